//! The figure: the large front view and the narrow side view, at the same scale and height.

use egui::accesskit::Role;
use egui::text::{LayoutJob, TextFormat, TextWrapping};
use egui::{Align2, PointerButton, Pos2, Rect, Response, Sense, Ui, pos2, vec2};
use rig::{Command, FigureView, Note, NoteLevel, PoseCommand, Snapshot, ViewCommand};

use super::button::{self, Button};
use super::hold::Hold;
use super::style::{self, ink};
use super::{Commands, Panel, canvas};
use crate::render::camera::Camera;
use crate::render::{stage, theme};

/// The large view: posing with the pointer, turning, zooming.
#[derive(Default)]
pub struct Front {
    posing: bool,
    hold: Hold,
}

/// The narrow view from the right.
#[derive(Default)]
pub struct Side;

/// How near the pointer must come to a link's end to take it, points.
const REACH: f32 = 14.0;
/// Turn of the view for each point dragged, radians: the width of a hand is a quarter turn.
const TURN_RAD_PER_POINT: f64 = 0.007;

impl Panel for Front {
    fn title(&self) -> &'static str {
        "front"
    }

    fn ui(&mut self, ui: &mut Ui, seen: &Snapshot, commands: &mut Commands<'_>) {
        let area = ui.max_rect();
        let scene = stage::scene(seen, &commands.choices.look);
        canvas::show(ui, area, "front", &scene);
        let id = ui.scope_id().with("front");
        let response = button::spot(
            ui,
            area,
            id,
            Sense::click_and_drag(),
            (Role::Canvas, "front view"),
        );
        self.point(ui, area, &scene.camera, &response, seen, commands);
        caption(ui, area, "front", &angles(seen));
        switches(ui, area, commands);
        remark(ui, area, seen);
        if seen.figure.is_none() && seen.puppet_pose.is_none() && seen.display.is_empty() {
            let text = ("This show has no figure", style::words(theme::SIZE_TITLE));
            style::line(
                ui.painter(),
                area.center(),
                Align2::CENTER_CENTER,
                text,
                theme::DIM,
                area.width(),
            );
        }
    }
}

impl Front {
    /// A press near a link's end takes that link; anywhere else it turns the view.
    fn point(
        &mut self,
        ui: &Ui,
        area: Rect,
        camera: &Camera,
        response: &Response,
        seen: &Snapshot,
        commands: &mut Commands<'_>,
    ) {
        let figure = seen.figure.as_ref();
        let puppet = seen.puppet_pose.as_ref().filter(|_| figure.is_none());
        if let Some(pose) = puppet {
            let holds = self.hold.drag(ui, (area, camera), response, pose, commands);
            self.hold.mark(ui, (area, camera), response, pose);
            if holds {
                return;
            }
        }
        let under = |at: Pos2| figure.and_then(|f| link_under(f, camera, area, at));
        let origin = ui.input(|input| input.pointer.press_origin());
        let started = response.drag_started_by(PointerButton::Primary);
        if let Some(link) = origin.filter(|_| started || response.clicked()).and_then(under) {
            commands.push(Command::Pose(PoseCommand::Select(link)));
            self.posing = started;
        }
        if let (true, Some(at)) = (self.posing && response.dragged(), response.interact_pointer_pos()) {
            commands.push(Command::Pose(PoseCommand::Cursor(cursor(area, at))));
        } else if response.dragged() {
            let by = response.drag_delta() * TURN_RAD_PER_POINT as f32;
            let turn = ViewCommand::Turn {
                azimuth_by_rad: by.x.into(),
                elevation_by_rad: by.y.into(),
            };
            commands.push(Command::View(turn));
        }
        if response.drag_stopped() {
            self.posing = false;
        }
        if response.hovered() {
            let scrolled = ui.input(|input| input.smooth_scroll_delta.y);
            if scrolled != 0.0 {
                commands.push(Command::View(ViewCommand::Zoom {
                    by: f64::from(scrolled * 0.002).exp(),
                }));
            }
        }
        if let (Some(figure), Some(at)) = (figure, response.hover_pos()) {
            hover_mark(ui, area, camera, figure, at);
        }
    }
}

