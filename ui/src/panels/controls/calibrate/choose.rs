//! What of a device can be calibrated: every control with what its counts come to, a tablet with its area and pressure.

use egui::{Align2, Rect, ScrollArea, Ui, UiBuilder, pos2, vec2};
use rig::{CalibrateControl, Command, ControlView, DeviceHealth, DeviceView};

use super::super::super::button::{Button, Tone};
use super::super::super::style::{self, ink};
use super::super::super::{Commands, layout};
use super::super::gauge;
use super::{curve, halves, mapping, mapping_of, sheet};
use crate::render::theme;

/// A control's cell would like to be so wide, points.
const CELL_WIDTH: f32 = 208.0;
/// And is so high.
const CELL_HEIGHT: f32 = 74.0;
/// Least height of a tablet's pictures with what can be done to them, points.
const TABLET: f32 = 300.0;
/// Width of a button, points.
const WIDTH: f32 = 62.0;

/// Shows it.
pub(super) fn show(ui: &mut Ui, area: Rect, device: &DeviceView, commands: &mut Commands<'_>) {
    let builder = UiBuilder::new()
        .max_rect(area)
        .id_salt(("calibrate", &device.name));
    ui.scope_builder(builder, |ui| {
        ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            tablet(ui, device, commands);
            cells(ui, device, commands);
            foot(ui, device, commands);
        });
    });
}

fn tablet(ui: &mut Ui, device: &DeviceView, commands: &mut Commands<'_>) {
    let Some(size) = device.sheet else { return };
    let beside = device.controls.iter().any(|it| !it.comes_to.is_empty());
    let rest = ui.available_height() - theme::ROW - 2.0 * theme::MARGIN;
    let height = if beside { TABLET } else { rest.max(TABLET) };
    let (_, rect) = ui.allocate_space(vec2(ui.available_width(), height + theme::MARGIN));
    let rect = Rect::from_min_size(rect.min, vec2(rect.width(), height));
    let (held, pressure) = mapping_of(device);
    let [left, right] = halves(rect);
    let [left, below] = mapping::split(left);
    sheet::paint(ui.painter(), left, &sheet::Sheet::held(size, &held).bright());
    mapping::area(ui, below, (device, &held), commands);
    let [right, below] = mapping::split(right);
    curve::paint(ui.painter(), right, &curve::Curve::held(pressure).bright());
    mapping::pressure(ui, below, (device, &held), commands);
}

fn cells(ui: &mut Ui, device: &DeviceView, commands: &mut Commands<'_>) {
    let width = ui.available_width();
    let count = ((width + theme::GAP) / (CELL_WIDTH + theme::GAP))
        .floor()
        .max(1.0) as usize;
    let measurable: Vec<&ControlView> = device
        .controls
        .iter()
        .filter(|it| !it.comes_to.is_empty())
        .collect();
    for row in measurable.chunks(count) {
        let (_, rect) = ui.allocate_space(vec2(width, CELL_HEIGHT + theme::GAP));
        // A row more than is seen, so that keys alone get there.
        if !ui.is_rect_visible(rect.expand(CELL_HEIGHT)) {
            continue;
        }
        let rects = Rect::from_min_size(rect.min, vec2(width, CELL_HEIGHT));
        for (control, rect) in row.iter().zip(layout::columns(rects, count, theme::GAP)) {
            cell(ui, rect, (device, control), commands);
        }
    }
    if measurable.is_empty() && device.sheet.is_none() {
        let (_, rect) = ui.allocate_space(vec2(width, theme::ROW));
        let text = ("Nothing of it can be calibrated.", style::words(theme::SIZE_BODY));
        style::line(
            ui.painter(),
            rect.left_center(),
            Align2::LEFT_CENTER,
            text,
            theme::DIM,
            width,
        );
    }
}

