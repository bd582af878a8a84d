//! The keys of the patch panel, by the table all keys are in. What is being typed keeps its keys.

use egui::Context;

use crate::panels::shortcuts::{Act, Place, SHORTCUTS};

/// What was asked for since the last picture.
pub(super) fn acts(ctx: &Context) -> Vec<Act> {
    if ctx.text_edit_focused() {
        return Vec::new();
    }
    let rows = SHORTCUTS.iter().filter(|row| row.place == Place::Patch);
    let pressed = rows.filter(|row| ctx.input_mut(|input| input.consume_key(row.modifiers, row.key)));
    pressed.map(|row| row.act).collect()
}
