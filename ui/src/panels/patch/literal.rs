//! A value typed at an input: the constant there, or one message for an input that consumes.

use egui::{Area, Context, Id, Key, Modifiers, Order, TextEdit, vec2};
use glam::Vec2;

use super::pop;
use super::view::View;
use crate::panels::style::{self, ink};
use crate::patch::edit;
use crate::patch::fit;
use crate::patch::scene::Port;
use crate::render::theme;

/// The field while it is open.
pub(super) struct Literal {
    port: Port,
    at: Vec2,
    typed: String,
    wrong: Option<String>,
    begun: bool,
}

/// What came of one picture of the field.
pub(super) enum Typed {
    /// Still open.
    Open,
    /// Closed without a change.
    Closed,
    /// A command.
    Commands(String),
}

impl Literal {
    /// At a place of the plane, beginning with what the input holds.
    pub(super) fn new(port: &Port, at: Vec2, holds: Option<&ps300::Value>) -> Literal {
        Literal {
            port: port.clone(),
            at,
            typed: holds.map(crate::patch::token::long).unwrap_or_default(),
            wrong: None,
            begun: false,
        }
    }

    pub(super) fn show(&mut self, ctx: &Context, view: &View) -> Typed {
        if ctx.input(|input| input.key_pressed(Key::Escape)) {
            return Typed::Closed;
        }
        if ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter)) {
            match edit::send(&self.typed, &self.port) {
                Ok(text) => return Typed::Commands(text),
                Err(why) => self.wrong = Some(why),
            }
        }
        let corner = view.screen(self.at) + vec2(10.0, -16.0);
        let shown = Area::new(Id::unique("patch literal"))
            .order(Order::Foreground)
            .fixed_pos(corner)
            .show(ctx, |ui| {
                pop::frame().show(ui, |ui| {
                    ui.set_width(220.0);
                    let field = TextEdit::singleline(&mut self.typed)
                        .id(Id::unique("patch literal field"))
                        .font(style::digits(theme::SIZE_BODY))
                        .desired_width(f32::INFINITY);
                    let output = field.show(ui);
                    let response = &output.response.response;
                    response.widget_info(|| {
                        egui::WidgetInfo::labeled(egui::accesskit::Role::TextInput, true, "value")
                    });
                    if !self.begun {
                        // The old value goes with the first letter typed.
                        let mut state = output.state.clone();
                        let all = egui::text::CCursorRange::two(
                            egui::text::CCursor::new(0),
                            egui::text::CCursor::new(self.typed.chars().count()),
                        );
                        state.cursor.set_char_range(Some(all));
                        state.store(ui.ctx(), response.id);
                        response.request_focus();
                    }
                    let said = match &self.wrong {
                        Some(why) => (why.clone(), theme::FAULTED),
                        None => (
                            format!("{}: {}", fit::input_text(&self.port), self.port.kinds),
                            theme::DIM,
                        ),
                    };
                    ui.label(
                        egui::RichText::new(said.0)
                            .font(style::words(theme::SIZE_SMALL))
                            .color(ink(said.1)),
                    );
                });
            });
        let outside = ctx.input(|i| {
            i.pointer.any_pressed()
                && i.pointer
                    .interact_pos()
                    .is_some_and(|p| !shown.response.rect.contains(p))
        });
        if outside && self.begun {
            return Typed::Closed;
        }
        self.begun = true;
        Typed::Open
    }
}
