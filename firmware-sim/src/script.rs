//! Hands from a text: what to do to a box of controls or a tablet, and when.
//!
//! Source: `docs/cli.md`, "Scripts". One action a line, `#` begins a comment, times in seconds since the
//! host first switched reporting on.

mod line;

use crate::hands::Touch;

/// The device a script is for; an action the device has no control for is an error in the script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Device {
    /// Dials, buttons, and controls with a place of their own, so many of each.
    Controls {
        /// Controls that `dial` turns.
        dials: u8,
        /// Controls that `button` presses.
        buttons: u8,
        /// Controls that `axis` moves.
        axes: u8,
    },
    /// Pen and puck.
    Tablet,
    /// A tablet with a pen and these controls on its pad.
    Pad {
        /// Keys.
        keys: u8,
        /// Rings and strips.
        rings: u8,
    },
    /// Whatever it is: what it has no control for it refuses itself.
    Any,
}

impl Device {
    /// The SGI box: 8 dials, 32 buttons.
    pub const DIAL_BOX: Self = Self::Controls {
        dials: 8,
        buttons: 32,
        axes: 0,
    };

    /// So many controls that `verb` is about; pens and pucks count as one.
    fn count(self, verb: &str) -> u8 {
        match (self, verb) {
            (Self::Any, _) => u8::MAX,
            (Self::Controls { dials, .. }, "dial") => dials,
            (Self::Controls { buttons, .. }, "button") => buttons,
            (Self::Controls { axes, .. }, "axis") => axes,
            (Self::Pad { keys, .. }, "button") => keys,
            (Self::Pad { rings, .. }, "ring") => rings,
            (Self::Tablet | Self::Pad { .. }, "pen") | (Self::Tablet, "puck") => 1,
            _ => 0,
        }
    }
}

/// Reads what one hand does, in the words of a script without the time, for a device that may have any controls.
pub fn touch(text: &str) -> Result<Touch, ScriptError> {
    const TIME: &str = "at 0 ";
    let flaw = |column: u32, message: String| ScriptError {
        line: 1,
        column: column.saturating_sub(TIME.len() as u32).max(1),
        message,
    };
    match line::parse(Device::Any, &format!("{TIME}{text}")) {
        Ok(Some(action)) => Ok(action.touch),
        Ok(None) => Err(flaw(0, "expected an action".to_owned())),
        Err(fault) => Err(flaw(fault.column, fault.message)),
    }
}

/// One line of a script.
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// Microseconds since reporting began.
    pub at_us: u64,
    /// What is done.
    pub touch: Touch,
}

/// Actions in order of time; lines of the same time keep their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Script {
    /// What to do when.
    pub actions: Vec<Action>,
}

/// Something a script says that cannot be done.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{line}:{column}: {message}")]
pub struct ScriptError {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
    /// What was expected and what was found.
    pub message: String,
}

impl Script {
    /// Reads a script for `device`. On failure gives every error, not only the first.
    pub fn parse(device: Device, text: &str) -> Result<Self, Vec<ScriptError>> {
        let mut actions = Vec::new();
        let mut errors = Vec::new();
        for (number, text) in (1..).zip(text.lines()) {
            match line::parse(device, text) {
                Ok(Some(action)) => actions.push(action),
                Ok(None) => {}
                Err(fault) => {
                    errors.push(ScriptError {
                        line: number,
                        column: fault.column,
                        message: fault.message,
                    });
                }
            }
        }
        actions.sort_by_key(|action| action.at_us);
        if errors.is_empty() {
            Ok(Self { actions })
        } else {
            Err(errors)
        }
    }
}

#[cfg(test)]
mod tests;
