//! A tap on the line to a simulated bus: sees every byte the host writes as the servos will, compares goals with
//! where the shafts really are, and makes the line fail when told to.

use super::instruction::writes;
use device::transport::{Boundary, Transport, TransportError};
use device::{Clock, Instant};
use dialrig_tests::simulated::Line;
use firmware_sim::ServoBus;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Goal PWM to Goal Velocity, and Goal Position. Source: control tables of the X series.
const OTHER_GOALS: [u16; 2] = [100, 107];
const GOAL: u16 = 116;
const TORQUE: u16 = 64;
/// A reading may be so old when a goal is pinned to it: two exchanges of a few servos with slack.
const PIN_AGE_SECS: f64 = 0.05;
/// A goal written less than this ago may still be on the wire: fifty bytes at 1 Mbaud.
const WIRE_SECS: f64 = 0.0005;

/// What a joint may do, in its servo's counts.
#[derive(Clone, Debug)]
pub(crate) struct Bounds {
    pub(crate) joint: String,
    pub(crate) centre: f64,
    pub(crate) rad_per_count: f64,
    pub(crate) range: [f64; 2],
    pub(crate) speed_max: f64,
}

/// The line fails at one operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Failing {
    /// Once, with an error; the next operation works.
    Once,
    /// From then on: the cable is out.
    Unplugged,
}

/// What the tap has seen and what it is to do; shared with the test.
#[derive(Debug, Default)]
pub(crate) struct Seen {
    /// Reads and writes so far.
    pub(crate) operations: u64,
    /// Which of them fails, counted from 1, and how.
    pub(crate) fail: Option<(u64, Failing)>,
    /// Bytes that the host hears before anything else.
    pub(crate) garbage: Vec<u8>,
    /// Goals written so far.
    pub(crate) goals: u64,
    /// What was wrong with goals.
    pub(crate) wrong: Vec<String>,
    last: BTreeMap<u8, (Instant, i32)>,
}

/// See the module.
pub(crate) struct Tap {
    line: Line<ServoBus>,
    clock: Arc<dyn Clock>,
    bounds: Arc<BTreeMap<u8, Bounds>>,
    seen: Arc<Mutex<Seen>>,
}

