//! Every form of the language as a table: what is written, what it means, how surely, and an example that runs.
//!
//! The reference in `docs/ps300/language.md` is made from it, and `tests/language_page.rs` reads, prints and
//! executes each example. Source: `docs/protocols/ps300.md`, section "Commands".

mod attributes;
mod conditions;
mod data;
mod faces;
mod network;
mod structure;
mod texts;
mod viewing;

use crate::intrinsic::Confidence;

/// One form.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    /// The word it is known by, whole.
    pub keyword: &'static str,
    /// How it is written. Capitals are the least that must be written of a keyword, `[ ]` may be left out, `/`
    /// separates choices, `…` goes on in the same way, and what is in small letters is filled in. A line each where
    /// there are several.
    pub form: &'static str,
    /// A program of its own that uses it.
    pub example: &'static str,
    /// What it does.
    pub meaning: &'static str,
    /// Where that is known from.
    pub source: &'static str,
    /// How far that can be relied on.
    pub confidence: Confidence,
}

/// Forms about one thing.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// As in the reference.
    pub title: &'static str,
    /// In the order of the reference.
    pub forms: &'static [Form],
}

/// The whole language.
pub const FORMS: &[Section] = &[
    Section {
        title: "Network",
        forms: network::FORMS,
    },
    Section {
        title: "Structure and display",
        forms: structure::FORMS,
    },
    Section {
        title: "Modelling transforms and viewing",
        forms: viewing::FORMS,
    },
    Section {
        title: "Attributes",
        forms: attributes::FORMS,
    },
    Section {
        title: "Conditions",
        forms: conditions::FORMS,
    },
    Section {
        title: "Lines and curves",
        forms: data::FORMS,
    },
    Section {
        title: "Texts",
        forms: texts::FORMS,
    },
    Section {
        title: "Faces and rendering",
        forms: faces::FORMS,
    },
];
