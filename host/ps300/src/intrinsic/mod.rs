//! The intrinsic functions: what `name := F:TYPE;` can make.
//!
//! One table row each, with where it is known from and how far it can be trusted; the reference page and
//! `net functions` are generated from the same rows. Start at [`table`] and [`Spec`].
//! Source: `docs/protocols/ps300.md`, "Intrinsic functions"; what the record leaves open is decided there
//! under "What dialrig decides" and marked [`Confidence::Project`] where a whole row is ours.

mod absent;
mod accumulate;
mod arithmetic;
mod clock;
mod compare;
mod components;
mod filter;
mod function;
mod gather;
mod logic;
mod look;
mod matrix;
mod message;
mod modern;
mod numbers;
mod recalled;
mod retype;
mod rotate;
mod route;
mod spec;
mod stopwatch;
mod store;
mod strings;
mod text;
mod timeout;
mod vector;
mod view;

pub use absent::{ABSENT, Absent};
pub(crate) use function::{Errand, Look, Sent};
pub use function::{Fault, Function, Inputs, Now, Outputs, TEXT_MAX_BYTES};
pub(crate) use look::PICK;
pub use message::Message;
pub use spec::{Confidence, InputSpec, OutputSpec, Preset, Spec, Times};
pub(crate) use spec::{Does, Fire, Scalar};
pub(crate) use store::VARIABLE;

/// Functions that belong together, under the heading the reference page gives them.
pub struct Family {
    /// As a heading.
    pub title: &'static str,
    /// In order.
    pub tables: &'static [&'static [Spec]],
}

/// All families, in the order of the reference page.
pub const FAMILIES: &[Family] = &[
    Family {
        title: "Arithmetic and logic",
        tables: &[accumulate::TABLE, arithmetic::TABLE, numbers::TABLE, logic::TABLE],
    },
    Family {
        title: "Comparison",
        tables: &[compare::TABLE],
    },
    Family {
        title: "Selection and routing",
        tables: &[route::TABLE, filter::TABLE, store::TABLE, retype::TABLE],
    },
    Family {
        title: "Vectors, matrices, transforms",
        tables: &[vector::TABLE, rotate::TABLE, matrix::TABLE, view::TABLE],
    },
    Family {
        title: "Strings and text",
        tables: &[text::TABLE, strings::TABLE, gather::TABLE],
    },
    Family {
        title: "Time",
        tables: &[clock::TABLE, timeout::TABLE],
    },
    Family {
        title: "The picture",
        tables: &[look::TABLE],
    },
    Family {
        title: "Functions of today",
        tables: &modern::TABLES,
    },
];

impl Family {
    /// Its functions, in order.
    pub fn functions(&self) -> impl Iterator<Item = &'static Spec> + use<> {
        self.tables.iter().copied().flatten()
    }
}

/// Every function that can be instanced, in the order of the reference page.
pub fn table() -> impl Iterator<Item = &'static Spec> {
    FAMILIES.iter().flat_map(Family::functions)
}

/// The function `name`, in any case.
pub fn find(name: &str) -> Option<&'static Spec> {
    table().find(|spec| spec.name.eq_ignore_ascii_case(name))
}

/// Functions whose names are near `name`, at most three.
pub(crate) fn alike(name: &str) -> Vec<&'static str> {
    let mut near: Vec<_> = table()
        .filter_map(|spec| Some((crate::names::distance(spec.name, name, 2)?, spec.name)))
        .collect();
    near.sort_unstable();
    near.into_iter().take(3).map(|(_, name)| name).collect()
}
