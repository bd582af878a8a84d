//! Controls that the host can move as well as the hand: motor faders, encoders that keep a value, faders on a screen.
//! Two rules: never against a hand, and never back what the hand has just said.
//!
//! Source: `docs/protocols/midi.md`, "Motors" (Mackie's faders: touch note, then drive after release).

use crate::clock::Instant;
use std::time::Duration;

/// A control without a touch sensor is in somebody's hand for so long after it last said something. Ours: longer than
/// the pauses of a slow hand, shorter than one notices.
const HELD_FOR: Duration = Duration::from_millis(300);

/// What one such control shows and should.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Motor {
    /// It says when it is touched, so that silence is no riddle.
    senses: bool,
    touched: bool,
    /// It has said something since the last look at the clock.
    moved: bool,
    held_until: Option<Instant>,
    wanted: Option<i32>,
    shown: Option<i32>,
}

/// All of a device, numbered as its axes.
#[derive(Debug, Default)]
pub(super) struct Motors {
    all: Vec<Motor>,
}

impl Motors {
    /// For so many axes.
    pub(super) fn new(axes: u16) -> Self {
        Self {
            all: vec![Motor::default(); usize::from(axes)],
        }
    }

    /// The host wants it at `value`.
    pub(super) fn want(&mut self, axis: u16, value: i32) {
        if let Some(motor) = self.all.get_mut(usize::from(axis)) {
            motor.wanted = Some(value);
        }
    }

    /// The hand has taken it to `value`, as the device has said. That is what it shows now, unless `forgets`: then it
    /// goes back by itself when it is let go, and must be told where it was taken.
    pub(super) fn moved(&mut self, axis: u16, value: i32, forgets: bool) {
        if let Some(motor) = self.all.get_mut(usize::from(axis)) {
            motor.moved = true;
            motor.shown = if forgets { None } else { Some(value) };
        }
    }

    /// A finger came or went.
    pub(super) fn touched(&mut self, axis: u16, down: bool) {
        if let Some(motor) = self.all.get_mut(usize::from(axis)) {
            motor.senses = true;
            motor.touched = down;
        }
    }

    /// The device is new: it shows nothing we know of, and nobody holds it.
    pub(super) fn forget(&mut self) {
        for motor in &mut self.all {
            motor.shown = None;
            motor.touched = false;
            motor.held_until = None;
            motor.moved = false;
        }
    }

    /// Gives `send` every value that is wanted, not shown, and not in a hand at `now`.
    pub(super) fn due(&mut self, now: Instant, mut send: impl FnMut(u16, i32)) {
        for (axis, motor) in (0..).zip(&mut self.all) {
            if std::mem::take(&mut motor.moved) && !motor.senses {
                motor.held_until = Some(now.after(HELD_FOR));
            }
            if motor.held_until.is_some_and(|until| until <= now) {
                motor.held_until = None;
            }
            if motor.touched || motor.held_until.is_some() || motor.wanted == motor.shown {
                continue;
            }
            if let Some(value) = motor.wanted {
                motor.shown = Some(value);
                send(axis, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at_ms(ms: u64) -> Instant {
        Instant::ZERO.after(Duration::from_millis(ms))
    }

    fn due(motors: &mut Motors, ms: u64) -> Vec<(u16, i32)> {
        let mut sent = Vec::new();
        motors.due(at_ms(ms), |axis, value| sent.push((axis, value)));
        sent
    }

    #[test]
    fn a_motor_waits_for_the_finger_to_go_and_is_told_where_it_was_taken() {
        let mut motors = Motors::new(2);
        motors.want(1, 500);
        assert_eq!(due(&mut motors, 0), [(1, 500)]);
        motors.touched(1, true);
        motors.moved(1, 800, true);
        motors.want(1, 400);
        assert_eq!(due(&mut motors, 10_000), []);
        motors.touched(1, false);
        assert_eq!(due(&mut motors, 10_001), [(1, 400)]);
        assert_eq!(due(&mut motors, 10_002), []);
        // Taken somewhere and left there: told all the same, or it runs back.
        motors.touched(1, true);
        motors.moved(1, 600, true);
        motors.want(1, 600);
        motors.touched(1, false);
        assert_eq!(due(&mut motors, 10_003), [(1, 600)]);
    }

    #[test]
    fn without_a_sensor_a_hand_is_gone_after_a_while_and_is_not_echoed() {
        let mut motors = Motors::new(1);
        motors.moved(0, 10, false);
        motors.want(0, 10);
        assert_eq!(due(&mut motors, 0), []);
        motors.want(0, 12);
        assert_eq!(due(&mut motors, 299), []);
        assert_eq!(due(&mut motors, 300), [(0, 12)]);
        motors.forget();
        assert_eq!(due(&mut motors, 301), [(0, 12)], "a new device is told again");
    }

    proptest! {
        /// Whatever happens: nothing is driven while touched, nothing is sent twice, and in the end what is wanted is
        /// shown.
        #[test]
        fn never_against_a_hand(doings in prop::collection::vec((0u8..4, 0i32..50, 1u64..400), 0..60)) {
            let mut motors = Motors::new(1);
            let (mut now, mut touched, mut wanted, mut last) = (0, false, None, None);
            for (what, value, wait_ms) in doings {
                match what {
                    0 => {
                        motors.want(0, value);
                        wanted = Some(value);
                    }
                    1 => {
                        touched = !touched;
                        motors.touched(0, touched);
                    }
                    2 if touched => {
                        motors.moved(0, value, true);
                        last = None;
                    }
                    _ => {}
                }
                now += wait_ms;
                for (_, sent) in due(&mut motors, now) {
                    prop_assert!(!touched);
                    prop_assert_ne!(Some(sent), last);
                    prop_assert_eq!(Some(sent), wanted);
                    last = Some(sent);
                }
            }
            motors.touched(0, false);
            for (_, sent) in due(&mut motors, now + 1000) {
                last = Some(sent);
            }
            prop_assert_eq!(last, wanted);
        }
    }
}
