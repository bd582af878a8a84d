//! Where the picture is looked at from: parallel projection, as on the desk this studio descends from.
//!
//! View axes: x right, y up, z towards the viewer. `screen = (V (p - c))_xy`, V a rotation.
//! Source: `docs/frames-and-units.md`; TR-88-032, section on the skeleton technique.

use glam::{DMat3, DVec3};

/// A parallel projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Turns world axes into view axes.
    pub view_from_world: DMat3,
    /// World point in the middle of the picture, metres.
    pub centre: DVec3,
    /// World height from the middle of the picture to its upper edge, metres, above 0.
    pub half_height: f64,
    /// Distance before and behind the centre over which lines lose brightness, metres, above 0.
    pub half_depth: f64,
}

impl Camera {
    /// A view turned by `azimuth_rad` about the world's vertical (y), then by `elevation_rad` about the
    /// screen's horizontal. Both zero look along −z.
    pub fn turned(azimuth_rad: f64, elevation_rad: f64, centre: DVec3, half_height: f64) -> Camera {
        Camera {
            view_from_world: DMat3::from_rotation_x(elevation_rad) * DMat3::from_rotation_y(azimuth_rad),
            centre,
            half_height,
            half_depth: half_height * 0.6,
        }
    }

    /// The same seen from the right: V' = Ry(−90°) V. What was nearest the viewer is now on the left.
    #[must_use]
    pub fn side(&self) -> Camera {
        // Written out, so that the side view is exact and not 6e-17 off.
        let quarter = DMat3::from_cols(DVec3::Z, DVec3::Y, DVec3::NEG_X);
        Camera {
            view_from_world: quarter * self.view_from_world,
            ..*self
        }
    }

    /// View coordinates in picture half-heights: x right, y up, z towards the viewer in cue depths (−1 far
    /// … 1 near, not clamped).
    pub fn project(&self, world: DVec3) -> DVec3 {
        let view = self.view_from_world * (world - self.centre);
        DVec3::new(
            view.x / self.half_height,
            view.y / self.half_height,
            view.z / self.half_depth,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn straight_ahead_keeps_x_and_y() {
        let camera = Camera::turned(0.0, 0.0, DVec3::ZERO, 2.0);
        let seen = camera.project(DVec3::new(1.0, -2.0, 0.6));
        assert!((seen - DVec3::new(0.5, -1.0, 0.5)).length() < 1e-12, "{seen}");
    }

    #[test]
    fn side_shows_the_near_on_the_left() {
        let side = Camera::turned(0.0, 0.0, DVec3::ZERO, 1.0).side();
        assert_eq!(side.project(DVec3::Z).x, -1.0);
        assert_eq!(side.project(DVec3::Y).y, 1.0);
        let turned = DMat3::from_rotation_y(-FRAC_PI_2);
        assert!(side.view_from_world.abs_diff_eq(turned, 1e-12));
    }
}
