//! Calibration of controls: what lies between a device's counts and what the network is told, per device, measured
//! with a hand on it.
//!
//! *Knows* how counts become places and shares: a tablet's area, turn, mirror and pressure ([`tablet`], [`pressure`]),
//! counts in a dial's turn, ends of faders and the rest of what springs back ([`measure`]); the steps a person goes
//! through ([`flow`]); and where it is kept ([`store`]). Pure but for the store: counts in, numbers out.
//! *Must not know* wires, profiles' formats, or what a control drives.
//! *Start reading* at [`ControlsCalibration`], then [`flow`].

pub mod flow;
pub mod measure;
pub mod pressure;
pub mod store;
pub mod tablet;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use flow::{CalibrateControl, Calibrating, CalibrationView};
pub use pressure::PressureCurve;
pub use tablet::{Area, TabletMapping};

/// Everything that was calibrated on one device. What is not here is as the profile has it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControlsCalibration {
    /// Of a tablet's surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tablet: Option<TabletMapping>,
    /// Counts in one turn, by the dial's number from 0; negative for a dial that counts the other way.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub dials: BTreeMap<u16, f64>,
    /// Faders, potentiometers and axes, by their number from 0.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub axes: BTreeMap<u16, AxisCalibration>,
}

impl ControlsCalibration {
    /// Whether nothing was calibrated.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// What a turn of a dial comes to, turns; by the profile's counts where the dial was not calibrated.
    pub fn turns(&self, control: u16, delta_counts: i32, counts_per_turn: f64) -> f64 {
        let per_turn = self.dials.get(&control).copied().unwrap_or(counts_per_turn);
        f64::from(delta_counts) / per_turn
    }
}

/// What was measured of one control with a place of its own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisCalibration {
    /// Counts at both ends; the first is where 0, or −1, is. The first may be the larger.
    pub ends: [i32; 2],
    /// Counts where it rests by itself, of what springs back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rest: Option<i32>,
    /// Counts to either side of the rest that mean nothing.
    #[serde(default)]
    pub dead_counts: i32,
}

impl AxisCalibration {
    /// Where a value is: 0 to 1 from end to end, or −1 to 1 around the rest, 0 within the dead zone and nowhere a step.
    pub fn share(&self, value: i32) -> f64 {
        let [from, to] = self.ends.map(f64::from);
        let value = f64::from(value);
        let Some(rest) = self.rest.map(f64::from) else {
            if from == to {
                return 0.0;
            }
            return ((value - from) / (to - from)).clamp(0.0, 1.0);
        };
        let end = if (value - rest) * (to - rest) >= 0.0 {
            to
        } else {
            from
        };
        let (off, far) = ((value - rest).abs(), (end - rest).abs());
        let dead = f64::from(self.dead_counts.max(0));
        if far <= dead {
            return 0.0;
        }
        let share = ((off - dead) / (far - dead)).clamp(0.0, 1.0);
        if end == to { share } else { 0.0 - share }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn dials_count_as_they_were_measured_and_others_as_the_profile_says() {
        let calibration = ControlsCalibration {
            dials: BTreeMap::from([(3, 200.0), (4, -256.0)]),
            ..ControlsCalibration::default()
        };
        let turns = |control, counts| calibration.turns(control, counts, 256.0);
        assert_eq!((turns(3, 100), turns(4, 64), turns(0, 64)), (0.5, -0.25, 0.25));
    }

    #[test]
    fn ends_and_rest_are_met() {
        let fader = AxisCalibration {
            ends: [1000, 24],
            rest: None,
            dead_counts: 0,
        };
        assert_eq!(
            [1000, 512, 24, 1023, 0].map(|v| fader.share(v)),
            [0.0, 0.5, 1.0, 0.0, 1.0]
        );
        let stick = AxisCalibration {
            ends: [-300, 400],
            rest: Some(10),
            dead_counts: 5,
        };
        assert_eq!(
            [-300, 10, 15, 5, 400, 900].map(|v| stick.share(v)),
            [-1.0, 0.0, 0.0, 0.0, 1.0, 1.0]
        );
    }

    proptest! {
        #[test]
        fn a_share_never_steps_and_never_turns_back(
            from in -2000..2000_i32, span in 50..3000_i32, rest in prop::option::of(0.2..0.8_f64), dead in 0..20_i32,
        ) {
            let to = from + span;
            let rest = rest.map(|share| from + (f64::from(span) * share) as i32);
            let axis = AxisCalibration { ends: [from, to], rest, dead_counts: if rest.is_some() { dead.min(span / 10) } else { 0 } };
            let shares: Vec<f64> = (from - 10..=to + 10).map(|value| axis.share(value)).collect();
            for pair in shares.windows(2) {
                let step = pair[1] - pair[0];
                prop_assert!((0.0..0.25).contains(&step), "{step}");
            }
            prop_assert_eq!(*shares.last().expect("values"), 1.0);
            prop_assert_eq!(shares[0], if rest.is_some() { -1.0 } else { 0.0 });
        }
    }
}
