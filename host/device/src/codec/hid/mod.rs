//! HID devices: reports to events by a plan, which is compiled from a profile's tables or, without a profile, from
//! the device's own report descriptor.
//!
//! *Knows* what bits of a report mean and what follows from one report to the next (tools, fingers, counters).
//! *Must not know* how reports come, or how a device is woken: that is the handshake's affair.
//! *Start reading* at [`HidCodec`], then [`descriptor`] and the plan. Source: `docs/protocols/hid.md`.

mod bits;
mod compile;
pub mod descriptor;
mod generic;
#[cfg(test)]
mod known;
mod pictures;
mod plan;
mod run;
mod show;
mod tool;

pub use compile::PlanError;

use super::{Codec, Counters, Feedback, InputEvent, Outgoing, Surface};
use crate::clock::Instant;
use descriptor::{Descriptor, DescriptorError};
use device_profiles::{FieldName, InputProfile};
use pictures::Pictures;
use plan::Plan;
use run::{Outcome, Running};
use show::Shown;
use std::time::Duration;

/// The host's side of a HID device.
#[derive(Debug)]
pub struct HidCodec {
    plan: Plan,
    running: Running,
    surface: Option<Surface>,
    pointer: bool,
    shown: Shown,
    pictures: Pictures,
    leave_after: Option<Duration>,
    /// When the tool was last heard of.
    heard_at: Option<Instant>,
    state: State,
    counters: Counters,
}

/// Where the conversation stands: this codec itself asks nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// Nothing was said yet.
    Fresh,
    /// To be said with the next look: it reports.
    Starting { again: bool },
    /// It reports.
    Started,
}

impl HidCodec {
    /// For a device with a profile of format `hid`, taken out of [`device_profiles::Profiles`].
    ///
    /// # Errors
    /// When its layout is missing or its tables cannot be used.
    pub fn new(profile: &InputProfile) -> Result<Self, PlanError> {
        let plan = compile::compile(profile)?;
        let surface = profile.surface.map(|area| Surface {
            tilt_steps_per_rad: area.tilt_steps_per_rad,
            tilt_signs: plan.tilt_signs,
            twist_steps_per_turn: area.twist_steps_per_turn.map(f64::from),
            ..Surface::flat(area.counts, area.per_inch(), area.pressure)
        });
        let leave_after_ms = profile.tables().leave_after_ms;
        Ok(Self {
            leave_after: leave_after_ms.map(|ms| Duration::from_millis(ms.into())),
            shown: Shown::new(profile),
            pictures: Pictures::new(profile),
            ..Self::of(plan, surface, false)
        })
    }

    /// For a device without profile, by its report descriptor.
    ///
    /// # Errors
    /// When the descriptor breaks the rules; the error says where and how.
    pub fn generic(descriptor: &[u8]) -> Result<Self, DescriptorError> {
        let generic = generic::compile(&Descriptor::parse(descriptor)?);
        Ok(Self::of(generic.plan, generic.surface, generic.pointer))
    }

    fn of(plan: Plan, surface: Option<Surface>, pointer: bool) -> Self {
        Self {
            running: Running::new(&plan),
            plan,
            surface,
            pointer,
            shown: Shown::default(),
            pictures: Pictures::default(),
            leave_after: None,
            heard_at: None,
            state: State::Fresh,
            counters: Counters::default(),
        }
    }

    /// Takes the area and ranges that the device itself has told.
    pub fn set_surface(&mut self, surface: Surface) {
        self.surface = Some(surface);
    }

    /// Whether it is a mouse or the like, whose buttons belong to its pointer.
    pub fn is_pointer(&self) -> bool {
        self.pointer
    }

    /// Whether anything a hand does on the device can be told.
    pub fn tells_anything(&self) -> bool {
        let told = |name: FieldName| !matches!(name, FieldName::InRange | FieldName::TouchDown);
        let mut groups = self.plan.reports.iter().flat_map(|report| &report.groups);
        groups.any(|g| !g.arrays.is_empty() || g.fields.iter().any(|f| told(f.name)))
    }
}

/// What a device without profile has, as a profile would say it: controls, ranges and surface.
///
/// # Errors
/// When the descriptor breaks the rules.
pub fn describe(descriptor: &[u8]) -> Result<InputProfile, DescriptorError> {
    Ok(generic::compile(&Descriptor::parse(descriptor)?).profile)
}

impl Codec for HidCodec {
    fn start(&mut self, _now: Instant, _out: &mut Outgoing) {
        self.state = State::Starting {
            again: self.state != State::Fresh,
        };
    }

    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        match self.running.take(&self.plan, bytes, emit) {
            Outcome::Understood => self.counters.reports += 1,
            Outcome::Unknown => self.counters.unknown += 1,
            Outcome::Rejected => self.counters.rejected += 1,
        }
    }

    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        if let State::Starting { again } = self.state {
            self.state = State::Started;
            self.shown.send_everything(out);
            self.pictures.send_everything(out);
            emit(if again {
                InputEvent::Restarted
            } else {
                InputEvent::Started
            });
        }
        if std::mem::take(&mut self.running.tool_heard) {
            self.heard_at = Some(now);
        }
        let silent = |at: Instant| self.leave_after.is_some_and(|limit| now.since(at) >= limit);
        if self.running.held.is_some() && self.heard_at.is_some_and(silent) {
            self.running
                .held
                .leave(&mut |sample| emit(InputEvent::Pen(sample)));
        }
    }

    fn encode(&mut self, feedback: &Feedback, out: &mut Outgoing) {
        let started = self.state == State::Started;
        self.shown.want(feedback, started, out);
        self.pictures.want(feedback, started, out);
    }

    fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        self.running.let_go(emit);
    }

    fn started(&self) -> bool {
        self.state == State::Started
    }

    fn counters(&self) -> Counters {
        self.counters
    }

    fn surface(&self) -> Option<Surface> {
        self.surface
    }
}
