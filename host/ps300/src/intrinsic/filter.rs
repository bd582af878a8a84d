//! Functions that let some messages pass and change or hold back others.

use super::function::{Fault, Function, Inputs, Outputs};
use super::numbers::integer;
use super::recalled::restore;
use super::spec::{Confidence, Does, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kinds, Value};

const NUMBER_OUT: &[OutputSpec] = &[OutputSpec::of(Kinds::NUMBER)];

pub(super) const TABLE: &[Spec] = &[
    Spec {
        name: "LIMIT",
        sizes: None,
        inputs: &[
            InputSpec::active(Kinds::NUMBER),
            InputSpec::constant(Kinds::NUMBER, Preset::Rule("unbounded")),
            InputSpec::constant(Kinds::NUMBER, Preset::Rule("unbounded")),
        ],
        outputs: NUMBER_OUT,
        does: Does::Pure(limit),
        behaviour: "The number, no greater than the upper limit <2> and no less than the lower limit <3>. \
                    An integer stays one; limits with fractions are cut off towards zero for it.",
        source: "recollected; upper before lower as in the D0 dial functions",
        confidence: Confidence::Medium,
    },
    Spec {
        name: "DELTA",
        sizes: None,
        inputs: &[
            InputSpec::active(Kinds::NUMBER),
            InputSpec::constant(Kinds::NUMBER, Preset::Real(0.0)),
        ],
        outputs: NUMBER_OUT,
        does: Does::Stateful(|_| Box::<Delta>::default()),
        behaviour: "Passes a number that differs from the last one passed by at least <2>; the first always.",
        source: "D0 tablet networks, integers with 1; whether equality passes is ours",
        confidence: Confidence::Used,
    },
    Spec {
        name: "EDGE_DETECT",
        sizes: None,
        inputs: &[
            InputSpec::active(Kinds::BOOLEAN),
            InputSpec::constant(Kinds::BOOLEAN, Preset::Boolean(true)),
        ],
        outputs: &[OutputSpec::of(Kinds::BOOLEAN)],
        does: Does::Stateful(|_| Box::<Edge>::default()),
        behaviour: "Sends the level <2> once each time <1> changes to it. Before the first message <1> counts as \
                    the opposite level.",
        source: "recollected; default and start ours",
        confidence: Confidence::Medium,
    },
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

    fn remembered(&self) -> Vec<Value> {
        self.passed.map(Value::Real).into_iter().collect()
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.passed, None, state, |state| state.real().map(Some))
    }
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

    fn remembered(&self) -> Vec<Value> {
        self.before.map(Value::Boolean).into_iter().collect()
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.before, None, state, |state| state.boolean().map(Some))
    }
}