fn cell(
    ui: &mut Ui,
    rect: Rect,
    (device, control): (&DeviceView, &ControlView),
    commands: &mut Commands<'_>,
) {
    let painter = ui.painter();
    let edge = if control.live { theme::LIVE } else { theme::EDGE };
    painter.rect(
        rect,
        style::round(),
        ink(theme::PANEL),
        style::hair(edge),
        egui::StrokeKind::Inside,
    );
    let inner = rect.shrink(theme::STEP + 2.0);
    let picture = Rect::from_min_size(inner.min, vec2(34.0, 34.0));
    gauge::paint(painter, picture, control);
    let left = picture.right() + theme::GAP;
    let width = inner.right() - left;
    let (who, colour) = if control.calibrated {
        (format!("{}, measured", control.name), theme::TEXT)
    } else {
        (control.name.clone(), theme::DIM)
    };
    let text = (who.as_str(), style::words(theme::SIZE_SMALL));
    style::line(
        painter,
        pos2(left, inner.top() + 8.0),
        Align2::LEFT_CENTER,
        text,
        colour,
        width,
    );
    let text = (control.comes_to.as_str(), style::digits(theme::SIZE_SMALL));
    style::line(
        painter,
        pos2(left, inner.top() + 24.0),
        Align2::LEFT_CENTER,
        text,
        theme::TEXT,
        width,
    );
    let mut x = inner.left();
    for (text, tip, command) in begins(device, control) {
        let at = Rect::from_min_size(pos2(x, inner.bottom() - 20.0), vec2(WIDTH, 20.0));
        x += WIDTH + theme::STEP;
        let name = format!("{text} of {} of {}", control.name, device.name);
        let back = matches!(command, CalibrateControl::Forget { .. });
        let button = Button::new(text, tip, "")
            .named(&name)
            .size(theme::SIZE_SMALL)
            .tone(if back { Tone::Off } else { Tone::Plain })
            .enabled(back || device.health == DeviceHealth::Present);
        if button.show(ui, at).clicked() {
            commands.push(Command::CalibrateControl(command));
        }
    }
}

/// What can be begun with a control, in words.
fn begins(device: &DeviceView, control: &ControlView) -> Vec<(&'static str, &'static str, CalibrateControl)> {
    let (device, number) = (device.name.clone(), control.number);
    let turn = || CalibrateControl::Dial {
        device: device.clone(),
        control: number,
        turns: 1,
    };
    let ends = || CalibrateControl::Ends {
        device: device.clone(),
        control: number,
    };
    let rest = || CalibrateControl::Rest {
        device: device.clone(),
        control: number,
    };
    let ends_tip = "Measures the counts at both ends: take it from one to the other.";
    let mut all = match control.kind {
        "dial" => vec![(
            "one turn",
            "Measures the counts of one turn: turn it round once.",
            turn(),
        )],
        "axis" => vec![
            ("ends", ends_tip, ends()),
            (
                "rest",
                "Measures where it rests: push it and let go, three times.",
                rest(),
            ),
        ],
        _ => vec![("ends", ends_tip, ends())],
    };
    if control.calibrated {
        let forget = CalibrateControl::Forget {
            device: device.clone(),
            control: Some(number),
        };
        all.push(("back", "Back to what its profile says.", forget));
    }
    all
}

fn foot(ui: &mut Ui, device: &DeviceView, commands: &mut Commands<'_>) {
    let width = ui.available_width();
    let (_, rect) = ui.allocate_space(vec2(width, theme::ROW + theme::GAP));
    let rect = Rect::from_min_size(rect.min, vec2(132.0, theme::ROW));
    let tip = "Forgets everything that was calibrated on this device. No parameter moves.";
    let name = format!("back to the profile of {}", device.name);
    let button = Button::new("Back to the profile", tip, "")
        .named(&name)
        .tone(Tone::Off)
        .enabled(!device.calibration.is_empty());
    if button.show(ui, rect).clicked() {
        commands.push(Command::CalibrateControl(CalibrateControl::Forget {
            device: device.name.clone(),
            control: None,
        }));
    }
}
