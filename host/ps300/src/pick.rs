//! What a pick reports: one drawn element near the cursor, and how the display tree leads to it.
//!
//! Apart from `structure`, which finds picks, because they also travel as messages and are taken apart by
//! F:PICKINFO. Source: `docs/protocols/ps300.md`, "Picking and system".

use std::sync::Arc;

use glam::DVec3;

use crate::language::Name;

/// The kind of data a picked element is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it all")]
pub enum Picked {
    Vectors,
    Characters,
    Labels,
    Curve,
    Polygon,
}

impl Picked {
    /// The number F:PICKINFO gives it. Our choice.
    pub fn code(self) -> i32 {
        match self {
            Self::Vectors => 0,
            Self::Characters => 1,
            Self::Labels => 2,
            Self::Curve => 3,
            Self::Polygon => 4,
        }
    }
}

/// One picked element.
#[derive(Clone, Debug, PartialEq)]
pub struct Pick {
    /// Counted from 1 within its list: the vector drawn to, the character, the label, the chord, the polygon.
    pub index: i32,
    /// The pick identifiers above it, innermost first.
    pub identifiers: Arc<[Name]>,
    /// The data node, by the name commands reach it.
    pub node: Name,
    /// What it is part of.
    pub kind: Picked,
    /// 2 for lists written in two dimensions.
    pub dimension: u8,
    /// Where, if PICK was told to say.
    pub spot: Option<Spot>,
}

/// The point of a picked element that is nearest to the middle of the pick window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// In the node's own space; of a character, its lower left corner.
    pub at: DVec3,
    /// How far along the line or curve, 0 to 1.
    pub along: f64,
}
