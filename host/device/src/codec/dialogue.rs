//! How a conversation with a device opens: what is sent, how long is waited, what is asked and what silence means.
//!
//! Apart because every device on a serial line opens like that, with other words. Knows neither the words nor what
//! an answer is: the codec tells when the open question has been answered.

use super::Outgoing;
use crate::clock::Instant;
use std::collections::VecDeque;
use std::time::Duration;

/// One turn of the host's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Turn<Q> {
    /// Sends bytes.
    Send(Vec<u8>),
    /// Sets the line's speed.
    Baud(u32),
    /// Says nothing for so many milliseconds.
    WaitMs(u64),
    /// Sends bytes and waits for the answer.
    Ask {
        /// What is sent; may be nothing, where the device speaks by itself.
        send: Vec<u8>,
        /// What the codec is told is open.
        question: Q,
        /// Longest wait in milliseconds.
        limit_ms: u64,
        /// What happens then.
        silence: Silence,
    },
}

/// What an unanswered question leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Silence {
    /// The next turn: the answer is welcome, not needed.
    GoesOn,
    /// Everything from the beginning: nobody is there.
    StartsOver,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State<Q> {
    /// Not begun.
    Idle,
    /// The next turn is due.
    Ready,
    /// Waiting for a time.
    Waiting { until: Instant },
    /// A question is open.
    Asked {
        question: Q,
        until: Instant,
        silence: Silence,
    },
    /// All turns are taken.
    Over,
}

/// The opening of a conversation.
#[derive(Clone, Debug)]
pub(super) struct Dialogue<Q> {
    opening: Vec<Turn<Q>>,
    left: VecDeque<Turn<Q>>,
    state: State<Q>,
}

impl<Q: Copy> Dialogue<Q> {
    /// One that takes these turns, each time it begins.
    pub(super) fn new(opening: Vec<Turn<Q>>) -> Self {
        Self {
            opening,
            left: VecDeque::new(),
            state: State::Idle,
        }
    }

    /// The same, as if it were over: for recordings that begin later.
    pub(super) fn skipped(mut self) -> Self {
        self.state = State::Over;
        self
    }

    /// Begins, or begins again.
    pub(super) fn begin(&mut self, now: Instant, out: &mut Outgoing) {
        self.left.clear();
        self.left.extend(self.opening.iter().cloned());
        self.state = State::Ready;
        self.take_turns(now, out);
    }

    /// The open question.
    pub(super) fn question(&self) -> Option<Q> {
        match self.state {
            State::Asked { question, .. } => Some(question),
            _ => None,
        }
    }

    /// The open question, if its time is up now.
    pub(super) fn expired(&self, now: Instant) -> Option<Q> {
        match self.state {
            State::Asked { question, until, .. } if now >= until => Some(question),
            _ => None,
        }
    }

    /// The open question has been answered; the next turn comes with the next [`advance`](Self::advance).
    pub(super) fn answered(&mut self) {
        if matches!(self.state, State::Asked { .. }) {
            self.state = State::Ready;
        }
    }

    /// More turns after those that are left, this time only.
    pub(super) fn then(&mut self, turns: impl IntoIterator<Item = Turn<Q>>) {
        self.left.extend(turns);
    }

    /// Goes on as far as the time lets it. True: it has just come to its end.
    pub(super) fn advance(&mut self, now: Instant, out: &mut Outgoing) -> bool {
        match self.state {
            State::Waiting { until } if now >= until => self.state = State::Ready,
            State::Asked { until, silence, .. } if now >= until => match silence {
                Silence::GoesOn => self.state = State::Ready,
                Silence::StartsOver => {
                    self.begin(now, out);
                    return false;
                }
            },
            _ => {}
        }
        self.take_turns(now, out);
        let ended = matches!(self.state, State::Ready);
        if ended {
            self.state = State::Over;
        }
        ended
    }

    /// Whether all turns are taken.
    pub(super) fn is_over(&self) -> bool {
        matches!(self.state, State::Over)
    }

