//! What went wrong while the network ran, gathered so that a loop cannot flood anybody.

use std::collections::BTreeMap;
use std::fmt;

use super::connection::input_text;
use super::made::Made;
use crate::language::{Input, Name, literal};
use crate::value::{Kind, Kinds, Value};

/// Something dropped, refused or postponed, and how often since the reports were last taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The instance, node or host input it happened at.
    pub name: Name,
    /// What that is: `F:ADDC`, `ROTATE node`, `host input`.
    pub what: String,
    /// The command that made it, if that is known.
    pub made: Option<Made>,
    /// What happened.
    pub cause: Cause,
    /// The first message to which it happened, and the input it came to; not finite is one that was to be sent.
    pub message: Option<(Option<Input>, Value)>,
    /// How often.
    pub count: u32,
}

/// What happened.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// A message of the wrong kind was dropped.
    Kind {
        /// Where it arrived.
        input: Input,
        /// What would have been taken.
        expected: Kinds,
        /// What came.
        got: Kind,
    },
    /// A message had no answer, or could not be acted on; it was consumed.
    Domain {
        /// As a clause.
        why: &'static str,
    },
    /// A number that is infinite or none was not sent on.
    NotFinite,
    /// The queue was full; the newest message was dropped.
    QueueFull {
        /// Which queue.
        input: Input,
    },
    /// The whole network holds as many messages as it may; the newest was dropped.
    NetworkFull,
    /// The firings of a batch or command were used up with this instance next in turn; it goes on with the next.
    OutOfBudget,
    /// Too many messages of the host wait for the firings of earlier ones; the newest was dropped.
    BacklogFull,
    /// Too many ticks wait for the firings of earlier ones; this one is taken together with the next.
    Behind,
    /// F:SEND or F:FETCH named something that is not there.
    Unknown {
        /// What was asked for.
        name: String,
    },
    /// CONNECT of a pair already connected changed nothing.
    AlreadyConnected {
        /// The other end.
        to: String,
    },
    /// A watched message was not recorded, since nobody took those before.
    Unwatched,
    /// Too many different things went wrong to list; `count` says how many more.
    Unlisted,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.cause == Cause::Unlisted {
            return write!(f, "{} further reports are not listed", self.count);
        }
        write!(f, "{} ({}", self.name, self.what)?;
        if let Some(made) = &self.made {
            write!(f, ", made at {made}")?;
        }
        f.write_str("): ")?;
        match &self.cause {
            Cause::Kind { input, expected, got } => {
                write!(f, "input {} takes {expected}, got {got}", input_text(*input))?;
                self.write_message(f, " ", "")?;
                f.write_str("; the message was dropped")?;
            }
            Cause::Domain { why } => f.write_str(why)?,
            Cause::NotFinite => {
                f.write_str("the result is not a finite number")?;
                self.write_message(f, " (", ")")?;
                f.write_str("; it was not sent")?;
            }
            Cause::QueueFull { input } => {
                write!(f, "the queue of input {} is full; ", input_text(*input))?;
                self.write_dropped(f)?;
            }
            Cause::NetworkFull => {
                f.write_str("the network holds as many messages as it may; ")?;
                self.write_dropped(f)?;
            }
            Cause::OutOfBudget => {
                f.write_str(
                    "the network did not come to rest; it goes on at the next tick (a loop without end?)",
                )?;
            }
            Cause::BacklogFull => {
                f.write_str("too many messages wait for the network to come to rest; ")?;
                self.write_dropped(f)?;
            }
            Cause::Behind => f.write_str("the network cannot keep up; ticks are taken together")?,
            Cause::Unknown { name } => write!(f, "there is no {name:?}")?,
            Cause::AlreadyConnected { to } => write!(f, "already connected to {to}; nothing changed")?,
            Cause::Unwatched => {
                f.write_str("too many watched messages were not taken; the newest was not recorded")?;
            }
            Cause::Unlisted => {}
        }
        if self.count > 1 {
            write!(f, " ({} times)", self.count)?;
        }
        if let (Cause::Domain { .. }, Some((Some(input), _))) = (&self.cause, &self.message) {
            write!(f, "; input {} had", input_text(*input))?;
            self.write_message(f, " ", "")?;
        }
        Ok(())
    }
}

/// Enough of a message to recognise it by.
const CHARACTERS_MAX: usize = 60;

impl Report {
    fn write_message(&self, f: &mut fmt::Formatter<'_>, before: &str, after: &str) -> fmt::Result {
        let Some((_, value)) = &self.message else {
            return Ok(());
        };
        let text = literal(value);
        match text.char_indices().nth(CHARACTERS_MAX) {
            None => write!(f, "{before}{text}{after}"),
            Some((end, _)) => write!(f, "{before}{}…{after}", &text[..end]),
        }
    }

    fn write_dropped(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the newest message")?;
        self.write_message(f, ", ", ",")?;
        f.write_str(" was dropped")
    }
}

/// Who and what a report is about.
pub(crate) struct About {
    pub(crate) what: String,
    pub(crate) made: Option<Made>,
    pub(crate) message: Option<(Option<Input>, Value)>,
}

impl About {
    pub(crate) fn new(what: &str) -> Self {
        Self {
            what: what.to_owned(),
            made: None,
            message: None,
        }
    }

    /// With the message and the input it came to.
    pub(crate) fn message(mut self, input: Input, value: &Value) -> Self {
        self.message = Some((Some(input), value.clone()));
        self
    }
}

/// As many different reports as are kept between two drains.
const DIFFERENT_MAX: usize = 256;

/// The reports since the last drain, in the order in which each first occurred.
#[derive(Default)]
pub(crate) struct Reports {
    listed: Vec<Report>,
    unlisted: u32,
    /// How often each name was reported, drained or not.
    counts: BTreeMap<Name, u64>,
}

impl Reports {
    /// `about` is asked only when the report is new.
    pub(crate) fn note(&mut self, name: &Name, about: impl FnOnce() -> About, cause: Cause) {
        match self.counts.get_mut(name) {
            Some(count) => *count += 1,
            None => {
                self.counts.insert(name.clone(), 1);
            }
        }
        let same = |report: &&mut Report| report.cause == cause && report.name == *name;
        if let Some(report) = self.listed.iter_mut().rev().find(same) {
            report.count = report.count.saturating_add(1);
        } else if self.listed.len() < DIFFERENT_MAX {
            let About { what, made, message } = about();
            self.listed.push(Report {
                name: name.clone(),
                what,
                made,
                cause,
                message,
                count: 1,
            });
        } else {
            self.unlisted = self.unlisted.saturating_add(1);
        }
    }

    /// How often something of this name was reported since the machine began.
    pub(crate) fn counted(&self, name: &Name) -> u64 {
        self.counts.get(name).copied().unwrap_or(0)
    }

    pub(crate) fn drain(&mut self) -> Vec<Report> {
        let mut reports = std::mem::take(&mut self.listed);
        if self.unlisted > 0 {
            reports.push(Report {
                name: Name::new("network"),
                what: "network".to_owned(),
                made: None,
                cause: Cause::Unlisted,
                message: None,
                count: std::mem::take(&mut self.unlisted),
            });
        }
        reports
    }
}
