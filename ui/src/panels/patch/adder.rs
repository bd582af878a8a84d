//! Search-add: a few letters, a list of what fits, Enter puts it where the pointer is and connects it.

use std::collections::BTreeSet;

use egui::{
    Align2, Area, Context, Id, Key, Modifiers, Order, Pos2, Rect, ScrollArea, Sense, TextEdit, Ui, pos2, vec2,
};
use glam::Vec2;
use ps300::language::{Input, Name};

use super::hand::Tie;
use super::{colour, pop};
use crate::panels::style::{self, ink};
use crate::patch::catalogue::{self, Adds, Entry, Want};
use crate::patch::edit;
use crate::patch::look::Look;
use crate::patch::scene::Port;
use crate::patch::search::{self, Query};
use crate::render::theme;

const WIDTH: f32 = 420.0;
const ROW: f32 = 38.0;
/// Rows that are shown without scrolling.
const ROWS: f32 = 8.0;

/// The search while it is open.
pub(super) struct Adder {
    at: Vec2,
    corner: Pos2,
    query: String,
    entries: Vec<Entry>,
    want: Want,
    tie: Tie,
    /// Commands that belong to the same gesture and come first.
    before: String,
    chosen: usize,
    begun: bool,
    hint: Option<String>,
}

/// What came of one picture of the search.
pub(super) enum Found {
    /// Still open.
    Open,
    /// Closed without a choice.
    Closed,
    /// Commands, and the box they make.
    Commands(String, Name),
    /// Something that is there already is laid on the table.
    Guest(Name),
}

impl Adder {
    pub(super) fn new(look: &Look, at: Vec2, corner: Pos2, want: Want, tie: Tie, before: String) -> Adder {
        Adder {
            at,
            corner,
            query: String::new(),
            entries: catalogue::entries(&look.picture),
            want,
            tie,
            before,
            chosen: 0,
            begun: false,
            hint: None,
        }
    }

    /// Where the box goes, on the plane.
    pub(super) fn at(&self) -> Vec2 {
        self.at
    }

    pub(super) fn show(&mut self, ctx: &Context, within: Rect, look: &Look) -> Found {
        let query = Query::read(&self.query);
        let found = search::find(&self.entries, &query, self.want);
        let mut choice = self.keys(ctx, found.len());
        if matches!(choice, Choice::Close) {
            return Found::Closed;
        }
        let height = 84.0 + ROW * ROWS.min(found.len().max(1) as f32);
        let corner = pos2(
            self.corner
                .x
                .clamp(within.left(), (within.right() - WIDTH - 8.0).max(within.left())),
            self.corner
                .y
                .clamp(within.top(), (within.bottom() - height).max(within.top())),
        );
        let shown = Area::new(Id::unique("patch adder"))
            .order(Order::Foreground)
            .fixed_pos(corner)
            .show(ctx, |ui| {
                pop::frame().show(ui, |ui| {
                    ui.set_width(WIDTH);
                    self.field(ui, &query, &found);
                    self.list(ui, &found, &mut choice);
                });
            });
        let outside = ctx.input(|i| {
            i.pointer.any_pressed()
                && i.pointer
                    .interact_pos()
                    .is_some_and(|p| !shown.response.rect.contains(p))
        });
        if outside && self.begun {
            return Found::Closed;
        }
        self.begun = true;
        match choice {
            Choice::Take => found
                .get(self.chosen)
                .map_or(Found::Open, |&index| self.take(index, &query, look)),
            _ => Found::Open,
        }
    }

    fn keys(&mut self, ctx: &Context, count: usize) -> Choice {
        let pressed = |key| ctx.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        if pressed(Key::ArrowDown) {
            self.chosen = (self.chosen + 1).min(count.saturating_sub(1));
        }
        if pressed(Key::ArrowUp) {
            self.chosen = self.chosen.saturating_sub(1);
        }
        if pressed(Key::Enter) {
            return Choice::Take;
        }
        // Esc stops the puppet as everywhere, and closes.
        if ctx.input(|input| input.key_pressed(Key::Escape)) || self.begun && pressed(Key::Tab) {
            return Choice::Close;
        }
        Choice::None
    }

