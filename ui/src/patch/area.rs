//! Rectangles of the patch panel's plane: points, x right, y down. Plain numbers, so that layout, routes and hit
//! tests need no window.

use glam::Vec2;

/// A rectangle.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Area {
    /// Upper left corner.
    pub min: Vec2,
    /// Lower right corner.
    pub max: Vec2,
}

impl Area {
    /// From a corner and a size.
    pub fn new(min: Vec2, size: Vec2) -> Area {
        Area { min, max: min + size }
    }

    /// Between any two corners.
    pub fn between(a: Vec2, b: Vec2) -> Area {
        Area {
            min: a.min(b),
            max: a.max(b),
        }
    }

    /// Width and height.
    pub fn size(self) -> Vec2 {
        self.max - self.min
    }

    /// Its middle.
    pub fn centre(self) -> Vec2 {
        (self.min + self.max) / 2.0
    }

    /// Larger by `by` on every side.
    #[must_use]
    pub fn grown(self, by: f32) -> Area {
        Area {
            min: self.min - by,
            max: self.max + by,
        }
    }

    /// The smallest rectangle around both.
    #[must_use]
    pub fn union(self, other: Area) -> Area {
        Area {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Whether a point lies inside or on the edge.
    pub fn contains(self, at: Vec2) -> bool {
        at.cmpge(self.min).all() && at.cmple(self.max).all()
    }

    /// Whether more than an edge is shared.
    pub fn meets(self, other: Area) -> bool {
        self.min.cmplt(other.max).all() && other.min.cmplt(self.max).all()
    }
}
