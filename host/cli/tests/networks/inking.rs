//! `networks/inking.ps300` against a model of the paper: strokes, what of them can be taken back, band and pointer.

use glam::{DMat4, DVec2};

use crate::hands::{Draws, Hands};

/// The paper as the page of networks describes it.
#[derive(Default)]
struct Paper {
    is_band: bool,
    /// Each vector, and whether a line is drawn to it.
    ink: Vec<(DVec2, bool)>,
    /// Vectors of the last stroke.
    last: usize,
    down: Option<DVec2>,
    pen: DVec2,
}

impl Paper {
    fn pen(&mut self, at: DVec2, down: bool) {
        self.pen = at;
        match self.down {
            // The place at which it is lifted still counts.
            Some(_) if !self.is_band => {
                self.ink.push((at, true));
                self.last += 1;
            }
            _ => {}
        }
        match (self.down, down) {
            (None, true) => {
                self.down = Some(at);
                if !self.is_band {
                    self.ink.push((at, false));
                    self.last = 1;
                }
            }
            (Some(start), false) => {
                self.down = None;
                if self.is_band {
                    self.ink.extend([(start, false), (at, true)]);
                    self.last = 2;
                }
            }
            _ => {}
        }
    }

    fn press(&mut self, key: i32) {
        match key {
            1 | 2 => self.is_band = key == 2,
            3 => {
                self.ink.truncate(self.ink.len().saturating_sub(self.last));
                self.last = 0;
            }
            4 => {
                self.ink.clear();
                self.last = 0;
            }
            _ => {
                self.ink.pop();
                self.last = self.last.saturating_sub(1);
            }
        }
    }

    /// The lines on the paper.
    fn lines(&self) -> Vec<[DVec2; 2]> {
        let pairs = self.ink.windows(2).filter(|pair| pair[1].1);
        pairs.map(|pair| [pair[0].0, pair[1].0]).collect()
    }
}

fn drawn(hands: &Hands, name: &str) -> Vec<[DVec2; 2]> {
    let strokes = hands.machine.display_of(name, DMat4::IDENTITY).strokes;
    strokes
        .iter()
        .map(|stroke| [stroke.from.truncate(), stroke.to.truncate()])
        .collect()
}

#[test]
fn pen_and_keys_draw_what_the_model_draws() {
    let mut hands = Hands::on(&["inking.ps300"]);
    // The file's list begins with a move to the middle, as a list must have a vector.
    let mut paper = Paper {
        ink: vec![(DVec2::ZERO, false)],
        ..Paper::default()
    };
    let mut draws = Draws(1989);
    for step in 0..1200 {
        if paper.down.is_none() && draws.below(8) == 0 {
            let key = [1, 2, 3, 3, 4, 5][draws.below(6) as usize];
            hands.press(key);
            paper.press(key);
        } else {
            let at = DVec2::new(draws.unit(), draws.unit());
            let down = draws.below(4) > 0;
            hands.pen(at, down);
            paper.pen(at, down);
        }
        assert_eq!(drawn(&hands, "ink"), paper.lines(), "step {step}");
        let band = match paper.down {
            Some(start) if paper.is_band => [start, paper.pen],
            _ => [paper.pen; 2],
        };
        let seen = drawn(&hands, "band");
        let is_right = match paper.down {
            Some(_) if paper.is_band => seen == [band],
            // Nothing is seen of a band that nobody holds: both its ends are in one place.
            _ => seen.iter().all(|[from, to]| from == to),
        };
        assert!(is_right, "step {step}: band {seen:?}");
    }
    assert_eq!(hands.machine.reports(), []);
}

#[test]
fn the_last_stroke_is_taken_back_once() {
    let mut hands = Hands::on(&["inking.ps300"]);
    let stroke = |hands: &mut Hands, y: f64| {
        hands.pen(DVec2::new(0.0, y), false);
        hands.pen(DVec2::new(0.0, y), true);
        hands.pen(DVec2::new(0.5, y), true);
        hands.pen(DVec2::new(1.0, y), false);
    };
    stroke(&mut hands, 0.1);
    stroke(&mut hands, 0.2);
    assert_eq!(drawn(&hands, "ink").len(), 4);
    hands.press(3);
    let first = drawn(&hands, "ink");
    assert!(
        first.len() == 2 && first.iter().flatten().all(|at| at.y == 0.1),
        "{first:?}"
    );
    hands.press(3);
    assert_eq!(drawn(&hands, "ink"), first);
}

#[test]
fn the_pointer_is_where_the_pen_is_and_only_while_it_is_near() {
    let mut hands = Hands::on(&["inking.ps300"]);
    assert!(drawn(&hands, "pointer").is_empty());
    let at = DVec2::new(0.25, -0.5);
    for (down, strokes, width) in [(false, 2, 0.1), (true, 4, 0.02)] {
        hands.pen(at, down);
        let pointer = drawn(&hands, "pointer");
        assert_eq!(pointer.len(), strokes);
        let across = pointer[0][1].x - pointer[0][0].x;
        let middle = pointer.iter().map(|[from, to]| from.midpoint(*to)).sum::<DVec2>() / strokes as f64;
        assert!(
            (across - width).abs() < 1e-12 && (middle - at).length() < 1e-12,
            "{pointer:?}"
        );
    }
    hands.away();
    assert!(drawn(&hands, "pointer").is_empty());
}
