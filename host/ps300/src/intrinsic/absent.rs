//! Functions whose names are known and which cannot be run.
//!
//! Listed so that a program that uses one is told why it cannot run, rather than that it is misspelt.

/// A name without behaviour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Absent {
    /// Without `F:`.
    pub name: &'static str,
    /// What it was for, as far as known.
    pub purpose: &'static str,
    /// Why it is not there.
    pub why: &'static str,
}

const UNKNOWN: &str = "what it did is not on record";
const ELSEWHERE: &str = "it belonged to a machine that is not there";

/// In the order of the reference page.
/// Source: `docs/protocols/ps300.md`, rows of low confidence and rows that need a host or a pick.
pub const ABSENT: &[Absent] = &[
    absent("ATSCALE", "not known", UNKNOWN),
    absent("CHOP", "not known", UNKNOWN),
    absent(
        "LABEL",
        "builds label items",
        "the form of label messages is not on record; LABELS nodes take strings and vectors as \
             they are",
    ),
    absent("POSITION_LINE", "not known", UNKNOWN),
    absent(
        "CIROUTE",
        "sent a host's bytes to the command interpreter or past it, by their routing character",
        ELSEWHERE,
    ),
    absent("DEMUX", "took a host's stream of bytes apart", ELSEWHERE),
    absent("READDISK", "read a file of the machine's disk", ELSEWHERE),
    absent("READSTREAM", "read a host's stream of bytes", ELSEWHERE),
    absent(
        "SCREENSAVE",
        "spared the screen while nobody was there",
        ELSEWHERE,
    ),
];

const fn absent(name: &'static str, purpose: &'static str, why: &'static str) -> Absent {
    Absent { name, purpose, why }
}
