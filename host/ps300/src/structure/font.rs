//! Fonts: which strokes a character has.
//!
//! The standard font is a program like any other, `standard_font.ps300`, read once.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use crate::language::{Command, Definition, Font, GlyphVector, Node, parse};

/// A font with its characters in order.
pub(crate) struct Typeface {
    pub(crate) written: Font,
    by_character: BTreeMap<char, usize>,
}

impl Typeface {
    pub(super) fn new(written: Font) -> Self {
        let of = |(index, glyph): (usize, &crate::language::Glyph)| (glyph.character, index);
        let by_character = written.glyphs.iter().enumerate().map(of).collect();
        Self {
            written,
            by_character,
        }
    }

    /// The strokes of a character; nothing where the font has none.
    pub(super) fn glyph(&self, character: char) -> Option<&[GlyphVector]> {
        let index = *self.by_character.get(&character)?;
        Some(&self.written.glyphs.get(index)?.vectors)
    }

    /// The machine's own: printable ASCII.
    pub(super) fn standard() -> &'static Self {
        static STANDARD: OnceLock<Typeface> = OnceLock::new();
        STANDARD.get_or_init(|| {
            let (commands, _) = parse(include_str!("standard_font.ps300"));
            let font = commands.into_iter().find_map(|located| match located.what {
                Command::Define {
                    definition: Definition::Node(Node::Font(font)),
                    ..
                } => Some(font),
                _ => None,
            });
            Self::new(font.unwrap_or(Font { glyphs: Vec::new() }))
        })
    }

    /// What stands in for a character the font does not have: its own question mark, or a box.
    pub(super) fn missing(&self) -> &[GlyphVector] {
        const fn at(x: f64, y: f64, draw: bool) -> GlyphVector {
            GlyphVector {
                at: glam::DVec2::new(x, y),
                draw,
            }
        }
        static BOX: [GlyphVector; 5] = [
            at(0.1, 0.0, false),
            at(0.1, 1.0, true),
            at(0.6, 1.0, true),
            at(0.6, 0.0, true),
            at(0.1, 0.0, true),
        ];
        self.glyph('?').unwrap_or(&BOX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_printable_character_has_a_shape_inside_its_cell() {
        let font = Typeface::standard();
        for character in ' '..='~' {
            let glyph = font.glyph(character).expect("printable ASCII is complete");
            assert_eq!(glyph.is_empty(), character == ' ', "{character:?}");
            assert!(
                glyph.first().is_none_or(|v| !v.draw),
                "{character:?} begins with a move"
            );
            for vector in glyph {
                let inside = (0.0..=0.8).contains(&vector.at.x) && (-0.35..=1.15).contains(&vector.at.y);
                assert!(inside, "{character:?} {}", vector.at);
            }
        }
        assert_eq!(font.written.glyphs.len(), 95);
    }
}
