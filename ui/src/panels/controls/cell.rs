//! One control: its picture, its value, what it drives, its label.

use std::fmt::Write as _;

use egui::accesskit::Role;
use egui::{Align2, Rect, Sense, Ui, pos2, vec2};
use rig::{Command, ControlView, DeviceView, LearnCommand};

use super::super::button;
use super::super::style::{self, ink};
use super::gauge;
use crate::render::theme;

/// What a hand on a cell wants.
#[derive(Default)]
pub(super) struct Asked {
    pub(super) command: Option<Command>,
    /// To write on the label, which is there.
    pub(super) label: Option<Rect>,
}

/// Width of the picture, points.
const PICTURE: f32 = 40.0;
/// Height of the label, points.
const LABEL: f32 = 18.0;

/// Shows a control; `learnt` says that it is the one being connected.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    (device, control): (&DeviceView, &ControlView),
    learnt: bool,
) -> Asked {
    let painter = ui.painter();
    let edge = match (learnt, control.live) {
        (true, _) => theme::SELECTED,
        (false, true) => theme::LIVE,
        (false, false) => theme::EDGE,
    };
    painter.rect(
        rect,
        style::round(),
        ink(theme::PANEL),
        style::hair(edge),
        egui::StrokeKind::Inside,
    );
    let inner = rect.shrink(theme::STEP + 2.0);
    let picture = Rect::from_min_size(inner.min, vec2(PICTURE, inner.height() - LABEL - theme::STEP));
    gauge::paint(painter, picture.shrink(1.0), control);
    let left = picture.right() + theme::GAP;
    let width = inner.right() - left;
    let row = |index: f32| pos2(left, inner.top() + 7.0 + index * (theme::SIZE_SMALL + 3.0));
    let name = (control.name.as_str(), style::words(theme::SIZE_SMALL));
    style::line(painter, row(0.0), Align2::LEFT_CENTER, name, theme::DIM, width);
    let value = value(control);
    let colour = if control.live { theme::LIVE } else { theme::TEXT };
    let text = (value.as_str(), style::digits(theme::SIZE_SMALL));
    style::line(painter, row(1.0), Align2::LEFT_CENTER, text, colour, width);
    let drives = if control.bound.is_empty() {
        String::new()
    } else {
        format!("\u{2192} {}", control.bound.join(", "))
    };
    let text = (drives.as_str(), style::digits(theme::SIZE_SMALL));
    style::line(painter, row(2.0), Align2::LEFT_CENTER, text, theme::TEXT, width);
    Asked {
        command: touched(ui, rect, (device, control), &drives),
        label: written(ui, inner, (device, control)),
    }
}

/// A click stands for touching the control while something is learnt, and begins to learn otherwise.
fn touched(
    ui: &Ui,
    rect: Rect,
    (device, control): (&DeviceView, &ControlView),
    drives: &str,
) -> Option<Command> {
    let id = ui.scope_id().with(("control", &device.name, control.number));
    let name = format!("{} of {}", control.name, device.name);
    let response = button::spot(ui, rect, id, Sense::click(), (Role::Button, &name));
    button::focus_ring(ui, &response);
    let clicked = response.clicked();
    let mut tip = format!("{}<{}>, in {}.", device.instance, control.number, control.unit);
    if !control.mode.is_empty() {
        let _ = write!(tip, " Mode: {}.", control.mode);
    }
    if drives.is_empty() {
        tip.push_str(" It drives nothing yet: click, then touch a parameter.");
    } else {
        let _ = write!(tip, " {drives}.");
    }
    if !control.picked_up && control.awaits.is_some() {
        tip.push_str(" It takes hold when it comes to the amber mark.");
    }
    button::tooltip(response, &tip, "");
    clicked.then(|| {
        Command::Learn(LearnCommand::Control {
            device: device.name.clone(),
            control: control.number,
        })
    })
}

/// The label's display; its place if it was clicked.
fn written(ui: &Ui, inner: Rect, (device, control): (&DeviceView, &ControlView)) -> Option<Rect> {
    let rect = Rect::from_min_max(pos2(inner.left(), inner.bottom() - LABEL), inner.max);
    let id = ui
        .scope_id()
        .with(("control label", &device.name, control.number));
    let name = format!("label of {} of {}", control.name, device.name);
    let response = button::spot(ui, rect, id, Sense::click(), (Role::Button, &name));
    let fill = if response.hovered() {
        theme::RAISED
    } else {
        theme::GROUND
    };
    let painter = ui.painter();
    painter.rect_filled(rect, style::round(), ink(fill));
    let (text, colour) = if control.label.is_empty() {
        ("label", theme::FAINT)
    } else {
        (control.label.as_str(), theme::TEXT)
    };
    let at = pos2(rect.left() + theme::STEP, rect.center().y);
    let font = style::digits(theme::SIZE_SMALL);
    style::line(
        painter,
        at,
        Align2::LEFT_CENTER,
        (text, font),
        colour,
        rect.width() - theme::GAP,
    );
    button::focus_ring(ui, &response);
    response.clicked().then_some(rect)
}

/// The value with its unit, and where it has to go before it takes hold.
fn value(control: &ControlView) -> String {
    let digits = |value: f64| match control.unit {
        "turns" | "turn" => format!("{value:+.3}"),
        "share" => format!("{:.0} %", value * 100.0),
        _ => format!("{value:.2}"),
    };
    let unit = if control.unit == "share" { "" } else { control.unit };
    if control.kind == "button" {
        return if control.value > 0.5 { "down" } else { "up" }.to_owned();
    }
    match control.awaits.filter(|_| !control.picked_up) {
        Some(awaits) => format!("{} \u{2192} {}", digits(control.value), digits(awaits)),
        None => format!("{} {unit}", digits(control.value)),
    }
}
