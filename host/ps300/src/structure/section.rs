//! Cutting polygons with a plane: the lines of the cut, and the faces that close it.

use std::collections::BTreeMap;

use glam::{DVec3, DVec4};

use super::frustum::Vertex;

type Place = [u64; 3];

fn place(at: DVec3) -> Place {
    (at + DVec3::ZERO).to_array().map(f64::to_bits) // Adding makes a negative zero positive.
}

/// Where a polygon with its holes crosses a plane; `borders` are closed. The same edge crosses at the same
/// bits in every polygon that has it, so that lines of neighbours join.
pub(super) fn crossings(plane: DVec4, borders: &[Vec<Vertex>], lines: &mut Vec<[DVec3; 2]>) {
    let side = |at: DVec3| plane.dot(at.extend(1.0));
    let mut points = Vec::new();
    for border in borders {
        let next = border.iter().cycle().skip(1);
        for (a, b) in border.iter().zip(next).map(|(a, b)| (a.at, b.at)) {
            if (side(a) < 0.0) == (side(b) < 0.0) {
                continue;
            }
            let (a, b) = if place(a) <= place(b) { (a, b) } else { (b, a) };
            points.push(a.lerp(b, side(a) / (side(a) - side(b))));
        }
    }
    let [Some(first), Some(last)] = [points.first(), points.last()] else {
        return;
    };
    // All lie on one line; two of them say which way it goes.
    let along = points
        .iter()
        .map(|point| *point - *first)
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
        .unwrap_or(*last - *first);
    points.sort_by(|a, b| a.dot(along).total_cmp(&b.dot(along)));
    lines.extend(points.chunks_exact(2).map(|pair| [pair[0], pair[1]]));
}

/// Joins lines to closed borders; what does not close is left out.
pub(super) fn borders(lines: &[[DVec3; 2]]) -> Vec<Vec<DVec3>> {
    let mut at: BTreeMap<Place, Vec<usize>> = BTreeMap::new();
    for (index, line) in lines.iter().enumerate() {
        for end in line {
            at.entry(place(*end)).or_default().push(index);
        }
    }
    let mut used = vec![false; lines.len()];
    let mut closed = Vec::new();
    for first in 0..lines.len() {
        if std::mem::replace(&mut used[first], true) {
            continue;
        }
        let [start, mut end] = lines[first];
        let mut border = vec![start];
        while place(end) != place(start) {
            let next = at
                .get(&place(end))
                .into_iter()
                .flatten()
                .find(|&&line| !used[line]);
            let Some(&next) = next else {
                border.clear();
                break;
            };
            used[next] = true;
            border.push(end);
            let [a, b] = lines[next];
            end = if place(a) == place(end) { b } else { a };
        }
        if border.len() > 2 {
            closed.push(border);
        }
    }
    closed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(corners: [[f64; 3]; 4]) -> Vec<Vec<Vertex>> {
        let vertex = |at: [f64; 3]| Vertex {
            at: DVec3::from_array(at),
            normal: DVec3::Z,
        };
        vec![corners.map(vertex).to_vec()]
    }

    /// The four upright sides of a cube.
    fn sides() -> Vec<Vec<Vec<Vertex>>> {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        (0..4)
            .map(|side| {
                let ([ax, ay], [bx, by]) = (corners[side], corners[(side + 1) % 4]);
                square([[ax, ay, 0.0], [bx, by, 0.0], [bx, by, 1.0], [ax, ay, 1.0]])
            })
            .collect()
    }

    #[test]
    fn a_cube_is_cut_in_one_closed_border() {
        for plane in [DVec4::new(0.0, 0.0, 1.0, -0.3), DVec4::new(0.1, 0.2, 1.0, -0.7)] {
            let mut lines = Vec::new();
            for side in sides() {
                crossings(plane, &side, &mut lines);
            }
            assert_eq!(lines.len(), 4);
            let borders = borders(&lines);
            assert_eq!((borders.len(), borders[0].len()), (1, 4));
            assert!(borders[0].iter().all(|p| plane.dot(p.extend(1.0)).abs() < 1e-12));
        }
    }

    #[test]
    fn a_hole_leaves_two_lines_and_an_open_sheet_no_border() {
        let mut outside = square([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]]);
        outside.extend(square([
            [1.0, 1.0, 0.0],
            [3.0, 1.0, 0.0],
            [3.0, 3.0, 0.0],
            [1.0, 3.0, 0.0],
        ]));
        let mut lines = Vec::new();
        crossings(DVec4::new(0.0, 1.0, 0.0, -2.0), &outside, &mut lines);
        let xs: Vec<_> = lines.iter().map(|[a, b]| (a.x.min(b.x), a.x.max(b.x))).collect();
        assert!(xs.contains(&(0.0, 1.0)) && xs.contains(&(3.0, 4.0)), "{xs:?}");
        assert!(borders(&lines).is_empty());
    }
}
