//! Clocks: the only functions that send without being sent to.
//!
//! They run on network time as the host gives it, never on a clock of their own, so that a recorded
//! session plays back alike.

use super::function::{Fault, Function, Inputs, Now, Outputs, domain};
use super::recalled::restore;
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kinds, Value};

const INPUTS: &[InputSpec] = &[
    InputSpec::constant(Kinds::INTEGER, Preset::Integer(1)),
    InputSpec::constant(Kinds::BOOLEAN, Preset::Boolean(true)),
    InputSpec::constant(Kinds::INTEGER, Preset::Integer(0)),
    InputSpec::constant(Kinds::INTEGER, Preset::Integer(1)),
];
const OUTPUTS: &[OutputSpec] = &[OutputSpec::of(Kinds::INTEGER), OutputSpec::of(Kinds::BOOLEAN)];
const SOURCE: &str = "names recollected; pins ours";

pub(super) const TABLE: &[Spec] = &[
    Spec::clock("CLCSECONDS", INPUTS, OUTPUTS, |_| {
        Box::new(Clock::new(|now| centiseconds(now.secs)))
    })
    .says(
        "Every <1> hundredths of a second of network time while <2> is TRUE: output <1> a count \
             that begins at <3> and grows by <4>, output <2> TRUE. Sending <3> starts the count anew.",
    )
    .known(Confidence::Low, SOURCE)
    .example("<1> FIX(50) | @0.5 | @1 -> <1> FIX(0) | <2> TRUE | <1> FIX(1) | <2> TRUE"),
    Spec::clock("CLFRAMES", INPUTS, OUTPUTS, |_| {
        Box::new(Clock::new(|now| now.frame))
    })
    .says("As CLCSECONDS, every <1> displayed frames.")
    .known(Confidence::Low, SOURCE)
    .example("<1> FIX(30) | <3> FIX(5) | @0.5 -> <1> FIX(5) | <2> TRUE"),
    Spec::clock("CLTICKS", INPUTS, OUTPUTS, |_| {
        Box::new(Clock::new(|now| now.ticks))
    })
    .says("As CLCSECONDS, every <1> ticks the host gives the machine.")
    .known(Confidence::Low, SOURCE)
    .example("<1> FIX(2) | @0.1 | @0.2 -> <1> FIX(0) | <2> TRUE"),
];

/// Hundredths of a second since the start. The small addition keeps 0.29 from being counted as 28.
fn centiseconds(secs: f64) -> u64 {
    (secs * 100.0 + 1e-6).max(0.0) as u64
}

/// After a pause of the host a clock does not send more than this at once; what it left out is counted.
const CAUGHT_UP_MAX: u64 = 256;

struct Clock {
    units: fn(Now) -> u64,
    /// Units at the last look; nothing before the first.
    seen: Option<u64>,
    /// Units that ran since the last interval ended.
    elapsed: u64,
    count: Option<i32>,
}

impl Clock {
    fn new(units: fn(Now) -> u64) -> Self {
        Self {
            units,
            seen: None,
            elapsed: 0,
            count: None,
        }
    }
}

impl Function for Clock {
    fn constant_set(&mut self, number: u8) {
        if number == 3 {
            self.count = None;
        }
    }

    fn fire(&mut self, _inputs: &Inputs<'_>, _outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        Ok(()) // An input made active by SETUP CNESS does not set a clock off.
    }

    fn advance(&mut self, now: Now, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let units = (self.units)(now);
        let passed = units.saturating_sub(self.seen.replace(units).unwrap_or(units));
        let (interval, running) = (inputs.integer(1)?, inputs.boolean(2)?);
        let (first, step) = (inputs.integer(3)?, inputs.integer(4)?);
        if !running {
            return Ok(());
        }
        let Ok(interval @ 1..) = u64::try_from(interval) else {
            return domain("the interval of a clock is at least 1; it stands still");
        };
        self.elapsed += passed;
        let due = self.elapsed / interval;
        self.elapsed %= interval;
        let left_out = due.saturating_sub(CAUGHT_UP_MAX);
        let jump = step.wrapping_mul(left_out as i32);
        let mut next = self.count.unwrap_or(first).wrapping_add(jump);
        for _ in left_out..due {
            outputs.send(1, next);
            outputs.send(2, true);
            next = next.wrapping_add(step);
        }
        if due > 0 {
            self.count = Some(next);
        }
        if left_out > 0 {
            return domain("network time jumped; the clock counted intervals without sending them");
        }
        Ok(())
    }

    /// Without the time of the last look, which is the machine's affair: a clock that is made again goes on
    /// from the moment it is made.
    fn remembered(&self) -> Vec<Value> {
        if self.elapsed == 0 && self.count.is_none() {
            return Vec::new();
        }
        let mut state = vec![Value::Real(self.elapsed as f64)];
        state.extend(self.count.map(Value::Integer));
        state
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        let Self { units, seen, .. } = *self;
        let new = Self {
            seen,
            ..Self::new(units)
        };
        restore(self, new, state, |state| {
            Some(Self {
                units,
                seen,
                elapsed: state.count()?,
                count: if state.left() > 0 {
                    Some(state.integer()?)
                } else {
                    None
                },
            })
        })
    }
}
