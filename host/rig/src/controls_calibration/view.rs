//! A calibration as windows see it: what the hand is to do, and a live picture's numbers.

use super::{AxisCalibration, PressureCurve, TabletMapping};

/// A calibration on its way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CalibrationView {
    /// The device.
    pub device: String,
    /// The control by the number of its output; none for a tablet's surface.
    pub control: Option<u8>,
    /// What is calibrated, in words: the control's name, `area`, `pressure`.
    pub what: String,
    /// Which step it is at, from 1; the last is keeping the result.
    pub step: u8,
    /// How many there are.
    pub steps: u8,
    /// What the hand is to do now.
    pub instruction: String,
    /// What was seen so far.
    pub seen: String,
    /// What came of it; it is kept by [`super::CalibrateControl::Take`].
    pub result: Option<String>,
    /// What holds until then, and again if it is not kept.
    pub replaces: String,
    /// What was wrong with the last step; it is to be done again.
    pub fault: Option<String>,
    /// The same in numbers.
    pub measured: Measured,
}

/// What was measured, what holds, and what would.
#[derive(Clone, Debug, PartialEq)]
pub enum Measured {
    /// A dial.
    Turn {
        /// Counts since the step began, clockwise positive.
        counts: i64,
        /// Turns the hand is to make.
        turns: u32,
        /// Counts in a turn that hold.
        holds: f64,
        /// Counts in a turn that were measured.
        proposed: Option<f64>,
    },
    /// A fader, knob or axis. All in counts.
    Travel {
        /// The profile's range.
        range: [i32; 2],
        /// Where it is.
        at: Option<i32>,
        /// The lowest and highest so far.
        seen: Option<[i32; 2]>,
        /// Where it came to rest.
        rests: Vec<i32>,
        /// What holds.
        holds: AxisCalibration,
        /// What was measured.
        proposed: Option<AxisCalibration>,
    },
    /// A tablet's area, in millimetres from the sheet's upper left corner, y down.
    Area {
        /// The sheet.
        size_mm: [f64; 2],
        /// Where the tool is.
        at_mm: Option<[f64; 2]>,
        /// Corners touched so far.
        touched_mm: Vec<[f64; 2]>,
        /// What holds.
        holds: TabletMapping,
        /// What was measured.
        proposed: Option<TabletMapping>,
    },
    /// A pen's pressure, in shares of the tablet's own full pressure.
    Pressure {
        /// How hard it is pressed.
        at: Option<f64>,
        /// The most of each step so far: hovering, lightly, hard.
        most: [Option<f64>; 3],
        /// What holds.
        holds: PressureCurve,
        /// What was measured.
        proposed: Option<PressureCurve>,
    },
}

impl Default for Measured {
    fn default() -> Self {
        Self::Turn {
            counts: 0,
            turns: 1,
            holds: 0.0,
            proposed: None,
        }
    }
}
