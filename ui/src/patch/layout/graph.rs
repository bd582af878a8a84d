//! What is laid out: rectangles, and edges that leave at the right and arrive at the left at given heights.

use glam::Vec2;

/// A graph whose places are wanted.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// In the order of definition, which decides where nothing else does.
    pub nodes: Vec<Node>,
    /// Any number between the same two; those from a node to itself count for nothing.
    pub edges: Vec<Edge>,
}

/// One rectangle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Node {
    /// Width and height.
    pub size: Vec2,
    /// Belongs at the left: what hands drive.
    pub first: bool,
    /// Belongs at the right: what is driven.
    pub last: bool,
    /// Where it was before, if it was.
    pub was: Option<Vec2>,
}

/// One edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Where it leaves.
    pub from: usize,
    /// Where it arrives.
    pub to: usize,
    /// Height of the port below the top of `from`.
    pub from_y: f32,
    /// Height of the port below the top of `to`.
    pub to_y: f32,
}

/// Where everything is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placed {
    /// Upper left corners, by node.
    pub at: Vec<Vec2>,
    /// By edge, the stretches on which it runs level past other columns: left end and right end of each.
    pub lanes: Vec<Vec<[Vec2; 2]>>,
}

/// Room between columns, points.
pub const COLUMN_GAP: f32 = 72.0;
/// Room between boxes of a column, points.
pub const ROW_GAP: f32 = 22.0;
/// Room between parts that are not connected, points.
pub const PART_GAP: f32 = 56.0;
