//! Goal against measured, joint by joint: a bar over the joint's range, a tick where it should be, a dot
//! where it is, and the line between them is the error. A limb's joints share a row with those of the limb
//! across, as the puppet is seen from the front: its right on the left.

use egui::{Align2, Rect, Stroke, Ui, pos2, vec2};
use rig::{JointView, PuppetView};

use super::style::{self, ink};
use crate::render::theme;

/// Heights of a row, points: what still reads, and what is wide apart.
const ROW: [f32; 2] = [12.0, 22.0];
/// What reads comfortably, points.
const ROW_WANTED: f32 = 18.0;
/// Height of the row that says which column is which, points.
const HEAD: f32 = 14.0;
/// Width of the number, points: five digits.
const NUMBER: f32 = 36.0;
/// Share of the width that names take.
const NAMES: f32 = 0.29;
/// How names tell the two sides apart.
const SIDES: [[&str; 2]; 2] = [["right_", "left_"], ["r_", "l_"]];
/// An answer older than this says where the joint was, not where it is; twenty cycles of the servo loop.
const OLD_SECS: f64 = 0.2;

/// Whether a joint's place is one that it had, not one that it has.
pub fn is_old(joint: &JointView) -> bool {
    joint.age_secs.is_nan() || joint.age_secs >= OLD_SECS
}

/// A row of the table: a joint, or the same joint of both sides under their common name.
#[derive(Debug)]
enum Row<'a> {
    One(&'a JointView),
    Pair(&'a str, [&'a JointView; 2]),
}

/// Joints as they share rows, in the order of the first of each.
fn rows(joints: &[JointView]) -> Vec<Row<'_>> {
    let twin = |name: &str, mine: usize| {
        SIDES.iter().find_map(|sides| {
            let bare = name.strip_prefix(sides[mine])?;
            let other = format!("{}{bare}", sides[1 - mine]);
            Some((
                name.len() - bare.len(),
                joints.iter().find(|joint| joint.name == other)?,
            ))
        })
    };
    joints
        .iter()
        .filter_map(|joint| match (twin(&joint.name, 0), twin(&joint.name, 1)) {
            (Some((cut, left)), _) => Some(Row::Pair(&joint.name[cut..], [joint, left])),
            (None, Some(_)) => None,
            (None, None) => Some(Row::One(joint)),
        })
        .collect()
}

/// How high the table of these joints would like to be, points.
pub fn height_wanted(joints: &[JointView]) -> f32 {
    let rows = rows(joints);
    rows.len() as f32 * ROW_WANTED + head_height(&rows)
}

