//! The panel's buttons, over the table.

use egui::{Align2, Rect, Ui, pos2, vec2};

use crate::panels::button::{Button, Icon};
use crate::panels::shortcuts::Act;
use crate::panels::style;
use crate::patch::look::Look;
use crate::patch::table::Table;
use crate::render::theme;

/// Height of the bar, points.
pub(super) const HEIGHT: f32 = 40.0;

/// Shows the bar; says what was pressed.
pub(super) fn show(ui: &mut Ui, area: Rect, table: &Table, look: Option<&Look>, text_open: bool) -> Vec<Act> {
    let top = area.center().y - theme::ROW / 2.0;
    let mut right = area.right() - theme::GAP;
    let mut pressed = Vec::new();
    for (button, width, act) in buttons(look, text_open) {
        right -= width;
        let rect = Rect::from_min_size(pos2(right, top), vec2(width, theme::ROW));
        right -= theme::STEP;
        if button.show(ui, rect).clicked() {
            pressed.push(act);
        }
    }
    caption(ui, area, table, look.is_some());
    pressed
}

/// Buttons with their widths, from the right.
fn buttons(look: Option<&Look>, text_open: bool) -> [(Button<'static>, f32, Act); 6] {
    let some = look.is_some();
    let (undo, redo) = look.map_or((false, false), |look| (look.can_undo, look.can_redo));
    let text = Button::new("Text", "The network as text, beside the graph.", "T").switch(text_open);
    let lay_out = Button::new("Lay out", "Puts every box where its wires are short.", "Ctrl-L");
    let frame = Button::new("Frame", "Shows what is selected, or everything.", "F");
    let redo_tip = "Makes the last edit again.";
    let undo_tip = "Takes the last edit back.";
    let add_tip = "Looks for a function, a device or a parameter by name.";
    [
        (text, 48.0, Act::PatchText),
        (lay_out.enabled(some), 66.0, Act::LayOut),
        (frame.enabled(some), 56.0, Act::Frame),
        (
            Button::icon(Icon::Redo, "patch redo", redo_tip, "Ctrl-Shift-Z").enabled(redo),
            28.0,
            Act::PatchRedo,
        ),
        (
            Button::icon(Icon::Undo, "patch undo", undo_tip, "Ctrl-Z").enabled(undo),
            28.0,
            Act::PatchUndo,
        ),
        (Button::new("Add", add_tip, "Tab").enabled(some), 48.0, Act::Add),
    ]
}

fn caption(ui: &Ui, area: Rect, table: &Table, some: bool) {
    let at = pos2(area.left() + theme::MARGIN, area.center().y);
    let (boxes, wires) = (table.scene.boxes.len(), table.scene.wires.len());
    let says = match (some, table.is_waiting()) {
        (false, _) => String::new(),
        (true, true) => String::from("laying out"),
        (true, false) => format!("{boxes} boxes  {wires} wires"),
    };
    let font = style::words(theme::SIZE_SMALL);
    let drawn = ui
        .painter()
        .text(at, Align2::LEFT_CENTER, "PATCH", font, style::ink(theme::DIM));
    let at = drawn.right_center() + vec2(theme::GAP, 0.0);
    let font = style::digits(theme::SIZE_SMALL);
    ui.painter()
        .text(at, Align2::LEFT_CENTER, says, font, style::ink(theme::FAINT));
}
