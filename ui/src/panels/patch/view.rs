//! The plane on the screen: where its places are, and how much of a box can be told at this size.

use egui::{Pos2, Rect, pos2};
use glam::Vec2;

use crate::patch::area::Area;
use crate::patch::camera::Camera;

/// Names, values and ports can be read from this zoom.
const FULL: f32 = 0.55;
/// Names can be read from this zoom.
const NAMES: f32 = 0.2;

/// How much is painted of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Detail {
    /// A block of colour.
    Blocks,
    /// A block with a name.
    Names,
    /// Everything.
    Full,
}

/// A camera and the rectangle it fills.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) area: Rect,
    pub(super) camera: Camera,
}

impl View {
    pub(super) fn screen(&self, at: Vec2) -> Pos2 {
        let at = self.camera.to_screen(at);
        pos2(self.area.left() + at.x, self.area.top() + at.y)
    }

    pub(super) fn plane(&self, at: Pos2) -> Vec2 {
        self.camera.to_plane(self.within(at))
    }

    /// A place on the screen from the view's corner.
    pub(super) fn within(&self, at: Pos2) -> Vec2 {
        Vec2::new(at.x - self.area.left(), at.y - self.area.top())
    }

    pub(super) fn rect(&self, area: Area) -> Rect {
        Rect::from_min_max(self.screen(area.min), self.screen(area.max))
    }

    pub(super) fn size(&self) -> Vec2 {
        Vec2::new(self.area.width(), self.area.height())
    }

    pub(super) fn detail(&self) -> Detail {
        match self.camera.zoom {
            zoom if zoom >= FULL => Detail::Full,
            zoom if zoom >= NAMES => Detail::Names,
            _ => Detail::Blocks,
        }
    }

    /// A length of the plane on the screen.
    pub(super) fn length(&self, points: f32) -> f32 {
        points * self.camera.zoom
    }
}
