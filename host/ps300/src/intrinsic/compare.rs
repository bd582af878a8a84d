//! Comparisons. Trailing C: input 2 is constant; leading C: input 1.

use super::function::{Fault, Inputs, Outputs};
use super::spec::{Confidence, Does, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kinds, Value};

const ANY_BOTH: &[InputSpec] = &[InputSpec::active(Kinds::ANY), InputSpec::active(Kinds::ANY)];
const ANY_SECOND: &[InputSpec] = &[
    InputSpec::active(Kinds::ANY),
    InputSpec::constant(Kinds::ANY, Preset::Required),
];
const BOTH: &[InputSpec] = &[InputSpec::active(Kinds::NUMBER), InputSpec::active(Kinds::NUMBER)];
const SECOND: &[InputSpec] = &[
    InputSpec::active(Kinds::NUMBER),
    InputSpec::constant(Kinds::NUMBER, Preset::Required),
];
const FIRST: &[InputSpec] = &[
    InputSpec::constant(Kinds::NUMBER, Preset::Required),
    InputSpec::active(Kinds::NUMBER),
];

macro_rules! row {
    ($name:literal, $inputs:expr, $does:expr, $behaviour:literal, $confidence:ident) => {
        Spec {
            name: $name,
            sizes: None,
            inputs: $inputs,
            outputs: &[OutputSpec::of(Kinds::BOOLEAN)],
            does: Does::Pure($does),
            behaviour: $behaviour,
            source: "recollected",
            confidence: Confidence::$confidence,
        }
    };
}

pub(super) const TABLE: &[Spec] = &[
    row!(
        "EQ",
        ANY_BOTH,
        |i, o| equal(i, o, true),
        "Whether <1> equals <2>; numbers, or any two of one kind.",
        High
    ),
    row!(
        "EQC",
        ANY_SECOND,
        |i, o| equal(i, o, true),
        "As EQ, <2> constant.",
        High
    ),
    row!(
        "NE",
        ANY_BOTH,
        |i, o| equal(i, o, false),
        "Whether <1> differs from <2>; numbers, or any two of one kind.",
        High
    ),
    row!(
        "NEC",
        ANY_SECOND,
        |i, o| equal(i, o, false),
        "As NE, <2> constant.",
        High
    ),
    row!(
        "LT",
        BOTH,
        |i, o| order(i, o, |a, b| a < b),
        "Whether <1> is less than <2>.",
        High
    ),
    row!(
        "LTC",
        SECOND,
        |i, o| order(i, o, |a, b| a < b),
        "As LT, <2> constant.",
        High
    ),
    row!(
        "CLT",
        FIRST,
        |i, o| order(i, o, |a, b| a < b),
        "As LT, <1> constant.",
        Medium
    ),
    row!(
        "LE",
        BOTH,
        |i, o| order(i, o, |a, b| a <= b),
        "Whether <1> is at most <2>.",
        High
    ),
    row!(
        "LEC",
        SECOND,
        |i, o| order(i, o, |a, b| a <= b),
        "As LE, <2> constant.",
        High
    ),
    row!(
        "CLE",
        FIRST,
        |i, o| order(i, o, |a, b| a <= b),
        "As LE, <1> constant.",
        Medium
    ),
    row!(
        "GT",
        BOTH,
        |i, o| order(i, o, |a, b| a > b),
        "Whether <1> is greater than <2>.",
        High
    ),
    row!(
        "GTC",
        SECOND,
        |i, o| order(i, o, |a, b| a > b),
        "As GT, <2> constant.",
        High
    ),
    row!(
        "CGT",
        FIRST,
        |i, o| order(i, o, |a, b| a > b),
        "As GT, <1> constant.",
        Medium
    ),
    row!(
        "GE",
        BOTH,
        |i, o| order(i, o, |a, b| a >= b),
        "Whether <1> is at least <2>.",
        High
    ),
    row!(
        "GEC",
        SECOND,
        |i, o| order(i, o, |a, b| a >= b),
        "As GE, <2> constant.",
        High
    ),
    row!(
        "CGE",
        FIRST,
        |i, o| order(i, o, |a, b| a >= b),
        "As GE, <1> constant.",
        Medium
    ),
];

fn equal(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>, wanted: bool) -> Result<(), Fault> {
    let (a, b) = (inputs.get(1), inputs.get(2));
    let same = match (a.as_number(), b.as_number()) {
        (Some(a), Some(b)) => a == b,
        _ if a.kind() == b.kind() => a == b,
        (Some(_), None) => {
            return Err(Fault::Kind {
                input: 2,
                expected: Kinds::NUMBER,
            });
        }
        _ => {
            return Err(Fault::Kind {
                input: 2,
                expected: a.kind().into(),
            });
        }
    };
    outputs.send(1, Value::Boolean(same == wanted));
    Ok(())
}

fn order(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>, holds: fn(f64, f64) -> bool) -> Result<(), Fault> {
    outputs.send(1, holds(inputs.number(1)?, inputs.number(2)?));
    Ok(())
}
