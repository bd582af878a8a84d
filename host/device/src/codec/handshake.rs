//! What has to be done before a device speaks in its full form, as its profile lists it: strings that are read,
//! features and reports that are sent, waits, what should come back, ranges the device tells.
//!
//! Stands in front of the codec that reads the reports, which it begins when all steps are done. The device may go
//! away at any step (some return as another product): [`Codec::start`] begins again from the first.

mod ranges;

use super::outline::{Outline, ReportKind};
use super::{Answer, Codec, Counters, Feedback, InputEvent, Outgoing, Step, Surface, usb_text};
use crate::clock::Instant;
use device_profiles::{HexBytes, InitAction, InitStep, InputProfile};
use std::time::Duration;

/// Longest wait for one step's end, beside what the step itself waits. Transports give up on a question sooner.
const STEP_LIMIT: Duration = Duration::from_secs(3);
/// How often a step is tried: some devices are too slow for the first question.
const TRIES: u8 = 3;
/// Between two tries.
const TRY_PAUSE: Duration = Duration::from_millis(100);
/// After the last try failed, before the whole handshake begins again.
const AGAIN_AFTER: Duration = Duration::from_secs(2);
/// Asked for where the descriptor does not tell a feature report's length; the system cuts it to the true one.
const FEATURE_BYTES: u16 = 64;

/// A codec behind a handshake.
pub struct Handshake {
    steps: Vec<InitStep>,
    inner: Box<dyn Codec>,
    stage: Stage,
    outline: Option<Outline>,
    tries: u8,
    /// What was refused during the present step.
    refused: Option<String>,
    told: Option<Surface>,
    text: Option<String>,
    trouble: Option<String>,
    rejected: u64,
    /// What the codec behind says too early.
    unsaid: Outgoing,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Idle,
    /// Asked for the report descriptor.
    Describing {
        until: Instant,
    },
    /// In the step of that number.
    Doing {
        step: usize,
        until: Instant,
    },
    /// Given up for now.
    Pausing {
        until: Instant,
    },
    Done,
}

impl Handshake {
    /// In front of `inner`, with the profile's steps. A profile without any needs no handshake.
    pub fn new(profile: &InputProfile, inner: Box<dyn Codec>) -> Self {
        Self::of_steps(profile.init.clone(), inner)
    }

    /// In front of `inner`, with these steps.
    pub fn of_steps(steps: Vec<InitStep>, inner: Box<dyn Codec>) -> Self {
        Self {
            steps,
            inner,
            stage: Stage::Idle,
            outline: None,
            tries: 0,
            refused: None,
            told: None,
            text: None,
            trouble: None,
            rejected: 0,
            unsaid: Outgoing::new(),
        }
    }

    /// Does a step, or is done after the last one.
    fn go_to(&mut self, step: usize, now: Instant, out: &mut Outgoing) {
        self.refused = None;
        let Some(action) = self.steps.get(step).map(InitStep::action) else {
            self.stage = Stage::Done;
            self.trouble = None;
            self.inner.start(now, out);
            return;
        };
        let mut until = now.after(STEP_LIMIT);
        match action {
            Some(InitAction::String(index)) => out.step(Step::AskString(index)),
            Some(InitAction::ReadFeature(id)) => out.step(Step::AskFeature {
                id,
                bytes: self.length(ReportKind::Feature, id).unwrap_or(FEATURE_BYTES),
            }),
            Some(InitAction::Feature(bytes)) => {
                out.step(Step::Feature(self.filled_up(ReportKind::Feature, bytes)));
                out.step(Step::AskDescriptor);
            }
            Some(InitAction::Output(bytes)) => {
                out.step(Step::Report(self.filled_up(ReportKind::Output, bytes)));
                out.step(Step::AskDescriptor);
            }
            Some(InitAction::Wait(ms)) => {
                let span = Duration::from_millis(ms.into());
                until = until.after(span);
                out.step(Step::Wait(span));
                out.step(Step::AskDescriptor);
            }
            // The profile's check refuses such steps; one that slipped through is none.
            None => out.step(Step::AskDescriptor),
        }
        self.stage = Stage::Doing { step, until };
    }

    fn length(&self, kind: ReportKind, id: u8) -> Option<u16> {
        self.outline.as_ref()?.bytes(kind, id)
    }

    /// A report filled up with zeros to the length the device has for it. Its id stands first, even where it is 0 and
    /// not sent.
    fn filled_up(&self, kind: ReportKind, bytes: &[u8]) -> Vec<u8> {
        let mut report = bytes.to_vec();
        let id = report.first().copied().unwrap_or(0);
        if let Some(length) = self.length(kind, id) {
            let length = usize::from(length) + usize::from(id == 0);
            if report.len() < length {
                report.resize(length, 0);
            }
        }
        report
    }

    /// The present step has ended, well or not.
    fn ended(&mut self, result: Result<(), String>, now: Instant, out: &mut Outgoing) {
        let Stage::Doing { step, .. } = self.stage else {
            return;
        };
        let optional = self.steps.get(step).is_some_and(|s| s.optional);
        match result {
            Ok(()) => {
                self.tries = 0;
                self.go_to(step + 1, now, out);
            }
            Err(why) => {
                self.rejected += 1;
                self.tries += 1;
                if self.tries < TRIES {
                    out.step(Step::Wait(TRY_PAUSE));
                    self.go_to(step, now, out);
                } else if optional {
                    tracing::debug!(step, "optional step of the handshake: {why}");
                    self.tries = 0;
                    self.go_to(step + 1, now, out);
                } else {
                    self.tries = 0;
                    self.trouble = Some(format!("step {} of its handshake: {why}", step + 1));
                    self.stage = Stage::Pausing {
                        until: now.after(AGAIN_AFTER),
                    };
                }
            }
        }
    }

