//! The way of a wire: level where it leaves and arrives, level through its lanes, smooth between.

use glam::Vec2;

use super::area::Area;

/// A way as cubic curves, and what it covers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Route {
    /// First point, two handles, last point; each begins where the one before ended.
    pub curves: Vec<[Vec2; 4]>,
    /// Everything the curves can touch.
    pub area: Area,
}

/// How far beside the boxes feedback turns, points.
const TURN: f32 = 44.0;
/// How far below the lower box it returns.
const BELOW: f32 = 26.0;

impl Route {
    /// From an output through lanes (left end, right end) to an input. `bottom` is the lower edge of the lower of
    /// the two boxes, under which feedback returns.
    pub fn new(from: Vec2, lanes: &[[Vec2; 2]], to: Vec2, bottom: f32) -> Route {
        let mut curves = Vec::with_capacity(lanes.len() * 2 + 1);
        if to.x < from.x + 8.0 {
            feedback(&mut curves, from, to, bottom);
        } else {
            let mut at = from;
            for &[left, right] in lanes {
                // A box moved by hand may have left its lanes behind.
                if left.x < at.x || right.x > to.x {
                    continue;
                }
                curves.push(flowing(at, left));
                curves.push(flowing(left, right));
                at = right;
            }
            curves.push(flowing(at, to));
        }
        let area = curves
            .iter()
            .flatten()
            .map(|&p| Area { min: p, max: p })
            .reduce(Area::union)
            .unwrap_or_default();
        Route { curves, area }
    }

    /// Points along the way, both ends included; a curve whose ends are `long` apart is cut in `pieces(long)`.
    pub fn points(&self, pieces: impl Fn(f32) -> usize) -> impl Iterator<Item = Vec2> {
        let first = self.curves.first().map(|c| c[0]);
        let rest = self.curves.iter().flat_map(move |curve| {
            // A level stretch is straight.
            let level = curve[0].y == curve[3].y;
            let count = if level {
                1
            } else {
                pieces(curve[0].distance(curve[3])).max(1)
            };
            (1..=count).map(move |step| at(curve, step as f32 / count as f32))
        });
        first.into_iter().chain(rest)
    }

    /// How far a point is from the way.
    pub fn distance(&self, from: Vec2) -> f32 {
        let mut last = None;
        let mut nearest = f32::INFINITY;
        for point in self.points(|_| 16) {
            if let Some(last) = last {
                nearest = nearest.min(to_segment(from, last, point));
            }
            last = Some(point);
        }
        nearest
    }
}

fn at(&[a, b, c, d]: &[Vec2; 4], u: f32) -> Vec2 {
    let v = 1.0 - u;
    a * (v * v * v) + b * (3.0 * v * v * u) + c * (3.0 * v * u * u) + d * (u * u * u)
}

fn to_segment(at: Vec2, a: Vec2, b: Vec2) -> f32 {
    let along = b - a;
    let share = ((at - a).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
    at.distance(a + along * share)
}

/// Left to right, level at both ends.
fn flowing(from: Vec2, to: Vec2) -> [Vec2; 4] {
    let reach = ((to.x - from.x) * 0.5).max(0.0);
    [from, from + Vec2::X * reach, to - Vec2::X * reach, to]
}

/// Right to left: out, down, back under both boxes, up, in.
fn feedback(curves: &mut Vec<[Vec2; 4]>, from: Vec2, to: Vec2, bottom: f32) {
    let low = bottom + BELOW;
    let (right, left) = (Vec2::new(from.x, low), Vec2::new(to.x, low));
    curves.push([from, from + Vec2::X * TURN, right + Vec2::X * TURN, right]);
    curves.push([right, right, left, left]);
    curves.push([left, left - Vec2::X * TURN, to - Vec2::X * TURN, to]);
}
