//! Networks that are not connected, set beside each other like paragraphs; single boxes below them in rows.

use glam::Vec2;

use super::{Edge, Graph, PART_GAP, Placed, ROW_GAP, arrange_part};
use crate::patch::area::Area;

/// Width of the whole, in square roots of its area.
const WIDE: f32 = 1.5;

/// Lays out any graph; its upper left corner is at zero.
pub fn arrange(graph: &Graph) -> Placed {
    let parts = parts(graph);
    let mut placed = Placed {
        at: vec![Vec2::ZERO; graph.nodes.len()],
        lanes: vec![Vec::new(); graph.edges.len()],
    };
    let mut laid: Vec<(Part, Placed, Vec2)> = Vec::new();
    let (single, joined): (Vec<Part>, Vec<Part>) = parts.into_iter().partition(|part| part.nodes.len() == 1);
    for part in joined {
        let inside = arrange_part(&part.graph);
        let size = extent(&part.graph, &inside).size();
        laid.push((part, inside, size));
    }
    let area: f32 = laid
        .iter()
        .map(|(_, _, s)| (s.x + PART_GAP) * (s.y + PART_GAP))
        .sum();
    let widest = laid.iter().map(|(_, _, s)| s.x).fold(0.0, f32::max);
    let width = (area.sqrt() * WIDE).max(widest);
    let mut shelf = Shelf::new(width, PART_GAP);
    for (part, inside, size) in &laid {
        let corner = shelf.take(*size);
        let origin = extent(&part.graph, inside).min;
        for (&node, &at) in part.nodes.iter().zip(&inside.at) {
            placed.at[node] = corner + at - origin;
        }
        for (&edge, lanes) in part.edges.iter().zip(&inside.lanes) {
            placed.lanes[edge] = lanes
                .iter()
                .map(|ends| ends.map(|at| corner + at - origin))
                .collect();
        }
    }
    let area: f32 = single
        .iter()
        .map(|p| p.graph.nodes[0].size)
        .map(|s| (s.x + ROW_GAP) * (s.y + ROW_GAP))
        .sum();
    let tallest = if laid.is_empty() {
        0.0
    } else {
        shelf.end() + PART_GAP
    };
    let mut rows = Shelf::new(width.max(area.sqrt() * WIDE), ROW_GAP);
    for part in &single {
        placed.at[part.nodes[0]] = Vec2::new(0.0, tallest) + rows.take(part.graph.nodes[0].size);
    }
    placed
}

/// All that a layout covers.
fn extent(graph: &Graph, placed: &Placed) -> Area {
    let boxes = graph
        .nodes
        .iter()
        .zip(&placed.at)
        .map(|(node, &at)| Area::new(at, node.size));
    let lanes = placed.lanes.iter().flatten().map(|&[a, b]| Area::between(a, b));
    boxes.chain(lanes).reduce(Area::union).unwrap_or_default()
}

/// Rows of rectangles from left to right, a new row where the width is used up.
struct Shelf {
    width: f32,
    gap: f32,
    next: Vec2,
    height: f32,
}

impl Shelf {
    fn new(width: f32, gap: f32) -> Shelf {
        Shelf {
            width,
            gap,
            next: Vec2::ZERO,
            height: 0.0,
        }
    }

    fn take(&mut self, size: Vec2) -> Vec2 {
        if self.next.x > 0.0 && self.next.x + size.x > self.width {
            self.next = Vec2::new(0.0, self.next.y + self.height + self.gap);
            self.height = 0.0;
        }
        let at = self.next;
        self.next.x += size.x + self.gap;
        self.height = self.height.max(size.y);
        at
    }

    fn end(&self) -> f32 {
        self.next.y + self.height
    }
}

/// A connected part, and where its nodes and edges are in the whole.
struct Part {
    graph: Graph,
    nodes: Vec<usize>,
    edges: Vec<usize>,
}

fn parts(graph: &Graph) -> Vec<Part> {
    let mut root: Vec<usize> = (0..graph.nodes.len()).collect();
    for edge in &graph.edges {
        let (a, b) = (find(&mut root, edge.from), find(&mut root, edge.to));
        // The earliest defined speaks for all.
        root[a.max(b)] = a.min(b);
    }
    let mut number = vec![usize::MAX; graph.nodes.len()];
    let mut within = vec![0; graph.nodes.len()];
    let mut parts: Vec<Part> = Vec::new();
    for node in 0..graph.nodes.len() {
        let root = find(&mut root, node);
        if number[root] == usize::MAX {
            number[root] = parts.len();
            parts.push(Part {
                graph: Graph::default(),
                nodes: Vec::new(),
                edges: Vec::new(),
            });
        }
        number[node] = number[root];
        let part = &mut parts[number[root]];
        within[node] = part.nodes.len();
        part.nodes.push(node);
        part.graph.nodes.push(graph.nodes[node]);
    }
    for (index, edge) in graph.edges.iter().enumerate() {
        let part = &mut parts[number[edge.from]];
        part.edges.push(index);
        part.graph.edges.push(Edge {
            from: within[edge.from],
            to: within[edge.to],
            ..*edge
        });
    }
    parts
}

fn find(root: &mut [usize], node: usize) -> usize {
    let mut top = node;
    while root[top] != top {
        top = root[top];
    }
    let mut at = node;
    while root[at] != top {
        at = std::mem::replace(&mut root[at], top);
    }
    top
}
