//! What a device can show: a click has it show something for a moment, so that one sees which is which.

use egui::{Align2, Rect, Ui, pos2, vec2};
use rig::{Command, DeviceHealth, DeviceView, OutputView};

use super::super::button::{Button, Tone};
use super::super::{Commands, layout, style};
use crate::render::theme;

/// Width of an output's button, points.
const WIDTH: f32 = 76.0;

/// Shows the buttons below the controls.
pub(super) fn show(ui: &mut Ui, device: &DeviceView, commands: &mut Commands<'_>) {
    if device.outputs.is_empty() {
        return;
    }
    let width = ui.available_width();
    let (_, head) = ui.allocate_space(vec2(width, theme::SIZE_SMALL + 2.0 * theme::GAP));
    let text = ("TRY WHAT IT SHOWS", style::words(theme::SIZE_SMALL));
    let at = pos2(head.left(), head.bottom() - theme::STEP);
    style::line(ui.painter(), at, Align2::LEFT_BOTTOM, text, theme::DIM, width);
    let count = ((width + theme::STEP) / (WIDTH + theme::STEP)).floor().max(1.0) as usize;
    for row in device.outputs.chunks(count) {
        let (_, rect) = ui.allocate_space(vec2(width, theme::ROW + theme::STEP));
        let cells = Rect::from_min_size(rect.min, vec2(width, theme::ROW));
        for (output, cell) in row.iter().zip(layout::columns(cells, count, theme::STEP)) {
            one(ui, cell, (device, output), commands);
        }
    }
}

fn one(ui: &mut Ui, cell: Rect, (device, output): (&DeviceView, &OutputView), commands: &mut Commands<'_>) {
    let text = format!("{} {}", output.kind, output.of_kind);
    let name = format!("try {text} of {}", device.name);
    let shows = match output.shows.as_str() {
        "" => "It shows nothing.".to_owned(),
        shows => format!("It shows {shows}."),
    };
    let tip = format!("{shows} A click has it show something else for a moment.");
    let lit = !matches!(output.shows.as_str(), "" | "off" | "0");
    let button = Button::new(&text, &tip, "")
        .named(&name)
        .size(theme::SIZE_SMALL)
        .tone(if lit { Tone::On } else { Tone::Off })
        .enabled(device.health == DeviceHealth::Present);
    if button.show(ui, cell).clicked() {
        commands.push(Command::TestOutput {
            device: device.name.clone(),
            output: output.number,
        });
    }
}
