//! One dial of the desk: its label display, and a knob that turns for ever.

use egui::accesskit::Role;
use egui::{Align2, Painter, Pos2, Rect, Sense, Stroke, Ui, Vec2, WidgetInfo, pos2, vec2};
use rig::DialView;

use super::button;
use super::style::{self, ink};
use crate::render::theme::{self, Rgb};

/// Height of a label display, points.
pub const DISPLAY: f32 = 20.0;
/// Turns for each point dragged: a hand's width is one turn.
const TURNS_PER_POINT: f64 = 1.0 / 240.0;

/// Shows dial `index`; returns how far a hand turned it, turns, clockwise positive.
pub fn show(ui: &Ui, cell: Rect, index: usize, dial: &DialView, chosen: &mut Option<usize>) -> f64 {
    let display = Rect::from_min_size(cell.min, vec2(cell.width(), DISPLAY));
    let knob_area = Rect::from_min_max(pos2(cell.left(), display.bottom() + theme::STEP), cell.max);
    let radius = (knob_area.height().min(knob_area.width()) / 2.0 - 2.0).floor();
    let centre = knob_area.center().round();
    let response = ui.interact(cell, ui.scope_id().with(("dial", index)), Sense::click_and_drag());
    let name = format!("dial {} {}", index + 1, dial.label.trim());
    response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, name.trim()));
    let is_chosen = *chosen == Some(index);
    show_display(ui.painter(), display, &dial.label, label_colour(dial, is_chosen));
    paint_knob(ui.painter(), centre, radius, dial, response.hovered());
    if is_chosen {
        ui.painter()
            .circle_stroke(centre, radius + 1.0, Stroke::new(1.5, ink(theme::SELECTED)));
    }
    let number = format!("{}", index + 1);
    let at = pos2(cell.left() + 1.0, cell.bottom());
    ui.painter().text(
        at,
        Align2::LEFT_BOTTOM,
        number,
        style::digits(theme::SIZE_SMALL),
        ink(theme::FAINT),
    );
    if response.dragged() || response.clicked() {
        *chosen = Some(index);
    }
    button::focus_ring(ui, &response);
    let mut turned = 0.0;
    if response.dragged() {
        turned += turned_by_drag(response.drag_delta());
    }
    if response.hovered() {
        let scrolled = ui.input_mut(|input| std::mem::take(&mut input.smooth_scroll_delta.y));
        turned += f64::from(scrolled) * TURNS_PER_POINT;
    }
    let tip = format!(
        "Dial {}: drag up or to the right, or scroll. {:+.2} turns so far.",
        index + 1,
        dial.turns
    );
    button::tooltip(
        response,
        &tip,
        &format!("{}, then [ and ]; Shift for more", index + 1),
    );
    turned
}

/// Up and right are clockwise wherever the pointer took hold: a knob of this size is too small to be walked round.
fn turned_by_drag(delta: Vec2) -> f64 {
    f64::from(delta.x - delta.y) * TURNS_PER_POINT
}

fn label_colour(dial: &DialView, chosen: bool) -> Rgb {
    if dial.live {
        theme::LIVE
    } else if chosen {
        theme::SELECTED
    } else {
        theme::TEXT
    }
}

/// A label display: at most eight characters, as on the real box.
pub fn show_display(painter: &Painter, area: Rect, text: &str, colour: Rgb) {
    painter.rect(
        area,
        style::round(),
        ink(theme::GROUND),
        style::hair(theme::EDGE),
        egui::StrokeKind::Inside,
    );
    let line = (text.trim_end(), style::digits(theme::SIZE_SMALL));
    style::line(
        painter,
        area.center(),
        Align2::CENTER_CENTER,
        line,
        colour,
        area.width() - 4.0,
    );
}

fn paint_knob(painter: &Painter, centre: Pos2, radius: f32, dial: &DialView, hovered: bool) {
    let ring = if dial.live { theme::LIVE } else { theme::EDGE };
    let body = if hovered { theme::HOVERED } else { theme::RAISED };
    for tick in 0..24 {
        let out = Vec2::angled(tick as f32 / 24.0 * std::f32::consts::TAU);
        let colour = if tick % 6 == 0 { theme::FAINT } else { theme::EDGE };
        painter.line_segment(
            [centre + out * (radius - 3.0), centre + out * radius],
            style::hair(colour),
        );
    }
    painter.circle(centre, radius - 5.0, ink(body), Stroke::new(1.5, ink(ring)));
    let angle = (dial.turns.rem_euclid(1.0) * std::f64::consts::TAU) as f32 - std::f32::consts::FRAC_PI_2;
    let out = Vec2::angled(angle);
    let pointer = if dial.live { theme::LIVE } else { theme::TEXT };
    let hand = [centre + out * (radius * 0.34), centre + out * (radius - 8.0)];
    painter.line_segment(hand, Stroke::new(2.5, ink(pointer)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_and_right_are_forwards_and_a_round_trip_is_nothing() {
        assert!((turned_by_drag(vec2(0.0, -24.0)) - 0.1).abs() < 1e-9);
        assert!((turned_by_drag(vec2(24.0, 0.0)) - 0.1).abs() < 1e-9);
        let trip = [vec2(7.0, -3.0), vec2(2.0, 11.0), vec2(-9.0, -8.0)];
        assert!(trip.map(turned_by_drag).iter().sum::<f64>().abs() < 1e-9);
    }
}
