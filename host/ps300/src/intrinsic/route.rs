//! Switches, joins and wires.
#![allow(clippy::unnecessary_wraps, reason = "the rows of a table share one signature")]

use super::function::{Fault, Inputs, Outputs, domain};
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec, Times};
use crate::value::Kinds;

const ANY: InputSpec = InputSpec::active(Kinds::ANY);
const STORED: InputSpec = InputSpec::constant(Kinds::ANY, Preset::Required);
const CHOICE: InputSpec = InputSpec::active(Kinds::INTEGER);
const TRUTH: InputSpec = InputSpec::active(Kinds::BOOLEAN);
const OUT: OutputSpec = OutputSpec::of(Kinds::ANY);
const MANY: &[OutputSpec] = &[OUT.times(Times::Size)];

pub(super) const TABLE: &[Spec] = &[
    Spec::pure("CONSTANT", &[ANY, STORED], &[OUT], constant)
        .scalar(|_, x| x)
        .says("Every message at <1>, of any kind, sends the value of <2>.")
        .known(Confidence::Used, "D0 rendering networks")
        .example("<1> TRUE | <2> 'x' | <1> 5 -> <1> 'x' | <1> 'x'"),
    Spec::pure("NOP", &[ANY], &[OUT], nop)
        .scalar(|x, _| x)
        .says("Passes messages on.")
        .known(Confidence::Used, "D0 as a sink; passing on recollected")
        .example("<1> 'x' -> <1> 'x'"),
    Spec::pure("PASSTHRU", &[ANY.times(Times::Size)], MANY, pass_one)
        .each()
        .sized(1, 127)
        .says(
            "Independent wires: a message at any input leaves at once on the output of the same \
             number.",
        )
        .known(Confidence::Medium, "recollected")
        .example("(3) | <2> 1 | <3> 'x' -> <2> 1 | <3> 'x'"),
    Spec::pure("ROUTE", &[CHOICE, ANY], MANY, route)
        .sized(1, 127)
        .says(
            "Sends the value <2> on the output whose number is <1>. A number without output is \
             reported.",
        )
        .known(Confidence::Used, "D0 tablet networks")
        .example("(3) | <1> FIX(2) | <2> 'b' -> <2> 'b'"),
    Spec::pure("ROUTEC", &[CHOICE, STORED], MANY, route)
        .sized(1, 127)
        .says("As ROUTE, <2> constant: every number sends the stored value.")
        .known(Confidence::High, "recollected")
        .example("(2) | <2> 'v' | <1> FIX(2) | <1> FIX(1) -> <2> 'v' | <1> 'v'"),
    Spec::pure(
        "CROUTE",
        &[InputSpec::constant(Kinds::INTEGER, Preset::Required), ANY],
        MANY,
        route,
    )
    .sized(1, 127)
    .says("As ROUTE, <1> constant: a set switch for a stream.")
    .known(Confidence::High, "recollected")
    .example("(2) | <1> FIX(2) | <2> 'v' | <1> FIX(1) | <2> 'w' -> <2> 'v' | <1> 'w'"),
    Spec::pure("BROUTE", &[TRUTH, ANY], &[OUT, OUT], broute)
        .says("Sends the value <2> on output <1> if <1> is TRUE, on output <2> if it is FALSE.")
        .known(Confidence::High, "recollected")
        .example("<1> TRUE | <2> 1 | <1> FALSE | <2> 2 -> <1> 1 | <2> 2"),
    Spec::pure("BROUTEC", &[TRUTH, STORED], &[OUT, OUT], broute)
        .says("As BROUTE, <2> constant.")
        .known(Confidence::High, "recollected")
        .example("<2> 9 | <1> FALSE -> <2> 9"),
    Spec::pure(
        "CBROUTE",
        &[InputSpec::constant(Kinds::BOOLEAN, Preset::Required), ANY],
        &[OUT, OUT],
        broute,
    )
    .says("As BROUTE, <1> constant.")
    .known(Confidence::High, "recollected")
    .example("<1> TRUE | <2> 9 -> <1> 9"),
    Spec::pure("BOOLEAN_CHOOSE", &[TRUTH, STORED, STORED], &[OUT], boolean_choose)
        .says("TRUE sends the value of <2>, FALSE that of <3>.")
        .known(Confidence::Medium, "recollected")
        .example("<2> 'yes' | <3> 'no' | <1> FALSE | <1> TRUE -> <1> 'no' | <1> 'yes'"),
    Spec::pure(
        "INPUTS_CHOOSE",
        &[STORED.times(Times::SizeLessOne), CHOICE],
        &[OUT],
        choose,
    )
    .sized(2, 127)
    .says("The last input chooses by number which of the values stored before it is sent.")
    .known(Confidence::Medium, "recollected")
    .example("(3) | <1> 'a' | <2> 'b' | <3> FIX(2) -> <1> 'b'"),
    Spec::pure("SYNC", &[ANY.times(Times::Size)], MANY, pass_all)
        .sized(2, 127)
        .says(
            "Waits until every input has a message, then sends each on the output of its number, in \
             order.",
        )
        .known(Confidence::High, "recollected, with the range of sizes")
        .example("(2) | <2> 'b' | <2> 'd' | <1> 'a' -> <1> 'a' | <2> 'b'"),
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
