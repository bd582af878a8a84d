//! Where everything is. One function of the window's size, so that nothing can push anything else.

use egui::{Rect, pos2};

use crate::render::theme;

/// The smallest window in which everything fits, points.
pub const SMALLEST: [f32; 2] = [1280.0, 720.0];

/// Width of the column at the right, points.
const COLUMN: f32 = 288.0;
/// Height of the desk: two rows of keys with their displays, points.
const DESK: f32 = 128.0;
/// Height of the transport: buttons, kinetic curve, keys, ruler; points.
const TRANSPORT: f32 = 148.0;
/// Heights in the column, points.
const HEADER: f32 = 36.0;
const KEYS: f32 = 144.0;
const DEVICES: f32 = 84.0;

/// The rectangles of all panels; they fill the window and do not overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Areas {
    /// The large view.
    pub front: Rect,
    /// The narrow view.
    pub side: Rect,
    /// Scrubbing, keys, kinetic curve.
    pub transport: Rect,
    /// Dials and keys.
    pub desk: Rect,
    /// The show's name, undo, save.
    pub header: Rect,
    /// Keys of the clip.
    pub keys: Rect,
    /// The servo puppet.
    pub puppet: Rect,
    /// Input devices.
    pub devices: Rect,
}

impl Areas {
    /// Divides `window`; one smaller than [`SMALLEST`] is treated as that size and cut off.
    pub fn of(window: Rect) -> Areas {
        let right = window.left() + window.width().max(SMALLEST[0]).round();
        let bottom = window.top() + window.height().max(SMALLEST[1]).round();
        let (left, top) = (window.left(), window.top());
        // A hand's width more on large screens: labels and bars gain, the figure still gains most.
        let column = right - (COLUMN + ((right - left - SMALLEST[0]) * 0.1).min(72.0)).round();
        let taller = bottom - top - SMALLEST[1];
        let desk = bottom - DESK - (taller * 0.06).min(32.0).round();
        let transport = desk - TRANSPORT - (taller * 0.14).min(72.0).round();
        let side = left + ((column - left) * 0.72).round();
        let keys = top + HEADER;
        let puppet = keys + KEYS + (taller * 0.25).min(120.0).round();
        let devices = bottom - DEVICES - (taller * 0.1).min(60.0).round();
        let rect = |x0: f32, y0: f32, x1: f32, y1: f32| Rect::from_min_max(pos2(x0, y0), pos2(x1, y1));
        Areas {
            front: rect(left, top, side, transport),
            side: rect(side, top, column, transport),
            transport: rect(left, transport, column, desk),
            desk: rect(left, desk, column, bottom),
            header: rect(column, top, right, keys),
            keys: rect(column, keys, right, puppet),
            puppet: rect(column, puppet, right, devices),
            devices: rect(column, devices, right, bottom),
        }
    }

    /// The rectangle of a board that takes the place of the figure and its time: the network, the controls.
    pub fn board(&self) -> Rect {
        self.front.union(self.side).union(self.transport)
    }

    /// All of them, with their names.
    pub fn all(&self) -> [(&'static str, Rect); 8] {
        [
            ("front", self.front),
            ("side", self.side),
            ("transport", self.transport),
            ("desk", self.desk),
            ("header", self.header),
            ("keys", self.keys),
            ("puppet", self.puppet),
            ("devices", self.devices),
        ]
    }
}

/// The same rectangle without the margin every panel keeps.
pub fn inside(panel: Rect) -> Rect {
    panel.shrink2(egui::vec2(theme::MARGIN, theme::GAP))
}

/// `count` equal cells from left to right with `gap` between, edges on whole points.
pub fn columns(area: Rect, count: usize, gap: f32) -> impl Iterator<Item = Rect> {
    let width = (area.width() - gap * (count as f32 - 1.0)) / count as f32;
    (0..count).map(move |index| {
        let left = (area.left() + index as f32 * (width + gap)).round();
        let right = (area.left() + index as f32 * (width + gap) + width).round();
        Rect::from_min_max(pos2(left, area.top()), pos2(right, area.bottom()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::vec2;

    #[test]
    fn nothing_overlaps_and_nothing_is_left_over() {
        for size in [
            [1280.0, 720.0],
            [1366.0, 768.0],
            [1920.0, 1080.0],
            [2560.0, 1440.0],
            [3840.0, 1200.0],
        ] {
            let window = Rect::from_min_size(pos2(0.0, 0.0), vec2(size[0], size[1]));
            let all = Areas::of(window).all();
            let area: f32 = all.iter().map(|(_, r)| r.area()).sum();
            assert!((area - window.area()).abs() < 1.0, "{size:?}: {area}");
            for (i, (name, a)) in all.iter().enumerate() {
                assert!(
                    window.contains_rect(*a) && a.width() > 90.0,
                    "{size:?} {name} {a:?}"
                );
                for (other, b) in &all[i + 1..] {
                    let shared = a.intersect(*b);
                    assert!(
                        !shared.is_positive(),
                        "{size:?}: {name} and {other} share {shared:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_figure_is_the_hero() {
        let areas = Areas::of(Rect::from_min_size(pos2(0.0, 0.0), vec2(1280.0, 720.0)));
        for (name, rect) in areas.all().into_iter().filter(|(name, _)| *name != "front") {
            assert!(areas.front.area() > 1.5 * rect.area(), "{name}");
        }
    }

    #[test]
    fn a_small_window_is_cut_off_not_squeezed() {
        let small = Areas::of(Rect::from_min_size(pos2(0.0, 0.0), vec2(640.0, 400.0)));
        let smallest = Areas::of(Rect::from_min_size(pos2(0.0, 0.0), vec2(1280.0, 720.0)));
        assert_eq!(small, smallest);
    }

    #[test]
    fn columns_end_where_the_area_ends() {
        let area = Rect::from_min_size(pos2(3.0, 0.0), vec2(100.0, 10.0));
        let cells: Vec<Rect> = columns(area, 3, 4.0).collect();
        assert_eq!(cells[0].left(), 3.0);
        assert_eq!(cells[2].right(), 103.0);
        assert!(cells.windows(2).all(|c| c[1].left() > c[0].right()));
    }
}
