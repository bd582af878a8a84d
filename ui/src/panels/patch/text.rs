//! The text beside the graph: the same network, to be read and typed. Ctrl-Enter applies it.

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::text::{CCursor, CCursorRange, LayoutJob, TextFormat};
use egui::{
    Align, Galley, Id, Key, Modifiers, Rect, ScrollArea, Stroke, TextBuffer, TextEdit, Ui, UiBuilder, pos2,
    vec2,
};
use ps300::Diagnostic;
use ps300::language::{Name, Severity};

use crate::panels::button::Button;
use crate::panels::style::{self, ink};
use crate::patch::look::Look;
use crate::patch::source;
use crate::render::theme;

/// Longer texts are checked only when they are applied.
const CHECKED_MAX_BYTES: usize = 60_000;
/// Remarks shown below the text.
const REMARKS: usize = 3;

/// The text and what is known of it.
#[derive(Default)]
pub(super) struct Text {
    pub(super) open: bool,
    draft: String,
    /// The network's own text as last seen.
    known: Option<Arc<str>>,
    /// The draft as it was applied and what was known to be wrong then, until the network answers.
    applied: Option<(String, Arc<[Diagnostic]>)>,
    remarks: Vec<Diagnostic>,
    lines: BTreeMap<Name, u32>,
    painted: Option<(String, Arc<Galley>)>,
    go_to: Option<u32>,
    cursor: Option<usize>,
}

/// What a hand on the text wants.
pub(super) enum Wish {
    /// The text is to be the network.
    Apply(String),
    /// The box of this name is meant.
    Point(Name),
}

impl Text {
    /// Shows the line that defines `name`.
    pub(super) fn point_to(&mut self, name: &Name) {
        self.go_to = self.lines.get(name).copied();
    }

    fn is_changed(&self) -> bool {
        self.known.as_deref().is_some_and(|known| known != self.draft)
    }

    fn see(&mut self, look: &Look) {
        let answer = |(_, before): &(String, Arc<[Diagnostic]>)| !Arc::ptr_eq(before, &look.diagnostics);
        if self.applied.as_ref().is_some_and(answer) && !look.diagnostics.is_empty() {
            // Refused after all: the draft stays, to be put right.
            self.applied = None;
            self.remarks = look.diagnostics.to_vec();
            self.painted = None;
        }
        let same = self.known.as_ref();
        if same.is_some_and(|known| Arc::ptr_eq(known, &look.text) || **known == *look.text) {
            return;
        }
        // A draft that somebody is working on is not taken away by an edit elsewhere.
        let answered = self
            .applied
            .take()
            .is_some_and(|(applied, _)| applied == self.draft);
        if answered || !self.is_changed() {
            self.draft = look.text.to_string();
            self.remarks.clear();
            self.painted = None;
        }
        self.known = Some(look.text.clone());
        self.lines = source::definitions(&self.draft);
    }

