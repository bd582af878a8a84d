//! Boolean functions; on integers they work bit by bit.

use super::function::{Fault, Inputs, Outputs};
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kinds, Value};

const BITS: Kinds = Kinds::BOOLEAN.or(Kinds::INTEGER);
const BOTH: &[InputSpec] = &[InputSpec::active(BITS), InputSpec::active(BITS)];
const SECOND: &[InputSpec] = &[
    InputSpec::active(BITS),
    InputSpec::constant(BITS, Preset::Required),
];
const OUT: &[OutputSpec] = &[OutputSpec::of(BITS)];
const SOURCE: &str = "recollected; integers bit by bit with little certainty";

pub(super) const TABLE: &[Spec] = &[
    Spec::pure("AND", BOTH, OUT, and)
        .says("TRUE if both are; integers bit by bit.")
        .known(Confidence::High, SOURCE)
        .example("<1> TRUE | <2> FALSE | <1> FIX(6) | <2> FIX(3) -> <1> FALSE | <1> FIX(2)"),
    Spec::pure("ANDC", SECOND, OUT, and)
        .says("As AND, <2> constant.")
        .known(Confidence::High, SOURCE)
        .example("<2> TRUE | <1> TRUE -> <1> TRUE"),
    Spec::pure("OR", BOTH, OUT, or)
        .says("TRUE if either is; integers bit by bit.")
        .known(Confidence::High, SOURCE)
        .example("<1> TRUE | <2> FALSE -> <1> TRUE"),
    Spec::pure("ORC", SECOND, OUT, or)
        .says("As OR, <2> constant.")
        .known(Confidence::High, SOURCE)
        .example("<2> FIX(1) | <1> FIX(6) -> <1> FIX(7)"),
    Spec::pure("XOR", BOTH, OUT, xor)
        .says("TRUE if they differ; integers bit by bit.")
        .known(Confidence::High, SOURCE)
        .example("<1> TRUE | <2> TRUE -> <1> FALSE"),
    Spec::pure("XORC", SECOND, OUT, xor)
        .says("As XOR, <2> constant.")
        .known(Confidence::High, SOURCE)
        .example("<2> TRUE | <1> FALSE -> <1> TRUE"),
    Spec::pure("NOT", &[InputSpec::active(BITS)], OUT, not)
        .says("TRUE if <1> is FALSE; integers bit by bit.")
        .known(Confidence::High, SOURCE)
        .example("<1> TRUE | <1> FIX(0) -> <1> FALSE | <1> FIX(-1)"),
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
