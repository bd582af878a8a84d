//! Functions whose names are known and whose behaviour is not.
//!
//! Listed so that a program that uses one is told why it cannot run, rather than that it is misspelt.

/// A name without behaviour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Absent {
    /// Without `F:`.
    pub name: &'static str,
    /// What it was for, as far as known.
    pub purpose: &'static str,
}

/// In the order of the reference page.
/// Source: `docs/protocols/ps300.md`, rows of low confidence and rows that need a host or a pick.
pub const ABSENT: &[Absent] = &[
    Absent {
        name: "RANGE_SELECT",
        purpose: "sorts numbers by whether they lie between limits",
    },
    Absent {
        name: "COMP_STRING",
        purpose: "compares two strings",
    },
    Absent {
        name: "CHANGEQTYPE",
        purpose: "relabels the type of a message",
    },
    Absent {
        name: "ATSCALE",
        purpose: "not known",
    },
    Absent {
        name: "CHOP",
        purpose: "not known",
    },
    Absent {
        name: "XFORMDATA",
        purpose: "reads the transform accumulated at a node",
    },
    Absent {
        name: "LIST",
        purpose: "prints special messages line by line",
    },
    Absent {
        name: "SPLIT",
        purpose: "cuts a string at a delimiter",
    },
    Absent {
        name: "TAKE_STRING",
        purpose: "takes part of a string",
    },
    Absent {
        name: "PUT_STRING",
        purpose: "inserts into a string",
    },
    Absent {
        name: "FIND_STRING",
        purpose: "searches a string",
    },
    Absent {
        name: "TRANS_STRING",
        purpose: "translates the characters of a string",
    },
    Absent {
        name: "MCAT_STRING",
        purpose: "joins several strings",
    },
    Absent {
        name: "GATHER_STRING",
        purpose: "collects a string up to a terminator",
    },
    Absent {
        name: "CHARCONVERT",
        purpose: "turns characters into integers",
    },
    Absent {
        name: "CHARMASK",
        purpose: "masks characters",
    },
    Absent {
        name: "LABEL",
        purpose: "builds label items",
    },
    Absent {
        name: "LINEEDITOR",
        purpose: "edits keyboard input into lines",
    },
    Absent {
        name: "TIMEOUT",
        purpose: "watches whether a stream pauses",
    },
    Absent {
        name: "PICKINFO",
        purpose: "unpacks a pick",
    },
    Absent {
        name: "POSITION_LINE",
        purpose: "not known",
    },
    Absent {
        name: "READDISK",
        purpose: "system function",
    },
    Absent {
        name: "READSTREAM",
        purpose: "system function",
    },
    Absent {
        name: "SCREENSAVE",
        purpose: "system function",
    },
    Absent {
        name: "CIROUTE",
        purpose: "system function",
    },
    Absent {
        name: "DEMUX",
        purpose: "system function",
    },
];
