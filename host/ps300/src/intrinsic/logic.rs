//! Boolean functions; on integers they work bit by bit.

use super::function::{Fault, Inputs, Outputs};
use super::spec::{Confidence, Does, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kinds, Value};

const BITS: Kinds = Kinds::BOOLEAN.or(Kinds::INTEGER);
const BOTH: &[InputSpec] = &[InputSpec::active(BITS), InputSpec::active(BITS)];
const SECOND: &[InputSpec] = &[
    InputSpec::active(BITS),
    InputSpec::constant(BITS, Preset::Required),
];
const SOURCE: &str = "recollected; integers bit by bit with little certainty";

macro_rules! row {
    ($name:literal, $inputs:expr, $does:expr, $behaviour:literal) => {
        Spec {
            name: $name,
            sizes: None,
            inputs: $inputs,
            outputs: &[OutputSpec::of(BITS)],
            does: Does::Pure($does),
            behaviour: $behaviour,
            source: SOURCE,
            confidence: Confidence::High,
        }
    };
}

pub(super) const TABLE: &[Spec] = &[
    row!("AND", BOTH, and, "TRUE if both are; integers bit by bit."),
    row!("ANDC", SECOND, and, "As AND, <2> constant."),
    row!("OR", BOTH, or, "TRUE if either is; integers bit by bit."),
    row!("ORC", SECOND, or, "As OR, <2> constant."),
    row!("XOR", BOTH, xor, "TRUE if they differ; integers bit by bit."),
    row!("XORC", SECOND, xor, "As XOR, <2> constant."),
    row!(
        "NOT",
        &[InputSpec::active(BITS)],
        not,
        "TRUE if <1> is FALSE; integers bit by bit."
    ),
];

fn and(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    combine(inputs, outputs, |a, b| a && b, |a, b| a & b)
}

fn or(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    combine(inputs, outputs, |a, b| a || b, |a, b| a | b)
}

fn xor(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    combine(inputs, outputs, |a, b| a != b, |a, b| a ^ b)
}

fn combine(
    inputs: &Inputs<'_>,
    outputs: &mut Outputs<'_>,
    truth: fn(bool, bool) -> bool,
    bits: fn(i32, i32) -> i32,
) -> Result<(), Fault> {
    match inputs.get(1) {
        Value::Boolean(a) => outputs.send(1, truth(*a, inputs.boolean(2)?)),
        _ => outputs.send(1, bits(inputs.integer(1)?, inputs.integer(2)?)),
    }
    Ok(())
}

fn not(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    match inputs.get(1) {
        Value::Boolean(a) => outputs.send(1, !a),
        _ => outputs.send(1, !inputs.integer(1)?),
    }
    Ok(())
}
