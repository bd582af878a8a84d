use glam::Vec2;
use proptest::prelude::*;

use super::*;
use crate::patch::area::Area;

fn node(height: f32) -> Node {
    Node {
        size: Vec2::new(160.0, height),
        ..Node::default()
    }
}

fn edge(from: usize, to: usize) -> Edge {
    Edge {
        from,
        to,
        from_y: 30.0,
        to_y: 30.0,
    }
}

fn graph(heights: &[f32], pairs: &[(usize, usize)]) -> Graph {
    Graph {
        nodes: heights.iter().map(|&height| node(height)).collect(),
        edges: pairs.iter().map(|&(from, to)| edge(from, to)).collect(),
    }
}

fn graphs() -> impl Strategy<Value = Graph> {
    (1_usize..60).prop_flat_map(|count| {
        let heights = prop::collection::vec(30.0_f32..200.0, count);
        let pairs = prop::collection::vec((0..count, 0..count), 0..count * 2);
        (heights, pairs).prop_map(|(heights, pairs)| graph(&heights, &pairs))
    })
}

fn areas(graph: &Graph, placed: &Placed) -> Vec<Area> {
    graph
        .nodes
        .iter()
        .zip(&placed.at)
        .map(|(node, &at)| Area::new(at, node.size))
        .collect()
}

/// Edges that an order of definition says run forward, which a network without feedback always has.
fn acyclic() -> impl Strategy<Value = Graph> {
    graphs().prop_map(|mut graph| {
        for edge in &mut graph.edges {
            (edge.from, edge.to) = (edge.from.min(edge.to), edge.from.max(edge.to));
        }
        graph
    })
}

proptest! {
    #[test]
    fn nothing_covers_anything(graph in graphs()) {
        let placed = arrange(&graph);
        let areas = areas(&graph, &placed);
        for (index, a) in areas.iter().enumerate() {
            prop_assert!(a.min.cmpge(Vec2::ZERO).all() && a.max.is_finite(), "{a:?}");
            for b in &areas[index + 1..] {
                prop_assert!(!a.grown(4.0).meets(*b), "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn without_feedback_every_wire_runs_to_the_right(graph in acyclic()) {
        let placed = arrange(&graph);
        for edge in graph.edges.iter().filter(|edge| edge.from != edge.to) {
            let (from, to) = (placed.at[edge.from], placed.at[edge.to]);
            prop_assert!(to.x >= from.x + graph.nodes[edge.from].size.x + 20.0);
        }
        for lanes in &placed.lanes {
            prop_assert!(lanes.windows(2).all(|pair| pair[0][1].x < pair[1][0].x));
        }
    }

    #[test]
    fn the_same_graph_looks_the_same(graph in graphs()) {
        prop_assert_eq!(arrange(&graph), arrange(&graph));
    }
}

#[test]
fn a_row_of_boxes_is_one_level_line() {
    let pairs: Vec<(usize, usize)> = (1..20).map(|n| (n - 1, n)).collect();
    let placed = arrange(&graph(&[60.0; 20], &pairs));
    assert!(
        placed.at.iter().all(|at| at.y == placed.at[0].y),
        "{:?}",
        placed.at
    );
}

#[test]
fn a_long_wire_is_level_past_what_it_passes() {
    // 0 feeds 1, 1 feeds 2, 2 feeds 3, and 0 feeds 3 directly.
    let graph = graph(&[60.0; 4], &[(0, 1), (1, 2), (2, 3), (0, 3)]);
    let placed = arrange(&graph);
    let lanes = &placed.lanes[3];
    assert_eq!(lanes.len(), 2, "{placed:?}");
    assert_eq!(lanes[0][0].y, lanes[1][1].y);
    for area in &areas(&graph, &placed)[1..3] {
        assert!(lanes.iter().flatten().all(|at| !area.contains(*at)), "{placed:?}");
    }
}

#[test]
fn wires_of_a_comb_do_not_cross() {
    // The dials of one box, each to a function of its own, defined in another order.
    let mut comb = graph(&[200.0, 60.0, 60.0, 60.0, 60.0], &[]);
    comb.nodes[0].first = true;
    for (to, port) in [(1, 3), (2, 0), (3, 2), (4, 1)] {
        comb.edges.push(Edge {
            from: 0,
            to,
            from_y: 40.0 + port as f32 * 18.0,
            to_y: 30.0,
        });
    }
    let placed = arrange(&comb);
    let y = |n: usize| placed.at[n].y;
    assert!(y(2) < y(4) && y(4) < y(3) && y(3) < y(1), "{:?}", placed.at);
}

#[test]
fn a_small_edit_moves_little() {
    let mut before = graph(&[], &[]);
    for chain in 0..40 {
        before.nodes.push(Node {
            first: true,
            ..node(50.0)
        });
        for step in 1..6 {
            let at = before.nodes.len();
            before.nodes.push(node(50.0 + step as f32 * 9.0));
            before.edges.push(edge(at - 1, at));
            if chain > 0 && step == 3 {
                before.edges.push(edge(at - 6, at));
            }
        }
    }
    let first = arrange(&before);
    let mut after = before.clone();
    for (node, &at) in after.nodes.iter_mut().zip(&first.at) {
        node.was = Some(at);
    }
    let added = after.nodes.len();
    after.nodes.push(node(60.0));
    after.edges.push(edge(100, added));
    let second = arrange(&after);
    let mut moved: Vec<f32> = first
        .at
        .iter()
        .zip(&second.at)
        .map(|(a, b)| a.distance(*b))
        .collect();
    moved.sort_by(f32::total_cmp);
    assert!(
        moved[moved.len() / 2] < 100.0,
        "half moved {} or more",
        moved[moved.len() / 2]
    );
}

/// A network like those people make: chains of a few functions from dials to nodes, with some wires across.
pub(super) fn large(boxes: usize) -> Graph {
    let mut made = Graph::default();
    let mut seed = 7_u64;
    let mut draw = |below: usize| {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % below
    };
    for index in 0..boxes {
        made.nodes.push(Node {
            first: index < 4,
            ..node(50.0 + 18.0 * draw(5) as f32)
        });
        if index >= 4 {
            for _ in 0..2 {
                let back = 1 + draw(index.min(40));
                made.edges.push(edge(index - back, index));
            }
        }
    }
    made
}

#[test]
fn the_work_grows_about_as_the_network() {
    // Counted, not timed: corners are what a layout's cost is made of.
    for boxes in [500, 2000, 4000] {
        let graph = large(boxes);
        let turned = cycles::turned(&graph);
        let layer = layers::assign(&graph, &turned);
        let layered = lanes::layered(&graph, &turned, layer);
        let pieces = layered.size.len() + layered.links.len();
        assert!(pieces < 12 * boxes, "{boxes} boxes became {pieces} pieces");
    }
}
