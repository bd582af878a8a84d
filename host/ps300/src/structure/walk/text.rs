//! Drawing text: letters become strokes here, so that every host and every pick sees the same.

use glam::DVec3;

use super::Walk;
use super::pen::{Line, Pen};
use super::state::State;
use crate::language::{Characters, Dimension, Labels};
use crate::pick::Picked;
use crate::structure::font::Typeface;
use crate::structure::{Body, NodeId};

impl<'a> Walk<'a> {
    fn typeface(&self, state: &State) -> &'a Typeface {
        let node = state.font.and_then(|name| self.names.node(name));
        match node
            .and_then(|node| self.structure.slot(node))
            .map(|slot| &slot.body)
        {
            Some(Body::Font(font)) => font,
            _ => Typeface::standard(),
        }
    }

    pub(super) fn draw_characters(&mut self, id: NodeId, characters: &Characters, state: &State) {
        self.source(id, Picked::Characters, flat(characters.at), state);
        let pen = self.pen(state);
        let font = self.typeface(state);
        for (index, character) in characters.text.chars().enumerate() {
            let offset = characters.step * index as f64;
            if !self.letter(&pen, font, state, characters.at, (offset, character, index)) {
                return;
            }
        }
    }

    pub(super) fn draw_labels(&mut self, id: NodeId, labels: &Labels, state: &State) {
        let dimension = labels
            .labels
            .first()
            .map_or(Dimension::Two, |label| flat(label.at));
        self.source(id, Picked::Labels, dimension, state);
        let pen = self.pen(state);
        let font = self.typeface(state);
        for (index, label) in labels.labels.iter().enumerate() {
            for (place, character) in label.text.chars().enumerate() {
                let offset = glam::DVec2::X * place as f64;
                if !self.letter(&pen, font, state, label.at, (offset, character, index)) {
                    return;
                }
            }
        }
    }

    /// Draws one character `offset` cells from `at`; picks report it as `index`, from 0, and `at` its corner.
    fn letter(
        &mut self,
        pen: &Pen,
        font: &Typeface,
        state: &State,
        at: DVec3,
        (offset, character, index): (glam::DVec2, char, usize),
    ) -> bool {
        let placed = |cell: glam::DVec2| at + (state.characters * (offset + cell)).extend(0.0);
        let corner = placed(glam::DVec2::ZERO);
        let mut from = None;
        for vector in font.glyph(character).unwrap_or(font.missing()) {
            let to = pen.world_from_here.transform_point3(placed(vector.at));
            if let (true, Some(from)) = (vector.draw, from) {
                let line = Line {
                    ends: [corner; 2],
                    brightness: 1.0,
                    index: index as i32 + 1,
                    along: [0.0; 2],
                };
                if !self.line_placed(pen, [from, to], &line) {
                    return false;
                }
            }
            from = Some(to);
        }
        true
    }
}

fn flat(at: DVec3) -> Dimension {
    if at.z == 0.0 {
        Dimension::Two
    } else {
        Dimension::Three
    }
}
