//! The clip's keys as a list: number, time, the way to each.

use egui::accesskit::Role;
use egui::{Align2, Rect, ScrollArea, Sense, Ui, pos2, vec2};
use rig::{Command, EditCommand, KeyView, Snapshot, TeachCommand, TransportCommand};

use super::button::{self, Button};
use super::style::ink;
use super::{Commands, Panel, layout, style};
use crate::render::theme;
use crate::render::timeline::clock_text;

/// Keys of the clip.
#[derive(Default)]
pub struct Keys {
    shown: Option<usize>,
}

/// Between keys that are taught one after the other, seconds: they are given their times afterwards.
const TAUGHT_STEP_SECS: f64 = 1.0;
/// Height of a row, points.
const ROW: f32 = 20.0;

impl Panel for Keys {
    fn title(&self) -> &'static str {
        "keys"
    }

    fn ui(&mut self, ui: &mut Ui, seen: &Snapshot, commands: &mut Commands<'_>) {
        let area = layout::inside(ui.max_rect());
        let clip = if seen.clip_name.is_empty() {
            String::new()
        } else {
            format!("{}  ", seen.clip_name)
        };
        let count = format!("{clip}{}", seen.keys.len());
        let corner = area.right_top();
        let text = (count.as_str(), style::words(theme::SIZE_SMALL));
        style::line(
            ui.painter(),
            corner,
            Align2::RIGHT_TOP,
            text,
            theme::DIM,
            area.width() - 48.0,
        );
        let rest = style::title(ui.painter(), area, self.title());
        let (mut list, mut buttons) = (rest, rest);
        buttons.min.y = rest.bottom() - theme::ROW;
        list.max.y = buttons.min.y - theme::GAP;
        self.list(ui, list, seen, commands);
        edit_buttons(ui, buttons, seen, commands);
    }
}

impl Keys {
    fn list(&mut self, ui: &mut Ui, area: Rect, seen: &Snapshot, commands: &mut Commands<'_>) {
        ui.painter().rect_filled(area, style::round(), ink(theme::GROUND));
        if seen.keys.is_empty() {
            let text = ("No key yet: pose, then store", style::words(theme::SIZE_BODY));
            style::line(
                ui.painter(),
                area.center(),
                Align2::CENTER_CENTER,
                text,
                theme::DIM,
                area.width() - 16.0,
            );
            return;
        }
        let selected = seen.keys.iter().position(|key| key.selected);
        let moved = selected != self.shown;
        self.shown = selected;
        ui.scope_builder(egui::UiBuilder::new().max_rect(area), |ui| {
            ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
            ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
                for (index, key) in seen.keys.iter().enumerate() {
                    let size = vec2(ui.available_width(), ROW);
                    let (_, rect) = ui.allocate_space(size);
                    if row(ui, rect, index, key, seen) {
                        commands.push(Command::Transport(TransportCommand::Seek { secs: key.secs }));
                    }
                    if moved && key.selected {
                        ui.scroll_to_rect(rect, None);
                    }
                }
            });
        });
    }
}

fn row(ui: &Ui, rect: Rect, index: usize, key: &KeyView, seen: &Snapshot) -> bool {
    let name = format!("key {}", index + 1);
    let response = button::spot(
        ui,
        rect,
        ui.scope_id().with(("key", index)),
        Sense::click(),
        (Role::ListItem, &name),
    );
    let painter = ui.painter();
    let colour = if key.selected {
        theme::SELECTED
    } else {
        theme::TEXT
    };
    if key.selected {
        painter.rect_filled(rect, 0.0, ink(theme::SELECTED.mix(theme::GROUND, 0.88)));
    } else if response.hovered() {
        painter.rect_filled(rect, 0.0, ink(theme::RAISED));
    }
    let diamond = pos2(rect.left() + 12.0, rect.center().y);
    paint_diamond(painter, diamond, 4.0, colour);
    let middle = rect.center().y;
    let font = style::digits(theme::SIZE_SMALL);
    let number = format!("{}", index + 1);
    painter.text(
        pos2(rect.left() + 24.0, middle),
        Align2::LEFT_CENTER,
        number,
        font.clone(),
        ink(colour),
    );
    let time = format!("{} s", clock_text(key.secs));
    let right = pos2(rect.right() - theme::MARGIN, middle);
    painter.text(right, Align2::RIGHT_CENTER, time, font.clone(), ink(colour));
    if let Some(next) = seen.keys.get(index + 1) {
        let gap = format!("+{}", clock_text(next.secs - key.secs));
        let at = pos2(rect.center().x + 16.0, middle);
        painter.text(at, Align2::RIGHT_CENTER, gap, font, ink(theme::FAINT));
    }
    button::focus_ring(ui, &response);
    button::tooltip(response, "Goes to this key.", "Up, Down").clicked()
}

