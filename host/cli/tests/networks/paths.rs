//! `networks/pages/paths.ps300` against a model: eight points, a view, a window, an area.

use glam::{DMat3, DMat4, DVec2, DVec3};

use crate::hands::{Draws, Hands};

/// What a press of the pen is for.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    Point,
    First,
    Second,
}

struct Model {
    points: [DVec3; 8],
    chosen: usize,
    turn_deg: f64,
    tilt_deg: f64,
    middle: DVec2,
    half: f64,
    order: i32,
    pen: Use,
    is_down: bool,
    corners: Option<[DVec2; 2]>,
    is_ready: bool,
    is_seen: bool,
}

impl Model {
    fn new() -> Self {
        let x = |n: usize| -0.875 + 0.25 * n as f64;
        let y = [-0.5, 0.25, 0.5, 0.25, -0.25, -0.5, -0.25, 0.5];
        Self {
            points: std::array::from_fn(|n| DVec3::new(x(n), y[n], 0.0)),
            chosen: 0,
            turn_deg: 0.0,
            tilt_deg: 0.0,
            middle: DVec2::ZERO,
            half: 1.0,
            order: 4,
            pen: Use::Point,
            is_down: false,
            corners: None,
            is_ready: false,
            is_seen: false,
        }
    }

    fn view(&self) -> DMat3 {
        DMat3::from_rotation_x(self.tilt_deg.to_radians())
            * DMat3::from_rotation_z(self.turn_deg.to_radians())
    }

    /// The place in the plane of a point's height that is seen at `at`: where the line of sight cuts it.
    fn below(&self, at: DVec2, height: f64) -> DVec3 {
        let back = self.view().transpose();
        let (start, along) = (back * at.extend(0.0), back * DVec3::Z);
        start + along * ((height - start.z) / along.z)
    }

    fn touch(&mut self, at: DVec2, pressed: bool) {
        match (self.pen, pressed) {
            (Use::Point, _) => {
                let height = self.points[self.chosen].z;
                self.points[self.chosen] = self.below(at, height);
            }
            (Use::First, true) => {
                self.corners = Some([at; 2]);
                (self.pen, self.is_ready, self.is_seen) = (Use::Second, false, true);
            }
            (Use::First, false) => {}
            (Use::Second, _) => {
                if let Some([_, second]) = &mut self.corners {
                    *second = at;
                    self.is_ready = true;
                }
            }
        }
    }

    fn pen(&mut self, at: DVec2, down: bool) {
        let at = self.middle + self.half * at;
        if self.is_down {
            self.touch(at, false);
        } else if down {
            self.touch(at, true);
        }
        self.is_down = down;
    }

    fn press(&mut self, key: i32) {
        match key {
            1 => self.half = (self.half / 1.5).max(0.001),
            2 => self.half = (self.half * 1.5).min(100.0),
            3 => self.pen = Use::First,
            4 | 5 => {
                if let (4, true, Some([a, b])) = (key, self.is_ready, self.corners) {
                    self.middle = (a + b) / 2.0;
                    self.half = ((b - a).abs().max_element() / 2.0).clamp(0.001, 100.0);
                }
                (self.pen, self.is_ready, self.is_seen) = (Use::Point, false, false);
            }
            6 => self.chosen = (self.chosen + 1) % 8,
            7 => self.chosen = (self.chosen + 7) % 8,
            8 => self.pen = Use::Point,
            9 => (self.middle, self.half) = (DVec2::ZERO, 1.0),
            _ => self.order = if self.order == 6 { 2 } else { self.order + 1 },
        }
    }

    fn turn(&mut self, dial: u8, turns: f64) {
        match dial {
            1 => {
                let height = &mut self.points[self.chosen].z;
                *height = (*height + 0.5 * turns).clamp(-1.0, 1.0);
            }
            2 => self.turn_deg += 90.0 * turns,
            _ => self.tilt_deg = (self.tilt_deg + 90.0 * turns).clamp(-80.0, 80.0),
        }
    }

    /// As the read-out says it.
    fn window(&self) -> String {
        let text = |x: f64| ((x * 1000.0).round() / 1000.0).to_string();
        let (low, high) = (self.middle - self.half, self.middle + self.half);
        format!(
            "X {} {} Y {} {}",
            text(low.x),
            text(high.x),
            text(low.y),
            text(high.y)
        )
    }
}

/// The ends of the lines of a name, without the transforms above it.
fn ends(hands: &Hands, name: &str) -> Vec<[DVec3; 2]> {
    let strokes = hands.machine.display_of(name, DMat4::IDENTITY).strokes;
    strokes.iter().map(|stroke| [stroke.from, stroke.to]).collect()
}

