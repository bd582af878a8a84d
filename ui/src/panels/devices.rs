//! Input devices: which are there, which answer, how much they said.

use egui::{Align2, Rect, ScrollArea, Ui, pos2, vec2};
use rig::{Command, DeviceHealth, DeviceView, Snapshot, Touch};

use super::button::Button;
use super::style::ink;
use super::{Board, Commands, Panel, button, layout, style};
use crate::render::theme;

/// Input devices.
#[derive(Default)]
pub struct Devices;

/// Height of a row, points.
const ROW: f32 = 22.0;
/// Width of the button that pulls a simulated cable, points.
const CABLE: f32 = 56.0;

impl Panel for Devices {
    fn title(&self) -> &'static str {
        "devices"
    }

    fn ui(&mut self, ui: &mut Ui, seen: &Snapshot, commands: &mut Commands<'_>) {
        let area = layout::inside(ui.max_rect());
        let rest = style::title(ui.painter(), area, self.title());
        if seen.devices.is_empty() {
            let text = (
                "No device. Plug one in: it is found by itself",
                style::words(theme::SIZE_BODY),
            );
            style::line(
                ui.painter(),
                rest.left_top(),
                Align2::LEFT_TOP,
                text,
                theme::DIM,
                rest.width(),
            );
            return;
        }
        ui.scope_builder(egui::UiBuilder::new().max_rect(rest), |ui| {
            ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
            ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
                for device in &seen.devices {
                    let (_, rect) = ui.allocate_space(vec2(ui.available_width(), ROW));
                    row(ui, rect, device, commands);
                }
            });
        });
    }
}

fn row(ui: &mut Ui, rect: Rect, device: &DeviceView, commands: &mut Commands<'_>) {
    let middle = rect.center().y;
    let lamp = pos2(rect.left() + 4.0, middle);
    let (word, colour) = match device.health {
        DeviceHealth::Present => ("", theme::TEXT),
        DeviceHealth::Starting => ("starting", theme::DIM),
        DeviceHealth::Lost => ("unplugged", theme::DIM),
        DeviceHealth::Forbidden { .. } => ("not allowed", theme::DIM),
        DeviceHealth::Held { .. } => ("in use", theme::DIM),
    };
    if device.health == DeviceHealth::Present {
        ui.painter().circle_filled(lamp, 3.5, ink(theme::LIVE));
    } else {
        ui.painter()
            .circle_stroke(lamp, 3.0, egui::Stroke::new(1.5, ink(theme::FAINT)));
    }
    let simulated = device.address.starts_with("sim:");
    let mut right = rect.right();
    if simulated {
        right -= CABLE;
        let cable = Rect::from_min_max(
            pos2(right, rect.top() + 1.0),
            pos2(rect.right(), rect.bottom() - 1.0),
        );
        cable_button(ui, cable, device, commands);
        right -= theme::GAP;
    }
    let count = if word.is_empty() {
        let plural = if device.events == 1 { "" } else { "s" };
        format!("{} event{plural}", device.events)
    } else {
        word.to_owned()
    };
    let at = pos2(right, middle);
    let font = style::digits(theme::SIZE_SMALL);
    let counted = ui
        .painter()
        .text(at, Align2::RIGHT_CENTER, count, font, ink(theme::DIM));
    let name_at = pos2(rect.left() + 16.0, middle);
    let text = (device.name.as_str(), style::words(theme::SIZE_BODY));
    let width = counted.left() - name_at.x - theme::GAP;
    style::line(ui.painter(), name_at, Align2::LEFT_CENTER, text, colour, width);
    let left = Rect::from_min_max(rect.min, pos2(right, rect.max.y));
    let id = ui.scope_id().with(("device", &device.name));
    let spoken = format!("controls of {}", device.name);
    let named = (egui::accesskit::Role::Button, spoken.as_str());
    let response = button::spot(ui, left, id, egui::Sense::click(), named);
    button::focus_ring(ui, &response);
    if response.clicked() {
        let shown = commands.choices.device.as_ref() == Some(&device.name);
        commands.choices.device = Some(device.name.clone());
        if commands.choices.board != Board::Controls || shown {
            commands.choices.board.toggle(Board::Controls);
        }
    }
    response.on_hover_ui(|ui| {
        ui.set_max_width(320.0);
        ui.label(format!("{} at {}", device.profile, device.address));
        ui.label(format!(
            "{} events, {} reports rejected",
            device.events, device.rejected
        ));
        ui.label("A click shows its controls, or the figure again.");
    });
}

fn cable_button(ui: &mut Ui, rect: Rect, device: &DeviceView, commands: &mut Commands<'_>) {
    let lost = device.health == DeviceHealth::Lost;
    let (text, tip) = if lost {
        ("Plug", "Puts the cable of this simulated device back in.")
    } else {
        (
            "Unplug",
            "Takes the cable of this simulated device out, as a test.",
        )
    };
    let name = format!("{text} {}", device.name);
    let button = Button::new(text, tip, "Tab, Enter")
        .named(&name)
        .size(theme::SIZE_SMALL);
    if button.show(ui, rect).clicked() {
        let touch = Touch::Cable { connected: lost };
        commands.push(Command::Touch {
            device: device.name.clone(),
            touch,
        });
    }
}
