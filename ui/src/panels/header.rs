//! The show's name, whether it is on disk, and the way back.

use egui::{Align2, Rect, Ui, pos2, vec2};
use rig::{Command, Snapshot};

use super::button::{Button, Icon};
use super::{Board, Commands, Panel, layout, style};
use crate::render::theme;

/// Name, the patch panel, undo, redo, save, and the page of keys.
#[derive(Default)]
pub struct Header;

/// Widths of its buttons, points, from the right: help, save, redo, undo, patch.
const WIDTHS: [f32; 5] = [24.0, 44.0, 28.0, 28.0, 48.0];

impl Panel for Header {
    fn title(&self) -> &'static str {
        "show"
    }

    fn ui(&mut self, ui: &mut Ui, seen: &Snapshot, commands: &mut Commands<'_>) {
        let area = layout::inside(ui.max_rect());
        let mut right = area.right();
        let top = area.center().y - theme::ROW / 2.0;
        let cells = WIDTHS.map(|width| {
            right -= width;
            let cell = Rect::from_min_size(pos2(right, top), vec2(width, theme::ROW));
            right -= theme::STEP;
            cell
        });
        let help = Button::new("?", "Shows every key of the keyboard.", "?")
            .named("help")
            .switch(commands.choices.help);
        if help.show(ui, cells[0]).clicked() {
            commands.choices.help = !commands.choices.help;
        }
        let save = Button::new("Save", "Writes the show to its folder.", "Ctrl-S").enabled(seen.unsaved);
        if save.show(ui, cells[1]).clicked() {
            commands.push(Command::Save);
        }
        let redo_tip = tip("Makes again", seen.redo.as_deref());
        let redo = Button::icon(Icon::Redo, "redo", &redo_tip, "Ctrl-Shift-Z").enabled(seen.redo.is_some());
        if redo.show(ui, cells[2]).clicked() {
            commands.push(Command::Redo);
        }
        let undo_tip = tip("Takes back", seen.undo.as_deref());
        let undo = Button::icon(Icon::Undo, "undo", &undo_tip, "Ctrl-Z").enabled(seen.undo.is_some());
        if undo.show(ui, cells[3]).clicked() {
            commands.push(Command::Undo);
        }
        let patch_tip = "The function network as boxes and wires, or the figure again.";
        let patch = Button::new("Patch", patch_tip, "Ctrl-P").switch(commands.choices.board == Board::Patch);
        if patch.show(ui, cells[4]).clicked() {
            commands.choices.board.toggle(Board::Patch);
        }
        let name = if seen.show.is_empty() {
            "untitled"
        } else {
            &seen.show
        };
        let font = style::words(theme::SIZE_TITLE);
        let at = pos2(area.left(), area.center().y);
        let mark = if seen.unsaved { 12.0 } else { 0.0 };
        if seen.unsaved {
            // The dot people know from editors: changed, not yet on disk.
            ui.painter()
                .circle_filled(at + vec2(3.0, 0.0), 3.0, style::ink(theme::DIM));
        }
        let (text, width) = ((name, font), right - at.x - mark);
        style::line(
            ui.painter(),
            at + vec2(mark, 0.0),
            Align2::LEFT_CENTER,
            text,
            theme::TEXT,
            width,
        );
    }
}

fn tip(does: &str, what: Option<&str>) -> String {
    match what {
        Some(what) => format!("{does}: {what}"),
        None => format!("{does} the last change. There is nothing to do."),
    }
}
