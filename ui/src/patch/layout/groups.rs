//! Unfolded structures: each is laid out by itself, then takes part in the whole as one large box, so that its
//! frame holds its own boxes and no others.

use glam::Vec2;

use super::{Edge, Graph, Node, Placed, ROW_GAP, arrange};
use crate::patch::area::Area;
use crate::patch::look::Role;
use crate::patch::scene::Scene;

/// Between a frame and its boxes, points.
const FRAME_PAD: f32 = 16.0;
/// Height of a frame's title, points.
pub const FRAME_TITLE: f32 = 22.0;
/// Boxes in a column of a frame without wires inside.
const STACK_MAX: usize = 12;

/// Lays out a whole scene. `was` says where a box has been, by its place in the scene.
pub fn arrange_scene(scene: &Scene, was: &dyn Fn(usize) -> Option<Vec2>) -> Placed {
    let outer = Outer::new(scene, was);
    let whole = arrange(&outer.graph);
    let mut placed = Placed {
        at: vec![Vec2::ZERO; scene.boxes.len()],
        lanes: vec![Vec::new(); scene.wires.len()],
    };
    for (index, seat) in outer.seats.iter().enumerate() {
        placed.at[index] = whole.at[seat.node] + seat.within;
    }
    for (lanes, &wire) in whole.lanes.into_iter().zip(&outer.wires) {
        placed.lanes[wire] = lanes;
    }
    for (lanes, frame, wire) in outer.inner {
        let origin = whole.at[frame];
        placed.lanes[wire] = lanes.into_iter().map(|ends| ends.map(|at| at + origin)).collect();
    }
    placed
}

/// The frame around boxes at these places.
pub fn frame_around(members: impl Iterator<Item = Area>) -> Option<Area> {
    let mut area = members.reduce(Area::union)?.grown(FRAME_PAD);
    area.min.y -= FRAME_TITLE - FRAME_PAD / 2.0;
    Some(area)
}

/// A node's places in the whole.
#[derive(Clone, Copy, Default)]
struct Seat {
    node: usize,
    within: Vec2,
}

/// The graph of boxes and frames.
struct Outer {
    graph: Graph,
    /// By box of the scene.
    seats: Vec<Seat>,
    /// By edge of the graph, the wire of the scene.
    wires: Vec<usize>,
    /// Wires inside frames: lanes from the frame's corner, the frame's node, the wire.
    inner: Vec<(Vec<[Vec2; 2]>, usize, usize)>,
}

impl Outer {
    fn new(scene: &Scene, was: &dyn Fn(usize) -> Option<Vec2>) -> Outer {
        let mut outer = Outer {
            graph: Graph::default(),
            seats: vec![Seat::default(); scene.boxes.len()],
            wires: Vec::new(),
            inner: Vec::new(),
        };
        let mut frame_of = vec![usize::MAX; scene.boxes.len()];
        for (number, frame) in scene.frames.iter().enumerate() {
            for &member in &frame.members {
                frame_of[member] = number;
            }
        }
        let mut begun = vec![usize::MAX; scene.frames.len()];
        for index in 0..scene.boxes.len() {
            let Some(frame) = scene.frames.get(frame_of[index]) else {
                outer.seats[index].node = outer.graph.nodes.len();
                outer.graph.nodes.push(node(scene, index, was));
                continue;
            };
            if begun[frame_of[index]] == usize::MAX {
                begun[frame_of[index]] = outer.graph.nodes.len();
                outer.take_frame(scene, &frame.members, was);
            }
        }
        for (index, wire) in scene.wires.iter().enumerate() {
            let (from, to) = (wire.from.0, wire.to.0);
            if frame_of[from] != usize::MAX && frame_of[from] == frame_of[to] {
                continue;
            }
            outer.wires.push(index);
            outer.graph.edges.push(Edge {
                from: outer.seats[from].node,
                to: outer.seats[to].node,
                from_y: outer.seats[from].within.y + scene.boxes[from].port_y(wire.from.1),
                to_y: outer.seats[to].within.y + scene.boxes[to].port_y(wire.to.1),
            });
        }
        outer
    }

    fn take_frame(&mut self, scene: &Scene, members: &[usize], was: &dyn Fn(usize) -> Option<Vec2>) {
        let inside = |index: usize| members.iter().position(|&member| member == index);
        let mut graph = Graph {
            nodes: members.iter().map(|&member| node(scene, member, was)).collect(),
            edges: Vec::new(),
        };
        let mut wires = Vec::new();
        for (index, wire) in scene.wires.iter().enumerate() {
            if let (Some(from), Some(to)) = (inside(wire.from.0), inside(wire.to.0)) {
                wires.push(index);
                graph.edges.push(Edge {
                    from,
                    to,
                    from_y: scene.boxes[wire.from.0].port_y(wire.from.1),
                    to_y: scene.boxes[wire.to.0].port_y(wire.to.1),
                });
            }
        }
        let placed = if graph.edges.is_empty() {
            stacked(&graph)
        } else {
            arrange(&graph)
        };
        let areas = graph
            .nodes
            .iter()
            .zip(&placed.at)
            .map(|(n, &at)| Area::new(at, n.size));
        let frame = frame_around(areas).unwrap_or_default();
        let number = self.graph.nodes.len();
        for (&member, &at) in members.iter().zip(&placed.at) {
            self.seats[member] = Seat {
                node: number,
                within: at - frame.min,
            };
        }
        for (lanes, wire) in placed.lanes.into_iter().zip(wires) {
            let lanes = lanes
                .into_iter()
                .map(|ends| ends.map(|at| at - frame.min))
                .collect();
            self.inner.push((lanes, number, wire));
        }
        self.graph.nodes.push(Node {
            size: frame.size(),
            first: false,
            last: graph.nodes.iter().all(|n| n.last),
            was: graph.nodes.iter().filter_map(|n| n.was).reduce(Vec2::min),
        });
    }
}

fn node(scene: &Scene, index: usize, was: &dyn Fn(usize) -> Option<Vec2>) -> Node {
    let shown = &scene.boxes[index];
    Node {
        size: shown.size,
        // Dials send, labels and lamps only show.
        first: shown.role == Role::Device && !shown.outputs.is_empty(),
        last: shown.outputs.is_empty() && !matches!(shown.role, Role::Function | Role::Variable),
        was: was(index),
    }
}

/// Columns from top to bottom in the order of definition, which in a structure is the order of effect.
fn stacked(graph: &Graph) -> Placed {
    let mut at = Vec::new();
    let mut next = Vec2::ZERO;
    let mut widest: f32 = 0.0;
    for (index, node) in graph.nodes.iter().enumerate() {
        if index > 0 && index % STACK_MAX == 0 {
            next = Vec2::new(next.x + widest + ROW_GAP, 0.0);
            widest = 0.0;
        }
        at.push(next);
        next.y += node.size.y + ROW_GAP * 0.6;
        widest = widest.max(node.size.x);
    }
    Placed {
        at,
        lanes: Vec::new(),
    }
}
