//! Absolute controls on values that something else moves too: how a fader gets hold of its value without a jump.
//!
//! Source of the pick-up rule: Mixxx, `src/controllers/softtakeover.cpp`: its distances, its time, and that the
//! very first message never takes hold.

use super::super::function::{Fault, Function, Inputs, Now, Outputs, domain};
use super::super::recalled::{optional, restore};
use super::super::spec::{Confidence, InputSpec, Spec};
use super::super::stopwatch::Stopwatch;
use super::{BOOLEAN_OUT, NUMBER, REAL_OUT, real, text};
use crate::value::{Kinds, Value};

/// Mixxx: closer than this share of the range is near.
const NEAR: f64 = 3.0 / 128.0;
/// Mixxx: two messages within this time are one movement.
const MOVEMENT_SECS: f64 = 0.05;

pub(super) const TABLE: &[Spec] = &[Spec::clock(
    "DR_PICKUP",
    &[
        NUMBER,
        InputSpec::required(Kinds::NUMBER),
        text("pickup"),
        real(NEAR),
        real(1.0),
        real(0.0),
        real(MOVEMENT_SECS),
    ],
    &[REAL_OUT, BOOLEAN_OUT],
    |_| Box::<Pickup>::default(),
)
.says(
    "Lets an absolute control <1> set a value that others change too: they tell it at <2>, \
             and output <1> is the value it sets, between <6> and <5>. By the way <3> names: \
             'pickup', it takes hold once it comes within <4> of the range of the value, or passes it \
             quicker than <7> seconds after it last held it; 'scale', the value goes with it so that \
             both reach the end of the range together; 'relative', it goes as far as the control; \
             'jump', it goes to the control. The first message never sets a value, save with 'jump'. \
             Output <2> whether the control has hold, when that changes. An empty range or an unknown \
             way is reported.",
)
.known(
    Confidence::Project,
    "pick-up, its distance and time: Mixxx, src/controllers/softtakeover.cpp; the other ways \
             usual in controllers",
)
.example(
    "<2> 0.5 | <1> 0 | <1> 0.3 | <1> 0.49 | <1> 0.6 -> <2> FALSE | <1> 0.49 | <2> TRUE | <1> \
             0.6",
)];

#[derive(Default)]
struct Pickup {
    watch: Stopwatch,
    memory: Memory,
}

#[derive(Default)]
struct Memory {
    /// The value, once the control has set it; else what is at <2>.
    value: Option<f64>,
    /// Where the control was, whether or not that was accepted.
    control: Option<f64>,
    /// Microseconds since it last set the value.
    since: Option<u64>,
    /// What output <2> sent last.
    holds: Option<bool>,
}

impl Function for Pickup {
    fn constant_set(&mut self, number: u8) {
        if number == 2 {
            self.memory.value = None;
        }
    }

    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let (upper, lower) = (inputs.number(5)?, inputs.number(6)?);
        if lower >= upper {
            return domain("a range has its upper end above its lower");
        }
        let control = inputs.number(1)?.clamp(lower, upper);
        let memory = &mut self.memory;
        let known = memory.value.filter(|_| inputs.is_constant(2));
        let value = known.map_or_else(|| inputs.number(2), Ok)?;
        let before = memory.control;
        let way = inputs.text(3)?;
        let is = |known: &str| way.eq_ignore_ascii_case(known);
        let set = if is("pickup") {
            let near = inputs.number(4)? * (upper - lower);
            let quick =
                memory.since.map_or(f64::INFINITY, |since| since as f64 * 1e-6) <= inputs.number(7)?;
            let takes = before.is_some_and(|before| takes_hold(value, before, control, near, quick));
            takes.then_some(control)
        } else if is("scale") {
            before.map(|before| scaled(value, before, control, [lower, upper]))
        } else if is("relative") {
            before.map(|before| (value + control - before).clamp(lower, upper))
        } else if is("jump") {
            Some(control)
        } else {
            return domain("the ways of taking hold are 'pickup', 'scale', 'relative' and 'jump'");
        };
        memory.control = Some(control);
        if let Some(set) = set {
            memory.value = Some(set);
            memory.since = Some(0);
            outputs.send(1, set);
        }
        if memory.holds.replace(set.is_some()) != Some(set.is_some()) {
            outputs.send(2, set.is_some());
        }
        Ok(())
    }

    fn advance(&mut self, now: Now, _: &Inputs<'_>, _: &mut Outputs<'_>) -> Result<(), Fault> {
        let passed = self.watch.lap(now);
        if let Some(since) = &mut self.memory.since {
            *since += passed;
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        let Memory {
            value,
            control,
            since,
            holds: Some(holds),
        } = self.memory
        else {
            return Vec::new(); // No message came yet.
        };
        let since = since.map(|since| since as f64);
        vec![
            optional(value),
            optional(control),
            optional(since),
            Value::Boolean(holds),
        ]
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.memory, Memory::default(), state, |state| {
            let (mut memory, mut since) = (Memory::default(), None);
            state.optional(&mut memory.value)?;
            state.optional(&mut memory.control)?;
            state.optional(&mut since)?;
            memory.since = since.map(|since| since.max(0.0) as u64);
            memory.holds = Some(state.boolean()?);
            Some(memory)
        })
    }
}

