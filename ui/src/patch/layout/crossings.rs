//! The order of each column from top to bottom, with few crossings: barycentres of ports, swept to and fro, the
//! best order kept; then neighbours are exchanged where that helps.

use super::{Graph, Layered, Link};

/// Sweeps in each direction.
const SWEEPS: usize = 8;
/// Neighbours are exchanged only in graphs this small; larger ones are not read wire by wire.
const EXCHANGED_MAX: usize = 600;

/// Orders the columns.
pub(super) fn reduce(graph: &Graph, layered: &mut Layered) {
    let links = Neighbours::new(layered);
    first_order(graph, layered, &links);
    let mut place = places(layered);
    let mut best = (crossings(layered, &place), layered.order.clone());
    for sweep in 0..SWEEPS * 2 {
        if best.0 == 0 {
            break;
        }
        let rightward = sweep % 2 == 0;
        let columns = layered.order.len();
        for step in 1..columns {
            let column = if rightward { step } else { columns - 1 - step };
            sort_column(layered, &links, &mut place, column, rightward);
        }
        let now = crossings(layered, &place);
        if now < best.0 {
            best = (now, layered.order.clone());
        }
    }
    layered.order = best.1;
    if layered.size.len() <= EXCHANGED_MAX {
        exchange(layered, &links);
    }
}

/// Links of each node, by their places in the list.
struct Neighbours {
    left: Vec<Vec<usize>>,
    right: Vec<Vec<usize>>,
}

impl Neighbours {
    fn new(layered: &Layered) -> Neighbours {
        let count = layered.size.len();
        let (mut left, mut right) = (vec![Vec::new(); count], vec![Vec::new(); count]);
        for (index, link) in layered.links.iter().enumerate() {
            right[link.from].push(index);
            left[link.to].push(index);
        }
        for list in &mut right {
            list.sort_by(|&a, &b| {
                let y = |index: usize| layered.links[index].from_y;
                y(a).total_cmp(&y(b)).then(a.cmp(&b))
            });
        }
        Neighbours { left, right }
    }
}

/// As it was before where that is known; the rest in the order in which a walk along the ports meets it.
fn first_order(graph: &Graph, layered: &mut Layered, links: &Neighbours) {
    let count = layered.size.len();
    let mut met = vec![usize::MAX; count];
    let mut next = 0;
    let mut open: Vec<usize> = (0..count).rev().filter(|&n| links.left[n].is_empty()).collect();
    open.sort_by_key(|&n| (std::cmp::Reverse(layered.layer[n]), std::cmp::Reverse(n)));
    while let Some(node) = open.pop() {
        if met[node] != usize::MAX {
            continue;
        }
        met[node] = next;
        next += 1;
        let onward = links.right[node].iter().rev().map(|&link| layered.links[link].to);
        open.extend(onward.filter(|&to| met[to] == usize::MAX));
    }
    let was = |node: usize| graph.nodes.get(node).and_then(|n| n.was).map(|at| at.y);
    for column in &mut layered.order {
        column.sort_by_key(|&node| (met[node], node));
        let mut known: Vec<usize> = column.iter().copied().filter(|&n| was(n).is_some()).collect();
        known.sort_by(|&a, &b| was(a).unwrap_or(0.0).total_cmp(&was(b).unwrap_or(0.0)));
        let mut known = known.into_iter();
        for slot in column.iter_mut().filter(|slot| was(**slot).is_some()) {
            *slot = known.next().unwrap_or(*slot);
        }
    }
}

fn places(layered: &Layered) -> Vec<usize> {
    let mut place = vec![0; layered.size.len()];
    for column in &layered.order {
        for (at, &node) in column.iter().enumerate() {
            place[node] = at;
        }
    }
    place
}

/// Where a link's other end is, with its port as a fraction of the box.
fn end(layered: &Layered, place: &[usize], node: usize, y: f32) -> f32 {
    place[node] as f32 + (y / layered.size[node].y.max(1.0)).clamp(0.0, 1.0) * 0.9
}

