//! How the faces of a mesh hang together.
//!
//! A mesh is closed if every edge belongs to exactly two faces that run along it in opposite directions.
//! The test looks at indices only: two vertices at the same place are two vertices, and a seam between
//! them is a gap. Source: `docs/math.md`, section "Solids".

use crate::Mesh;

/// Counts of a mesh. `vertices - edges + faces` is 2 for anything that can be blown up to a ball.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topology {
    /// All vertices, also those that no face uses.
    pub vertices: usize,
    /// Pairs of vertices that are neighbours in at least one face.
    pub edges: usize,
    /// Polygons of any number of corners.
    pub faces: usize,
    /// One of the edges at which the mesh is not closed, the one with the smallest vertex numbers.
    pub open_edge: Option<OpenEdge>,
}

/// An edge that is not run along once in each direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the edge between vertices {from} and {to} is in {forward} faces one way and in {backward} the other, \
     expected one each way"
)]
pub struct OpenEdge {
    /// The smaller vertex number.
    pub from: u32,
    /// The larger.
    pub to: u32,
    /// Faces that run from `from` to `to`.
    pub forward: usize,
    /// Faces that run from `to` to `from`.
    pub backward: usize,
}

impl Topology {
    /// Vertices less edges plus faces: Euler's number.
    pub fn euler(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.faces as i64
    }

    /// Whether the mesh has faces and no open edge.
    pub fn is_closed(&self) -> bool {
        self.faces > 0 && self.open_edge.is_none()
    }
}

impl Mesh {
    /// Counts vertices, edges and faces and looks for an open edge. Time grows as E log E.
    pub fn topology(&self) -> Topology {
        let mut runs = Vec::new();
        for face in self.faces() {
            for (index, &from) in face.iter().enumerate() {
                let to = face[(index + 1) % face.len()];
                runs.push((from.min(to), from.max(to), from > to));
            }
        }
        runs.sort_unstable();

        let mut edges = 0;
        let mut open_edge = None;
        for edge in runs.chunk_by(|one, other| (one.0, one.1) == (other.0, other.1)) {
            edges += 1;
            let backward = edge.iter().filter(|run| run.2).count();
            let forward = edge.len() - backward;
            if (forward, backward) != (1, 1) && open_edge.is_none() {
                open_edge = Some(OpenEdge {
                    from: edge[0].0,
                    to: edge[0].1,
                    forward,
                    backward,
                });
            }
        }
        Topology {
            vertices: self.vertices().len(),
            edges,
            faces: self.faces().len(),
            open_edge,
        }
    }
}
