//! Posing a link with a cursor: the sight line through the cursor meets the sphere the link's end can reach.
//!
//! Parallel projection. Where the line meets the sphere there are two answers, near and far, chosen by a
//! button; where it passes outside there is one, on the silhouette towards the cursor.
//! Source: the thesis, section 5.2.

use super::frame::angle;
use glam::{DMat3, DVec2, DVec3};
use thiserror::Error;

/// How much nearer than its length a cursor may be and still count as on the silhouette, as a share.
const SILHOUETTE_SHARE: f64 = 1e-12;

/// How the world is seen: `screen = scale * (view_from_world * (p - centre)).xy`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Rotation into view axes: x right, y up, z towards the viewer.
    pub view_from_world: DMat3,
    /// What is seen at the screen's origin, metres.
    pub centre: DVec3,
    /// Screen units for one metre, above zero.
    pub scale: f64,
}

impl View {
    /// Where a point of the world is seen.
    pub fn screen(&self, point: DVec3) -> DVec2 {
        (self.view_from_world * (point - self.centre)).truncate() * self.scale
    }

    /// The view from the side, turned by a quarter about the screen's vertical: for choosing between near
    /// and far with one's own eyes.
    #[must_use]
    pub fn from_side(&self) -> Self {
        let turn = DMat3::from_rotation_y(-std::f64::consts::FRAC_PI_2);
        Self {
            view_from_world: turn * self.view_from_world,
            ..*self
        }
    }
}

/// How the sight line lies to the sphere of the link's end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    /// It passes outside: one answer, drawn towards the cursor.
    Outside,
    /// It touches: one answer.
    Tangent,
    /// It goes through: two answers.
    Inside,
}

/// Which of two answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// Towards the viewer.
    #[default]
    Near,
    /// Away from the viewer.
    Far,
}

/// What a cursor asks of a link. Directions are unit vectors in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// How many answers there are, and why.
    pub sight: Sight,
    /// The one towards the viewer, or the only one.
    pub near: DVec3,
    /// The one away from the viewer; the same where there is only one.
    pub far: DVec3,
}

impl Answer {
    /// The direction on that side.
    pub fn direction(&self, side: Side) -> DVec3 {
        match side {
            Side::Near => self.near,
            Side::Far => self.far,
        }
    }
}

/// Why a cursor cannot pose a link.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum PosingError {
    /// A length is above zero.
    #[error("the link is {0} long; a length is a finite number above zero")]
    BadLength(f64),
    /// A scale is above zero.
    #[error("the view's scale is {0}; a scale is a finite number above zero")]
    BadScale(f64),
    /// Something else is NaN or infinite.
    #[error("cursor, start or view is not finite")]
    NotFinite,
}

/// The directions in which a link of that length, starting there, ends nearest to the sight line through
/// `cursor` (screen units).
pub fn aim(view: &View, start: DVec3, length: f64, cursor: DVec2) -> Result<Answer, PosingError> {
    if !(length.is_finite() && length > 0.0) {
        return Err(PosingError::BadLength(length));
    }
    if !(view.scale.is_finite() && view.scale > 0.0) {
        return Err(PosingError::BadScale(view.scale));
    }
    let finite = view.view_from_world.is_finite() && view.centre.is_finite();
    if !(finite && start.is_finite() && cursor.is_finite()) {
        return Err(PosingError::NotFinite);
    }
    let seen = view.view_from_world * (start - view.centre);
    let gap = cursor / view.scale - seen.truncate();
    let radius = gap.x.hypot(gap.y);
    let world_from_view = view.view_from_world.transpose();
    if radius >= length * (1.0 - SILHOUETTE_SHARE) {
        let only = world_from_view * (gap / radius).extend(0.0);
        let outside = radius > length * (1.0 + SILHOUETTE_SHARE);
        let sight = if outside { Sight::Outside } else { Sight::Tangent };
        return Ok(Answer {
            sight,
            near: only,
            far: only,
        });
    }
    let across = gap / length;
    // The two factors apart keep the digits that a difference of squares would lose.
    let depth = ((length - radius) * (length + radius)).sqrt() / length;
    Ok(Answer {
        sight: Sight::Inside,
        near: world_from_view * across.extend(depth),
        far: world_from_view * across.extend(-depth),
    })
}

/// Azimuth from +x towards +y, and polar angle from +z, of a unit direction; radians.
pub fn sphere_angles(direction: DVec3) -> (f64, f64) {
    let radius = direction.x.hypot(direction.y);
    (angle(direction.y, direction.x), angle(radius, direction.z))
}
