//! Motor, gear, heat and load behind one servo: just enough that a driver's mistakes show.
//!
//! The horn follows the trajectory through two equal first-order lags, which is a critically damped second
//! order system that cannot overshoot, so the true speed is an average of past trajectory speeds and never
//! exceeds them; before that, the motor's own top speed bounds what it can follow. Positions are encoder
//! counts of the shaft, whatever the servo's registers make of them. All numbers here are ours, chosen to
//! be plausible for a servo of a few watts.

/// Plant step in seconds; one in nanoseconds is `STEP_NS`.
pub(super) const STEP_SECS: f64 = 0.001;
/// Plant step.
pub(super) const STEP_NS: u64 = 1_000_000;
/// Rate of each lag: 20 ms in all behind a moving goal.
const BANDWIDTH_PER_SEC: f64 = 100.0;
/// Distance behind the trajectory at which the motor pulls with all it has.
const FULL_EFFORT_COUNTS: f64 = 180.0;
/// Time constant of heating and cooling.
const HEAT_SECS: f64 = 180.0;
/// How much hotter than the room a motor gets at full effort.
const HEAT_RISE_C: f64 = 70.0;
/// The room.
const AMBIENT_C: f64 = 25.0;

/// State of the moving part.
#[derive(Clone, Debug)]
pub(super) struct Plant {
    /// True shaft position in counts.
    pub(super) position: f64,
    /// True shaft speed in counts per second.
    pub(super) velocity: f64,
    /// −1 to 1 of what the motor can pull.
    pub(super) effort: f64,
    pub(super) temperature_c: f64,
    /// Steady load from outside, −1 to 1 of what the motor can pull.
    pub(super) load: f64,
    /// Does not move under its own power.
    pub(super) stuck: bool,
    /// Top speed of the motor, counts per second.
    speed_max: f64,
    /// What the motor can follow, then the first lag.
    followed: f64,
    lagged: f64,
    lag_share: f64,
}

impl Plant {
    pub(super) fn new(position: f64, speed_max: f64) -> Self {
        Self {
            position,
            velocity: 0.0,
            effort: 0.0,
            temperature_c: AMBIENT_C,
            load: 0.0,
            stuck: false,
            speed_max,
            followed: position,
            lagged: position,
            lag_share: 1.0 - (-BANDWIDTH_PER_SEC * STEP_SECS).exp(),
        }
    }

    /// One step under power, towards the trajectory's `target`.
    pub(super) fn follow(&mut self, target: f64) {
        let reach = self.speed_max * STEP_SECS;
        self.followed += (target - self.followed).clamp(-reach, reach);
        self.lagged += self.lag_share * (self.followed - self.lagged);
        let step = (self.lag_share * (self.lagged - self.position)).clamp(-reach, reach);
        let step = if self.stuck { 0.0 } else { step };
        self.position += step;
        self.velocity = step / STEP_SECS;
        self.effort = ((self.followed - self.position) / FULL_EFFORT_COUNTS + self.load).clamp(-1.0, 1.0);
        self.warm();
    }

    /// One step without power, moved by `drift_per_sec` counts.
    pub(super) fn coast(&mut self, drift_per_sec: f64) {
        let drift = if self.stuck { 0.0 } else { drift_per_sec };
        self.position += drift * STEP_SECS;
        self.velocity = drift;
        self.effort = 0.0;
        self.settle();
        self.warm();
    }

    /// A hand moves the horn by `counts`. Under power the motor pulls it back.
    pub(super) fn push(&mut self, counts: f64, powered: bool) {
        self.position += counts;
        if !powered {
            self.settle();
        }
    }

    /// Forgets the trajectory: the next one begins where the shaft is.
    pub(super) fn settle(&mut self) {
        self.followed = self.position;
        self.lagged = self.position;
    }

    /// The encoder loses count of `counts` whole turns' worth.
    pub(super) fn recount(&mut self, position: f64) {
        self.position = position;
        self.settle();
    }

    fn warm(&mut self) {
        let goal = AMBIENT_C + HEAT_RISE_C * self.effort * self.effort;
        self.temperature_c += (goal - self.temperature_c) * STEP_SECS / HEAT_SECS;
    }
}
