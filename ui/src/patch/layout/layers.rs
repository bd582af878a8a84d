//! Columns: each node to the right of all that feed it.

use super::Graph;

/// Columns whose boxes need more height than this share of the square root of all area are divided.
const TALL: f32 = 0.9;
/// Nor are columns below this height ever divided, points.
const TALL_MIN: f32 = 1200.0;
/// In deeper networks what is driven stays near what drives it.
const DEEP: usize = 14;

/// By node, its column from 0.
pub(super) fn assign(graph: &Graph, turned: &[bool]) -> Vec<usize> {
    let flow = Flow::new(graph, turned);
    let mut layer = vec![0; graph.nodes.len()];
    for &node in &flow.order {
        for &to in &flow.out[node] {
            layer[to] = layer[to].max(layer[node] + 1);
        }
    }
    let deepest = layer.iter().copied().max().unwrap_or(0);
    for &node in flow.order.iter().rev() {
        let nearest = flow.out[node].iter().map(|&to| layer[to]).min();
        let made_of_nothing = flow.into[node].is_empty() && !graph.nodes[node].first;
        match nearest {
            Some(nearest) if made_of_nothing => layer[node] = nearest - 1,
            Some(nearest) if flow.out[node].len() > flow.into[node].len() && !graph.nodes[node].first => {
                layer[node] = nearest - 1;
            }
            None if graph.nodes[node].last && deepest <= DEEP => layer[node] = deepest,
            _ => {}
        }
    }
    divide(graph, &mut layer);
    layer
}

/// Edges in the direction of flow, and the nodes in an order in which all of them point forward.
struct Flow {
    out: Vec<Vec<usize>>,
    into: Vec<Vec<usize>>,
    order: Vec<usize>,
}

impl Flow {
    fn new(graph: &Graph, turned: &[bool]) -> Flow {
        let count = graph.nodes.len();
        let (mut out, mut into) = (vec![Vec::new(); count], vec![Vec::new(); count]);
        for (edge, &turned) in graph.edges.iter().zip(turned) {
            if edge.from == edge.to {
                continue;
            }
            let (from, to) = if turned {
                (edge.to, edge.from)
            } else {
                (edge.from, edge.to)
            };
            out[from].push(to);
            into[to].push(from);
        }
        let mut waits: Vec<usize> = into.iter().map(Vec::len).collect();
        let mut order: Vec<usize> = (0..count).filter(|&n| waits[n] == 0).collect();
        let mut next = 0;
        while let Some(&node) = order.get(next) {
            next += 1;
            for &to in &out[node] {
                waits[to] -= 1;
                if waits[to] == 0 {
                    order.push(to);
                }
            }
        }
        Flow { out, into, order }
    }
}

/// Divides columns that are far taller than the picture is wide; nodes of one column feed none of it.
fn divide(graph: &Graph, layer: &mut [usize]) {
    let area: f32 = graph
        .nodes
        .iter()
        .map(|n| (n.size.x + 72.0) * (n.size.y + 22.0))
        .sum();
    let tall = (area.sqrt() * TALL).max(TALL_MIN);
    let count = layer.iter().copied().max().map_or(0, |deepest| deepest + 1);
    let mut columns: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (node, &column) in layer.iter().enumerate() {
        columns[column].push(node);
    }
    let mut next = 0;
    for column in columns.into_iter().filter(|column| !column.is_empty()) {
        let mut height = 0.0;
        for node in column {
            let more = graph.nodes[node].size.y + 22.0;
            if height > 0.0 && height + more > tall {
                (next, height) = (next + 1, 0.0);
            }
            height += more;
            layer[node] = next;
        }
        next += 1;
    }
}
