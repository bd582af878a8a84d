//! Where in time the figure on screen is: play, pause, seek, loop.

use crate::command::TransportCommand;
use crate::snapshot::TransportView;

/// Slowest and fastest playing speed.
const SPEED: std::ops::RangeInclusive<f64> = 0.05..=8.0;

/// A key this near is the one at hand: half a frame at 30 a second, about what a dial's count moves.
const KEY_REACH_SECS: f64 = 0.016;

/// The transport's state. Times are animation seconds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Timeline {
    view: TransportView,
    key_secs: Vec<f64>,
}

impl Timeline {
    /// Takes over the key times of the clip being edited, earliest first; stays at the same time if it can.
    pub(crate) fn set_keys(&mut self, key_secs: Vec<f64>) {
        self.view.start_secs = key_secs.first().copied().unwrap_or(0.0);
        self.view.end_secs = key_secs.last().copied().unwrap_or(0.0);
        self.key_secs = key_secs;
        if self.view.playing {
            self.view.secs = self.view.secs.clamp(self.view.start_secs, self.view.end_secs);
        }
    }

    /// Moves time on by `elapsed_secs` of machine time if it runs.
    pub(crate) fn advance(&mut self, elapsed_secs: f64) {
        let v = &mut self.view;
        if !v.playing {
            return;
        }
        v.secs += elapsed_secs * v.speed;
        if v.secs < v.end_secs {
            return;
        }
        let span_secs = v.end_secs - v.start_secs;
        if v.looped && span_secs > 0.0 {
            v.secs = v.start_secs + (v.secs - v.start_secs).rem_euclid(span_secs);
        } else {
            v.secs = v.end_secs;
            v.playing = false;
        }
    }

    /// Where time is and how it runs, without the clip's ends.
    pub(crate) fn standing(&self) -> TransportView {
        TransportView {
            start_secs: 0.0,
            end_secs: 0.0,
            ..self.view.clone()
        }
    }

    /// Goes on from there.
    pub(crate) fn resume(&mut self, start: &TransportView) {
        self.view = TransportView {
            start_secs: self.view.start_secs,
            end_secs: self.view.end_secs,
            ..start.clone()
        };
    }

    /// Stops at the first key.
    pub(crate) fn go_to_start(&mut self) {
        self.view.playing = false;
        self.view.secs = self.view.start_secs;
    }

    /// Goes along with something else that plays the clip, `since_start_secs` after its first key. Time that runs
    /// by itself is left alone. Returns whether it moved.
    pub(crate) fn go_along(&mut self, since_start_secs: f64) -> bool {
        let secs = (self.view.start_secs + since_start_secs).clamp(self.view.start_secs, self.view.end_secs);
        let moves = !self.view.playing && secs != self.view.secs;
        if moves {
            self.view.secs = secs;
        }
        moves
    }

    /// Does what was asked; says what was wrong with it otherwise. Returns whether time jumped or stopped
    /// being where it was, so that the pose of the clip is to be shown.
    pub(crate) fn apply(&mut self, command: &TransportCommand) -> Result<bool, String> {
        match *command {
            TransportCommand::Toggle if self.view.playing => self.view.playing = false,
            TransportCommand::Play | TransportCommand::Toggle => self.play(),
            TransportCommand::Pause => self.view.playing = false,
            TransportCommand::Seek { secs } => return self.seek(secs),
            TransportCommand::Nudge { by_secs } => return self.seek(self.view.secs + by_secs),
            TransportCommand::Loop(on) => self.view.looped = on,
            TransportCommand::ToggleLoop => self.view.looped = !self.view.looped,
            TransportCommand::Key(step) => return self.step_key(step),
            TransportCommand::Speed(speed) => {
                if !speed.is_finite() {
                    return Err("the playing speed must be a number".into());
                }
                self.view.speed = speed.clamp(*SPEED.start(), *SPEED.end());
            }
        }
        Ok(matches!(
            command,
            TransportCommand::Play | TransportCommand::Toggle
        ))
    }

    fn play(&mut self) {
        if self.key_secs.len() < 2 {
            return;
        }
        if self.view.secs >= self.view.end_secs {
            self.view.secs = self.view.start_secs;
        }
        self.view.playing = true;
    }

