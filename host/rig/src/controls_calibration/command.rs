//! What is asked of a calibration of controls.

use serde::{Deserialize, Serialize};

use super::TabletMapping;

/// One request. Devices go by the name in [`crate::DeviceView::name`], controls by the number of their output in the
/// network ([`crate::ControlView::number`]). None of it is a step of undo: it says how a device is, not what a show
/// is, and it is kept with the device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CalibrateControl {
    /// Counts in a dial's turn, by turning it round.
    Dial {
        /// The device.
        device: String,
        /// The dial, from 1.
        control: u8,
        /// Whole turns that will be made; more are more exact.
        #[serde(default = "one")]
        turns: u32,
    },
    /// Ends of a fader, knob or axis, by moving it from one to the other.
    Ends {
        /// The device.
        device: String,
        /// The control, from 1.
        control: u8,
    },
    /// Rest of an axis, by letting go of it a few times; its ends must be known or are the profile's.
    Rest {
        /// The device.
        device: String,
        /// The axis, from 1.
        control: u8,
    },
    /// A tablet's area, by touching two opposite corners of it.
    Corners {
        /// The device.
        device: String,
    },
    /// A pen's pressure: hovering, lightly, as hard as it will be pressed.
    Pressure {
        /// The device.
        device: String,
    },
    /// A tablet's mapping outright: turn, mirror, aspect, or anything of it. Holds at once.
    Tablet {
        /// The device.
        device: String,
        /// All of it.
        mapping: TabletMapping,
    },
    /// The hand is done with this step: on to the next, or to the result.
    Next,
    /// Keeps the result.
    Take,
    /// Forgets it; what was before stays.
    Cancel,
    /// Back to the profile's values.
    Forget {
        /// The device.
        device: String,
        /// One control, from 1; all of the device unless said.
        #[serde(default)]
        control: Option<u8>,
    },
}

fn one() -> u32 {
    1
}