fn sort_column(
    layered: &mut Layered,
    links: &Neighbours,
    place: &mut [usize],
    column: usize,
    rightward: bool,
) {
    let nodes = std::mem::take(&mut layered.order[column]);
    let wanted = |node: usize| -> Option<f32> {
        let list = if rightward {
            &links.left[node]
        } else {
            &links.right[node]
        };
        let ends = list.iter().map(|&index| {
            let link = layered.links[index];
            if rightward {
                // The port at this side too: the upper input wants the upper sender.
                end(layered, place, link.from, link.from_y) - 0.01 * link.to_y / layered.size[node].y.max(1.0)
            } else {
                end(layered, place, link.to, link.to_y)
            }
        });
        (!list.is_empty()).then(|| ends.sum::<f32>() / list.len() as f32)
    };
    let mut bound: Vec<(f32, usize)> = nodes.iter().filter_map(|&n| Some((wanted(n)?, n))).collect();
    bound.sort_by(|a, b| a.0.total_cmp(&b.0).then(place[a.1].cmp(&place[b.1])));
    let mut bound = bound.into_iter().map(|(_, node)| node);
    // What nothing pulls keeps its place.
    let sorted: Vec<usize> = nodes
        .iter()
        .map(|&n| {
            let free = if rightward {
                links.left[n].is_empty()
            } else {
                links.right[n].is_empty()
            };
            if free { n } else { bound.next().unwrap_or(n) }
        })
        .collect();
    for (at, &node) in sorted.iter().enumerate() {
        place[node] = at;
    }
    layered.order[column] = sorted;
}

/// How many pairs of links cross, by a tree of counts over the places of the left ends.
fn crossings(layered: &Layered, place: &[usize]) -> u64 {
    let mut by_column: Vec<Vec<&Link>> = vec![Vec::new(); layered.order.len()];
    for link in &layered.links {
        by_column[layered.layer[link.to]].push(link);
    }
    let mut total = 0;
    for links in &mut by_column {
        let key = |link: &Link| (place[link.from], link.from_y);
        links.sort_by(|a, b| {
            let (a, b) = ((key(a), place[a.to], a.to_y), (key(b), place[b.to], b.to_y));
            a.0.0
                .cmp(&b.0.0)
                .then(a.0.1.total_cmp(&b.0.1))
                .then(a.1.cmp(&b.1))
                .then(a.2.total_cmp(&b.2))
        });
        let mut ends: Vec<(usize, u32)> = links.iter().map(|l| (place[l.to], l.to_y.to_bits())).collect();
        let mut ranks = ends.clone();
        ranks.sort_unstable();
        ranks.dedup();
        let mut tree = vec![0_u64; ranks.len() + 1];
        for (seen, end) in ends.drain(..).enumerate() {
            let rank = ranks.binary_search(&end).unwrap_or(0) + 1;
            let mut not_above = 0;
            let mut at = rank;
            while at > 0 {
                not_above += tree[at];
                at &= at - 1;
            }
            total += seen as u64 - not_above;
            at = rank;
            while at < tree.len() {
                tree[at] += 1;
                at += at & at.wrapping_neg();
            }
        }
    }
    total
}

/// Exchanges neighbours while that takes crossings away.
fn exchange(layered: &mut Layered, links: &Neighbours) {
    let mut place = places(layered);
    for _ in 0..4 {
        let mut better = false;
        for column in 0..layered.order.len() {
            for at in 1..layered.order[column].len() {
                let (above, below) = (layered.order[column][at - 1], layered.order[column][at]);
                if pair(layered, links, &place, below, above) < pair(layered, links, &place, above, below) {
                    layered.order[column].swap(at - 1, at);
                    place.swap(above, below);
                    better = true;
                }
            }
        }
        if !better {
            break;
        }
    }
}

/// Crossings between the links of two neighbours when `above` is above.
fn pair(layered: &Layered, links: &Neighbours, place: &[usize], above: usize, below: usize) -> usize {
    let side = |a: &[usize], b: &[usize], far: &dyn Fn(usize) -> f32| -> usize {
        let over = |x: f32| b.iter().filter(|&&other| far(other) < x).count();
        a.iter().map(|&one| over(far(one))).sum()
    };
    let left = |index: usize| {
        end(
            layered,
            place,
            layered.links[index].from,
            layered.links[index].from_y,
        )
    };
    let right = |index: usize| end(layered, place, layered.links[index].to, layered.links[index].to_y);
    side(&links.left[above], &links.left[below], &left)
        + side(&links.right[above], &links.right[below], &right)
}
