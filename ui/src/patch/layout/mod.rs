//! Where boxes go: what hands drive at the left, what is driven at the right, wires short and level.
//!
//! The method is that of layered drawing (Sugiyama, Tagawa, Toda 1981; Gansner and others 1993): `cycles` turns
//! feedback around, `layers` makes columns, `lanes` gives long wires room, `crossings` orders the columns,
//! `coordinates` makes wires level, `parts` sets unconnected networks beside each other. `place` adds
//! a few boxes to a layout without moving the others. Everything is deterministic.

mod coordinates;
mod crossings;
mod cycles;
mod graph;
mod groups;
mod lanes;
mod layers;
mod parts;
pub mod place;

pub use graph::{COLUMN_GAP, Edge, Graph, Node, PART_GAP, Placed, ROW_GAP};
pub use groups::{FRAME_TITLE, arrange_scene, frame_around};
pub use parts::arrange;

use glam::Vec2;

/// One connected graph as layers: real nodes, then the corners of long edges.
struct Layered {
    /// Real nodes come first.
    real: usize,
    size: Vec<Vec2>,
    /// By node.
    layer: Vec<usize>,
    /// By layer, from top to bottom.
    order: Vec<Vec<usize>>,
    /// Only between neighbouring layers, left to right.
    links: Vec<Link>,
    /// By edge of the graph: its corners, left to right.
    corners: Vec<Vec<usize>>,
}

/// A piece of an edge between neighbouring layers.
#[derive(Clone, Copy)]
struct Link {
    from: usize,
    to: usize,
    from_y: f32,
    to_y: f32,
    /// How much it matters that it is level.
    weight: f32,
}

/// Lays out a graph in one piece, its upper left corner at zero.
fn arrange_part(graph: &Graph) -> Placed {
    let turned = cycles::turned(graph);
    let layer = layers::assign(graph, &turned);
    let mut layered = lanes::layered(graph, &turned, layer);
    crossings::reduce(graph, &mut layered);
    let tops = coordinates::tops(&layered);
    coordinates::placed(graph, &layered, &tops)
}

#[cfg(test)]
mod tests;
