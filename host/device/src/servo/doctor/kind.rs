//! Everything the doctor can find, by name: what it is called, what it means, what it costs, what helps.
//!
//! `docs/doctor.md` has this table; a test keeps the two alike.

/// A kind of finding. The order is that of reports: what stops everything comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// There is no such port.
    PortMissing,
    /// The user may not open it.
    PortForbidden,
    /// Somebody else has it open.
    PortBusy,
    /// Nobody answers at all.
    SilentLine,
    /// Servos answer, but at another line speed.
    OtherBaud,
    /// Everybody up to one place of the chain answers, nobody behind it.
    Cable,
    /// A servo of the puppet does not answer.
    MissingServo,
    /// Two servos have one id.
    DuplicateId,
    /// One servo as it came out of its box, in place of the one that is missing.
    FactoryFresh,
    /// Another model than the profile says.
    WrongModel,
    /// A model nobody has described.
    UnknownModel,
    /// A servo that the puppet does not have.
    UnexpectedServo,
    /// The adapter keeps answers back.
    AdapterLatency,
    /// The adapter hears itself.
    Echo,
    /// Packets are damaged or lost.
    Noise,
    /// The line runs slower than its servos could.
    SlowBaud,
    /// A servo waits before it answers.
    ReturnDelay,
    /// A servo does not answer everything.
    StatusLevel,
    /// Firmware lacks what makes cycles fast or safe.
    OldFirmware,
    /// One model, several firmwares.
    MixedFirmware,
    /// Not a mode in which it goes to positions.
    OperatingMode,
    /// Reversed, timed, or switched on by its goals.
    DriveMode,
    /// The EEPROM's lock is not as it should stand.
    Lock,
    /// The count jumps inside the joint's travel.
    Wrap,
    /// A homing offset without effect.
    HomingOffset,
    /// The servo refuses part of the joint's travel.
    LimitsInside,
    /// The servo refuses all of the joint's travel.
    LimitsOutside,
    /// The joint stands where the puppet's profile does not let it be.
    OutOfRange,
    /// Too few volts.
    LowVoltage,
    /// The supply is for another model.
    WrongSupply,
    /// The voltage breaks down under load, or along the cable.
    VoltageSag,
    /// Close to the temperature at which it switches itself off.
    Hot,
    /// An error that the servo keeps until it is restarted.
    HardwareError,
}

/// What is always true of a kind, in words.
struct About {
    kind: Kind,
    name: &'static str,
    meaning: &'static str,
    costs: &'static str,
    remedy: &'static str,
    /// Whether `--fix` mends it.
    fixable: bool,
}

const fn about(
    kind: Kind,
    name: &'static str,
    meaning: &'static str,
    costs: &'static str,
    remedy: &'static str,
    fixable: bool,
) -> About {
    About {
        kind,
        name,
        meaning,
        costs,
        remedy,
        fixable,
    }
}