/// A key's mark.
pub fn paint_diamond(painter: &egui::Painter, at: egui::Pos2, radius: f32, colour: theme::Rgb) {
    let corners = [
        vec2(0.0, -radius),
        vec2(radius, 0.0),
        vec2(0.0, radius),
        vec2(-radius, 0.0),
    ];
    let corners = corners.into_iter().map(|corner| at + corner).collect();
    painter.add(egui::Shape::convex_polygon(
        corners,
        ink(colour),
        egui::Stroke::NONE,
    ));
}

fn edit_buttons(ui: &mut Ui, area: Rect, seen: &Snapshot, commands: &mut Commands<'_>) {
    let cells: Vec<Rect> = layout::columns(area, 3, theme::STEP).collect();
    let posed = can_store(seen);
    let store = Button::new(
        "Store",
        "Stores the pose on screen: in the selected key, else as a new one at the present time.",
        "K",
    );
    if store.enabled(posed).show(ui, cells[0]).clicked() {
        commands.push(store_command(seen));
    }
    let copy_tip = "Copies the key at or before the present time to the present time.";
    let copy = copy_command(seen);
    if Button::new("Copy", copy_tip, "C")
        .enabled(copy.is_some())
        .show(ui, cells[1])
        .clicked()
    {
        commands.queue.extend(copy);
    }
    let delete = delete_command(seen);
    let button = Button::new("Delete", "Deletes the selected key.", "Delete").enabled(delete.is_some());
    if button.show(ui, cells[2]).clicked() {
        commands.queue.extend(delete);
    }
}

/// Whether there is a pose to store: the figure's, or the puppet's own.
pub fn can_store(seen: &Snapshot) -> bool {
    seen.figure.is_some() || seen.puppet_pose.is_some()
}

/// Stores the pose on screen: into the selected key, which is the one at hand, or else at the present time. A
/// second key a few milliseconds beside the first would send the kinetic curve far out of its way.
///
/// While somebody teaches, it is what the servos measure; at the end of the clip time goes on to the next.
pub fn store_command(seen: &Snapshot) -> Command {
    if seen.teaching {
        let adds = seen.transport.secs >= seen.transport.end_secs;
        let step_secs = if adds { TAUGHT_STEP_SECS } else { 0.0 };
        return Command::Teach(TeachCommand::Store { step_secs });
    }
    let selected = seen.keys.iter().find(|key| key.selected);
    Command::Edit(EditCommand::StoreKey {
        secs: selected.map_or(seen.transport.secs, |key| key.secs),
    })
}

/// Copies the key before the present time to it; nothing where a key already is.
pub fn copy_command(seen: &Snapshot) -> Option<Command> {
    let now = seen.transport.secs;
    let key = seen.keys.iter().rposition(|key| key.secs <= now + 1e-6)?;
    let here = (seen.keys[key].secs - now).abs() < 1e-6;
    (!here).then_some(Command::Edit(EditCommand::CopyKey { key, secs: now }))
}

/// Deletes the selected key.
pub fn delete_command(seen: &Snapshot) -> Option<Command> {
    let key = seen.keys.iter().position(|key| key.selected)?;
    Some(Command::Edit(EditCommand::DeleteKey { key }))
}
