//! Motor, gear, heat and load behind one servo.
//!
//! Two bodies are to be had. `ideal` follows the servo's trajectory smoothly and never exceeds it: whatever is
//! wrong in its motion is the driver's doing. `real` is an electric motor with its torque, inertia and friction,
//! moved by the position loop of the servo's firmware. Around both stand what pulls at the horn (`outside`),
//! what the winding does to the temperature (`heat`), end stops and the play of the gear. Positions are encoder
//! counts of the shaft, whatever the servo's registers make of them. Model and sources: `docs/simulator.md`.

mod heat;
mod ideal;
mod motor;
mod outside;
mod real;

pub use motor::PlantKind;
pub use outside::Hand;

pub(super) use motor::{MotorFacts, Printed};

use heat::Heat;
use ideal::Ideal;
use outside::{Grip, Load};
use real::Real;

/// Plant step in seconds; one in nanoseconds is `STEP_NS`.
pub(super) const STEP_SECS: f64 = 0.001;
/// Plant step.
pub(super) const STEP_NS: u64 = 1_000_000;
/// How fast a load takes the horn through the play of the gear, radians a second. Ours.
const FALL_RAD_PER_S: f64 = 2.0;

/// What the firmware asks of the motor for one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Order {
    /// Be on the trajectory: counts, counts per second.
    Position {
        counts: f64,
        velocity: f64,
        gains: Gains,
    },
    /// Turn at this speed: counts per second; `counts` is where that would have led.
    Speed { counts: f64, velocity: f64 },
    /// Draw this share of the stall current.
    Current { counts: f64, share: f64 },
    /// This share of the supply.
    Duty { counts: f64, share: f64 },
}

/// The position loop, per count: duty for a count of error, for a count a second of the error's change, for a
/// count second of its sum, for a count a second of the trajectory; and the most it may ask for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Gains {
    pub(super) p: f64,
    pub(super) i: f64,
    pub(super) d: f64,
    pub(super) feed_forward: f64,
    /// Duty that any error at all is worth.
    pub(super) punch: f64,
    pub(super) duty_max: f64,
}

/// The moving part with its surroundings.
#[derive(Clone, Debug)]
pub(super) struct Plant {
    /// True position of the horn in counts.
    pub(super) position: f64,
    /// True speed of the horn in counts per second.
    pub(super) velocity: f64,
    /// −1 to 1 of what the motor can pull.
    pub(super) effort: f64,
    /// Share of the supply that the motor gets, −1 to 1.
    pub(super) duty: f64,
    /// How near it is to standing still under all it has, 0 to 1.
    pub(super) strain: f64,
    /// What it draws from the supply, amperes.
    pub(super) supply_a: f64,
    pub(super) heat: Heat,
    pub(super) load: Load,
    /// Does not move under its own power nor by a hand.
    pub(super) stuck: bool,
    pub(super) backlash_rad: f64,
    pub(super) jitter_counts: f64,
    /// Where the horn meets an end, counts.
    pub(super) stops: Option<[f64; 2]>,
    pub(super) motor: MotorFacts,
    rad_per_count: f64,
    centre: f64,
    grip: Option<Grip>,
    body: Body,
    /// Horn before motor by the play of the gear, counts.
    play: f64,
    noise: f64,
    random: fastrand::Rng,
}

#[derive(Clone, Debug)]
enum Body {
    Ideal(Ideal),
    Real(Real),
}

impl Plant {
    pub(super) fn new(
        position: f64,
        centre: f64,
        rad_per_count: f64,
        motor: MotorFacts,
        kind: PlantKind,
    ) -> Self {
        let speed_max = motor.no_load_rad_per_s / rad_per_count;
        Self {
            position,
            velocity: 0.0,
            effort: 0.0,
            duty: 0.0,
            strain: 0.0,
            supply_a: motor.standby_a,
            heat: Heat::default(),
            load: Load::default(),
            stuck: false,
            backlash_rad: 0.0,
            jitter_counts: 0.0,
            stops: None,
            body: match kind {
                PlantKind::Ideal => Body::Ideal(Ideal::new(position, speed_max)),
                PlantKind::Real => Body::Real(Real::new(position, &motor)),
            },
            motor,
            rad_per_count,
            centre,
            grip: None,
            play: 0.0,
            noise: 0.0,
            random: fastrand::Rng::with_seed(0),
        }
    }

    /// Decides what the encoder's noise is.
    pub(super) fn seed(&mut self, seed: u64) {
        self.random = fastrand::Rng::with_seed(seed);
    }

    /// What the encoder reads, counts.
    pub(super) fn encoder(&self) -> f64 {
        self.position + self.noise
    }

    /// One step under power, at `volts`.
    pub(super) fn drive(&mut self, order: Order, volts: f64) {
        let before = self.shaft();
        let outside_nm = self.outside_nm();
        let (encoder, inertia) = (self.encoder(), self.load.inertia_kg_m2());
        let (stuck, rad_per_count) = (self.stuck, self.rad_per_count);
        match &mut self.body {
            Body::Ideal(ideal) => {
                ideal.follow(order.counts(), stuck);
                let effort = ideal.effort() - outside_nm / self.motor.stall_nm;
                self.effort = effort.clamp(-1.0, 1.0);
                (self.duty, self.strain) = (self.effort, self.effort.abs());
                self.supply_a = self.motor.standby_a + self.effort.abs() * self.motor.stall_a;
            }
            Body::Real(real) => {
                let outcome = real.drive(order, encoder, volts, outside_nm, inertia, stuck, rad_per_count);
                self.effort = (outcome.amperes / self.motor.stall_a).clamp(-1.0, 1.0);
                self.duty = outcome.duty;
                self.strain = outcome.amperes.abs() * self.motor.ohms / volts.max(1.0);
                self.supply_a = self.motor.standby_a + (outcome.amperes * outcome.duty).max(0.0);
            }
        }
        self.moved_from(before, outside_nm);
    }