/// Whether a control that went from `before` to `control` takes hold of `value`: when it comes near, and when a
/// quick movement leads through the value or away from it.
fn takes_hold(value: f64, before: f64, control: f64, near: f64, quick: bool) -> bool {
    let is_near = |at: f64| (at - value).abs() <= near;
    let passes = (before - value) * (control - value) < 0.0;
    is_near(control) || (quick && (passes || is_near(before)))
}

/// The value moved so that what is left of its way to the end is what is left of the control's.
fn scaled(value: f64, before: f64, control: f64, [lower, upper]: [f64; 2]) -> f64 {
    let end = if control > before { upper } else { lower };
    let left = end - before;
    if left == 0.0 {
        value
    } else {
        end - (end - value) * (end - control) / left
    }
}

#[cfg(test)]
mod tests {
    use super::takes_hold;

    /// A row of Mixxx's table; nothing where it does not matter.
    struct Row {
        passes: Option<bool>,
        was_near: Option<bool>,
        is_near: bool,
        quick: Option<bool>,
        takes: bool,
    }

    const fn row(
        passes: Option<bool>,
        was_near: Option<bool>,
        is_near: bool,
        quick: Option<bool>,
        takes: bool,
    ) -> Row {
        Row {
            passes,
            was_near,
            is_near,
            quick,
            takes,
        }
    }

    const TABLE: [Row; 6] = [
        row(None, None, true, None, true),
        row(Some(true), None, false, Some(true), true),
        row(Some(true), None, false, Some(false), false),
        row(Some(false), Some(true), false, Some(true), true),
        row(Some(false), Some(true), false, Some(false), false),
        row(Some(false), Some(false), false, None, false),
    ];

    #[test]
    fn every_case_of_the_table_is_decided_as_it_says() {
        let (value, near) = (0.5, 0.1);
        let places = [0.1, 0.45, 0.55, 0.9];
        let is_near = |at: f64| (at - value).abs() <= near;
        for before in places {
            for control in places {
                for quick in [false, true] {
                    let passes = (before < value) != (control < value);
                    let fits = |row: &&Row| {
                        row.is_near == is_near(control)
                            && row.passes.is_none_or(|wanted| wanted == passes)
                            && row.was_near.is_none_or(|wanted| wanted == is_near(before))
                            && row.quick.is_none_or(|wanted| wanted == quick)
                    };
                    let rows: Vec<_> = TABLE.iter().filter(fits).collect();
                    assert_eq!(rows.len(), 1, "{before} {control} {quick}");
                    let takes = takes_hold(value, before, control, near, quick);
                    assert_eq!(takes, rows[0].takes, "{before} {control} {quick}");
                }
            }
        }
    }
}
