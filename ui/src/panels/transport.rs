//! Time: play, scrub, keys as diamonds, and above them the kinetic curve.

use egui::accesskit::Role;
use egui::{Align2, Rect, Sense, Ui, pos2, vec2};
use rig::{Command, EditCommand, Snapshot, TransportCommand, TransportView};

use super::button;
use super::keys::paint_diamond;
use super::style::{self, ink};
use super::{Commands, Panel, kinetics, layout, strain, transport_buttons};
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
        let [start_secs, end_secs] = shown_secs(&seen.transport);
        let line = Timeline::new(
            start_secs,
            end_secs,
            area.left() + theme::GAP,
            area.right() - theme::GAP,
        );
        let ground = Rect::from_min_max(curve.min, track.max);
        ui.painter()
            .rect_filled(ground, style::round(), ink(theme::GROUND));
        paint_outside(ui, ground, &line, seen);
        scrub(
            ui,
            Rect::from_min_max(curve.min, ruler.max),
            &line,
            seen,
            commands,
        );
        paint_ruler(ui, ruler, ground, &line);
        self.curve.show(ui, curve, &line, seen, commands);
        strain::show(ui, ground, &line, seen);
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
        let secs = snapped(seen, line, at.x);
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
    button::tooltip_at_pointer(
        response,
        "Drag to move through time.",
        "Left, Right; Shift for ten frames",
    );
}

/// Room before the first and after the last key, in shares of the clip, and at least so many seconds: there new
/// keys are set and the outer ones moved to.
const ROOM: f64 = 0.06;
const ROOM_SECS: f64 = 0.25;

/// What the strip shows: the clip with some room, and in any case the present moment.
fn shown_secs(transport: &TransportView) -> [f64; 2] {
    let room_secs = ((transport.end_secs - transport.start_secs) * ROOM).max(ROOM_SECS);
    let first = (transport.start_secs - room_secs).max(0.0);
    let last = transport.end_secs + room_secs;
    [first.min(transport.secs), last.max(transport.secs)]
}

/// The pointer this near to a key means the key, points.
const SNAP: f32 = 5.0;

/// The moment at `x`, or the key that is nearly there.
fn snapped(seen: &Snapshot, line: &Timeline, x: f32) -> f64 {
    let away = |secs: f64| (line.x(secs) - x).abs();
    let keys = seen.keys.iter().map(|key| key.secs);
    let nearest = keys.min_by(|a, b| away(*a).total_cmp(&away(*b)));
    nearest
        .filter(|secs| away(*secs) <= SNAP)
        .unwrap_or_else(|| line.secs(x))
}

/// Time in which the clip does not play.
fn paint_outside(ui: &Ui, area: Rect, line: &Timeline, seen: &Snapshot) {
    if seen.keys.is_empty() {
        return;
    }
    let (first, last) = (line.x(seen.transport.start_secs), line.x(seen.transport.end_secs));
    for outside in [area.left()..=first, last..=area.right()] {
        if outside.end() - outside.start() > theme::GAP {
            let rect = Rect::from_x_y_ranges(outside, area.y_range());
            ui.painter().rect_filled(rect, style::round(), ink(theme::PANEL));
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use rig::KeyView;

    #[test]
    fn the_strip_has_room_and_shows_the_present() {
        let shown = |start_secs, end_secs, secs| {
            shown_secs(&TransportView {
                start_secs,
                end_secs,
                secs,
                ..TransportView::default()
            })
        };
        assert_eq!(shown(0.0, 10.0, 3.0), [0.0, 10.6]);
        assert_eq!(shown(0.0, 10.0, 14.0), [0.0, 14.0], "after the last key");
        assert_eq!(shown(2.0, 3.0, 0.5), [0.5, 3.25], "before the first");
        assert_eq!(shown(0.0, 0.0, 0.0), [0.0, 0.25], "no clip yet");
    }

    #[test]
    fn a_pointer_beside_a_key_means_the_key() {
        let keys = [0.0, 1.0, 1.03].map(|secs| KeyView {
            secs,
            selected: false,
        });
        let seen = Snapshot {
            keys: keys.into(),
            ..Snapshot::default()
        };
        let line = Timeline::new(0.0, 2.0, 0.0, 200.0);
        for (x, want) in [(96.0, 1.0), (104.0, 1.03), (94.0, 0.94), (150.0, 1.5)] {
            assert!((snapped(&seen, &line, x) - want).abs() < 1e-6, "{x}");
        }
    }
}
