//! Goal against measured, joint by joint: a bar over the joint's range, a tick where it should be, a dot
//! where it is, and the line between them is the error. A limb's joints share a row with those of the limb
//! across, as the puppet is seen from the front: its right on the left. Dragging a bar poses the joint on screen.
//!
//! A joint that is in trouble, or is asked too much at the present moment, says what of instead of its angle.

use egui::accesskit::Role;
use egui::{Align2, Rect, Sense, Stroke, Ui, pos2, vec2};
use rig::{Command, JointView, PuppetPose, PuppetPoseView, PuppetView, Snapshot};

use super::style::{self, ink};
use super::{Commands, button, joint_words, keys, strain};
use crate::render::puppet::joint_colour;
use crate::render::theme::{self, Rgb};

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

/// What a row is shown with, whatever its joint.
struct Look<'a> {
    seen: &'a Snapshot,
    torque: bool,
    pose: Option<&'a PuppetPoseView>,
}

impl Look<'_> {
    /// The joint's angle on screen, radians, and whether a hand can change it.
    fn posed(&self, joint: &JointView) -> Option<(f64, bool)> {
        let pose = self.pose?;
        let index = pose.names.iter().position(|name| *name == joint.name)?;
        let led = pose.led.get(index).copied().unwrap_or_default();
        Some((*pose.angles_rad.get(index)?, !led))
    }

    /// Whether servos are there at all.
    fn driven(&self) -> bool {
        self.seen.puppet.is_some()
    }
}

