//! What is read in turn beside the positions: errors, torque, watchdog, supply.

use super::event::BusEvent;
use super::line::Answer;
use super::slot::Slot;
use super::table::{Block, Table};

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
    pub(super) fn next(self) -> Self {
        match self {
            Self::Errors => Self::Torque,
            Self::Torque => Self::Watchdog,
            Self::Watchdog => Self::Supply,
            Self::Supply => Self::Errors,
        }
    }

    pub(super) fn block(self, table: &Table) -> Block {
        match self {
            Self::Errors => table.error_block,
            Self::Torque => table.torque_block,
            Self::Watchdog => table.watchdog_block,
            Self::Supply => table.supply,
        }
    }
}

impl Slot {
    /// Takes in one health reading; the event says what is wrong.
    pub(super) fn take_health(
        &mut self,
        table: &Table,
        member: usize,
        item: Item,
        answer: &Answer<'_>,
        confirmed: Option<&mut [u8; 2]>,
        hot_c: f64,
    ) -> Option<BusEvent> {
        let data = answer.status.data;
        let address = item.block(table).address;
        let armed = self.limiter.is_some();
        let mut unused = [0; 2];
        let [torque_lost, tripped] = confirmed.unwrap_or(&mut unused);
        match item {
            Item::Errors => {
                self.supply.error_bits = table.error.get(data, address)? as u8;
                let bits = self.supply.error_bits;
                (bits != 0).then_some(BusEvent::HardwareError { member, bits })
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
                let trip = table.watchdog.get(data, address)? < 0 || data.first() == Some(&0xff);
                *tripped = if armed && trip {
                    tripped.saturating_add(1)
                } else {
                    0
                };
                (*tripped >= CONFIRMATIONS).then_some(BusEvent::WatchdogTripped { member })
            }
            Item::Supply => {
                self.take_supply(data, address);
                let temperature_c = self.supply.temperature_c?;
                (temperature_c >= hot_c).then_some(BusEvent::Hot {
                    member,
                    temperature_c,
                })
            }
        }
    }
}
