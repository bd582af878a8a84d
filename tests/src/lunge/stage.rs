//! A puppet on simulated buses in virtual time, ticked as the player's own loop would.

use super::Outcome;
use super::shafts::Shafts;
use crate::simulated::Line;
use anyhow::Context;
use device::servo::Limits;
use device::{Clock, Instant, VirtualClock};
use device_profiles::{Policy, Profiles, PuppetProfile, Reaction};
use fastrand::Rng;
use firmware_sim::servo_bus::{Absent, BusOptions, Unit};
use firmware_sim::{Fault, ServoBus};
use player::{Order, Player, PlayerConfig, Puppet, State};
use std::sync::Arc;
use std::time::Duration;

/// Looks between two ticks, of the player at its lines and of the judge at the shafts.
const LOOKS: u32 = 4;
/// What is wrong is told so often; more only repeats itself.
const WRONG_MAX: usize = 8;

struct Hung {
    name: String,
    line: Line<ServoBus>,
    shafts: Shafts,
    /// Ids of its servos.
    ids: Vec<u8>,
}

/// See the module.
pub(super) struct Stage {
    clock: VirtualClock,
    player: Player,
    buses: Vec<Hung>,
    period: Duration,
    wrong: Vec<String>,
    disturbances: u64,
    /// What was asked and what went wrong, for runs that fail.
    story: Vec<String>,
}

fn reaction(random: &mut Rng) -> Reaction {
    *random
        .choice([Reaction::BackOff, Reaction::Hold, Reaction::Release].iter())
        .unwrap_or(&Reaction::Hold)
}

fn policy(random: &mut Rng) -> Policy {
    Policy {
        on_heat: reaction(random),
        on_overload: reaction(random),
        on_brownout: reaction(random),
        on_lost_host: reaction(random),
        ..Policy::default()
    }
}

/// Servos hanging anywhere in their ranges, sometimes a little outside.
fn hang(
    profile: &PuppetProfile,
    name: &str,
    baud: u32,
    profiles: &Profiles,
    random: &mut Rng,
) -> anyhow::Result<ServoBus> {
    let absent = [Absent::Silence, Absent::GoOnAfter(1000)][random.usize(..2)];
    let mut bus = ServoBus::new(BusOptions {
        baud,
        seed: random.u64(..),
        absent,
        ..BusOptions::default()
    });
    for joint in profile.joints_on(name) {
        let servo = profiles.servo(&joint.model)?;
        let share = random.f64() * 1.04 - 0.02;
        let angle = joint.min_rad + share * (joint.max_rad - joint.min_rad);
        let counts = f64::from(joint.zero_counts) + f64::from(joint.sign) * angle / servo.rad_per_count();
        let unit = Unit {
            start_rad: (counts - f64::from(servo.centre_counts)) * servo.rad_per_count(),
            turnaround_us: random.u32(0..60),
            drift_ppm: random.i32(-5000..5000),
            ..Unit::new(joint.id)
        };
        bus.add(servo, unit)?;
    }
    Ok(bus)
}

impl Stage {
    pub(super) fn new(puppet: &str, profiles: &Profiles, random: &mut Rng) -> anyhow::Result<Self> {
        let profile = profiles.puppet(puppet)?;
        let bound = Puppet::new(profile, profiles)?.with_policy(policy(random));
        let clock = VirtualClock::new();
        clock.advance(Duration::from_secs(1));
        let shared: Arc<dyn Clock> = Arc::new(clock.clone());
        let (mut buses, mut lines) = (Vec::new(), Vec::new());
        for bus in bound.buses() {
            let far = hang(profile, &bus.name, bus.baud, profiles, random)?;
            let line = Line::new(far, Arc::clone(&shared));
            lines.push(bound.connect(&bus.name, Box::new(line.clone()))?);
            buses.push(Hung {
                name: bus.name.clone(),
                line,
                shafts: Shafts::new(bus.members.iter()),
                ids: bus.members.iter().map(device::servo::Member::id).collect(),
            });
        }
        let period = Duration::from_millis([10, 20, 20, 33][random.usize(..4)]);
        let config = PlayerConfig {
            period,
            ..PlayerConfig::default()
        };
        let player = Player::new(bound, lines, config).context(puppet.to_owned())?;
        Ok(Self {
            clock,
            player,
            buses,
            period,
            wrong: Vec::new(),
            disturbances: 0,
            story: Vec::new(),
        })
    }

    pub(super) fn player(&self) -> &Player {
        &self.player
    }