/// Shows all joints in `area`; those that do not fit are reached by scrolling.
pub fn show(ui: &mut Ui, area: Rect, puppet: &PuppetView, seen: &Snapshot, commands: &mut Commands<'_>) {
    let look = Look {
        seen,
        torque: puppet.torque,
        pose: seen.puppet_pose.as_ref(),
    };
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
                    show_row(ui, rect, &columns, row, (&look, &mut *commands));
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

fn show_row(
    ui: &Ui,
    rect: Rect,
    columns: &Columns,
    row: &Row<'_>,
    (look, commands): (&Look<'_>, &mut Commands<'_>),
) {
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
    let colours = || {
        cells
            .iter()
            .filter_map(|(_, joint)| loud_colour(joint, look.seen))
    };
    let worst = colours().find(|colour| *colour == theme::FAULTED);
    let colour = match worst.or_else(|| colours().next()) {
        Some(colour) => colour,
        None if cells.iter().all(|(_, joint)| joint.present || !look.driven()) => theme::DIM,
        None => theme::FAINT,
    };
    let text = name.replace('_', " ");
    let text = (text.as_str(), style::words(theme::SIZE_SMALL));
    let at = pos2(rect.left(), rect.center().y.round());
    let width = columns.names - rect.left() - theme::STEP;
    style::line(ui.painter(), at, Align2::LEFT_CENTER, text, colour, width);
    for (cell, joint) in cells {
        show_joint(ui, cell, joint, (look, &mut *commands));
    }
}

/// The colour of a joint that must be noticed.
fn loud_colour(joint: &JointView, seen: &Snapshot) -> Option<Rgb> {
    let strained = || strain::of_joint(seen, &joint.name).map(|_| theme::TOO_MUCH);
    joint_colour(joint).or_else(strained)
}

fn show_joint(ui: &Ui, rect: Rect, joint: &JointView, (look, commands): (&Look<'_>, &mut Commands<'_>)) {
    let middle = rect.center().y.round();
    let bar = Rect::from_min_max(rect.min, pos2(rect.right() - NUMBER, rect.bottom()));
    let posed = look.posed(joint);
    let id = ui.scope_id().with(("joint", &joint.name));
    let (sense, role) = match posed {
        Some((_, true)) => (Sense::drag(), Role::Slider),
        _ => (Sense::hover(), Role::Label),
    };
    let name = format!("joint {}", joint.name);
    let response = button::spot(ui, rect, id, sense, (role, &name));
    if let Some((posed_rad, true)) = posed {
        let scale = Scale::of(bar, joint);
        if response.drag_started() {
            ui.data_mut(|data| data.insert_temp(id, posed_rad));
        }
        let began: Option<f64> = ui.data(|data| data.get_temp(id));
        if let (true, Some(by), Some(began_rad)) = (response.dragged(), response.total_drag_delta(), began) {
            commands.push(Command::PuppetPose(PuppetPose::Joint {
                joint: joint.name.clone(),
                angle_rad: (began_rad + scale.rad(by.x)).clamp(joint.range_rad[0], joint.range_rad[1]),
            }));
        }
    }
    show_bar(ui, bar, joint, look);
    let (number, colour) = number(joint, look);
    let font = style::digits(theme::SIZE_SMALL);
    let at = pos2(rect.right(), middle);
    ui.painter()
        .text(at, Align2::RIGHT_CENTER, number, font, ink(colour));
    response.on_hover_ui(|ui| {
        ui.set_max_width(320.0);
        ui.label(joint_words::told(joint, look.seen));
    });
}

/// What is at the right of a joint's bar: what it has too much of, else where it is.
fn number(joint: &JointView, look: &Look<'_>) -> (String, Rgb) {
    let loud = loud_colour(joint, look.seen);
    if let (Some(colour), Some(text)) = (loud, joint_words::much(joint, look.seen)) {
        return (text, colour);
    }
    let still = loud.unwrap_or(theme::TEXT);
    match (joint.measured_rad, look.posed(joint)) {
        (Some(rad), _) if joint.present && !is_old(joint) => (degrees_text(rad), still),
        (Some(rad), _) if joint.present => (degrees_text(rad), theme::FAINT),
        (_, Some((posed_rad, _))) if !look.driven() => (degrees_text(posed_rad), theme::DIM),
        _ => ("absent".to_owned(), theme::FAINT),
    }
}

/// Whole degrees, and never a negative nothing; the tooltip has the rest.
fn degrees_text(rad: f64) -> String {
    let whole = rad.to_degrees().round();
    format!("{:.0}°", if whole == 0.0 { 0.0 } else { whole })
}

/// Angles along a bar.
struct Scale {
    left: f32,
    width: f32,
    low_rad: f64,
    span_rad: f64,
}

impl Scale {
    fn of(bar: Rect, joint: &JointView) -> Scale {
        let [low_rad, high_rad] = joint.range_rad;
        Scale {
            left: bar.left() + 3.0,
            width: (bar.width() - 6.0).max(1.0),
            low_rad,
            span_rad: (high_rad - low_rad).max(1e-6),
        }
    }

    fn x(&self, rad: f64) -> f32 {
        let share = ((rad - self.low_rad) / self.span_rad).clamp(0.0, 1.0) as f32;
        self.left + self.width * share
    }

    /// A way along the bar as an angle.
    fn rad(&self, points: f32) -> f64 {
        f64::from(points / self.width) * self.span_rad
    }
}

fn show_bar(ui: &Ui, bar: Rect, joint: &JointView, look: &Look<'_>) {
    let painter = ui.painter();
    let middle = bar.center().y.round();
    let scale = Scale::of(bar, joint);
    let [low, high] = joint.range_rad;
    let track = Rect::from_center_size(pos2(bar.center().x, middle), vec2(bar.width(), 2.0));
    painter.rect_filled(track, 1.0, ink(theme::EDGE));
    if low < 0.0 && high > 0.0 {
        let zero = middle - 3.0..=middle + 3.0;
        painter.vline(scale.x(0.0).round(), zero, style::hair(theme::FAINT));
    }
    let measured = joint.measured_rad.filter(|_| joint.present);
    let plain = if look.torque { theme::LIVE } else { theme::DIM };
    let state = loud_colour(joint, look.seen).unwrap_or(plain);
    if let (Some(goal), Some(measured)) = (joint.goal_rad, measured) {
        let error = [pos2(scale.x(goal), middle), pos2(scale.x(measured), middle)];
        painter.line_segment(error, Stroke::new(2.0, ink(state.mix(theme::PANEL, 0.35))));
    }
    if let Some(goal) = joint.goal_rad {
        let tick = middle - 5.0..=middle + 5.0;
        painter.vline(scale.x(goal).round(), tick, Stroke::new(1.5, ink(theme::TEXT)));
    }
    if let Some(measured) = measured {
        let at = pos2(scale.x(measured), middle);
        if is_old(joint) {
            painter.circle(at, 2.5, ink(theme::PANEL), Stroke::new(1.2, ink(theme::DIM)));
        } else {
            painter.circle_filled(at, 3.0, ink(state));
        }
    }
    let by_hand = look.pose.is_some_and(|pose| pose.by_hand);
    if let Some((posed_rad, _)) = look.posed(joint).filter(|_| by_hand || !look.driven()) {
        let colour = if by_hand { theme::SELECTED } else { theme::TEXT };
        keys::paint_diamond(painter, pos2(scale.x(posed_rad), middle), 4.0, colour);
    }
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
    fn a_bar_is_as_long_as_its_range() {
        let joint = JointView {
            range_rad: [-1.0, 3.0],
            ..joint("a")
        };
        let scale = Scale::of(Rect::from_min_size(pos2(10.0, 0.0), vec2(86.0, 10.0)), &joint);
        assert_eq!([scale.x(-1.0), scale.x(3.0), scale.x(9.0)], [13.0, 93.0, 93.0]);
        assert!((scale.rad(20.0) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn nothing_is_never_negative() {
        assert_eq!(degrees_text(-1e-4), "0°");
        assert_eq!(degrees_text(-0.2), "-11°");
    }
}
