//! Rendered polygons: borders to fill, edges to draw, and what both look like.
//!
//! Which side of a face is seen depends on the camera, so hosts decide it: a face whose first border goes
//! clockwise on the screen is seen from its front.

use std::ops::Range;

use glam::DVec3;

/// How the inside of a face is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// Not at all.
    Empty,
    /// In the colour of the ground, so that it hides what is behind.
    Hides,
    /// In its own colour, whatever the light.
    Wash,
    /// Lit, with one normal for all of it.
    Flat,
    /// Lit, with a normal for each point.
    Smooth,
}

/// One polygon with its holes. What lies inside an odd number of its borders is filled.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Its borders in [`super::DisplayList::corners`].
    pub corners: Range<u32>,
    /// Its edges in [`super::DisplayList::edges`].
    pub edges: Range<u32>,
    /// What is drawn inside.
    pub fill: Fill,
    /// Whether nothing of it is drawn where it is seen from behind.
    pub one_sided: bool,
    /// Of length 1, on either side; where it points away from the viewer, those of the corners do too and
    /// are to be turned round. In the space lights are in.
    pub normal: DVec3,
    /// Towards the eye in the same space; nothing where the host's camera applies.
    pub viewer: Option<DVec3>,
    /// Of the front, in [`super::DisplayList::materials`].
    pub front: u16,
    /// Of the back.
    pub back: u16,
    /// What shines on it, in [`super::DisplayList::lights`]; where there is nothing, white light comes from
    /// the viewer.
    pub lights: Range<u16>,
    /// Brightness at depth 0 and what is added towards depth 1; the depth cue of a projection of its own.
    pub cue: [f64; 2],
    /// Index into [`super::DisplayList::views`].
    pub view: u16,
}

/// A corner of a border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// In world space.
    pub at: DVec3,
    /// Of length 1, on the side of the face's own; in the space lights are in.
    pub normal: DVec3,
    /// Whether a border begins here; it ends before the next that does, and is closed.
    pub begins: bool,
}

/// How one side of a face answers light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Red, green, blue, 0 to 1.
    pub colour: DVec3,
    /// 0 lets everything through, 1 nothing.
    pub opaque: f64,
    /// How much light is scattered, 0 to 1; the rest is mirrored.
    pub diffuse: f64,
    /// How sharp a highlight is: an exponent, from 0.
    pub specular: f64,
}

impl Default for Material {
    /// White, opaque, and nearly dull. Source: D0's polygons have diffuse 0.75 and specular 5.
    fn default() -> Self {
        Self {
            colour: DVec3::ONE,
            opaque: 1.0,
            diffuse: 0.75,
            specular: 5.0,
        }
    }
}

/// Light from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Towards where it comes from, of length 1. In the space below the last projection, or in world space
    /// where the host's camera applies.
    pub towards: DVec3,
    /// Red, green, blue, 0 to 1.
    pub colour: DVec3,
    /// How much of it is everywhere, 0 to 1.
    pub ambient: f64,
}
