//! Cutting lines and faces at the borders of a view.
//!
//! Done before the division by depth, so that what passes behind an eye cannot come out at the other side.
//! Source: Liang and Barsky, 1984; Sutherland and Hodgman, 1974.

use glam::{DMat4, DVec3, DVec4};

/// The half spaces a view shows: points with `plane · (x, y, z, 1) >= 0` for all of them.
pub(super) struct Frustum {
    planes: [DVec4; 7],
    count: usize,
}

/// Nearer to an eye than this nothing is drawn. Our choice.
const NEAREST: f64 = 1e-9;

impl Frustum {
    /// Of a view; with `depth`, cut at the front and the back too. Without a view everything is seen.
    pub(super) fn new(screen_from_world: Option<&DMat4>, depth: bool) -> Self {
        let Some(m) = screen_from_world else {
            return Self {
                planes: [DVec4::ZERO; 7],
                count: 0,
            };
        };
        let (x, y, z, w) = (m.row(0), m.row(1), m.row(2), m.row(3));
        let planes = [w - DVec4::W * NEAREST, w + x, w - x, w + y, w - y, z, w - z];
        Self {
            planes,
            count: if depth { 7 } else { 5 },
        }
    }

    fn planes(&self) -> &[DVec4] {
        &self.planes[..self.count]
    }

    /// Which part of a line is seen, as shares of its length.
    #[inline]
    pub(super) fn cut(&self, from: DVec3, to: DVec3) -> Option<[f64; 2]> {
        let (mut begin, mut end) = (0.0, 1.0);
        for plane in self.planes() {
            let (a, b) = (plane.dot(from.extend(1.0)), plane.dot(to.extend(1.0)));
            if a >= 0.0 && b >= 0.0 {
                continue;
            }
            if a < 0.0 && b < 0.0 {
                return None;
            }
            let at = a / (a - b);
            if a < 0.0 {
                begin = f64::max(begin, at);
            } else {
                end = f64::min(end, at);
            }
        }
        (begin <= end).then_some([begin, end])
    }

    /// Cuts a triangle; what is left is convex, its corners in the same order.
    pub(super) fn cut_face(&self, corners: &mut Vec<Vertex>, spare: &mut Vec<Vertex>) {
        for plane in self.planes() {
            cut_face(*plane, corners, spare);
        }
    }
}

/// A corner while faces are cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    pub(super) at: DVec3,
    pub(super) normal: DVec3,
}

/// Keeps the part of a convex face with `plane · (x, y, z, 1) >= 0`.
pub(super) fn cut_face(plane: DVec4, corners: &mut Vec<Vertex>, spare: &mut Vec<Vertex>) {
    let side = |vertex: &Vertex| plane.dot(vertex.at.extend(1.0));
    if corners.iter().all(|corner| side(corner) >= 0.0) {
        return;
    }
    spare.clear();
    for (index, corner) in corners.iter().enumerate() {
        let next = &corners[(index + 1) % corners.len()];
        let (a, b) = (side(corner), side(next));
        if a >= 0.0 {
            spare.push(*corner);
        }
        if (a < 0.0) != (b < 0.0) {
            let share = a / (a - b);
            spare.push(Vertex {
                at: corner.at.lerp(next.at, share),
                normal: corner.normal.lerp(next.normal, share),
            });
        }
    }
    std::mem::swap(corners, spare);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::projection::{parallel, perspective};

    #[test]
    fn lines_are_cut_at_the_sides_and_behind_the_eye() {
        let window = parallel([-1.0, 1.0], [-1.0, 1.0], None).unwrap();
        let seen = Frustum::new(Some(&window), false);
        let x = |x: f64| DVec3::new(x, 0.0, 0.0);
        assert_eq!(seen.cut(x(-3.0), x(1.0)), Some([0.5, 1.0]));
        assert_eq!(seen.cut(x(-3.0), x(3.0)), Some([1.0 / 3.0, 2.0 / 3.0]));
        assert_eq!(seen.cut(x(-3.0), x(-2.0)), None);
        let eye = perspective(90.0, 1.0, 10.0).unwrap();
        let z = |z: f64| DVec3::new(0.0, 0.0, z);
        let seen = Frustum::new(Some(&eye), false).cut(z(-5.0), z(5.0)).unwrap();
        assert!((seen[0] - 0.5).abs() < 1e-6 && seen[1] == 1.0);
        let seen = Frustum::new(Some(&eye), true).cut(z(0.0), z(20.0)).unwrap();
        assert!((seen[0] - 0.05).abs() < 1e-12 && (seen[1] - 0.5).abs() < 1e-12);
        assert_eq!(Frustum::new(None, true).cut(z(-5.0), z(5.0)), Some([0.0, 1.0]));
    }

    #[test]
    fn a_triangle_through_a_corner_of_the_window_keeps_five_corners() {
        let window = parallel([-1.0, 1.0], [-1.0, 1.0], None).unwrap();
        let corner = |x: f64, y: f64| Vertex {
            at: DVec3::new(x, y, 0.0),
            normal: DVec3::Z,
        };
        let mut face = vec![corner(0.0, 0.0), corner(0.0, 1.5), corner(1.5, 0.0)];
        Frustum::new(Some(&window), false).cut_face(&mut face, &mut Vec::new());
        assert_eq!(face.len(), 5);
        assert!(face.iter().all(|v| v.at.x <= 1.0 && v.at.y <= 1.0));
    }
}
