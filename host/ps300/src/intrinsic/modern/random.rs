//! Chance that repeats itself: the same seed, the same numbers.

use super::super::function::{Fault, Function, Inputs, Now, Outputs, domain};
use super::super::numbers::integer;
use super::super::recalled::restore;
use super::super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use super::super::stopwatch::Stopwatch;
use super::{REAL_OUT, TRIGGER, real, truth};
use crate::value::{Kinds, Value};

const SEED: InputSpec = InputSpec::constant(Kinds::INTEGER, Preset::Integer(1));

pub(super) const TABLE: &[Spec] = &[
    Spec::stateful(
        "DR_RANDOM",
        &[TRIGGER, real(0.0), real(1.0), SEED],
        &[OutputSpec::of(Kinds::NUMBER)],
        |_| Box::<Random>::default(),
    )
    .says(
        "Every message at <1> sends a number by chance from <2> to <3>: a real below <3>, or, \
             where both are integers, one of those and all between. The same seed <4> gives the same \
             sequence; sending it begins anew. <3> below <2> is reported.",
    )
    .known(
        Confidence::Project,
        "ours; generator SplitMix64: G. Steele, D. Lea, C. Flood, OOPSLA 2014",
    )
    .example(
        "<2> FIX(1) | <3> FIX(6) | <1> TRUE | <1> TRUE | <1> TRUE -> <1> FIX(4) | <1> FIX(5) | \
             <1> FIX(6)",
    ),
    Spec::clock(
        "DR_NOISE",
        &[real(1.0), real(1.0), real(0.0), SEED, truth(true)],
        &[REAL_OUT],
        |_| Box::<Noise>::default(),
    )
    .says(
        "At every tick while <5> is TRUE: <3> plus at most <2> of smooth noise that wavers about \
             <1> times a second: the tremble of something alive. The same seed <4> gives the same \
             course; it passes through <3> <1> times a second.",
    )
    .known(
        Confidence::Project,
        "ours; gradient noise of one dimension: K. Perlin, Improving Noise, SIGGRAPH 2002",
    )
    .example("@0.25 | @0.5 | @1 -> <1> 0.29065199048162488 | <1> 0.47220104593349388 | <1> 0"),
];

/// SplitMix64's stride, the golden ratio of 2 to the 64th.
const STRIDE: u64 = 0x9e37_79b9_7f4a_7c15;

/// SplitMix64's mixing of a counter.
fn mixed(counter: u64) -> u64 {
    let z = (counter ^ (counter >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[derive(Default)]
struct Random {
    counter: Option<u64>,
}

impl Function for Random {
    fn constant_set(&mut self, number: u8) {
        if number == 4 {
            self.counter = None;
        }
    }

    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let (lower, upper, seed) = (inputs.number(2)?, inputs.number(3)?, inputs.integer(4)?);
        if upper < lower {
            return domain("the upper end of a range of chance is not below the lower");
        }
        let counter = self.counter.unwrap_or(u64::from(seed.cast_unsigned()));
        let counter = counter.wrapping_add(STRIDE);
        self.counter = Some(counter);
        // The upper 53 bits: as many as a real between 0 and 1 tells apart.
        let share = (mixed(counter) >> 11) as f64 / (1_u64 << 53) as f64;
        match (inputs.get(2), inputs.get(3)) {
            (Value::Integer(_), Value::Integer(_)) => {
                outputs.send(1, integer(lower + (share * (upper - lower + 1.0)).floor())?);
            }
            _ => outputs.send(1, lower + (upper - lower) * share),
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        // As two integers, since reals do not tell all 64 bits apart.
        let halves = |counter: u64| [(counter >> 32) as u32, counter as u32];
        let counter = self.counter.into_iter().flat_map(halves);
        counter.map(|half| Value::Integer(half.cast_signed())).collect()
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.counter, None, state, |state| {
            let mut half = || state.integer().map(|half| u64::from(half.cast_unsigned()));
            Some(Some((half()? << 32) | half()?))
        })
    }
}

#[derive(Default)]
struct Noise {
    watch: Stopwatch,
    /// How far along the noise it is; between two whole numbers lies one waver.
    at: f64,
}

impl Function for Noise {
    fn fire(&mut self, _: &Inputs<'_>, _: &mut Outputs<'_>) -> Result<(), Fault> {
        Ok(()) // An input made active by SETUP CNESS sets nothing off.
    }

    fn advance(&mut self, now: Now, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let secs = self.watch.lap_secs(now);
        if secs == 0.0 || !inputs.boolean(5)? {
            return Ok(());
        }
        let at = self.at + inputs.number(1)? * secs;
        if at.abs() >= PLACES_MAX {
            return domain("the noise has come to its end; a lower frequency would have lasted longer");
        }
        self.at = at;
        let noise = gradient_noise(inputs.integer(4)?, at);
        outputs.send(1, inputs.number(3)? + inputs.number(2)? * noise);
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        Some(self.at)
            .filter(|at| *at != 0.0)
            .map(Value::Real)
            .into_iter()
            .collect()
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.at, 0.0, state, |state| {
            state.real().filter(|at| at.abs() < PLACES_MAX)
        })
    }
}

/// Beyond this a real no longer tells places between whole numbers apart finely enough.
const PLACES_MAX: f64 = 4_294_967_296.0;

/// Between -1 and 1, 0 at whole numbers, with a slope there that the seed decides.
fn gradient_noise(seed: i32, at: f64) -> f64 {
    let place = at.floor();
    let slope = |place: f64| {
        let key = (u64::from(seed.cast_unsigned()) << 32) ^ (place as i64).cast_unsigned();
        let share = (mixed(key.wrapping_mul(STRIDE)) >> 11) as f64 / (1_u64 << 53) as f64;
        2.0 * share - 1.0
    };
    let t = at - place;
    let blend = t * t * t * (10.0 + t * (6.0 * t - 15.0));
    let (left, right) = (slope(place) * t, slope(place + 1.0) * (t - 1.0));
    // Two slopes of 1 towards each other meet half way at a half.
    2.0 * (left + (right - left) * blend)
}
