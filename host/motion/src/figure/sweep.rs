//! One link from one key to the next: direction, twist and length together.
//!
//! `Transport` carries the whole frame along the great circle and spins it evenly, so nothing ever jumps.
//! `Zyz` interpolates the twist angle, as the thesis says, and flips by half a turn when the circle passes
//! a pole; it is kept for old scripts. Both meet both keys exactly.
//! Source: the thesis, section 4.4; maths notes 5.2.

use super::LinkPose;
use super::frame::{angle, frame_of};
use super::great_circle::{BadDirection, DirectionLaw, GreatCircle};
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};

/// A turn this close above minus a half turn counts as plus a half turn, radians.
const HALF_TURN_SLACK: f64 = 1e-9;

/// How twist goes from key to key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TwistLaw {
    /// The frame is carried along the great circle and spins evenly about the link.
    #[default]
    Transport,
    /// The twist angle itself is interpolated, over the z-y-z frame of the direction.
    Zyz,
}

/// The motion of one link between two keys, over s from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweep {
    circle: GreatCircle,
    twist_law: TwistLaw,
    /// The circle's axis: from x towards.
    normal: DVec3,
    /// Where the link's x axis lies at s = 0 in the plane (towards, normal).
    roll_rad: f64,
    /// How far it turns in that plane until s = 1.
    roll_change_rad: f64,
    twist_rad: f64,
    twist_change_rad: f64,
    length: f64,
    length_change: f64,
}

impl Sweep {
    /// From one key to the next. Directions need not be unit vectors.
    pub fn between(
        from: &LinkPose,
        to: &LinkPose,
        direction_law: DirectionLaw,
        twist_law: TwistLaw,
    ) -> Result<Self, BadDirection> {
        let start = frame_of(super::great_circle::unit(from.direction)?);
        let end = frame_of(super::great_circle::unit(to.direction)?);
        let (sin, cos) = from.twist_rad.sin_cos();
        let own_x = start.x_axis * cos + start.y_axis * sin;
        let circle = GreatCircle::between(from.direction, to.direction, own_x, direction_law)?;
        let normal = circle.from.cross(circle.towards);
        // The untwisted x axis of the first key, carried to the second, seen from the second's frame.
        let carried = {
            let (sin, cos) = circle.angle_rad.sin_cos();
            let (x, up) = (start.x_axis.dot(circle.towards), start.x_axis.dot(normal));
            (circle.towards * cos - circle.from * sin) * x + normal * up
        };
        let mut holonomy_rad = angle(carried.dot(end.y_axis), carried.dot(end.x_axis));
        if holonomy_rad <= HALF_TURN_SLACK - PI {
            holonomy_rad += TAU;
        }
        let twist_change_rad = to.twist_rad - from.twist_rad;
        Ok(Self {
            circle,
            twist_law,
            normal,
            roll_rad: angle(own_x.dot(normal), own_x.dot(circle.towards)),
            roll_change_rad: twist_change_rad - holonomy_rad,
            twist_rad: from.twist_rad,
            twist_change_rad,
            length: from.length,
            length_change: to.length - from.length,
        })
    }

    /// The great circle of its direction.
    pub fn circle(&self) -> &GreatCircle {
        &self.circle
    }

    /// The angle that turns the frame's x axis from its reference, at s = 0, and its change until s = 1;
    /// the reference is the direction of travel, or under `Zyz` the untwisted frame.
    pub(crate) fn rolling(&self) -> [f64; 2] {
        match self.twist_law {
            TwistLaw::Transport => [self.roll_rad, self.roll_change_rad],
            TwistLaw::Zyz => [self.twist_rad, self.twist_change_rad],
        }
    }

    /// The link's length at s.
    pub fn length(&self, s: f64) -> f64 {
        self.length + self.length_change * s
    }

    /// The unit direction at s.
    pub fn direction(&self, s: f64) -> DVec3 {
        self.circle.direction(s)
    }

    /// The link's frame at s.
    pub fn frame(&self, s: f64) -> DMat3 {
        let (sin, cos) = self.circle.progress_rad(s).sin_cos();
        let z = self.circle.from * cos + self.circle.towards * sin;
        let (ahead, aside, roll_rad) = match self.twist_law {
            TwistLaw::Transport => {
                let ahead = self.circle.towards * cos - self.circle.from * sin;
                (ahead, self.normal, self.roll_rad + self.roll_change_rad * s)
            }
            TwistLaw::Zyz => {
                let frame = frame_of(z);
                (
                    frame.x_axis,
                    frame.y_axis,
                    self.twist_rad + self.twist_change_rad * s,
                )
            }
        };
        let (sin, cos) = roll_rad.sin_cos();
        DMat3::from_cols(ahead * cos + aside * sin, aside * cos - ahead * sin, z)
    }

    /// The twist angle at s that gives [`Sweep::frame`] over the direction's own frame; of all the turns
    /// that do, the one nearest to the even course from key to key.
    pub fn twist_rad(&self, s: f64) -> f64 {
        let even = self.twist_rad + self.twist_change_rad * s;
        match self.twist_law {
            TwistLaw::Zyz => even,
            TwistLaw::Transport => twist_of(&self.frame(s), even),
        }
    }

    /// The whole pose of the link at s.
    pub fn pose(&self, s: f64) -> LinkPose {
        LinkPose {
            direction: self.direction(s),
            twist_rad: self.twist_rad(s),
            length: self.length(s),
        }
    }
}

/// The twist angle of a frame over its direction's own frame, of all its turns the one nearest to `near`.
pub(crate) fn twist_of(world_from_link: &DMat3, near_rad: f64) -> f64 {
    let untwisted = frame_of(world_from_link.z_axis);
    let x = world_from_link.x_axis;
    let wrapped = angle(x.dot(untwisted.y_axis), x.dot(untwisted.x_axis));
    wrapped + TAU * ((near_rad - wrapped) / TAU).round()
}
