//! A value on a spring: it follows late and softly, and may swing.

use super::super::components::{CONTINUOUS, Point};
use super::super::function::{Fault, Function, Inputs, Now, Outputs, domain};
use super::super::recalled::restore;
use super::super::spec::{Confidence, InputSpec, OutputSpec, Spec};
use super::super::stopwatch::Stopwatch;
use super::real;
use crate::value::Value;

pub(super) const TABLE: &[Spec] = &[Spec::clock(
    "DR_LAG",
    &[InputSpec::active(CONTINUOUS), real(0.1), real(1.0)],
    &[OutputSpec::of(CONTINUOUS)],
    |_| Box::<Lag>::default(),
)
.says(
    "Follows <1> as if drawn by a spring: <2> is its time constant in seconds, after seven of \
             which less than a hundredth is left to go; <3> its damping, 1 for none too far, less for \
             swinging beyond and back, more for creeping. Sent at every tick until it rests. The \
             first message passes at once. A time constant that is not positive or a negative damping \
             is reported, and it stands still.",
)
.known(
    Confidence::Project,
    "ours; the exact solution of a damped spring, so that the division into ticks does not \
             matter",
)
.example(
    "<2> 1 | <1> 0 | <1> 1 | @1 | @2 -> <1> 0 | <1> 0.2642411176571153 | <1> \
             0.5939941502901616",
)];

/// Both what is left to go and the way made in one time constant are below this share: it rests.
const REST: f64 = 1e-6;

#[derive(Default)]
struct Lag {
    watch: Stopwatch,
    motion: Option<Motion>,
}

#[derive(Clone, Copy)]
struct Motion {
    at: Point,
    /// Per second.
    speed: Point,
    target: Point,
}

impl Function for Lag {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let target = Point::of(inputs, 1)?;
        match &mut self.motion {
            Some(motion) if motion.at.is_like(target) => motion.target = target,
            _ => {
                self.motion = Some(Motion {
                    at: target,
                    speed: target.zero(),
                    target,
                });
                outputs.send(1, target.value());
            }
        }
        if inputs.number(2)? <= 0.0 || inputs.number(3)? < 0.0 {
            return domain("a time constant is positive, a damping not negative; it stands still");
        }
        Ok(())
    }

    fn advance(&mut self, now: Now, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let secs = self.watch.lap_secs(now);
        let (constant_secs, damping) = (inputs.number(2)?, inputs.number(3)?);
        let Some(motion) = self.motion.as_mut().filter(|motion| !motion.rests()) else {
            return Ok(());
        };
        if secs > 0.0 && constant_secs > 0.0 && damping >= 0.0 {
            motion.go(secs, 1.0 / constant_secs, damping);
            outputs.send(1, motion.at.value());
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        match &self.motion {
            None => Vec::new(),
            Some(motion) => [motion.at, motion.speed, motion.target]
                .map(Point::value)
                .to_vec(),
        }
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.motion, None, state, |state| {
            let (at, speed, target) = (state.point()?, state.point()?, state.point()?);
            let alike = at.is_like(target) && speed.is_like(target);
            alike.then_some(Some(Motion { at, speed, target }))
        })
    }
}

impl Motion {
    fn rests(&self) -> bool {
        self.at == self.target && self.speed == self.speed.zero()
    }

    /// Moves on, and comes to rest where hardly anything is left. `frequency` in radians a second.
    fn go(&mut self, secs: f64, frequency: f64, damping: f64) {
        let left = self.at.with(self.target, |at, target| at - target);
        let spring = Spring::new(secs, frequency, damping);
        let moved = left.with(self.speed, |y, v| spring.left * y + spring.left_by_speed * v);
        self.speed = left.with(self.speed, |y, v| spring.speed_by_left * y + spring.speed * v);
        self.at = moved.with(self.target, |y, target| target + y);
        let near = REST * (1.0 + self.target.length());
        if moved.length() <= near && self.speed.length() <= near * frequency {
            self.at = self.target;
            self.speed = self.speed.zero();
        }
    }
}

/// What is left to go and the speed after a span are sums of the two before it, with these factors:
/// the solution of y'' = -f²y - 2dfy' over the span.
struct Spring {
    left: f64,
    left_by_speed: f64,
    speed_by_left: f64,
    speed: f64,
}

impl Spring {
    fn new(secs: f64, f: f64, d: f64) -> Self {
        // The span decays by `decay`; `c` and `s` are the even and the odd part of what it does meanwhile.
        let (decay, c, s) = if d < 1.0 {
            let swing = f * (1.0 - d * d).sqrt();
            (
                (-d * f * secs).exp(),
                (swing * secs).cos(),
                (swing * secs).sin() / swing,
            )
        } else if d > 1.0 {
            let creep = f * (d * d - 1.0).sqrt();
            // Written with the slower decay, so that nothing grows beyond all bounds.
            let faster = (-2.0 * creep * secs).exp();
            let slower = ((creep - d * f) * secs).exp();
            (slower, f64::midpoint(1.0, faster), (1.0 - faster) / (2.0 * creep))
        } else {
            ((-f * secs).exp(), 1.0, secs)
        };
        Self {
            left: decay * (c + d * f * s),
            left_by_speed: decay * s,
            speed_by_left: -decay * f * f * s,
            speed: decay * (c - d * f * s),
        }
    }
}
