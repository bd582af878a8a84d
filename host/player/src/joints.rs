//! The buses as the player sees them: one line each, and the puppet's joints spread over them.

use crate::puppet::{Puppet, Seat};
use crate::report::{Interventions, JointReport};
use crate::trouble::Signs;
use device::Instant;
use device::servo::{Armed, Bus, BusError, BusEvent, Commanded, Goal, Intervention, Limits, Reading};

/// A bus, the joints on it, and its share of the pose.
#[derive(Debug)]
pub(crate) struct Line {
    pub(crate) bus: Bus,
    /// The puppet's joint for each member.
    pub(crate) joints: Vec<usize>,
    wanted: Vec<f64>,
    /// Members whose last goal the limits changed.
    limited: Vec<bool>,
    /// The line has failed; only switching off is still tried.
    pub(crate) lost: bool,
    /// Torque is to go off, and the line has not taken it yet.
    pub(crate) release_due: bool,
    /// Servos may have been given torque, and not all have said since that it is off.
    pub(crate) unconfirmed: bool,
}

impl Line {
    pub(crate) fn new(at: usize, bus: Bus, puppet: &Puppet) -> Self {
        let seats = puppet.seats().iter().enumerate();
        let here = seats.filter(|(_, seat)| seat.bus == at);
        let joints: Vec<usize> = here.map(|(joint, _)| joint).collect();
        let wanted = vec![0.0; joints.len()];
        let limited = vec![false; joints.len()];
        Self {
            bus,
            joints,
            wanted,
            limited,
            lost: false,
            release_due: false,
            unconfirmed: false,
        }
    }

    /// Goals for this bus out of the puppet's pose, or a stand.
    pub(crate) fn command(
        &mut self,
        pose: Option<&[f64]>,
        now: Instant,
        interventions: &mut Interventions,
    ) -> Result<Commanded, BusError> {
        self.limited.fill(false);
        let limited = &mut self.limited;
        let mut note = |intervention: Intervention| {
            interventions.add(intervention.change);
            if let Some(limited) = limited.get_mut(intervention.member) {
                *limited = true;
            }
        };
        let Some(pose) = pose else {
            return self.bus.command(Goal::Standstill, now, &mut note);
        };
        for (wanted, joint) in self.wanted.iter_mut().zip(&self.joints) {
            *wanted = pose.get(*joint).copied().unwrap_or(f64::NAN);
        }
        self.bus.command(Goal::Positions(&self.wanted), now, &mut note)
    }

    /// Begins to arm; from here on nobody knows of torque but the servos.
    pub(crate) fn arm(&mut self, now: Instant) -> Result<(), BusError> {
        self.lost = false;
        self.unconfirmed = true;
        self.bus.begin_arming(now)
    }

    /// Torque was switched off: whether each servo has said so.
    pub(crate) fn released(&mut self) {
        let off = |member| {
            let supply = self.bus.supply(member);
            supply.is_some_and(|supply| supply.torque == Some(false))
        };
        self.unconfirmed &= !(0..self.joints.len()).all(off);
    }

    /// Switches torque off, or remembers to try again.
    pub(crate) fn release(&mut self, now: Instant) {
        self.release_due = self.bus.release(now).is_err();
    }

    /// Takes in answers; a failed line is marked and its reason returned.
    pub(crate) fn poll(&mut self, now: Instant, emit: &mut dyn FnMut(BusEvent)) -> Option<String> {
        if self.lost {
            return None;
        }
        match self.bus.poll(now, emit) {
            Ok(()) => None,
            Err(error) => {
                self.lost = true;
                Some(error.to_string())
            }
        }
    }

    pub(crate) fn is_armed(&self) -> bool {
        !self.lost && self.bus.armed() == Armed::Yes
    }

    /// No torque, as far as anybody can do anything about it.
    pub(crate) fn is_loose(&self) -> bool {
        self.lost || (!self.release_due && self.bus.armed() == Armed::No)
    }
}

/// All lines of a puppet.
#[derive(Debug)]
pub(crate) struct Lines {
    pub(crate) all: Vec<Line>,
    seats: Vec<Seat>,
    pub(crate) limits: Vec<Limits>,
}

impl Lines {
    pub(crate) fn new(buses: Vec<Bus>, puppet: &Puppet) -> Self {
        let all = buses
            .into_iter()
            .enumerate()
            .map(|(at, bus)| Line::new(at, bus, puppet))
            .collect();
        let seats = puppet.seats().to_vec();
        let members = |seat: &Seat| {
            puppet
                .buses()
                .get(seat.bus)
                .and_then(|bus| bus.members.get(seat.member))
        };
        let limits = seats
            .iter()
            .filter_map(members)
            .map(device::servo::Member::limits)
            .collect();
        Self { all, seats, limits }
    }

