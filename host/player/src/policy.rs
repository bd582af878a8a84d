//! What follows from trouble: the puppet's policy, kind by kind.

use crate::config::{Ending, PlayerConfig};
use crate::fault::Fault;
use crate::player::{Player, Stance, State, Stopping};
use crate::puppet::Puppet;
use crate::trouble::{Bounds, Trouble, Troubled, Turn};
use device::Instant;
use device_profiles::Reaction;

/// How fast time runs while a joint backs off: half the speed is a quarter of the accelerations.
const PACE_IN_TROUBLE: f64 = 0.5;
/// How fast the pace changes, a second: a slow clip is not a sudden one.
const PACE_PER_SEC: f64 = 0.5;
/// Bits of Hardware Error Status, the same for all makers (`docs/protocols`): input voltage, overheating, overload.
const VOLTAGE: u8 = 1;
const OVERHEATING: u8 = 1 << 2;
const OVERLOAD: u8 = 1 << 5;

/// From which values on each joint is in trouble.
pub(crate) fn bounds(puppet: &Puppet, config: &PlayerConfig) -> Vec<Bounds> {
    let member = |seat: &crate::puppet::Seat| puppet.buses().get(seat.bus)?.members.get(seat.member);
    let members = puppet.seats().iter().filter_map(member);
    let of = |member: &device::servo::Member| {
        let strain_secs = config.strain_max.as_secs_f64();
        Bounds::of(
            member.servo(),
            puppet.policy().hot_c,
            config.strain_rad,
            strain_secs,
        )
    };
    members.map(of).collect()
}

fn ending(reaction: Reaction) -> Ending {
    match reaction {
        // Whatever backs off and cannot any more stands still.
        Reaction::BackOff | Reaction::Hold => Ending::Hold,
        Reaction::Release => Ending::Release,
    }
}

impl Player {
    /// What becomes of torque after a fault.
    pub(crate) fn ending_of(&self, fault: &Fault) -> Ending {
        let policy = self.puppet().policy();
        match fault {
            // A servo that is still getting hotter while it does less cannot go on holding either.
            Fault::Hot { .. } if policy.on_heat == Reaction::BackOff => Ending::Release,
            Fault::Hot { .. } => ending(policy.on_heat),
            Fault::Strained { .. } | Fault::Overloaded(_) => ending(policy.on_overload),
            Fault::BrownOut { .. } | Fault::Restarted(_) | Fault::TorqueLost(_) => ending(policy.on_brownout),
            Fault::BusLost { .. } | Fault::OperatorGone | Fault::HeartbeatLost => ending(policy.on_lost_host),
            Fault::ServoError { bits, .. } if bits & OVERHEATING != 0 => ending(policy.on_heat),
            Fault::ServoError { bits, .. } if bits & OVERLOAD != 0 => ending(policy.on_overload),
            Fault::ServoError { bits, .. } if bits & VOLTAGE != 0 => ending(policy.on_brownout),
            Fault::StopPressed
            | Fault::LateTicks { .. }
            | Fault::BusSilent(_)
            | Fault::ServoError { .. }
            | Fault::Refused(_) => self.config.ending,
        }
    }

    fn reaction(&self, trouble: Trouble) -> Reaction {
        let policy = self.puppet().policy();
        match trouble {
            Trouble::Heat => policy.on_heat,
            Trouble::Overload => policy.on_overload,
            Trouble::BrownOut => policy.on_brownout,
        }
    }

    /// Looks for heat, overload and brown-out wherever there is torque, and does what the policy says.
    pub(crate) fn watch_troubles(&mut self, now: Instant, dt_secs: f64) {
        let held = self
            .stopping
            .is_some_and(|stopping| stopping.ending == Ending::Hold);
        let engaged = matches!(self.state, State::Holding | State::Playing);
        if engaged || held {
            for joint in 0..self.troubled.len() {
                let (trouble, turn) = self.look_at(joint, dt_secs);
                match turn {
                    Some(persists) if engaged => self.react(joint, trouble, persists, now),
                    // Nothing more is asked of a puppet that holds, but what gets too hot is let go.
                    Some(true) if trouble == Trouble::Heat => self.let_go(now),
                    _ => {}
                }
            }
        }
        let worst = self.troubled.iter().enumerate();
        let worst = worst.filter_map(|(joint, troubled)| Some((troubled.worst()?, joint)));
        let worst = worst.max_by_key(|(trouble, joint)| (*trouble, std::cmp::Reverse(*joint)));
        self.report.backing_off = worst.filter(|_| engaged);
        let aim = if self.report.backing_off.is_some() {
            PACE_IN_TROUBLE
        } else {
            1.0
        };
        let reach = PACE_PER_SEC * dt_secs;
        self.pace += (aim - self.pace).clamp(-reach, reach);
    }

