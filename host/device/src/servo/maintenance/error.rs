//! Why maintenance could not do what was asked, in words that say what to do.

use crate::servo::framing::{FramingError, StatusError};
use crate::servo::register::RegisterError;
use crate::transport::TransportError;
use device_profiles::ServoProtocol;

/// Why maintenance could not do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum MaintenanceError {
    /// The line failed.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// No such register, or no such value.
    #[error(transparent)]
    Register(#[from] RegisterError),
    /// Not an id, or an instruction that the protocol does not have.
    #[error(transparent)]
    Framing(#[from] FramingError),
    /// Writing it could move the servo.
    #[error(
        "register \"{name}\" can move the servo and is not written here: goals and torque go through the player \
         (`dialrig play`), which limits them"
    )]
    Goal {
        /// The row.
        name: String,
    },
    /// Nothing came back.
    #[error(
        "servo {id} does not answer at {baud} baud; check cable and power, or look for it with a scan over bauds"
    )]
    Silent {
        /// The id.
        id: u8,
        /// The line speed in use.
        baud: u32,
    },
    /// The servo says no.
    #[error("servo {id} refused: {error}")]
    Refused {
        /// The id.
        id: u8,
        /// Its error byte.
        error: StatusError,
    },
    /// It was written, but reads otherwise.
    #[error("servo {id}: \"{name}\" reads {found} after {wanted} was written; power the servo off and on")]
    NotTaken {
        /// The id.
        id: u8,
        /// The row.
        name: String,
        /// Written.
        wanted: i64,
        /// Read.
        found: i64,
    },
    /// It answers as no family known does.
    #[error(
        "servo {id} answers in the frame of Dynamixel 1.0, but has its id where neither Dynamixel nor Feetech keep it; \
         say which protocol it speaks (--protocol)"
    )]
    Unidentified {
        /// The id.
        id: u8,
    },
    /// It is there, but speaks what was not asked for.
    #[error("servo {id} speaks {protocol}; give that as --protocol, or none")]
    OtherProtocol {
        /// The id.
        id: u8,
        /// What it speaks.
        protocol: ServoProtocol,
    },
    /// The EEPROM of an AX or MX(1.0) is locked.
    #[error("servo {id}: its EEPROM is locked; only switching its power off and on unlocks it")]
    Locked {
        /// The id.
        id: u8,
    },
    /// Torque stays on.
    #[error("servo {id} still has torque after it was switched off; cut its power")]
    TorqueOn {
        /// The id.
        id: u8,
    },
    /// Two servos would have one id.
    #[error("id {id} is in use on this line; choose a free one")]
    IdTaken {
        /// The id asked for.
        id: u8,
    },
    /// The model does not know that speed.
    #[error("{model} cannot speak at {baud} baud; it knows {known:?}")]
    NoSuchBaud {
        /// The servo profile's name.
        model: String,
        /// What was asked for.
        baud: u32,
        /// What there is.
        known: Vec<u32>,
    },
    /// Neither here nor there.
    #[error(
        "servo {id} is silent after it was told to speak at {to} baud, and silent at {from} baud too; power it off and \
         on, and look for it with a scan over bauds"
    )]
    Lost {
        /// The id.
        id: u8,
        /// Its speed before.
        from: u32,
        /// Its speed to be.
        to: u32,
    },
}
