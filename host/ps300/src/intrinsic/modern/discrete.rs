//! Functions that turn streams into states and counts: thresholds, toggles, counters, unwrapped angles.

use super::super::function::{Fault, Function, Inputs, Outputs, domain};
use super::super::numbers::integer;
use super::super::recalled::remembers_one;
use super::super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use super::{BOOLEAN_OUT, NUMBER, OURS, TRIGGER, real, truth};
use crate::value::{Kinds, Value};

const WHOLE: OutputSpec = OutputSpec::of(Kinds::INTEGER);
const LIMIT: InputSpec = InputSpec::constant(Kinds::INTEGER, Preset::Rule("unbounded"));

pub(super) const TABLE: &[Spec] = &[
    Spec::stateful("DR_EDGE", &[NUMBER, real(0.5), real(0.0)], &[BOOLEAN_OUT], |_| {
        Box::<Edge>::default()
    })
    .says(
        "TRUE when <1> reaches the threshold <2>, FALSE when it falls below; once each. <3> is \
             the width of a band around the threshold that it has to leave on the other side. The \
             first message sends its side. A negative width is reported.",
    )
    .known(Confidence::Project, "ours; O. H. Schmitt's trigger, 1938")
    .example(
        "<3> 0.2 | <1> 0 | <1> 0.55 | <1> 0.65 | <1> 0.45 | <1> 0.35 -> <1> FALSE | <1> TRUE | \
             <1> FALSE",
    ),
    Spec::stateful("DR_TOGGLE", &[TRIGGER, truth(false)], &[BOOLEAN_OUT], |_| {
        Box::<Toggle>::default()
    })
    .says(
        "Each message turns TRUE to FALSE and back, beginning from <2>. Sending <2> starts anew \
             without sending.",
    )
    .known(Confidence::Project, OURS)
    .example("<1> FIX(3) | <1> FIX(3) | <1> FIX(3) -> <1> TRUE | <1> FALSE | <1> TRUE"),
    Spec::stateful(
        "DR_COUNTER",
        &[
            TRIGGER,
            TRIGGER,
            TRIGGER,
            InputSpec::constant(Kinds::INTEGER, Preset::Integer(0)),
            InputSpec::constant(Kinds::INTEGER, Preset::Integer(1)),
            LIMIT,
            LIMIT,
            truth(false),
        ],
        &[WHOLE, BOOLEAN_OUT],
        |_| Box::<Counter>::default(),
    )
    .each()
    .says(
        "Counts: a message at <1> adds <5>, one at <2> takes it away, one at <3> goes back to the \
             start <4>; each sends the count on output <1>. It stays between the lower limit <7> and \
             the upper limit <6>, or, with <8> TRUE, goes on at the other one; output <2> sends TRUE \
             when it would have left them. Sending <4> starts anew without sending. Limits the wrong \
             way round are reported, and so is a count beyond 32 bits.",
    )
    .known(Confidence::Project, OURS)
    .example(
        "<6> FIX(2) | <7> FIX(0) | <8> TRUE | <1> 'x' | <1> 'x' | <1> 'x' -> <1> FIX(1) | <1> \
             FIX(2) | <1> FIX(0) | <2> TRUE",
    ),
    Spec::stateful(
        "DR_UNWRAP",
        &[NUMBER, real(360.0)],
        &[OutputSpec::of(Kinds::NUMBER)],
        |_| Box::<Unwrap>::default(),
    )
    .says(
        "An angle or count that begins again at every period <2> as one that goes on: each step \
             is the shortest, half a period counts as forwards. The first message passes as it is. \
             Integers give an integer. A period that is not positive is reported, and so is a sum \
             beyond 32 bits.",
    )
    .known(Confidence::Project, OURS)
    .example("<1> 350 | <1> 10 | <1> 340 -> <1> 350 | <1> 370 | <1> 340"),
];

#[derive(Default)]
struct Edge {
    above: Option<bool>,
}

impl Function for Edge {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let (number, threshold, width) = (inputs.number(1)?, inputs.number(2)?, inputs.number(3)?);
        if width < 0.0 {
            return domain("the width of a threshold is not negative");
        }
        let above = match self.above {
            None => number >= threshold,
            Some(true) => number >= threshold - width / 2.0,
            Some(false) => number >= threshold + width / 2.0,
        };
        if self.above.replace(above) != Some(above) {
            outputs.send(1, above);
        }
        Ok(())
    }

    remembers_one!(above, Boolean, boolean);
}

#[derive(Default)]
struct Toggle {
    state: Option<bool>,
}

impl Function for Toggle {
    fn constant_set(&mut self, number: u8) {
        if number == 2 {
            self.state = None;
        }
    }

    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let start = inputs.boolean(2)?;
        let now = !self.state.filter(|_| inputs.is_constant(2)).unwrap_or(start);
        self.state = Some(now);
        outputs.send(1, now);
        Ok(())
    }

    remembers_one!(state, Boolean, boolean);
}

#[derive(Default)]
struct Counter {
    count: Option<i32>,
}

impl Function for Counter {
    fn constant_set(&mut self, number: u8) {
        if number == 4 {
            self.count = None;
        }
    }

    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let (start, step, wraps) = (
            inputs.integer(4)?,
            i64::from(inputs.integer(5)?),
            inputs.boolean(8)?,
        );
        let limit = |input, absent| {
            inputs
                .find(input)
                .map_or(Ok(absent), |_| inputs.integer(input).map(i64::from))
        };
        let (upper, lower) = (limit(6, i64::MAX)?, limit(7, i64::MIN)?);
        if lower > upper {
            return domain("the upper limit of a counter is not below the lower");
        }
        let now = i64::from(self.count.unwrap_or(start));
        let next = match (inputs.find(1), inputs.find(2)) {
            (Some(_), _) => now + step,
            (None, Some(_)) => now - step,
            (None, None) => i64::from(start),
        };
        let kept = if !wraps || (lower..=upper).contains(&next) {
            next.clamp(lower, upper)
        } else if next > upper && lower != i64::MIN {
            lower
        } else if next < lower && upper != i64::MAX {
            upper
        } else {
            next.clamp(lower, upper)
        };
        let Ok(count) = i32::try_from(kept) else {
            return domain("the count does not fit an integer of 32 bits; it was left as it was");
        };
        self.count = Some(count);
        outputs.send(1, count);
        if kept != next {
            outputs.send(2, true);
        }
        Ok(())
    }

    remembers_one!(count, Integer, integer);
}

#[derive(Default)]
struct Unwrap {
    sum: Option<f64>,
}

impl Function for Unwrap {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let (number, period) = (inputs.number(1)?, inputs.number(2)?);
        if period <= 0.0 {
            return domain("a period is positive");
        }
        let sum = match self.sum {
            None => number,
            Some(sum) => {
                let step = number - sum;
                sum + step - period * (step / period - 0.5).ceil()
            }
        };
        let whole = matches!(
            (inputs.get(1), inputs.get(2)),
            (Value::Integer(_), Value::Integer(_))
        );
        let sent = if whole {
            Value::Integer(integer(sum.round())?)
        } else {
            Value::Real(sum)
        };
        outputs.send(1, sent);
        self.sum = Some(sum);
        Ok(())
    }

    remembers_one!(sum, Real, real);
}
