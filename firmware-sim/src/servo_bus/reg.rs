//! The registers a firmware itself works with, whatever their addresses are.
//!
//! Found in a profile by what they are for, or by the maker's name where no host needs to find them.

use device_profiles::{Register, Role, ServoProfile};

/// How a register is found.
#[derive(Clone, Copy, Debug)]
enum Key {
    For(Role),
    Named(&'static str),
}

macro_rules! known_registers {
    ($($variant:ident = $key:expr),* $(,)?) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Reg { $($variant),* }
        const KEYS: &[(Reg, Key)] = &[$((Reg::$variant, $key)),*];
    };
}

use Key::{For, Named};

known_registers! {
    ModelNumber = For(Role::ModelNumber),
    FirmwareVersion = For(Role::FirmwareVersion),
    FirmwareMinor = For(Role::FirmwareMinor),
    Id = For(Role::Id),
    BaudRate = For(Role::BaudRate),
    ReturnDelayTime = For(Role::ReturnDelay),
    StatusReturnLevel = For(Role::StatusReturnLevel),
    OperatingMode = For(Role::OperatingMode),
    HomingOffset = For(Role::HomingOffset),
    DriveMode = For(Role::DriveMode),
    Phase = For(Role::Phase),
    MinPosition = For(Role::MinPosition),
    MaxPosition = For(Role::MaxPosition),
    TemperatureLimit = For(Role::TemperatureLimit),
    MaxVoltageLimit = For(Role::MaxVoltage),
    MinVoltageLimit = For(Role::MinVoltage),
    VelocityLimit = For(Role::VelocityLimit),
    TorqueLimit = For(Role::TorqueLimit),
    Shutdown = For(Role::Shutdown),
    Lock = For(Role::Lock),
    TorqueEnable = For(Role::TorqueEnable),
    RegisteredInstruction = For(Role::Registered),
    HardwareErrorStatus = For(Role::HardwareError),
    PositionDGain = For(Role::PositionD),
    PositionIGain = For(Role::PositionI),
    PositionPGain = For(Role::PositionP),
    BusWatchdog = For(Role::BusWatchdog),
    GoalTorque = For(Role::GoalTorque),
    GoalVelocity = For(Role::GoalVelocity),
    GoalAcceleration = For(Role::GoalAcceleration),
    GoalTime = For(Role::GoalTime),
    ProfileAcceleration = For(Role::ProfileAcceleration),
    ProfileVelocity = For(Role::ProfileVelocity),
    GoalPosition = For(Role::GoalPosition),
    RealtimeTick = For(Role::RealtimeTick),
    Moving = For(Role::Moving),
    PresentCurrent = For(Role::PresentCurrent),
    PresentLoad = For(Role::PresentLoad),
    PresentVelocity = For(Role::PresentVelocity),
    PresentPosition = For(Role::PresentPosition),
    PresentInputVoltage = For(Role::PresentVoltage),
    PresentTemperature = For(Role::PresentTemperature),
    ShadowId = Named("Secondary(Shadow) ID"),
    MovingThreshold = Named("Moving Threshold"),
    CurrentLimit = Named("Current Limit"),
    StartupConfiguration = Named("Startup Configuration"),
    VelocityIGain = Named("Velocity I Gain"),
    VelocityPGain = Named("Velocity P Gain"),
    FeedforwardSecond = Named("Feedforward 2nd Gain"),
    FeedforwardFirst = Named("Feedforward 1st Gain"),
    GoalCurrent = Named("Goal Current"),
    MovingStatus = Named("Moving Status"),
    PresentPwm = Named("Present PWM"),
    VelocityTrajectory = Named("Velocity Trajectory"),
    PositionTrajectory = Named("Position Trajectory"),
    BackupReady = Named("Backup Ready"),
    TargetPosition = Named("Target Position"),
    Punch = Named("Punch"),
    StartupForce = Named("Minimum Startup Force"),
    ClockwiseSlope = Named("CW Compliance Slope"),
    AnticlockwiseSlope = Named("CCW Compliance Slope"),
    ClockwiseMargin = Named("CW Compliance Margin"),
    AnticlockwiseMargin = Named("CCW Compliance Margin"),
    ComplianceSlope = Named("CW Compliance Slope"),
    ClockwiseDeadZone = Named("CW Dead Zone"),
    AnticlockwiseDeadZone = Named("CCW Dead Zone"),
}

/// A few of the registers above.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Regs(u128);

impl Regs {
    pub(super) fn insert(&mut self, reg: Reg) {
        self.0 |= 1 << reg as u32;
    }

    pub(super) fn contains(self, reg: Reg) -> bool {
        self.0 >> reg as u32 & 1 == 1
    }

    pub(super) fn contains_any(self, regs: &[Reg]) -> bool {
        regs.iter().any(|&reg| self.contains(reg))
    }

    /// In the order of the list above.
    pub(super) fn iter(self) -> impl Iterator<Item = Reg> {
        KEYS.iter()
            .map(|&(reg, _)| reg)
            .filter(move |&reg| self.contains(reg))
    }
}

impl Reg {
    /// Where each register is among the rows of `profile`, in the order of the list above.
    pub(super) fn places(profile: &ServoProfile) -> Vec<Option<u16>> {
        let place = |holds: &dyn Fn(&Register) -> bool| {
            let found = profile.registers.iter().position(holds);
            found.map(|at| at as u16)
        };
        KEYS.iter()
            .map(|&(_, key)| match key {
                For(role) => place(&|row| row.role == Some(role)),
                Named(name) => place(&|row| row.name == name),
            })
            .collect()
    }

    /// The register whose row is `row`.
    pub(super) fn of_row(places: &[Option<u16>], row: u16) -> Option<Self> {
        let at = places.iter().position(|&place| place == Some(row))?;
        KEYS.get(at).map(|&(reg, _)| reg)
    }
}
