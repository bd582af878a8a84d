//! What a receiver has made out of the bytes on the wire, and what it asks for, whatever the framing was.

/// Addresses every servo at once, in every protocol.
pub(super) const BROADCAST: u8 = 254;

/// The two ways a packet is put together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Framing {
    /// DYNAMIXEL 2.0.
    Dynamixel2,
    /// DYNAMIXEL 1.0 and Feetech.
    Summed,
}

/// A packet just completed. Its parameters are with the receiver until the next byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Heard {
    pub(super) framing: Framing,
    /// When its first byte was complete.
    pub(super) began_ns: u64,
    pub(super) id: u8,
    /// None: the checksum was wrong.
    pub(super) instruction: Option<u8>,
}

/// What a packet asks of a servo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order<'a> {
    Ping,
    Read {
        address: u16,
        length: u16,
    },
    Write {
        address: u16,
        bytes: &'a [u8],
    },
    /// A write that waits for `Action`.
    Register {
        address: u16,
        bytes: &'a [u8],
    },
    Action,
    FactoryReset(Scope),
    Reboot,
    /// Forget whole turns.
    ClearTurns,
    /// Keep a copy of the table.
    Backup,
    /// Bring the copy back.
    Restore,
    /// From here on the present position reads so many counts.
    Calibrate(u16),
    /// A known instruction whose parameters are too few or too many.
    Malformed,
    /// A known instruction with parameters it does not take.
    Refused,
    /// No instruction of this protocol.
    Unknown,
}

/// What a factory reset leaves alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scope {
    All,
    KeepId,
    KeepIdAndBaud,
}

/// Kinds of instruction that Status Return Level tells apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    Ping,
    Read,
    Other,
}

impl Order<'_> {
    pub(super) fn class(&self) -> Class {
        match self {
            Self::Ping => Class::Ping,
            Self::Read { .. } => Class::Read,
            _ => Class::Other,
        }
    }
}

/// Why a servo does not do what it was told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    /// It could not.
    Fail,
    /// There is no such instruction, or nothing is registered.
    Instruction,
    /// The packet was spoilt.
    Checksum,
    /// A value outside what the register takes.
    Range,
    /// Too few or too many bytes.
    Length,
    /// A value outside a limit the user has set.
    Limit,
    /// Read only, undefined, or locked.
    Access,
}
