//! Why servos cannot be armed, in words that name the servo and the remedy.

use crate::servo::framing::StatusError;
use crate::servo::member::error_names;
use device_profiles::Role;

/// Why one servo cannot be armed, and what to do about it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("bus \"{bus}\", joint \"{joint}\", servo {id}: {why}")]
pub struct Refusal {
    /// The bus's name.
    pub bus: String,
    /// The joint's name.
    pub joint: String,
    /// The servo's id.
    pub id: u8,
    /// What is wrong and what helps.
    pub why: Why,
}

/// What is wrong with a servo that cannot be armed, or released.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Why {
    /// It did not answer, asked together with the others and alone.
    #[error(
        "does not answer; check its cable and power first, then its id and baud rate (`dialrig servo scan`)"
    )]
    Missing,
    /// Another model answers.
    #[error("is model {found}, the puppet expects {expected}; correct the puppet file or swap the servo")]
    Model {
        /// Model Number in the profile.
        expected: i64,
        /// Model Number read.
        found: i64,
    },
    /// Without Bus Watchdog a servo would run on when the host dies.
    #[error(
        "has firmware {found}; the Bus Watchdog needs {needed} or later: update it with the maker's tool"
    )]
    Firmware {
        /// First firmware that will do.
        needed: u8,
        /// Firmware Version read.
        found: i64,
    },
    /// A hardware error is latched.
    #[error("has a latched hardware error ({}); remove the cause, then reboot it (`dialrig servo doctor`)", error_names(*bits))]
    HardwareError {
        /// Hardware Error Status.
        bits: u8,
    },
    /// Too warm to start.
    #[error("is at {temperature_c} C, the limit is {limit_c} C; let it cool down")]
    Hot {
        /// Present Temperature.
        temperature_c: f64,
        /// The bus's limit.
        limit_c: f64,
    },
    /// It answered an instruction with an error.
    #[error("answered \"{error}\" to reading address {address}; check model and firmware")]
    Answer {
        /// What it said.
        error: StatusError,
        /// First byte read.
        address: u16,
    },
    /// A setting reads differently from what was written.
    #[error("keeps \"{register}\" at {found} instead of {wanted}; power it off and on, and try again")]
    Setting {
        /// What the row is for.
        register: Role,
        /// What was written.
        wanted: i64,
        /// What was read.
        found: i64,
    },
    /// The servo's own limits are narrower than the joint's range.
    #[error(
        "limits positions to {found_min} to {found_max} counts, the joint needs {needed_min} to {needed_max}; \
         widen its position limits or narrow the joint's range"
    )]
    Range {
        /// Min Position Limit read.
        found_min: i64,
        /// Max Position Limit read.
        found_max: i64,
        /// Lowest count of the joint's range.
        needed_min: i64,
        /// Highest count of the joint's range.
        needed_max: i64,
    },
    /// Its position cannot be a goal, so it cannot be held where it is.
    #[error(
        "stands at {counts} counts, outside the positions it accepts ({min} to {max}); turn it back by hand"
    )]
    Outside {
        /// Present Position.
        counts: i64,
        /// Min Position Limit.
        min: i64,
        /// Max Position Limit.
        max: i64,
    },
    /// It does not stand still.
    #[error("is moving; hold it still while arming")]
    Restless,
    /// Its clock says that its answers are old ones, again and again.
    #[error(
        "answers too late to be trusted; the computer or the adapter is busy: close other programs, look at the adapter's latency timer"
    )]
    Late,
    /// Torque is still on after it was switched off several times.
    #[error("still has torque after it was switched off; cut its power")]
    StillOn,
}
