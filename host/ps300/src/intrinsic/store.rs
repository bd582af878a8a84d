//! Functions that reach things by name, and the variable.

use super::function::{Errand, Fault, Inputs, Outputs, domain};
use super::spec::{Confidence, Does, InputSpec, OutputSpec, Preset, Spec};
use crate::language::Input;
use crate::value::Kinds;

pub(super) const TABLE: &[Spec] = &[
    Spec {
        name: "SEND",
        sizes: None,
        inputs: &[
            InputSpec::active(Kinds::ANY),
            InputSpec::active(Kinds::STRING),
            InputSpec::active(Kinds::INTEGER),
        ],
        outputs: &[],
        does: Does::Pure(send),
        behaviour: "Sends the value <1> to input <3> of whatever is named <2>, as the command SEND would. \
                    A name that denotes nothing is reported.",
        source: "recollected",
        confidence: Confidence::Medium,
    },
    Spec {
        name: "FETCH",
        sizes: None,
        inputs: &[
            InputSpec::active(Kinds::ANY),
            InputSpec::constant(Kinds::STRING, Preset::Required),
        ],
        outputs: &[OutputSpec::of(Kinds::ANY)],
        does: Does::Pure(fetch),
        behaviour: "Every message at <1>, of any kind, sends what the variable named <2> holds.",
        source: "recollected",
        confidence: Confidence::Medium,
    },
];

/// What VARIABLE makes: not in the table, since `F:` cannot make it.
pub(crate) static VARIABLE: Spec = Spec {
    name: "VARIABLE",
    sizes: None,
    inputs: &[InputSpec::constant(Kinds::ANY, Preset::Required)],
    outputs: &[],
    does: Does::Pure(|_, _| Ok(())),
    behaviour: "Holds the last message sent to <1>.",
    source: "recollected",
    confidence: Confidence::Medium,
};

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
