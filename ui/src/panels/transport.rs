//! Time: play, scrub, keys as diamonds, and above them the kinetic curve.

use egui::accesskit::Role;
use egui::{Align2, Rect, Sense, Ui, pos2, vec2};
use rig::{Command, EditCommand, Snapshot, TransportCommand};

use super::button;
use super::keys::paint_diamond;
use super::style::{self, ink};
use super::{Commands, Panel, kinetics, layout, transport_buttons};
use crate::render::theme;
use crate::render::timeline::Timeline;

/// The transport.
#[derive(Default)]
pub struct Transport {
    dragged: Option<Dragged>,
    curve: kinetics::Curve,
}

/// A key on its way to another time.
struct Dragged {
    key: usize,
    secs: f64,
}

/// Heights of the strips, points: keys, ruler.
const TRACK: f32 = 22.0;
const RULER: f32 = 16.0;

impl Panel for Transport {
    fn title(&self) -> &'static str {
        "transport"
    }

    fn ui(&mut self, ui: &mut Ui, seen: &Snapshot, commands: &mut Commands<'_>) {
        let area = layout::inside(ui.max_rect());
        let buttons = Rect::from_min_size(area.min, vec2(area.width(), theme::ROW));
        let ruler = Rect::from_min_max(pos2(area.left(), area.bottom() - RULER), area.max);
        let track = Rect::from_min_max(
            pos2(area.left(), ruler.top() - TRACK),
            pos2(area.right(), ruler.top()),
        );
        let curve = Rect::from_min_max(
            pos2(area.left(), buttons.bottom() + theme::GAP),
            pos2(area.right(), track.top()),
        );
        transport_buttons::show(ui, buttons, seen, commands);
        // Room at both ends, so that the first and last diamond are whole.
        let line = Timeline::new(
            seen.transport.start_secs,
            seen.transport.end_secs,
            area.left() + theme::GAP,
            area.right() - theme::GAP,
        );
        let ground = Rect::from_min_max(curve.min, track.max);
        ui.painter()
            .rect_filled(ground, style::round(), ink(theme::GROUND));
        scrub(
            ui,
            Rect::from_min_max(curve.min, ruler.max),
            &line,
            seen,
            commands,
        );
        paint_ruler(ui, ruler, ground, &line);
        self.curve.show(ui, curve, &line, seen, commands);
        paint_playhead(ui, ground, &line, seen);
        self.track(ui, track, &line, seen, commands);
    }
}

impl Transport {
    fn track(&mut self, ui: &Ui, area: Rect, line: &Timeline, seen: &Snapshot, commands: &mut Commands<'_>) {
        ui.painter()
            .hline(area.x_range(), area.top(), style::hair(theme::EDGE));
        let middle = area.center().y.round();
        let mut released = None;
        for (index, key) in seen.keys.iter().enumerate() {
            let moved = self.dragged.as_ref().filter(|d| d.key == index).map(|d| d.secs);
            let at = pos2(line.x(moved.unwrap_or(key.secs)), middle);
            let rect = Rect::from_center_size(at, vec2(14.0, area.height()));
            let name = format!("diamond {}", index + 1);
            let response = button::spot(
                ui,
                rect,
                ui.scope_id().with(("diamond", index)),
                Sense::click_and_drag(),
                (Role::Slider, &name),
            );
            let colour = if key.selected {
                theme::SELECTED
            } else {
                theme::TEXT
            };
            let radius = if response.hovered() || response.dragged() {
                7.0
            } else {
                5.5
            };
            paint_diamond(ui.painter(), at, radius, colour);
            if let (true, Some(pointer)) = (response.dragged(), response.interact_pointer_pos()) {
                self.dragged = Some(Dragged {
                    key: index,
                    secs: between_neighbours(seen, index, line.secs(pointer.x)),
                });
            }
            if response.drag_stopped() {
                released = self.dragged.take();
            }
            if response.clicked() {
                commands.push(Command::Transport(TransportCommand::Seek { secs: key.secs }));
            }
            button::focus_ring(ui, &response);
            button::tooltip(
                response,
                "Click to go to this key, drag to give it another time.",
                "Up, Down; Ctrl-Left, Ctrl-Right",
            );
        }
        if let Some(Dragged { key, secs }) = released {
            commands.push(Command::Edit(EditCommand::MoveKey { key, secs }));
        }
    }
}

