//! The watch-dog on a stream.

use super::function::{Fault, Function, Inputs, Now, Outputs, domain};
use super::recalled::restore;
use super::spec::{Confidence, InputSpec, OutputSpec, Spec};
use super::stopwatch::Stopwatch;
use crate::value::{Kinds, Value};

pub(super) const TABLE: &[Spec] = &[Spec::clock(
    "TIMEOUT",
    &[InputSpec::active(Kinds::ANY), InputSpec::required(Kinds::INTEGER)],
    &[OutputSpec::of(Kinds::ANY), OutputSpec::of(Kinds::BOOLEAN)],
    |_| Box::<Timeout>::default(),
)
.says(
    "Passes each message on output <1>. When <2> hundredths of a second of network time have \
             gone by without another, output <2> sends TRUE, once; the next message starts the watch \
             again. An interval below 1 is reported.",
)
.known(
    Confidence::Low,
    "recollected: tells what came in time from what did not; pins and unit ours",
)
.example("<2> FIX(50) | @0 | <1> 'x' | @0.4 | @0.6 | @2 -> <1> 'x' | <2> TRUE")];

#[derive(Default)]
struct Timeout {
    watch: Stopwatch,
    /// Microseconds since the last message; nothing while none is waited for.
    silent: Option<u64>,
}

/// Microseconds in a hundredth of a second.
const CENTISECOND: u64 = 10_000;

impl Function for Timeout {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        outputs.send(1, inputs.get(1).clone());
        self.silent = Some(0);
        if inputs.integer(2)? < 1 {
            return domain("the interval is at least 1; nothing is watched");
        }
        Ok(())
    }

    fn advance(&mut self, now: Now, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let passed = self.watch.lap(now);
        let Some(silent) = &mut self.silent else {
            return Ok(());
        };
        *silent += passed;
        let interval = inputs.find(2).map_or(Ok(0), |_| inputs.integer(2))?;
        match u64::try_from(interval) {
            Ok(interval @ 1..) if *silent >= interval * CENTISECOND => {
                self.silent = None;
                outputs.send(2, true);
            }
            _ => {}
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        self.silent
            .map(|silent| Value::Real(silent as f64))
            .into_iter()
            .collect()
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.silent, None, state, |state| state.count().map(Some))
    }
}
