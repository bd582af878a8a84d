//! Three rotations about joint axes, in any order of three different axes, to a matrix and back.
//!
//! A file's channels multiply from left to right: `Zrotation Yrotation Xrotation` is Rz·Ry·Rx.

use glam::DMat3;

/// Below this the middle rotation is a right angle and only a sum of the outer two is determined.
const GIMBAL: f64 = 1e-9;

/// The product of the three rotations, angles in radians.
pub(super) fn matrix(axes: [u8; 3], angles_rad: [f64; 3]) -> DMat3 {
    let [a, b, c] = [0, 1, 2].map(|place| about(axes[place], angles_rad[place]));
    a * b * c
}

fn about(axis: u8, angle_rad: f64) -> DMat3 {
    match axis {
        0 => DMat3::from_rotation_x(angle_rad),
        1 => DMat3::from_rotation_y(angle_rad),
        _ => DMat3::from_rotation_z(angle_rad),
    }
}

/// Angles whose [`matrix`] is `rotation`: of all that are, those nearest to `near_rad`, so that curves
/// over frames do not jump.
pub(super) fn angles(axes: [u8; 3], rotation: DMat3, near_rad: [f64; 3]) -> [f64; 3] {
    let [i, j, k] = axes.map(usize::from);
    let sign = if (i + 1) % 3 == j { 1.0 } else { -1.0 };
    let entry = |row: usize, column: usize| rotation.col(column)[row];
    let across = entry(i, i).hypot(entry(i, j));
    let middle = (sign * entry(i, k)).atan2(across);
    if across < GIMBAL {
        let last = near_rad[2];
        let first = rotation * about(axes[2], -last) * about(axes[1], -middle);
        let first_rad = (-sign * first.col(k)[j]).atan2(first.col(j)[j]);
        return unwrapped([first_rad, middle, last], near_rad);
    }
    let first = (-sign * entry(j, k)).atan2(entry(k, k));
    let last = (-sign * entry(i, j)).atan2(entry(i, i));
    let half = std::f64::consts::PI;
    let one = unwrapped([first, middle, last], near_rad);
    let other = unwrapped([first + half, half - middle, last + half], near_rad);
    if distance(other, near_rad) < distance(one, near_rad) {
        other
    } else {
        one
    }
}

/// Adds whole turns to each angle until it is nearest to `near_rad`.
fn unwrapped(angles_rad: [f64; 3], near_rad: [f64; 3]) -> [f64; 3] {
    let turn = std::f64::consts::TAU;
    [0, 1, 2].map(|place| {
        let angle = angles_rad[place];
        angle + turn * ((near_rad[place] - angle) / turn).round()
    })
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ORDERS: [[u8; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

    fn same(a: DMat3, b: DMat3) -> bool {
        a.abs_diff_eq(b, 1e-9)
    }

    #[test]
    fn right_angles_in_the_middle_are_read_back_in_every_order() {
        for axes in ORDERS {
            for middle in [90.0_f64, -90.0] {
                let rotation = matrix(axes, [0.3, middle.to_radians(), -0.7]);
                let read = angles(axes, rotation, [0.1, 0.2, 0.3]);
                assert!(same(matrix(axes, read), rotation), "{axes:?} {middle}");
            }
        }
    }

    proptest! {
        #[test]
        fn reading_is_the_inverse_and_stays_near(order in 0..6_usize, a in -9.0..9.0_f64, b in -9.0..9.0_f64, c in -9.0..9.0_f64) {
            let axes = ORDERS[order];
            let rotation = matrix(axes, [a, b, c]);
            prop_assert!(same(matrix(axes, angles(axes, rotation, [0.0; 3])), rotation));
            let near = angles(axes, rotation, [a + 0.01, b - 0.01, c + 0.01]);
            prop_assert!(same(matrix(axes, near), rotation));
            prop_assert!(distance(near, [a, b, c]) < 0.1 || (b.cos()).abs() < 0.05);
        }
    }
}
