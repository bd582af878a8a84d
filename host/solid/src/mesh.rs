//! A polygon mesh with shared vertices.
//!
//! Source: the polygon files of the thesis name vertices once and let polygons refer to them by number;
//! solids that repeat vertices instead cannot be told closed from open.

use glam::DVec3;

/// Vertices, and polygons that refer to them. Invariant: every face has at least three corners, all
/// different and all existing, and every coordinate is finite. Whether it encloses anything is asked of
/// [`Mesh::topology`] and [`Mesh::is_outward`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    vertices: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
}

/// Why vertices and faces are not a mesh. Positions count from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// A coordinate that is infinite or not a number.
    #[error("vertex {vertex} is at {at}, expected finite coordinates")]
    NotFinite {
        /// Which vertex.
        vertex: usize,
        /// Its coordinates.
        at: DVec3,
    },
    /// A face with fewer than three corners.
    #[error("face {face} has {corners} corners, expected at least 3")]
    TooFewCorners {
        /// Which face.
        face: usize,
        /// How many it has.
        corners: usize,
    },
    /// A corner that is not there.
    #[error("face {face} refers to vertex {vertex}, but there are only {vertices}, numbered from 0")]
    NoSuchVertex {
        /// Which face.
        face: usize,
        /// What it refers to.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A face that visits a vertex twice.
    #[error("face {face} visits vertex {vertex} twice; split the face there")]
    RepeatedVertex {
        /// Which face.
        face: usize,
        /// Visited twice.
        vertex: u32,
    },
}

impl Mesh {
    /// Checks the invariant and takes the parts.
    pub fn new(vertices: Vec<DVec3>, faces: Vec<Vec<u32>>) -> Result<Self, MeshError> {
        for (vertex, &at) in vertices.iter().enumerate() {
            if !at.is_finite() {
                return Err(MeshError::NotFinite { vertex, at });
            }
        }
        let mut sorted = Vec::new();
        for (face, corners) in faces.iter().enumerate() {
            if corners.len() < 3 {
                return Err(MeshError::TooFewCorners {
                    face,
                    corners: corners.len(),
                });
            }
            sorted.clone_from(corners);
            sorted.sort_unstable();
            if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
                return Err(MeshError::RepeatedVertex {
                    face,
                    vertex: pair[0],
                });
            }
            if let Some(&vertex) = sorted.last().filter(|&&vertex| vertex as usize >= vertices.len()) {
                return Err(MeshError::NoSuchVertex {
                    face,
                    vertex,
                    vertices: vertices.len(),
                });
            }
        }
        Ok(Self { vertices, faces })
    }

    /// For the builders of this crate, which keep the invariant by construction; tests hold them to it.
    pub(crate) fn from_parts(vertices: Vec<DVec3>, faces: Vec<Vec<u32>>) -> Self {
        debug_assert_eq!(Self::new(vertices.clone(), faces.clone()).err(), None);
        Self { vertices, faces }
    }

    /// Positions, referred to by their index.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Polygons as indices of vertices, anticlockwise seen from outside.
    pub fn faces(&self) -> &[Vec<u32>] {
        &self.faces
    }

    /// The corners of one polygon in order.
    pub fn corners<'a>(&'a self, face: &'a [u32]) -> impl Iterator<Item = DVec3> + 'a {
        face.iter().map(|&vertex| self.vertices[vertex as usize])
    }

    /// The same surface seen from the other side.
    #[must_use]
    pub fn flipped(mut self) -> Self {
        for face in &mut self.faces {
            face.reverse();
        }
        self
    }
}
