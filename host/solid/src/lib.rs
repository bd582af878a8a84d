//! Polygon solids: primitives, solids of revolution, and whether a mesh is one.
//!
//! Knows: vertices shared by index, polygons of any number of corners, the counts and measures that tell
//! a solid from a heap of polygons. Must not know: colour, files, display structures, figures, curves (a
//! revolved curve arrives as points).
//!
//! Start at [`Mesh`]; then [`primitive`] and [`Revolution`]. `cargo run -p solid --example counts` prints
//! what each primitive is made of.
//!
//! Lengths are in whatever unit the caller uses, angles in radians. Spaces are right-handed here: faces
//! run anticlockwise seen from outside.

mod measure;
mod mesh;
pub mod primitive;
mod revolution;
mod topology;

pub use measure::Bounds;
pub use mesh::{Mesh, MeshError};
pub use primitive::PrimitiveError;
pub use revolution::{Axis, Fill, ProfileEnds, Revolution, RevolutionError, Turn};
pub use topology::{OpenEdge, Topology};
