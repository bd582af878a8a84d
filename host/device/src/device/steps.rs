//! Doing on the line what a codec wants done, in order: waits, late answers, refusals.

use crate::clock::Instant;
use crate::codec::{Answer, Codec, Outgoing, Step};
use crate::transport::{Transport, TransportError};

/// Steps done in one go, so that a codec which answers every answer with a question cannot hold up the others.
const STEPS_MAX: usize = 256;
/// The longest feature report a transport reads: HID's own limit is 4096 bytes.
const FEATURE_BYTES_MAX: usize = 4096;

/// What is still to be done, and until when nothing is.
#[derive(Debug, Default)]
pub(super) struct Steps {
    pub(super) queue: Outgoing,
    idle_until: Option<Instant>,
    /// Reports that the device would not take.
    pub(super) refused: u64,
}

impl Steps {
    /// Forgets everything: the line is another.
    pub(super) fn clear(&mut self) {
        self.queue.clear();
        self.idle_until = None;
    }

    /// Does what can be done now. True: an answer came, so the codec may have more to say.
    pub(super) fn run(
        &mut self,
        now: Instant,
        transport: &mut dyn Transport,
        codec: &mut dyn Codec,
    ) -> Result<bool, TransportError> {
        let mut answered = false;
        for _ in 0..STEPS_MAX {
            if self.idle_until.is_some_and(|until| now < until) {
                break;
            }
            self.idle_until = None;
            let Some(step) = self.queue.next_step() else {
                break;
            };
            match step {
                Step::Bytes(bytes) => transport.write(&bytes)?,
                Step::Report(bytes) => {
                    if let Err(error) = transport.write(&bytes) {
                        // A lamp that a device lacks is no reason to let go of it.
                        self.refused += 1;
                        tracing::warn!("output report not taken: {}", bearable(error)?);
                    }
                }
                Step::Baud(baud) => transport.set_baud(baud)?,
                Step::Feature(bytes) => match set_feature(transport, &bytes)? {
                    Set::Done => {}
                    Set::Pending => {
                        self.queue.put_back(Step::Feature(bytes));
                        break;
                    }
                    Set::Refused(answer) => {
                        self.refused += 1;
                        codec.answer(answer, now, &mut self.queue);
                        answered = true;
                    }
                },
                Step::Wait(span) => self.idle_until = Some(now.after(span)),
                question => {
                    let Some(answer) = ask(transport, &question)? else {
                        self.queue.put_back(question);
                        break;
                    };
                    codec.answer(answer, now, &mut self.queue);
                    answered = true;
                }
            }
        }
        Ok(answered)
    }
}

/// A refusal in words; an error only where the device is gone.
fn bearable(error: TransportError) -> Result<String, TransportError> {
    if error.is_gone() {
        Err(error)
    } else {
        Ok(error.to_string())
    }
}

enum Set {
    Done,
    Pending,
    Refused(Answer),
}

fn set_feature(transport: &mut dyn Transport, bytes: &[u8]) -> Result<Set, TransportError> {
    match transport.write_feature(bytes) {
        Ok(Some(())) => Ok(Set::Done),
        Ok(None) => Ok(Set::Pending),
        Err(error) => Ok(Set::Refused(Answer::Feature {
            id: bytes.first().copied().unwrap_or_default(),
            bytes: Err(bearable(error)?),
        })),
    }
}

/// `None`: not answered yet, or no question.
fn ask(transport: &mut dyn Transport, question: &Step) -> Result<Option<Answer>, TransportError> {
    match *question {
        Step::AskFeature { id, bytes } => {
            let mut buffer = vec![0; usize::from(bytes).min(FEATURE_BYTES_MAX)];
            let bytes = match transport.read_feature(id, &mut buffer) {
                Ok(None) => return Ok(None),
                Ok(Some(count)) => {
                    buffer.truncate(count);
                    Ok(buffer)
                }
                Err(error) => Err(bearable(error)?),
            };
            Ok(Some(Answer::Feature { id, bytes }))
        }
        Step::AskString(index) => {
            let raw = match transport.read_string(index) {
                Ok(None) => return Ok(None),
                Ok(Some(raw)) => Ok(raw),
                Err(error) => Err(bearable(error)?),
            };
            Ok(Some(Answer::Text { index, raw }))
        }
        Step::AskDescriptor => {
            let bytes = match transport.report_descriptor() {
                Ok(bytes) => Ok(bytes),
                Err(error) => Err(bearable(error)?),
            };
            Ok(Some(Answer::Descriptor(bytes)))
        }
        _ => Ok(None),
    }
}
