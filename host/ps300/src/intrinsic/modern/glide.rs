//! Going to each new value in a given time.

use super::super::components::{CONTINUOUS, Point};
use super::super::function::{Fault, Function, Inputs, Now, Outputs, domain};
use super::super::recalled::restore;
use super::super::spec::{Confidence, InputSpec, OutputSpec, Spec};
use super::super::stopwatch::Stopwatch;
use super::easing::Easing;
use super::{BOOLEAN_OUT, OURS, real, text};
use crate::value::Value;

pub(super) const TABLE: &[Spec] = &[Spec::clock(
    "DR_GLIDE",
    &[InputSpec::active(CONTINUOUS), real(1.0), text("in_out_cubic")],
    &[OutputSpec::of(CONTINUOUS), BOOLEAN_OUT],
    |_| Box::<Glide>::default(),
)
.says(
    "Goes from where it is to <1> in <2> seconds, by the course <3>, one of those of DR_EASE. \
             Output <1> at every tick on the way, the last exactly <1>; output <2> TRUE on arrival. A \
             message on the way sets out anew from there. The first message passes at once. A \
             negative time or an unknown course is reported and nothing moves.",
)
.known(Confidence::Project, OURS)
.example("<2> 2 | <3> 'in_quad' | <1> 0 | <1> 8 | @1 | @2 -> <1> 0 | <1> 2 | <1> 8 | <2> TRUE")];

#[derive(Default)]
struct Glide {
    watch: Stopwatch,
    way: Option<Way>,
}

#[derive(Clone, Copy)]
struct Way {
    from: Point,
    at: Point,
    to: Point,
    /// Microseconds since it set out; nothing once it has arrived.
    elapsed: Option<u64>,
}

impl Function for Glide {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let to = Point::of(inputs, 1)?;
        if inputs.number(2)? < 0.0 {
            return domain("a time to glide in is not negative");
        }
        Easing::named(inputs.text(3)?)?;
        if let Some(way) = self.way.as_mut().filter(|way| way.at.is_like(to)) {
            way.from = way.at;
            way.to = to;
            way.elapsed = Some(0);
        } else {
            self.way = Some(Way {
                from: to,
                at: to,
                to,
                elapsed: None,
            });
            outputs.send(1, to.value());
        }
        Ok(())
    }

    fn advance(&mut self, now: Now, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let passed = self.watch.lap(now);
        let Some(way) = &mut self.way else {
            return Ok(());
        };
        let Some(elapsed) = &mut way.elapsed else {
            return Ok(());
        };
        *elapsed += passed;
        let (secs, easing) = (inputs.number(2)?, Easing::named(inputs.text(3)?)?);
        let gone = *elapsed as f64 * 1e-6;
        if gone < secs {
            way.at = way.from.towards(way.to, easing.at(gone / secs));
            outputs.send(1, way.at.value());
        } else {
            way.at = way.to;
            way.elapsed = None;
            outputs.send(1, way.at.value());
            outputs.send(2, true);
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        let Some(way) = &self.way else {
            return Vec::new();
        };
        let mut state = [way.from, way.at, way.to].map(Point::value).to_vec();
        state.extend(way.elapsed.map(|elapsed| Value::Real(elapsed as f64)));
        state
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.way, None, state, |state| {
            let (from, at, to) = (state.point()?, state.point()?, state.point()?);
            let elapsed = if state.left() > 0 {
                Some(state.count()?)
            } else {
                None
            };
            let alike = from.is_like(to) && at.is_like(to);
            alike.then_some(Some(Way {
                from,
                at,
                to,
                elapsed,
            }))
        })
    }
}
