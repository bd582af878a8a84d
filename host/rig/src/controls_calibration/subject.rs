//! What is to be known of a device to calibrate it.

use device_profiles::{ControlClass, ControlKind};

use super::measure::Sweeping;
use super::tablet::Sheet;
use super::{AxisCalibration, ControlsCalibration};

/// The device, the control if it is one, and what holds so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Subject {
    /// What the rig calls the device.
    pub device: String,
    /// The control; none where its surface is meant.
    pub control: Option<Control>,
    /// Its tablet, if it is one and has said how large it is.
    pub sheet: Option<Sheet>,
    /// Its tablet's full pressure, counts; 0 where it tells none.
    pub pressure_max: u32,
    /// What was calibrated before.
    pub holds: ControlsCalibration,
}

/// One control, as the profile has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    /// Of its output, from 1.
    pub number: u8,
    /// What the profile calls it.
    pub name: String,
    /// What it is.
    pub kind: ControlKind,
    /// Among those of its class, from 0: as events number it.
    pub of_class: u16,
    /// Counts at its ends.
    pub range: [i32; 2],
    /// Changes below this are noise, which it does not tell.
    pub noise_counts: i32,
    /// Counts in a turn.
    pub counts_per_turn: f64,
    /// Where it said it is; none before it said.
    pub at: Option<i32>,
}

impl Control {
    /// Its travel so far: what says nothing while it rests has said where that is.
    pub(super) fn resting(&self) -> Sweeping {
        let mut sweeping = Sweeping::default();
        if let Some(at) = self.at {
            sweeping.moved(at);
        }
        sweeping
    }
}

impl Subject {
    pub(super) fn dial(&self) -> Result<&Control, String> {
        let control = self.control()?;
        if control.kind.class() == ControlClass::Dial {
            return Ok(control);
        }
        Err(format!("{}; only dials have turns to count", self.is_a(control)))
    }

    pub(super) fn axis(&self) -> Result<&Control, String> {
        let control = self.control()?;
        if control.kind.class() == ControlClass::Axis {
            return Ok(control);
        }
        Err(format!(
            "{}; only faders, knobs and axes have ends",
            self.is_a(control)
        ))
    }

    pub(super) fn sprung(&self) -> Result<&Control, String> {
        let control = self.control()?;
        if control.kind == ControlKind::Axis {
            return Ok(control);
        }
        Err(format!("{}; only axes spring back", self.is_a(control)))
    }

    pub(super) fn tablet(&self) -> Result<Sheet, String> {
        self.sheet.ok_or_else(|| {
            format!(
                "{} is no tablet, or has not said how large it is yet",
                self.device
            )
        })
    }

    fn control(&self) -> Result<&Control, String> {
        self.control
            .as_ref()
            .ok_or_else(|| format!("{} has no such control", self.device))
    }

    fn is_a(&self, control: &Control) -> String {
        let word = control.kind.word();
        format!("{} of {} is a {word}", control.name, self.device)
    }
}

impl Control {
    /// Counts of a turn as they hold now.
    pub(super) fn per_turn(&self, holds: &ControlsCalibration) -> f64 {
        let known = holds.dials.get(&self.of_class);
        known.copied().unwrap_or(self.counts_per_turn)
    }

    /// Ends and rest as they hold now.
    pub(super) fn axis(&self, holds: &ControlsCalibration) -> AxisCalibration {
        let built = AxisCalibration {
            ends: self.range,
            rest: None,
            dead_counts: 0,
        };
        holds.axes.get(&self.of_class).copied().unwrap_or(built)
    }
}
