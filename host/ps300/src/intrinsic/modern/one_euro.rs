//! The 1 Euro filter: steady at rest, quick in motion.

use std::f64::consts::TAU;

use super::super::components::{CONTINUOUS, Point};
use super::super::function::{Fault, Function, Inputs, Now, Outputs, domain};
use super::super::recalled::{Recalled, restore};
use super::super::spec::{Confidence, InputSpec, OutputSpec, Spec};
use super::super::stopwatch::Stopwatch;
use super::real;
use crate::value::Value;

pub(super) const TABLE: &[Spec] = &[Spec::clock(
    "DR_ONE_EURO",
    &[InputSpec::active(CONTINUOUS), real(1.0), real(0.0), real(1.0)],
    &[OutputSpec::of(CONTINUOUS)],
    |_| Box::<OneEuro>::default(),
)
.says(
    "Smooths a jittering stream: a low pass whose cutoff is <2> hertz at rest and grows by \
             <3> for each unit a second of speed; the speed is itself smoothed with the cutoff <4>. \
             First lower <2> until a resting hand is still, then raise <3> until a fast one is not \
             late. Of several messages at one time the last counts. Cutoffs that are not positive are \
             reported.",
)
.known(
    Confidence::Project,
    "G. Casiez, N. Roussel, D. Vogel, 1 Euro Filter, CHI 2012, algorithm 1; for vectors \
             component by component; <2>, <4> 1 Hz as there, <3> 0 where tuning begins",
)
.example(
    "@0 | <1> 0 | @0.1 | <1> 1 | @0.2 | <1> 1 -> <1> 0 | <1> 0.3858695450950375 | <1> \
             0.6228437843582239",
)];

#[derive(Default)]
struct OneEuro {
    watch: Stopwatch,
    heard: Option<Heard>,
}

/// The newest message filtered, and what it was filtered from.
#[derive(Clone, Copy)]
struct Heard {
    newest: Filtered,
    /// Microseconds since it came.
    age: u64,
    /// The filter at an earlier time, and how many microseconds earlier.
    before: Option<(Filtered, u64)>,
}

#[derive(Clone, Copy)]
struct Filtered {
    value: Point,
    /// Per second.
    speed: Point,
}

struct Cutoffs {
    least: f64,
    per_speed: f64,
    speed: f64,
}

impl Function for OneEuro {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let value = Point::of(inputs, 1)?;
        let cutoffs = Cutoffs {
            least: inputs.number(2)?,
            per_speed: inputs.number(3)?,
            speed: inputs.number(4)?,
        };
        if cutoffs.least <= 0.0 || cutoffs.per_speed < 0.0 || cutoffs.speed <= 0.0 {
            return domain("cutoffs are positive, their growth is not negative");
        }
        let before = match self.heard.filter(|heard| heard.newest.value.is_like(value)) {
            Some(Heard { newest, age, .. }) if age > 0 => Some((newest, age)),
            Some(Heard { before, .. }) => before,
            None => None,
        };
        let newest = match before {
            Some((filtered, micros)) => filtered.step(value, micros as f64 * 1e-6, &cutoffs),
            None => Filtered {
                value,
                speed: value.zero(),
            },
        };
        self.heard = Some(Heard {
            newest,
            age: 0,
            before,
        });
        outputs.send(1, newest.value.value());
        Ok(())
    }

    fn advance(&mut self, now: Now, _: &Inputs<'_>, _: &mut Outputs<'_>) -> Result<(), Fault> {
        let passed = self.watch.lap(now);
        if let Some(heard) = &mut self.heard {
            heard.age += passed;
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        let Some(heard) = &self.heard else {
            return Vec::new();
        };
        let state = |filtered: Filtered, micros: u64| {
            [
                filtered.value.value(),
                filtered.speed.value(),
                Value::Real(micros as f64),
            ]
        };
        let mut all = state(heard.newest, heard.age).to_vec();
        if let Some((filtered, micros)) = heard.before {
            all.extend(state(filtered, micros));
        }
        all
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.heard, None, state, |state| {
            let (newest, age) = filtered(state)?;
            let before = if state.left() > 0 {
                Some(filtered(state)?)
            } else {
                None
            };
            let alike = before.is_none_or(|(before, _)| before.value.is_like(newest.value));
            alike.then_some(Some(Heard { newest, age, before }))
        })
    }
}

fn filtered(state: &mut Recalled<'_>) -> Option<(Filtered, u64)> {
    let (value, speed) = (state.point()?, state.point()?);
    let micros = state.count()?;
    value
        .is_like(speed)
        .then_some((Filtered { value, speed }, micros))
}

impl Filtered {
    fn step(self, value: Point, secs: f64, cutoffs: &Cutoffs) -> Self {
        let raw = self.value.with(value, |old, new| (new - old) / secs);
        let speed = self.speed.towards(raw, share(secs, cutoffs.speed));
        let pace = value.zero().with(speed, |_, speed| {
            share(secs, cutoffs.least + cutoffs.per_speed * speed.abs())
        });
        let way = self.value.with(value, |old, new| new - old);
        let way = way.with(pace, |way, share| way * share);
        Self {
            value: self.value.with(way, |old, way| old + way),
            speed,
        }
    }
}

/// How much of a new value enters: 1 / (1 + tau / secs) with tau = 1 / (2 pi cutoff).
fn share(secs: f64, cutoff_hz: f64) -> f64 {
    let turned = TAU * cutoff_hz * secs;
    turned / (turned + 1.0)
}
