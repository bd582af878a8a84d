//! Goal against measured, joint by joint: a bar over the joint's range, a tick where it should be, a dot
//! where it is, and the line between them is the error.

use egui::{Align2, Rect, Stroke, Ui, pos2, vec2};
use rig::JointView;

use super::style::{self, ink};
use crate::render::theme;

/// Heights of a row, points: what is read comfortably, and what still reads.
const ROW: [f32; 2] = [11.5, 18.0];
/// Width of the number, points: seven digits.
const NUMBER: f32 = 50.0;

/// Shows all joints in `area`; those that do not fit are reached by scrolling.
pub fn show(ui: &mut Ui, area: Rect, joints: &[JointView]) {
    if joints.is_empty() {
        return;
    }
    let row = (area.height() / joints.len() as f32).clamp(ROW[0], ROW[1]);
    ui.scope_builder(egui::UiBuilder::new().max_rect(area), |ui| {
        ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
        egui::ScrollArea::vertical()
            .auto_shrink([false, false])
            .show(ui, |ui| {
                for joint in joints {
                    let (_, rect) = ui.allocate_space(vec2(ui.available_width(), row));
                    show_joint(ui, rect, joint);
                }
            });
    });
}

fn show_joint(ui: &Ui, rect: Rect, joint: &JointView) {
    let middle = rect.center().y.round();
    let name_width = (rect.width() * 0.43).round();
    let bar = Rect::from_min_max(
        pos2(rect.left() + name_width, rect.top()),
        pos2(rect.right() - NUMBER, rect.bottom()),
    );
    let colour = if joint.error.is_some() {
        theme::FAULTED
    } else if joint.present {
        theme::DIM
    } else {
        theme::FAINT
    };
    let name = (joint.name.as_str(), style::words(theme::SIZE_SMALL));
    let at = pos2(rect.left(), middle);
    style::line(
        ui.painter(),
        at,
        Align2::LEFT_CENTER,
        name,
        colour,
        name_width - theme::GAP,
    );
    show_bar(ui, bar, joint);
    let number = match joint.measured_rad {
        Some(rad) if joint.present => format!("{:.1}°", rad.to_degrees()),
        _ => "absent".to_owned(),
    };
    let at = pos2(rect.right(), middle);
    let font = style::digits(theme::SIZE_SMALL);
    let number_colour = if joint.present { theme::TEXT } else { theme::FAINT };
    ui.painter()
        .text(at, Align2::RIGHT_CENTER, number, font, ink(number_colour));
    let response = ui.interact(
        rect,
        ui.scope_id().with(("joint", &joint.name)),
        egui::Sense::hover(),
    );
    response.on_hover_ui(|ui| {
        ui.set_max_width(300.0);
        ui.label(told(joint));
    });
}

fn show_bar(ui: &Ui, bar: Rect, joint: &JointView) {
    let painter = ui.painter();
    let middle = bar.center().y.round();
    let [low, high] = joint.range_rad;
    let span = (high - low).max(1e-6);
    let x = |rad: f64| {
        let share = ((rad - low) / span).clamp(0.0, 1.0) as f32;
        bar.left() + 3.0 + (bar.width() - 6.0) * share
    };
    let track = Rect::from_center_size(pos2(bar.center().x, middle), vec2(bar.width(), 2.0));
    painter.rect_filled(track, 1.0, ink(theme::EDGE));
    if low < 0.0 && high > 0.0 {
        painter.vline(
            x(0.0).round(),
            middle - 3.0..=middle + 3.0,
            style::hair(theme::FAINT),
        );
    }
    let measured = joint.measured_rad.filter(|_| joint.present);
    let state = if joint.error.is_some() {
        theme::FAULTED
    } else {
        theme::LIVE
    };
    if let (Some(goal), Some(measured)) = (joint.goal_rad, measured) {
        let error = [pos2(x(goal), middle), pos2(x(measured), middle)];
        painter.line_segment(error, Stroke::new(2.0, ink(state.mix(theme::PANEL, 0.35))));
    }
    if let Some(goal) = joint.goal_rad {
        painter.vline(
            x(goal).round(),
            middle - 5.0..=middle + 5.0,
            Stroke::new(1.5, ink(theme::TEXT)),
        );
    }
    if let Some(measured) = measured {
        painter.circle_filled(pos2(x(measured), middle), 3.0, ink(state));
    }
}

/// Everything known about a joint, for its tooltip.
fn told(joint: &JointView) -> String {
    let degrees = |rad: Option<f64>| rad.map_or("none yet".to_owned(), |r| format!("{:.2}°", r.to_degrees()));
    let [low, high] = joint.range_rad.map(f64::to_degrees);
    let mut lines = vec![
        format!(
            "{}: goal {}, measured {}",
            joint.name,
            degrees(joint.goal_rad),
            degrees(joint.measured_rad)
        ),
        format!(
            "range {low:.0}° to {high:.0}°, measured {:.0} ms ago",
            joint.age_secs * 1e3
        ),
    ];
    if let Some(celsius) = joint.temperature_c {
        lines.push(format!("{celsius:.0} °C"));
    }
    if let Some(volts) = joint.voltage_v {
        lines.push(format!("{volts:.1} V"));
    }
    if let Some(error) = &joint.error {
        lines.push(error.clone());
    }
    if !joint.present {
        lines.push("It does not answer: check its cable and its id.".to_owned());
    }
    lines.join("\n")
}
