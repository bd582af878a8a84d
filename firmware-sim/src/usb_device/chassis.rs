//! What all simulated USB devices have in common: time, power, polls, scripts, faults. The rest is [`Inside`].

use super::{Report, Request, Shown, Stall, UsbDevice, UsbFacts};
use crate::hands::{Hands, Schedule, Touch};
use crate::input_fault::{Faults, InputFault};
use crate::script::Script;
use std::collections::VecDeque;

/// How long a device stays off the bus when it leaves by itself or its power is switched. Ours: long enough that a host
/// which looks every few hundred milliseconds sees it gone.
pub(crate) const AWAY_US: u64 = 500_000;
/// Reports that are kept for a host that asks late; the oldest go first.
const READY_MAX: usize = 1 << 16;

/// The moment something happens, and what the device may do to the world around it.
#[derive(Debug)]
pub(crate) struct Moment<'a> {
    /// Now.
    pub(crate) now_us: u64,
    shown: &'a mut Vec<(u64, Shown)>,
    leaves: &'a mut bool,
}

impl Moment<'_> {
    /// The host had something shown.
    pub(crate) fn show(&mut self, what: Shown) {
        self.shown.push((self.now_us, what));
    }

    /// Drops off the bus, to come back as what [`Inside::facts`] says then.
    pub(crate) fn leave(&mut self) {
        *self.leaves = true;
    }
}

/// What differs from device to device. Nothing here knows the time but by `Moment`.
pub(crate) trait Inside: Send {
    /// What the device says of itself the next time it comes onto the bus.
    fn facts(&self) -> UsbFacts;

    /// Least time between two reports.
    fn interval_us(&self) -> u64;

    /// Power was lost: modes are forgotten. Hands stay where they are.
    fn lose_power(&mut self);

    /// Reporting begins anew: what waited is forgotten, what is held now will be reported.
    fn begin_anew(&mut self);

    /// Whether the device now reports what it is bought for: scripts begin with that.
    fn is_reporting(&self) -> bool {
        true
    }

    /// A hand does something; false: no such control.
    fn touch(&mut self, at: &mut Moment<'_>, touch: &Touch) -> bool;

    /// When something under way (a turn that takes time) makes its next step.
    fn next_step_us(&self) -> Option<u64> {
        None
    }

    /// Makes the steps due at `at_us`.
    fn step(&mut self, _at_us: u64) {}

    /// Whether there is something to report.
    fn has_report(&self) -> bool;

    /// Takes the next report; what happened since the last one is in it.
    fn take_report(&mut self) -> Option<Report>;

    /// The report the device would give if it were asked again: what a flood is made of.
    fn same_again(&self) -> Option<Report>;

    /// An output report.
    fn output(&mut self, _at: &mut Moment<'_>, _interface: u8, _bytes: &[u8]) -> Result<(), Stall> {
        Err(Stall)
    }

    /// A feature report is set.
    fn set_feature(&mut self, _at: &mut Moment<'_>, _interface: u8, _bytes: &[u8]) -> Result<(), Stall> {
        Err(Stall)
    }

    /// A feature report is asked for.
    fn feature(&mut self, _interface: u8, _id: u8) -> Result<Vec<u8>, Stall> {
        Err(Stall)
    }

    /// A string that is none of the usual ones.
    fn string(&mut self, _at: &mut Moment<'_>, _index: u8) -> Result<Vec<u8>, Stall> {
        Err(Stall)
    }

    /// A vendor's request.
    fn request(&mut self, _at: &mut Moment<'_>, _request: Request, _data: &[u8]) -> Result<Vec<u8>, Stall> {
        Err(Stall)
    }
}

/// A device with its cable and its hands.
#[derive(Debug)]
pub(crate) struct Chassis<D> {
    inside: D,
    facts: UsbFacts,
    reached_us: u64,
    connected: bool,
    /// Off the bus by its own doing until then.
    away_until_us: Option<u64>,
    arrivals: u32,
    /// Interfaces somebody listens to, bit n for interface n.
    listened: u32,
    schedule: Schedule,
    ready: VecDeque<(u64, Report)>,
    next_slot_us: u64,
    faults: Faults<Report>,
    shown: Vec<(u64, Shown)>,
}

/// Does something to the inside at a moment, and what it wants of the bus after.
macro_rules! at_a_moment {
    ($self:ident, $at:ident, $doing:expr) => {{
        let mut leaves = false;
        let mut $at = Moment {
            now_us: $self.reached_us,
            shown: &mut $self.shown,
            leaves: &mut leaves,
        };
        let done = $doing;
        if leaves {
            $self.leave_bus();
        }
        done
    }};
}

impl<D: Inside> Chassis<D> {
    /// The device, plugged in, nobody listening.
    pub(crate) fn new(inside: D) -> Self {
        Self {
            facts: inside.facts(),
            inside,
            reached_us: 0,
            connected: true,
            away_until_us: None,
            arrivals: 1,
            listened: 0,
            schedule: Schedule::default(),
            ready: VecDeque::new(),
            next_slot_us: 0,
            faults: Faults::default(),
            shown: Vec::new(),
        }
    }

