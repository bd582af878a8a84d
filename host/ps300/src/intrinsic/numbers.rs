//! Functions of one number: rounding, conversion, sine and cosine, square root, mean.

use std::collections::VecDeque;

use super::function::{Fault, Function, Inputs, Outputs, domain};
use super::recalled::{Recalled, restore};
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kinds, Value};

const NUMBER: &[InputSpec] = &[InputSpec::active(Kinds::NUMBER)];
const INTEGER_OUT: &[OutputSpec] = &[OutputSpec::of(Kinds::INTEGER)];
const REAL_OUT: &[OutputSpec] = &[OutputSpec::of(Kinds::REAL)];
const RECOLLECTED: &str = "recollected: name certain, rounding less so";

pub(super) const TABLE: &[Spec] = &[
    Spec::pure("ROUND", NUMBER, INTEGER_OUT, |inputs, outputs| {
        send_integer(inputs, outputs, f64::round)
    })
    .says("The nearest integer; halves go away from zero.")
    .known(Confidence::Medium, RECOLLECTED)
    .example("<1> 2.5 | <1> -2.5 -> <1> FIX(3) | <1> FIX(-3)"),
    Spec::pure("CEILING", NUMBER, INTEGER_OUT, |inputs, outputs| {
        send_integer(inputs, outputs, f64::ceil)
    })
    .says("The least integer that is not less.")
    .known(Confidence::Medium, RECOLLECTED)
    .example("<1> 2.1 | <1> -2.9 -> <1> FIX(3) | <1> FIX(-2)"),
    Spec::pure("FIX", NUMBER, INTEGER_OUT, |inputs, outputs| {
        send_integer(inputs, outputs, f64::trunc)
    })
    .says("Real to integer; the fraction is cut off.")
    .known(Confidence::Medium, RECOLLECTED)
    .example("<1> 2.9 | <1> -2.9 -> <1> FIX(2) | <1> FIX(-2)"),
    Spec::pure("FLOAT", NUMBER, REAL_OUT, |inputs, outputs| {
        outputs.send(1, inputs.number(1)?);
        Ok(())
    })
    .says("Integer to real.")
    .known(Confidence::Medium, RECOLLECTED)
    .example("<1> FIX(4) -> <1> 4"),
    Spec::pure(
        "SINCOS",
        NUMBER,
        &[OutputSpec::of(Kinds::REAL), OutputSpec::of(Kinds::REAL)],
        |inputs, outputs| {
            let (sin, cos) = inputs.number(1)?.to_radians().sin_cos();
            outputs.send(1, sin);
            outputs.send(2, cos);
            Ok(())
        },
    )
    .says("Output <1> the sine, <2> the cosine of an angle in degrees.")
    .known(Confidence::Medium, "recollected")
    .example("<1> 30 -> <1> 0.5 | <2> 0.8660254037844386"),
    Spec::pure("SQROOT", NUMBER, REAL_OUT, |inputs, outputs| {
        let x = inputs.number(1)?;
        if x < 0.0 {
            return domain("square root of a negative number");
        }
        outputs.send(1, x.sqrt());
        Ok(())
    })
    .says("The square root; a negative number is reported and gives nothing.")
    .known(Confidence::High, "recollected")
    .example("<1> 9 -> <1> 3"),
    Spec::stateful(
        "AVERAGE",
        &[
            InputSpec::active(Kinds::NUMBER),
            InputSpec::constant(Kinds::INTEGER, Preset::Integer(1)),
        ],
        REAL_OUT,
        |_| Box::<Average>::default(),
    )
    .says(
        "The mean of the last <2> numbers, of as many as have come while they are fewer. <2> lies \
             between 1 and 1024.",
    )
    .known(Confidence::Low, "recollected; bounds ours")
    .example("<1> 3 | <1> 5 -> <1> 3 | <1> 5"),
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
