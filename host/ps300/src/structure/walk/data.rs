//! Drawing data nodes: vector lists, curves, and polygons that nothing renders.

use glam::DVec3;

use super::Walk;
use super::pen::{Line, Pen};
use super::state::State;
use crate::display::{Light, rgb};
use crate::language::{Dimension, Illumination, Polygon, Vector, VectorClass, VectorList};
use crate::names::NameId;
use crate::pick::Picked;
use crate::structure::curve::Curve;
use crate::structure::dash::Dashes;
use crate::structure::{Body, NodeId};

impl<'a> Walk<'a> {
    pub(super) fn draw_data(&mut self, id: NodeId, body: &'a Body, state: &State) {
        match body {
            Body::Vectors { list, pattern } => {
                let list = list.now();
                self.source(id, Picked::Vectors, list.dimension, state);
                let dashes = self.dashes(*pattern, state);
                self.draw_vectors(list, dashes.as_ref(), state);
            }
            Body::Curve { curve, pattern } => {
                let curve = curve.now();
                self.source(id, Picked::Curve, curve.dimension(), state);
                let dashes = self.dashes(*pattern, state);
                self.draw_curve(curve, dashes.as_ref(), state);
            }
            Body::Characters(characters) => self.draw_characters(id, characters.now(), state),
            Body::Labels(labels) => self.draw_labels(id, labels.now(), state),
            Body::Polygons(polygons) if state.sectioning => {
                self.section_with(polygons, state);
                self.source(id, Picked::Polygon, Dimension::Three, state);
                self.draw_outlines(&polygons.written, state);
            }
            Body::Polygons(polygons) if self.traced.is_none() && self.gather(polygons, state) => {}
            Body::Polygons(polygons) => {
                self.source(id, Picked::Polygon, Dimension::Three, state);
                self.draw_outlines(&polygons.written, state);
            }
            Body::Illumination(light) => self.shine(light, state),
            _ => {}
        }
    }

    /// The pattern of a node, or the texture set above it.
    fn dashes(&self, pattern: Option<NameId>, state: &State) -> Option<Dashes> {
        let node = pattern.and_then(|name| self.names.node(name));
        let body = node
            .and_then(|node| self.structure.slot(node))
            .map(|slot| &slot.body);
        if let Some(Body::Pattern(pattern)) = body {
            return Some(Dashes::of(pattern));
        }
        let (around_corners, mask) = state.texture?;
        Dashes::of_mask(mask, around_corners)
    }

    fn draw_vectors(&mut self, list: &VectorList, dashes: Option<&Dashes>, state: &State) {
        let mut pen = self.pen(state);
        if list.colored {
            pen.saturation = state.blending;
        }
        let mut from: Option<(DVec3, DVec3)> = None;
        let mut run = Run::default();
        for (index, Vector { at, draw, intensity }) in list.vectors.iter().enumerate() {
            let brightness = match intensity {
                Some(hue_deg) if list.colored => {
                    pen.hue_deg = *hue_deg;
                    1.0
                }
                Some(brightness) if list.class != VectorClass::Tabulated => *brightness,
                _ => 1.0,
            };
            let to = (*at, pen.world_from_here.transform_point3(*at));
            let start = if list.class == VectorClass::Dots {
                Some(to)
            } else {
                from
            };
            if let (true, Some(from)) = (*draw, start) {
                let line = Line {
                    ends: [from.0, to.0],
                    brightness,
                    index: index as i32 + 1,
                    along: [0.0, 1.0],
                };
                let room = match dashes {
                    Some(dashes) if list.class != VectorClass::Dots => {
                        if run.vectors == 0 {
                            run = Run::from(&list.vectors, index, dashes);
                        }
                        self.dash(&pen, dashes, &mut run, &line)
                    }
                    _ => self.line_placed(&pen, [from.1, to.1], &line),
                };
                if !room {
                    return;
                }
            }
            from = Some(to);
        }
    }

