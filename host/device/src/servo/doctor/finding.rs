//! One thing that is wrong: where, what it costs, what to do.

use super::kind::Kind;
use device_profiles::Role;
use std::fmt;

/// Something that is wrong with a bus or a servo.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Of which kind.
    pub kind: Kind,
    /// The joint, where the puppet is known and one joint has it.
    pub joint: Option<String>,
    /// The bus, by the puppet's name for it, or the port.
    pub bus: String,
    /// The servo.
    pub id: Option<u8>,
    /// What was expected and what was found.
    pub what: String,
    /// In milliseconds, cycles a second, or risk.
    pub costs: String,
    /// What to do, with the command where there is one.
    pub remedy: String,
    /// What mends it, where that is safe.
    pub fix: Option<Fix>,
}

/// A change that mends a finding and can do no harm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fix {
    /// The adapter's latency timer, milliseconds.
    LatencyTimer {
        /// To be set.
        ms: u8,
    },
    /// A register of a servo.
    Register {
        /// The servo.
        id: u8,
        /// Which register.
        role: Role,
        /// To be written, in counts.
        value: i64,
    },
}

impl fmt::Display for Fix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LatencyTimer { ms } => write!(f, "latency timer of the adapter to {ms} ms"),
            Self::Register { id, role, value } => write!(f, "{role} of servo {id} to {value}"),
        }
    }
}

impl Finding {
    /// A finding about a whole bus, with the kind's own words for cost and remedy.
    pub fn of_bus(kind: Kind, bus: &str, what: String) -> Self {
        Self {
            kind,
            joint: None,
            bus: bus.to_owned(),
            id: None,
            what,
            costs: kind.costs().to_owned(),
            remedy: kind.remedy().to_owned(),
            fix: None,
        }
    }

    /// The same with what it costs here.
    #[must_use]
    pub fn costing(mut self, costs: impl Into<String>) -> Self {
        self.costs = costs.into();
        self
    }

    /// The same with what to do here.
    #[must_use]
    pub fn mended_by(mut self, remedy: impl Into<String>) -> Self {
        self.remedy = remedy.into();
        self
    }

    /// The same with a change that mends it.
    #[must_use]
    pub fn with_fix(mut self, fix: Fix) -> Self {
        self.fix = Some(fix);
        self
    }

    /// Where it is: the joint, the servo, or the bus.
    pub fn place(&self) -> String {
        match (&self.joint, self.id) {
            (Some(joint), Some(id)) => format!("{joint} (bus {}, id {id})", self.bus),
            (Some(joint), None) => format!("{joint} (bus {})", self.bus),
            (None, Some(id)) => format!("bus {}, id {id}", self.bus),
            (None, None) => format!("bus {}", self.bus),
        }
    }
}