    /// One step without power, moved by `drift_per_sec` counts.
    pub(super) fn coast(&mut self, drift_per_sec: f64) {
        let before = self.shaft();
        let outside_nm = self.outside_nm();
        let guided = self.grip.as_ref().and_then(Grip::place);
        let (inertia, stuck) = (self.load.inertia_kg_m2(), self.stuck);
        match &mut self.body {
            _ if stuck => {}
            Body::Ideal(ideal) => {
                let pulled = self
                    .grip
                    .as_ref()
                    .map_or(0.0, |_| outside_nm / self.motor.stall_nm);
                let drift = drift_per_sec + pulled.clamp(-1.0, 1.0) * ideal.speed_max;
                ideal.place(guided.unwrap_or(ideal.position + drift * STEP_SECS));
            }
            Body::Real(real) if drift_per_sec != 0.0 && self.grip.is_none() => {
                real.place(real.position + drift_per_sec * STEP_SECS, drift_per_sec);
            }
            Body::Real(real) => real.coast(outside_nm, inertia, self.rad_per_count),
        }
        (self.effort, self.duty, self.strain) = (0.0, 0.0, 0.0);
        self.supply_a = self.motor.standby_a;
        self.moved_from(before, outside_nm);
    }

    /// What pulls at the horn, newton metres in the sense of rising counts. A hand moves on with it.
    fn outside_nm(&mut self) -> f64 {
        let rad = (self.position - self.centre) * self.rad_per_count;
        let needed = self.load.needed_nm(rad, self.motor.stall_nm);
        let (position, velocity, rad_per_count) = (self.position, self.velocity, self.rad_per_count);
        let hand = self
            .grip
            .as_mut()
            .map_or(0.0, |grip| grip.pull_nm(position, velocity, rad_per_count));
        hand - needed
    }

    /// End stops, play, noise and heat, after the shaft has moved.
    fn moved_from(&mut self, before: f64, outside_nm: f64) {
        if let Some([low, high]) = self.stops {
            self.body.stop_within(low, high);
        }
        let shaft = self.shaft();
        let horn_before = self.position;
        let room = self.backlash_rad / self.rad_per_count / 2.0;
        if room > 0.0 {
            let fall = FALL_RAD_PER_S / self.rad_per_count * STEP_SECS;
            let pushed = if outside_nm.abs() > self.motor.friction_nm {
                outside_nm.signum()
            } else {
                0.0
            };
            self.play = (self.play - (shaft - before) + pushed * fall).clamp(-room, room);
        } else {
            self.play = 0.0;
        }
        self.position = shaft + self.play;
        self.velocity = (self.position - horn_before) / STEP_SECS;
        if self.jitter_counts > 0.0 {
            self.noise = self.jitter_counts * (2.0 * self.random.f64() - 1.0);
        } else {
            self.noise = 0.0;
        }
        self.heat.step(self.effort);
    }

    fn shaft(&self) -> f64 {
        match &self.body {
            Body::Ideal(ideal) => ideal.position,
            Body::Real(real) => real.position,
        }
    }

    /// A hand moves the horn by `counts`. Under power the motor pulls it back.
    pub(super) fn push(&mut self, counts: f64, powered: bool) {
        let shaft = self.shaft() + counts;
        match &mut self.body {
            Body::Ideal(ideal) => ideal.push(counts),
            Body::Real(real) => real.place(shaft, 0.0),
        }
        if let Some([low, high]) = self.stops {
            self.body.stop_within(low, high);
        }
        self.position = self.shaft() + self.play;
        if !powered {
            self.settle();
        }
    }

    /// A hand takes the horn, or lets go of it.
    pub(super) fn grip(&mut self, hand: Option<Hand>) {
        self.grip = hand.map(|hand| Grip::new(hand, self.position, self.centre, self.rad_per_count));
    }

    /// Forgets the trajectory: the next one begins where the shaft is.
    pub(super) fn settle(&mut self) {
        match &mut self.body {
            Body::Ideal(ideal) => ideal.settle(),
            Body::Real(real) => real.forget(),
        }
    }

    /// The encoder loses count of whole turns; the shaft stays where it is.
    pub(super) fn recount(&mut self, position: f64) {
        let shift = position - self.position;
        let shaft = self.shaft() + shift;
        match &mut self.body {
            Body::Ideal(ideal) => ideal.place(shaft),
            Body::Real(real) => {
                real.position = shaft;
                real.forget();
            }
        }
        if let Some(stops) = &mut self.stops {
            *stops = stops.map(|stop| stop + shift);
        }
        if let Some(grip) = &mut self.grip {
            grip.shift(shift);
        }
        self.position = position;
    }
}

impl Body {
    fn stop_within(&mut self, low: f64, high: f64) {
        match self {
            Self::Ideal(ideal) => ideal.stop_within(low, high),
            Self::Real(real) => real.stop_within(low, high),
        }
    }
}

impl Order {
    /// Where the trajectory is.
    fn counts(self) -> f64 {
        match self {
            Self::Position { counts, .. }
            | Self::Speed { counts, .. }
            | Self::Current { counts, .. }
            | Self::Duty { counts, .. } => counts,
        }
    }
}
