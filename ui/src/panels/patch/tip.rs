//! Words at the pointer: what a port takes and holds, what a box reported, why a wire does not fit.

use egui::{Area, Context, Id, Order, Pos2, RichText, Ui, vec2};

use super::{boxes, pop};
use crate::panels::style::{self, ink};
use crate::patch::look::Look;
use crate::patch::scene::{Part, Port, Shown};
use crate::patch::token;
use crate::patch::{catalogue, fit};
use crate::render::theme::{self, Rgb};

/// Different reports of a box that are told.
const REPORTS: usize = 4;

fn at_pointer(ctx: &Context, at: Pos2, contents: impl FnOnce(&mut Ui)) {
    let room = ctx.content_rect();
    let pivot = match (at.x > room.right() - 340.0, at.y > room.bottom() - 160.0) {
        (false, false) => egui::Align2::LEFT_TOP,
        (true, false) => egui::Align2::RIGHT_TOP,
        (false, true) => egui::Align2::LEFT_BOTTOM,
        (true, true) => egui::Align2::RIGHT_BOTTOM,
    };
    let off = vec2(
        if at.x > room.right() - 340.0 { -14.0 } else { 16.0 },
        if at.y > room.bottom() - 160.0 { -12.0 } else { 18.0 },
    );
    Area::new(Id::unique("patch tip"))
        .order(Order::Tooltip)
        .fixed_pos(at + off)
        .pivot(pivot)
        .interactable(false)
        .show(ctx, |ui| {
            pop::frame().show(ui, |ui| {
                ui.set_max_width(340.0);
                ui.spacing_mut().item_spacing.y = 3.0;
                contents(ui);
            });
        });
}

fn small(ui: &mut Ui, text: impl Into<String>, colour: Rgb) {
    ui.label(
        RichText::new(text)
            .font(style::words(theme::SIZE_SMALL))
            .color(ink(colour)),
    );
}

fn code(ui: &mut Ui, text: impl Into<String>, colour: Rgb) {
    ui.label(
        RichText::new(text)
            .font(style::digits(theme::SIZE_SMALL))
            .color(ink(colour)),
    );
}

/// An input.
pub(super) fn input(ctx: &Context, at: Pos2, port: &Port, look: &Look) {
    let activity = port.activity.and_then(|index| look.activity.inputs.get(index));
    at_pointer(ctx, at, |ui| {
        code(ui, fit::input_text(port), theme::TEXT);
        let keeps = if port.constant { "; keeps its message" } else { "" };
        small(ui, format!("takes {}{keeps}", port.kinds), theme::DIM);
        if let Some(meaning) = catalogue::meaning(port.of.as_str(), port.input) {
            small(ui, meaning, theme::DIM);
        }
        if let Some(activity) = activity {
            if let Some(value) = &activity.front {
                code(ui, token::long(value), theme::TEXT);
            }
            if activity.waiting > 0 && !port.constant {
                small(ui, format!("{} waiting", activity.waiting), theme::DIM);
            }
        }
        small(ui, "double-click to send a value", theme::FAINT);
    });
}

/// An output.
pub(super) fn output(ctx: &Context, at: Pos2, port: &Port, look: &Look) {
    let activity = port.activity.and_then(|index| look.activity.outputs.get(index));
    at_pointer(ctx, at, |ui| {
        code(ui, fit::output_text(port), theme::TEXT);
        small(ui, format!("sends {}", port.kinds), theme::DIM);
        if let Some(activity) = activity {
            if let Some(value) = &activity.last {
                code(ui, token::long(value), theme::TEXT);
            }
            let held = if activity.frozen {
                format!(", {} held back", activity.withheld)
            } else {
                String::new()
            };
            small(ui, format!("{} sent{held}", activity.sent), theme::DIM);
        }
        small(
            ui,
            "drag to connect    P reads it out    X holds it back",
            theme::FAINT,
        );
    });
}

/// What a box reported.
pub(super) fn reports(ctx: &Context, at: Pos2, shown: &Shown, look: &Look) {
    let names: Vec<&str> = match &shown.part {
        Part::Folded(members) => {
            let boxes = members
                .iter()
                .filter_map(|&member| look.picture.boxes.get(member));
            boxes.map(|seen| seen.name.as_str()).collect()
        }
        Part::Box(_) | Part::Guest => vec![shown.name.as_str()],
    };
    let of_it = |words: &str| names.iter().any(|name| speaks_of(words, name));
    let count = boxes::reports(shown, &look.activity);
    at_pointer(ctx, at, |ui| {
        let times = if count == 1 {
            "once".to_owned()
        } else {
            format!("{count} times")
        };
        small(ui, format!("went wrong {times}"), theme::FAULTED);
        let mut told: Vec<&str> = Vec::new();
        for words in look.remarks.iter().rev().filter(|words| of_it(words)) {
            if !told.contains(&words.as_str()) && told.len() < REPORTS {
                told.push(words);
                small(ui, words.clone(), theme::TEXT);
            }
        }
    });
}

/// Whether a remark is about what bears a name: it stands before the brackets that say what it is.
fn speaks_of(words: &str, name: &str) -> bool {
    let mut found = words.match_indices(name);
    found.any(|(at, _)| {
        let begins = words[..at].chars().next_back().is_none_or(char::is_whitespace);
        begins && words[at + name.len()..].starts_with(" (")
    })
}

/// Why a wire that hangs at the pointer does not fit, or what it would mean.
pub(super) fn wire(ctx: &Context, at: Pos2, fit: &fit::Fit) {
    let (text, colour) = match fit {
        fit::Fit::Whole => return,
        fit::Fit::Partly(why) => (why, theme::DIM),
        fit::Fit::Refused(why) => (why, theme::TEXT),
    };
    at_pointer(ctx, at, |ui| {
        if matches!(fit, fit::Fit::Refused(_)) {
            small(ui, "does not fit", theme::FAULTED);
        }
        small(ui, text.clone(), colour);
    });
}
