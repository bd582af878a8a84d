//! Functions of one number: rounding, conversion, sine and cosine, square root, mean.

use std::collections::VecDeque;

use super::function::{Fault, Function, Inputs, Outputs, domain};
use super::recalled::{Recalled, restore};
use super::spec::{Confidence, Does, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kinds, Value};

const NUMBER: &[InputSpec] = &[InputSpec::active(Kinds::NUMBER)];
const INTEGER_OUT: &[OutputSpec] = &[OutputSpec::of(Kinds::INTEGER)];
const REAL_OUT: &[OutputSpec] = &[OutputSpec::of(Kinds::REAL)];
const RECOLLECTED: &str = "recollected: name certain, rounding less so";

pub(super) const TABLE: &[Spec] = &[
    Spec {
        name: "ROUND",
        sizes: None,
        inputs: NUMBER,
        outputs: INTEGER_OUT,
        does: Does::Pure(|inputs, outputs| send_integer(inputs, outputs, f64::round)),
        behaviour: "The nearest integer; halves go away from zero.",
        source: RECOLLECTED,
        confidence: Confidence::Medium,
    },
    Spec {
        name: "CEILING",
        sizes: None,
        inputs: NUMBER,
        outputs: INTEGER_OUT,
        does: Does::Pure(|inputs, outputs| send_integer(inputs, outputs, f64::ceil)),
        behaviour: "The least integer that is not less.",
        source: RECOLLECTED,
        confidence: Confidence::Medium,
    },
    Spec {
        name: "FIX",
        sizes: None,
        inputs: NUMBER,
        outputs: INTEGER_OUT,
        does: Does::Pure(|inputs, outputs| send_integer(inputs, outputs, f64::trunc)),
        behaviour: "Real to integer; the fraction is cut off.",
        source: RECOLLECTED,
        confidence: Confidence::Medium,
    },
    Spec {
        name: "FLOAT",
        sizes: None,
        inputs: NUMBER,
        outputs: REAL_OUT,
        does: Does::Pure(|inputs, outputs| {
            outputs.send(1, inputs.number(1)?);
            Ok(())
        }),
        behaviour: "Integer to real.",
        source: RECOLLECTED,
        confidence: Confidence::Medium,
    },
    Spec {
        name: "SINCOS",
        sizes: None,
        inputs: NUMBER,
        outputs: &[OutputSpec::of(Kinds::REAL), OutputSpec::of(Kinds::REAL)],
        does: Does::Pure(|inputs, outputs| {
            let (sin, cos) = inputs.number(1)?.to_radians().sin_cos();
            outputs.send(1, sin);
            outputs.send(2, cos);
            Ok(())
        }),
        behaviour: "Output <1> the sine, <2> the cosine of an angle in degrees.",
        source: "recollected",
        confidence: Confidence::Medium,
    },
    Spec {
        name: "SQROOT",
        sizes: None,
        inputs: NUMBER,
        outputs: REAL_OUT,
        does: Does::Pure(|inputs, outputs| {
            let x = inputs.number(1)?;
            if x < 0.0 {
                return domain("square root of a negative number");
            }
            outputs.send(1, x.sqrt());
            Ok(())
        }),
        behaviour: "The square root; a negative number is reported and gives nothing.",
        source: "recollected",
        confidence: Confidence::High,
    },
    Spec {
        name: "AVERAGE",
        sizes: None,
        inputs: &[
            InputSpec::active(Kinds::NUMBER),
            InputSpec::constant(Kinds::INTEGER, Preset::Integer(1)),
        ],
        outputs: REAL_OUT,
        does: Does::Stateful(|_| Box::<Average>::default()),
        behaviour: "The mean of the last <2> numbers, of as many as have come while they are fewer. \
                    <2> lies between 1 and 1024.",
        source: "recollected; bounds ours",
        confidence: Confidence::Low,
    },
];

/// A real that is whole already, as an integer; those beyond 32 bits have no answer.
pub(super) fn integer(whole: f64) -> Result<i32, Fault> {
    if whole >= f64::from(i32::MIN) && whole <= f64::from(i32::MAX) {
        Ok(whole as i32)
    } else {
        domain("the number does not fit an integer of 32 bits")
    }
}

fn send_integer(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>, round: fn(f64) -> f64) -> Result<(), Fault> {
    outputs.send(1, integer(round(inputs.number(1)?))?);
    Ok(())
}

/// More numbers than this smooth nothing a hand could feel, and cost memory.
const AVERAGED_MAX: usize = 1024;

#[derive(Default)]
struct Average {
    last: VecDeque<f64>,
}

impl Function for Average {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let Ok(count @ 1..=AVERAGED_MAX) = usize::try_from(inputs.integer(2)?) else {
            return domain("the count of an average lies between 1 and 1024");
        };
        self.last.push_back(inputs.number(1)?);
        while self.last.len() > count {
            self.last.pop_front();
        }
        let share = 1.0 / self.last.len() as f64;
        outputs.send(1, self.last.iter().map(|x| x * share).sum::<f64>());
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        self.last.iter().map(|&x| Value::Real(x)).collect()
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        let last = |state: &mut Recalled<'_>| {
            state
                .reals()
                .filter(|last: &VecDeque<f64>| last.len() <= AVERAGED_MAX)
        };
        restore(&mut self.last, VecDeque::new(), state, last)
    }
}