/// The pointer as the posing cursor, in the rig's half-heights from the middle, y up.
fn cursor(area: Rect, at: Pos2) -> [f64; 2] {
    let half = area.height() / 2.0;
    let from_middle = at - area.center();
    let [x, y] = [f64::from(from_middle.x / half), f64::from(-from_middle.y / half)];
    [x, y].map(|shown| (shown * stage::SHOWN_HALF_HEIGHT).clamp(-1.0, 1.0))
}

fn on_screen(camera: &Camera, area: Rect, world: glam::DVec3) -> Pos2 {
    let seen = camera.project(world);
    area.center() + vec2(seen.x as f32, -seen.y as f32) * (area.height() / 2.0)
}

/// The link whose end is nearest to the pointer and within reach.
fn link_under(figure: &FigureView, camera: &Camera, area: Rect, at: Pos2) -> Option<u16> {
    let ends = figure
        .placed
        .iter()
        .map(|link| on_screen(camera, area, link.end).distance(at));
    let (index, distance) = ends.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
    (distance <= REACH).then_some(index as u16)
}

fn hover_mark(ui: &Ui, area: Rect, camera: &Camera, figure: &FigureView, at: Pos2) {
    let Some(link) = link_under(figure, camera, area, at) else {
        return;
    };
    let Some(placed) = figure.placed.get(usize::from(link)) else {
        return;
    };
    let end = on_screen(camera, area, placed.end);
    let painter = ui.painter().with_clip_rect(area);
    painter.circle_stroke(end, 8.0, style::hair(theme::TEXT));
    if figure.selected != Some(link) {
        let name = figure
            .figure
            .links()
            .get(usize::from(link))
            .map_or("", |l| l.name.as_str());
        let font = style::words(theme::SIZE_BODY);
        painter.text(
            end + vec2(12.0, -14.0),
            Align2::LEFT_BOTTOM,
            name,
            font,
            ink(theme::TEXT),
        );
    }
}