    fn is_on_bus(&self) -> bool {
        self.connected && self.away_until_us.is_none()
    }

    fn leave_bus(&mut self) {
        self.away_until_us = Some(self.reached_us + AWAY_US);
        self.listened = 0;
        self.ready.clear();
    }

    /// Onto the bus, as what the inside says it is now.
    fn arrive(&mut self) {
        self.away_until_us = None;
        self.facts = self.inside.facts();
        self.arrivals += 1;
        self.next_slot_us = self.reached_us;
        self.inside.begin_anew();
    }

    /// Counts a request and answers whether the device is still there for it.
    fn asked(&mut self, now_us: u64) -> Result<(), Stall> {
        self.advance(now_us);
        if self.is_on_bus() && self.faults.unplugs_at_this_request() {
            self.pull();
        }
        if self.is_on_bus() { Ok(()) } else { Err(Stall) }
    }

    fn pull(&mut self) {
        self.connected = false;
        self.away_until_us = None;
        self.listened = 0;
        self.ready.clear();
        self.inside.lose_power();
    }

    /// When the next report may leave, if there is one.
    fn slot_us(&self) -> Option<u64> {
        if !self.is_on_bus() || self.listened == 0 {
            return None;
        }
        let due = self.inside.has_report() || self.faults.has_early();
        let usual = due.then(|| self.next_slot_us.max(self.reached_us));
        usual.into_iter().chain(self.faults.flood_slot_us()).min()
    }

    /// Lets everything happen, in its order, that happens up to `to_us`.
    fn advance(&mut self, to_us: u64) {
        loop {
            let hand_us = self.schedule.next_ns().map(|ns| ns / 1000);
            let events = [
                self.away_until_us.filter(|_| self.connected),
                hand_us,
                self.inside.next_step_us(),
                self.slot_us(),
            ];
            let Some(at_us) = events.into_iter().flatten().min().filter(|&at| at <= to_us) else {
                break;
            };
            self.reached_us = self.reached_us.max(at_us);
            let now_us = self.reached_us;
            let due = |event: Option<u64>| event.is_some_and(|at| at <= now_us);
            if self.connected && due(self.away_until_us) {
                self.arrive();
            } else if due(hand_us) {
                if let Some(touch) = self.schedule.pop() {
                    self.touch_now(&touch);
                }
            } else if due(self.inside.next_step_us()) {
                self.inside.step(now_us);
            } else {
                self.report_now();
            }
        }
        self.reached_us = self.reached_us.max(to_us);
    }

    fn report_now(&mut self) {
        let now_us = self.reached_us;
        let floods = self.faults.flood_begins_slot(now_us);
        let interface = self.facts.main;
        let early = self.faults.early().map(|bytes| Report { interface, bytes });
        let report = early.or_else(|| self.inside.take_report());
        let report = report.or_else(|| floods.then(|| self.inside.same_again()).flatten());
        // What leaves nothing on the wire takes no slot of it.
        let Some(report) = report else { return };
        self.next_slot_us = now_us + self.inside.interval_us();
        for report in self.faults.mangle(report) {
            if self.listened >> u32::from(report.interface).min(31) & 1 == 0 {
                continue;
            }
            if self.ready.len() >= READY_MAX {
                self.ready.pop_front();
            }
            self.ready.push_back((now_us, report));
        }
    }

