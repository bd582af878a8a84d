//! The SGI dial and button box, and its imagined kin with displays.
//!
//! Source: `docs/protocols/sgi-dial-box.md`.

mod report;
mod shown;

use super::{Codec, Counters, Feedback, InputEvent, Outgoing};
use crate::clock::Instant;
use device_profiles::{ControlClass, InputProfile};
use report::{Report, Reports};
use shown::Shown;
use std::time::Duration;

/// "Initialise", and the box's answer to it.
const INITIALISE: u8 = 0x20;
/// Dials of a mask report absolute counts by themselves.
const DIALS_ABSOLUTE: u8 = 0x50;
/// Buttons of a mask are enabled.
const BUTTONS_ENABLE: u8 = 0x71;
/// Buttons of a mask report by themselves.
const BUTTONS_REPORT: u8 = 0x73;

/// How long the box may take to answer (VRPN waits as long).
const ANSWER_LIMIT: Duration = Duration::from_secs(1);
/// An answer this soon after another is a second box on the chain, not a power cycle: the answers of a chained
/// pair are a byte apart, and no hand switches a box off and on within it. The project's own decision.
const CHAIN_SPAN: Duration = Duration::from_millis(250);
/// A report is three bytes, 3.1 ms at 9600 baud; one that has not ended long after that never will.
const REPORT_LIMIT: Duration = Duration::from_millis(100);

/// Where the conversation stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// Not begun.
    Idle,
    /// Asked to initialise; the time limit.
    Asked { until: Instant },
    /// Answered; the set-up is still to be sent.
    Answered,
    /// Reporting; until then further answers are a chained box's.
    Running { chained_until: Instant },
}

/// The host's side of the dial box.
#[derive(Debug)]
pub struct SgiDialBox {
    dials: u8,
    buttons: u8,
    starts_at_zero: bool,
    phase: Phase,
    /// Whether `Started` has been said.
    known: bool,
    /// An answer nobody asked for has come.
    surprised: bool,
    reports: Reports,
    /// When an unfinished report was first noticed.
    unfinished_since: Option<Instant>,
    counts: [Option<u16>; 16],
    down: u32,
    shown: Shown,
    counters: Counters,
}

/// The format has four bits for a dial.
fn dials_of(profile: &InputProfile) -> u8 {
    profile.count(ControlClass::Dial).min(16) as u8
}

impl SgiDialBox {
    /// For a box that has yet to be asked.
    pub fn new(profile: &InputProfile) -> Self {
        Self {
            dials: dials_of(profile),
            buttons: profile.count(ControlClass::Button).min(32) as u8,
            starts_at_zero: profile.sgi.is_some_and(|sgi| sgi.counts_start_at_zero),
            phase: Phase::Idle,
            known: false,
            surprised: false,
            reports: Reports::new(dials_of(profile)),
            unfinished_since: None,
            counts: [None; 16],
            down: 0,
            shown: Shown::new(profile),
            counters: Counters::default(),
        }
    }

    /// For a recording that begins when the box already reports.
    pub fn listening(profile: &InputProfile) -> Self {
        let mut codec = Self::new(profile);
        codec.phase = Phase::Running {
            chained_until: Instant::ZERO,
        };
        codec.known = true;
        codec.forget_counts();
        codec
    }

    fn forget_counts(&mut self) {
        self.counts = [self.starts_at_zero.then_some(0); 16];
    }

    fn ask(&mut self, now: Instant, out: &mut Outgoing) {
        out.bytes(&[INITIALISE]);
        self.surprised = false;
        self.phase = Phase::Asked {
            until: now.after(ANSWER_LIMIT),
        };
    }

    /// The order that works in VRPN: dials first, since enabling them disables the buttons; then the buttons
    /// twice, since the box does not always understand the first time; lamps and labels last.
    fn set_up(&mut self, out: &mut Outgoing) {
        let dials = low_bits(self.dials).to_be_bytes();
        out.bytes(&[DIALS_ABSOLUTE, dials[2], dials[3]]);
        let buttons = low_bits(self.buttons).to_le_bytes();
        for _ in 0..2 {
            for command in [BUTTONS_ENABLE, BUTTONS_REPORT] {
                out.bytes(&[command]);
                out.bytes(&buttons);
            }
        }
        self.shown.send_everything(out);
    }

