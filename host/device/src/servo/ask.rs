//! Asking one company, and taking in its answers.

use super::block::Block;
use super::bus::{Bus, BusError};
use super::company::Company;
use super::event::{BusEvent, Presence};
use super::framing;
use super::freshness::Verdict;
use super::health::{Item, reported};
use super::line::{Answer, Line, Progress};
use super::slot::Slot;
use super::turns::Turns;
use crate::clock::Instant;
use device_profiles::ServoProtocol;
use std::time::Duration;

/// Bytes of an instruction packet around its parameters, and of parameters for each servo, at most: those of a bulk
/// read in protocol 2.0.
const REQUEST_BYTES: [usize; 2] = [14, 5];

/// What is being asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Asked {
    Status,
    /// The status of those that did not answer in this cycle yet.
    Again,
    Health(Item),
    /// Every length is owed: only whether the line still lives.
    Ping,
}

/// A member that is asked, and for what.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chosen {
    pub(super) member: usize,
    pub(super) id: u8,
    block: Block,
    /// Where the read begins.
    address: u16,
    bytes: u16,
}

impl Bus {
    /// The longest that reading a company may take, until the wire is surely free again.
    pub(super) fn time_for(&self, company: usize) -> Duration {
        let Some(company) = self.companies.get(company) else {
            return Duration::ZERO;
        };
        let [head, each] = REQUEST_BYTES;
        let slots = company
            .members
            .iter()
            .filter_map(|member| self.slots.get(*member));
        let longest = slots.map(|slot| slot.table.status.bytes).max().unwrap_or(0);
        let servos = company.members.len();
        let bytes = head + servos * each;
        self.line.exchange_time(bytes, servos, usize::from(longest) + 4) + self.line.guard()
    }

    /// Appends a read of one company to the packets waiting to be sent, and sends them. False: there is nobody to
    /// ask, and nothing was sent.
    pub(super) fn ask(&mut self, company: usize, asked: Asked, now: Instant) -> Result<bool, BusError> {
        let Self {
            companies,
            slots,
            cycle,
            line,
            counters,
            ..
        } = self;
        let Some(asking) = companies.get_mut(company) else {
            return Ok(false);
        };
        asking.put_in_order(slots);
        choose(asking, asked, slots, cycle.number, &mut cycle.chosen);
        if cycle.chosen.is_empty() {
            return Ok(false);
        }
        line.speak(asking.protocol);
        let first = cycle.chosen.first().copied();
        give_lengths(line, asking, &mut cycle.chosen);
        cycle.company = company;
        if let (true, Some(first)) = (cycle.chosen.is_empty(), first) {
            return self.ping(first, now);
        }
        let all_there = |chosen: &[Chosen]| {
            let mut slots = chosen.iter().filter_map(|chosen| slots.get(chosen.member));
            slots.all(|slot| slot.presence == Presence::Present)
        };
        let may_be_fast = asked != Asked::Again && cycle.chosen.len() > 1 && all_there(&cycle.chosen);
        let fast = may_be_fast && asking.fast.choose();
        cycle.fast = fast;
        cycle.asked = Some(asked);
        counters.fast_reads += u64::from(fast);
        append_read(line, asking, &cycle.chosen, fast);
        let turns = if fast {
            Turns::together()
        } else {
            Turns::each(asking.protocol)
        };
        let wanted = cycle.chosen.iter().map(|chosen| (chosen.id, chosen.bytes));
        let sent = line.send_for(now, turns, wanted);
        sent.map_err(|source| BusError::transport(&self.settings.name, source))?;
        Ok(true)
    }

