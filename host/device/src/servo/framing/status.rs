//! Answers and their error byte, which each protocol reads in its own way.
//!
//! Sources: ROBOTIS e-manual, "DYNAMIXEL Protocol 1.0" and "2.0", status packet; for Feetech the users' protocol
//! notes: its bits report the servo's state, and the instruction is carried out all the same.

use device_profiles::ServoProtocol;
use std::fmt;

/// An answer, taken apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Status<'a> {
    /// Who answers.
    pub id: u8,
    /// What is wrong, if anything.
    pub error: StatusError,
    /// The data behind the error byte, unstuffed.
    pub data: &'a [u8],
}

/// The error byte of an answer. Part of it says that the servo did not do what was asked
/// ([`StatusError::number`]), part of it how the servo is while it obeys ([`StatusError::alert`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StatusError {
    protocol: ServoProtocol,
    raw: u8,
}

/// Protocol 1.0: checksum, range, instruction, and a goal outside the angle limits.
const REFUSED_1: u8 = 0b0101_1010;
/// Protocol 1.0: voltage, overheating, overload.
const ALARMS_1: u8 = 0b0010_0101;

impl StatusError {
    /// The error byte as received.
    pub fn new(protocol: ServoProtocol, raw: u8) -> Self {
        Self { protocol, raw }
    }

    /// As received.
    pub fn raw(self) -> u8 {
        self.raw
    }

    /// The servo reports that something is wrong with itself; what it says is good all the same.
    pub fn alert(self) -> bool {
        match self.protocol {
            ServoProtocol::Dynamixel2 => self.raw & 0x80 != 0,
            ServoProtocol::Dynamixel1 => self.raw & ALARMS_1 != 0,
            ServoProtocol::Sts | ServoProtocol::Scs => self.raw != 0,
        }
    }

    /// 0 when the instruction was carried out; else the e-manual's number (2.0), or the bits that say why
    /// not (1.0). Feetech never refuses.
    pub fn number(self) -> u8 {
        match self.protocol {
            ServoProtocol::Dynamixel2 => self.raw & 0x7f,
            ServoProtocol::Dynamixel1 => self.raw & REFUSED_1,
            ServoProtocol::Sts | ServoProtocol::Scs => 0,
        }
    }

    /// Whether the servo says that it did not do what was asked.
    pub fn is_refusal(self) -> bool {
        self.number() != 0
    }

    /// The bits that are set, by the maker's meaning. Empty for protocol 2.0, which numbers its errors.
    fn bits(self) -> &'static [&'static str; 8] {
        const NONE: [&str; 8] = [""; 8];
        const DYNAMIXEL: [&str; 8] = [
            "input voltage out of its limits",
            "goal outside the angle limits",
            "too hot",
            "value out of range",
            "wrong checksum",
            "overload",
            "unknown instruction, or action without anything registered",
            "unknown error bit 7",
        ];
        const FEETECH: [&str; 8] = [
            "voltage out of its limits",
            "encoder or angle error",
            "too hot",
            "current too high",
            "unknown error bit 4",
            "overload",
            "unknown error bit 6",
            "unknown error bit 7",
        ];
        match self.protocol {
            ServoProtocol::Dynamixel2 => &NONE,
            ServoProtocol::Dynamixel1 => &DYNAMIXEL,
            ServoProtocol::Sts | ServoProtocol::Scs => &FEETECH,
        }
    }
}

/// In words: "data range error", "overload and too hot", "no error".
impl fmt::Display for StatusError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.protocol == ServoProtocol::Dynamixel2 {
            f.write_str(number_in_words(self.number()))?;
            return if self.alert() {
                f.write_str(", and a hardware error is latched")
            } else {
                Ok(())
            };
        }
        let mut words = (0..8)
            .zip(self.bits())
            .filter(|(bit, _)| self.raw >> bit & 1 == 1);
        let Some((_, first)) = words.next() else {
            return f.write_str("no error");
        };
        f.write_str(first)?;
        words.try_for_each(|(_, word)| write!(f, ", {word}"))
    }
}

/// The e-manual's table of error numbers of protocol 2.0, with what they mean.
fn number_in_words(number: u8) -> &'static str {
    match number {
        0 => "no error",
        1 => "result fail: the servo could not process the packet",
        2 => "instruction error: not defined, or action without anything registered",
        3 => "CRC error: the packet arrived damaged",
        4 => "data range error: the value is outside the register's range",
        5 => "data length error: the data are shorter than the register",
        6 => "data limit error: the value is outside the limit that another register sets",
        7 => "access error: read only, undefined, or EEPROM while torque is on",
        _ => "unknown error number",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ServoProtocol::{Dynamixel1, Dynamixel2, Scs, Sts};

    #[test]
    fn refusals_and_alarms_are_told_apart() {
        for (protocol, raw, number, alert, words) in [
            (Dynamixel2, 0x00, 0, false, "no error"),
            (
                Dynamixel2,
                0x80,
                0,
                true,
                "no error, and a hardware error is latched",
            ),
            (
                Dynamixel2,
                0x84,
                4,
                true,
                "data range error: the value is outside the register's range, and a hardware error is latched",
            ),
            (Dynamixel1, 0x24, 0, true, "too hot, overload"),
            (Dynamixel1, 0x08, 8, false, "value out of range"),
            (
                Dynamixel1,
                0x41,
                0x40,
                true,
                "input voltage out of its limits, unknown instruction, or action without anything registered",
            ),
            (Sts, 0x20, 0, true, "overload"),
            (Scs, 0x00, 0, false, "no error"),
        ] {
            let error = StatusError::new(protocol, raw);
            assert_eq!(
                (error.number(), error.alert()),
                (number, alert),
                "{protocol:?} {raw:02x}"
            );
            assert_eq!(error.to_string(), words);
            assert_eq!(error.is_refusal(), number != 0);
        }
    }
}
