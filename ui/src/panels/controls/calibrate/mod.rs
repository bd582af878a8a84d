//! Calibrating a device's controls: what their counts come to now, and step by step what a hand measures.
//!
//! Before: every control with what holds, and a button that begins. Under way: what to do next, a live picture of what
//! was measured against what holds, and the three answers: on, keep, cancel. It must not know how anything is measured.

mod choose;
mod curve;
mod mapping;
mod sheet;
mod steps;
mod travel;
mod turn;

use egui::{Align2, Painter, Rect, Ui, pos2};
use rig::controls_calibration::{Measured, PressureCurve, TabletMapping};
use rig::{CalibrationView, DeviceView, Snapshot};

use super::super::button::Button;
use super::super::{Commands, style};
use crate::render::theme;

/// Height of the steps, what to do and what was wrong, points.
const STEPS: f32 = 84.0;
/// Height of what holds and what would, points.
const WORDS: f32 = 44.0;

/// Shows it in place of the controls.
pub(super) fn show(
    ui: &mut Ui,
    area: Rect,
    (seen, device): (&Snapshot, &DeviceView),
    commands: &mut Commands<'_>,
) {
    match &seen.calibration {
        Some(view) if view.device == device.name => under_way(ui, area, (device, view), commands),
        Some(view) => elsewhere(ui, area, view, commands),
        None => choose::show(ui, area, device, commands),
    }
}

/// One device at a time.
fn elsewhere(ui: &mut Ui, area: Rect, view: &CalibrationView, commands: &mut Commands<'_>) {
    let said = format!("{} of {} is being calibrated.", view.what, view.device);
    let text = (said.as_str(), style::words(theme::SIZE_BODY));
    let at = area.left_top();
    style::line(ui.painter(), at, Align2::LEFT_TOP, text, theme::DIM, area.width());
    let rect = Rect::from_min_size(pos2(at.x, at.y + 26.0), egui::vec2(96.0, theme::ROW));
    let tip = "Shows the device whose calibration has to be kept or cancelled first.";
    if Button::new("Go there", tip, "").show(ui, rect).clicked() {
        commands.choices.device = Some(view.device.clone());
    }
}

fn under_way(
    ui: &mut Ui,
    area: Rect,
    (device, view): (&DeviceView, &CalibrationView),
    commands: &mut Commands<'_>,
) {
    let top = Rect::from_min_max(area.min, pos2(area.right(), area.top() + STEPS));
    let bottom = Rect::from_min_max(pos2(area.left(), area.bottom() - WORDS), area.max);
    let middle = Rect::from_min_max(
        pos2(area.left(), top.bottom() + theme::GAP),
        pos2(area.right(), bottom.top() - theme::GAP),
    );
    steps::show(ui, top, view, commands);
    picture(ui.painter(), middle, (device, view));
    steps::words(ui.painter(), bottom, view);
}

fn picture(painter: &Painter, area: Rect, (device, view): (&DeviceView, &CalibrationView)) {
    let mapping = device.calibration.tablet.clone().unwrap_or_default();
    match &view.measured {
        Measured::Turn { .. } => turn::paint(painter, area, &view.measured),
        Measured::Travel { .. } => travel::paint(painter, area, &view.measured),
        Measured::Area { .. } => {
            let [left, right] = halves(area);
            sheet::paint(painter, left, &sheet::Sheet::measured(&view.measured));
            curve::paint(painter, right, &curve::Curve::held(mapping.pressure));
        }
        Measured::Pressure { .. } => {
            let [left, right] = halves(area);
            if let Some(sheet) = device.sheet {
                sheet::paint(painter, left, &sheet::Sheet::held(sheet, &mapping));
            }
            curve::paint(painter, right, &curve::Curve::measured(&view.measured));
        }
    }
}

/// A tablet has two pictures side by side: the sheet, which is wider, and its pressure.
fn halves(area: Rect) -> [Rect; 2] {
    let split = (area.left() + area.width() * 0.58).round();
    [
        Rect::from_min_max(area.min, pos2(split - theme::GAP, area.bottom())),
        Rect::from_min_max(pos2(split + theme::GAP, area.top()), area.max),
    ]
}

/// What a tablet is mapped by, its own values where nothing was calibrated.
fn mapping_of(device: &DeviceView) -> (TabletMapping, PressureCurve) {
    let mapping = device.calibration.tablet.clone().unwrap_or_default();
    let pressure = mapping.pressure;
    (mapping, pressure)
}
