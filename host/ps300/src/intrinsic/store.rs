//! Functions that reach things by name, and the variable.

use super::function::{Errand, Fault, Inputs, Outputs, domain};
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::language::Input;
use crate::value::Kinds;

pub(super) const TABLE: &[Spec] = &[
    Spec::pure(
        "SEND",
        &[
            InputSpec::active(Kinds::ANY),
            InputSpec::active(Kinds::STRING),
            InputSpec::active(Kinds::INTEGER),
        ],
        &[],
        send,
    )
    .says(
        "Sends the value <1> to input <3> of whatever is named <2>, as the command SEND would. A \
             name that denotes nothing is reported.",
    )
    .known(Confidence::Medium, "recollected")
    .example("n := F:NOP | <1> 4 | <2> 'n' | <3> FIX(1) -> <1>n 4"),
    Spec::pure(
        "FETCH",
        &[
            InputSpec::active(Kinds::ANY),
            InputSpec::constant(Kinds::STRING, Preset::Required),
        ],
        &[OutputSpec::of(Kinds::ANY)],
        fetch,
    )
    .says("Every message at <1>, of any kind, sends what the variable named <2> holds.")
    .known(Confidence::Medium, "recollected")
    .example("VARIABLE store | STORE 12 IN <1>store | <2> 'store' | <1> TRUE -> <1> 12"),
];

/// What VARIABLE makes: not in the table, since `F:` cannot make it.
pub(crate) static VARIABLE: Spec = Spec::pure(
    "VARIABLE",
    &[InputSpec::constant(Kinds::ANY, Preset::Required)],
    &[],
    |_, _| Ok(()),
)
.says("Holds the last message sent to <1>.")
.known(Confidence::Medium, "recollected");

fn send(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let Ok(input) = u16::try_from(inputs.integer(3)?) else {
        return domain("inputs are numbered from 1");
    };
    let name = inputs.text(2)?.clone();
    outputs.errand(Errand::Send {
        name,
        input: Input::Number(input),
        value: inputs.get(1).clone(),
    });
    Ok(())
}

fn fetch(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    outputs.errand(Errand::Fetch {
        name: inputs.text(2)?.clone(),
        output: 1,
    });
    Ok(())
}