fn angles(seen: &Snapshot) -> String {
    let degrees = |rad: f64| (rad.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
    format!(
        "{:.0}°  {:.0}°",
        degrees(seen.view.azimuth_rad),
        degrees(seen.view.elevation_rad)
    )
}

fn caption(ui: &Ui, area: Rect, name: &str, detail: &str) {
    let at = area.min + vec2(theme::MARGIN, theme::MARGIN);
    let font = style::words(theme::SIZE_SMALL);
    let drawn = ui
        .painter()
        .text(at, Align2::LEFT_TOP, name.to_uppercase(), font, ink(theme::DIM));
    let at = drawn.right_top() + vec2(theme::GAP, 0.0);
    ui.painter().text(
        at,
        Align2::LEFT_TOP,
        detail,
        style::digits(theme::SIZE_SMALL),
        ink(theme::FAINT),
    );
}

fn switches(ui: &mut Ui, area: Rect, commands: &mut Commands<'_>) {
    let top = area.top() + theme::GAP;
    let mut right = area.right() - theme::GAP;
    let mut cell = |width: f32| {
        right -= width;
        let rect = Rect::from_min_size(pos2(right, top), vec2(width, theme::ROW));
        right -= theme::STEP;
        rect
    };
    let reset = Button::new("Fit", "Back to the front, with the whole figure in view.", "V");
    if reset.show(ui, cell(44.0)).clicked() {
        commands.push(Command::View(ViewCommand::Reset));
    }
    let look = &mut commands.choices.look;
    let switches = [
        ("Floor", "A grid under the feet.", "G", &mut look.floor),
        (
            "Ticks",
            "The way of the selected link, one tick each 1/12 s: close is slow, wide is fast.",
            "T",
            &mut look.ticks,
        ),
        (
            "Onion",
            "Poses before and after, fainter the farther.",
            "O",
            &mut look.onion,
        ),
    ];
    for (text, tip, keys, on) in switches {
        if Button::new(text, tip, keys)
            .switch(*on)
            .show(ui, cell(56.0))
            .clicked()
        {
            *on = !*on;
        }
    }
}

/// How long a remark stays, seconds.
const REMARK_SECS: f64 = 8.0;

/// The latest remark, for a while; what says why the puppet has stopped stays as long as it is stopped.
pub fn current_remark(seen: &Snapshot) -> Option<&Note> {
    let note = seen.notes.last()?;
    let stopped = seen.puppet.as_ref().and_then(|puppet| puppet.fault.as_ref());
    let told = stopped.is_some_and(|fault| note.text.contains(fault));
    (told || seen.at_secs - note.at_secs < REMARK_SECS).then_some(note)
}

/// The latest remark, in the lower left corner; long ones take two lines.
pub(crate) fn remark(ui: &Ui, area: Rect, seen: &Snapshot) {
    let Some(note) = current_remark(seen) else {
        return;
    };
    let colour = if note.level == NoteLevel::Info {
        theme::DIM
    } else {
        theme::TEXT
    };
    let at = pos2(area.left() + theme::MARGIN, area.bottom() - theme::MARGIN);
    let font = style::words(theme::SIZE_BODY);
    let width = area.width() - 2.0 * theme::MARGIN;
    let mut job = LayoutJob::single_section(note.text.clone(), TextFormat::simple(font, ink(colour)));
    job.wrap = TextWrapping {
        max_width: width,
        max_rows: 2,
        ..TextWrapping::default()
    };
    let galley = ui.painter().layout_job(job);
    let rect = Align2::LEFT_BOTTOM.anchor_size(at, galley.size());
    // On the ground's own colour, so that the grid does not strike it through.
    ui.painter().rect_filled(
        rect.expand2(vec2(theme::STEP, 2.0)),
        style::round(),
        ink(theme::GROUND),
    );
    ui.painter().galley(rect.min.round(), galley, ink(colour));
}

impl Panel for Side {
    fn title(&self) -> &'static str {
        "side"
    }

    fn ui(&mut self, ui: &mut Ui, seen: &Snapshot, commands: &mut Commands<'_>) {
        let area = ui.max_rect();
        let scene = stage::scene(seen, &commands.choices.look).side();
        canvas::show(ui, area, "side", &scene);
        caption(ui, area, "side", "");
        ui.painter()
            .vline(area.left() + 0.5, area.y_range(), style::hair(theme::EDGE));
        let id = ui.scope_id().with("side");
        let response = button::spot(ui, area, id, Sense::click(), (Role::Canvas, "side view"));
        let offered = seen.figure.as_ref().map_or(&[][..], |figure| &figure.candidates);
        if let (Some(at), [near, far]) = (
            response.interact_pointer_pos().filter(|_| response.clicked()),
            offered,
        ) {
            let distance = |world: &glam::DVec3| on_screen(&scene.camera, area, *world).distance(at);
            let side = if distance(near) <= distance(far) {
                rig::Side::Near
            } else {
                rig::Side::Far
            };
            commands.push(Command::Pose(PoseCommand::Side(side)));
        }
        button::tooltip_at_pointer(
            response,
            "The same from the right. While posing, click near or far.",
            "N",
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn pointer_and_projection_agree() {
        let area = Rect::from_min_size(pos2(10.0, 20.0), vec2(700.0, 400.0));
        let view = rig::ViewState {
            scale: 2.0,
            ..rig::ViewState::default()
        };
        let at = on_screen(&stage::camera(&view), area, DVec3::new(0.2, 0.1, 3.0));
        let [x, y] = cursor(area, at);
        assert!(
            (x - 0.4).abs() < 1e-6 && (y - 0.2).abs() < 1e-6,
            "{x} {y}: metres times the rig's scale"
        );
    }
}
