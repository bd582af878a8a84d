//! A limit on how fast a value moves.

use super::super::components::{CONTINUOUS, Point};
use super::super::function::{Fault, Function, Inputs, Now, Outputs, domain};
use super::super::recalled::restore;
use super::super::spec::{Confidence, InputSpec, OutputSpec, Spec};
use super::super::stopwatch::Stopwatch;
use super::{OURS, number_or};
use crate::value::Value;

pub(super) const TABLE: &[Spec] = &[Spec::clock(
    "DR_SLEW",
    &[
        InputSpec::active(CONTINUOUS),
        number_or("unbounded"),
        number_or("as <2>"),
    ],
    &[OutputSpec::of(CONTINUOUS)],
    |_| Box::<Slew>::default(),
)
.says(
    "Follows <1> no faster than <2> a second; a number falls no faster than <3> a second. A \
             vector goes straight, <2> being its speed. Sent at every tick while it moves. The first \
             message passes at once, and so does each while <2> is not set. Negative rates are \
             reported; then it stands still.",
)
.known(Confidence::Project, OURS)
.example("<2> 2 | <1> 0 | <1> 1 | @0.25 | @1 -> <1> 0 | <1> 0.5 | <1> 1")];

#[derive(Default)]
struct Slew {
    watch: Stopwatch,
    motion: Option<Motion>,
}

struct Motion {
    at: Point,
    target: Point,
}

impl Function for Slew {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let target = Point::of(inputs, 1)?;
        let rates = [
            inputs.number_or(2, f64::INFINITY)?,
            inputs.number_or(3, f64::INFINITY)?,
        ];
        match &mut self.motion {
            Some(motion) if motion.at.is_like(target) && rates[0].is_finite() => motion.target = target,
            _ => {
                self.motion = Some(Motion { at: target, target });
                outputs.send(1, target.value());
            }
        }
        if rates.iter().any(|rate| *rate < 0.0) {
            return domain("a rate is not negative; it stands still");
        }
        Ok(())
    }

    fn advance(&mut self, now: Now, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let secs = self.watch.lap_secs(now);
        let Some(motion) = self.motion.as_mut().filter(|motion| motion.at != motion.target) else {
            return Ok(());
        };
        let rising = inputs.number_or(2, f64::INFINITY)?;
        let falls = motion.at.is_number() && motion.target.first() < motion.at.first();
        let rate = if falls {
            inputs.number_or(3, rising)?
        } else {
            rising
        };
        let (step, distance) = (rate * secs, motion.at.distance(motion.target));
        if step >= distance {
            motion.at = motion.target;
        } else if step > 0.0 {
            motion.at = motion.at.towards(motion.target, step / distance);
        } else {
            return Ok(());
        }
        outputs.send(1, motion.at.value());
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        match &self.motion {
            None => Vec::new(),
            Some(motion) => vec![motion.at.value(), motion.target.value()],
        }
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.motion, None, state, |state| {
            let (at, target) = (state.point()?, state.point()?);
            at.is_like(target).then_some(Some(Motion { at, target }))
        })
    }
}