pub(crate) fn lock(seen: &Mutex<Seen>) -> MutexGuard<'_, Seen> {
    seen.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Tap {
    pub(crate) fn new(
        line: Line<ServoBus>,
        clock: Arc<dyn Clock>,
        bounds: Arc<BTreeMap<u8, Bounds>>,
        seen: Arc<Mutex<Seen>>,
    ) -> Self {
        Self {
            line,
            clock,
            bounds,
            seen,
        }
    }

    /// Counts one operation; it may be the one that fails.
    fn operate(&self) -> Result<(), TransportError> {
        let mut seen = lock(&self.seen);
        seen.operations += 1;
        let address = "sim:tapped".to_owned();
        match seen.fail {
            Some((at, Failing::Once)) if at == seen.operations => {
                let source = std::io::Error::other("made to fail");
                Err(TransportError::Io { address, source })
            }
            Some((at, Failing::Unplugged)) if at <= seen.operations => Err(TransportError::Gone { address }),
            _ => Ok(()),
        }
    }

    /// Looks at what packets do to goals and torque.
    fn judge(&self, bytes: &[u8]) {
        let now = self.clock.now();
        for written in writes(bytes) {
            let mut seen = lock(&self.seen);
            if written.touches(OTHER_GOALS[0], OTHER_GOALS[1]) {
                let id = written.id;
                seen.wrong
                    .push(format!("servo {id}: a goal other than a position"));
            }
            if written.touches(TORQUE, TORQUE) && written.data.first() != Some(&0) {
                self.judge_torque(&mut seen, now, written.id);
            }
            if !written.touches(GOAL, GOAL + 3) {
                continue;
            }
            if let (Some(goal), Some(bounds)) = (written.value_at(GOAL), self.bounds.get(&written.id)) {
                self.judge_goal(&mut seen, now, written.id, goal, bounds);
            } else {
                let id = written.id;
                seen.wrong
                    .push(format!("servo {id}: part of a goal, or nobody's"));
            }
        }
    }

    /// The shaft of a servo as it is, in counts, and its goal and torque; none: there is no such servo.
    fn shaft(&self, id: u8, bounds: &Bounds) -> Option<Shaft> {
        self.line.with(|bus, _| {
            let servo = bus.servo(id)?;
            Some(Shaft {
                counts: servo.true_position_rad() / bounds.rad_per_count + bounds.centre,
                counts_per_s: servo.true_velocity_rad_per_s() / bounds.rad_per_count,
                goal: servo.register("Goal Position")?,
                torque: servo.torque_is_on(),
            })
        })
    }

    /// Torque may only come on over a goal that is where the shaft is.
    fn judge_torque(&self, seen: &mut Seen, now: Instant, id: u8) {
        let Some((bounds, shaft)) = self
            .bounds
            .get(&id)
            .and_then(|bounds| Some((bounds, self.shaft(id, bounds)?)))
        else {
            seen.wrong.push(format!("servo {id}: torque for nobody"));
            return;
        };
        let under_way = seen
            .last
            .get(&id)
            .filter(|(at, _)| now.since(*at).as_secs_f64() < WIRE_SECS);
        let goal = under_way.map_or(shaft.goal, |(_, goal)| i64::from(*goal)) as f64;
        if !shaft.torque && !shaft.is_at(goal) {
            seen.wrong.push(format!(
                "{:.4} s, {}: torque over goal {goal}, {shaft:?}",
                now.as_secs_f64(),
                bounds.joint
            ));
        }
    }

    fn judge_goal(&self, seen: &mut Seen, now: Instant, id: u8, goal: i32, bounds: &Bounds) {
        let Some(shaft) = self.shaft(id, bounds) else {
            return;
        };
        seen.goals += 1;
        let counts = f64::from(goal);
        let before = seen.last.insert(id, (now, goal));
        let stepped = before.is_some_and(|(at, before)| {
            let reach = bounds.speed_max * now.since(at).as_secs_f64();
            (counts - f64::from(before)).abs() <= reach + 1.0
        });
        // A goal is pinned to the shaft, or a step from the one before it. A servo that has lost its torque is
        // still led on until that is found out; it gets torque again only over a goal where it is.
        if !shaft.is_at(counts) && !stepped {
            seen.wrong.push(format!(
                "{:.4} s, {}: goal {goal} after {before:?}, {shaft:?}",
                now.as_secs_f64(),
                bounds.joint
            ));
        }
        // Inside the range; a shaft that stands outside is only led inwards.
        let [low, high] = bounds.range;
        let inside = counts >= low.min(shaft.counts) - 1.0 && counts <= high.max(shaft.counts) + 1.0;
        if !inside {
            seen.wrong.push(format!(
                "{:.4} s, {}: goal {goal} leaves the range {low} to {high}",
                now.as_secs_f64(),
                bounds.joint
            ));
        }
    }
}

/// A servo as nobody on the wire can see it.
#[derive(Debug)]
struct Shaft {
    counts: f64,
    counts_per_s: f64,
    goal: i64,
    torque: bool,
}

impl Shaft {
    /// Within one step of the encoder, and what it turned since it was measured.
    fn is_at(&self, goal: f64) -> bool {
        (goal - self.counts).abs() <= 1.0 + self.counts_per_s.abs() * PIN_AGE_SECS
    }
}

impl Transport for Tap {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        self.operate()?;
        let mut seen = lock(&self.seen);
        if !seen.garbage.is_empty() {
            let count = seen.garbage.len().min(buffer.len());
            for (place, byte) in buffer.iter_mut().zip(seen.garbage.drain(..count)) {
                *place = byte;
            }
            return Ok(count);
        }
        drop(seen);
        self.line.read(buffer)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.operate()?;
        self.judge(bytes);
        self.line.write(bytes)
    }

    fn set_baud(&mut self, baud: u32) -> Result<(), TransportError> {
        self.line.set_baud(baud)
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        self.line.wait(clock, until);
    }

    fn ready(&mut self) -> bool {
        self.line.ready()
    }
}
