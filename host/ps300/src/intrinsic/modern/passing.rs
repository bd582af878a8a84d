//! Functions that pass messages, or do not: gates, holding, delay, changes only.

use std::collections::VecDeque;

use super::super::function::{Fault, Function, Inputs, Now, Outputs, domain};
use super::super::recalled::restore;
use super::super::spec::{Confidence, InputSpec, OutputSpec, Spec};
use super::super::stopwatch::Stopwatch;
use super::{OURS, WRITTEN, truth};
use crate::value::{Kinds, Value};

const MESSAGE: InputSpec = InputSpec::active(WRITTEN);
const OUT: &[OutputSpec] = &[OutputSpec::of(WRITTEN)];

pub(super) const TABLE: &[Spec] = &[
    Spec::pure(
        "DR_GATE",
        &[InputSpec::active(Kinds::ANY), truth(true)],
        &[OutputSpec::of(Kinds::ANY)],
        gate,
    )
    .says("Passes messages while <2> is TRUE, drops them while it is FALSE.")
    .known(Confidence::Project, OURS)
    .example("<1> 1 | <2> FALSE | <1> 2 | <2> TRUE | <1> 3 -> <1> 1 | <1> 3"),
    Spec::stateful(
        "DR_HOLD",
        &[MESSAGE, InputSpec::active(Kinds::BOOLEAN)],
        OUT,
        |_| Box::<Hold>::default(),
    )
    .each()
    .says(
        "Passes <1>. TRUE at <2> holds it: nothing leaves until FALSE at <2>, which sends the \
             newest of what came meanwhile, if anything did. Either input sets it off by itself.",
    )
    .known(Confidence::Project, OURS)
    .example("<1> 1 | <2> TRUE | <1> 2 | <1> 3 | <2> FALSE | <1> 4 -> <1> 1 | <1> 3 | <1> 4"),
    Spec::stateful("DR_CHANGE", &[MESSAGE], OUT, |_| Box::<Change>::default())
        .says("Passes a message that is not the same as the one before; the first always.")
        .known(Confidence::Project, OURS)
        .example("<1> 'a' | <1> 'a' | <1> 'b' | <1> 'a' -> <1> 'a' | <1> 'b' | <1> 'a'"),
    Spec::clock(
        "DR_DELAY",
        &[MESSAGE, InputSpec::required(Kinds::NUMBER)],
        OUT,
        |_| Box::<Delay>::default(),
    )
    .says(
        "Passes each message <2> seconds after it came, at the first tick then, and none before \
             those that came before. A negative time is reported, and so are messages beyond the 4096 \
             it keeps; these are dropped.",
    )
    .known(Confidence::Project, OURS)
    .example("<2> 0.5 | <1> 'a' | @0.3 | <1> 'b' | @0.5 | @1 -> <1> 'a' | <1> 'b'"),
];

fn gate(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    if inputs.boolean(2)? {
        outputs.send(1, inputs.get(1).clone());
    }
    Ok(())
}

#[derive(Default)]
struct Hold {
    holds: bool,
    newest: Option<Value>,
}

impl Function for Hold {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        match inputs.find(1) {
            Some(message) if self.holds => self.newest = Some(message.clone()),
            Some(message) => outputs.send(1, message.clone()),
            None => {
                self.holds = inputs.boolean(2)?;
                if let Some(newest) = self.newest.take_if(|_| !self.holds) {
                    outputs.send(1, newest);
                }
            }
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        if !self.holds {
            return Vec::new();
        }
        std::iter::once(Value::Boolean(true))
            .chain(self.newest.clone())
            .collect()
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(self, Self::default(), state, |state| {
            let holds = state.boolean().filter(|&holds| holds)?;
            let newest = if state.left() > 0 {
                Some(state.written()?.clone())
            } else {
                None
            };
            Some(Self { holds, newest })
        })
    }
}

#[derive(Default)]
struct Change {
    before: Option<Value>,
}

impl Function for Change {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let message = inputs.get(1);
        if self.before.as_ref() != Some(message) {
            self.before = Some(message.clone());
            outputs.send(1, message.clone());
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        self.before.clone().into_iter().collect()
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.before, None, state, |state| {
            Some(Some(state.written()?.clone()))
        })
    }
}

/// As many messages as wait at most.
const DELAYED_MAX: usize = 4096;

#[derive(Default)]
struct Delay {
    watch: Stopwatch,
    /// Oldest first, each with the microseconds until it is due.
    waiting: VecDeque<(u64, Value)>,
}

impl Function for Delay {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let (message, secs) = (inputs.get(1), inputs.number(2)?);
        if secs < 0.0 {
            return domain("a delay is not negative");
        }
        let micros = (secs * 1e6).round() as u64;
        if micros == 0 && self.waiting.is_empty() {
            outputs.send(1, message.clone());
        } else if self.waiting.len() >= DELAYED_MAX {
            return domain("4096 messages wait already; this one was dropped");
        } else {
            self.waiting.push_back((micros, message.clone()));
        }
        Ok(())
    }

    fn advance(&mut self, now: Now, _: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let passed = self.watch.lap(now);
        for (due, _) in &mut self.waiting {
            *due = due.saturating_sub(passed);
        }
        while let Some((_, message)) = self.waiting.pop_front_if(|(due, _)| *due == 0) {
            outputs.send(1, message);
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        let pair = |(due, message): &(u64, Value)| [Value::Real(*due as f64), message.clone()];
        self.waiting.iter().flat_map(pair).collect()
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.waiting, VecDeque::new(), state, |state| {
            let mut waiting = VecDeque::new();
            while state.left() > 0 && waiting.len() < DELAYED_MAX {
                waiting.push_back((state.count()?, state.written()?.clone()));
            }
            Some(waiting)
        })
    }
}
