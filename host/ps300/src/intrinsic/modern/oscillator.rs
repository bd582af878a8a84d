//! What goes to and fro by itself.

use std::f64::consts::TAU;

use super::super::function::{Fault, Function, Inputs, Now, Outputs, domain};
use super::super::recalled::restore;
use super::super::spec::{Confidence, Spec};
use super::super::stopwatch::Stopwatch;
use super::{OURS, REAL_OUT, real, text, truth};
use crate::value::Value;

pub(super) const TABLE: &[Spec] = &[Spec::clock(
    "DR_OSCILLATOR",
    &[
        real(1.0),
        real(1.0),
        real(0.0),
        real(0.0),
        text("sine"),
        truth(true),
    ],
    &[REAL_OUT],
    |_| Box::<Oscillator>::default(),
)
.says(
    "At every tick while <6> is TRUE: <3> plus <2> times a wave of <1> hertz between -1 and \
             1, <4> degrees ahead. <5> names the wave: 'sine' and 'triangle' begin at 0 and rise, \
             'square' begins at 1, 'saw' at -1. A change of frequency makes no jump. Other waves are \
             reported.",
)
.known(Confidence::Project, OURS)
.example("<1> 0.5 | <2> 10 | <3> 100 | @0.5 | @1.5 -> <1> 110 | <1> 90")];

#[derive(Default)]
struct Oscillator {
    watch: Stopwatch,
    /// Of a turn, 0 to 1.
    turned: f64,
}

impl Function for Oscillator {
    fn fire(&mut self, _: &Inputs<'_>, _: &mut Outputs<'_>) -> Result<(), Fault> {
        Ok(()) // An input made active by SETUP CNESS sets nothing off.
    }

    fn advance(&mut self, now: Now, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let secs = self.watch.lap_secs(now);
        if secs == 0.0 || !inputs.boolean(6)? {
            return Ok(());
        }
        let turned = self.turned + inputs.number(1)? * secs;
        if !turned.is_finite() {
            return domain("the frequency is beyond all bounds");
        }
        self.turned = turned.rem_euclid(1.0);
        let wave = wave(
            inputs.text(5)?,
            (self.turned + inputs.number(4)? / 360.0).rem_euclid(1.0),
        )?;
        outputs.send(1, inputs.number(3)? + inputs.number(2)? * wave);
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        Some(self.turned)
            .filter(|turned| *turned != 0.0)
            .map(Value::Real)
            .into_iter()
            .collect()
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.turned, 0.0, state, |state| {
            state.real().filter(|turned| (0.0..=1.0).contains(turned))
        })
    }
}

fn wave(name: &str, turned: f64) -> Result<f64, Fault> {
    let is = |known: &str| name.eq_ignore_ascii_case(known);
    Ok(if is("sine") {
        (turned * TAU).sin()
    } else if is("triangle") {
        // 0 at 0, 1 at a quarter, -1 at three quarters.
        1.0 - 4.0 * ((turned + 0.25).rem_euclid(1.0) - 0.5).abs()
    } else if is("square") {
        if turned < 0.5 { 1.0 } else { -1.0 }
    } else if is("saw") {
        2.0 * turned - 1.0
    } else {
        return domain("the waves are 'sine', 'triangle', 'square' and 'saw'");
    })
}
