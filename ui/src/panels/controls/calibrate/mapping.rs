//! What can be done to a tablet's mapping: measured, turned, mirrored, cut to a proportion, made softer.

use egui::{Rect, Ui, pos2, vec2};
use rig::controls_calibration::PressureCurve;
use rig::{CalibrateControl, Command, DeviceHealth, DeviceView, TabletMapping};

use super::super::super::Commands;
use super::super::super::button::{Button, Tone};
use super::super::super::layout;
use crate::render::theme;

/// Proportions offered, with what they are called; first the area as it is.
const ASPECTS: [(&str, Option<f64>); 5] = [
    ("as it is", None),
    ("1:1", Some(1.0)),
    ("4:3", Some(4.0 / 3.0)),
    ("16:10", Some(1.6)),
    ("16:9", Some(16.0 / 9.0)),
];
/// One step softer or harder.
const SOFTER: f64 = 1.25;
/// Between these exponents.
const SOFTNESS: [f64; 2] = [0.25, 4.0];

/// A picture, and below it two rows of buttons.
pub(super) fn split(area: Rect) -> [Rect; 2] {
    let at = area.bottom() - 2.0 * theme::ROW - theme::STEP;
    [
        Rect::from_min_max(area.min, pos2(area.right(), at - theme::GAP)),
        Rect::from_min_max(pos2(area.left(), at), area.max),
    ]
}

fn rows(area: Rect) -> [Rect; 2] {
    let row = vec2(area.width(), theme::ROW);
    let below = area.min + vec2(0.0, theme::ROW + theme::STEP);
    [
        Rect::from_min_size(area.min, row),
        Rect::from_min_size(below, row),
    ]
}

/// One thing that may be asked: text, tip, whether it is on where it can be, and the command.
type Offer = (String, &'static str, Option<bool>, CalibrateControl);

/// What is offered for the area.
pub(super) fn area(
    ui: &mut Ui,
    area: Rect,
    (device, held): (&DeviceView, &TabletMapping),
    commands: &mut Commands<'_>,
) {
    let [upper, lower] = rows(area);
    let cells = layout::columns(upper, 3, theme::STEP).chain(layout::columns(lower, 3, theme::STEP));
    for (offer, rect) in areas(device, held).into_iter().zip(cells) {
        show(ui, rect, (device, "area"), offer, commands);
    }
}

fn show(
    ui: &mut Ui,
    rect: Rect,
    (device, of): (&DeviceView, &str),
    (text, tip, on, command): Offer,
    commands: &mut Commands<'_>,
) {
    let name = format!("{text}, {of} of {}", device.name);
    let tone = match on {
        None => Tone::Plain,
        Some(true) => Tone::On,
        Some(false) => Tone::Off,
    };
    let button = Button::new(&text, tip, "")
        .named(&name)
        .size(theme::SIZE_SMALL)
        .tone(tone)
        .enabled(device.health == DeviceHealth::Present);
    if button.show(ui, rect).clicked() {
        commands.push(Command::CalibrateControl(command));
    }
}

fn areas(device: &DeviceView, held: &TabletMapping) -> [Offer; 6] {
    let device = || device.name.clone();
    let map = |mapping| CalibrateControl::Tablet {
        device: device(),
        mapping,
    };
    let mirror = |axis: usize, text: &str| {
        let mut mapping = held.clone();
        mapping.mirrored[axis] = !mapping.mirrored[axis];
        let tip = "It runs the other way.";
        (text.to_owned(), tip, Some(held.mirrored[axis]), map(mapping))
    };
    let corners = CalibrateControl::Corners { device: device() };
    let whole = TabletMapping {
        area: None,
        ..held.clone()
    };
    let turned = TabletMapping {
        turned_deg: (held.turned_deg + 90.0).rem_euclid(360.0),
        ..held.clone()
    };
    let here = ASPECTS.iter().position(|(_, aspect)| *aspect == held.aspect);
    let cut = TabletMapping {
        aspect: ASPECTS[(here.unwrap_or(0) + 1) % ASPECTS.len()].1,
        ..held.clone()
    };
    let aspect = match (here, held.aspect) {
        (Some(at), _) => ASPECTS[at].0.to_owned(),
        (None, aspect) => format!("{:.2}", aspect.unwrap_or(1.0)),
    };
    let touch_tip = "Touch two opposite corners of what you will draw on.";
    let turn_tip = "How the tablet lies against the hand, a quarter counter-clockwise at a time.";
    let cut_tip = "Width against height of what is drawn on: the area is cut to it.";
    [
        ("touch corners".to_owned(), touch_tip, None, corners),
        (
            "whole sheet".to_owned(),
            "All of the sheet counts.",
            Some(held.area.is_none()),
            map(whole),
        ),
        (
            format!("turned {:.0}\u{b0}", held.turned_deg),
            turn_tip,
            Some(held.turned_deg != 0.0),
            map(turned),
        ),
        mirror(0, "mirror x"),
        mirror(1, "mirror y"),
        (aspect, cut_tip, Some(held.aspect.is_some()), map(cut)),
    ]
}

/// What is offered for the pressure.
pub(super) fn pressure(
    ui: &mut Ui,
    area: Rect,
    (device, held): (&DeviceView, &TabletMapping),
    commands: &mut Commands<'_>,
) {
    let curve = held.pressure;
    let bent = |gamma: f64| PressureCurve {
        gamma: gamma.clamp(SOFTNESS[0], SOFTNESS[1]),
        ..curve
    };
    let map = |pressure| CalibrateControl::Tablet {
        device: device.name.clone(),
        mapping: TabletMapping {
            pressure,
            ..held.clone()
        },
    };
    let begin = CalibrateControl::Pressure {
        device: device.name.clone(),
    };
    let measured = PressureCurve {
        gamma: curve.gamma,
        ..PressureCurve::default()
    };
    let [upper, lower] = rows(area);
    let offers = [
        (
            "press it",
            "Hover, touch lightly, press hard: three steps.",
            begin,
        ),
        (
            "as it tells",
            "Back to what the tablet itself tells.",
            map(measured),
        ),
        (
            "softer",
            "A light hand comes to less at first.",
            map(bent(curve.gamma * SOFTER)),
        ),
        (
            "harder",
            "A light hand comes to more at first.",
            map(bent(curve.gamma / SOFTER)),
        ),
    ];
    let cells = layout::columns(upper, 2, theme::STEP).chain(layout::columns(lower, 2, theme::STEP));
    for ((text, tip, command), rect) in offers.into_iter().zip(cells) {
        show(
            ui,
            rect,
            (device, "pressure"),
            (text.to_owned(), tip, None, command),
            commands,
        );
    }
}
