//! Drawing single lines: cut at the view's borders, brightened by depth.

use glam::{DMat4, DVec3, DVec4};

use super::state::State;
use super::trace::Trace;
use super::{PARTS_MAX, Walk};
use crate::display::Stroke;
use crate::structure::frustum::{Frustum, Vertex};

/// What the lines of one data node have in common.
pub(super) struct Pen {
    pub(super) world_from_here: DMat4,
    frustum: Frustum,
    /// Rows of the view's matrix that give depth.
    depth: [DVec4; 2],
    /// At depth 0, and what is added towards depth 1.
    pub(super) brightness: [f64; 2],
    pub(super) hue_deg: f64,
    pub(super) saturation: f64,
    pub(super) view: u16,
    /// Whether lines are noted for a pick.
    traced: bool,
}

/// One line of a data node, in its own space.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) ends: [DVec3; 2],
    pub(super) brightness: f64,
    /// Of the element it is part of, from 1.
    pub(super) index: i32,
    /// Which part of the element it is.
    pub(super) along: [f64; 2],
}

impl Pen {
    fn brightness(&self, world: DVec3) -> f64 {
        let [near, further] = self.brightness;
        if further == 0.0 {
            return near;
        }
        let [z, w] = self.depth.map(|row| row.dot(world.extend(1.0)));
        near + further * (z / w).clamp(0.0, 1.0)
    }

    fn stroke(&self, from: DVec3, to: DVec3, brightness: f64) -> Stroke {
        Stroke {
            from,
            to,
            hue_deg: self.hue_deg,
            saturation: self.saturation,
            intensity: [from, to].map(|end| brightness * self.brightness(end)),
            view: self.view,
        }
    }

    /// Cuts a border of a face, given in the world, to what is seen of it.
    pub(super) fn cut_face(&self, border: &mut Vec<Vertex>, spare: &mut Vec<Vertex>) {
        self.frustum.cut_face(border, spare);
    }

    /// A line given in the world, as far as it is seen.
    pub(super) fn seen(&self, from: DVec3, to: DVec3, brightness: f64) -> Option<(Stroke, [f64; 2])> {
        let part @ [begin, end] = self.frustum.cut(from, to)?;
        let (from, to) = if part == [0.0, 1.0] {
            (from, to)
        } else {
            (from.lerp(to, begin), from.lerp(to, end))
        };
        Some((self.stroke(from, to, brightness), part))
    }
}

impl Walk<'_> {
    pub(super) fn pen(&mut self, state: &State) -> Pen {
        let m = state.screen_from_world.unwrap_or(DMat4::IDENTITY);
        Pen {
            world_from_here: state.world_from_here,
            frustum: state.frustum(),
            depth: [m.row(2), m.row(3)],
            brightness: state.brightness(),
            hue_deg: state.hue_deg,
            saturation: state.saturation,
            view: self.view(state),
            traced: self.traced.is_some(),
        }
    }

    fn view(&mut self, state: &State) -> u16 {
        let view = state.view();
        let views = &mut self.list.views;
        if let Some(index) = views.iter().rposition(|known| *known == view) {
            return index as u16;
        }
        if views.len() < usize::from(u16::MAX) {
            views.push(view);
        }
        views.len() as u16 - 1
    }

    /// Draws a line whose ends are known in the world already; false when the picture is full.
    pub(super) fn line_placed(&mut self, pen: &Pen, [from, to]: [DVec3; 2], line: &Line) -> bool {
        if self.list.strokes.len() >= PARTS_MAX {
            return false;
        }
        let Some((stroke, part)) = pen.seen(from, to, line.brightness) else {
            return true;
        };
        self.list.strokes.push(stroke);
        if pen.traced
            && let Some(traced) = self.traced.as_deref_mut()
        {
            let [begin, end] = line.along;
            traced.traces.push(Trace {
                source: traced.sources.len() as u32 - 1,
                index: line.index,
                ends: part.map(|share| line.ends[0].lerp(line.ends[1], share)),
                along: part.map(|share| begin + (end - begin) * share),
            });
        }
        true
    }

    /// Draws a line of a data node.
    pub(super) fn line(&mut self, pen: &Pen, line: &Line) -> bool {
        let ends = line.ends.map(|end| pen.world_from_here.transform_point3(end));
        self.line_placed(pen, ends, line)
    }
}
