//! Fonts made by commands.

use glam::DVec2;

/// `BEGIN_FONT C[65]: N=3 P 0,0 L 0.5,1 L 1,0; … END_FONT`.
#[derive(Clone, Debug, PartialEq)]
pub struct Font {
    /// In the order written; of two for one character the later counts.
    pub glyphs: Vec<Glyph>,
}

/// The shape of one character.
#[derive(Clone, Debug, PartialEq)]
pub struct Glyph {
    /// Which character, written as its code.
    pub character: char,
    /// In drawing order; none is a blank.
    pub vectors: Vec<GlyphVector>,
}

/// One vector of a glyph.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlyphVector {
    /// In the character's cell: 0 to 1 each way, from its lower left corner; descenders go below.
    pub at: DVec2,
    /// A line (L) from the vector before; false is a move (P).
    pub draw: bool,
}
