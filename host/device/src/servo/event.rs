//! What goes between a bus and whoever drives it: wishes, answers to them, and what was found out.

use super::limit::Change;

/// What somebody would like.
#[derive(Debug, Clone, Copy)]
pub enum Goal<'a> {
    /// An angle for each member, in member order; limited before it is sent.
    Positions(&'a [f64]),
    /// The shortest stop of every member.
    Standstill,
}

/// What the limits changed about one member's goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Intervention {
    /// Place in member order.
    pub member: usize,
    /// What was changed.
    pub change: Change,
}

/// What became of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Commanded {
    /// Goals were limited and sent.
    Sent,
    /// Answers are still on the wire: nothing was sent, and the goals did not move.
    Busy,
    /// The pause was so long that the servos' watchdogs have stopped them: they are measured and pinned
    /// again, and goals are taken when [`super::Bus::armed`] says so.
    Lapsed,
}

/// Whether goals are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Armed {
    /// Torque is off, or as somebody else left it.
    No,
    /// Being measured, configured and pinned.
    Arming,
    /// Pinned, torque on, watchdog armed.
    Yes,
    /// Torque is being switched off and this is being checked.
    Releasing,
}

/// Whether a servo answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// It answered the last time it was asked.
    Present,
    /// It did not, which may be the fault of one before it.
    Doubtful,
    /// It did not, ten times, while those before it did.
    Absent,
}

/// Something the bus found out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BusEvent {
    /// All members are pinned and have torque.
    Armed,
    /// See [`super::Bus::refusals`]; torque is being switched off.
    ArmingRefused,
    /// Torque is off, as far as members answer; see [`super::Bus::refusals`] for any that keep it.
    Released,
    /// A servo counts as absent now.
    Silent {
        /// Place in member order.
        member: usize,
    },
    /// It answers again.
    Returned {
        /// Place in member order.
        member: usize,
    },
    /// A late answer was recognised and thrown away.
    Stale {
        /// Place in member order.
        member: usize,
        /// How late, as far as its clock tells.
        by_ms: f64,
    },
    /// A position that cannot be was thrown away.
    Implausible {
        /// Place in member order.
        member: usize,
        /// As sent.
        counts: i64,
    },
    /// The servo's clock began again: it was rebooted and has lost torque and settings.
    Restarted {
        /// Place in member order.
        member: usize,
    },
    /// It refused an instruction; the number is the e-manual's.
    Refused {
        /// Place in member order.
        member: usize,
        /// Number of the error.
        error: u8,
    },
    /// Hardware Error Status is not zero.
    HardwareError {
        /// Place in member order.
        member: usize,
        /// Hardware Error Status.
        bits: u8,
    },
    /// Warmer than the settings allow.
    Hot {
        /// Place in member order.
        member: usize,
        /// Present Temperature.
        temperature_c: f64,
    },
    /// Torque is off although the bus is armed.
    TorqueLost {
        /// Place in member order.
        member: usize,
    },
    /// The servo's watchdog has stopped it: all are being measured and pinned again.
    WatchdogTripped {
        /// Place in member order.
        member: usize,
    },
}

/// Counts since the bus was made.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BusCounters {
    /// Cycles sent.
    pub cycles: u64,
    /// Commands that found the wire busy.
    pub busy: u64,
    /// Late answers thrown away, whichever way they were recognised.
    pub stale: u64,
    /// Answers thrown away that fit nothing that was ever asked.
    pub strays: u64,
    /// Positions that cannot be.
    pub implausible: u64,
    /// Answers missing at their deadline.
    pub timeouts: u64,
    /// Reads by fast sync or bulk read.
    pub fast_reads: u64,
    /// Those of them that were not whole.
    pub fast_failures: u64,
    /// Pings sent because answers of every length were owed.
    pub pings: u64,
    /// Damaged packets.
    pub rejected: u64,
    /// Our own instructions heard back.
    pub echoes: u64,
    /// Bytes written.
    pub sent_bytes: u64,
    /// Bytes read.
    pub received_bytes: u64,
}
