//! Dashes.

/// `PATTERN i j … [AROUND_CORNERS] [MATCH/NOMATCH] LENGTH r`.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    /// Lengths of line and gap in turn, line first, relative to each other; never empty.
    pub segments: Vec<u16>,
    /// Whether the pattern goes on from one vector to the next, instead of beginning at each.
    pub around_corners: bool,
    /// Whether the length is adapted so that a whole number of patterns fits; true unless `NOMATCH`.
    pub matched: bool,
    /// Of one whole pattern, in the list's own space.
    pub length: f64,
}