    /// What came back in the present step; `None` where it belongs to another.
    fn judge(&mut self, answer: Answer) -> Option<Result<(), String>> {
        let Stage::Doing { step, .. } = self.stage else {
            return None;
        };
        let asked = self.steps.get(step)?;
        match (asked.action(), answer) {
            (Some(InitAction::String(wanted)), Answer::Text { index, raw }) if index == wanted => {
                Some(raw.and_then(|raw| learn(asked, &raw, &mut self.told, &mut self.text)))
            }
            (Some(InitAction::ReadFeature(wanted)), Answer::Feature { id, bytes }) if id == wanted => {
                Some(bytes.and_then(|bytes| expected(asked, &bytes)))
            }
            (Some(InitAction::Feature(_)), Answer::Feature { bytes: Err(why), .. }) => {
                self.refused = Some(why);
                None
            }
            (Some(InitAction::String(_) | InitAction::ReadFeature(_)), _) => None,
            // The descriptor was asked for behind the step, so the step is over.
            (_, Answer::Descriptor(_)) => Some(self.refused.take().map_or(Ok(()), Err)),
            _ => None,
        }
    }
}

/// Takes what a string tells.
fn learn(
    step: &InitStep,
    raw: &[u8],
    told: &mut Option<Surface>,
    text: &mut Option<String>,
) -> Result<(), String> {
    if let Some(from) = step.range_from {
        *told = Some(ranges::surface(from, raw)?);
        return Ok(());
    }
    let said = usb_text::text(raw).map_err(|error| error.to_string())?;
    if let Some(expect) = &step.expect
        && !said.starts_with(expect.as_str())
    {
        return Err(format!(
            "expected a string that begins with \"{expect}\", found \"{said}\""
        ));
    }
    *text = Some(said);
    Ok(())
}

/// Whether a feature report begins as it should.
fn expected(step: &InitStep, bytes: &[u8]) -> Result<(), String> {
    let Some(expect) = &step.expect else {
        return Ok(());
    };
    let wanted = HexBytes::parse(expect).unwrap_or_default();
    if bytes.starts_with(&wanted.0) {
        return Ok(());
    }
    Err(format!(
        "expected a feature report that begins with {wanted}, found {}",
        HexBytes(bytes.to_vec())
    ))
}

impl Codec for Handshake {
    fn start(&mut self, now: Instant, out: &mut Outgoing) {
        self.tries = 0;
        out.step(Step::AskDescriptor);
        self.stage = Stage::Describing {
            until: now.after(STEP_LIMIT),
        };
    }

    /// Before the handshake is over reports have another form, and mean nothing.
    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        if self.stage == Stage::Done {
            self.inner.decode(bytes, emit);
        }
    }

    fn answer(&mut self, answer: Answer, now: Instant, out: &mut Outgoing) {
        match self.stage {
            Stage::Done => self.inner.answer(answer, now, out),
            Stage::Describing { .. } => {
                if let Answer::Descriptor(descriptor) = answer {
                    // Without one reports are sent as long as the profile has them.
                    self.outline = descriptor.ok().map(|bytes| Outline::of(&bytes));
                    self.go_to(0, now, out);
                }
            }
            Stage::Doing { .. } => {
                if let Some(result) = self.judge(answer) {
                    self.ended(result, now, out);
                }
            }
            Stage::Idle | Stage::Pausing { .. } => {}
        }
    }

    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        match self.stage {
            Stage::Done => self.inner.advance(now, out, emit),
            Stage::Describing { until } if now >= until => self.go_to(0, now, out),
            Stage::Doing { until, .. } if now >= until => {
                let why = format!("no answer within {} s", STEP_LIMIT.as_secs());
                self.ended(Err(why), now, out);
            }
            Stage::Pausing { until } if now >= until => self.start(now, out),
            _ => {}
        }
    }

    fn encode(&mut self, feedback: &Feedback, out: &mut Outgoing) {
        if self.stage == Stage::Done {
            self.inner.encode(feedback, out);
        } else {
            // Kept by the codec behind, which says everything when it is started.
            self.inner.encode(feedback, &mut self.unsaid);
            self.unsaid.clear();
        }
    }

    fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        self.stage = Stage::Idle;
        self.inner.let_go(emit);
    }

    fn started(&self) -> bool {
        self.stage == Stage::Done && self.inner.started()
    }

    fn counters(&self) -> Counters {
        let inner = self.inner.counters();
        Counters {
            rejected: inner.rejected + self.rejected,
            ..inner
        }
    }

    /// As the device told, with what only the profile knows.
    fn surface(&self) -> Option<Surface> {
        let known = self.inner.surface();
        match (self.told, known) {
            (Some(told), Some(known)) => Some(Surface {
                max_counts: told.max_counts,
                counts_per_inch: told.counts_per_inch,
                pressure_max: told.pressure_max,
                ..known
            }),
            (told, known) => told.or(known),
        }
    }

    fn trouble(&self) -> Option<&str> {
        self.trouble.as_deref().or_else(|| self.inner.trouble())
    }

    fn identity(&self) -> Option<&str> {
        self.inner.identity().or(self.text.as_deref())
    }
}
