//! Rendered polygons: gathered on the way, drawn when all below their rendering node are known.
//!
//! A light shines on what its own rendering node renders; one outside all of them, on every rendering that
//! has no light of its own. Source: `docs/protocols/ps300.md`, "Rendering"; which light shines where is ours.

use glam::{DMat3, DVec3, DVec4};

use super::pen::Pen;
use super::state::State;
use super::{PARTS_MAX, Walk};
use crate::display::{Corner, Face, Fill, Light, Material, rgb};
use crate::language::{Polygon, Surface};
use crate::names::NameId;
use crate::structure::Body;
use crate::structure::effect::{Drawing, Rendering};
use crate::structure::frustum::{Vertex, cut_face};
use crate::structure::polygon::{Polygons, around};
use crate::structure::section;

/// A rendering node met on the way.
pub(super) struct Rendition {
    rendering: Rendering,
    /// Of the section: what is behind it stays.
    plane: Option<DVec4>,
    lights: Vec<Light>,
}

/// A polygon with its holes, in the world.
pub(super) struct Gathered {
    rendition: u16,
    borders: Vec<Vec<Vertex>>,
    edges: Vec<[DVec3; 2]>,
    normal: DVec3,
    viewer: Option<DVec3>,
    front: Material,
    back: Material,
    pen: std::rc::Rc<Pen>,
    outline: (f64, f64),
}

impl<'a> Walk<'a> {
    pub(super) fn begin_rendition(&mut self, rendering: Rendering) -> Option<u16> {
        let index = u16::try_from(self.renditions.len()).ok()?;
        self.renditions.push(Rendition {
            rendering,
            plane: None,
            lights: Vec::new(),
        });
        Some(index)
    }

    fn rendition(&mut self, state: &State) -> Option<&mut Rendition> {
        self.renditions.get_mut(usize::from(state.rendition?))
    }

    pub(super) fn add_light(&mut self, light: Light, state: &State) {
        let lights = match self.rendition(state) {
            Some(rendition) => &mut rendition.lights,
            None => &mut self.lights,
        };
        if lights.len() < LIGHTS_MAX {
            lights.push(light);
        }
    }

    /// The first polygon below a sectioning node gives the plane.
    pub(super) fn section_with(&mut self, polygons: &Polygons, state: &State) {
        let Some(polygon) = polygons.written.first() else {
            return;
        };
        let place = |at| state.world_from_here.transform_point3(at);
        let corners = polygon.vertices.iter().map(|vertex| place(vertex.at));
        // Behind is where it looks anticlockwise, which the formula calls positive in a right-handed world.
        let handed = if state.screen_from_world.is_some() {
            -1.0
        } else {
            1.0
        };
        let behind = handed * around(corners.clone());
        let at = corners.clone().next().unwrap_or(DVec3::ZERO);
        if let (Some(behind), Some(rendition)) = (behind.try_normalize(), self.rendition(state)) {
            rendition.plane.get_or_insert(behind.extend(-behind.dot(at)));
        }
    }

    /// Keeps polygons for later; false where nothing renders them.
    pub(super) fn gather(&mut self, polygons: &'a Polygons, state: &State) -> bool {
        let (Some(rendition), Some(index)) = (self.rendition(state), state.rendition) else {
            return false;
        };
        if rendition.rendering.shown.is_none() {
            return false;
        }
        let pen = std::rc::Rc::new(self.pen(state));
        let light_from_here = state.light_from_world * state.world_from_here;
        let normal_from_here = DMat3::from_mat4(light_from_here).inverse().transpose();
        let turned = |normal: DVec3| (normal_from_here * normal).try_normalize().unwrap_or(DVec3::Z);
        for range in polygons.faces() {
            if self.drawn() >= PARTS_MAX {
                break;
            }
            let first = range.start;
            let polygon = &polygons.written[first];
            let own = around(polygon.vertices.iter().map(|vertex| vertex.at));
            let center =
                light_from_here.transform_point3(polygon.vertices.first().map_or(DVec3::ZERO, |v| v.at));
            let (front, back) = self.materials(polygons.attributes[first], state);
            let (mut borders, mut edges) = (Vec::new(), Vec::new());
            for part in range {
                let vertices = &polygons.written[part].vertices;
                let border: Vec<_> = vertices
                    .iter()
                    .zip(&polygons.normals[part])
                    .map(|(vertex, normal)| Vertex {
                        at: pen.world_from_here.transform_point3(vertex.at),
                        normal: turned(*normal),
                    })
                    .collect();
                edges.extend(hard_edges(&polygons.written[part], &border));
                borders.push(border);
            }
            self.gathered.push(Gathered {
                rendition: index,
                borders,
                edges,
                normal: turned(own),
                viewer: viewer(state, center),
                front,
                back,
                pen: pen.clone(),
                outline: polygon
                    .outline_hue_deg
                    .map_or((state.hue_deg, state.saturation), |hue_deg| (hue_deg, 1.0)),
            });
        }
        true
    }