    /// Ids on a bus, by any number.
    pub(super) fn ids(&self, bus: usize) -> &[u8] {
        &self.buses[bus % self.buses.len()].ids
    }

    /// The limits of each joint.
    pub(super) fn limits(&self) -> Vec<Limits> {
        let seats = self.player.puppet().seats().iter();
        let buses = self.player.puppet().buses();
        seats
            .map(|seat| buses[seat.bus].members[seat.member].limits())
            .collect()
    }

    /// One period: a tick with these orders, then looks until the next.
    pub(super) fn tick(&mut self, orders: impl IntoIterator<Item = Order>) {
        let orders: Vec<Order> = orders.into_iter().collect();
        for order in &orders {
            let what = match order {
                Order::Play { speed, looped, .. } => format!("play, speed {speed:.2}, looped {looped}"),
                Order::Follow(_) => "follow".to_owned(),
                order => format!("{order:?}"),
            };
            self.tell(&what);
        }
        self.player.tick(self.clock.now(), &mut orders.into_iter());
        for _ in 0..LOOKS {
            self.clock.advance(self.period / LOOKS);
            self.player.poll(self.clock.now());
            self.judge();
        }
    }

    fn tell(&mut self, what: &str) {
        let (secs, state) = (self.clock.now().as_secs_f64(), self.player.state());
        self.story.push(format!("{secs:.3} s, {state:?}: {what}"));
    }

    fn judge(&mut self) {
        let now = self.clock.now();
        for hung in &mut self.buses {
            if self.wrong.len() < WRONG_MAX {
                hung.shafts.look(&hung.line, now, &mut self.wrong);
            }
        }
    }

    /// The host sleeps; the shafts are watched.
    pub(super) fn stall(&mut self, secs: f64) {
        self.disturbances += 1;
        self.tell(&format!("stall {secs:.3} s"));
        let end = self.clock.now().after(Duration::from_secs_f64(secs));
        while self.clock.now() < end {
            self.clock.advance(Duration::from_millis(5));
            self.judge();
        }
    }

    /// Takes a cable out or puts it back, with the player's line on it.
    pub(super) fn plug(&mut self, bus: usize, connected: bool) {
        self.disturbances += 1;
        let at = bus % self.buses.len();
        self.tell(&format!("bus {at} plugged {connected}"));
        let hung = &self.buses[at];
        hung.line.connect(connected);
        if connected {
            let again = self.player.reconnect(&hung.name, Box::new(hung.line.clone()));
            if let Err(error) = again {
                self.wrong.push(format!("cannot be connected again: {error}"));
            }
        }
    }

    /// Brings a fault in on a bus.
    pub(super) fn inject(&mut self, bus: usize, text: &str) {
        self.disturbances += 1;
        let at = bus % self.buses.len();
        self.tell(&format!("{text} on bus {at}"));
        match Fault::parse(text) {
            Ok(fault) => self.buses[at].line.with(|bus, now_us| bus.inject(now_us, &fault)),
            Err(error) => self.wrong.push(format!("{text}: {error}")),
        }
    }

    /// Everything is well again, and the program ends.
    pub(super) fn close(&mut self) {
        for at in 0..self.buses.len() {
            self.buses[at].line.with(ServoBus::mend);
            self.plug(at, true);
        }
        self.tick([Order::Stop, Order::Reset]);
        let end = self.clock.now().after(Duration::from_secs(6));
        while self.clock.now() < end {
            self.tick([]);
            if *self.player.state() == State::Released && !self.player.report().torque {
                let unknown = self.player.report().torque_unknown;
                self.tell(&format!("closed; torque unknown: {unknown}"));
                return;
            }
        }
        self.wrong
            .push(format!("never released: {:?}", self.player.state()));
    }

    pub(super) fn outcome(mut self, puppet: &'static str) -> Outcome {
        let mut outcome = Outcome {
            puppet,
            disturbances: self.disturbances,
            secs: self.clock.now().since(Instant::ZERO).as_secs_f64(),
            ..Outcome::default()
        };
        for hung in &self.buses {
            let (ratio, torque_ons) = hung.shafts.finish(&hung.line, &mut self.wrong);
            outcome.speed_ratio = outcome.speed_ratio.max(ratio);
            outcome.torque_ons += torque_ons;
            outcome.turned_rad += hung.shafts.turned_rad;
            outcome.start_counts = outcome.start_counts.max(hung.shafts.start_counts);
        }
        outcome.wrong = self.wrong;
        outcome.story = self.story;
        outcome
    }
}
