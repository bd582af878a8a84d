//! Polygons, how they look, and lights.
//! Source: `docs/protocols/ps300.md`, sections "Data nodes" and "Rendering". Ours, where the record is silent:
//! several polygons in one command, each beginning with POLYGON; WITH written once or before each of its parts.

use glam::DVec3;

use super::{Parsed, Parser};
use crate::language::token::TokenKind;
use crate::language::words;
use crate::language::{Attributes, Diagnostic, Illumination, Polygon, PolygonVertex, Surface};

impl Parser<'_> {
    /// Everything after the first POLYGON.
    pub(super) fn polygons(&mut self) -> Parsed<Vec<Polygon>> {
        let mut polygons = vec![self.polygon()?];
        while self.accept_word(words::POLYGON) {
            polygons.push(self.polygon()?);
        }
        Ok(polygons)
    }

    fn polygon(&mut self) -> Parsed<Polygon> {
        let at = self.end;
        let mut polygon = Polygon {
            attributes: None,
            outline_hue_deg: None,
            coplanar: false,
            vertices: Vec::new(),
        };
        loop {
            if self.is_word_before_one_of(words::WITH, &[words::ATTRIBUTES, words::OUTLINE]) {
                self.advance();
            } else if self.accept_word(words::ATTRIBUTES) {
                polygon.attributes = Some(self.name("the name of attributes")?);
            } else if self.accept_word(words::OUTLINE) {
                polygon.outline_hue_deg = Some(self.number("the hue of the edges, in degrees")?);
            } else if self.accept_word(words::COPLANAR) {
                polygon.coplanar = true;
            } else {
                break;
            }
        }
        loop {
            let soft = self.accept_word_before_number(words::S);
            if !soft && !matches!(self.current.kind, TokenKind::Number(_)) {
                break;
            }
            let at = self.point("a corner of the polygon")?;
            let normal = if self.accept_word_before_number(words::N) {
                Some(self.point("a normal")?)
            } else {
                None
            };
            polygon.vertices.push(PolygonVertex { at, soft, normal });
        }
        if polygon.vertices.is_empty() {
            let known = [words::WITH, words::COPLANAR, words::S];
            return Err(self.unknown_word("a corner of the polygon: [S] x,y,z [N x,y,z]", &known));
        }
        if polygon.vertices.len() < Polygon::VERTICES_MIN {
            let message = format!("a polygon of {} corners", polygon.vertices.len());
            return Err(Diagnostic::error(at, message).expecting("three or more").into());
        }
        Ok(polygon)
    }

    /// Everything after ATTRIBUTES.
    pub(super) fn attributes(&mut self) -> Parsed<Attributes> {
        let front = self.surface()?;
        let back = if self.accept_word(words::AND) {
            Some(self.surface()?)
        } else {
            None
        };
        Ok(Attributes { front, back })
    }

    fn surface(&mut self) -> Parsed<Surface> {
        let mut surface = Surface::default();
        loop {
            if self.accept_word(words::COLOR) {
                surface.color = Some(self.surface_color()?);
            } else if self.accept_word(words::OPAQUE) {
                surface.opaque = Some(self.number("how opaque, from 0 to 1")?);
            } else if self.accept_word(words::DIFFUSE) {
                surface.diffuse = Some(self.number("how diffuse, from 0 to 1")?);
            } else if self.accept_word(words::SPECULAR) {
                surface.specular = Some(self.number("how sharp highlights are, from 0")?);
            } else {
                return Ok(surface);
            }
        }
    }

    /// Everything after ILLUMINATION.
    pub(super) fn illumination(&mut self) -> Parsed<Illumination> {
        let mut light = Illumination {
            direction: self.components(3, DVec3::ZERO, "the direction of the light")?.0,
            color: None,
            ambient: None,
        };
        loop {
            if self.accept_word(words::COLOR) {
                light.color = Some(self.surface_color()?);
            } else if self.accept_word(words::AMBIENT) {
                light.ambient = Some(self.number("how much of it is everywhere, from 0 to 1")?);
            } else {
                return Ok(light);
            }
        }
    }
}
