//! `networks/pages/posing.ps300` against the rule it draws: the end of a link is the point of its sphere nearest to the
//! line that the pen is. Source: `docs/math.md`, section 5.4.

use glam::{DMat3, DMat4, DVec2, DVec3};
use ps300::Value;

use crate::hands::{Draws, Hands};

struct Model {
    pen: DVec2,
    turn_deg: f64,
    tilt_deg: f64,
    twist_deg: f64,
    is_near: bool,
    /// The view turns only what is posed after it.
    direction: DVec3,
    other: DVec3,
    fixed: Option<DVec3>,
}

impl Model {
    fn new() -> Self {
        Self {
            pen: DVec2::ZERO,
            turn_deg: 0.0,
            tilt_deg: 0.0,
            twist_deg: 0.0,
            is_near: true,
            direction: DVec3::Z,
            other: -DVec3::Z,
            fixed: None,
        }
    }

    fn view(&self) -> DMat3 {
        DMat3::from_rotation_x(self.tilt_deg.to_radians())
            * DMat3::from_rotation_y(self.turn_deg.to_radians())
    }

    fn pose(&mut self) {
        let radius = self.pen.length();
        let side = if self.is_near { 1.0 } else { -1.0 };
        let [chosen, other] = [side, -side].map(|side| {
            if radius >= 1.0 {
                (self.pen / radius).extend(0.0)
            } else {
                self.pen.extend(side * (1.0 - radius * radius).sqrt())
            }
        });
        let back = self.view().transpose();
        (self.direction, self.other) = (back * chosen, back * other);
    }

    /// The triangle's corners: about the link, in its outer half.
    fn corners(&self) -> [DVec3; 3] {
        let midway = DVec3::Z + self.direction;
        let aim = if midway.length_squared() < 1e-9 {
            DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0))
        } else {
            DMat3::from_axis_angle(midway / midway.length(), std::f64::consts::PI)
        };
        let twist = DMat3::from_rotation_z(self.twist_deg.to_radians());
        [[0.2, 0.0], [-0.1, 0.1], [-0.1, -0.1]].map(|[x, y]| aim * (twist * DVec3::new(x, y, 0.7)))
    }
}

fn ends(hands: &Hands, name: &str) -> Vec<DVec3> {
    let strokes = hands.machine.display_of(name, DMat4::IDENTITY).strokes;
    strokes.iter().map(|stroke| stroke.to).collect()
}

fn is_near(got: &[DVec3], expected: &[DVec3]) -> bool {
    got.len() == expected.len() && got.iter().zip(expected).all(|(a, b)| (*a - *b).length() < 1e-7)
}

fn differences(hands: &Hands, model: &Model) -> Vec<&'static str> {
    let [a, b, c] = model.corners();
    let panel = hands.machine.panel();
    let seen: Vec<DVec3> = [model.direction, model.other]
        .map(|at| 0.5 * (model.view() * at))
        .to_vec();
    [
        ("bone", is_near(&ends(hands, "bone"), &[model.direction])),
        ("ghost", is_near(&ends(hands, "ghost"), &[model.other])),
        ("triangle", is_near(&ends(hands, "helper"), &[b, c, a])),
        ("view", is_near(&ends(hands, "figure_link")[..2], &seen)),
        (
            "twist",
            panel.dial_labels[0] == format!("Tw {}", model.twist_deg.round()),
        ),
        (
            "side",
            panel.key_labels[10] == if model.is_near { "Near" } else { "Far" },
        ),
    ]
    .into_iter()
    .filter_map(|(name, same)| (!same).then_some(name))
    .collect()
}

#[test]
fn the_link_goes_where_the_pen_meets_the_sphere_in_any_view() {
    let mut hands = Hands::on(&["pages/posing.ps300"]);
    assert!(hands.machine.watch("fixed", 1));
    let mut model = Model::new();
    let mut draws = Draws(1987);
    for step in 0..1500 {
        let done = match draws.below(8) {
            0 => {
                hands.press(11);
                model.is_near ^= true;
                model.pose();
                "F11".to_owned()
            }
            1 => {
                let button = 1 + draws.below(2) as i32;
                hands.emit("TABLETIN", 3, button);
                hands.emit("TABLETIN", 3, 0);
                model.is_near = button == 1;
                model.pose();
                model.fixed = Some(model.direction);
                format!("button {button}")
            }
            2..=4 => {
                // The twist by whole degrees: how halves are rounded is another test's.
                let dial = 1 + draws.below(3) as u8;
                let turns = if dial == 1 {
                    draws.below(720) as f64 / 360.0 - 1.0
                } else {
                    draws.unit()
                };
                hands.turn(dial, turns);
                match dial {
                    1 => model.twist_deg += 360.0 * turns,
                    2 => model.turn_deg += 180.0 * turns,
                    _ => model.tilt_deg = (model.tilt_deg + 90.0 * turns).clamp(-90.0, 90.0),
                }
                format!("dial {dial} by {turns}")
            }
            _ => {
                let at = DVec2::new(draws.unit(), 0.75 * draws.unit());
                hands.emit("TABLETIN", 1, at);
                model.pen = (at - DVec2::new(-0.25, 0.0)) / 0.375;
                model.pose();
                format!("pen at {at}")
            }
        };
        let wrong = differences(&hands, &model);
        assert!(wrong.is_empty(), "step {step}, {done}: {wrong:?}");
        let fixed = hands.machine.drain_watched().last().map(|seen| seen.value);
        match (fixed, model.fixed.take()) {
            (None, None) => {}
            (Some(Value::Vector3(got)), Some(expected)) if (got - expected).length() < 1e-9 => {}
            (got, expected) => panic!("step {step}, {done}: fixed {got:?}, expected {expected:?}"),
        }
    }
    assert_eq!(hands.machine.reports(), []);
}

#[test]
fn straight_away_from_the_viewer_the_triangle_still_stands_about_the_link() {
    let mut hands = Hands::on(&["pages/posing.ps300"]);
    hands.emit("TABLETIN", 1, DVec2::new(-0.25, 0.0));
    hands.emit("TABLETIN", 3, 2);
    assert!(is_near(&ends(&hands, "bone"), &[-DVec3::Z]));
    let corners = ends(&hands, "helper");
    assert!(
        corners.len() == 3 && corners.iter().all(|at| (at.z + 0.7).abs() < 1e-12),
        "{corners:?}"
    );
    assert_eq!(hands.machine.reports(), []);
}
