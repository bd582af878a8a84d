//! From power-up to reports: reset at every speed, ask, set up. Time limits at every step.

use super::answer::Question;
use crate::clock::Instant;
use crate::codec::Outgoing;
use device_profiles::InputProfile;
use std::time::Duration;

/// The tablet may stand at any of these speeds (inputattach tries them in this order).
const RESET_BAUDS: [u32; 3] = [38_400, 19_200, 9_600];
/// How long a tablet may take to answer; a PenPartner shows the end of its answer only by silence.
const ANSWER_LIMIT: Duration = Duration::from_secs(1);
/// An answer has at most 31 characters; what is longer is none.
const ANSWER_CHARACTERS_MAX: usize = 64;

/// Multi mode, origin in the upper left, all macro buttons, not group 1's, as fast as possible, no increments,
/// continuous, with pressure. Source: Linux `wacom_serial4.c`.
const SET_UP: &[u8] = b"MU1\rOC1\r~M0\r~M1\rIT0\rIN0\rSR\rZF1\r";
/// Reports tilt: after multi mode, which would undo it (xf86-input-wacom).
const TILT: &[u8] = b"FM1\r";
/// Starts sending.
const START: &[u8] = b"ST\r";
/// A PenPartner knows nothing but pressure on.
const SET_UP_PEN_PARTNER: &[u8] = b"PH1\r";

/// Where the conversation stands.
#[derive(Clone, Debug, Default)]
pub(super) enum Conversation {
    /// Not begun.
    #[default]
    Idle,
    /// Resetting: the next step is due at `due`.
    Resetting { step: usize, due: Instant },
    /// Asked, with what has come of the answer.
    Asked {
        question: Question,
        until: Instant,
        text: Vec<u8>,
    },
    /// Answered; what follows is still to be sent.
    Answered { question: Question },
    /// Reporting.
    Running,
}

impl Conversation {
    /// Does the first step.
    pub(super) fn begin(now: Instant, out: &mut Outgoing) -> Self {
        Self::reset_step(0, now, out)
    }

    /// Steps two by two: `\r$` and `\r#` at each speed; at last `SP` at the slowest, where the resets end.
    fn reset_step(step: usize, now: Instant, out: &mut Outgoing) -> Self {
        let wait_ms = match (RESET_BAUDS.get(step / 2), step % 2) {
            (Some(&baud), 0) => {
                out.baud(baud);
                out.bytes(b"\r$");
                250
            }
            (Some(_), _) => {
                out.bytes(b"\r#");
                75
            }
            (None, _) => {
                out.bytes(b"SP\r");
                30
            }
        };
        Self::Resetting {
            step,
            due: now.after(Duration::from_millis(wait_ms)),
        }
    }

    fn ask(question: Question, now: Instant, out: &mut Outgoing) -> Self {
        out.bytes(question.bytes());
        Self::Asked {
            question,
            until: now.after(ANSWER_LIMIT),
            text: Vec::new(),
        }
    }

    /// The open question, if one is.
    pub(super) fn question(&self) -> Option<Question> {
        match self {
            Self::Asked { question, .. } => Some(*question),
            _ => None,
        }
    }

    /// Takes a byte; gives the line it ends. Bytes nobody asked for vanish.
    pub(super) fn push(&mut self, byte: u8) -> Option<String> {
        let Self::Asked { text, .. } = self else {
            return None;
        };
        match byte {
            // Answers begin so; what stood before is the end of something else.
            b'~' => {
                text.clear();
                text.push(byte);
            }
            b'\r' if !text.is_empty() => {
                return Some(String::from_utf8_lossy(&std::mem::take(text)).into_owned());
            }
            // Packets that were still under way, and line ends of other makers.
            0x80.. | b'\r' | b'\n' => {}
            _ if !text.is_empty() && text.len() < ANSWER_CHARACTERS_MAX => text.push(byte),
            _ => {}
        }
        None
    }

    /// The open question has been answered.
    pub(super) fn answered(&mut self) {
        if let Self::Asked { question, .. } = *self {
            *self = Self::Answered { question };
        }
    }

    /// What has come of an answer when its time is up.
    pub(super) fn unended_answer(&mut self, now: Instant) -> Option<String> {
        match self {
            Self::Asked { until, text, .. } if now >= *until && !text.is_empty() => {
                Some(String::from_utf8_lossy(&std::mem::take(text)).into_owned())
            }
            _ => None,
        }
    }

    /// Goes on. True: reporting has just begun.
    pub(super) fn advance(
        &mut self,
        now: Instant,
        profile: &InputProfile,
        tilt: bool,
        out: &mut Outgoing,
    ) -> bool {
        let asked = match self {
            Self::Resetting { step, due } if now >= *due => {
                let next = *step + 1;
                *self = if next > 2 * RESET_BAUDS.len() {
                    Self::ask(Question::Identity, now, out)
                } else {
                    Self::reset_step(next, now, out)
                };
                return false;
            }
            // Nobody there, or not a tablet: from the beginning.
            Self::Asked {
                question: Question::Identity,
                until,
                ..
            } if now >= *until => {
                *self = Self::begin(now, out);
                return false;
            }
            // What it does not say is in the profile.
            Self::Asked { question, until, .. } if now >= *until => *question,
            Self::Answered { question } => *question,
            _ => return false,
        };
        let next = match asked {
            Question::Identity if profile.wacom.as_ref().is_some_and(|w| w.answers_size) => {
                Some(Question::Size)
            }
            Question::Size => Some(Question::Resolution),
            Question::Identity | Question::Resolution => None,
        };
        if let Some(question) = next {
            *self = Self::ask(question, now, out);
            return false;
        }
        set_up(profile, tilt, out);
        *self = Self::Running;
        true
    }
}

fn set_up(profile: &InputProfile, tilt: bool, out: &mut Outgoing) {
    if profile.answer_prefix() == "CT" {
        out.bytes(SET_UP_PEN_PARTNER);
    } else {
        out.bytes(SET_UP);
    }
    if tilt {
        out.bytes(TILT);
    }
    out.bytes(START);
}
