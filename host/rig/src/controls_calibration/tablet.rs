//! From a tablet's counts to a place: crop, turn, mirror, keep the aspect, unit square.
//!
//! The order of common tablet drivers (OpenTabletDriver, libinput): the area is cropped in millimetres of the sheet,
//! turned about its middle, mirrored, cut to the wanted proportion, and then spans −1…1 on its longer side, the shorter
//! one centred with the aspect kept, y up, as the network's tablet has it.

use device::codec::Surface;
use serde::{Deserialize, Serialize};

/// Millimetres in an inch.
const MM_PER_INCH: f64 = 25.4;
/// The smallest side an area may have, millimetres: less is a slip of the hand.
pub const SIDE_MM_MIN: f64 = 5.0;

/// A rectangle on the sheet, millimetres from its upper left corner, y down.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Area {
    /// Its upper left corner.
    pub corner_mm: [f64; 2],
    /// Its width and height.
    pub size_mm: [f64; 2],
}

/// How a tablet lies and which part of it counts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TabletMapping {
    /// The part that counts; all of it unless said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area: Option<Area>,
    /// How far the tablet is turned against the hand, degrees counter-clockwise: what is drawn upright then comes out
    /// upright. Quarter turns also exchange the sides of the area.
    #[serde(default)]
    pub turned_deg: f64,
    /// Whether x and y run the other way.
    #[serde(default)]
    pub mirrored: [bool; 2],
    /// Width against height of what is drawn on: the area is cut to it. Left out: the area as it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub aspect: Option<f64>,
    /// What pressing comes to.
    #[serde(default)]
    pub pressure: super::PressureCurve,
}

/// The sheet a mapping is for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sheet {
    /// Largest x and y, counts.
    pub max_counts: [u32; 2],
    /// Counts per inch.
    pub counts_per_inch: [f64; 2],
}

impl From<Surface> for Sheet {
    fn from(surface: Surface) -> Self {
        Self {
            max_counts: surface.max_counts,
            counts_per_inch: surface.counts_per_inch,
        }
    }
}

impl Sheet {
    /// Width and height, millimetres.
    pub fn size_mm(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.mm(axis, self.max_counts[axis]))
    }

    fn mm(&self, axis: usize, counts: u32) -> f64 {
        f64::from(counts) / self.counts_per_inch[axis].max(1.0) * MM_PER_INCH
    }

    /// A place on it, millimetres from the upper left corner.
    pub fn place_mm(&self, counts: [u32; 2]) -> [f64; 2] {
        [0, 1].map(|axis| self.mm(axis, counts[axis]))
    }
}

impl TabletMapping {
    /// Where a place is: −1…1 on the longer side, y up; `None` outside the area. A place a tenth of a millimetre
    /// outside still is on its edge, so that an edge can be drawn along; of a whole sheet there is no outside.
    pub fn place(&self, counts: [u32; 2], sheet: &Sheet) -> Option<[f64; 2]> {
        const EDGE_MM: f64 = 0.1;
        let area = self.area_of(sheet);
        let at = sheet.place_mm(counts);
        let from_middle = [0, 1].map(|axis| at[axis] - area.corner_mm[axis] - area.size_mm[axis] / 2.0);
        // y up from here on.
        let (x, y) = (from_middle[0], 0.0 - from_middle[1]);
        let (sin, cos) = self.sin_cos();
        let turned = [x * cos - y * sin, x * sin + y * cos];
        let half = self.half_mm(area);
        let mut place = [0.0; 2];
        for axis in 0..2 {
            let along = turned[axis];
            if along.abs() > half[axis] + EDGE_MM && !self.is_whole() {
                return None;
            }
            let along = along.clamp(-half[axis], half[axis]);
            let along = if self.mirrored[axis] { 0.0 - along } else { along };
            place[axis] = along / half[0].max(half[1]).max(f64::MIN_POSITIVE);
        }
        Some(place)
    }

    /// The corners of what is drawn on, millimetres of the sheet: upper left, upper right, lower right and lower left, as
    /// the hand sees them.
    pub fn outline_mm(&self, sheet: &Sheet) -> [[f64; 2]; 4] {
        let area = self.area_of(sheet);
        let (sin, cos) = self.sin_cos();
        let half = self.half_mm(area);
        [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|[x, y]| {
            let (x, y) = (x * half[0], y * half[1]);
            // Back from the hand's axes to the sheet's, whose y goes down.
            let (right, up) = (x * cos + y * sin, y * cos - x * sin);
            [
                area.corner_mm[0] + area.size_mm[0] / 2.0 + right,
                area.corner_mm[1] + area.size_mm[1] / 2.0 - up,
            ]
        })
    }

