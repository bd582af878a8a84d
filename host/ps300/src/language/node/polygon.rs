//! Faces.

use glam::DVec3;

use crate::language::Name;

/// `POLYGON [WITH ATTRIBUTES a] [WITH OUTLINE h] [COPLANAR] vertex vertex vertex …`.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// `WITH ATTRIBUTES`: an [`super::Attributes`] node.
    pub attributes: Option<Name>,
    /// `WITH OUTLINE`: the hue of its edges, in degrees, where they are drawn.
    pub outline_hue_deg: Option<f64>,
    /// `COPLANAR`: in the plane of the polygon before it, of which it is a hole or another part.
    pub coplanar: bool,
    /// In order around the face, at least [`Polygon::VERTICES_MIN`].
    pub vertices: Vec<PolygonVertex>,
}

impl Polygon {
    /// Fewer have no inside.
    pub const VERTICES_MIN: usize = 3;
}

/// A corner of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolygonVertex {
    /// In the node's own space.
    pub at: DVec3,
    /// `S`: the edge from here to the next vertex is soft: no line is drawn for it, and smooth shading goes across.
    pub soft: bool,
    /// `N`: the normal for smooth shading, of any length; absent, it follows from the faces around.
    pub normal: Option<DVec3>,
}