fn head_height(rows: &[Row<'_>]) -> f32 {
    let paired = rows.iter().any(|row| matches!(row, Row::Pair(..)));
    if paired { HEAD } else { 0.0 }
}

/// Shows all joints in `area`; those that do not fit are reached by scrolling.
pub fn show(ui: &mut Ui, area: Rect, puppet: &PuppetView) {
    let rows = rows(&puppet.joints);
    if rows.is_empty() {
        return;
    }
    let head = head_height(&rows);
    let columns = Columns::of(area);
    if head > 0.0 {
        for (text, column) in ["right", "left"].into_iter().zip(columns.halves) {
            let text = (text, style::words(theme::SIZE_SMALL));
            let at = pos2(column[0], area.top());
            style::line(ui.painter(), at, Align2::LEFT_TOP, text, theme::FAINT, NUMBER);
        }
    }
    let list = Rect::from_min_max(pos2(area.left(), area.top() + head), area.max);
    let height = (list.height() / rows.len() as f32).clamp(ROW[0], ROW[1]);
    ui.scope_builder(egui::UiBuilder::new().max_rect(list), |ui| {
        ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
        egui::ScrollArea::vertical()
            .auto_shrink([false, false])
            .show(ui, |ui| {
                for row in &rows {
                    let (_, rect) = ui.allocate_space(vec2(ui.available_width(), height));
                    show_row(ui, rect, &columns, row, puppet.torque);
                }
            });
    });
}

/// From left to right: where names end, and where each half begins and ends.
struct Columns {
    names: f32,
    halves: [[f32; 2]; 2],
}

impl Columns {
    fn of(area: Rect) -> Columns {
        let names = area.left() + (area.width() * NAMES).round();
        let half = ((area.right() - names - theme::GAP) / 2.0).floor();
        let second = area.right() - half;
        Columns {
            names,
            halves: [[names, names + half], [second, area.right()]],
        }
    }
}

fn show_row(ui: &Ui, rect: Rect, columns: &Columns, row: &Row<'_>, torque: bool) {
    let cell = |[left, right]: [f32; 2]| Rect::from_x_y_ranges(left..=right, rect.y_range());
    let (name, cells): (&str, Vec<(Rect, &JointView)>) = match row {
        Row::One(joint) => {
            let all = [columns.halves[0][0], columns.halves[1][1]];
            (&joint.name, vec![(cell(all), joint)])
        }
        Row::Pair(name, joints) => {
            let halves = columns.halves.map(cell).into_iter();
            (name, halves.zip(joints.iter().copied()).collect())
        }
    };
    let colour = if cells.iter().any(|(_, joint)| joint.error.is_some()) {
        theme::FAULTED
    } else if cells.iter().all(|(_, joint)| joint.present) {
        theme::DIM
    } else {
        theme::FAINT
    };
    let text = name.replace('_', " ");
    let text = (text.as_str(), style::words(theme::SIZE_SMALL));
    let at = pos2(rect.left(), rect.center().y.round());
    let width = columns.names - rect.left() - theme::STEP;
    style::line(ui.painter(), at, Align2::LEFT_CENTER, text, colour, width);
    for (cell, joint) in cells {
        show_joint(ui, cell, joint, torque);
    }
}

fn show_joint(ui: &Ui, rect: Rect, joint: &JointView, torque: bool) {
    let middle = rect.center().y.round();
    let bar = Rect::from_min_max(rect.min, pos2(rect.right() - NUMBER, rect.bottom()));
    show_bar(ui, bar, joint, torque);
    let (number, colour) = match joint.measured_rad {
        Some(rad) if joint.present && !is_old(joint) => (degrees_text(rad), theme::TEXT),
        Some(rad) if joint.present => (degrees_text(rad), theme::FAINT),
        _ => ("absent".to_owned(), theme::FAINT),
    };
    let at = pos2(rect.right(), middle);
    let font = style::digits(theme::SIZE_SMALL);
    ui.painter()
        .text(at, Align2::RIGHT_CENTER, number, font, ink(colour));
    let id = ui.scope_id().with(("joint", &joint.name));
    let response = ui.interact(rect, id, egui::Sense::hover());
    response.on_hover_ui(|ui| {
        ui.set_max_width(300.0);
        ui.label(told(joint));
    });
}

/// Whole degrees, and never a negative nothing; the tooltip has the rest.
fn degrees_text(rad: f64) -> String {
    let whole = rad.to_degrees().round();
    format!("{:.0}°", if whole == 0.0 { 0.0 } else { whole })
}

fn show_bar(ui: &Ui, bar: Rect, joint: &JointView, torque: bool) {
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
        let zero = middle - 3.0..=middle + 3.0;
        painter.vline(x(0.0).round(), zero, style::hair(theme::FAINT));
    }
    let measured = joint.measured_rad.filter(|_| joint.present);
    let state = if joint.error.is_some() {
        theme::FAULTED
    } else if torque {
        theme::LIVE
    } else {
        theme::DIM
    };
    if let (Some(goal), Some(measured)) = (joint.goal_rad, measured) {
        let error = [pos2(x(goal), middle), pos2(x(measured), middle)];
        painter.line_segment(error, Stroke::new(2.0, ink(state.mix(theme::PANEL, 0.35))));
    }
    if let Some(goal) = joint.goal_rad {
        let tick = middle - 5.0..=middle + 5.0;
        painter.vline(x(goal).round(), tick, Stroke::new(1.5, ink(theme::TEXT)));
    }
    if let Some(measured) = measured {
        let at = pos2(x(measured), middle);
        if is_old(joint) {
            painter.circle(at, 2.5, ink(theme::PANEL), Stroke::new(1.2, ink(theme::DIM)));
        } else {
            painter.circle_filled(at, 3.0, ink(state));
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn joint(name: &str) -> JointView {
        JointView {
            name: name.to_owned(),
            ..JointView::default()
        }
    }

    #[test]
    fn twins_share_a_row_and_nobody_is_lost() {
        let joints: Vec<JointView> = ["neck", "left_knee", "right_knee", "right_hook", "l_a", "r_a"]
            .map(joint)
            .into();
        let told: Vec<String> = rows(&joints)
            .iter()
            .map(|row| match row {
                Row::One(joint) => joint.name.clone(),
                Row::Pair(name, [right, left]) => format!("{name}: {} {}", right.name, left.name),
            })
            .collect();
        assert_eq!(
            told,
            ["neck", "knee: right_knee left_knee", "right_hook", "a: r_a l_a"]
        );
    }

    #[test]
    fn nothing_is_never_negative() {
        assert_eq!(degrees_text(-1e-4), "0°");
        assert_eq!(degrees_text(-0.2), "-11°");
    }
}