    fn area_of(&self, sheet: &Sheet) -> Area {
        self.area.unwrap_or(Area {
            corner_mm: [0.0; 2],
            size_mm: sheet.size_mm(),
        })
    }

    /// Whether the whole sheet counts, however it lies.
    fn is_whole(&self) -> bool {
        self.area.is_none() && self.aspect.is_none() && self.turned_deg.rem_euclid(90.0) == 0.0
    }

    /// Exact for quarter turns, so that a turned tablet reaches its edges exactly.
    fn sin_cos(&self) -> (f64, f64) {
        let turned = self.turned_deg.rem_euclid(360.0);
        match turned {
            0.0 => (0.0, 1.0),
            90.0 => (1.0, 0.0),
            180.0 => (0.0, -1.0),
            270.0 => (-1.0, 0.0),
            _ => turned.to_radians().sin_cos(),
        }
    }

    /// Half of what is drawn on, millimetres, as the hand sees it: the largest rectangle of the wanted proportion that
    /// lies in the turned area.
    fn half_mm(&self, area: Area) -> [f64; 2] {
        let (sin, cos) = self.sin_cos();
        let (sin, cos) = (sin.abs(), cos.abs());
        let [width, height] = area.size_mm;
        let aspect = self.aspect.unwrap_or({
            // As the area lies: on its side where it is turned by more than an eighth.
            if sin > cos { height / width } else { width / height }
        });
        // A rectangle of half height h and half width h · aspect, turned, must reach no farther than the area's sides.
        let h = (width / 2.0 / (aspect * cos + sin)).min(height / 2.0 / (aspect * sin + cos));
        [h * aspect, h]
    }

    /// What is wrong with it whatever the sheet; `None` if nothing is.
    pub fn unsound(&self) -> Option<String> {
        if !self.turned_deg.is_finite() {
            return Some("a turn must be a number of degrees".into());
        }
        if let Some(aspect) = self.aspect.filter(|aspect| !(0.05..=20.0).contains(aspect)) {
            return Some(format!("an aspect must be 0.05 to 20, found {aspect}"));
        }
        let numbers = self.area.iter().flat_map(|area| [area.corner_mm, area.size_mm]);
        if !numbers.flatten().all(f64::is_finite) {
            return Some("an area must be of numbers".into());
        }
        if self
            .area
            .is_some_and(|area| area.size_mm.iter().any(|side| *side < SIDE_MM_MIN))
        {
            return Some(format!("the sides of an area must be {SIDE_MM_MIN} mm at least"));
        }
        self.pressure.fault()
    }