    fn take(&mut self, report: Report, emit: &mut dyn FnMut(InputEvent)) {
        let running = matches!(self.phase, Phase::Running { .. });
        match report {
            Report::Initialised => {
                self.counters.reports += 1;
                match self.phase {
                    Phase::Asked { .. } => {
                        self.phase = Phase::Answered;
                        // Every report after this byte counts from here.
                        self.forget_counts();
                    }
                    Phase::Running { .. } => self.surprised = true,
                    Phase::Idle | Phase::Answered => {}
                }
            }
            // What the box says before it has answered is left over from an earlier conversation.
            _ if !running && self.phase != Phase::Answered => {}
            Report::Absolute { control, count } => self.turned(control, count, emit),
            Report::Delta {
                control,
                delta_counts,
            } => {
                self.counters.reports += 1;
                emit(InputEvent::Dial {
                    control: control.into(),
                    delta_counts: delta_counts.into(),
                });
            }
            Report::Button { control, down } if control < self.buttons => {
                self.counters.reports += 1;
                let bit = 1 << control;
                self.down = if down { self.down | bit } else { self.down & !bit };
                emit(InputEvent::Button {
                    control: control.into(),
                    down,
                });
            }
            Report::Button { .. } => self.counters.rejected += 1,
            Report::Unknown => self.counters.unknown += 1,
        }
    }

    fn turned(&mut self, control: u8, count: u16, emit: &mut dyn FnMut(InputEvent)) {
        self.counters.reports += 1;
        let Some(before) = self.counts.get_mut(usize::from(control)) else {
            return;
        };
        // Counts wrap in sixteen bits, and so must their difference: 7FFF to 8000 is one step.
        let delta = before.map_or(0, |before| count.wrapping_sub(before) as i16);
        *before = Some(count);
        if delta != 0 {
            emit(InputEvent::Dial {
                control: control.into(),
                delta_counts: delta.into(),
            });
        }
    }

    fn give_up_late_report(&mut self, now: Instant) {
        if !self.reports.unfinished() {
            self.unfinished_since = None;
            return;
        }
        let since = *self.unfinished_since.get_or_insert(now);
        if now.since(since) > REPORT_LIMIT {
            self.reports.reset();
            self.unfinished_since = None;
            self.counters.rejected += 1;
        }
    }
}

impl Codec for SgiDialBox {
    fn start(&mut self, now: Instant, out: &mut Outgoing) {
        self.reports.reset();
        self.ask(now, out);
    }

    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        for &byte in bytes {
            if let Some(report) = self.reports.push(byte) {
                // The next one has its own time.
                self.unfinished_since = None;
                self.take(report, emit);
            }
        }
    }

    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        self.give_up_late_report(now);
        match self.phase {
            Phase::Asked { until } if now >= until => {
                // Half a report from before may have swallowed the answer.
                self.reports.reset();
                self.ask(now, out);
            }
            Phase::Answered => {
                self.set_up(out);
                self.surprised = false;
                self.phase = Phase::Running {
                    chained_until: now.after(CHAIN_SPAN),
                };
                emit(if self.known {
                    InputEvent::Restarted
                } else {
                    InputEvent::Started
                });
                self.known = true;
            }
            Phase::Running { chained_until } if self.surprised => {
                self.surprised = false;
                if now >= chained_until {
                    self.let_go(emit);
                    self.ask(now, out);
                }
            }
            Phase::Idle | Phase::Asked { .. } | Phase::Running { .. } => {}
        }
    }

    fn encode(&mut self, feedback: &Feedback, out: &mut Outgoing) {
        self.shown.want(feedback);
        if matches!(self.phase, Phase::Running { .. }) {
            self.shown.send_changes(out);
        }
    }

    fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        for control in (0..32).filter(|control| self.down >> control & 1 == 1) {
            emit(InputEvent::Button { control, down: false });
        }
        self.down = 0;
    }

    fn started(&self) -> bool {
        matches!(self.phase, Phase::Running { .. })
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}

/// The lowest `count` bits set.
fn low_bits(count: u8) -> u32 {
    1_u32.checked_shl(count.into()).map_or(u32::MAX, |bit| bit - 1)
}

#[cfg(test)]
mod tests;
