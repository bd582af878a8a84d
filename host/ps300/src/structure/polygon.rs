//! Polygons with what shading needs to know of them.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::language::{Polygon, PolygonVertex};
use crate::names::NameId;

/// The polygons of one node.
pub(crate) struct Polygons {
    pub(crate) written: Vec<Polygon>,
    /// The ATTRIBUTES node of each.
    pub(super) attributes: Vec<Option<NameId>>,
    /// A normal for each vertex of each, on the side of the polygon's own.
    pub(super) normals: Vec<Vec<DVec3>>,
}

impl Polygons {
    pub(super) fn new(written: Vec<Polygon>, attributes: Vec<Option<NameId>>) -> Self {
        let normals = normals(&written);
        Self {
            written,
            attributes,
            normals,
        }
    }

    /// Each polygon that begins a face, with those that are its holes or other parts.
    pub(super) fn faces(&self) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        let begins = |&index: &usize| index == 0 || !self.written[index].coplanar;
        (0..self.written.len()).filter(begins).map(|first| {
            let more = self.written[first + 1..].iter().take_while(|it| it.coplanar);
            first..first + 1 + more.count()
        })
    }
}

/// The direction a border runs around, as long as twice its area; by the right-hand formula.
/// Source: M. E. Newell's formula, in Sutherland, Sproull, Schumacker, 1974.
pub(super) fn around(border: impl Iterator<Item = DVec3> + Clone) -> DVec3 {
    let next = border.clone().skip(1).chain(border.clone().take(1));
    border
        .zip(next)
        .map(|(a, b)| a.cross(b))
        .fold(DVec3::ZERO, |sum, part| sum + part)
}

fn own(polygon: &Polygon) -> DVec3 {
    around(polygon.vertices.iter().map(|vertex| vertex.at))
}

type Place = [u64; 3];

fn place(at: DVec3) -> Place {
    (at + DVec3::ZERO).to_array().map(f64::to_bits) // Adding makes a negative zero positive.
}

/// Given normals as they are; others the polygon's own, or, where soft edges join polygons, the sum of theirs,
/// the larger polygon counting more.
fn normals(polygons: &[Polygon]) -> Vec<Vec<DVec3>> {
    let starts: Vec<usize> = polygons
        .iter()
        .scan(0, |next, polygon| {
            let start = *next;
            *next += polygon.vertices.len();
            Some(start)
        })
        .collect();
    let count = polygons.iter().map(|polygon| polygon.vertices.len()).sum();
    let mut joined = Joined::new(count);
    let mut edges: BTreeMap<[Place; 2], Vec<[usize; 2]>> = BTreeMap::new();
    let mut soft = std::collections::BTreeSet::new();
    for (polygon, start) in polygons.iter().zip(&starts) {
        let vertices = &polygon.vertices;
        for (index, PolygonVertex { at, soft: gentle, .. }) in vertices.iter().enumerate() {
            let next = (index + 1) % vertices.len();
            let (a, b) = (place(*at), place(vertices[next].at));
            let (key, ends) = if a <= b {
                ([a, b], [start + index, start + next])
            } else {
                ([b, a], [start + next, start + index])
            };
            if *gentle {
                soft.insert(key);
            }
            edges.entry(key).or_default().push(ends);
        }
    }
    for ends in soft.iter().filter_map(|key| edges.get(key)) {
        for pair in ends.windows(2) {
            joined.join(pair[0][0], pair[1][0]);
            joined.join(pair[0][1], pair[1][1]);
        }
    }
    let mut sums = vec![DVec3::ZERO; count];
    for (polygon, start) in polygons.iter().zip(&starts) {
        let own = own(polygon);
        for index in 0..polygon.vertices.len() {
            let group = joined.group(start + index);
            sums[group] += own;
        }
    }
    polygons
        .iter()
        .zip(&starts)
        .map(|(polygon, start)| {
            let own = own(polygon);
            let normal = |(index, vertex): (usize, &PolygonVertex)| {
                let given = vertex.normal.map(|n| if n.dot(own) < 0.0 { -n } else { n });
                let normal = given.unwrap_or_else(|| sums[joined.group(start + index)]);
                normal.try_normalize().unwrap_or(DVec3::Z)
            };
            polygon.vertices.iter().enumerate().map(normal).collect()
        })
        .collect()
}

/// Which corners share a normal.
struct Joined(Vec<usize>);

impl Joined {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn group(&self, mut corner: usize) -> usize {
        while self.0[corner] != corner {
            corner = self.0[corner];
        }
        corner
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.group(a), self.group(b));
        // The smaller number leads, so that chains stay short and the order of joining does not matter.
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(corners: &[[f64; 3]], soft: bool) -> Polygon {
        Polygon {
            attributes: None,
            outline_hue_deg: None,
            coplanar: false,
            vertices: corners
                .iter()
                .map(|at| PolygonVertex {
                    at: DVec3::from_array(*at),
                    soft,
                    normal: None,
                })
                .collect(),
        }
    }

    const FLOOR: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    const WALL: [[f64; 3]; 4] = [[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]];

    #[test]
    fn soft_edges_share_a_normal_and_hard_ones_do_not() {
        let hard = normals(&[polygon(&FLOOR, false), polygon(&WALL, false)]);
        assert!(hard[0].iter().all(|n| *n == DVec3::Z), "{hard:?}");
        let soft = normals(&[polygon(&FLOOR, true), polygon(&WALL, false)]);
        let both = (DVec3::Z + DVec3::NEG_Y).normalize_or_zero();
        assert_eq!((soft[0][0], soft[0][1]), (DVec3::Z, DVec3::Z));
        assert!((soft[0][2] - both).length() < 1e-12 && (soft[1][0] - both).length() < 1e-12);
    }

    #[test]
    fn a_polygon_without_area_still_has_a_normal() {
        let flat = normals(&[polygon(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], true)]);
        assert_eq!(flat[0], [DVec3::Z; 3]);
    }
}