    fn materials(&self, attributes: Option<NameId>, state: &State) -> (Material, Material) {
        let plain = Material {
            colour: rgb(state.hue_deg, state.saturation, 1.0),
            ..Material::default()
        };
        let node = attributes.and_then(|name| self.names.node(name));
        match node
            .and_then(|node| self.structure.slot(node))
            .map(|slot| &slot.body)
        {
            Some(Body::Attributes(written)) => {
                let front = material(&written.front, plain);
                (front, written.back.map_or(front, |back| material(&back, front)))
            }
            _ => (plain, plain),
        }
    }

    /// Draws everything gathered.
    pub(super) fn finish_faces(&mut self) {
        let gathered = std::mem::take(&mut self.gathered);
        let renditions = std::mem::take(&mut self.renditions);
        let outside = std::mem::take(&mut self.lights);
        let outside = self.list_lights(&outside);
        for (index, rendition) in renditions.iter().enumerate() {
            let Some(drawing) = rendition.rendering.shown else {
                continue;
            };
            let faces = gathered
                .iter()
                .filter(|face| usize::from(face.rendition) == index);
            let lights = if rendition.lights.is_empty() {
                outside.clone()
            } else {
                self.list_lights(&rendition.lights)
            };
            let mut cut = Vec::new();
            for face in faces.clone() {
                self.draw_face(face, drawing, rendition, &lights, &mut cut);
            }
            if let (Some(face), Some(plane)) = (faces.clone().next(), rendition.plane) {
                self.draw_cut(face, drawing, plane, rendition.rendering.solid, &lights, &cut);
            }
        }
    }

    fn list_lights(&mut self, lights: &[Light]) -> std::ops::Range<u16> {
        let end = |list: &[Light]| u16::try_from(list.len()).unwrap_or(u16::MAX);
        let first = end(&self.list.lights);
        self.list.lights.extend_from_slice(lights);
        first..end(&self.list.lights)
    }

    fn draw_face(
        &mut self,
        face: &Gathered,
        drawing: Drawing,
        rendition: &Rendition,
        lights: &std::ops::Range<u16>,
        cut: &mut Vec<[DVec3; 2]>,
    ) {
        let plane = rendition
            .plane
            .filter(|_| matches!(drawing, Drawing::CrossSection | Drawing::Sectioned));
        if let Some(plane) = plane {
            section::crossings(plane, &face.borders, cut);
        }
        let solid = rendition.rendering.solid;
        let (fill, one_sided, lines) = match drawing {
            Drawing::CrossSection if plane.is_some() => return,
            Drawing::CrossSection => (Fill::Empty, false, true),
            Drawing::Sectioned => (Fill::Hides, false, true),
            Drawing::BackFacesRemoved => (Fill::Empty, true, true),
            Drawing::HiddenLinesRemoved => (Fill::Hides, solid, true),
            Drawing::Wash => (Fill::Wash, solid, false),
            Drawing::Flat => (Fill::Flat, solid, false),
            Drawing::Smooth => (Fill::Smooth, solid, false),
        };
        let mut borders = face.borders.clone();
        let mut edges = if lines { face.edges.clone() } else { Vec::new() };
        if let Some(plane) = plane {
            let mut spare = Vec::new();
            for border in &mut borders {
                cut_face(plane, border, &mut spare);
            }
            edges.retain_mut(|edge| cut_edge(plane, edge));
        }
        self.push_face(face, (&borders, &edges), (fill, one_sided), lights);
    }