    fn seek(&mut self, secs: f64) -> Result<bool, String> {
        if !secs.is_finite() {
            return Err("a time must be a number".into());
        }
        // New keys may be set after the last one, so time is only bounded below and by a long day.
        self.view.secs = secs.clamp(0.0, 86_400.0);
        Ok(true)
    }

    fn step_key(&mut self, step: i32) -> Result<bool, String> {
        let now = self.view.secs;
        let to = if step >= 0 {
            self.key_secs
                .iter()
                .copied()
                .filter(|&t| t > now + 1e-9)
                .nth(step.max(1) as usize - 1)
        } else {
            self.key_secs
                .iter()
                .rev()
                .copied()
                .filter(|&t| t < now - 1e-9)
                .nth(step.unsigned_abs() as usize - 1)
        };
        match to {
            Some(secs) => self.seek(secs),
            None => Ok(false),
        }
    }

    pub(crate) fn secs(&self) -> f64 {
        self.view.secs
    }

    pub(crate) fn playing(&self) -> bool {
        self.view.playing
    }

    pub(crate) fn view(&self) -> &TransportView {
        &self.view
    }

    /// Where a pose stored now belongs: at the key at hand, else at the present time. A second key a hundredth of a
    /// second from the first would send the kinetic curve up and down between them.
    pub(crate) fn store_secs(&self) -> f64 {
        self.key_here()
            .and_then(|key| self.key_secs.get(key).copied())
            .unwrap_or(self.view.secs)
    }

    /// The key at the present time: the nearest one within [`KEY_REACH_SECS`].
    pub(crate) fn key_here(&self) -> Option<usize> {
        let away = |secs: &f64| (secs - self.view.secs).abs();
        let nearest = self
            .key_secs
            .iter()
            .enumerate()
            .min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)));
        nearest
            .filter(|(_, secs)| away(secs) <= KEY_REACH_SECS)
            .map(|(index, _)| index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timeline() -> Timeline {
        let mut t = Timeline::default();
        t.set_keys(vec![0.0, 1.0, 3.0]);
        t
    }

    #[test]
    fn playing_stops_at_the_end() {
        let mut t = timeline();
        t.apply(&TransportCommand::Play).expect("plays");
        t.advance(2.5);
        assert!(t.playing());
        t.advance(1.0);
        assert_eq!((t.secs(), t.playing()), (3.0, false));
    }

    #[test]
    fn looping_wraps_by_the_span() {
        let mut t = timeline();
        t.apply(&TransportCommand::Loop(true)).expect("loops");
        t.apply(&TransportCommand::Play).expect("plays");
        t.advance(7.0);
        assert!((t.secs() - 1.0).abs() < 1e-12 && t.playing());
    }

    #[test]
    fn keys_are_stepped_both_ways_and_end_quietly() {
        let mut t = timeline();
        for (step, want) in [
            (1, 1.0),
            (1, 3.0),
            (1, 3.0),
            (-1, 1.0),
            (-2, 1.0),
            (-1, 0.0),
            (2, 3.0),
        ] {
            t.apply(&TransportCommand::Key(step)).expect("steps");
            assert_eq!(t.secs(), want, "after a step of {step}");
        }
    }

    #[test]
    fn the_key_at_hand_is_the_nearest_within_reach() {
        let mut t = timeline();
        for (secs, want) in [
            (0.0, Some(0)),
            (0.99, Some(1)),
            (1.015, Some(1)),
            (1.02, None),
            (2.0, None),
        ] {
            t.apply(&TransportCommand::Seek { secs }).expect("seeks");
            assert_eq!(t.key_here(), want, "at {secs}");
            assert_eq!(
                t.store_secs(),
                want.map_or(secs, |key| [0.0, 1.0, 3.0][key]),
                "at {secs}"
            );
        }
    }

    #[test]
    fn times_that_are_no_numbers_are_refused() {
        let mut t = timeline();
        assert!(t.apply(&TransportCommand::Seek { secs: f64::NAN }).is_err());
        assert!(t.apply(&TransportCommand::Speed(f64::INFINITY)).is_err());
        assert_eq!(t.secs(), 0.0);
    }
}
