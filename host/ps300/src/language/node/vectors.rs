//! Vector lists.

use glam::DVec3;

/// How the vectors of a list are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VectorClass {
    /// One polyline: a move to the first, then lines.
    Connected,
    /// A dot at each.
    Dots,
    /// Each says whether it is a move (P) or a line (L).
    Itemized,
    /// Pairs: move, line, move, line.
    Separate,
    /// As itemized, and each may say with `T=` which entry of a table of colours it has. What the table
    /// held is not on record.
    Tabulated,
}

impl VectorClass {
    /// Entries of the table of colours are numbered from 0 to this.
    pub const TABLE_LAST: u8 = 127;

    /// Whether the vector at `index` (from 0) is drawn to, for the classes that decide it by place.
    pub fn draws(self, index: usize) -> Option<bool> {
        match self {
            Self::Connected => Some(index > 0),
            Self::Dots => Some(true),
            Self::Itemized | Self::Tabulated => None,
            Self::Separate => Some(index % 2 == 1),
        }
    }
}

/// How many coordinates a data node was written with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// `x,y`; z is 0.
    Two,
    /// `x,y,z`.
    Three,
}

impl Dimension {
    /// As a number, for picks and GSR calls.
    pub fn count(self) -> u8 {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }
}

/// `VECTOR_LIST …`.
#[derive(Clone, Debug, PartialEq)]
pub struct VectorList {
    /// How the vectors are joined.
    pub class: VectorClass,
    /// `BLOCK_NORMALIZED`: all vectors had one exponent in the memory of the PS 300. Kept, and without effect.
    pub block_normalized: bool,
    /// `COLOR`: `I=` is a hue in degrees instead of a brightness.
    pub colored: bool,
    /// Two where every vector was written so.
    pub dimension: Dimension,
    /// In drawing order.
    pub vectors: Vec<Vector>,
}

impl VectorList {
    /// Vectors in space, neither block normalized nor coloured one by one.
    pub fn new(class: VectorClass, vectors: Vec<Vector>) -> Self {
        Self {
            class,
            block_normalized: false,
            colored: false,
            dimension: Dimension::Three,
            vectors,
        }
    }
}

/// One element of a vector list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector {
    /// In the list's own space; z is 0 for lists written in two dimensions.
    pub at: DVec3,
    /// A line (L) from the vector before, or a dot; false is a move (P). Always what
    /// [`VectorClass::draws`] says, except in itemized and tabulated lists.
    pub draw: bool,
    /// `I=`: brightness 0 to 1, or in a list with `COLOR` a hue in degrees; in a tabulated list `T=`: a whole
    /// number from 0 to [`VectorClass::TABLE_LAST`]. Absent is full brightness in the colour set above.
    pub intensity: Option<f64>,
}