#[rustfmt::skip]
const ALL: &[About] = {
    use Kind::{
        AdapterLatency, Cable, DriveMode, DuplicateId, Echo, FactoryFresh, HardwareError, HomingOffset, Hot,
        LimitsInside, LimitsOutside, Lock, LowVoltage, MissingServo, MixedFirmware, Noise, OldFirmware,
        OperatingMode, OtherBaud, OutOfRange, PortBusy, PortForbidden, PortMissing, ReturnDelay, SilentLine,
        SlowBaud, StatusLevel, UnexpectedServo, UnknownModel, VoltageSag, Wrap, WrongModel, WrongSupply,
    };
    &[
        about(PortMissing, "port-missing", "there is no such port", "nothing can be done on this bus",
            "plug the adapter in; list ports with `dialrig devices`", false),
        about(PortForbidden, "port-forbidden", "this user may not open the port", "nothing can be done on this bus",
            "join the port's group, or install the udev rule that is printed", false),
        about(PortBusy, "port-busy", "another program has the port open", "nothing can be done on this bus",
            "close that program; `fuser PORT` names it", false),
        about(SilentLine, "silent-line", "no servo answers at any line speed", "the puppet cannot move",
            "switch the supply on; check the first cable and which connector of the adapter it is in", false),
        about(OtherBaud, "other-baud", "servos answer at another line speed than the bus's", "they are not there for the player",
            "set the bus's speed in the profile, or theirs", false),
        about(Cable, "cable", "the chain answers up to one place and not behind it", "every joint behind it is limp and unseen",
            "press the plugs between the two joints named; change that cable", false),
        about(MissingServo, "missing-servo", "one servo of the puppet does not answer", "arming is refused; the joint is limp",
            "check its plug and its id", false),
        about(DuplicateId, "duplicate-id", "answers to one id are garbled although the line is clean: two servos have it",
            "both joints get each other's goals", "unplug one of them and give it another id", false),
        about(FactoryFresh, "factory-fresh", "a servo with the factory's id and speed, of the one model that is missing",
            "the joint is limp until it is adopted", "give it the joint's id and the bus's speed", false),
        about(WrongModel, "wrong-model", "another model than the profile says", "other gears, limits and registers: goals would be wrong",
            "correct the model in the profile, or change the servo", false),
        about(UnknownModel, "unknown-model", "a model number without a profile", "its registers are not known: it is left alone",
            "add a servo profile to the user's folder", false),
        about(UnexpectedServo, "unexpected-servo", "a servo that the puppet's profile does not have", "it stays limp, or holds on to whatever it was told last",
            "unplug it, add it to the profile, or give it the id of a missing joint", false),
        about(AdapterLatency, "adapter-latency", "the adapter keeps the end of an answer back", "up to that time in every cycle",
            "set the latency timer to 1 ms", true),
        about(Echo, "echo", "the adapter hears its own bytes", "the host reads everything twice; harmless, but wire and CPU time",
            "tie the receiver's enable to the driver's, or use an adapter with automatic direction", false),
        about(Noise, "noise", "packets are damaged or lost", "joints go on with old measurements; many in a row stop the show",
            "shorten or twist the cable, check ground, keep it away from motors, add power at the far end", false),
        about(SlowBaud, "slow-baud", "the line is slower than all its servos could be", "fewer cycles in a second",
            "raise the speed of all servos and of the bus in the profile", false),
        about(ReturnDelay, "return-delay", "a servo waits before it answers", "that time for every servo in every cycle",
            "set it to 0", true),
        about(StatusLevel, "status-level", "a servo does not confirm writes", "refused settings and torque switched off go unnoticed",
            "set the level to answer everything", false),
        about(OldFirmware, "old-firmware", "firmware without fast reads or without the bus watchdog", "longer cycles; a servo that goes on moving when the host is lost",
            "update it with the maker's tool", false),
        about(MixedFirmware, "mixed-firmware", "one model with several firmwares", "the slowest common way is used; registers may differ",
            "bring all to the newest with the maker's tool", false),
        about(OperatingMode, "operating-mode", "not in a mode that goes to positions", "goals are ignored, or taken as speeds",
            "set the operating mode to position", false),
        about(DriveMode, "drive-mode", "reversed, timed or counting turns by its own settings", "it moves the wrong way, at other speeds, or at once",
            "set it back to the factory's value", false),
        about(Lock, "lock", "the EEPROM's lock is not as it should stand", "settings are lost at power-off, or every stray write is kept",
            "lock it, or switch power off and on", true),
        about(Wrap, "wrap", "the count jumps from its last value to its first inside the joint's travel", "a full turn the wrong way at the jump",
            "move the jump out of the travel: by the homing offset, or by mounting the horn anew", false),
        about(HomingOffset, "homing-offset", "a homing offset beyond what the servo applies", "positions are off by that much",
            "set it to 0 and calibrate", false),
        about(LimitsInside, "limits-inside", "the servo's limits cut into the joint's range", "goals there are refused: the joint stops short",
            "widen the servo's limits or narrow the joint's range", false),
        about(LimitsOutside, "limits-outside", "the servo's limits do not meet the joint's range at all", "no goal is accepted",
            "calibrate the joint", false),
        about(OutOfRange, "out-of-range", "the joint stands outside its range", "arming is refused until it is inside",
            "move it by hand, or calibrate", false),
        about(LowVoltage, "low-voltage", "too few volts at the servo", "weak and slow; restarts under load",
            "use the supply the model is made for; add power along the chain", false),
        about(WrongSupply, "wrong-supply", "the supply is for another model", "it can burn the servo",
            "switch off now; use the supply the model is made for", false),
        about(VoltageSag, "voltage-sag", "the voltage breaks down under load or along the chain", "servos restart or shut down in the middle of a show",
            "a stronger supply, thicker cable, power every 10 to 15 servos", false),
        about(Hot, "hot", "close to the temperature at which it switches itself off", "the joint goes limp in the middle of a show",
            "let it cool; look for a load or a jam", false),
        about(HardwareError, "hardware-error", "an error that the servo keeps", "no torque until it is restarted",
            "find the cause, then restart it", false),
    ]
};

impl Kind {
    /// All kinds, in the order of reports.
    pub fn all() -> impl Iterator<Item = Self> {
        ALL.iter().map(|about| about.kind)
    }

    fn about(self) -> &'static About {
        // Every kind has its row: a test counts them, and the order is the enum's own.
        &ALL[self as usize]
    }

    /// Its name in reports and on the page, such as `return-delay`.
    pub fn name(self) -> &'static str {
        self.about().name
    }

    /// What is wrong, in general.
    pub fn meaning(self) -> &'static str {
        self.about().meaning
    }

    /// What it costs, in general.
    pub fn costs(self) -> &'static str {
        self.about().costs
    }

    /// What helps, in general.
    pub fn remedy(self) -> &'static str {
        self.about().remedy
    }

    /// Whether the doctor can mend it.
    pub fn is_fixable(self) -> bool {
        self.about().fixable
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_its_row_and_a_name_of_its_own() {
        let names: std::collections::BTreeSet<_> = Kind::all().map(Kind::name).collect();
        assert_eq!(names.len(), ALL.len());
        assert_eq!(ALL.len(), Kind::HardwareError as usize + 1);
        for (place, kind) in Kind::all().enumerate() {
            assert_eq!(kind as usize, place, "{kind:?}");
        }
    }
}
