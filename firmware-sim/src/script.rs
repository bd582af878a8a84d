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
}

impl Device {
    /// The SGI box: 8 dials, 32 buttons.
    pub const DIAL_BOX: Self = Self::Controls {
        dials: 8,
        buttons: 32,
        axes: 0,
    };
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
