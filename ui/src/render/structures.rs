//! The network's own display structures: vectors and lettering that no figure has drawn.
//!
//! A structure with viewing nodes of its own (window, eye) brings its own camera: its lines are put where
//! that camera shows them, flat in the middle of ours. Everything else lies in the world.

use glam::{DVec2, DVec3};
use ps300::display::{DisplayList, View};

use super::camera::Camera;
use super::figure::colour_of;
use super::scene::{Ink, Layer, Place, Scene};
use super::theme;

/// Points of type for lettering as high as half the picture; pictures are about 500 points high.
const LETTERING_POINTS: f32 = 250.0;

/// Adds everything that is displayed.
pub fn add(scene: &mut Scene, display: &DisplayList) {
    let camera = scene.camera;
    let world = |view: u16, point: DVec3| match display.views.get(usize::from(view)) {
        Some(view) => placed(view, &camera, point),
        None => point,
    };
    for stroke in &display.strokes {
        let colour = colour_of(stroke.hue_deg, stroke.saturation, stroke.intensity);
        let (from, to) = (world(stroke.view, stroke.from), world(stroke.view, stroke.to));
        scene.stroke(from, to, theme::WIDTH_GHOST, Ink::new(colour, Layer::Figure));
    }
    for lettering in &display.letterings {
        let colour = colour_of(lettering.hue_deg, lettering.saturation, lettering.intensity);
        let at = world(lettering.view, lettering.at);
        let top = world(lettering.view, lettering.at + lettering.up);
        let height = (at.distance(top) / camera.half_height) as f32 * LETTERING_POINTS;
        let size = height.clamp(theme::SIZE_SMALL, theme::SIZE_READOUT);
        let ink = Ink::new(colour, Layer::Overlay);
        scene.label(Place::World(at, [0.0, -size]), lettering.text.as_ref(), size, ink);
    }
}

/// Where our camera must see a point so that it stands where the view's own camera puts it.
fn placed(view: &View, camera: &Camera, point: DVec3) -> DVec3 {
    let Some(screen_from_world) = view.screen_from_world else {
        return point;
    };
    let screen = screen_from_world.project_point3(point);
    let [left, right] = view.viewport.horizontal;
    let [bottom, top] = view.viewport.vertical;
    let x = left + (right - left) * (screen.x + 1.0) / 2.0;
    let y = bottom + (top - bottom) * (screen.y + 1.0) / 2.0;
    camera.centre + camera.view_from_world.transpose() * (DVec2::new(x, y) * camera.half_height).extend(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat4;
    use ps300::display::Viewport;

    #[test]
    fn a_view_of_its_own_ignores_our_camera() {
        let camera = Camera::turned(0.7, 0.3, DVec3::new(1.0, 2.0, 3.0), 2.0);
        let viewport = Viewport {
            horizontal: [0.0, 1.0],
            ..Viewport::default()
        };
        let view = View {
            screen_from_world: Some(DMat4::IDENTITY),
            viewport,
        };
        let seen = camera.project(placed(&view, &camera, DVec3::new(-1.0, 0.5, 0.0)));
        assert!(
            (seen.truncate() - DVec2::new(0.0, 0.5)).length() < 1e-12,
            "{seen}"
        );
        let plain = View {
            screen_from_world: None,
            ..view
        };
        assert_eq!(placed(&plain, &camera, DVec3::X), DVec3::X);
    }
}