    /// Draws one vector of a run, dashed.
    fn dash(&mut self, pen: &Pen, dashes: &Dashes, run: &mut Run, line: &Line) -> bool {
        let [from, to] = line.ends;
        let length = from.distance(to);
        let mut pieces = std::mem::take(&mut self.dashes);
        dashes.dashes(run.total, run.done, length, &mut pieces);
        let mut room = true;
        for piece in &pieces {
            let along = piece.map(|at| ((at - run.done) / length.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0));
            let piece = Line {
                ends: along.map(|share| from.lerp(to, share)),
                along,
                ..*line
            };
            room = room && self.line(pen, &piece);
        }
        self.dashes = pieces;
        run.done += length;
        run.vectors = run.vectors.saturating_sub(1);
        room
    }

    fn draw_curve(&mut self, curve: &Curve, dashes: Option<&Dashes>, state: &State) {
        let pen = self.pen(state);
        let points = curve.points();
        let chords = points.len().saturating_sub(1).max(1) as f64;
        let mut run = Run {
            total: points.windows(2).map(|pair| pair[0].distance(pair[1])).sum(),
            done: 0.0,
            vectors: 0,
        };
        for (index, pair) in points.windows(2).enumerate() {
            let line = Line {
                ends: [pair[0], pair[1]],
                brightness: 1.0,
                index: index as i32 + 1,
                along: [index as f64 / chords, (index as f64 + 1.0) / chords],
            };
            let room = match dashes {
                Some(dashes) => self.dash(&pen, dashes, &mut run, &line),
                None => self.line(&pen, &line),
            };
            if !room {
                return;
            }
        }
    }

    /// The edges of polygons, soft ones left out, in the hue of the outline.
    fn draw_outlines(&mut self, polygons: &[Polygon], state: &State) {
        let mut pen = self.pen(state);
        for (index, polygon) in polygons.iter().enumerate() {
            pen.hue_deg = polygon.outline_hue_deg.unwrap_or(state.hue_deg);
            pen.saturation = polygon.outline_hue_deg.map_or(state.saturation, |_| 1.0);
            let ends = polygon.vertices.iter().cycle().skip(1);
            for (from, to) in polygon.vertices.iter().zip(ends).filter(|(from, _)| !from.soft) {
                let line = Line {
                    ends: [from.at, to.at],
                    brightness: 1.0,
                    index: index as i32 + 1,
                    along: [0.0, 1.0],
                };
                if !self.line(&pen, &line) {
                    return;
                }
            }
        }
    }

    fn shine(&mut self, light: &Illumination, state: &State) {
        let towards = (state.light_from_world * state.world_from_here).transform_vector3(light.direction);
        let Some(towards) = towards.try_normalize() else {
            return;
        };
        let colour = light
            .color
            .map_or(DVec3::ONE, |c| rgb(c.hue_deg, c.saturation, c.intensity));
        self.add_light(
            Light {
                towards,
                colour,
                ambient: light.ambient.unwrap_or(0.0),
            },
            state,
        );
    }
}

/// Vectors joined to each other, over which a pattern runs.
#[derive(Default)]
struct Run {
    total: f64,
    done: f64,
    /// How many are left.
    vectors: usize,
}

impl Run {
    /// The run that begins with the vector at `index`, which is drawn to.
    fn from(vectors: &[Vector], index: usize, dashes: &Dashes) -> Self {
        let most = if dashes.around_corners { usize::MAX } else { 1 };
        let drawn = vectors[index..]
            .iter()
            .take_while(|vector| vector.draw)
            .take(most);
        let count = drawn.count();
        let points = &vectors[index.saturating_sub(1)..index + count];
        Self {
            total: points
                .windows(2)
                .map(|pair| pair[0].at.distance(pair[1].at))
                .sum(),
            done: 0.0,
            vectors: count,
        }
    }
}
