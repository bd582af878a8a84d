//! Comparisons. Trailing C: input 2 is constant; leading C: input 1.

use super::function::{Fault, Inputs, Outputs};
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
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

const OUT: &[OutputSpec] = &[OutputSpec::of(Kinds::BOOLEAN)];

pub(super) const TABLE: &[Spec] = &[
    Spec::pure("EQ", ANY_BOTH, OUT, |i, o| equal(i, o, true))
        .says("Whether <1> equals <2>; numbers, or any two of one kind.")
        .known(Confidence::High, "recollected")
        .example("<1> 1 | <2> FIX(1) -> <1> TRUE"),
    Spec::pure("EQC", ANY_SECOND, OUT, |i, o| equal(i, o, true))
        .says("As EQ, <2> constant.")
        .known(Confidence::High, "recollected")
        .example("<2> V2D(1,2) | <1> V2D(1,2) -> <1> TRUE"),
    Spec::pure("NE", ANY_BOTH, OUT, |i, o| equal(i, o, false))
        .says("Whether <1> differs from <2>; numbers, or any two of one kind.")
        .known(Confidence::High, "recollected")
        .example("<1> 1 | <2> 1 -> <1> FALSE"),
    Spec::pure("NEC", ANY_SECOND, OUT, |i, o| equal(i, o, false))
        .says("As NE, <2> constant.")
        .known(Confidence::High, "recollected")
        .example("<2> TRUE | <1> FALSE -> <1> TRUE"),
    Spec::pure("LT", BOTH, OUT, |i, o| order(i, o, |a, b| a < b))
        .says("Whether <1> is less than <2>.")
        .known(Confidence::High, "recollected")
        .example("<1> 1 | <2> 2 -> <1> TRUE"),
    Spec::pure("LTC", SECOND, OUT, |i, o| order(i, o, |a, b| a < b))
        .says("As LT, <2> constant.")
        .known(Confidence::High, "recollected")
        .example("<2> 2 | <1> 2 -> <1> FALSE"),
    Spec::pure("CLT", FIRST, OUT, |i, o| order(i, o, |a, b| a < b))
        .says("As LT, <1> constant.")
        .known(Confidence::Medium, "recollected")
        .example("<1> 1 | <2> 2 -> <1> TRUE"),
    Spec::pure("LE", BOTH, OUT, |i, o| order(i, o, |a, b| a <= b))
        .says("Whether <1> is at most <2>.")
        .known(Confidence::High, "recollected")
        .example("<1> 2 | <2> 2 -> <1> TRUE"),
    Spec::pure("LEC", SECOND, OUT, |i, o| order(i, o, |a, b| a <= b))
        .says("As LE, <2> constant.")
        .known(Confidence::High, "recollected")
        .example("<2> 2 | <1> 3 -> <1> FALSE"),
    Spec::pure("CLE", FIRST, OUT, |i, o| order(i, o, |a, b| a <= b))
        .says("As LE, <1> constant.")
        .known(Confidence::Medium, "recollected")
        .example("<1> 3 | <2> 2 -> <1> FALSE"),
    Spec::pure("GT", BOTH, OUT, |i, o| order(i, o, |a, b| a > b))
        .says("Whether <1> is greater than <2>.")
        .known(Confidence::High, "recollected")
        .example("<1> 2 | <2> 2 -> <1> FALSE"),
    Spec::pure("GTC", SECOND, OUT, |i, o| order(i, o, |a, b| a > b))
        .says("As GT, <2> constant.")
        .known(Confidence::High, "recollected")
        .example("<2> 2 | <1> FIX(3) -> <1> TRUE"),
    Spec::pure("CGT", FIRST, OUT, |i, o| order(i, o, |a, b| a > b))
        .says("As GT, <1> constant.")
        .known(Confidence::Medium, "recollected")
        .example("<1> 3 | <2> 2 -> <1> TRUE"),
    Spec::pure("GE", BOTH, OUT, |i, o| order(i, o, |a, b| a >= b))
        .says("Whether <1> is at least <2>.")
        .known(Confidence::High, "recollected")
        .example("<1> 2 | <2> 2 -> <1> TRUE"),
    Spec::pure("GEC", SECOND, OUT, |i, o| order(i, o, |a, b| a >= b))
        .says("As GE, <2> constant.")
        .known(Confidence::High, "recollected")
        .example("<2> 2 | <1> 1 -> <1> FALSE"),
    Spec::pure("CGE", FIRST, OUT, |i, o| order(i, o, |a, b| a >= b))
        .says("As GE, <1> constant.")
        .known(Confidence::Medium, "recollected")
        .example("<1> 1 | <2> 2 -> <1> FALSE"),
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
