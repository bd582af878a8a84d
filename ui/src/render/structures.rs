//! The network's own display structures: lines, letters and faces that no figure has drawn.
//!
//! A structure with viewing nodes of its own (window, eye) brings its own camera: its lines are put where
//! that camera shows them, and as deep. Everything else lies in the world.

use glam::{DVec2, DVec3};
use ps300::display::{DisplayList, Face, Stroke, View};

use super::camera::Camera;
use super::figure::colour_of;
use super::scene::{self, Ink, Layer, Scene, Surface};
use super::theme;

/// Adds everything that is displayed.
pub fn add(scene: &mut Scene, display: &DisplayList) {
    let camera = scene.camera;
    let view = |index: u16| display.views.get(usize::from(index));
    for stroke in &display.strokes {
        scene.strokes.push(line(stroke, view(stroke.view), &camera));
    }
    for face in &display.faces {
        let surface = surface(face, display, view(face.view), &camera);
        scene.surfaces.push(surface);
    }
}

fn world(view: Option<&View>, camera: &Camera, point: DVec3) -> DVec3 {
    view.map_or(point, |view| placed(view, camera, point))
}

fn line(stroke: &Stroke, view: Option<&View>, camera: &Camera) -> scene::Stroke {
    let [begin, end] = stroke.intensity.map(|brightness| brightness as f32);
    let colour = colour_of(stroke.hue_deg, stroke.saturation, 1.0);
    let ink = Ink::new(colour, Layer::Figure).faded(begin);
    let own = view.is_some_and(|view| view.screen_from_world.is_some());
    let said = view.and_then(|view| view.cue);
    scene::Stroke {
        from: world(view, camera, stroke.from),
        to: world(view, camera, stroke.to),
        width: theme::WIDTH_GHOST,
        ink: Ink {
            cued: !own,
            cue: said.map_or(ink.cue, |[far, near]| [(far / near.max(1e-6)) as f32, 1.0]),
            ..ink
        },
        to_strength: end,
    }
}

fn surface(face: &Face, display: &DisplayList, view: Option<&View>, camera: &Camera) -> Surface {
    let slice = |range: &std::ops::Range<u32>| range.start as usize..range.end as usize;
    let mut corners = display.corners.get(slice(&face.corners)).unwrap_or(&[]).to_vec();
    for corner in &mut corners {
        corner.at = world(view, camera, corner.at);
    }
    let edges = display.edges.get(slice(&face.edges)).unwrap_or(&[]);
    let material = |index: u16| {
        let found = display.materials.get(usize::from(index));
        found.copied().unwrap_or_default()
    };
    let lights = usize::from(face.lights.start)..usize::from(face.lights.end);
    let [near, further] = face.cue;
    let said = view.and_then(|view| view.cue);
    let cue = match (view.and_then(|view| view.screen_from_world), said) {
        (Some(_), _) => [near + further, near].map(|brightness| brightness as f32),
        (None, Some([far, near])) => [far, near].map(|brightness| brightness as f32),
        (None, None) => [theme::CUE_FAR, 1.0],
    };
    Surface {
        corners,
        fill: face.fill,
        one_sided: face.one_sided,
        normal: face.normal,
        viewer: face.viewer,
        materials: [material(face.front), material(face.back)],
        lights: display.lights.get(lights).unwrap_or(&[]).to_vec(),
        cue,
        edges: edges.iter().map(|edge| line(edge, view, camera)).collect(),
    }
}

/// Where our camera must see a point so that it stands where the view's own camera puts it.
fn placed(view: &View, camera: &Camera, point: DVec3) -> DVec3 {
    let Some(screen_from_world) = view.screen_from_world else {
        return point;
    };
    let screen = view.onto_screen(screen_from_world.project_point3(point));
    // Depth 0 is the nearest and 1 the farthest of the view, and of the camera's depth cue.
    let depth = camera.half_depth * (1.0 - 2.0 * screen.z);
    let onto = (DVec2::new(screen.x, screen.y) * camera.half_height).extend(depth);
    camera.centre + camera.view_from_world.transpose() * onto
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
            cue: None,
        };
        let seen = camera.project(placed(&view, &camera, DVec3::new(-1.0, 0.5, 0.25)));
        assert!((seen - DVec3::new(0.0, 0.5, 0.5)).length() < 1e-12, "{seen}");
        let plain = View {
            screen_from_world: None,
            ..view
        };
        assert_eq!(placed(&plain, &camera, DVec3::X), DVec3::X);
    }
}
