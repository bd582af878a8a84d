//! Writing on a control's label.

use egui::{Id, Key, Modifiers, Rect, TextEdit, Ui};
use rig::{Command, ControlView, DeviceView};

use super::super::{Commands, style};
use crate::render::theme;

/// No label anywhere holds more.
const LETTERS_MAX: usize = 32;

/// A label while it is written.
pub(super) struct Editing {
    device: String,
    control: u8,
    place: Rect,
    typed: String,
    begun: bool,
}

impl Editing {
    /// Of a control whose label is at `place`, beginning with what it says.
    pub(super) fn of(device: &DeviceView, control: &ControlView, place: Rect) -> Self {
        Self {
            device: device.name.clone(),
            control: control.number,
            place,
            typed: control.label.clone(),
            begun: false,
        }
    }
}

/// Shows the field while there is one: Enter writes, Esc and anything outside leave it as it was.
pub(super) fn field(
    ui: &mut Ui,
    editing: &mut Option<Editing>,
    device: &DeviceView,
    commands: &mut Commands<'_>,
) {
    let Some(open) = editing.as_mut().filter(|open| open.device == device.name) else {
        *editing = None;
        return;
    };
    // The Enter that opened it is not the one that writes it.
    let entered = open.begun && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
    let left = ui.input(|input| input.key_pressed(Key::Escape));
    if entered {
        commands.push(Command::SetControlLabel {
            device: open.device.clone(),
            control: open.control,
            text: open.typed.trim().to_owned(),
        });
    }
    if entered || left {
        *editing = None;
        return;
    }
    let field = TextEdit::singleline(&mut open.typed)
        .id(Id::unique("control label field"))
        .font(style::digits(theme::SIZE_SMALL))
        .char_limit(LETTERS_MAX)
        .margin(egui::Margin::symmetric(4, 1));
    let response = ui.put(open.place, field);
    let name = "label, Enter writes it";
    response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::TextInput, true, name));
    if !open.begun {
        open.begun = true;
        response.request_focus();
    } else if response.lost_focus() {
        *editing = None;
    }
}
