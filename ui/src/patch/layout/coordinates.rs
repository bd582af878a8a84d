//! Heights within the columns: every box as near as its neighbours let it to where its wires are level.
//!
//! Each column by itself is a least-squares problem under an order, which pooling adjacent violators solves exactly
//! (isotonic regression); sweeps to and fro carry the wishes across columns.

use glam::Vec2;

use super::{COLUMN_GAP, Graph, Layered, Placed, ROW_GAP};

/// Sweeps in each direction.
const SWEEPS: usize = 10;
/// How much a box without wires on the asking side wants to stay.
const STAY: f32 = 0.05;

/// By node, the height of its upper edge.
pub(super) fn tops(layered: &Layered) -> Vec<f32> {
    let mut tops = vec![0.0; layered.size.len()];
    for column in &layered.order {
        let mut y = 0.0;
        for &node in column {
            tops[node] = y;
            y += step(layered, node);
        }
    }
    let mut links: [Vec<Vec<usize>>; 2] = [vec![Vec::new(); tops.len()], vec![Vec::new(); tops.len()]];
    for (index, link) in layered.links.iter().enumerate() {
        links[0][link.to].push(index);
        links[1][link.from].push(index);
    }
    let columns = layered.order.len();
    for sweep in 0..SWEEPS * 2 {
        let rightward = sweep % 2 == 0;
        for step in 0..columns {
            let column = if rightward { step } else { columns - 1 - step };
            // The last two sweeps listen to both sides.
            let heard: &[usize] = match (sweep >= SWEEPS * 2 - 2, rightward) {
                (true, _) => &[0, 1],
                (false, true) => &[0],
                (false, false) => &[1],
            };
            settle(layered, &links, heard, column, &mut tops);
        }
    }
    straighten(layered, &mut tops);
    tops
}

/// Gives all corners of a wire one height where their neighbours leave them room for it.
fn straighten(layered: &Layered, tops: &mut [f32]) {
    let mut place = vec![(0, 0); tops.len()];
    for (column, order) in layered.order.iter().enumerate() {
        for (at, &node) in order.iter().enumerate() {
            place[node] = (column, at);
        }
    }
    for corners in layered.corners.iter().filter(|corners| corners.len() > 1) {
        let (mut lowest, mut highest) = (f32::NEG_INFINITY, f32::INFINITY);
        for &corner in corners {
            let (column, at) = place[corner];
            let order = &layered.order[column];
            let above = at.checked_sub(1).map(|above| order[above]);
            lowest = above.map_or(lowest, |above| lowest.max(tops[above] + step(layered, above)));
            let below = order.get(at + 1);
            highest = below.map_or(highest, |&below| highest.min(tops[below] - step(layered, corner)));
        }
        if lowest <= highest {
            let mean = corners.iter().map(|&corner| tops[corner]).sum::<f32>() / corners.len() as f32;
            let level = mean.clamp(lowest, highest);
            for &corner in corners {
                tops[corner] = level;
            }
        }
    }
}

/// From a box's upper edge to the next one's.
fn step(layered: &Layered, node: usize) -> f32 {
    let gap = if node < layered.real {
        ROW_GAP
    } else {
        ROW_GAP / 3.0
    };
    layered.size[node].y + gap
}

fn settle(layered: &Layered, links: &[Vec<Vec<usize>>; 2], heard: &[usize], column: usize, tops: &mut [f32]) {
    let order = &layered.order[column];
    let mut offset = 0.0;
    let mut pools: Vec<Pool> = Vec::with_capacity(order.len());
    let mut offsets = Vec::with_capacity(order.len());
    for &node in order {
        let (want, weight) = wish(layered, links, heard, node, tops);
        offsets.push(offset);
        pools.push(Pool {
            sum: (want - offset) * weight,
            weight,
            count: 1,
        });
        while let [.., above, below] = pools.as_slice() {
            if above.mean() <= below.mean() {
                break;
            }
            let joined = Pool {
                sum: above.sum + below.sum,
                weight: above.weight + below.weight,
                count: above.count + below.count,
            };
            pools.truncate(pools.len() - 2);
            pools.push(joined);
        }
        offset += step(layered, node);
    }
    let means = pools
        .iter()
        .flat_map(|pool| std::iter::repeat_n(pool.mean(), pool.count));
    for ((&node, offset), mean) in order.iter().zip(offsets).zip(means) {
        tops[node] = mean + offset;
    }
}

/// Neighbours that share one answer.
struct Pool {
    sum: f32,
    weight: f32,
    count: usize,
}

impl Pool {
    fn mean(&self) -> f32 {
        self.sum / self.weight
    }
}

/// Where a node's wires would be level: the weighted median, which makes one of them exactly so.
fn wish(
    layered: &Layered,
    links: &[Vec<Vec<usize>>; 2],
    heard: &[usize],
    node: usize,
    tops: &[f32],
) -> (f32, f32) {
    let mut wishes: Vec<(f32, f32)> = Vec::new();
    for &side in heard {
        for &index in &links[side][node] {
            let link = layered.links[index];
            let level = if side == 0 {
                tops[link.from] + link.from_y - link.to_y
            } else {
                tops[link.to] + link.to_y - link.from_y
            };
            wishes.push((level, link.weight));
        }
    }
    if wishes.is_empty() {
        return (tops[node], STAY);
    }
    wishes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let whole: f32 = wishes.iter().map(|w| w.1).sum();
    let mut below = 0.0;
    let mut last = wishes[0].0;
    for &(level, weight) in &wishes {
        below += weight;
        if below * 2.0 == whole {
            last = level;
            continue;
        }
        if below * 2.0 > whole {
            let between = (below - weight) * 2.0 == whole;
            return (
                if between {
                    f32::midpoint(last, level)
                } else {
                    level
                },
                whole,
            );
        }
    }
    (last, whole)
}

/// Corners of boxes and lanes of wires, the whole in whole points from zero.
pub(super) fn placed(graph: &Graph, layered: &Layered, tops: &[f32]) -> Placed {
    let mut wires = vec![0_usize; layered.order.len() + 1];
    for link in &layered.links {
        wires[layered.layer[link.to]] += 1;
    }
    let mut left = Vec::new();
    let mut width = Vec::new();
    let mut x = 0.0;
    for (column, nodes) in layered.order.iter().enumerate() {
        // Many wires need room to change places.
        x += if column == 0 {
            0.0
        } else {
            COLUMN_GAP + (wires[column] as f32 * 3.0).min(96.0)
        };
        let widest = nodes.iter().map(|&n| layered.size[n].x).fold(0.0, f32::max);
        left.push(x);
        width.push(widest);
        x += widest;
    }
    let top = tops
        .iter()
        .take(layered.real)
        .copied()
        .fold(f32::INFINITY, f32::min);
    let y = |node: usize| (tops[node] - top).round();
    let at = (0..layered.real).map(|node| Vec2::new(left[layered.layer[node]], y(node)));
    let lane = |&corner: &usize| {
        let column = layered.layer[corner];
        let level = y(corner) + layered.size[corner].y / 2.0;
        let x = left[column];
        [Vec2::new(x, level), Vec2::new(x + width[column], level)]
    };
    Placed {
        at: at.collect(),
        lanes: (0..graph.edges.len())
            .map(|edge| layered.corners[edge].iter().map(lane).collect())
            .collect(),
    }
}
