//! Tells an answer to this request from a late answer to an earlier one.
//!
//! The protocol has no sequence number, but every block read holds the servo's Realtime Tick (1 ms, 0 to
//! 32767). An answer was measured after its request was sent and before it was received, so with
//! `offset = tick - host time` each answer bounds the unknown offset from both sides: the smallest
//! `tick - sent` seen is at most the servo's turn in the chain too large. An answer whose tick lies before its
//! request was sent, by the smallest offset possible, is an old one.
//!
//! Source: e-manual, "Realtime Tick (120)"; the method is this project's.

use crate::clock::Instant;
use std::time::Duration;

/// The tick's period: it counts to 32767 and starts again at 0.
const TICK_PERIOD_MS: f64 = 32_768.0;
/// How far the servo's clock may run from ours: an RC oscillator's few percent.
const DRIFT: f64 = 0.02;
/// Granularity of the tick, and the tick that may fall between measuring and reading it.
const TOLERANCE_MS: f64 = 2.0;
/// After so long a silence the tick says nothing any more (less than half its period).
const FORGET_MS: f64 = 10_000.0;
/// A tick that far from the expected one cannot be lateness, but a servo that started anew.
const RESTART_MS: f64 = 500.0;

/// What the tick says about an answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// Measured after the request was sent, as far as can be told.
    Fresh,
    /// Measured before the request was sent: the answer to an earlier one.
    Stale {
        /// By so much.
        by_ms: f64,
    },
    /// The servo's clock began again: it was rebooted, and its torque and RAM registers are lost.
    Restarted,
}

/// What is known about one servo's clock.
#[derive(Debug, Clone, Default)]
pub struct Freshness {
    known: Option<Known>,
}

#[derive(Debug, Clone, Copy)]
struct Known {
    /// The smallest `tick - sent`, modulo the period, allowing for drift since.
    offset_ms: f64,
    /// How much of it may be the wait for the servo's turn, which may be shorter another time.
    turn_ms: f64,
    /// When the last fresh answer's request was sent.
    sent: Instant,
}

impl Freshness {
    /// Forgets the servo's clock, as after a reconnection.
    pub fn forget(&mut self) {
        self.known = None;
    }

    /// Judges one answer, and learns from it when it is fresh. `turn` is how long after `sent` the servo
    /// measures at the latest, if nothing is delayed.
    pub fn judge(&mut self, tick: u16, sent: Instant, turn: Duration, received: Instant) -> Verdict {
        let at_sent = offset(tick, sent);
        let turn_ms = turn.as_secs_f64() * 1e3;
        let Some(known) = self
            .known
            .filter(|known| millis(sent) - millis(known.sent) < FORGET_MS)
        else {
            self.known = Some(Known {
                offset_ms: at_sent,
                turn_ms,
                sent,
            });
            return Verdict::Fresh;
        };
        let gap_ms = (millis(sent) - millis(known.sent)).max(0.0);
        let slack_ms = TOLERANCE_MS + DRIFT * gap_ms;
        let ahead_ms = wrapped(at_sent - known.offset_ms);
        let began_since = f64::from(tick) <= millis(received) - millis(known.sent) + slack_ms;
        if ahead_ms.abs() > RESTART_MS && began_since {
            self.known = None;
            return Verdict::Restarted;
        }
        if ahead_ms < -slack_ms - (known.turn_ms - turn_ms).max(0.0) {
            return Verdict::Stale { by_ms: -ahead_ms };
        }
        self.known = Some(known.learned(tick, turn_ms, sent, received));
        Verdict::Fresh
    }
}

impl Known {
    /// Down at once with a prompter answer, up slowly with drift, and never below what an answer proves: it
    /// was measured before it was received.
    fn learned(self, tick: u16, turn_ms: f64, sent: Instant, received: Instant) -> Self {
        let gap_ms = (millis(sent) - millis(self.sent)).max(0.0);
        let ahead_ms = wrapped(offset(tick, sent) - self.offset_ms);
        let offset_ms = self.offset_ms + ahead_ms.min(DRIFT * gap_ms);
        let proved_ms = wrapped(offset(tick, received) - offset_ms);
        if proved_ms > 0.0 {
            Self {
                offset_ms: offset_ms + proved_ms,
                turn_ms: 0.0,
                sent,
            }
        } else if ahead_ms < 0.0 {
            Self {
                offset_ms,
                turn_ms,
                sent,
            }
        } else {
            Self {
                offset_ms,
                turn_ms: self.turn_ms.max(turn_ms),
                sent,
            }
        }
    }
}

fn offset(tick: u16, host: Instant) -> f64 {
    f64::from(tick) - millis(host)
}

fn millis(at: Instant) -> f64 {
    at.as_nanos() as f64 * 1e-6
}

/// Into half a period either side of zero.
fn wrapped(ms: f64) -> f64 {
    (ms + TICK_PERIOD_MS / 2.0).rem_euclid(TICK_PERIOD_MS) - TICK_PERIOD_MS / 2.0
}

#[cfg(test)]
#[path = "freshness_tests.rs"]
mod tests;
