//! A tablet's active area, and the two ways of naming a place on it.
//!
//! A script says −1…1 for the whole of each side. The network's `TABLETIN` says −1…1 for the longer side and
//! keeps the aspect, so that a circle of the hand is a circle (`docs/ps300/functions.md`, TABLETIN).

use device_profiles::InputProfile;

/// The active area in counts and inches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    counts: [f64; 2],
    inches: [f64; 2],
}

impl From<&InputProfile> for Surface {
    fn from(profile: &InputProfile) -> Self {
        let counts = profile.area().counts.map(f64::from);
        let [x, y] = profile.area().per_inch().map(|per_inch| per_inch.max(1.0));
        Self {
            counts,
            inches: [counts[0] / x, counts[1] / y],
        }
    }
}

impl Surface {
    /// How far the cursor reaches from the middle: 1 on the longer side.
    pub fn cursor_reach(&self) -> [f64; 2] {
        let longer = self.inches[0].max(self.inches[1]).max(f64::MIN_POSITIVE);
        self.inches.map(|side| side / longer)
    }

    /// Script coordinates of a place given as a cursor, clamped to the area.
    pub fn script_from_cursor(&self, cursor: [f64; 2]) -> [f64; 2] {
        let reach = self.cursor_reach();
        [0, 1].map(|axis| (cursor[axis] / reach[axis]).clamp(-1.0, 1.0))
    }

    /// The cursor that a place given in script coordinates makes.
    pub fn cursor_from_script(&self, place: [f64; 2]) -> [f64; 2] {
        let reach = self.cursor_reach();
        [0, 1].map(|axis| place[axis] * reach[axis])
    }

    /// The place of the nearest count to `place`, moved by whole counts; script coordinates.
    pub fn on_the_grid(&self, place: [f64; 2], by_counts: [i32; 2]) -> [f64; 2] {
        [0, 1].map(|axis| {
            let half = self.counts[axis] / 2.0;
            let count = ((place[axis] + 1.0) * half).round() + f64::from(by_counts[axis]);
            count.clamp(0.0, self.counts[axis]) / half - 1.0
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use device_profiles::Profiles;

    fn graphire() -> Surface {
        Profiles::builtin()
            .input("graphire-serial")
            .expect("built in")
            .into()
    }

    #[test]
    fn the_longer_side_reaches_one_and_the_way_back_is_the_way_there() {
        let surface = graphire();
        let reach = surface.cursor_reach();
        assert_eq!(reach[0], 1.0);
        assert!((reach[1] - 3711.0 / 5103.0).abs() < 1e-12);
        let there = surface.script_from_cursor([0.5, 0.5]);
        let back = surface.cursor_from_script(there);
        assert!((back[0] - 0.5).abs() < 1e-12 && (back[1] - 0.5).abs() < 1e-12);
        assert_eq!(surface.script_from_cursor([2.0, -2.0]), [1.0, -1.0]);
    }

    #[test]
    fn the_grid_is_one_count_wide() {
        let surface = graphire();
        let here = surface.on_the_grid([0.1, 0.1], [0, 0]);
        let beside = surface.on_the_grid([0.1, 0.1], [1, 0]);
        assert!((beside[0] - here[0] - 2.0 / 5103.0).abs() < 1e-12);
        assert!((here[0] - 0.1).abs() <= 1.0 / 5103.0);
    }
}
