//! The watchdogs: what stops a player without anybody asking.

use crate::fault::Fault;
use crate::player::{Player, State};
use device::Instant;

/// The clip's time runs on by no more than this in one tick: after a longer pause of the host the motion goes
/// on where it was, not where it would have been. As `device::servo::limit::STEP_MAX_SECS`.
const STEP_MAX_SECS: f64 = device::servo::limit::STEP_MAX_SECS;

impl Player {
    /// Time since the last tick as playing sees it, and how late this one is.
    pub(crate) fn note_time(&mut self, now: Instant) -> f64 {
        let period = self.config.period;
        let since = self.ticked.map_or(period, |ticked| now.since(ticked));
        self.ticked = Some(now);
        if self.ticked_seldom(since) {
            // Nobody listened meanwhile: servos are not to blame for what was not asked of them.
            self.listening_since = now;
        }
        let lateness = since.saturating_sub(period);
        self.report.lateness = lateness;
        if lateness > self.config.late_after {
            self.late_run = self.late_run.saturating_add(1);
            self.report.late_ticks = self.report.late_ticks.saturating_add(1);
        } else {
            self.late_run = 0;
        }
        since.as_secs_f64().min(STEP_MAX_SECS)
    }

    fn ticked_seldom(&self, since: std::time::Duration) -> bool {
        since.saturating_mul(2) > self.config.silence_max
    }

    /// Judges what is known by now. Only a player with torque has anything to fear.
    pub(crate) fn watch(&mut self, now: Instant, dt_secs: f64) {
        self.watch_troubles(now, dt_secs);
        if !matches!(self.state, State::Holding | State::Playing) {
            self.late_run = 0;
            return;
        }
        if let Some(fault) = self.find_fault(now) {
            self.fault(fault, now);
        }
    }

    fn find_fault(&self, now: Instant) -> Option<Fault> {
        if self.late_run >= self.config.late_ticks_max {
            return Some(Fault::LateTicks { count: self.late_run });
        }
        let gone = self
            .config
            .operator_max
            .is_some_and(|max| now.since(self.heard_operator) > max);
        if gone {
            return Some(Fault::OperatorGone);
        }
        if self.heartbeat_is_missing(now) {
            return Some(Fault::HeartbeatLost);
        }
        self.find_silence(now)
    }

    /// Whether a heartbeat is needed and has not come for too long.
    pub(crate) fn heartbeat_is_missing(&self, now: Instant) -> bool {
        let Some(max) = self.config.heartbeat_max else {
            return false;
        };
        self.heartbeat_at.is_none_or(|heard| now.since(heard) > max)
    }

    /// Blames the first in the chain of those not heard for too long: behind it, all may be its fault.
    fn find_silence(&self, now: Instant) -> Option<Fault> {
        for (at, line) in self.lines.all.iter().enumerate() {
            if !line.is_armed() {
                continue;
            }
            let heard = |member: usize| {
                let reading = line.bus.reading(member).map(|reading| reading.at);
                reading.unwrap_or_default().max(self.listening_since)
            };
            let silent =
                (0..line.joints.len()).find(|member| now.since(heard(*member)) > self.config.silence_max);
            if let Some(place) = silent.and_then(|member| self.place(at, member)) {
                return Some(Fault::BusSilent(place));
            }
        }
        None
    }
}
