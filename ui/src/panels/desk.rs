//! The desk as it really is: eight dials and twelve keys, each with its label display. A hand here touches
//! the simulated box, which answers with bytes; a hand on a real box turns what is seen here.

use egui::accesskit::Role;
use egui::{Align2, Rect, Sense, Stroke, Ui, pos2, vec2};
use rig::{Command, DeskKeyView, Snapshot, Touch};

use super::style::{self, ink};
use super::{Commands, Panel, button, dial, layout};
use crate::render::theme;

/// Dials and keys.
#[derive(Default)]
pub struct Desk {
    held: Option<u8>,
}

impl Panel for Desk {
    fn title(&self) -> &'static str {
        "desk"
    }

    fn ui(&mut self, ui: &mut Ui, seen: &Snapshot, commands: &mut Commands<'_>) {
        let area = layout::inside(ui.max_rect());
        // Dials and keys share the width so that both displays hold eight letters.
        let split = area.left() + (area.width() * 0.535).round();
        let dials = Rect::from_min_max(area.min, pos2(split - theme::GAP, area.bottom()));
        let keys = Rect::from_min_max(pos2(split + theme::GAP, area.top()), area.max);
        let device = seen.desk.simulated_device.clone();
        for (index, cell) in layout::columns(dials, 8, theme::STEP).enumerate() {
            let Some(view) = seen.desk.dials.get(index) else {
                break;
            };
            let turns = dial::show(ui, cell, index, view, &mut commands.choices.dial);
            if let (Some(device), true) = (&device, turns != 0.0) {
                let touch = Touch::Dial {
                    control: index as u8,
                    turns,
                };
                commands.push(Command::Touch {
                    device: device.clone(),
                    touch,
                });
            }
        }
        let mut pressed = None;
        for (row, cells) in rows(keys).into_iter().enumerate() {
            for (column, cell) in layout::columns(cells, 6, theme::STEP).enumerate() {
                let index = row * 6 + column;
                let Some(key) = seen.desk.keys.get(index) else {
                    break;
                };
                if show_key(ui, cell, index, key) {
                    pressed = Some(index as u8);
                }
            }
        }
        self.hold(pressed, device, commands);
    }
}

impl Desk {
    /// A key goes down when the pointer presses it and up when it lets go, wherever that is.
    fn hold(&mut self, pressed: Option<u8>, device: Option<String>, commands: &mut Commands<'_>) {
        let Some(device) = device else { return };
        if pressed == self.held {
            return;
        }
        let touches = [self.held.map(|c| (c, false)), pressed.map(|c| (c, true))];
        for (control, down) in touches.into_iter().flatten() {
            let touch = Touch::Button { control, down };
            commands.push(Command::Touch {
                device: device.clone(),
                touch,
            });
        }
        self.held = pressed;
    }
}

fn rows(area: Rect) -> [Rect; 2] {
    let height = ((area.height() - theme::GAP) / 2.0).floor();
    let upper = Rect::from_min_size(area.min, vec2(area.width(), height));
    let lower = Rect::from_min_max(pos2(area.left(), area.bottom() - height), area.max);
    [upper, lower]
}

/// One key with its display; whether the pointer holds it down.
fn show_key(ui: &Ui, cell: Rect, index: usize, key: &DeskKeyView) -> bool {
    let display = Rect::from_min_size(cell.min, vec2(cell.width(), dial::DISPLAY));
    let cap = Rect::from_min_max(pos2(cell.left(), display.bottom() + 2.0), cell.max);
    let name = format!("F{} {}", index + 1, key.label.trim());
    let response = button::spot(
        ui,
        cell,
        ui.scope_id().with(("desk key", index)),
        Sense::click_and_drag(),
        (Role::Button, name.trim()),
    );
    let down = response.is_pointer_button_down_on();
    let painter = ui.painter();
    dial::show_display(
        painter,
        display,
        &key.label,
        if key.down { theme::LIVE } else { theme::TEXT },
    );
    let fill = if key.down || down {
        theme::PRESSED
    } else if response.hovered() {
        theme::HOVERED
    } else {
        theme::RAISED
    };
    let edge = if key.down { theme::LIVE } else { theme::EDGE };
    painter.rect(
        cap,
        style::round(),
        ink(fill),
        style::hair(edge),
        egui::StrokeKind::Inside,
    );
    let text = format!("F{}", index + 1);
    let at = pos2(cap.left() + theme::GAP, cap.center().y);
    let font = style::digits(theme::SIZE_SMALL);
    painter.text(at, Align2::LEFT_CENTER, text, font, ink(theme::DIM));
    let lamp = pos2(cap.right() - 12.0, cap.center().y);
    if key.lit {
        painter.circle_filled(lamp, 4.0, ink(theme::LIVE));
    } else {
        painter.circle_stroke(lamp, 3.5, Stroke::new(1.0, ink(theme::FAINT)));
    }
    button::focus_ring(ui, &response);
    let tip = format!(
        "Key {} of the desk. Its lamp and its label belong to the network.",
        index + 1
    );
    button::tooltip(response, &tip, &format!("F{}", index + 1));
    down
}
