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
    let mut pressed = Vec::new();
    let top = area.center().y - theme::ROW / 2.0;
    let mut right = area.right() - theme::GAP;
    let mut cell = |width: f32| {
        right -= width;
        let rect = Rect::from_min_size(pos2(right, top), vec2(width, theme::ROW));
        right -= theme::STEP;
        rect
    };
    let some = look.is_some();
    let (undo, redo) = look.map_or((false, false), |look| (look.can_undo, look.can_redo));
    let mut put = |ui: &mut Ui, button: Button<'_>, width: f32, act: Act| {
        if button.show(ui, cell(width)).clicked() {
            pressed.push(act);
        }
    };
    put(
        ui,
        Button::new("Text", "The network as text, beside the graph.", "T").switch(text_open),
        48.0,
        Act::PatchText,
    );
    put(
        ui,
        Button::new("Lay out", "Puts every box where its wires are short.", "Ctrl-L").enabled(some),
        66.0,
        Act::LayOut,
    );
    put(
        ui,
        Button::new("Frame", "Shows what is selected, or everything.", "F").enabled(some),
        56.0,
        Act::Frame,
    );
    let redo = Button::icon(
        Icon::Redo,
        "patch redo",
        "Makes the network's last edit again.",
        "Ctrl-Shift-Z",
    )
    .enabled(redo);
    put(ui, redo, 28.0, Act::PatchRedo);
    let undo = Button::icon(
        Icon::Undo,
        "patch undo",
        "Takes the network's last edit back.",
        "Ctrl-Z",
    )
    .enabled(undo);
    put(ui, undo, 28.0, Act::PatchUndo);
    put(
        ui,
        Button::new(
            "Add",
            "Looks for a function, a device or a parameter by name.",
            "Tab",
        )
        .enabled(some),
        48.0,
        Act::Add,
    );
    let at = pos2(area.left() + theme::MARGIN, area.center().y);
    let (boxes, wires) = (table.scene.boxes.len(), table.scene.wires.len());
    let says = match (some, table.is_waiting()) {
        (false, _) => String::new(),
        (true, true) => String::from("laying out"),
        (true, false) => format!("{boxes} boxes  {wires} wires"),
    };
    let font = style::words(theme::SIZE_SMALL);
    let drawn = ui.painter().text(
        at,
        Align2::LEFT_CENTER,
        "PATCH",
        font.clone(),
        style::ink(theme::DIM),
    );
    let at = drawn.right_center() + vec2(theme::GAP, 0.0);
    ui.painter().text(
        at,
        Align2::LEFT_CENTER,
        says,
        style::digits(theme::SIZE_SMALL),
        style::ink(theme::FAINT),
    );
    pressed
}
