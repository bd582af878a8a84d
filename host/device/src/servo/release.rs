//! Switching torque off, from every state, until the servos that answer have confirmed it.

use super::arming::Why;
use super::bus::{Bus, BusError, Mode};
use super::event::BusEvent;
use super::gather::Gather;
use crate::clock::Instant;

/// How often torque is switched off before a servo is reported to keep it.
const RELEASE_TRIES: u8 = 5;

/// Torque going off, until every member that answers has confirmed it.
#[derive(Debug, Clone)]
pub(super) struct Releasing {
    pub(super) written: u8,
    pub(super) gather: Gather,
}

impl Bus {
    /// Switches torque off at once, whatever is going on, and goes on doing so until the servos that answer
    /// confirm it. The joints sag: decelerate and stand first if there is time.
    pub fn release(&mut self, now: Instant) -> Result<(), BusError> {
        self.line.abandon();
        for slot in &mut self.slots {
            slot.limiter = None;
            slot.let_go = false;
            slot.pin = None;
        }
        self.cycle.restart(now);
        let gather = self.gather(|slot| vec![slot.table.torque]);
        self.mode = Mode::Releasing(Releasing { written: 1, gather });
        self.write_torque_off(now)
    }

    fn write_torque_off(&mut self, now: Instant) -> Result<(), BusError> {
        self.line.packet();
        self.append_writes(&|slot| Some((slot.table.torque, 0)));
        // Twice: the first may have collided with an answer that was still on the wire.
        self.append_writes(&|slot| Some((slot.table.torque, 0)));
        self.append_writes(&|slot| Some((slot.table.watchdog?, 0)));
        self.send_unanswered(now)
    }

    pub(super) fn poll_releasing(
        &mut self,
        now: Instant,
        emit: &mut dyn FnMut(BusEvent),
    ) -> Result<(), BusError> {
        let quiet = self.settings.quiet;
        let Mode::Releasing(releasing) = &mut self.mode else {
            return Ok(());
        };
        let asked = releasing.gather.advance(&mut self.line, quiet, now);
        if !asked.map_err(|source| BusError::transport(&self.settings.name, source))? {
            return Ok(());
        }
        let releasing = releasing.clone();
        let mut on = Vec::new();
        for (at, slot) in self.slots.iter_mut().enumerate() {
            let torque = releasing.gather.value(at, slot.table.torque);
            slot.supply.torque = torque.map(|torque| torque != 0);
            if torque.is_some_and(|torque| torque != 0) {
                on.push((at, Why::StillOn));
            }
        }
        if !on.is_empty() && releasing.written < RELEASE_TRIES {
            let gather = self.gather(|slot| vec![slot.table.torque]);
            self.mode = Mode::Releasing(Releasing {
                written: releasing.written + 1,
                gather,
            });
            return self.write_torque_off(now);
        }
        self.refuse(on);
        self.mode = Mode::Loose;
        emit(BusEvent::Released);
        Ok(())
    }
}
