//! Area, volume and extent of a mesh.
//!
//! Polygons are measured by their area vector (half the sum of the cross products of neighbouring
//! corners), which needs no triangulation and is right for non-convex polygons as well.
//! Source: `docs/math.md`, section "Solids".

use glam::DVec3;

use crate::Mesh;

/// The smallest box with sides along the axes that holds all vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The smallest of each coordinate.
    pub min: DVec3,
    /// The largest of each coordinate.
    pub max: DVec3,
}

impl Bounds {
    /// The middle of the box.
    pub fn centre(self) -> DVec3 {
        self.min.midpoint(self.max)
    }
}

impl Mesh {
    /// The sum of the areas of the faces; exact if they are planar.
    pub fn area(&self) -> f64 {
        self.faces()
            .iter()
            .map(|face| self.area_vector(face).length())
            .sum()
    }

    /// The enclosed volume of a closed mesh, negative where faces run clockwise seen from outside.
    /// Without meaning if the mesh is open.
    pub fn signed_volume(&self) -> f64 {
        // Measured from the middle, so that a small solid far from the origin keeps its digits.
        let Some(origin) = self.bounds().map(Bounds::centre) else {
            return 0.0;
        };
        let of_face = |face: &Vec<u32>| {
            let corner = self.vertices()[face[0] as usize];
            self.area_vector(face).dot(corner - origin)
        };
        self.faces().iter().map(of_face).sum::<f64>() / 3.0
    }

    /// Whether the faces of a closed mesh are turned outward: a light shines on the side one sees.
    pub fn is_outward(&self) -> bool {
        self.signed_volume() > 0.0
    }

    /// The extent of all vertices, also those that no face uses; none if there are none.
    pub fn bounds(&self) -> Option<Bounds> {
        let (&first, rest) = self.vertices().split_first()?;
        let bounds = Bounds {
            min: first,
            max: first,
        };
        Some(rest.iter().fold(bounds, |bounds, &at| Bounds {
            min: bounds.min.min(at),
            max: bounds.max.max(at),
        }))
    }

    /// As long as the polygon is large, pointing to where its corners run anticlockwise.
    pub fn area_vector(&self, face: &[u32]) -> DVec3 {
        let mut corners = self.corners(face);
        let Some(first) = corners.next() else {
            return DVec3::ZERO;
        };
        let mut doubled = DVec3::ZERO;
        let mut before = DVec3::ZERO;
        for corner in corners {
            let spoke = corner - first;
            doubled += before.cross(spoke);
            before = spoke;
        }
        doubled / 2.0
    }
}
