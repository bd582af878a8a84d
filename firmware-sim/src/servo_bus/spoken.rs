//! What a person says to a running bus, line by line: faults and hands.
//!
//! A line is a fault as `--fault` takes it, or one of the words here. Source: `docs/simulator.md`, "While it runs".

use super::bus::ServoBus;
use super::fault::words::Words;
use super::fault::{Fault, FaultError};
use super::plant::Hand;
use std::fmt;

/// Words that begin a line which is no fault.
const VERBS: &[&str] = &["mend", "hand"];

/// One line that has been understood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spoken {
    /// `FAULT`: something goes wrong.
    Fault(Fault),
    /// `mend`: everything is well again.
    Mend,
    /// `hand on N turns to X deg [over TIME]`, `hand on N pulls XNm`, `hand on N lets go`.
    Hand {
        /// Whose horn.
        id: u8,
        /// What it does; none: lets go.
        hand: Option<Hand>,
    },
}

impl Spoken {
    /// Reads one line; nothing if it is empty or a comment.
    pub fn parse(line: &str) -> Result<Option<Self>, FaultError> {
        let line = line.split_once('#').map_or(line, |(before, _)| before);
        let mut words = Words::new(line);
        let spoken = match line.split_whitespace().next() {
            None => return Ok(None),
            Some(first) if VERBS.contains(&first) => words.one_of(VERBS, "mend or hand")?,
            Some(_) => return Fault::parse(line).map(|fault| Some(Self::Fault(fault))),
        };
        let spoken = match spoken {
            "mend" => Self::Mend,
            _ => hand(&mut words)?,
        };
        if words.next().is_some() {
            return Err(words.wrong("the end of the line"));
        }
        Ok(Some(spoken))
    }
}

fn hand(words: &mut Words<'_>) -> Result<Spoken, FaultError> {
    words.expect("on")?;
    let id = words.id()?;
    let hand = match words.one_of(&["turns", "pulls", "lets"], "turns to, pulls or lets go")? {
        "turns" => {
            words.expect("to")?;
            let degrees = words.number("deg", -3600.0, 3600.0)?;
            words.take("deg");
            let over_secs = if words.take("over") {
                words.micros()? as f64 * 1e-6
            } else {
                0.0
            };
            Some(Hand::Guide {
                to_rad: degrees.to_radians(),
                over_secs,
            })
        }
        "pulls" => Some(Hand::Pull {
            nm: words.number("Nm", -100.0, 100.0)?,
        }),
        _ => {
            words.expect("go")?;
            None
        }
    };
    Ok(Spoken::Hand { id, hand })
}

impl fmt::Display for Spoken {
    /// The line that `parse` reads back.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fault(fault) => fault.fmt(f),
            Self::Mend => write!(f, "mend"),
            Self::Hand { id, hand: None } => write!(f, "hand on {id} lets go"),
            Self::Hand {
                id,
                hand: Some(Hand::Pull { nm }),
            } => write!(f, "hand on {id} pulls {nm}Nm"),
            Self::Hand {
                id,
                hand: Some(Hand::Guide { to_rad, over_secs }),
            } => write!(
                f,
                "hand on {id} turns to {} deg over {over_secs}s",
                to_rad.to_degrees()
            ),
        }
    }
}

impl ServoBus {
    /// Does what was said, or tells why it cannot be done.
    pub fn obey(&mut self, now_us: u64, spoken: &Spoken) -> Result<(), String> {
        match spoken {
            Spoken::Fault(fault) => match self.misfit(fault) {
                None => self.inject(now_us, fault),
                Some(why) => return Err(why),
            },
            Spoken::Mend => self.mend(now_us),
            Spoken::Hand { id, hand } => {
                if !self.hand(now_us, *id, *hand) {
                    return Err(self.nobody(*id));
                }
            }
        }
        Ok(())
    }
}
