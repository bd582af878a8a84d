//! A link's direction and twist as the thesis's three angles, and back.
//!
//! World from link = Rz(α)·Ry(β)·Rz(γ): twist γ about the link's own axis, then tilt β from z, then
//! azimuth α. Script rows, dense clips, CSV and version-0 files use them; the thesis, chapter 5.

use glam::DVec3;

/// Below this sine of the tilt the azimuth is undetermined and taken as 0, as `motion` does.
const POLE: f64 = 1e-9;

/// Direction and twist from (α, β, γ), radians. At a pole the azimuth is moved into the twist.
pub(super) fn link_from_angles([alpha, beta, gamma]: [f64; 3]) -> (DVec3, f64) {
    let (sin_beta, cos_beta) = beta.sin_cos();
    if sin_beta.abs() < POLE {
        let up = cos_beta > 0.0;
        return (
            if up { DVec3::Z } else { DVec3::NEG_Z },
            if up { gamma + alpha } else { gamma - alpha },
        );
    }
    let direction = DVec3::new(alpha.cos() * sin_beta, alpha.sin() * sin_beta, cos_beta);
    // A negative tilt points the other way round: the frame that `motion` builds from the direction
    // alone is then turned by half a turn.
    (
        direction,
        if sin_beta > 0.0 {
            gamma
        } else {
            gamma + std::f64::consts::PI
        },
    )
}

/// (α, β) of a unit direction, radians; α is 0 at the poles.
pub(super) fn angles_of(direction: DVec3) -> (f64, f64) {
    let across = direction.x.hypot(direction.y);
    if across < POLE {
        return (
            0.0,
            if direction.z > 0.0 {
                0.0
            } else {
                std::f64::consts::PI
            },
        );
    }
    (direction.y.atan2(direction.x), across.atan2(direction.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;
    use proptest::prelude::*;

    fn matrix([a, b, c]: [f64; 3]) -> DMat3 {
        DMat3::from_rotation_z(a) * DMat3::from_rotation_y(b) * DMat3::from_rotation_z(c)
    }

    fn check(angles: [f64; 3]) {
        let (direction, twist) = link_from_angles(angles);
        let (alpha, beta) = angles_of(direction);
        let back = matrix([alpha, beta, twist]);
        assert!(back.abs_diff_eq(matrix(angles), 1e-8), "{angles:?}");
    }

    #[test]
    fn poles_keep_the_orientation() {
        for beta in [0.0_f64, 180.0, -180.0, 1e-10, 360.0] {
            check([0.7, beta.to_radians(), 0.4]);
        }
    }

    proptest! {
        #[test]
        fn any_angles_keep_the_orientation(a in -7.0..7.0_f64, b in -7.0..7.0_f64, c in -20.0..20.0_f64) {
            check([a, b, c]);
        }
    }
}
