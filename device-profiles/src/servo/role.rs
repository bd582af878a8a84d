//! What a register is for, whatever its maker calls it.
//!
//! Hosts find registers by role: "Moving Speed", "Goal Velocity" and "Goal_Speed" are one thing in three
//! languages. A servo has the roles it has, each at most once.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The purpose of one row of a control table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// Which model this is; a ping answers it on DYNAMIXEL.
    ModelNumber,
    /// The firmware's version; on Feetech its part before the point.
    FirmwareVersion,
    /// The part of the firmware's version after the point.
    FirmwareMinor,
    /// The address on the bus.
    Id,
    /// Code of the line speed (see [`crate::ServoProfile::baud_code`]).
    BaudRate,
    /// How long a servo waits before it answers.
    ReturnDelay,
    /// Which instructions are answered.
    StatusReturnLevel,
    /// Position, velocity, current, ...; the codes are the family's own.
    OperatingMode,
    /// What is added to (DYNAMIXEL) or taken from (Feetech) the shaft's count to give Present Position.
    HomingOffset,
    /// DYNAMIXEL X: bit 0 reverses, bit 2 times moves, bit 3 lets a goal switch torque on.
    DriveMode,
    /// Feetech: bit 4 counts several turns, bit 2 picks the unit of speed.
    Phase,
    /// Smallest goal position that is accepted.
    MinPosition,
    /// Largest goal position that is accepted.
    MaxPosition,
    /// The servo switches itself off above it.
    TemperatureLimit,
    /// Voltage above which the servo complains.
    MaxVoltage,
    /// Voltage below which the servo complains.
    MinVoltage,
    /// Largest goal velocity that is accepted.
    VelocityLimit,
    /// Largest effort ever, kept without power; a share of all there is.
    TorqueLimit,
    /// Which faults switch torque off; bits as in `hardware-error` where the family has both.
    Shutdown,
    /// Protects the EEPROM; the family's own rules.
    Lock,
    /// 1 drives the shaft, 0 lets it turn freely.
    TorqueEnable,
    /// Whether a registered write waits for its action.
    Registered,
    /// Which faults there are, one bit each.
    HardwareError,
    /// Where to go.
    GoalPosition,
    /// Speed to turn at in velocity mode. Without a `profile-velocity` row also the speed of a move to a position.
    GoalVelocity,
    /// How fast speed changes. Without a `profile-acceleration` row also that of a move to a position.
    GoalAcceleration,
    /// How long a move shall take.
    GoalTime,
    /// Effort that may be spent now, in position mode too; a share of all there is.
    GoalTorque,
    /// Speed of a move to a position; 0: as fast as the servo can.
    ProfileVelocity,
    /// Acceleration of a move to a position; 0: at once.
    ProfileAcceleration,
    /// Silence on the bus after which the servo stops by itself.
    BusWatchdog,
    /// The servo's own clock.
    RealtimeTick,
    /// Whether a move is under way.
    Moving,
    /// Where the shaft is.
    PresentPosition,
    /// How fast it turns.
    PresentVelocity,
    /// The motor's current, measured.
    PresentCurrent,
    /// Effort, inferred; a share of all there is.
    PresentLoad,
    /// Supply voltage at the servo.
    PresentVoltage,
    /// Temperature inside.
    PresentTemperature,
    /// The lamp.
    Led,
    /// Proportional gain of the position loop.
    PositionP,
    /// Integral gain of the position loop.
    PositionI,
    /// Differential gain of the position loop.
    PositionD,
}

impl std::str::FromStr for Role {
    type Err = serde::de::value::Error;

    /// The word of the files.
    fn from_str(word: &str) -> Result<Self, Self::Err> {
        Self::deserialize(serde::de::IntoDeserializer::into_deserializer(word))
    }
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The word of the files: a formatter is serde's serializer of unit variants.
        self.serialize(f)
    }
}