    /// The turn that matters most, if any: what it is about, and whether backing off has not helped.
    fn look_at(&mut self, joint: usize, dt_secs: f64) -> (Trouble, Option<bool>) {
        let signs = self.lines.signs(joint);
        let mut found = (Trouble::Heat, None);
        if let (Some(troubled), Some(bounds)) = (self.troubled.get_mut(joint), self.bounds.get(joint)) {
            troubled.step(&signs, bounds, dt_secs, &mut |turn| match turn {
                Turn::Begins(trouble) if found.1 != Some(true) => found = (trouble, Some(false)),
                Turn::Persists(trouble) => found = (trouble, Some(true)),
                Turn::Begins(_) | Turn::Ends(_) => {}
            });
        }
        found
    }

    fn react(&mut self, joint: usize, trouble: Trouble, persists: bool, now: Instant) {
        if self.reaction(trouble) == Reaction::BackOff && !persists {
            return;
        }
        let signs = self.lines.signs(joint);
        let seat = self.lines.place(joint);
        let Some(place) = seat.and_then(|(bus, member)| self.place(bus, member)) else {
            return;
        };
        let fault = match trouble {
            Trouble::Heat => Fault::Hot {
                place,
                temperature_c: signs.temperature_c.unwrap_or_default(),
            },
            Trouble::BrownOut => Fault::BrownOut {
                place,
                voltage_v: signs.voltage_v.unwrap_or_default(),
            },
            Trouble::Overload if signs.strain_rad > self.config.strain_rad => Fault::Strained {
                place,
                by_rad: signs.strain_rad,
            },
            Trouble::Overload => Fault::Overloaded(place),
        };
        self.fault(fault, now);
    }

    fn let_go(&mut self, now: Instant) {
        tracing::warn!("a servo that holds after a fault gets too hot: torque goes off");
        self.stopping = Some(Stopping::new(now, Ending::Release));
    }

    /// Works out this tick's pose, retreats and all. Whether there is one; otherwise joints come to a stand.
    pub(crate) fn ease(&mut self) -> bool {
        let retreats = self.troubled.iter().any(|troubled| troubled.retreat() > 0.0);
        let holding = self.state == State::Holding && self.stopping.is_none();
        if retreats && holding && self.stance == Stance::Stand && self.lines.all_still() {
            // What stands has no wish to retreat from until it is said what: to stand where it does.
            self.lines.goals_into(&mut self.wanted);
            self.stance = Stance::Pose;
        }
        let wished = match self.stopping {
            None => matches!(self.state, State::Holding | State::Playing),
            Some(stopping) => stopping.settled,
        };
        if !wished || self.stance != Stance::Pose {
            return false;
        }
        for (joint, (eased, wanted)) in self.eased.iter_mut().zip(&self.wanted).enumerate() {
            let retreat = self.troubled.get(joint).map_or(0.0, Troubled::retreat);
            *eased = match self.lines.reading(joint) {
                Some(reading) if retreat > 0.0 => wanted + (reading.position_rad - wanted) * retreat,
                _ => *wanted,
            };
        }
        true
    }

    /// After the stand of a fault that ends in holding: what is kept from its goal is held where it is, so that
    /// nothing goes on pushing.
    pub(crate) fn hold_where_joints_are(&mut self, stopping: Stopping) {
        if stopping.settled {
            return;
        }
        self.lines.goals_into(&mut self.wanted);
        for (joint, wanted) in self.wanted.iter_mut().enumerate() {
            if let Some(reading) = self.lines.reading(joint)
                && (reading.position_rad - *wanted).abs() > self.config.settled_rad
            {
                *wanted = reading.position_rad;
            }
        }
        self.stance = Stance::Pose;
        self.stopping = Some(Stopping {
            settled: true,
            ..stopping
        });
    }
}
