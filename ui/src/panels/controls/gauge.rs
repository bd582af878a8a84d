//! Small pictures of where a control is, by its kind. Where it has to be turned to before it takes hold is a tick.

use egui::{Painter, Pos2, Rect, Stroke, pos2, vec2};
use rig::ControlView;

use super::super::style::{self, ink};
use crate::render::theme::{self, Rgb};

/// Paints a control's position into a square.
pub(super) fn paint(painter: &Painter, area: Rect, control: &ControlView) {
    let colour = if control.live { theme::LIVE } else { theme::TEXT };
    match control.kind {
        "button" => key(painter, area, control.value > 0.5, colour),
        "fader" | "strip" => fader(painter, area, control, colour),
        "axis" => axis(painter, area, control, colour),
        "pen" => pen(painter, area, control, colour),
        _ => dial(painter, area, control, colour),
    }
}

/// Where in its range the control is, 0 to 1; of what has none, its turn.
fn share(control: &ControlView, value: f64) -> f32 {
    match control.range {
        Some([least, greatest]) if greatest > least => {
            ((value - least) / (greatest - least)).clamp(0.0, 1.0) as f32
        }
        _ => value.rem_euclid(1.0) as f32,
    }
}

/// A knob. With ends it leaves a gap below, without it goes round; the pointer begins at twelve.
fn dial(painter: &Painter, area: Rect, control: &ControlView, colour: Rgb) {
    const GAP: f32 = 0.125;
    let (centre, radius) = (area.center(), area.width().min(area.height()) / 2.0 - 2.0);
    let angle = |value: f64| {
        let share = share(control, value);
        let turn = match control.range {
            Some(_) => (share - 0.5) * (1.0 - 2.0 * GAP),
            None => share,
        };
        std::f32::consts::TAU * (turn - 0.25)
    };
    painter.circle(
        centre,
        radius,
        ink(theme::RAISED),
        Stroke::new(1.0, ink(theme::FAINT)),
    );
    if let Some(awaits) = control.awaits {
        let out = egui::Vec2::angled(angle(awaits));
        let tick = [centre + out * (radius - 1.0), centre + out * (radius + 4.0)];
        painter.line_segment(tick, Stroke::new(2.0, ink(theme::SELECTED)));
    }
    let out = egui::Vec2::angled(angle(control.value));
    let ink_of = if control.picked_up { colour } else { theme::DIM };
    let hand = [centre + out * (radius * 0.25), centre + out * (radius - 2.0)];
    painter.line_segment(hand, Stroke::new(2.5, ink(ink_of)));
}

/// A track that stands, with a cap.
fn fader(painter: &Painter, area: Rect, control: &ControlView, colour: Rgb) {
    let track = Rect::from_center_size(area.center(), vec2(4.0, area.height() - 4.0));
    painter.rect_filled(track, 2.0, ink(theme::RAISED));
    painter.rect_stroke(track, 2.0, style::hair(theme::FAINT), egui::StrokeKind::Outside);
    let y = |value: f64| track.bottom() - share(control, value) * track.height();
    if let Some(awaits) = control.awaits {
        let at = y(awaits);
        let reach = area.width() / 2.0;
        painter.hline(
            area.center().x - reach..=area.center().x + reach,
            at,
            Stroke::new(2.0, ink(theme::SELECTED)),
        );
    }
    let ink_of = if control.picked_up { colour } else { theme::DIM };
    let cap = Rect::from_center_size(
        pos2(area.center().x, y(control.value)),
        vec2(area.width() * 0.6, 7.0),
    );
    painter.rect_filled(cap, style::round(), ink(ink_of));
}

/// A bar from the middle, for what springs back.
fn axis(painter: &Painter, area: Rect, control: &ControlView, colour: Rgb) {
    let middle = area.center();
    let track = Rect::from_center_size(middle, vec2(area.width() - 4.0, 6.0));
    painter.rect_filled(track, 2.0, ink(theme::RAISED));
    painter.rect_stroke(track, 2.0, style::hair(theme::FAINT), egui::StrokeKind::Outside);
    let x = track.left() + share(control, control.value) * track.width();
    let bar = Rect::from_two_pos(pos2(middle.x, track.top()), pos2(x, track.bottom()));
    painter.rect_filled(bar, 0.0, ink(colour));
    painter.vline(
        middle.x,
        track.top() - 4.0..=track.bottom() + 4.0,
        style::hair(theme::DIM),
    );
}

/// A key, lit while it is down.
fn key(painter: &Painter, area: Rect, down: bool, colour: Rgb) {
    let side = area.width().min(area.height()) * 0.62;
    let rect = Rect::from_center_size(area.center(), vec2(side, side));
    let fill = if down { colour } else { theme::RAISED };
    painter.rect(
        rect,
        style::round(),
        ink(fill),
        style::hair(theme::FAINT),
        egui::StrokeKind::Inside,
    );
}

/// The pen over its surface: a sheet with a mark.
fn pen(painter: &Painter, area: Rect, control: &ControlView, colour: Rgb) {
    let sheet = Rect::from_center_size(area.center(), vec2(area.width(), area.height() * 0.7));
    painter.rect(
        sheet,
        style::round(),
        ink(theme::RAISED),
        style::hair(theme::FAINT),
        egui::StrokeKind::Inside,
    );
    let x = sheet.left() + share(control, control.value) * sheet.width();
    let at = Pos2::new(x.clamp(sheet.left() + 3.0, sheet.right() - 3.0), sheet.center().y);
    painter.circle_filled(at, 3.0, ink(colour));
}