    /// Every length that can be asked for is owed by somebody: a ping's answer holds no values, so it may be late, and
    /// proves that the line carries answers again.
    fn ping(&mut self, whom: Chosen, now: Instant) -> Result<bool, BusError> {
        let protocol = self.line.protocol();
        // Ids of members are right.
        let _ = framing::ping(protocol, self.line.packet_so_far(), whom.id);
        let bytes = match protocol {
            ServoProtocol::Dynamixel2 => 3,
            _ => 0,
        };
        self.cycle.asked = Some(Asked::Ping);
        self.cycle.fast = false;
        self.cycle.chosen.push(Chosen { bytes, ..whom });
        self.cycle.pinging_since.get_or_insert(now);
        self.counters.pings += 1;
        let sent = self.line.send_for(now, Turns::each(protocol), [(whom.id, bytes)]);
        sent.map_err(|source| BusError::transport(&self.settings.name, source))?;
        Ok(true)
    }

    /// Takes in what has arrived.
    pub(super) fn take_answers(
        &mut self,
        now: Instant,
        emit: &mut dyn FnMut(BusEvent),
    ) -> Result<Progress, BusError> {
        let Self {
            line,
            slots,
            counters,
            cycle,
            settings,
            ..
        } = self;
        let asked = cycle.asked;
        let mut urgent = false;
        let mut pinged = false;
        let (lost, chosen) = (&mut cycle.lost, &cycle.chosen);
        let progress = line.poll(now, &mut |answer| {
            let of = chosen.iter().find(|chosen| chosen.id == answer.status.id);
            let Some((chosen, slot)) = of.and_then(|of| Some((of, slots.get_mut(of.member)?))) else {
                return;
            };
            let member = chosen.member;
            let error = answer.status.error;
            urgent |= error.alert() && slot.table.error.is_some() && slot.supply.error_bits == 0;
            if !answer.whole {
                emit(BusEvent::Refused {
                    member,
                    error: error.number(),
                });
                return;
            }
            let event = match asked {
                Some(Asked::Status | Asked::Again) => {
                    slot.read_in = cycle.number;
                    slot.take_status(chosen, &answer, now, settings.hot_c)
                }
                Some(Asked::Health(item)) => {
                    let confirmed = lost.get_mut(member);
                    slot.take_health(member, item, &answer, chosen.address, confirmed, settings.hot_c)
                }
                Some(Asked::Ping) | None => {
                    pinged = true;
                    None
                }
            };
            if let Some(event) = event {
                counters.stale += u64::from(matches!(event, BusEvent::Stale { .. }));
                counters.implausible += u64::from(matches!(event, BusEvent::Implausible { .. }));
                emit(event);
            }
        });
        let progress = progress.map_err(|source| BusError::transport(&settings.name, source))?;
        if urgent {
            cycle.urgent = Some(cycle.company);
        }
        if pinged && let Some(since) = cycle.pinging_since.take() {
            line.heard_of(since);
        }
        Ok(progress)
    }
}

/// Who of a company is asked now.
fn choose(company: &Company, asked: Asked, slots: &mut [Slot], cycle: u64, chosen: &mut Vec<Chosen>) {
    chosen.clear();
    for &member in &company.members {
        let Some(slot) = slots.get_mut(member) else {
            continue;
        };
        let wanted = match slot.presence {
            Presence::Present => true,
            Presence::Doubtful => matches!(asked, Asked::Status | Asked::Again),
            Presence::Absent => asked == Asked::Status && cycle >= slot.probe_at,
        };
        let wanted = wanted && !(asked == Asked::Again && slot.read_in == cycle);
        let block = match asked {
            Asked::Health(item) => slot.health_block(item),
            Asked::Status | Asked::Again | Asked::Ping => Some(slot.table.status),
        };
        if let Some(block) = block.filter(|_| wanted) {
            chosen.push(Chosen {
                member,
                id: slot.member.id(),
                block,
                address: block.address,
                bytes: block.bytes,
            });
        }
    }
}