    fn field(&mut self, ui: &mut Ui, query: &Query, found: &[usize]) {
        let hint = match self.want {
            Want::Any => String::from("function, device or parameter"),
            Want::Takes(kinds) => format!("what takes {kinds}"),
            Want::Sends(kinds) => format!("what sends {kinds}"),
        };
        let before = self.query.clone();
        let field = TextEdit::singleline(&mut self.query)
            .id(Id::unique("patch search"))
            .font(style::digits(theme::SIZE_TITLE))
            .hint_text(hint)
            .desired_width(f32::INFINITY)
            .margin(vec2(8.0, 6.0));
        let response = ui.add(field);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::TextInput, true, "search"));
        response.request_focus();
        if before != self.query {
            self.chosen = 0;
            self.hint = None;
        }
        let sized = found
            .get(self.chosen)
            .and_then(|&index| Some((&self.entries[index], self.entries[index].sizes()?)));
        let line = self.hint.clone().unwrap_or_else(|| match sized {
            Some((entry, (least, most))) if query.size.is_none() => {
                format!(
                    "{} has a size, {least} to {most}: type it after the name",
                    entry.title
                )
            }
            _ => String::from("name:function size     Enter adds, up and down choose"),
        });
        let colour = if self.hint.is_some() {
            theme::TEXT
        } else {
            theme::FAINT
        };
        ui.label(
            egui::RichText::new(line)
                .font(style::words(theme::SIZE_SMALL))
                .color(ink(colour)),
        );
    }

    fn list(&mut self, ui: &mut Ui, found: &[usize], choice: &mut Choice) {
        ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
        if found.is_empty() {
            ui.label(egui::RichText::new("Nothing fits").color(ink(theme::DIM)));
            return;
        }
        ScrollArea::vertical().max_height(ROW * ROWS).show(ui, |ui| {
            for (row, &index) in found.iter().enumerate() {
                let (_, rect) = ui.allocate_space(vec2(WIDTH, ROW));
                let id = ui.scope_id().with(("entry", row));
                let response = ui.interact(rect, id, Sense::click());
                let entry = &self.entries[index];
                response.widget_info(|| {
                    egui::WidgetInfo::labeled(egui::accesskit::Role::ListItem, true, &entry.title)
                });
                if ui.is_rect_visible(rect) {
                    paint_row(ui, rect, entry, row == self.chosen, response.hovered());
                }
                if row == self.chosen
                    && !response.hovered()
                    && ui.input(|i| i.key_pressed(Key::ArrowDown) || i.key_pressed(Key::ArrowUp))
                {
                    ui.scroll_to_rect(rect, None);
                }
                if response.clicked() {
                    self.chosen = row;
                    *choice = Choice::Take;
                }
            }
        });
    }

    fn take(&mut self, index: usize, query: &Query, look: &Look) -> Found {
        let entry = self.entries[index].clone();
        let Some(port) = self.want.port(&entry) else {
            return Found::Open;
        };
        if let Adds::Guest(name) = &entry.adds {
            let Some(other) = look.picture.unwired.iter().find(|other| other.name == *name) else {
                return Found::Closed;
            };
            let ends = match &self.tie {
                Tie::None => return Found::Guest(name.clone()),
                Tie::From(_) => other.inputs.get(port),
                Tie::To(_) => other.outputs.get(port),
            };
            let input = ends.map_or(Input::Number(1), |port| port.input);
            return Found::Commands(self.tied(name, input), name.clone());
        }
        let name = match &query.name {
            Some(name) if !Name::is_valid(name) => return self.refuse(format!("{name:?} is no name")),
            Some(name) => Name::new(name),
            None => edit::fresh_name(&entry.title, look, &BTreeSet::new()),
        };
        let made = match entry.adds {
            Adds::Function(spec) => match (entry.sizes(), query.size) {
                (Some((least, most)), None) => {
                    self.query = format!("{} ", self.query.trim());
                    return self.refuse(format!("{} wants a size, {least} to {most}", entry.title));
                }
                (Some((least, most)), Some(size))
                    if !(u16::from(least)..=u16::from(most)).contains(&size) =>
                {
                    return self.refuse(format!("{} has sizes {least} to {most}", entry.title));
                }
                (sizes, size) => edit::create(spec, &name, size.filter(|_| sizes.is_some())),
            },
            _ => edit::variable(&name),
        };
        let text = made + &self.tied(&name, Input::Number(port as u16 + 1));
        Found::Commands(text, name)
    }

    fn refuse(&mut self, why: String) -> Found {
        self.hint = Some(why);
        Found::Open
    }

    /// The wire that was let go over nothing, now with an end.
    fn tied(&self, name: &Name, input: Input) -> String {
        let end = |like: &Port| Port {
            of: name.clone(),
            input,
            ..like.clone()
        };
        let wire = match &self.tie {
            Tie::None => String::new(),
            Tie::From(output) => edit::connect(output, &end(output)),
            Tie::To(input) => edit::connect(&end(input), input),
        };
        format!("{}{wire}", self.before)
    }
}

enum Choice {
    None,
    Take,
    Close,
}

fn paint_row(ui: &Ui, rect: Rect, entry: &Entry, chosen: bool, hovered: bool) {
    let painter = ui.painter();
    if chosen {
        painter.rect_filled(rect, style::round(), ink(theme::PRESSED));
    } else if hovered {
        painter.rect_filled(rect, style::round(), ink(theme::HOVERED));
    }
    let left = rect.left() + 8.0;
    let title = match entry.sizes() {
        Some(_) => format!("{} (n)", entry.title),
        None => entry.title.clone(),
    };
    let text = (title.as_str(), style::digits(theme::SIZE_BODY));
    style::line(
        painter,
        pos2(left, rect.top() + 11.0),
        Align2::LEFT_CENTER,
        text,
        theme::TEXT,
        250.0,
    );
    let mut x = rect.right() - 10.0;
    let dots = |kinds: &[ps300::Kinds]| {
        kinds
            .iter()
            .take(8)
            .map(|&k| colour::of_port(k))
            .rev()
            .collect::<Vec<_>>()
    };
    for colour in dots(&entry.outputs) {
        painter.circle_filled(pos2(x, rect.top() + 11.0), 3.5, ink(colour));
        x -= 9.0;
    }
    let (tip, tail) = (pos2(x + 2.0, rect.top() + 11.0), pos2(x - 5.0, rect.top() + 11.0));
    painter.line_segment([tail, tip], style::hair(theme::FAINT));
    painter.line(
        vec![tip + vec2(-3.0, -3.0), tip, tip + vec2(-3.0, 3.0)],
        style::hair(theme::FAINT),
    );
    x -= 13.0;
    for colour in dots(&entry.inputs) {
        painter.circle_filled(pos2(x, rect.top() + 11.0), 3.5, ink(colour));
        x -= 9.0;
    }
    let says = (entry.behaviour.as_str(), style::words(theme::SIZE_SMALL));
    style::line(
        painter,
        pos2(left, rect.top() + 27.0),
        Align2::LEFT_CENTER,
        says,
        theme::DIM,
        rect.width() - 16.0,
    );
}
