//! Writing a register of many members, with as few packets as the protocols allow.
//!
//! Sync writes are obeyed by all and answered by none, so they cost no turn on the line; what must be certain is read
//! back.

use super::bus::Bus;
use super::framing;
use super::line::Line;
use super::register::{Field, Word};
use super::slot::Slot;
use device_profiles::ServoProtocol;

/// Bytes of items that one packet of protocol 1.0 or Feetech takes: its length field has eight bits.
const SUMMED_ITEMS_MAX: usize = 240;

/// Members whose goals one packet can carry.
#[derive(Debug)]
pub(super) struct GoalGroup {
    pub(super) protocol: ServoProtocol,
    goal: Field,
    members: Vec<usize>,
}

impl GoalGroup {
    /// The groups of a bus.
    pub(super) fn all(slots: &[Slot]) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for (member, slot) in slots.iter().enumerate() {
            let (protocol, goal) = (slot.table.protocol, slot.table.goal);
            let room = items_max(protocol, goal);
            let same = |group: &&mut Self| {
                let there = (group.protocol, group.goal.address, group.goal.size);
                there == (protocol, goal.address, goal.size) && group.members.len() < room
            };
            match all.iter_mut().find(same) {
                Some(group) => group.members.push(member),
                None => all.push(Self {
                    protocol,
                    goal,
                    members: vec![member],
                }),
            }
        }
        all
    }

    /// Appends the limited goals of those that have one.
    pub(super) fn append(&self, line: &mut Line, slots: &[Slot]) {
        let goals = self.members.iter().filter_map(|member| {
            let slot = slots.get(*member)?;
            let rad = slot.limiter.as_ref()?.position_rad();
            let word = slot.table.goal.word(slot.member.position_counts(rad));
            Some((slot.member.id(), word))
        });
        // Ids of members are right, and there is room for all.
        let _ = framing::sync_write(self.protocol, line.packet_so_far(), self.goal.address, goals);
    }
}

/// How many items of a row fit one packet.
fn items_max(protocol: ServoProtocol, row: Field) -> usize {
    match protocol {
        ServoProtocol::Dynamixel2 => usize::MAX,
        _ => SUMMED_ITEMS_MAX / (1 + usize::from(row.size)),
    }
}

/// Ids and what is written to them.
type Items = Vec<(u8, Word)>;

impl Bus {
    /// Appends writes of one register of every member for which `item` names one, with its value.
    pub(super) fn append_writes(&mut self, item: &dyn Fn(&Slot) -> Option<(Field, i64)>) {
        let Self { line, slots, .. } = self;
        let mut groups: Vec<(ServoProtocol, Field, Items)> = Vec::new();
        for slot in slots.iter() {
            let Some((row, raw)) = item(slot) else { continue };
            let protocol = slot.table.protocol;
            let entry = (slot.member.id(), row.word(raw));
            let room = items_max(protocol, row);
            let same = groups.iter_mut().find(|(other, there, items)| {
                let alike = (*other, there.address, there.size) == (protocol, row.address, row.size);
                alike && items.len() < room
            });
            match same {
                Some((_, _, items)) => items.push(entry),
                None => groups.push((protocol, row, vec![entry])),
            }
        }
        for (protocol, row, items) in groups {
            // Ids of members are right, and there is room for all.
            let _ = framing::sync_write(protocol, line.packet_so_far(), row.address, items);
        }
    }
}
