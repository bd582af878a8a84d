//! A link's frame: +z along the link, R = Rz(azimuth) Ry(polar) Rz(twist).
//!
//! At the poles only the sum or difference of azimuth and twist is determined; azimuth is then 0.
//! Source: the thesis, section 4.2 (z-y-z angles); maths notes 5.2 for the poles.

use glam::{DMat3, DVec3};

/// Nearer to the z axis than this, a unit direction has no azimuth.
const POLE_RADIUS: f64 = 1e-9;

/// The three angles of a link's frame, radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Zyz {
    /// Last turn, about the world's z, from +x towards +y.
    pub azimuth_rad: f64,
    /// Second turn: 0 is along +z, pi is along -z.
    pub polar_rad: f64,
    /// First turn, about the link itself.
    pub twist_rad: f64,
}

/// The rotation of those angles.
pub fn matrix_from_zyz(zyz: Zyz) -> DMat3 {
    DMat3::from_rotation_z(zyz.azimuth_rad)
        * DMat3::from_rotation_y(zyz.polar_rad)
        * DMat3::from_rotation_z(zyz.twist_rad)
}

/// The angles of a rotation, azimuth and twist in (-pi, pi], polar in [0, pi].
pub fn zyz_from_matrix(world_from_link: &DMat3) -> Zyz {
    let (x, y, z) = (
        world_from_link.x_axis,
        world_from_link.y_axis,
        world_from_link.z_axis,
    );
    let radius = z.x.hypot(z.y);
    let polar_rad = angle(radius, z.z);
    if radius >= POLE_RADIUS {
        Zyz {
            azimuth_rad: angle(z.y, z.x),
            polar_rad,
            twist_rad: angle(y.z, -x.z),
        }
    } else if z.z > 0.0 {
        Zyz {
            azimuth_rad: 0.0,
            polar_rad,
            twist_rad: angle(x.y, x.x),
        }
    } else {
        Zyz {
            azimuth_rad: 0.0,
            polar_rad,
            twist_rad: angle(y.x, -x.x),
        }
    }
}

/// `atan2` with -0 read as 0, so that an exact half turn is never minus a half turn.
pub(crate) fn angle(y: f64, x: f64) -> f64 {
    (y + 0.0).atan2(x + 0.0)
}

/// The untwisted frame of a unit direction: Rz(azimuth) Ry(polar).
pub fn frame_of(direction: DVec3) -> DMat3 {
    let radius = direction.x.hypot(direction.y);
    let (cos, sin) = if radius < POLE_RADIUS {
        (1.0, 0.0)
    } else {
        (direction.x / radius, direction.y / radius)
    };
    DMat3::from_cols(
        DVec3::new(cos * direction.z, sin * direction.z, -radius),
        DVec3::new(-sin, cos, 0.0),
        direction,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn angles_come_back() {
        for azimuth in [-3.0, -0.4, 0.0, 1.0, PI] {
            for polar in [0.1, 1.0, 2.0, 3.1] {
                for twist in [-2.0, 0.0, 0.7, PI] {
                    let want = Zyz {
                        azimuth_rad: azimuth,
                        polar_rad: polar,
                        twist_rad: twist,
                    };
                    let got = zyz_from_matrix(&matrix_from_zyz(want));
                    let gaps = [
                        got.azimuth_rad - azimuth,
                        got.polar_rad - polar,
                        got.twist_rad - twist,
                    ];
                    assert!(gaps.iter().all(|g| g.abs() < 1e-12), "{got:?} wanted {want:?}");
                }
            }
        }
    }

    #[test]
    fn a_frame_is_its_angles() {
        let zyz = Zyz {
            azimuth_rad: 2.5,
            polar_rad: 1.2,
            twist_rad: 0.0,
        };
        let matrix = matrix_from_zyz(zyz);
        assert!(frame_of(matrix.z_axis).abs_diff_eq(matrix, 1e-15));
    }

    #[test]
    fn minus_zero_is_no_half_turn() {
        assert_eq!(angle(-0.0, -1.0), PI);
        assert_eq!(angle(-0.0, -0.0), 0.0);
    }
}
