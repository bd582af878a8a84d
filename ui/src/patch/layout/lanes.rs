//! Room for long wires: a corner in every column they pass, so that they run between boxes and not behind them.

use glam::Vec2;

use super::{Graph, Layered, Link};

/// Wires that pass more columns run behind the boxes: corners for all of them would be more than the network.
const COLUMNS_MAX: usize = 10;
/// Corners for each node and edge of the graph, at most; the shortest wires have them first.
const CORNERS_EACH: usize = 2;
/// Height kept free for a wire, points.
const LANE: f32 = 4.0;
/// How much more than two boxes two corners want to be level.
const LEVEL: f32 = 8.0;

/// The graph in layers, edges cut into links between neighbours.
pub(super) fn layered(graph: &Graph, turned: &[bool], layer: Vec<usize>) -> Layered {
    let real = graph.nodes.len();
    let columns = layer.iter().copied().max().map_or(0, |deepest| deepest + 1);
    let mut layered = Layered {
        real,
        size: graph.nodes.iter().map(|node| node.size).collect(),
        layer,
        order: Vec::new(),
        links: Vec::new(),
        corners: vec![Vec::new(); graph.edges.len()],
    };
    let mut budget = CORNERS_EACH * (real + graph.edges.len());
    let span = |layered: &Layered, edge: usize| {
        let edge = graph.edges[edge];
        layered.layer[edge.from].abs_diff(layered.layer[edge.to])
    };
    let mut edges: Vec<usize> = (0..graph.edges.len()).collect();
    edges.sort_by_key(|&edge| (span(&layered, edge), edge));
    for edge in edges {
        let long = span(&layered, edge);
        // Feedback returns below the boxes and needs no room between them.
        if long == 0 || turned[edge] {
            continue;
        }
        let corners = long - 1;
        if corners > COLUMNS_MAX || corners > budget {
            continue;
        }
        budget -= corners;
        cut(graph, &mut layered, edge);
    }
    layered.order = vec![Vec::new(); columns];
    for (node, &column) in layered.layer.iter().enumerate() {
        layered.order[column].push(node);
    }
    layered
}

fn cut(graph: &Graph, layered: &mut Layered, index: usize) {
    let edge = graph.edges[index];
    let (first, last) = (layered.layer[edge.from], layered.layer[edge.to]);
    let (mut from, mut from_y) = (edge.from, edge.from_y);
    for column in first + 1..last {
        let corner = layered.size.len();
        layered.size.push(Vec2::new(0.0, LANE));
        layered.layer.push(column);
        layered.corners[index].push(corner);
        let weight = if from < layered.real { 2.0 } else { LEVEL };
        layered.links.push(Link {
            from,
            to: corner,
            from_y,
            to_y: LANE / 2.0,
            weight,
        });
        (from, from_y) = (corner, LANE / 2.0);
    }
    let weight = if from < layered.real { 1.0 } else { 2.0 };
    layered.links.push(Link {
        from,
        to: edge.to,
        from_y,
        to_y: edge.to_y,
        weight,
    });
}
