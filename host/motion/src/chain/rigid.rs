//! A rotation and a translation: where one frame lies in another.

use glam::{DQuat, DVec3};
use std::ops::Mul;

/// `target_from_source`: turns first, then moves. `a_from_b * b_from_c` is `a_from_c`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    /// A unit quaternion.
    pub rotation: DQuat,
    /// Metres.
    pub translation: DVec3,
}

impl Rigid {
    /// Nothing moved.
    pub const IDENTITY: Self = Self {
        rotation: DQuat::IDENTITY,
        translation: DVec3::ZERO,
    };

    /// As URDF writes it: metres, and roll, pitch, yaw in radians about fixed x, then y, then z.
    pub fn from_xyz_rpy(xyz: DVec3, rpy: DVec3) -> Self {
        let rotation =
            DQuat::from_rotation_z(rpy.z) * DQuat::from_rotation_y(rpy.y) * DQuat::from_rotation_x(rpy.x);
        Self {
            rotation,
            translation: xyz,
        }
    }

    /// Where a point of the source lies in the target.
    pub fn transform_point(&self, point: DVec3) -> DVec3 {
        self.rotation * point + self.translation
    }

    /// Whether every number in it is finite.
    pub fn is_finite(&self) -> bool {
        self.rotation.is_finite() && self.translation.is_finite()
    }
}

impl Default for Rigid {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Mul for Rigid {
    type Output = Self;

    fn mul(self, inner: Self) -> Self {
        Self {
            rotation: self.rotation * inner.rotation,
            translation: self.transform_point(inner.translation),
        }
    }
}
