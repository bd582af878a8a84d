//! The board of input devices: how each is, what every control says and drives, what can be shown on it.
//!
//! At the left the devices, at the right one of them with all its controls. What a device lacks to be used is said where
//! its controls would be, with what to do about it. Everything else is for the hand on the real control: it is turned,
//! and its cell lights up.

mod calibrate;
mod cell;
mod gauge;
mod head;
mod label;
mod list;
mod outputs;
mod trouble;

use egui::{Align2, Rect, ScrollArea, Ui, UiBuilder, pos2, vec2};
use rig::{DeviceHealth, DeviceView, Snapshot};

use self::label::Editing;
use super::{Commands, Panel, layout, style};
use crate::render::theme;

/// Width of the list of devices, points.
const LIST: f32 = 264.0;
/// Height of what stands above the controls, points.
const HEAD: f32 = 84.0;
/// A control's cell would like to be so wide, points.
const CELL_WIDTH: f32 = 156.0;
/// And is so high.
const CELL_HEIGHT: f32 = 78.0;

/// The board and what it remembers; a restart may lose all of it.
#[derive(Default)]
pub struct Controls {
    editing: Option<Editing>,
    /// What its controls come to is shown, instead of the controls.
    measuring: bool,
}

impl Panel for Controls {
    fn title(&self) -> &'static str {
        "controls"
    }

    fn ui(&mut self, ui: &mut Ui, seen: &Snapshot, commands: &mut Commands<'_>) {
        let area = layout::inside(ui.max_rect());
        let split = area.left() + LIST;
        let left = Rect::from_min_max(area.min, pos2(split, area.bottom()));
        let right = Rect::from_min_max(pos2(split + 2.0 * theme::MARGIN, area.top()), area.max);
        let rest = style::title(ui.painter(), left, self.title());
        let line = split + theme::MARGIN + 0.5;
        let edge = style::hair(theme::EDGE);
        ui.painter().vline(line, ui.max_rect().y_range(), edge);
        let Some(chosen) = chosen(seen, commands) else {
            empty(ui, rest);
            return;
        };
        list::show(ui, rest, &seen.devices, &chosen.name, commands);
        self.device(ui, right, (seen, chosen), commands);
    }
}

/// The device that was chosen, or else the one that is most worth looking at: the first that needs help, or the first.
fn chosen<'a>(seen: &'a Snapshot, commands: &Commands<'_>) -> Option<&'a DeviceView> {
    let named = |name: &String| seen.devices.iter().find(|device| device.name == *name);
    let in_need = || {
        let helpless = |device: &&DeviceView| {
            matches!(
                device.health,
                DeviceHealth::Forbidden { .. } | DeviceHealth::Held { .. }
            )
        };
        seen.devices.iter().find(helpless)
    };
    let asked = commands.choices.device.as_ref().and_then(named);
    asked.or_else(in_need).or(seen.devices.first())
}

fn empty(ui: &Ui, area: Rect) {
    let lines = [
        ("No device.", theme::TEXT),
        ("Plug one in: it is found by itself.", theme::DIM),
        (
            "On a command line, dialrig devices says why one is not.",
            theme::DIM,
        ),
    ];
    for (index, (text, colour)) in lines.into_iter().enumerate() {
        let at = area.left_top() + vec2(0.0, index as f32 * (theme::SIZE_BODY + theme::STEP));
        let text = (text, style::words(theme::SIZE_BODY));
        style::line(ui.painter(), at, Align2::LEFT_TOP, text, colour, area.width());
    }
}

impl Controls {
    fn device(
        &mut self,
        ui: &mut Ui,
        area: Rect,
        (seen, device): (&Snapshot, &DeviceView),
        commands: &mut Commands<'_>,
    ) {
        let head = Rect::from_min_max(area.min, pos2(area.right(), area.top() + HEAD));
        let under_way = seen
            .calibration
            .as_ref()
            .is_some_and(|it| it.device == device.name);
        head::show(
            ui,
            head,
            (seen, device),
            (&mut self.measuring, under_way),
            commands,
        );
        let below = Rect::from_min_max(pos2(area.left(), head.bottom() + theme::GAP), area.max);
        let below = trouble::show(ui, below, device);
        if self.measuring || under_way {
            calibrate::show(ui, below, (seen, device), commands);
            return;
        }
        let builder = UiBuilder::new().max_rect(below).id_salt(&device.name);
        ui.scope_builder(builder, |ui| {
            ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
            ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
                self.cells(ui, device, seen, commands);
                outputs::show(ui, device, commands);
            });
        });
        label::field(ui, &mut self.editing, device, commands);
    }

    fn cells(&mut self, ui: &mut Ui, device: &DeviceView, seen: &Snapshot, commands: &mut Commands<'_>) {
        let width = ui.available_width();
        let count = ((width + theme::GAP) / (CELL_WIDTH + theme::GAP))
            .floor()
            .max(1.0) as usize;
        for row in device.controls.chunks(count) {
            let (_, rect) = ui.allocate_space(vec2(width, CELL_HEIGHT + theme::GAP));
            // A row more than is seen, so that keys alone get there.
            if !ui.is_rect_visible(rect.expand(CELL_HEIGHT)) {
                continue;
            }
            let cells = Rect::from_min_size(rect.min, vec2(width, CELL_HEIGHT));
            for (control, cell) in row.iter().zip(layout::columns(cells, count, theme::GAP)) {
                let learnt = seen
                    .learning
                    .as_ref()
                    .and_then(|learning| learning.control.as_ref())
                    .is_some_and(|(name, number)| *name == device.name && *number == control.number);
                let asked = cell::show(ui, cell, (device, control), learnt);
                commands.queue.extend(asked.command);
                if let Some(place) = asked.label {
                    self.editing = Some(Editing::of(device, control, place));
                }
            }
        }
    }
}