    pub(crate) fn count(&self) -> usize {
        self.seats.len()
    }

    /// The bus of a joint and its place there.
    pub(crate) fn seat(&self, joint: usize) -> Option<(&Bus, usize)> {
        let seat = self.seats.get(joint)?;
        Some((&self.all.get(seat.bus)?.bus, seat.member))
    }

    pub(crate) fn reading(&self, joint: usize) -> Option<Reading> {
        let (bus, member) = self.seat(joint)?;
        bus.reading(member)
    }

    pub(crate) fn goal_rad(&self, joint: usize) -> Option<f64> {
        let (bus, member) = self.seat(joint)?;
        bus.goal_rad(member)
    }

    /// When goals were last sent to a joint's bus; none without torque.
    pub(crate) fn goals_at(&self, joint: usize) -> Option<Instant> {
        self.seat(joint)?.0.goals_at()
    }

    pub(crate) fn joint_report(&self, joint: usize) -> JointReport {
        let Some(seat) = self.seats.get(joint) else {
            return JointReport::default();
        };
        let Some(line) = self.all.get(seat.bus) else {
            return JointReport::default();
        };
        let reading = line.bus.reading(seat.member);
        let supply = line.bus.supply(seat.member).unwrap_or_default();
        JointReport {
            goal_rad: line.bus.goal_rad(seat.member),
            goal_at: line.bus.goals_at(),
            measured_rad: reading.map(|reading| reading.position_rad),
            measured_at: reading.map(|reading| reading.at),
            velocity_rad_per_s: reading.map_or(0.0, |reading| reading.velocity_rad_per_s),
            load: reading.and_then(|reading| reading.load),
            voltage_v: supply.voltage_v,
            temperature_c: supply.temperature_c,
            error_bits: supply.error_bits,
            presence: line.bus.presence(seat.member),
            limited: line.limited.get(seat.member).copied().unwrap_or_default(),
            ..JointReport::default()
        }
    }

    /// What tells of heat, overload and brown-out.
    pub(crate) fn signs(&self, joint: usize) -> Signs {
        let Some((bus, member)) = self.seat(joint) else {
            return Signs::default();
        };
        let (reading, supply) = (bus.reading(member), bus.supply(member).unwrap_or_default());
        let strain = |goal: f64| reading.map(|reading| (goal - reading.position_rad).abs());
        Signs {
            temperature_c: supply.temperature_c,
            // Whoever answers has some: 0 V is a servo that does not measure it.
            voltage_v: supply.voltage_v.filter(|volts| *volts > 0.0),
            load: reading.and_then(|reading| reading.load),
            strain_rad: bus.goal_rad(member).and_then(strain).unwrap_or_default(),
        }
    }

    /// The place of a joint's bus, and its place there.
    pub(crate) fn place(&self, joint: usize) -> Option<(usize, usize)> {
        self.seats.get(joint).map(|seat| (seat.bus, seat.member))
    }

    /// Writes every joint's goal into the pose; joints without one keep what is there.
    pub(crate) fn goals_into(&self, pose: &mut [f64]) {
        for (joint, wanted) in pose.iter_mut().enumerate() {
            *wanted = self.goal_rad(joint).unwrap_or(*wanted);
        }
    }

    pub(crate) fn all_armed(&self) -> bool {
        self.all.iter().all(Line::is_armed)
    }

    pub(crate) fn all_loose(&self) -> bool {
        self.all.iter().all(Line::is_loose)
    }

    /// Whether any servo said that it has torque when it was last asked.
    pub(crate) fn any_torque(&self) -> bool {
        let torque = |line: &Line| {
            let supplies = (0..line.joints.len()).filter_map(|member| line.bus.supply(member));
            supplies.into_iter().any(|supply| supply.torque == Some(true))
        };
        self.all.iter().any(|line| !line.lost && torque(line))
    }

    /// Whether torque may be on where nothing can be done about it any more.
    pub(crate) fn torque_unknown(&self) -> bool {
        let beyond = |line: &Line| line.lost || line.bus.armed() == Armed::No;
        self.all.iter().any(|line| line.unconfirmed && beyond(line))
    }

    /// Whether every goal that could still move stands.
    pub(crate) fn all_still(&self) -> bool {
        self.all
            .iter()
            .all(|line| !line.is_armed() || line.bus.is_still())
    }

    /// Switches torque off again where servos have not all said that it is; false if there is no such line.
    pub(crate) fn release_unconfirmed(&mut self, now: Instant) -> bool {
        let open = self.all.iter_mut().filter(|line| line.unconfirmed && !line.lost);
        open.map(|line| line.release(now)).count() > 0
    }

    pub(crate) fn release_all(&mut self, now: Instant) {
        for line in &mut self.all {
            line.release(now);
        }
    }
}