    pub(super) fn show(&mut self, ui: &mut Ui, area: Rect, look: &Look) -> Option<Wish> {
        self.see(look);
        let painter = ui.painter().clone();
        painter.rect_filled(area, 0.0, ink(theme::PANEL));
        painter.vline(area.left() + 0.5, area.y_range(), style::hair(theme::EDGE));
        let inside = area.shrink2(vec2(theme::GAP, theme::GAP));
        let mut apply = self.buttons(ui, inside);
        let remarks_height = (self.remarks.len().min(REMARKS)) as f32 * 32.0;
        let field = Rect::from_min_max(
            pos2(inside.left(), inside.top() + theme::ROW + theme::GAP),
            pos2(inside.right(), inside.bottom() - remarks_height),
        );
        let focused = ui.memory(|memory| memory.has_focus(text_id()));
        apply |= focused && ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::Enter));
        let mut wish = None;
        ui.scope_builder(UiBuilder::new().max_rect(field), |ui| {
            ui.painter()
                .rect_filled(field, style::round(), ink(theme::GROUND));
            wish = self.field(ui, look);
        });
        self.remarks(
            ui,
            Rect::from_min_max(pos2(inside.left(), field.bottom() + 4.0), inside.max),
        );
        if apply && self.is_changed() {
            self.remarks = source::check(&self.draft, &look.picture);
            self.painted = None;
            if self
                .remarks
                .iter()
                .all(|remark| remark.severity == Severity::Warning)
            {
                self.applied = Some((self.draft.clone(), look.diagnostics.clone()));
                return Some(Wish::Apply(self.draft.clone()));
            }
        }
        wish
    }

    fn buttons(&mut self, ui: &mut Ui, inside: Rect) -> bool {
        let changed = self.is_changed();
        let top = inside.top();
        let cell =
            |right: f32, width: f32| Rect::from_min_size(pos2(right - width, top), vec2(width, theme::ROW));
        let apply =
            Button::new("Apply", "Makes the network what the text says.", "Ctrl-Enter").enabled(changed);
        let applied = apply.show(ui, cell(inside.right(), 56.0)).clicked();
        let revert = Button::new("Revert", "Shows the network's own text again.", "").enabled(changed);
        if revert.show(ui, cell(inside.right() - 60.0, 60.0)).clicked() {
            self.draft = self.known.as_deref().unwrap_or_default().to_owned();
            self.remarks.clear();
            self.painted = None;
        }
        let said = if changed { "text  changed" } else { "text" };
        let at = Rect::from_min_size(inside.min + vec2(2.0, 6.0), vec2(120.0, 12.0));
        style::title(ui.painter(), at, said);
        applied
    }

    fn field(&mut self, ui: &mut Ui, look: &Look) -> Option<Wish> {
        let before = self.draft.len();
        let remarks = std::mem::take(&mut self.remarks);
        let mut painted = self.painted.take();
        let go_to = self.go_to.take();
        let mut layouter = |ui: &Ui, text: &dyn TextBuffer, _width: f32| -> Arc<Galley> {
            if let Some((known, galley)) = &painted
                && known == text.as_str()
            {
                return galley.clone();
            }
            let galley = ui.fonts_mut(|fonts| fonts.layout_job(coloured(text.as_str(), &remarks)));
            painted = Some((text.as_str().to_owned(), galley.clone()));
            galley
        };
        let output = ScrollArea::both()
            .id_salt("patch text")
            .auto_shrink([false, false])
            .show(ui, |ui| {
                let output = TextEdit::multiline(&mut self.draft)
                    .id(text_id())
                    .font(style::digits(theme::SIZE_SMALL))
                    .code_editor()
                    // A press below the last line is in the text as well.
                    .min_size(ui.available_size())
                    .frame(egui::Frame::NONE)
                    .desired_width(f32::INFINITY)
                    .layouter(&mut layouter)
                    .show(ui);
                if let Some(line) = go_to {
                    let row = output.galley.rows.get(line.saturating_sub(1) as usize);
                    let top = row.map_or(0.0, |row| row.pos.y);
                    let rect = Rect::from_min_size(output.galley_pos + vec2(0.0, top), vec2(80.0, 16.0));
                    ui.scroll_to_rect(rect, Some(Align::Center));
                    ui.painter().rect_filled(
                        Rect::from_min_size(rect.min, vec2(2000.0, 14.0)),
                        0.0,
                        ink(theme::SELECTED).gamma_multiply(0.12),
                    );
                }
                output
            });
        self.painted = painted;
        self.remarks = remarks;
        let output = output.inner;
        let response = &output.response.response;
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::accesskit::Role::MultilineTextInput, true, "network text")
        });
        if response.changed() || self.draft.len() != before {
            self.remarks.clear();
            if self.draft.len() <= CHECKED_MAX_BYTES {
                self.lines = source::definitions(&self.draft);
                self.remarks = source::check(&self.draft, &look.picture);
            }
            self.painted = None;
        }
        let cursor = output.cursor_range.map(|range| range.primary.index.0);
        let moved = cursor != self.cursor && response.has_focus();
        self.cursor = cursor;
        let name = cursor
            .filter(|_| moved)
            .and_then(|at| source::name_at(&self.draft, at));
        name.map(Wish::Point)
    }

    /// What is wrong, below the text; a press goes there.
    fn remarks(&mut self, ui: &mut Ui, area: Rect) {
        let mut top = area.top();
        let mut go_to = None;
        for (index, remark) in self.remarks.iter().take(REMARKS).enumerate() {
            let rect = Rect::from_min_size(pos2(area.left(), top), vec2(area.width(), 30.0));
            top += 32.0;
            let id = ui.scope_id().with(("remark", index));
            let response = ui.interact(rect, id, egui::Sense::click());
            response.widget_info(|| {
                egui::WidgetInfo::labeled(egui::accesskit::Role::ListItem, true, &remark.message)
            });
            let colour = if remark.severity == Severity::Error {
                theme::FAULTED
            } else {
                theme::DIM
            };
            let place = format!("{}:{}", remark.line, remark.column);
            let text = (place.as_str(), style::digits(theme::SIZE_SMALL));
            style::line(ui.painter(), rect.min, egui::Align2::LEFT_TOP, text, colour, 60.0);
            let mut words = remark.to_string();
            if let Some((_, rest)) = words.split_once(": ") {
                words = String::from(rest);
            }
            let mut job = LayoutJob::simple(
                words,
                style::words(theme::SIZE_SMALL),
                ink(theme::TEXT),
                rect.width() - 56.0,
            );
            job.wrap.max_rows = 2;
            let galley = ui.painter().layout_job(job);
            ui.painter()
                .galley(rect.min + vec2(54.0, 0.0), galley, ink(theme::TEXT));
            if response.clicked() {
                go_to = Some((
                    remark.line,
                    source::byte_of(&self.draft, remark.line, remark.column),
                ));
            }
        }
        if let Some((line, byte)) = go_to {
            self.go_to = Some(line);
            let mut state = egui::text_edit::TextEditState::load(ui.ctx(), text_id()).unwrap_or_default();
            let character = self.draft.get(..byte).map_or(0, |head| head.chars().count());
            state
                .cursor
                .set_char_range(Some(CCursorRange::one(CCursor::new(character))));
            state.store(ui.ctx(), text_id());
            ui.memory_mut(|memory| memory.request_focus(text_id()));
        }
    }
}

