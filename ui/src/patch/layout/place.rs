//! A few boxes added to a layout that stays as it is: a hand's own order is not taken away by the next edit.

use glam::Vec2;

use super::{COLUMN_GAP, ROW_GAP};
use crate::patch::area::Area;
use crate::patch::scene::Scene;

/// Room kept around a box that is put down, points.
const ROOM: f32 = 14.0;

/// Fills the gaps in `at`, one place for each box of the scene: beside what feeds the box, before what it feeds,
/// or else below everything; always where nothing is yet.
pub fn fill(scene: &Scene, at: &mut [Option<Vec2>]) -> Vec<Vec2> {
    let mut ties: Vec<Vec<Tie>> = vec![Vec::new(); scene.boxes.len()];
    for wire in &scene.wires {
        let ((from, output), (to, input)) = (wire.from, wire.to);
        let down = scene.boxes[from].port_y(output) - scene.boxes[to].port_y(input);
        ties[to].push(Tie {
            other: from,
            right: true,
            down,
        });
        ties[from].push(Tie {
            other: to,
            right: false,
            down: -down,
        });
    }
    // Boxes tied to one that has its place come before boxes tied to none.
    let mut open: Vec<usize> = (0..scene.boxes.len()).filter(|&n| at[n].is_none()).collect();
    while !open.is_empty() {
        let tied = |&n: &usize| ties[n].iter().any(|tie| at[tie.other].is_some());
        let next = open.iter().position(tied).unwrap_or(0);
        let node = open.remove(next);
        let wanted = wanted(scene, &ties[node], at, node).unwrap_or_else(|| below(scene, at));
        at[node] = Some(free(scene, at, node, wanted));
    }
    at.iter().map(|at| at.unwrap_or_default()).collect()
}

/// A wire as one of its boxes sees it.
#[derive(Clone, Copy)]
struct Tie {
    other: usize,
    right: bool,
    down: f32,
}

/// Where its wires want a box, if they lead to boxes that have a place.
fn wanted(scene: &Scene, ties: &[Tie], at: &[Option<Vec2>], node: usize) -> Option<Vec2> {
    let spots = |right: bool| {
        let known = ties.iter().filter(move |tie| tie.right == right);
        known.filter_map(|tie| Some((at[tie.other]?, *tie)))
    };
    let after = spots(true).map(|(corner, tie)| {
        let x = corner.x + scene.boxes[tie.other].size.x + COLUMN_GAP;
        Vec2::new(x, corner.y + tie.down)
    });
    let beside = after.reduce(|a, b| if b.x > a.x { b } else { a });
    beside.or_else(|| {
        let before = spots(false).map(|(corner, tie)| {
            let x = corner.x - scene.boxes[node].size.x - COLUMN_GAP;
            Vec2::new(x, corner.y + tie.down)
        });
        before.reduce(|a, b| if b.x < a.x { b } else { a })
    })
}

/// Below everything that has a place.
fn below(scene: &Scene, at: &[Option<Vec2>]) -> Vec2 {
    let known = || {
        at.iter()
            .zip(&scene.boxes)
            .filter_map(|(at, shown)| Some(((*at)?, shown.size)))
    };
    let Some(bottom) = known().map(|(at, size)| at.y + size.y).reduce(f32::max) else {
        return Vec2::ZERO;
    };
    let left = known().map(|(at, _)| at.x).fold(f32::INFINITY, f32::min);
    Vec2::new(left, bottom + ROW_GAP * 2.0)
}

/// The nearest place above or below `wanted` where the box covers no other.
pub fn free(scene: &Scene, at: &[Option<Vec2>], node: usize, wanted: Vec2) -> Vec2 {
    let size = scene.boxes[node].size;
    let around = Area::new(wanted, size).grown(ROOM);
    // Only what stands in the same column can be in the way.
    let mut taken: Vec<(f32, f32)> = at
        .iter()
        .zip(&scene.boxes)
        .enumerate()
        .filter(|(other, _)| *other != node)
        .filter_map(|(_, (at, shown))| Some(Area::new((*at)?, shown.size)))
        .filter(|area| area.min.x < around.max.x && area.max.x > around.min.x)
        .map(|area| (area.min.y - ROOM - size.y, area.max.y + ROOM))
        .collect();
    taken.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut joined: Vec<(f32, f32)> = Vec::new();
    for (from, to) in taken {
        match joined.last_mut() {
            Some(last) if from < last.1 => last.1 = last.1.max(to),
            _ => joined.push((from, to)),
        }
    }
    let inside = joined
        .iter()
        .find(|(from, to)| wanted.y > *from && wanted.y < *to);
    let y = inside.map_or(
        wanted.y,
        |&(from, to)| {
            if wanted.y - from < to - wanted.y { from } else { to }
        },
    );
    Vec2::new(wanted.x, y).round()
}