    /// The lines in which a section cuts, and the faces that close a solid there.
    fn draw_cut(
        &mut self,
        like: &Gathered,
        drawing: Drawing,
        plane: DVec4,
        solid: bool,
        lights: &std::ops::Range<u16>,
        cut: &[[DVec3; 2]],
    ) {
        if drawing == Drawing::Sectioned && solid {
            let normal = plane.truncate();
            let vertex = |at| Vertex { at, normal };
            let close = |border: Vec<DVec3>| border.into_iter().map(vertex).collect();
            let borders: Vec<Vec<Vertex>> = section::borders(cut).into_iter().map(close).collect();
            self.push_face(like, (&borders, cut), (Fill::Hides, false), lights);
        } else {
            self.push_face(like, (&[], cut), (Fill::Empty, false), lights);
        }
    }

    fn push_face(
        &mut self,
        face: &Gathered,
        (borders, edges): (&[Vec<Vertex>], &[[DVec3; 2]]),
        (fill, one_sided): (Fill, bool),
        lights: &std::ops::Range<u16>,
    ) {
        let end = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
        let (first_corner, first_edge) = (end(self.list.corners.len()), end(self.list.edges.len()));
        let mut spare = Vec::new();
        for border in borders {
            let mut border = border.clone();
            face.pen.cut_face(&mut border, &mut spare);
            let corner = |(index, vertex): (usize, &Vertex)| Corner {
                at: vertex.at,
                normal: vertex.normal.try_normalize().unwrap_or(face.normal),
                begins: index == 0,
            };
            self.list.corners.extend(border.iter().enumerate().map(corner));
        }
        for [from, to] in edges {
            if let Some((mut stroke, _)) = face.pen.seen(*from, *to, 1.0) {
                (stroke.hue_deg, stroke.saturation) = face.outline;
                self.list.edges.push(stroke);
            }
        }
        let (corners, edges) = (
            first_corner..end(self.list.corners.len()),
            first_edge..end(self.list.edges.len()),
        );
        if corners.is_empty() && edges.is_empty() {
            return;
        }
        let (front, back) = (self.list_material(face.front), self.list_material(face.back));
        self.list.faces.push(Face {
            corners,
            edges,
            fill,
            one_sided,
            normal: face.normal,
            viewer: face.viewer,
            front,
            back,
            lights: lights.clone(),
            cue: face.pen.brightness,
            view: face.pen.view,
        });
    }

    fn list_material(&mut self, material: Material) -> u16 {
        let materials = &mut self.list.materials;
        if let Some(index) = materials.iter().rposition(|known| *known == material) {
            return index as u16;
        }
        if materials.len() < usize::from(u16::MAX) {
            materials.push(material);
        }
        materials.len() as u16 - 1
    }
}

/// Lights of one rendering; more only make it white.
const LIGHTS_MAX: usize = 64;

fn hard_edges<'a>(polygon: &'a Polygon, border: &'a [Vertex]) -> impl Iterator<Item = [DVec3; 2]> + 'a {
    let next = border.iter().cycle().skip(1);
    let ends = border.iter().zip(next).map(|(a, b)| [a.at, b.at]);
    let hard = polygon.vertices.iter().map(|vertex| !vertex.soft);
    ends.zip(hard).filter(|(_, hard)| *hard).map(|(ends, _)| ends)
}

/// Towards the eye from a place, both in the space lights are in. Nothing where the host's camera applies.
fn viewer(state: &State, at: DVec3) -> Option<DVec3> {
    let screen = state.screen_from_world?;
    let perspective = screen.row(3).truncate() != DVec3::ZERO;
    let towards = if perspective { (-at).try_normalize() } else { None };
    Some(towards.unwrap_or(DVec3::NEG_Z))
}

fn material(surface: &Surface, absent: Material) -> Material {
    Material {
        colour: surface
            .color
            .map_or(absent.colour, |c| rgb(c.hue_deg, c.saturation, c.intensity)),
        opaque: surface.opaque.unwrap_or(absent.opaque).clamp(0.0, 1.0),
        diffuse: surface.diffuse.unwrap_or(absent.diffuse).clamp(0.0, 1.0),
        specular: surface.specular.unwrap_or(absent.specular).max(0.0),
    }
}

/// Keeps the part of a line behind a section; false where there is none.
fn cut_edge(plane: DVec4, edge: &mut [DVec3; 2]) -> bool {
    let [a, b] = *edge;
    let [s, t] = edge.map(|at| plane.dot(at.extend(1.0)));
    if s < 0.0 && t < 0.0 {
        return false;
    }
    if s < 0.0 {
        edge[0] = a.lerp(b, s / (s - t));
    } else if t < 0.0 {
        edge[1] = a.lerp(b, s / (s - t));
    }
    true
}
