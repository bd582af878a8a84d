//! The direction of a link between two keys: along the great circle, by one of two laws.
//!
//! Source: the thesis, section 4.4. Opposite directions have no great circle of their own; our choice is
//! to bend towards the link's own x axis, so that the twist dial steers it.

use super::frame::angle;
use glam::DVec3;
use thiserror::Error;

/// Sine below which two unit directions count as parallel or opposite.
const PARALLEL_SINE: f64 = 1e-8;

/// How fast the direction goes along its circle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DirectionLaw {
    /// The end of the link runs straight at constant speed and is pushed out to the sphere: slow at the
    /// ends, fast in the middle.
    Chord,
    /// Constant angular speed.
    #[default]
    Constant,
}

/// A direction of length zero, or not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("a direction must be finite and longer than zero")]
pub struct BadDirection;

/// A stretch of great circle from one unit direction to another, over s from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GreatCircle {
    /// The direction at s = 0.
    pub(super) from: DVec3,
    /// The unit direction of setting out, at a right angle to `from`.
    pub(super) towards: DVec3,
    /// How far it goes, radians.
    pub(super) angle_rad: f64,
    pub(super) law: DirectionLaw,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Proper,
    Parallel,
    Opposite,
}

/// The unit vector of any finite direction longer than zero, at any scale.
pub fn unit(direction: DVec3) -> Result<DVec3, BadDirection> {
    let largest = direction.abs().max_element();
    if !direction.is_finite() || largest == 0.0 {
        return Err(BadDirection);
    }
    (direction / largest).try_normalize().ok_or(BadDirection)
}

impl GreatCircle {
    /// From `from` to `to`, which need not be unit vectors. `aside` is where it bends if they are opposite:
    /// the link's own x axis at the first key, at a right angle to `from`.
    pub fn between(from: DVec3, to: DVec3, aside: DVec3, law: DirectionLaw) -> Result<Self, BadDirection> {
        let (from, to, aside) = (unit(from)?, unit(to)?, unit(aside)?);
        let (normal, cosine) = (from.cross(to), from.dot(to));
        let sine = normal.length();
        if sine >= PARALLEL_SINE {
            let towards = unit(to - from * cosine)?;
            return Ok(Self {
                from,
                towards,
                angle_rad: sine.atan2(cosine),
                law,
                kind: Kind::Proper,
            });
        }
        let opposite = cosine < 0.0;
        if opposite || sine == 0.0 {
            let kind = if opposite { Kind::Opposite } else { Kind::Parallel };
            let angle_rad = if opposite { std::f64::consts::PI } else { 0.0 };
            // Opposite directions have no chord to follow: constant speed under either law.
            return Ok(Self {
                from,
                towards: aside,
                angle_rad,
                law: DirectionLaw::Constant,
                kind,
            });
        }
        // The difference has lost its digits along `from`; take it at a right angle again.
        let across = normal.cross(from);
        let towards = unit(across - from * across.dot(from))?;
        Ok(Self {
            from,
            towards,
            angle_rad: sine,
            law: DirectionLaw::Constant,
            kind: Kind::Parallel,
        })
    }

    /// The angle between the ends, 0 to pi; 0 for directions too close to tell apart.
    pub fn angle_rad(&self) -> f64 {
        if self.kind == Kind::Parallel {
            0.0
        } else {
            self.angle_rad
        }
    }

    /// The unit direction at s = 0.
    pub fn from(&self) -> DVec3 {
        self.from
    }

    /// The unit direction of setting out, at a right angle to [`GreatCircle::from`].
    pub fn towards(&self) -> DVec3 {
        self.towards
    }

    /// How far it really goes, radians: what [`GreatCircle::angle_rad`] calls 0 may be a trace above it.
    pub(crate) fn whole_rad(&self) -> f64 {
        self.angle_rad
    }

    /// Whether the ends are opposite, so that the plane was chosen and not given.
    pub fn ambiguous(&self) -> bool {
        self.kind == Kind::Opposite
    }

    /// The unit direction at s, 0 to 1.
    pub fn direction(&self, s: f64) -> DVec3 {
        let (sin, cos) = self.turned(s);
        self.from * cos + self.towards * sin
    }

    /// Angular speed at s, radians per unit of s.
    pub fn speed(&self, s: f64) -> f64 {
        match (self.kind, self.law) {
            (Kind::Parallel, _) => 0.0,
            (_, DirectionLaw::Constant) => self.angle_rad,
            (_, DirectionLaw::Chord) => {
                let (sin, cos) = self.angle_rad.sin_cos();
                sin / (1.0 - 2.0 * s * (1.0 - s) * (1.0 - cos))
            }
        }
    }

    /// How far along the circle s is, radians from `from`.
    pub fn progress_rad(&self, s: f64) -> f64 {
        let (sin, cos) = self.angle_rad.sin_cos();
        match self.law {
            DirectionLaw::Constant => s * self.angle_rad,
            DirectionLaw::Chord => angle(s * sin, 1.0 - s + s * cos),
        }
    }

    /// Sine and cosine of [`GreatCircle::progress_rad`].
    fn turned(&self, s: f64) -> (f64, f64) {
        self.progress_rad(s).sin_cos()
    }
}