    fn touch_now(&mut self, touch: &Touch) -> bool {
        if *touch == Touch::PowerCycle {
            self.inside.lose_power();
            self.leave_bus();
            return true;
        }
        if let Touch::Noise(_) = touch {
            self.faults.add(self.reached_us, InputFault::Garbage);
            return true;
        }
        at_a_moment!(self, at, self.inside.touch(&mut at, touch))
    }

    /// Scripts begin once the device reports and somebody listens.
    fn begin_script(&mut self) {
        if self.is_on_bus() && self.listened != 0 && self.inside.is_reporting() {
            self.schedule.begin(self.reached_us * 1000);
        }
    }
}

impl<D: Inside> Hands for Chassis<D> {
    fn touch(&mut self, now_us: u64, touch: &Touch) -> bool {
        self.advance(now_us);
        let touched = self.touch_now(touch);
        self.advance(now_us);
        touched
    }

    fn reporting_since_us(&self) -> Option<u64> {
        self.schedule.since_us()
    }
}

impl<D: Inside> UsbDevice for Chassis<D> {
    fn facts(&self) -> &UsbFacts {
        &self.facts
    }

    fn arrival(&mut self, now_us: u64) -> u32 {
        self.advance(now_us);
        if self.is_on_bus() { self.arrivals } else { 0 }
    }

    fn plug(&mut self, now_us: u64, connected: bool) {
        self.advance(now_us);
        if connected == self.connected {
            return;
        }
        if connected {
            self.connected = true;
            self.arrive();
        } else {
            self.pull();
        }
    }

    fn listen(&mut self, now_us: u64, interface: u8, on: bool) {
        self.advance(now_us);
        let bit = 1 << u32::from(interface).min(31);
        if on && self.is_on_bus() {
            if self.listened == 0 {
                self.inside.begin_anew();
            }
            self.listened |= bit;
        } else {
            self.listened &= !bit;
        }
        self.begin_script();
    }

    fn arrived_report(&mut self, now_us: u64) -> Option<(u64, Report)> {
        self.advance(now_us);
        self.ready.pop_front()
    }

    fn next_report_us(&self) -> Option<u64> {
        let made = self.ready.front().map(|&(at_us, _)| at_us);
        made.or_else(|| {
            // A hand or a turn may bring a report sooner than the slot of one that waits.
            let events = [
                self.slot_us(),
                self.schedule.next_ns().map(|ns| ns / 1000),
                self.inside.next_step_us(),
            ];
            events.into_iter().flatten().min()
        })
    }

    fn output(&mut self, now_us: u64, interface: u8, bytes: &[u8]) -> Result<(), Stall> {
        self.asked(now_us)?;
        let done = at_a_moment!(self, at, self.inside.output(&mut at, interface, bytes));
        self.begin_script();
        done
    }

    fn set_feature(&mut self, now_us: u64, interface: u8, bytes: &[u8]) -> Result<(), Stall> {
        self.asked(now_us)?;
        let done = at_a_moment!(self, at, self.inside.set_feature(&mut at, interface, bytes));
        self.begin_script();
        done
    }

    fn feature(&mut self, now_us: u64, interface: u8, id: u8) -> Result<Vec<u8>, Stall> {
        self.asked(now_us)?;
        self.inside.feature(interface, id)
    }

    fn string(&mut self, now_us: u64, index: u8) -> Result<Vec<u8>, Stall> {
        self.asked(now_us)?;
        let usual = self.facts.usual_string(index);
        let done = if let Some(bytes) = usual {
            Ok(bytes)
        } else {
            at_a_moment!(self, at, self.inside.string(&mut at, index))
        };
        self.begin_script();
        done
    }

    fn request(&mut self, now_us: u64, request: Request, data: &[u8]) -> Result<Vec<u8>, Stall> {
        self.asked(now_us)?;
        at_a_moment!(self, at, self.inside.request(&mut at, request, data))
    }

    fn inject(&mut self, now_us: u64, fault: InputFault) {
        self.advance(now_us);
        self.faults.add(self.reached_us, fault);
    }

    fn play(&mut self, script: &Script) {
        self.schedule.add(
            script
                .actions
                .iter()
                .map(|action| (action.at_us, action.touch.clone())),
        );
    }

    fn script_is_done(&self) -> bool {
        self.schedule.is_done()
    }

    fn drain_shown(&mut self) -> Vec<(u64, Shown)> {
        std::mem::take(&mut self.shown)
    }
}