    /// Takes turns until one needs time, or none is left.
    fn take_turns(&mut self, now: Instant, out: &mut Outgoing) {
        while matches!(self.state, State::Ready) {
            let Some(turn) = self.left.pop_front() else {
                return;
            };
            match turn {
                Turn::Send(bytes) => out.bytes(&bytes),
                Turn::Baud(baud) => out.baud(baud),
                Turn::WaitMs(ms) => {
                    self.state = State::Waiting {
                        until: now.after(Duration::from_millis(ms)),
                    };
                }
                Turn::Ask {
                    send,
                    question,
                    limit_ms,
                    silence,
                } => {
                    if !send.is_empty() {
                        out.bytes(&send);
                    }
                    self.state = State::Asked {
                        question,
                        until: now.after(Duration::from_millis(limit_ms)),
                        silence,
                    };
                }
            }
        }
    }
}

/// Sends text.
pub(super) fn send<Q>(text: &str) -> Turn<Q> {
    Turn::Send(text.as_bytes().to_vec())
}

/// Asks with text.
pub(super) fn ask<Q>(text: &str, question: Q, limit_ms: u64, silence: Silence) -> Turn<Q> {
    Turn::Ask {
        send: text.as_bytes().to_vec(),
        question,
        limit_ms,
        silence,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at_ms(ms: u64) -> Instant {
        Instant::ZERO.after(Duration::from_millis(ms))
    }

    fn said(out: &mut Outgoing) -> String {
        let bytes = out.all_bytes();
        out.clear();
        String::from_utf8(bytes).expect("these tests send text")
    }

    fn dialogue(silence: Silence) -> Dialogue<u8> {
        Dialogue::new(vec![
            send("hello "),
            Turn::WaitMs(10),
            ask("who?", 1, 50, silence),
            send("thanks"),
        ])
    }

    #[test]
    fn turns_are_taken_when_their_time_comes() {
        let mut out = Outgoing::new();
        let mut dialogue = dialogue(Silence::GoesOn);
        dialogue.begin(at_ms(0), &mut out);
        assert_eq!(said(&mut out), "hello ");
        assert!(!dialogue.advance(at_ms(9), &mut out));
        assert_eq!((said(&mut out).as_str(), dialogue.question()), ("", None));
        assert!(!dialogue.advance(at_ms(10), &mut out));
        assert_eq!((said(&mut out).as_str(), dialogue.question()), ("who?", Some(1)));
        dialogue.answered();
        assert!(dialogue.advance(at_ms(11), &mut out));
        assert_eq!(said(&mut out), "thanks");
        assert!(dialogue.is_over());
        assert!(!dialogue.advance(at_ms(500), &mut out), "the end is told once");
    }

    #[test]
    fn silence_goes_on_or_starts_over() {
        for (silence, then) in [(Silence::GoesOn, "thanks"), (Silence::StartsOver, "hello ")] {
            let mut out = Outgoing::new();
            let mut dialogue = dialogue(silence);
            dialogue.begin(at_ms(0), &mut out);
            dialogue.advance(at_ms(10), &mut out);
            said(&mut out);
            dialogue.advance(at_ms(59), &mut out);
            assert_eq!((said(&mut out).as_str(), dialogue.expired(at_ms(59))), ("", None));
            assert_eq!(dialogue.expired(at_ms(60)), Some(1));
            dialogue.advance(at_ms(60), &mut out);
            assert_eq!(said(&mut out), then);
        }
    }

    #[test]
    fn a_conversation_of_nothing_is_over_at_once() {
        let mut out = Outgoing::new();
        let mut dialogue: Dialogue<u8> = Dialogue::new(Vec::new());
        dialogue.begin(at_ms(0), &mut out);
        assert!(dialogue.advance(at_ms(0), &mut out));
        assert!(dialogue.is_over() && out.is_empty());
    }

    #[test]
    fn further_turns_come_after_those_that_are_left() {
        let mut out = Outgoing::new();
        let mut dialogue = dialogue(Silence::GoesOn);
        dialogue.begin(at_ms(0), &mut out);
        dialogue.advance(at_ms(10), &mut out);
        dialogue.answered();
        dialogue.then([Turn::Baud(38_400), send(" bye")]);
        assert!(dialogue.advance(at_ms(11), &mut out));
        assert_eq!(said(&mut out), "hello who?thanks bye");
        dialogue.begin(at_ms(20), &mut out);
        dialogue.advance(at_ms(30), &mut out);
        dialogue.advance(at_ms(90), &mut out);
        assert_eq!(said(&mut out), "hello who?thanks", "the next time without them");
    }
}