    /// What is wrong with it for a sheet; `None` if nothing is.
    pub fn fault(&self, sheet: &Sheet) -> Option<String> {
        if let Some(fault) = self.unsound() {
            return Some(fault);
        }
        let area = self.area?;
        let size = sheet.size_mm();
        let inside = (0..2).all(|axis| {
            area.corner_mm[axis] >= -0.5
                && area.size_mm[axis] >= SIDE_MM_MIN
                && area.corner_mm[axis] + area.size_mm[axis] <= size[axis] + 0.5
        });
        (!inside).then(|| {
            format!(
                "the area must lie on the sheet of {:.1} × {:.1} mm and have sides of {SIDE_MM_MIN} mm at least",
                size[0], size[1]
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// 100 by 50 mm.
    const SHEET: Sheet = Sheet {
        max_counts: [10_000, 5_000],
        counts_per_inch: [2540.0, 2540.0],
    };

    fn near(place: Option<[f64; 2]>, want: [f64; 2]) {
        let place = place.unwrap_or_else(|| panic!("outside; wanted {want:?}"));
        let off = (place[0] - want[0]).abs().max((place[1] - want[1]).abs());
        assert!(off < 1e-9, "{place:?}, wanted {want:?}");
    }

    #[test]
    fn a_whole_sheet_spans_its_longer_side() {
        let whole = TabletMapping::default();
        near(whole.place([0, 0], &SHEET), [-1.0, 0.5]);
        near(whole.place([10_000, 5_000], &SHEET), [1.0, -0.5]);
        near(whole.place([5_000, 2_500], &SHEET), [0.0, 0.0]);
    }

    #[test]
    fn quarter_turns_and_mirrors() {
        for (turned_deg, mirrored, want) in [
            // The sheet's upper right corner; turned a quarter counter-clockwise it is the upper left one.
            (0.0, [false, false], [1.0, 0.5]),
            (90.0, [false, false], [-0.5, 1.0]),
            (180.0, [false, false], [-1.0, -0.5]),
            (270.0, [false, false], [0.5, -1.0]),
            (-90.0, [false, false], [0.5, -1.0]),
            (0.0, [true, false], [-1.0, 0.5]),
            (90.0, [false, true], [-0.5, -1.0]),
        ] {
            let mapping = TabletMapping {
                turned_deg,
                mirrored,
                ..TabletMapping::default()
            };
            near(mapping.place([10_000, 0], &SHEET), want);
        }
    }

    #[test]
    fn an_area_is_cut_to_the_aspect_around_its_middle() {
        let mapping = TabletMapping {
            area: Some(Area {
                corner_mm: [20.0, 10.0],
                size_mm: [40.0, 20.0],
            }),
            aspect: Some(1.0),
            ..TabletMapping::default()
        };
        // The square of 20 mm in the middle of it: 30 to 50 mm, 10 to 30 mm.
        near(mapping.place([3_000, 1_000], &SHEET), [-1.0, 1.0]);
        near(mapping.place([5_000, 3_000], &SHEET), [1.0, -1.0]);
        assert_eq!(mapping.place([2_500, 2_000], &SHEET), None);
    }

    #[test]
    fn the_outline_is_where_the_corners_come_from() {
        for (turned_deg, aspect) in [(0.0, None), (90.0, None), (30.0, Some(1.5)), (-135.0, Some(0.8))] {
            let mapping = TabletMapping {
                turned_deg,
                aspect,
                area: Some(Area {
                    corner_mm: [20.0, 5.0],
                    size_mm: [60.0, 40.0],
                }),
                ..TabletMapping::default()
            };
            let [a, b, c, d] = mapping.outline_mm(&SHEET);
            let half = mapping.half_mm(mapping.area_of(&SHEET));
            let longer = half[0].max(half[1]);
            let (x, y) = (half[0] / longer, half[1] / longer);
            for (corner, want) in [(a, [-x, y]), (b, [x, y]), (c, [x, -y]), (d, [-x, -y])] {
                let counts = corner.map(|mm| (mm / MM_PER_INCH * 2540.0).round() as u32);
                let place = mapping.place(counts, &SHEET).expect("a corner is inside");
                let off = (place[0] - want[0]).abs().max((place[1] - want[1]).abs());
                assert!(off < 0.01, "{turned_deg}: {place:?}, wanted {want:?}");
            }
        }
    }

    #[test]
    fn areas_off_the_sheet_are_told() {
        let of = |corner_mm, size_mm| TabletMapping {
            area: Some(Area { corner_mm, size_mm }),
            ..TabletMapping::default()
        };
        assert_eq!(of([0.0, 0.0], [100.0, 50.0]).fault(&SHEET), None);
        for wrong in [
            of([0.0, 0.0], [101.0, 50.0]),
            of([-2.0, 0.0], [20.0, 20.0]),
            of([0.0, 0.0], [4.0, 20.0]),
            of([f64::NAN, 0.0], [20.0, 20.0]),
        ] {
            assert!(wrong.fault(&SHEET).is_some(), "{wrong:?}");
        }
    }

    proptest! {
        /// Whatever the mapping: places lie in the square, a millimetre of the hand is the same everywhere and in every
        /// direction, and a turned tablet gives what the hand drew.
        #[test]
        fn a_mapping_keeps_shapes(
            turned_deg in -720.0..720.0_f64, mirrored in any::<[bool; 2]>(), aspect in prop::option::of(0.3..3.0_f64),
            a in (3_000_u32..7_000, 1_500_u32..3_500), b in (3_000_u32..7_000, 1_500_u32..3_500),
        ) {
            let mapping = TabletMapping { turned_deg, mirrored, aspect, ..TabletMapping::default() };
            let (Some(p), Some(q)) = (mapping.place([a.0, a.1], &SHEET), mapping.place([b.0, b.1], &SHEET)) else {
                return Ok(());
            };
            for place in [p, q] {
                prop_assert!(place.iter().all(|along| along.abs() <= 1.0 + 1e-12));
            }
            let half = mapping.half_mm(Area { corner_mm: [0.0; 2], size_mm: SHEET.size_mm() });
            let inner = |place: [f64; 2]| (0..2).all(|axis| place[axis].abs() < half[axis] / half[0].max(half[1]) - 1e-6);
            if inner(p) && inner(q) {
                let hand = f64::from(a.0).mul_add(1.0, -f64::from(b.0)).hypot(f64::from(a.1) - f64::from(b.1)) / 100.0;
                let shown = (p[0] - q[0]).hypot(p[1] - q[1]) * half[0].max(half[1]);
                prop_assert!((hand - shown).abs() < 1e-6, "{hand} mm became {shown}");
            }
        }
    }
}
