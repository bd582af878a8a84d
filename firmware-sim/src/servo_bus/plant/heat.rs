//! Winding and housing: two bodies that warm each other, with the room around them.
//!
//! The winding gets what the current leaves in it (I²R); what the servo reports is its housing's temperature,
//! where its sensor sits. The times and rises are ours, of the size that a stalled servo of this class shows: a
//! minute or two to its limit.

use super::STEP_SECS;

/// The room.
pub(in crate::servo_bus) const AMBIENT_C: f64 = 25.0;
/// How much hotter than the room the housing gets at full effort.
const HOUSING_RISE_C: f64 = 70.0;
/// Time constant of the housing against the room.
const HOUSING_SECS: f64 = 180.0;
/// How much hotter than the housing the winding gets at full effort.
const WINDING_RISE_C: f64 = 40.0;
/// Time constant of the winding against the housing.
const WINDING_SECS: f64 = 12.0;

/// Temperatures in degrees Celsius.
#[derive(Clone, Copy, Debug)]
pub(in crate::servo_bus) struct Heat {
    pub(in crate::servo_bus) winding_c: f64,
    pub(in crate::servo_bus) housing_c: f64,
}

impl Default for Heat {
    fn default() -> Self {
        Self {
            winding_c: AMBIENT_C,
            housing_c: AMBIENT_C,
        }
    }
}

impl Heat {
    /// One plant step at `effort`, a share of the stall current.
    pub(super) fn step(&mut self, effort: f64) {
        // Heat that flows, as a share of what full effort makes.
        let made = effort * effort;
        let inward = (self.winding_c - self.housing_c) / WINDING_RISE_C;
        let outward = (self.housing_c - AMBIENT_C) / HOUSING_RISE_C;
        self.winding_c += (made - inward) * WINDING_RISE_C * STEP_SECS / WINDING_SECS;
        self.housing_c += (inward - outward) * HOUSING_RISE_C * STEP_SECS / HOUSING_SECS;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(secs: u32, effort: f64) -> Heat {
        let mut heat = Heat::default();
        for _ in 0..secs * 1000 {
            heat.step(effort);
        }
        heat
    }

    #[test]
    fn full_effort_settles_at_both_rises_and_half_at_a_quarter() {
        let hot = after(2000, 1.0);
        assert!((hot.housing_c - AMBIENT_C - HOUSING_RISE_C).abs() < 0.1);
        assert!((hot.winding_c - hot.housing_c - WINDING_RISE_C).abs() < 0.1);
        let warm = after(2000, -0.5);
        assert!((warm.housing_c - AMBIENT_C - HOUSING_RISE_C / 4.0).abs() < 0.1);
    }

    #[test]
    fn the_winding_runs_ahead_of_what_is_reported() {
        let early = after(15, 1.0);
        assert!(early.winding_c - AMBIENT_C > 20.0 && early.housing_c - AMBIENT_C < 6.0);
    }
}
