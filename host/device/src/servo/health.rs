//! What is read in turn beside the positions: errors, torque, watchdog, supply.

use super::block::Block;
use super::event::BusEvent;
use super::framing::StatusError;
use super::line::Answer;
use super::slot::Slot;
use device_profiles::{HardwareFault, ServoProfile, ServoProtocol};

/// A health reading must say so this often in a row before torque or watchdog count as lost.
pub(super) const CONFIRMATIONS: u8 = 2;

/// The health readings, in turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Item {
    Errors,
    Torque,
    Watchdog,
    Supply,
}

impl Item {
    /// In the order in which they are read.
    pub(super) const ALL: [Self; 4] = [Self::Errors, Self::Torque, Self::Watchdog, Self::Supply];

    /// What is read of a servo for it; none where the servo lacks it or tells it each cycle anyway.
    pub(super) fn block(self, slot: &Slot) -> Option<Block> {
        let table = &slot.table;
        let servo = slot.member.servo();
        match self {
            Self::Errors => Some(Block::spanning(servo, &[table.error?])),
            Self::Torque => Some(Block::spanning(servo, &[table.torque])),
            Self::Watchdog => Some(Block::spanning(servo, &[table.watchdog?])),
            Self::Supply => {
                let rows = [table.voltage, table.temperature];
                let wanted = rows.into_iter().flatten().filter(|row| !table.status.holds(*row));
                // Where they do not lie together only the first is read: no read may span a gap.
                let rows: Vec<_> = wanted.collect();
                Block::covering(servo, &rows).into_iter().next()
            }
        }
    }
}

/// Where each fault stands in [`super::member::Supply::error_bits`]. A goal outside its limits is no fault of the servo.
fn place(fault: HardwareFault) -> Option<u8> {
    match fault {
        HardwareFault::InputVoltage => Some(0),
        HardwareFault::AngleLimit => None,
        HardwareFault::Overheating => Some(2),
        HardwareFault::Encoder => Some(3),
        HardwareFault::ElectricalShock => Some(4),
        HardwareFault::Overload => Some(5),
        HardwareFault::Overcurrent => Some(6),
    }
}

/// A servo's own fault bits in the order that is the same for all.
pub(super) fn faults(servo: &ServoProfile, raw: u8) -> u8 {
    if raw == 0 {
        return 0;
    }
    let set = servo
        .fault_bits
        .iter()
        .filter(|(_, bit)| raw >> (**bit & 7) & 1 == 1);
    set.filter_map(|(fault, _)| place(*fault))
        .fold(0, |bits, at| bits | 1 << at)
}

/// The faults that an answer itself reports; none where it only says that there are some.
pub(super) fn reported(servo: &ServoProfile, error: StatusError) -> Option<u8> {
    match servo.protocol {
        ServoProtocol::Dynamixel2 => None,
        _ => Some(faults(servo, error.raw())),
    }
}

impl Slot {
    /// Takes note of error bits; the event says that there are some that were not there before.
    pub(super) fn take_errors(&mut self, member: usize, bits: u8) -> Option<BusEvent> {
        self.supply.error_bits = bits;
        (bits != 0).then_some(BusEvent::HardwareError { member, bits })
    }

    /// Takes in one health reading of the block that starts at `address`; the event says what is wrong.
    pub(super) fn take_health(
        &mut self,
        member: usize,
        item: Item,
        answer: &Answer<'_>,
        address: u16,
        confirmed: Option<&mut [u8; 2]>,
        hot_c: f64,
    ) -> Option<BusEvent> {
        let data = answer.status.data;
        let table = self.table;
        let armed = self.limiter.is_some();
        let mut unused = [0; 2];
        let [torque_lost, tripped] = confirmed.unwrap_or(&mut unused);
        match item {
            Item::Errors => {
                let raw = table.error?.get(data, address)? as u8;
                let bits = faults(self.member.servo(), raw);
                self.take_errors(member, bits)
            }
            Item::Torque => {
                let on = table.torque.get(data, address)? != 0;
                self.supply.torque = Some(on);
                *torque_lost = if armed && !on {
                    torque_lost.saturating_add(1)
                } else {
                    0
                };
                (*torque_lost >= CONFIRMATIONS).then_some(BusEvent::TorqueLost { member })
            }
            Item::Watchdog => {
                // Tripped it reads -1, whichever way the profile takes its byte.
                let raw = table.watchdog?.get(data, address)?;
                let trip = raw < 0 || raw == 0xff;
                *tripped = if armed && trip {
                    tripped.saturating_add(1)
                } else {
                    0
                };
                (*tripped >= CONFIRMATIONS).then_some(BusEvent::WatchdogTripped { member })
            }
            Item::Supply => {
                self.take_supply(data, address);
                self.is_hot(member, hot_c)
            }
        }
    }

    /// Whether it is too warm.
    pub(super) fn is_hot(&self, member: usize, hot_c: f64) -> Option<BusEvent> {
        let temperature_c = self.supply.temperature_c?;
        (temperature_c >= hot_c).then_some(BusEvent::Hot {
            member,
            temperature_c,
        })
    }
}
