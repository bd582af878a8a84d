//! What a controller is told after opening, and what it should say to that: modes, templates, identity.
//!
//! Source: `docs/protocols/midi.md`, "Waking".

use crate::clock::Instant;
use crate::codec::Outgoing;
use device_profiles::{HexBytes, InitAction, InitStep, InputProfile};
use std::fmt::Write as _;
use std::time::Duration;

/// How long an answer may take; the controllers known here answer within a few milliseconds. Ours.
const ANSWER_LIMIT: Duration = Duration::from_millis(300);
/// Between two tries of a step that must not fail. Ours.
const TRY_AGAIN: Duration = Duration::from_secs(1);

/// A step of the profile.
#[derive(Clone, Debug)]
struct Doing {
    send: Vec<u8>,
    wait: Duration,
    /// What the answer begins with, without its F0.
    expect: Option<Vec<u8>>,
    optional: bool,
}

/// Where we are in the steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Idle,
    /// The step may begin from then on.
    At {
        step: usize,
        from: Instant,
    },
    /// The step's answer is awaited.
    Asked {
        step: usize,
        until: Instant,
    },
    Done,
}

/// The waking of one controller.
#[derive(Debug)]
pub(super) struct Waking {
    steps: Vec<Doing>,
    phase: Phase,
    answered: bool,
    missed: bool,
    identity: Option<String>,
}

impl Waking {
    pub(super) fn new(profile: &InputProfile) -> Self {
        Self {
            steps: profile.init.iter().filter_map(Doing::new).collect(),
            phase: Phase::Idle,
            answered: false,
            missed: false,
            identity: None,
        }
    }

    /// Begins, or begins again.
    pub(super) fn begin(&mut self, now: Instant) {
        self.answered = false;
        self.phase = Phase::At { step: 0, from: now };
    }

    /// It is awake already.
    pub(super) fn skip(&mut self) {
        self.phase = Phase::Done;
    }

    pub(super) fn is_done(&self) -> bool {
        self.phase == Phase::Done
    }

    /// Whether a step's answer has not come, said once.
    pub(super) fn take_missed(&mut self) -> bool {
        std::mem::take(&mut self.missed)
    }

    /// What the controller has said of itself.
    pub(super) fn identity(&self) -> Option<&str> {
        self.identity.as_deref()
    }

    /// A system exclusive message has come, without its F0 and F7.
    pub(super) fn answered(&mut self, bytes: &[u8]) {
        // Identity reply: 7E, channel, 06 02, maker (one byte, or 00 and two), family, member, version.
        if let [0x7E, _, 0x06, 0x02, rest @ ..] = bytes {
            // A controller may say it again and again: into the memory that is there.
            let identity = self.identity.get_or_insert_with(String::new);
            identity.clear();
            for byte in rest {
                let gap = if identity.is_empty() { "" } else { " " };
                // Writing into text cannot fail.
                let _ = write!(identity, "{gap}{byte:02x}");
            }
        }
        if let Phase::Asked { step, .. } = self.phase {
            let expect = self.steps.get(step).and_then(|doing| doing.expect.as_deref());
            self.answered |= expect.is_some_and(|expect| bytes.starts_with(expect));
        }
    }

    /// Goes on; true once, when the last step is done.
    pub(super) fn advance(&mut self, now: Instant, out: &mut Outgoing) -> bool {
        loop {
            match self.phase {
                Phase::Idle | Phase::Done => return false,
                Phase::At { from, .. } if now < from => return false,
                Phase::At { step, .. } => {
                    let Some(doing) = self.steps.get(step) else {
                        self.phase = Phase::Done;
                        return true;
                    };
                    if !doing.send.is_empty() {
                        out.bytes(&doing.send);
                    }
                    self.answered = false;
                    self.phase = if doing.expect.is_some() {
                        Phase::Asked {
                            step,
                            until: now.after(ANSWER_LIMIT),
                        }
                    } else {
                        Phase::At {
                            step: step + 1,
                            from: now.after(doing.wait),
                        }
                    };
                }
                Phase::Asked { step, .. } if self.answered => {
                    self.phase = Phase::At {
                        step: step + 1,
                        from: now,
                    };
                }
                Phase::Asked { until, .. } if now < until => return false,
                Phase::Asked { step, .. } => {
                    self.missed = true;
                    let optional = self.steps.get(step).is_none_or(|doing| doing.optional);
                    self.phase = if optional {
                        Phase::At {
                            step: step + 1,
                            from: now,
                        }
                    } else {
                        Phase::At {
                            step: 0,
                            from: now.after(TRY_AGAIN),
                        }
                    };
                }
            }
        }
    }
}

impl Doing {
    /// Of a step that says something to a MIDI controller; others belong to other buses.
    fn new(step: &InitStep) -> Option<Self> {
        let (send, wait) = match step.action()? {
            // A leading 0 stands for "no report id", which MIDI has not either.
            InitAction::Output(bytes) => (bytes.strip_prefix(&[0]).unwrap_or(bytes).to_vec(), Duration::ZERO),
            InitAction::Wait(ms) => (Vec::new(), Duration::from_millis(ms.into())),
            InitAction::String(_) | InitAction::Feature(_) | InitAction::ReadFeature(_) => return None,
        };
        let expect = step.expect.as_deref().and_then(HexBytes::parse).map(|bytes| {
            let bytes = bytes.0;
            bytes.strip_prefix(&[0xF0]).map(<[u8]>::to_vec).unwrap_or(bytes)
        });
        Some(Self {
            send,
            wait,
            expect,
            optional: step.optional,
        })
    }
}
