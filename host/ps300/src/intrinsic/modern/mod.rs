//! Functions the PS 300 did not have: what an animator of today misses, under names that cannot be mistaken
//! for originals.
//!
//! Whatever lasts is measured in network time, which the host gives; nothing here has a clock or chance of
//! its own. Source: `docs/protocols/ps300.md`, "What dialrig decides"; methods by others are named in the rows.

mod curve;
mod discrete;
mod easing;
mod glide;
mod lag;
mod noise_gate;
mod one_euro;
mod oscillator;
mod passing;
mod pickup;
mod random;
mod recorder;
mod shaping;
mod slew;

use super::spec::{InputSpec, OutputSpec, Preset, Spec};
use crate::value::Kinds;

pub(super) const TABLES: [&[Spec]; 14] = [
    shaping::TABLE,
    curve::TABLE,
    easing::TABLE,
    glide::TABLE,
    slew::TABLE,
    lag::TABLE,
    one_euro::TABLE,
    noise_gate::TABLE,
    pickup::TABLE,
    passing::TABLE,
    discrete::TABLE,
    recorder::TABLE,
    oscillator::TABLE,
    random::TABLE,
];

const OURS: &str = "ours";

/// What has a literal, so that it can be remembered in a text.
const WRITTEN: Kinds = Kinds::BOOLEAN
    .or(Kinds::NUMBER)
    .or(Kinds::STRING)
    .or(Kinds::VECTOR)
    .or(Kinds::MATRIX);

const NUMBER: InputSpec = InputSpec::active(Kinds::NUMBER);
const TRIGGER: InputSpec = InputSpec::active(Kinds::ANY);
const REAL_OUT: OutputSpec = OutputSpec::of(Kinds::REAL);
const BOOLEAN_OUT: OutputSpec = OutputSpec::of(Kinds::BOOLEAN);

/// A constant number.
const fn real(preset: f64) -> InputSpec {
    InputSpec::constant(Kinds::NUMBER, Preset::Real(preset))
}

/// A constant Boolean.
const fn truth(preset: bool) -> InputSpec {
    InputSpec::constant(Kinds::BOOLEAN, Preset::Boolean(preset))
}

/// A constant string.
const fn text(preset: &'static str) -> InputSpec {
    InputSpec::constant(Kinds::STRING, Preset::Text(preset))
}

/// A constant number whose absence has a meaning of its own.
const fn number_or(rule: &'static str) -> InputSpec {
    InputSpec::constant(Kinds::NUMBER, Preset::Rule(rule))
}
