//! A stream kept with its times, and played again.

use super::super::function::{Fault, Function, Inputs, Now, Outputs, domain};
use super::super::recalled::{Recalled, restore};
use super::super::spec::{Confidence, InputSpec, OutputSpec, Spec};
use super::super::stopwatch::Stopwatch;
use super::{BOOLEAN_OUT, OURS, WRITTEN, real, truth};
use crate::value::{Kinds, Value};

pub(super) const TABLE: &[Spec] = &[Spec::clock(
    "DR_RECORDER",
    &[
        InputSpec::active(WRITTEN),
        InputSpec::active(Kinds::BOOLEAN),
        InputSpec::active(Kinds::BOOLEAN),
        truth(false),
        real(1.0),
    ],
    &[OutputSpec::of(WRITTEN), BOOLEAN_OUT],
    |_| Box::<Recorder>::default(),
)
.each()
.says(
    "TRUE at <2> forgets what was kept and keeps what comes to <1> from now on, with its \
             times, until FALSE at <2>. TRUE at <3> plays it from the beginning, <5> times as fast, \
             until FALSE at <3> or its end, at which output <2> sends TRUE; with <4> TRUE it begins \
             again there. Output <1> what is played, and while nothing is, <1> as it comes; while it \
             plays, <1> is dropped. Messages beyond 16384 are reported and not kept; a negative speed \
             is reported and nothing is played.",
)
.known(Confidence::Project, OURS)
.example(
    "<2> TRUE | <1> 1 | @0.5 | <1> 2 | @1 | <2> FALSE | <3> TRUE | @1.4 | @1.5 | @2 -> <1> 1 \
             | <1> 2 | <1> 1 | <1> 2 | <2> TRUE",
)];

/// As many messages as one recording has at most: at 60 a second some four minutes.
const KEPT_MAX: usize = 16384;

/// A tick plays no more rounds of a loop than this; of those beyond it plays the last one's place only.
const ROUNDS_MAX: usize = 16;

#[derive(Default)]
struct Recorder {
    watch: Stopwatch,
    tape: Tape,
}

/// Times in microseconds from the beginning.
#[derive(Default)]
struct Tape {
    does: Does,
    /// While recording or playing, how far it has come.
    at: f64,
    /// How long the recording is.
    length: f64,
    /// The message to be played next.
    next: usize,
    kept: Vec<(f64, Value)>,
}

#[derive(Clone, Copy, Default, PartialEq)]
enum Does {
    #[default]
    Nothing,
    Record,
    Play,
}

impl Function for Recorder {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let tape = &mut self.tape;
        if let Some(message) = inputs.find(1) {
            return tape.hear(message, outputs);
        }
        if inputs.find(2).is_some() {
            tape.record(inputs.boolean(2)?);
        } else {
            tape.stop();
            if inputs.boolean(3)? {
                if inputs.number(5)? < 0.0 {
                    return domain("a recording is not played backwards");
                }
                tape.does = Does::Play;
                tape.rewind(0.0);
                tape.play_due(outputs);
            }
        }
        Ok(())
    }

    fn advance(&mut self, now: Now, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let passed = self.watch.lap(now) as f64;
        let (loops, speed) = (inputs.boolean(4)?, inputs.number(5)?);
        if self.tape.does == Does::Record {
            self.tape.at += passed;
        } else if self.tape.does == Does::Play && passed > 0.0 && speed > 0.0 {
            self.tape.play(passed * speed, loops, outputs);
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        let tape = &self.tape;
        if tape.does == Does::Nothing && tape.kept.is_empty() && tape.length == 0.0 {
            return Vec::new();
        }
        let mut state: Vec<Value> = vec![
            Value::Boolean(tape.does == Does::Record),
            Value::Boolean(tape.does == Does::Play),
            Value::Real(tape.at),
            Value::Real(tape.length),
            Value::Integer(tape.next as i32),
        ];
        let kept = tape.kept.iter();
        state.extend(kept.flat_map(|(at, message)| [Value::Real(*at), message.clone()]));
        state
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.tape, Tape::default(), state, Tape::read)
    }
}

impl Tape {
    fn hear(&mut self, message: &Value, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        if self.does == Does::Play {
            return Ok(());
        }
        outputs.send(1, message.clone());
        if self.does == Does::Record {
            if self.kept.len() == KEPT_MAX {
                return domain("16384 messages are kept already; this one is not");
            }
            self.kept.push((self.at, message.clone()));
        }
        Ok(())
    }

    fn record(&mut self, on: bool) {
        self.stop();
        if on {
            self.kept.clear();
            self.rewind(0.0);
            self.length = 0.0;
            self.does = Does::Record;
        }
    }

    fn stop(&mut self) {
        if self.does == Does::Record {
            self.length = self.at;
        }
        self.does = Does::Nothing;
    }

    fn rewind(&mut self, at: f64) {
        self.at = at;
        self.next = self.kept.partition_point(|(kept, _)| *kept < at);
    }

    fn play_due(&mut self, outputs: &mut Outputs<'_>) {
        while let Some((at, message)) = self.kept.get(self.next)
            && *at <= self.at
        {
            outputs.send(1, message.clone());
            self.next += 1;
        }
    }

    fn play(&mut self, span: f64, loops: bool, outputs: &mut Outputs<'_>) {
        self.at += span;
        for _ in 0..ROUNDS_MAX {
            self.play_due(outputs);
            if self.at < self.length {
                return;
            }
            outputs.send(2, true);
            if !loops || self.length <= 0.0 {
                self.does = Does::Nothing;
                return;
            }
            let over = self.at - self.length;
            self.rewind(0.0);
            self.at = over;
        }
        let place = self.at % self.length;
        self.rewind(place);
    }

    fn read(state: &mut Recalled<'_>) -> Option<Self> {
        let does = match (state.boolean()?, state.boolean()?) {
            (false, false) => Does::Nothing,
            (true, false) => Does::Record,
            (false, true) => Does::Play,
            (true, true) => return None,
        };
        let (at, length, next) = (state.real()?, state.real()?, state.integer()?);
        let mut kept = Vec::new();
        while state.left() > 0 && kept.len() < KEPT_MAX {
            kept.push((state.real()?, state.written()?.clone()));
        }
        let next = usize::try_from(next).ok().filter(|&next| next <= kept.len())?;
        let in_order = kept.is_sorted_by(|a, b| a.0 <= b.0) && at >= 0.0 && length >= 0.0;
        in_order.then_some(Self {
            does,
            at,
            length,
            next,
            kept,
        })
    }
}
