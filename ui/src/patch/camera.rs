//! Which part of the plane is seen, and how large.

use glam::Vec2;

use super::area::Area;

/// How large things may become.
const ZOOM: [f32; 2] = [0.04, 2.5];
/// Room left around what is framed, points on the screen.
const MARGIN: f32 = 36.0;
/// Framing makes nothing larger than this.
const FRAMED_MAX: f32 = 1.0;

/// From the plane to the screen: scaled, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Screen points for a point of the plane.
    pub zoom: f32,
    /// The place of the plane shown at the upper left corner.
    pub corner: Vec2,
}

impl Default for Camera {
    fn default() -> Self {
        Camera {
            zoom: 1.0,
            corner: Vec2::ZERO,
        }
    }
}

impl Camera {
    /// Where a place of the plane is, from the view's corner.
    pub fn to_screen(self, at: Vec2) -> Vec2 {
        (at - self.corner) * self.zoom
    }

    /// Which place of the plane is there.
    pub fn to_plane(self, at: Vec2) -> Vec2 {
        at / self.zoom + self.corner
    }

    /// Moves with the hand.
    pub fn pan(&mut self, by: Vec2) {
        self.corner -= by / self.zoom;
    }

    /// Larger or smaller by a factor, the place under the pointer staying where it is.
    pub fn zoom_at(&mut self, pointer: Vec2, by: f32) {
        let held = self.to_plane(pointer);
        self.zoom = (self.zoom * by).clamp(ZOOM[0], ZOOM[1]);
        self.corner = held - pointer / self.zoom;
    }

    /// Shows all of `area` in a view of this size, in its middle.
    pub fn frame(&mut self, area: Area, view: Vec2) {
        let room = (view - 2.0 * MARGIN).max(Vec2::splat(50.0));
        let fit = (room / area.size().max(Vec2::ONE)).min_element();
        self.zoom = fit.clamp(ZOOM[0], FRAMED_MAX);
        self.corner = area.centre() - view / self.zoom / 2.0;
    }

    /// What is seen in a view of this size.
    pub fn seen(self, view: Vec2) -> Area {
        Area::new(self.corner, view / self.zoom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_pointer_holds_stays_under_it() {
        let mut camera = Camera::default();
        let pointer = Vec2::new(120.0, 80.0);
        let held = camera.to_plane(pointer);
        for by in [1.3, 0.2, 7.0, 0.001, 1000.0] {
            camera.zoom_at(pointer, by);
            assert!(camera.to_plane(pointer).distance(held) < 0.01, "{camera:?}");
        }
    }

    #[test]
    fn framed_things_are_seen() {
        let area = Area::new(Vec2::new(-300.0, 50.0), Vec2::new(900.0, 2000.0));
        let mut camera = Camera::default();
        camera.frame(area, Vec2::new(800.0, 600.0));
        let seen = camera.seen(Vec2::new(800.0, 600.0));
        assert!(seen.contains(area.min) && seen.contains(area.max), "{seen:?}");
    }
}