fn text_id() -> Id {
    Id::unique("patch network text")
}

/// Comments and values step back, words of the language stay firm, what is wrong is underlined.
fn coloured(text: &str, remarks: &[Diagnostic]) -> LayoutJob {
    let font = style::digits(theme::SIZE_SMALL);
    let plain = |colour: theme::Rgb| TextFormat::simple(font.clone(), ink(colour));
    let wrong: Vec<(usize, usize)> = remarks
        .iter()
        .map(|remark| {
            let from = source::byte_of(text, remark.line, remark.column);
            let rest = text.get(from..).unwrap_or_default();
            let word = rest
                .find(|c: char| c.is_whitespace() || c == ';')
                .unwrap_or(rest.len())
                .max(1);
            (from, (from + word).min(text.len()))
        })
        .collect();
    let mut job = LayoutJob::default();
    let mut at = 0;
    while at < text.len() {
        let (length, colour) = piece(&text[at..]);
        let mut format = plain(colour);
        if wrong.iter().any(|&(from, to)| from < at + length && to > at) {
            format.underline = Stroke::new(1.5, ink(theme::FAULTED));
        }
        job.append(&text[at..at + length], 0.0, format);
        at += length;
    }
    job
}

/// The next piece of a text that has one colour: its length in bytes, never 0.
fn piece(text: &str) -> (usize, theme::Rgb) {
    let first = text.chars().next().unwrap_or(' ');
    let run = |more: fn(char) -> bool| text.find(|c| !more(c)).unwrap_or(text.len());
    match first {
        '{' => (text.find('}').map_or(text.len(), |end| end + 1), theme::FAINT),
        '\'' => (
            text[1..].find(['\'', '\n']).map_or(text.len(), |end| end + 2),
            super::colour::of(ps300::Kind::String),
        ),
        c if c.is_ascii_digit() => (
            run(|c| c.is_ascii_alphanumeric() || c == '.'),
            super::colour::of(ps300::Kind::Real),
        ),
        c if c.is_alphabetic() => {
            let length = run(|c| c.is_alphanumeric() || matches!(c, '_' | '$' | '.'));
            let word = &text[..length];
            let command = word.len() > 1 && word.chars().all(|c| c.is_ascii_uppercase() || c == '_');
            (length, if command { theme::DIM } else { theme::TEXT })
        }
        c => (c.len_utf8(), theme::DIM),
    }
}