/// The whole strip is for scrubbing; keys and coefficients lie above it and take the pointer first.
fn scrub(ui: &Ui, area: Rect, line: &Timeline, seen: &Snapshot, commands: &mut Commands<'_>) {
    let id = ui.scope_id().with("scrub");
    let response = button::spot(ui, area, id, Sense::click_and_drag(), (Role::Canvas, "scrub"));
    let pressed = response.dragged() || response.clicked();
    if let (true, Some(at)) = (pressed, response.interact_pointer_pos()) {
        let secs = line.secs(at.x);
        if (secs - seen.transport.secs).abs() > 1e-6 {
            commands.push(Command::Transport(TransportCommand::Seek { secs }));
        }
    }
    if let (Some(at), false) = (response.hover_pos(), response.dragged()) {
        let x = at.x.clamp(line.left, line.right).round();
        ui.painter()
            .vline(x, area.top()..=area.bottom() - RULER, style::hair(theme::EDGE));
    }
    button::focus_ring(ui, &response);
    button::tooltip(
        response,
        "Drag to move through time.",
        "Left, Right; Shift for ten frames",
    );
}

/// The nearest that two keys may come, seconds: half a frame at 24 a second.
const APART_SECS: f64 = 1.0 / 48.0;

/// A key's new time, kept between its neighbours.
pub fn between_neighbours(seen: &Snapshot, key: usize, secs: f64) -> f64 {
    let low = key
        .checked_sub(1)
        .and_then(|k| seen.keys.get(k))
        .map_or(0.0, |k| k.secs + APART_SECS);
    let high = seen
        .keys
        .get(key + 1)
        .map_or(f64::INFINITY, |k| k.secs - APART_SECS);
    secs.min(high).max(low)
}

fn paint_ruler(ui: &Ui, area: Rect, ground: Rect, line: &Timeline) {
    let font = style::digits(theme::SIZE_SMALL);
    let step = line.mark_step_secs(72.0);
    let decimals = if step < 0.1 { 2 } else { usize::from(step < 1.0) };
    for secs in line.marks_secs(72.0) {
        let x = line.x(secs).round();
        ui.painter()
            .vline(x, ground.bottom()..=area.top() + 3.0, style::hair(theme::FAINT));
        ui.painter().vline(
            x,
            ground.y_range(),
            style::hair(theme::PANEL.mix(theme::EDGE, 0.5)),
        );
        let text = format!("{secs:.decimals$}");
        let centre = pos2(x, area.top() + 4.0);
        let half = 4.0 * text.len() as f32;
        let (at, anchor) = if x - half < area.left() {
            (pos2(area.left(), centre.y), Align2::LEFT_TOP)
        } else if x + half > area.right() {
            (pos2(area.right(), centre.y), Align2::RIGHT_TOP)
        } else {
            (centre, Align2::CENTER_TOP)
        };
        ui.painter().text(at, anchor, text, font.clone(), ink(theme::DIM));
    }
}

fn paint_playhead(ui: &Ui, area: Rect, line: &Timeline, seen: &Snapshot) {
    let x = line
        .x(seen.transport.secs)
        .clamp(area.left() + 1.0, area.right() - 1.0)
        .round();
    let head = Rect::from_min_max(pos2(x - 1.0, area.top()), pos2(x + 1.0, area.bottom()));
    ui.painter().rect_filled(head, 0.0, ink(theme::LIVE));
    let corners = vec![
        pos2(x - 5.0, area.top()),
        pos2(x + 5.0, area.top()),
        pos2(x, area.top() + 6.0),
    ];
    ui.painter().add(egui::Shape::convex_polygon(
        corners,
        ink(theme::LIVE),
        egui::Stroke::NONE,
    ));
}
