//! Switches, joins and wires.
#![allow(clippy::unnecessary_wraps, reason = "the rows of a table share one signature")]

use super::function::{Fault, Inputs, Outputs, domain};
use super::spec::{Confidence, Does, InputSpec, OutputSpec, Preset, Spec, Times};
use crate::value::Kinds;

const ANY: InputSpec = InputSpec::active(Kinds::ANY);
const STORED: InputSpec = InputSpec::constant(Kinds::ANY, Preset::Required);
const CHOICE: InputSpec = InputSpec::active(Kinds::INTEGER);
const TRUTH: InputSpec = InputSpec::active(Kinds::BOOLEAN);
const OUT: OutputSpec = OutputSpec::of(Kinds::ANY);
const MANY: &[OutputSpec] = &[OUT.times(Times::Size)];

/// The range of sizes the record gives for SYNC; taken for the other sized types too.
const SIZES: Option<(u8, u8)> = Some((1, 127));

macro_rules! row {
    ($name:literal, $sizes:expr, $inputs:expr, $outputs:expr, $does:expr, $behaviour:literal, $source:literal, $confidence:ident) => {
        Spec {
            name: $name,
            sizes: $sizes,
            inputs: $inputs,
            outputs: $outputs,
            does: Does::Pure($does),
            behaviour: $behaviour,
            source: $source,
            confidence: Confidence::$confidence,
        }
    };
}

pub(super) const TABLE: &[Spec] = &[
    row!(
        "CONSTANT",
        None,
        &[ANY, STORED],
        &[OUT],
        constant,
        "Every message at <1>, of any kind, sends the value of <2>.",
        "D0 rendering networks",
        Used
    ),
    row!(
        "NOP",
        None,
        &[ANY],
        &[OUT],
        nop,
        "Passes messages on.",
        "D0 as a sink; passing on recollected",
        Used
    ),
    Spec {
        name: "PASSTHRU",
        sizes: SIZES,
        inputs: &[ANY.times(Times::Size)],
        outputs: MANY,
        does: Does::Each(pass_one),
        behaviour: "Independent wires: a message at any input leaves at once on the output of the same number.",
        source: "recollected",
        confidence: Confidence::Medium,
    },
    row!(
        "ROUTE",
        SIZES,
        &[CHOICE, ANY],
        MANY,
        route,
        "Sends the value <2> on the output whose number is <1>. A number without output is reported.",
        "D0 tablet networks",
        Used
    ),
    row!(
        "ROUTEC",
        SIZES,
        &[CHOICE, STORED],
        MANY,
        route,
        "As ROUTE, <2> constant: every number sends the stored value.",
        "recollected",
        High
    ),
    row!(
        "CROUTE",
        SIZES,
        &[InputSpec::constant(Kinds::INTEGER, Preset::Required), ANY],
        MANY,
        route,
        "As ROUTE, <1> constant: a set switch for a stream.",
        "recollected",
        High
    ),
    row!(
        "BROUTE",
        None,
        &[TRUTH, ANY],
        &[OUT, OUT],
        broute,
        "Sends the value <2> on output <1> if <1> is TRUE, on output <2> if it is FALSE.",
        "recollected",
        High
    ),
    row!(
        "BROUTEC",
        None,
        &[TRUTH, STORED],
        &[OUT, OUT],
        broute,
        "As BROUTE, <2> constant.",
        "recollected",
        High
    ),
    row!(
        "CBROUTE",
        None,
        &[InputSpec::constant(Kinds::BOOLEAN, Preset::Required), ANY],
        &[OUT, OUT],
        broute,
        "As BROUTE, <1> constant.",
        "recollected",
        High
    ),
    row!(
        "BOOLEAN_CHOOSE",
        None,
        &[TRUTH, STORED, STORED],
        &[OUT],
        boolean_choose,
        "TRUE sends the value of <2>, FALSE that of <3>.",
        "recollected",
        Medium
    ),
    row!(
        "INPUTS_CHOOSE",
        Some((2, 127)),
        &[STORED.times(Times::SizeLessOne), CHOICE],
        &[OUT],
        choose,
        "The last input chooses by number which of the values stored before it is sent.",
        "recollected",
        Medium
    ),
    row!(
        "SYNC",
        Some((2, 127)),
        &[ANY.times(Times::Size)],
        MANY,
        pass_all,
        "Waits until every input has a message, then sends each on the output of its number, in order.",
        "recollected, with the range of sizes",
        High
    ),
];

fn pass(outputs: &mut Outputs<'_>, output: u8, inputs: &Inputs<'_>, input: u8) {
    outputs.send(output, inputs.get(input).clone());
}

fn constant(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    pass(outputs, 1, inputs, 2);
    Ok(())
}

fn nop(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    pass(outputs, 1, inputs, 1);
    Ok(())
}

fn route(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    match u8::try_from(inputs.integer(1)?) {
        Ok(output) if (1..=inputs.size()).contains(&output) => pass(outputs, output, inputs, 2),
        _ => return domain("the switch has no output of that number"),
    }
    Ok(())
}

fn broute(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    pass(outputs, if inputs.boolean(1)? { 1 } else { 2 }, inputs, 2);
    Ok(())
}

fn boolean_choose(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    pass(outputs, 1, inputs, if inputs.boolean(1)? { 2 } else { 3 });
    Ok(())
}

fn choose(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let last = inputs.count();
    match u8::try_from(inputs.integer(last)?) {
        Ok(chosen) if (1..last).contains(&chosen) => pass(outputs, 1, inputs, chosen),
        _ => return domain("there is no stored input of that number"),
    }
    Ok(())
}

fn pass_all(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    for number in 1..=inputs.count() {
        pass(outputs, number, inputs, number);
    }
    Ok(())
}

fn pass_one(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    if let Some(number) = (1..=inputs.count()).find(|&number| inputs.find(number).is_some()) {
        pass(outputs, number, inputs, number);
    }
    Ok(())
}