/// Gives everybody a length that nobody owes; takes out those for whom there is none.
fn give_lengths(line: &Line, company: &Company, chosen: &mut Vec<Chosen>) {
    let owed = line.owed();
    if !owed.has_room_for(chosen.len()) {
        chosen.clear();
    }
    if owed.is_empty() {
        return;
    }
    if !company.syncs() {
        chosen.retain_mut(|one| {
            let free = owed.free_length(&std::iter::once(one.id), one.block.lengths());
            one.bytes = free.unwrap_or(0);
            one.address = one.block.address_for(one.bytes);
            free.is_some()
        });
        return;
    }
    let Some(block) = chosen.first().map(|chosen| chosen.block) else {
        return;
    };
    let free = owed.free_length(&chosen.iter().map(|one| one.id), block.lengths());
    // If everybody can be asked for none, that for which most can.
    let owing = |bytes: &u16| chosen.iter().filter(|one| owed.owes(one.id, *bytes)).count();
    let bytes = free
        .or_else(|| block.lengths().min_by_key(owing))
        .unwrap_or(block.bytes);
    chosen.retain_mut(|one| {
        one.bytes = bytes;
        one.address = block.address_for(bytes);
        !owed.owes(one.id, bytes)
    });
}

/// The instruction that asks them. Ids, lengths and addresses are those of members, so nothing can be wrong with them.
fn append_read(line: &mut Line, company: &Company, chosen: &[Chosen], fast: bool) {
    let protocol = company.protocol;
    let out = line.packet_so_far();
    let ids = chosen.iter().map(|chosen| chosen.id);
    let items = chosen
        .iter()
        .map(|chosen| (chosen.id, chosen.address, chosen.bytes));
    let _ = match (chosen, company.syncs(), fast) {
        ([], _, _) => Ok(()),
        ([only], _, _) => framing::read(protocol, out, only.id, only.address, only.bytes),
        ([first, ..], true, true) => framing::fast_sync_read(protocol, out, first.address, first.bytes, ids),
        ([first, ..], true, false) => framing::sync_read(protocol, out, first.address, first.bytes, ids),
        (_, false, true) => framing::fast_bulk_read(protocol, out, items),
        (_, false, false) => framing::bulk_read(protocol, out, items),
    };
}

impl Slot {
    /// Takes in one answer to the status read; the event says what was wrong with it, or that it is back.
    fn take_status(
        &mut self,
        chosen: &Chosen,
        answer: &Answer<'_>,
        now: Instant,
        hot_c: f64,
    ) -> Option<BusEvent> {
        let was = self.presence;
        let member = chosen.member;
        let (data, start) = (answer.status.data, chosen.address);
        let reading = self
            .member
            .reading(&self.table, data, start, answer.measured, self.reading);
        let reading = match reading {
            Ok(reading) => reading,
            Err(counts) => return Some(BusEvent::Implausible { member, counts }),
        };
        let verdict = reading.tick.map_or(Verdict::Fresh, |tick| {
            self.freshness.judge(tick, answer.sent, answer.turn, now)
        });
        match verdict {
            Verdict::Fresh => self.late_in_a_row = 0,
            Verdict::Stale { by_ms } => {
                self.late_in_a_row = self.late_in_a_row.saturating_add(1);
                return Some(BusEvent::Stale { member, by_ms });
            }
            Verdict::Restarted => return Some(BusEvent::Restarted { member }),
        }
        self.reading = Some(reading);
        self.presence = Presence::Present;
        self.misses = 0;
        if std::mem::take(&mut self.let_go) {
            return Some(BusEvent::Restarted { member });
        }
        if was == Presence::Absent {
            return Some(BusEvent::Returned { member });
        }
        self.take_what_else_it_says(member, answer, start, hot_c)
    }

    /// Errors and supply, where answers tell of them.
    fn take_what_else_it_says(
        &mut self,
        member: usize,
        answer: &Answer<'_>,
        start: u16,
        hot_c: f64,
    ) -> Option<BusEvent> {
        let told = reported(self.member.servo(), answer.status.error);
        if let Some(bits) = told.filter(|bits| *bits != self.supply.error_bits) {
            return self.take_errors(member, bits);
        }
        self.table.in_status(self.table.temperature)?;
        let was_hot = self.is_hot(member, hot_c).is_some();
        self.take_supply(answer.status.data, start);
        self.is_hot(member, hot_c).filter(|_| !was_hot)
    }
}
