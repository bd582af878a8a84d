//! Functions that let some messages pass and change or hold back others.

use super::function::{Fault, Function, Inputs, Outputs};
use super::numbers::integer;
use super::recalled::remembers_one;
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kinds, Value};

const NUMBER_OUT: &[OutputSpec] = &[OutputSpec::of(Kinds::NUMBER)];

pub(super) const TABLE: &[Spec] = &[
    Spec::pure(
        "LIMIT",
        &[
            InputSpec::active(Kinds::NUMBER),
            InputSpec::constant(Kinds::NUMBER, Preset::Rule("unbounded")),
            InputSpec::constant(Kinds::NUMBER, Preset::Rule("unbounded")),
        ],
        NUMBER_OUT,
        limit,
    )
    .says(
        "The number, no greater than the upper limit <2> and no less than the lower limit <3>. An \
             integer stays one; limits with fractions are cut off towards zero for it.",
    )
    .known(
        Confidence::Medium,
        "recollected; upper before lower as in the D0 dial functions",
    )
    .example("<2> 5 | <3> -5 | <1> 7 | <1> -7 | <1> 1 -> <1> 5 | <1> -5 | <1> 1"),
    Spec::pure(
        "RANGE_SELECT",
        &[
            InputSpec::active(Kinds::NUMBER),
            InputSpec::constant(Kinds::NUMBER, Preset::Rule("unbounded")),
            InputSpec::constant(Kinds::NUMBER, Preset::Rule("unbounded")),
        ],
        &[OutputSpec::of(Kinds::NUMBER), OutputSpec::of(Kinds::NUMBER)],
        range_select,
    )
    .says(
        "The number on output <1> if it is no greater than <2> and no less than <3>, on output \
             <2> if it is.",
    )
    .known(
        Confidence::Low,
        "recollected: one output in range, one out of it; pins ours, upper before lower as in \
             LIMIT",
    )
    .example("<2> 5 | <3> -5 | <1> 3 | <1> 7 -> <1> 3 | <2> 7"),
    Spec::stateful(
        "DELTA",
        &[
            InputSpec::active(Kinds::NUMBER),
            InputSpec::constant(Kinds::NUMBER, Preset::Real(0.0)),
        ],
        NUMBER_OUT,
        |_| Box::<Delta>::default(),
    )
    .says("Passes a number that differs from the last one passed by at least <2>; the first always.")
    .known(
        Confidence::Used,
        "D0 tablet networks, integers with 1; whether equality passes is ours",
    )
    .example("<2> 0.5 | <1> 1 | <1> 1.25 | <1> 1.5 -> <1> 1 | <1> 1.5"),
    Spec::stateful(
        "EDGE_DETECT",
        &[
            InputSpec::active(Kinds::BOOLEAN),
            InputSpec::constant(Kinds::BOOLEAN, Preset::Boolean(true)),
        ],
        &[OutputSpec::of(Kinds::BOOLEAN)],
        |_| Box::<Edge>::default(),
    )
    .says(
        "Sends the level <2> once each time <1> changes to it. Before the first message <1> \
             counts as the opposite level.",
    )
    .known(Confidence::Medium, "recollected; default and start ours")
    .example("<1> TRUE | <1> TRUE | <1> FALSE | <1> TRUE -> <1> TRUE | <1> TRUE"),
];

fn limit(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let upper = inputs.number_or(2, f64::INFINITY)?;
    let lower = inputs.number_or(3, f64::NEG_INFINITY)?;
    let limited = inputs.number(1)?.min(upper).max(lower);
    match inputs.get(1) {
        Value::Integer(_) => outputs.send(1, integer(limited.trunc())?),
        _ => outputs.send(1, limited),
    }
    Ok(())
}

fn range_select(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let upper = inputs.number_or(2, f64::INFINITY)?;
    let lower = inputs.number_or(3, f64::NEG_INFINITY)?;
    let number = inputs.number(1)?;
    let within = lower <= number && number <= upper;
    outputs.send(if within { 1 } else { 2 }, inputs.get(1).clone());
    Ok(())
}

#[derive(Default)]
struct Delta {
    passed: Option<f64>,
}

impl Function for Delta {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let (number, least) = (inputs.number(1)?, inputs.number(2)?);
        if self.passed.is_none_or(|passed| (number - passed).abs() >= least) {
            self.passed = Some(number);
            outputs.send(1, inputs.get(1).clone());
        }
        Ok(())
    }

    remembers_one!(passed, Real, real);
}

#[derive(Default)]
struct Edge {
    before: Option<bool>,
}

impl Function for Edge {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let (now, level) = (inputs.boolean(1)?, inputs.boolean(2)?);
        let before = self.before.replace(now).unwrap_or(!level);
        if now == level && before != level {
            outputs.send(1, level);
        }
        Ok(())
    }

    remembers_one!(before, Boolean, boolean);
}
