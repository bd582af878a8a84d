//! A gate against the noise of pots: nothing passes until a hand moves.

use super::super::function::{Fault, Function, Inputs, Now, Outputs, domain};
use super::super::recalled::restore;
use super::super::spec::{Confidence, OutputSpec, Spec};
use super::super::stopwatch::Stopwatch;
use super::{NUMBER, real};
use crate::value::{Kinds, Value};

pub(super) const TABLE: &[Spec] = &[Spec::clock(
    "DR_GATE_NOISE",
    &[NUMBER, real(0.025), real(0.005), real(0.25)],
    &[OutputSpec::of(Kinds::NUMBER)],
    |_| Box::<NoiseGate>::default(),
)
.says(
    "Passes a number that lies further than <2> from the last one passed, and then every one, \
             until they have stayed within <3> of each other for <4> seconds; then it is shut again. \
             The first passes always. Negative distances or times, or <3> above <2>, are reported.",
)
.known(
    Confidence::Project,
    "ours; the distance of 2.5 % is the middle one of deej's (omriharel/deej, noise \
             reduction)",
)
.example(
    "<2> 0.1 | <3> 0.01 | <1> 0 | <1> 0.05 | <1> 0.2 | <1> 0.25 | @1 | <1> 0.25 | <1> 0.3 -> \
             <1> 0 | <1> 0.2 | <1> 0.25 | <1> 0.25",
)];

#[derive(Default)]
struct NoiseGate {
    watch: Stopwatch,
    gate: Option<Gate>,
}

struct Gate {
    passed: f64,
    open: Option<Open>,
}

struct Open {
    /// The number the others have stayed near to.
    near: f64,
    /// Microseconds since then.
    still: u64,
}

impl Function for NoiseGate {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let number = inputs.number(1)?;
        let [opens, shuts, secs] = [inputs.number(2)?, inputs.number(3)?, inputs.number(4)?];
        if shuts < 0.0 || opens < shuts || secs < 0.0 {
            return domain(
                "distances and time of a gate are not negative, the first distance not below the second",
            );
        }
        let gate = self.gate.get_or_insert(Gate {
            passed: f64::INFINITY, // Further off than any number: the first passes.
            open: None,
        });
        let open = match gate.open.take() {
            Some(open) if (number - open.near).abs() > shuts => Some(Open {
                near: number,
                still: 0,
            }),
            Some(open) => Some(open),
            None if gate.passed.is_infinite() => None,
            None if (number - gate.passed).abs() > opens => Some(Open {
                near: number,
                still: 0,
            }),
            None => return Ok(()),
        };
        gate.open = open.filter(|open| (open.still as f64) * 1e-6 < secs || open.still == 0);
        gate.passed = number;
        outputs.send(1, inputs.get(1).clone());
        Ok(())
    }

    fn advance(&mut self, now: Now, _: &Inputs<'_>, _: &mut Outputs<'_>) -> Result<(), Fault> {
        let passed = self.watch.lap(now);
        if let Some(open) = self.gate.as_mut().and_then(|gate| gate.open.as_mut()) {
            open.still += passed;
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        let Some(gate) = &self.gate else {
            return Vec::new();
        };
        let mut state = vec![Value::Real(gate.passed)];
        if let Some(open) = &gate.open {
            state.extend([Value::Real(open.near), Value::Real(open.still as f64)]);
        }
        state
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.gate, None, state, |state| {
            let passed = state.real()?;
            let open = if state.left() > 0 {
                Some(Open {
                    near: state.real()?,
                    still: state.count()?,
                })
            } else {
                None
            };
            Some(Some(Gate { passed, open }))
        })
    }
}