fn is_near(got: &[[DVec3; 2]], expected: &[[DVec3; 2]]) -> bool {
    got.len() == expected.len()
        && got
            .iter()
            .flatten()
            .zip(expected.iter().flatten())
            .all(|(a, b)| (*a - *b).length() < 1e-9 * (1.0 + b.length()))
}

/// What differs, by name.
fn differences(hands: &Hands, model: &Model) -> Vec<&'static str> {
    let joined: Vec<_> = model.points.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    let hung = model.points.map(|point| [point.with_z(0.0), point]);
    let panel = hands.machine.panel();
    let mark = ends(hands, "chosen_point");
    let marked = mark
        .first()
        .map(|[from, to]| from.midpoint(*to))
        .unwrap_or_default();
    let corners = model.corners.filter(|_| model.is_seen);
    let rectangle = corners.map_or(Vec::new(), |[a, b]| {
        let around = [a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y), a];
        around
            .windows(2)
            .map(|pair| [pair[0].extend(0.0), pair[1].extend(0.0)])
            .collect()
    });
    let flip = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
    let seen: Vec<_> = joined
        .iter()
        .map(|pair| pair.map(|at| flip * model.view() * at))
        .collect();
    let world = ends(hands, "world");
    [
        ("polygon", is_near(&ends(hands, "polygon"), &joined)),
        ("curtain", is_near(&ends(hands, "curtain"), &hung)),
        ("view", is_near(&world[..7], &seen)),
        (
            "mark",
            (marked - model.points[model.chosen]).length() < 1e-9 * (1.0 + marked.length()),
        ),
        ("area", is_near(&ends(hands, "area"), &rectangle)),
        ("window", panel.message == model.window()),
        (
            "point",
            panel.key_labels[11] == format!("Point {}", model.chosen + 1),
        ),
        ("order", panel.key_labels[9] == format!("Order {}", model.order)),
    ]
    .into_iter()
    .filter_map(|(name, same)| (!same).then_some(name))
    .collect()
}

#[test]
fn points_follow_pen_and_dials_in_any_view_and_at_any_zoom() {
    let mut hands = Hands::on(&["pages/paths.ps300"]);
    let mut model = Model::new();
    assert!(
        differences(&hands, &model).is_empty(),
        "{:?}",
        differences(&hands, &model)
    );
    let mut draws = Draws(1988);
    for step in 0..1500 {
        let done = match draws.below(6) {
            0 => {
                // Far zooms are come back from, or everything would end in them.
                let key = [1, 2, 3, 4, 5, 6, 6, 7, 8, 9, 9, 10][draws.below(12) as usize];
                hands.press(key);
                model.press(key);
                format!("F{key}")
            }
            1 | 2 => {
                let (dial, turns) = (draws.below(3) as u8 + 1, draws.unit());
                hands.turn(dial, turns);
                model.turn(dial, turns);
                format!("dial {dial} by {turns}")
            }
            _ => {
                let (at, down) = (DVec2::new(draws.unit(), draws.unit()), draws.below(3) > 0);
                hands.pen(at, down);
                model.pen(at, down);
                format!("pen at {at}, {down}")
            }
        };
        let wrong = differences(&hands, &model);
        assert!(wrong.is_empty(), "step {step}, {done}: {wrong:?}");
    }
    assert_eq!(hands.machine.reports(), []);
}

#[test]
fn the_window_is_what_the_read_out_says() {
    let mut hands = Hands::on(&["pages/paths.ps300"]);
    let read = |hands: &Hands| hands.machine.panel().message.clone();
    assert_eq!(read(&hands), "X -1 1 Y -1 1");
    hands.press(1);
    assert_eq!(read(&hands), "X -0.667 0.667 Y -0.667 0.667");
    hands.press(2);
    hands.press(3);
    for (at, down) in [
        ([0.0, 0.0], true),
        ([0.0, 0.0], false),
        ([0.5, 0.25], true),
        ([0.5, 0.25], false),
    ] {
        hands.pen(DVec2::from(at), down);
    }
    assert_eq!(read(&hands), "X -1 1 Y -1 1");
    hands.press(4);
    // The smallest square that holds the rectangle, with its middle.
    assert_eq!(read(&hands), "X 0 0.5 Y -0.125 0.375");
    let corner = hands.machine.display_of("path", DMat4::IDENTITY).views[0].screen_from_world;
    let placed = corner
        .expect("a view")
        .project_point3(DVec3::new(0.5, 0.375, 0.0));
    assert!((placed.truncate() - DVec2::ONE).length() < 1e-9, "{placed}");
}
