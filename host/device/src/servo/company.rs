//! Members that can be asked by one instruction, and how they are asked.
//!
//! All protocol 2.0 servos of a bus are one company: by sync read where their registers lie alike, else by bulk read.
//! So are STS servos that are alike, and protocol 1.0 servos that have bulk read. Servos without any group read (AX,
//! SCS) are companies of one, asked in turn.

use super::event::Presence;
use super::fast::FastRead;
use super::health::Item;
use super::slot::Slot;
use device_profiles::{ServoProtocol, WordOrder};

/// Members asked together.
#[derive(Debug)]
pub(super) struct Company {
    pub(super) protocol: ServoProtocol,
    order: WordOrder,
    sync: bool,
    bulk: bool,
    /// Places in member order, in the order in which they are asked.
    pub(super) members: Vec<usize>,
    pub(super) fast: FastRead,
}

impl Company {
    fn of(member: usize, slot: &Slot) -> Self {
        let servo = slot.member.servo();
        Self {
            protocol: servo.protocol,
            order: servo.word_order(),
            sync: servo.sync_read,
            bulk: servo.bulk_read,
            members: vec![member],
            fast: FastRead::new(),
        }
    }

    /// Whether a member can be asked together with these.
    fn takes(&self, slot: &Slot, slots: &[Slot]) -> bool {
        let servo = slot.member.servo();
        let speaks_alike = (self.protocol, self.order) == (servo.protocol, servo.word_order());
        let first = self.members.first().and_then(|first| slots.get(*first));
        let alike = first.is_some_and(|first| first.table.reads_like(&slot.table));
        let by_sync = self.sync && servo.sync_read && alike;
        let by_bulk = self.bulk && servo.bulk_read;
        speaks_alike && (by_sync || by_bulk)
    }

    /// The companies of a bus.
    pub(super) fn all(slots: &[Slot]) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for (member, slot) in slots.iter().enumerate() {
            match all.iter_mut().find(|company| company.takes(slot, slots)) {
                Some(company) => {
                    company.sync &= slot.member.servo().sync_read;
                    company.bulk &= slot.member.servo().bulk_read;
                    company.members.push(member);
                }
                None => all.push(Self::of(member, slot)),
            }
        }
        all
    }

    /// Whether sync read is understood by all.
    pub(super) fn syncs(&self) -> bool {
        self.sync
    }

    /// Puts those who answered first, the one to blame for a silence last; among equals nothing changes. The list is
    /// nearly in order already.
    pub(super) fn put_in_order(&mut self, slots: &[Slot]) {
        let rank = |place: usize| slots.get(place).map(|slot| (slot.presence as u8, slot.misses));
        for end in 1..self.members.len() {
            let mut at = end;
            while at > 0 {
                let (Some(&before), Some(&behind)) = (self.members.get(at - 1), self.members.get(at)) else {
                    break;
                };
                if rank(before) <= rank(behind) {
                    break;
                }
                self.members.swap(at - 1, at);
                at -= 1;
            }
        }
    }

    /// Whether every member that answers has fast sync read, as far as its firmware was read.
    pub(super) fn can_be_fast(&self, slots: &[Slot]) -> bool {
        let has = |slot: &Slot| {
            let from = slot.member.servo().fast_sync_read_from_firmware;
            from.zip(slot.firmware).is_some_and(|(from, own)| own >= from)
        };
        let mut members = self.members.iter().filter_map(|member| slots.get(*member));
        self.sync && members.all(has)
    }

    /// What is read of it beside positions, in turn.
    pub(super) fn health(&self, slots: &[Slot]) -> Vec<Item> {
        let members = || self.members.iter().filter_map(|member| slots.get(*member));
        Item::ALL
            .into_iter()
            .filter(|item| members().any(|slot| item.block(slot).is_some()))
            .collect()
    }

    /// Whether nobody of it is thought to be there.
    pub(super) fn is_absent(&self, slots: &[Slot]) -> bool {
        let mut members = self.members.iter().filter_map(|member| slots.get(*member));
        members.all(|slot| slot.presence == Presence::Absent)
    }
}
