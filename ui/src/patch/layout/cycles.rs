//! Which edges run against the flow: feedback, found by walking from what hands drive.

use super::Graph;

/// By edge, whether it is feedback; without those (and without loops at one node) the graph has no cycle.
pub(super) fn turned(graph: &Graph) -> Vec<bool> {
    let mut out: Vec<Vec<usize>> = vec![Vec::new(); graph.nodes.len()];
    let mut arriving = vec![0_usize; graph.nodes.len()];
    for (index, edge) in graph.edges.iter().enumerate() {
        if edge.from != edge.to {
            out[edge.from].push(index);
            arriving[edge.to] += 1;
        }
    }
    let mut starts: Vec<usize> = (0..graph.nodes.len()).collect();
    // Devices, then whatever nothing arrives at, then in the order of definition.
    starts.sort_by_key(|&n| (!graph.nodes[n].first, arriving[n] > 0, n));
    let mut turned = vec![false; graph.edges.len()];
    let mut state = vec![State::New; graph.nodes.len()];
    let mut path: Vec<(usize, usize)> = Vec::new();
    for start in starts {
        if state[start] == State::New {
            state[start] = State::Open;
            path.push((start, 0));
        }
        while let Some((node, next)) = path.last_mut() {
            let Some(&edge) = out[*node].get(*next) else {
                state[*node] = State::Done;
                path.pop();
                continue;
            };
            *next += 1;
            let to = graph.edges[edge].to;
            match state[to] {
                State::Open => turned[edge] = true,
                State::New => {
                    state[to] = State::Open;
                    path.push((to, 0));
                }
                State::Done => {}
            }
        }
    }
    turned
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    New,
    Open,
    Done,
}
