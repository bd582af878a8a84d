//! What the buses tell, and what follows from it.

use crate::fault::{Fault, Place};
use crate::player::{Player, State};
use crate::report::Phase;
use device::Instant;
use device::servo::BusEvent;

impl Player {
    /// Makes of an event what it means for the puppet.
    pub(crate) fn hear(&mut self, at: usize, event: BusEvent, now: Instant) {
        match event {
            BusEvent::ArmingRefused => self.arming_refused(at, now),
            BusEvent::Released => {
                if let Some(line) = self.lines.all.get_mut(at) {
                    line.released();
                }
            }
            // Pinned anew after a pause: the joints may stand elsewhere, so what is played is approached again.
            BusEvent::Armed => {
                if let Some(playback) = &mut self.playback {
                    playback.phase = Phase::Pinning;
                }
            }
            BusEvent::HardwareError { member, bits } => {
                self.member_fault(at, member, now, |place| Fault::ServoError { place, bits });
            }
            BusEvent::Restarted { member } => self.member_fault(at, member, now, Fault::Restarted),
            BusEvent::TorqueLost { member } => self.member_fault(at, member, now, Fault::TorqueLost),
            // Silence is judged by the age of readings, heat by the supply's; the rest is counted by the bus.
            _ => {}
        }
    }

    fn arming_refused(&mut self, at: usize, now: Instant) {
        self.refused = true;
        if self.state == State::Arming {
            self.lines.release_all(now);
            self.state = State::Released;
            return;
        }
        let first = self
            .lines
            .all
            .get(at)
            .and_then(|line| line.bus.refusals().first());
        let why = first.map(ToString::to_string).unwrap_or_default();
        self.fault(Fault::Refused(why), now);
    }

    fn member_fault(&mut self, at: usize, member: usize, now: Instant, fault: impl FnOnce(Place) -> Fault) {
        let engaged = matches!(self.state, State::Holding | State::Playing);
        if let Some(place) = self.place(at, member)
            && engaged
        {
            self.fault(fault(place), now);
        }
    }

    pub(crate) fn place(&self, at: usize, member: usize) -> Option<Place> {
        let bus = &self.lines.all.get(at)?.bus;
        let seated = bus.member(member)?;
        Some(Place {
            bus: bus.name().to_owned(),
            joint: seated.joint().to_owned(),
            id: seated.id(),
        })
    }
}
