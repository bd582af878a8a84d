//! The judge: what the shafts of one bus really do, whatever registers, packets and reports say.

use crate::simulated::Line;
use device::Instant;
use device::servo::Member;
use firmware_sim::servo_bus::Servo;
use firmware_sim::{Firmware, ServoBus};

/// A shaft's speed is a difference of two positions a millisecond apart: rounding shows this much.
const SPEED_SLACK: f64 = 1.0 + 1e-6;
/// Two counts: one of the encoder's own, one that a goal is rounded by.
const PLACE_COUNTS: f64 = 2.0;
/// How long after torque came on the start is judged.
const START_SECS: f64 = 0.4;

/// One servo, and where its shaft was.
struct Shaft {
    joint: String,
    id: u8,
    rad_per_count: f64,
    centre: f64,
    range: [f64; 2],
    speed_max_rad_per_s: f64,
    acceleration_max_rad_per_s2: f64,
    /// Where it was when it was last seen, counts.
    counts: f64,
    torque: bool,
    on: Option<On>,
}

/// Torque has come on.
#[derive(Clone, Copy)]
struct On {
    since: Instant,
    /// Where the shaft stood before, counts.
    from: f64,
}

/// All shafts of a bus.
pub(super) struct Shafts {
    all: Vec<Shaft>,
    pub(super) turned_rad: f64,
    pub(super) start_counts: f64,
}

impl Shafts {
    pub(super) fn new<'a>(members: impl Iterator<Item = &'a Member>) -> Self {
        let of = |member: &Member| {
            let [low, high] = member.range_counts();
            let limits = member.limits();
            Shaft {
                joint: member.joint().to_owned(),
                id: member.id(),
                rad_per_count: member.servo().rad_per_count(),
                centre: f64::from(member.servo().centre_counts),
                range: [low as f64, high as f64],
                speed_max_rad_per_s: limits.velocity_max_rad_per_s(),
                acceleration_max_rad_per_s2: limits.acceleration_max_rad_per_s2(),
                counts: f64::NAN,
                torque: false,
                on: None,
            }
        };
        Self {
            all: members.map(of).collect(),
            turned_rad: 0.0,
            start_counts: 0.0,
        }
    }

    /// Looks at every shaft, and says what is wrong.
    pub(super) fn look(&mut self, line: &Line<ServoBus>, now: Instant, wrong: &mut Vec<String>) {
        let Self {
            all,
            turned_rad,
            start_counts,
        } = self;
        line.with(|bus, now_us| {
            // Nobody else may have looked since: lets time pass for the servos.
            bus.receive(now_us, &[]);
            for shaft in all {
                let Some(servo) = bus.servo(shaft.id) else {
                    continue;
                };
                let before = shaft.counts;
                let fresh = shaft.take(servo, now);
                if shaft.torque && before.is_finite() {
                    *turned_rad += (shaft.counts - before).abs() * shaft.rad_per_count;
                }
                if let Some(on) = shaft.on.filter(|_| fresh) {
                    *start_counts = start_counts.max((shaft.counts - on.from).abs());
                }
                shaft.judge(now, wrong);
            }
        });
    }

    /// Speeds over the whole run, and torque at its end.
    pub(super) fn finish(&self, line: &Line<ServoBus>, wrong: &mut Vec<String>) -> (f64, u64) {
        line.with(|bus, _| {
            let (mut ratio, mut torque_ons) = (0.0_f64, 0);
            for shaft in &self.all {
                let Some(servo) = bus.servo(shaft.id) else {
                    continue;
                };
                let fastest = servo.counters().speed_max_rad_per_s;
                torque_ons += servo.counters().torque_ons;
                ratio = ratio.max(fastest / shaft.speed_max_rad_per_s);
                if fastest > shaft.speed_max_rad_per_s * SPEED_SLACK {
                    let most = shaft.speed_max_rad_per_s;
                    wrong.push(format!(
                        "{}: turned at {fastest:.4} rad/s, {most:.4} allowed",
                        shaft.joint
                    ));
                }
                if servo.is_connected() && servo.torque_is_on() {
                    wrong.push(format!("{}: still has torque when all is over", shaft.joint));
                }
            }
            (ratio, torque_ons)
        })
    }
}

impl Shaft {
    /// Where it is now; whether torque has come on since the last look.
    fn take(&mut self, servo: &Servo, now: Instant) -> bool {
        let counts = servo.true_position_rad() / self.rad_per_count + self.centre;
        let torque = servo.is_connected() && servo.torque_is_on();
        let fresh = torque && !self.torque;
        if fresh {
            let from = if self.counts.is_finite() {
                self.counts
            } else {
                counts
            };
            self.on = Some(On { since: now, from });
        }
        if !torque {
            self.on = None;
        }
        (self.counts, self.torque) = (counts, torque);
        fresh
    }

    fn judge(&self, now: Instant, wrong: &mut Vec<String>) {
        let Some(on) = self.on else { return };
        let secs = now.since(on.since).as_secs_f64();
        let way = (self.counts - on.from).abs();
        // Between two looks more may have gone by; the speed over the whole run covers those.
        let may = PLACE_COUNTS + 0.5 * self.acceleration_max_rad_per_s2 * secs * secs / self.rad_per_count;
        if secs <= START_SECS && way > may {
            wrong.push(format!(
                "{:.3} s, {}: {way:.1} counts from its place {secs:.3} s after torque came on, {may:.1} allowed",
                now.as_secs_f64(),
                self.joint
            ));
        }
        let [low, high] = self.range;
        let [low, high] = [low.min(on.from) - PLACE_COUNTS, high.max(on.from) + PLACE_COUNTS];
        if self.counts < low || self.counts > high {
            wrong.push(format!(
                "{:.3} s, {}: at {:.1} counts, outside {low:.1} to {high:.1}",
                now.as_secs_f64(),
                self.joint,
                self.counts
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulated::{bus_of, members};
    use device::servo::framing::dynamixel2;
    use device::{Clock, Transport, VirtualClock};
    use firmware_sim::servo_bus::BusOptions;
    use std::sync::Arc;
    use std::time::Duration;

    /// What a program without any care does: torque over whatever goal there is, then goals.
    fn careless(goals: &[i32], until_ms: u64) -> Vec<String> {
        let clock = VirtualClock::new();
        let mut line = Line::new(bus_of(1, BusOptions::default()), Arc::new(clock.clone()));
        let members = members(1);
        let mut shafts = Shafts::new(members.iter());
        let mut wrong = Vec::new();
        shafts.look(&line, clock.now(), &mut wrong);
        let mut bytes = Vec::new();
        dynamixel2::sync_write(&mut bytes, 64, [(1, [1_u8])]).expect("short");
        for goal in goals {
            dynamixel2::sync_write(&mut bytes, 116, [(1, goal.to_le_bytes())]).expect("short");
        }
        line.write(&bytes).expect("it is there");
        for _ in 0..until_ms / 5 {
            clock.advance(Duration::from_millis(5));
            shafts.look(&line, clock.now(), &mut wrong);
        }
        shafts.finish(&line, &mut wrong);
        wrong
    }

    #[test]
    fn the_judge_sees_a_lunge_a_place_that_was_left_a_range_that_was_and_torque_that_stays() {
        assert_eq!(
            careless(&[2048], 200),
            ["joint 1: still has torque when all is over"]
        );
        let all = careless(&[3800], 900).join("\n");
        for what in ["from its place", "outside", "turned at", "still has torque"] {
            assert!(all.contains(what), "{what}: {all}");
        }
    }
}
