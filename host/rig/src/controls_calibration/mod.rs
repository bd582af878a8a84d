//! Calibration of controls: what lies between a device's counts and what the network is told, per device, measured
//! with a hand on it.
//!
//! *Knows* how counts become places and shares: a tablet's area, turn, mirror and pressure ([`tablet`], [`pressure`]),
//! counts in a dial's turn, ends of faders and the rest of what springs back ([`measure`]); the steps a person goes
//! through ([`flow`], `told`, `propose`); and where it is kept ([`store`]). Pure but for the store: counts in, numbers out.
//! *Must not know* wires, profiles' formats, or what a control drives.
//! *Start reading* at [`ControlsCalibration`], then [`flow`]; `controls` applies what is here, `rig::calibrate` connects it.

pub mod command;
pub mod flow;
pub mod measure;
pub mod pressure;
mod propose;
pub mod store;
pub mod subject;
pub mod tablet;
mod told;
pub mod view;

use std::collections::BTreeMap;

use device_profiles::ControlClass;
use serde::{Deserialize, Serialize};

pub use command::CalibrateControl;
pub use flow::Calibrating;
pub use pressure::PressureCurve;
pub use store::Store;
pub use subject::Subject;
pub use tablet::{Area, Sheet, TabletMapping};
pub use view::{CalibrationView, Measured};

/// Counts in a turn that a dial may have, either way round.
const PER_TURN: std::ops::RangeInclusive<f64> = 1.0..=1e7;

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

    /// One control is as the profile has it.
    pub fn forget(&mut self, class: ControlClass, control: u16) {
        match class {
            ControlClass::Dial => drop(self.dials.remove(&control)),
            ControlClass::Axis => drop(self.axes.remove(&control)),
            ControlClass::Button | ControlClass::Ring => {}
        }
    }

    /// What is wrong with it, of what came from a file; `None` if nothing is.
    pub fn unsound(&self) -> Option<String> {
        for (control, per_turn) in &self.dials {
            if !PER_TURN.contains(&per_turn.abs()) {
                let (least, most) = (PER_TURN.start(), PER_TURN.end());
                return Some(format!(
                    "dial {control}: counts in a turn must be {least} to {most} either way, found {per_turn}"
                ));
            }
        }
        for (control, axis) in &self.axes {
            if axis.ends[0] == axis.ends[1] {
                return Some(format!("axis {control}: its ends must differ"));
            }
            if axis.dead_counts < 0 {
                return Some(format!(
                    "axis {control}: a quiet middle cannot be less than nothing"
                ));
            }
        }
        self.tablet.as_ref().and_then(TabletMapping::unsound)
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
    fn what_would_divide_by_nothing_is_unsound() {
        let dial = |per_turn| ControlsCalibration {
            dials: BTreeMap::from([(3, per_turn)]),
            ..ControlsCalibration::default()
        };
        assert_eq!((dial(200.0).unsound(), dial(-256.0).unsound()), (None, None));
        for per_turn in [0.0, -0.5, f64::NAN, f64::INFINITY] {
            assert!(dial(per_turn).unsound().is_some(), "{per_turn}");
        }
        let axis = |ends, dead_counts| ControlsCalibration {
            axes: BTreeMap::from([(
                0,
                AxisCalibration {
                    ends,
                    rest: None,
                    dead_counts,
                },
            )]),
            ..ControlsCalibration::default()
        };
        assert_eq!(axis([1000, 0], 0).unsound(), None);
        assert!(axis([5, 5], 0).unsound().is_some() && axis([0, 5], -1).unsound().is_some());
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
