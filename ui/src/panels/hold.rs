//! Taking hold of a puppet on screen: the end of a link is dragged across the picture, as deep as it was.

use egui::{PointerButton, Pos2, Rect, Response, Ui, vec2};
use glam::DVec3;
use rig::{Command, EndHandle, PuppetPose, PuppetPoseView};

use super::Commands;
use super::style::{self, ink};
use crate::render::camera::Camera;
use crate::render::theme;

/// How near the pointer must come to an end to take it, points.
const REACH: f32 = 12.0;
/// A picture lower than this shows where to take hold only while a pointer is over it, points.
const SMALL: f32 = 260.0;

/// What a hand holds.
#[derive(Default)]
pub struct Hold {
    held: Option<Held>,
}

struct Held {
    link: String,
    /// Where the end was when it was taken, world axes, metres.
    from: DVec3,
    /// Where the pointer was then.
    pressed: Pos2,
}

impl Hold {
    /// Lets a hand drag ends of `pose` in a picture that shows it; returns whether it holds one.
    pub fn drag(
        &mut self,
        ui: &Ui,
        (area, camera): (Rect, &Camera),
        response: &Response,
        pose: &PuppetPoseView,
        commands: &mut Commands<'_>,
    ) -> bool {
        if response.drag_started_by(PointerButton::Primary)
            && let Some(pressed) = ui.input(|input| input.pointer.press_origin())
        {
            self.held = under(pose, camera, area, pressed).map(|end| Held {
                link: end.link.clone(),
                from: end.at,
                pressed,
            });
        }
        if response.drag_stopped() {
            self.held = None;
        }
        let pointer = response.interact_pointer_pos();
        if let (Some(held), Some(pointer)) = (&self.held, pointer.filter(|_| response.dragged())) {
            let to = held.from + moved(camera, area, held.pressed, pointer);
            commands.push(Command::PuppetPose(PuppetPose::Drag {
                link: held.link.clone(),
                to: to.to_array(),
            }));
        }
        self.held.is_some()
    }

    /// Rings where a hand can take hold, while one is near; the name of the one it would take or has taken.
    pub fn mark(&self, ui: &Ui, (area, camera): (Rect, &Camera), response: &Response, pose: &PuppetPoseView) {
        let hover = response.hover_pos().and_then(|at| under(pose, camera, area, at));
        let chosen = match &self.held {
            Some(held) => pose.ends.iter().find(|end| end.link == held.link),
            None => hover,
        };
        let painter = ui.painter().with_clip_rect(area);
        // A small picture would be full of them.
        let small = area.height() < SMALL && !response.hovered() && self.held.is_none();
        for end in pose.ends.iter().filter(|_| !small) {
            painter.circle_stroke(on_screen(camera, area, end.at), 5.0, style::hair(theme::DIM));
        }
        let Some(end) = chosen else { return };
        let colour = if self.held.is_some() {
            theme::SELECTED
        } else {
            theme::TEXT
        };
        let at = on_screen(camera, area, end.at);
        painter.circle_stroke(at, 7.0, egui::Stroke::new(1.5, ink(colour)));
        let name = (end.link.replace('_', " "), style::words(theme::SIZE_SMALL));
        let galley = painter.layout_no_wrap(name.0, name.1, ink(colour));
        // Beside the end, and inside the picture.
        let room = area.shrink(theme::STEP);
        let wanted = at + vec2(10.0, -10.0 - galley.size().y);
        let corner = wanted.min(room.max - galley.size()).max(room.min);
        painter.galley(corner, galley, ink(colour));
    }
}

/// The end nearest to a point of the picture and within reach; of ends in one place the outermost.
fn under<'a>(pose: &'a PuppetPoseView, camera: &Camera, area: Rect, at: Pos2) -> Option<&'a EndHandle> {
    let far = |end: &&EndHandle| on_screen(camera, area, end.at).distance(at);
    let nearest = pose.ends.iter().rev().min_by(|a, b| far(a).total_cmp(&far(b)));
    nearest.filter(|end| far(end) <= REACH)
}

fn on_screen(camera: &Camera, area: Rect, world: DVec3) -> Pos2 {
    let seen = camera.project(world);
    area.center() + vec2(seen.x as f32, -seen.y as f32) * (area.height() / 2.0)
}

/// A way across the picture as one through the world, metres, world axes.
fn moved(camera: &Camera, area: Rect, from: Pos2, to: Pos2) -> DVec3 {
    let by = (to - from) / (area.height() / 2.0).max(1.0);
    let view = DVec3::new(f64::from(by.x), f64::from(-by.y), 0.0) * camera.half_height;
    camera.view_from_world.transpose() * view
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn an_end_goes_where_the_pointer_goes() {
        let area = Rect::from_min_size(pos2(30.0, 10.0), vec2(300.0, 200.0));
        let camera = Camera::turned(0.9, 0.25, DVec3::new(0.1, 0.2, 0.0), 0.4);
        let end = DVec3::new(0.2, 0.1, 0.3);
        let at = on_screen(&camera, area, end);
        let to = at + vec2(40.0, -25.0);
        let moved = end + moved(&camera, area, at, to);
        assert!(on_screen(&camera, area, moved).distance(to) < 1e-3);
        let depth = |world: DVec3| camera.project(world).z;
        assert!((depth(moved) - depth(end)).abs() < 1e-9, "as deep as it was");
    }

    #[test]
    fn of_two_ends_in_one_place_the_outer_one_is_taken() {
        let end = |link: &str, x: f64| EndHandle {
            link: link.into(),
            at: DVec3::new(x, 0.0, 0.0),
        };
        let pose = PuppetPoseView {
            ends: vec![end("base", -0.3), end("wrist", 0.1), end("jaw", 0.1)],
            ..PuppetPoseView::default()
        };
        let area = Rect::from_min_size(pos2(0.0, 0.0), vec2(200.0, 200.0));
        let camera = Camera::turned(0.0, 0.0, DVec3::ZERO, 1.0);
        let taken = |x: f32| under(&pose, &camera, area, pos2(x, 103.0)).map(|end| end.link.as_str());
        assert_eq!(taken(112.0), Some("jaw"));
        assert_eq!(taken(72.0), Some("base"));
        assert_eq!(taken(150.0), None);
    }
}
