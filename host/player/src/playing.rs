//! Playing, tick by tick: come to a stand, approach, and only then let time run.
//!
//! The same three steps whatever led here: a new clip, a seek, a loop's seam, a live pose, or servos that had
//! to be pinned again after a pause of the host.

use crate::lag::Follower;
use crate::order::{Order, Rejection};
use crate::playback::{Playback, Step};
use crate::player::{Player, Stance, State};
use crate::report::Phase;
use device::Instant;
use std::time::Duration;

impl Player {
    /// Begins, changes or moves what is played.
    pub(crate) fn play(&mut self, order: Order) {
        let result = match order {
            Order::Play {
                clip,
                from_secs,
                speed,
                looped,
            } => {
                let seam_rad = self.config.seam_rad;
                Playback::of_clip(clip, from_secs, speed, looped, self.puppet().joints(), seam_rad).map(Some)
            }
            Order::Seek(to_secs) if !to_secs.is_finite() => Err(Rejection::Value {
                what: "seek",
                value: to_secs,
                expected: "seconds of the clip",
            }),
            Order::Seek(to_secs) => {
                if self
                    .playback
                    .as_mut()
                    .is_some_and(|playback| playback.seek(to_secs))
                {
                    Ok(None)
                } else {
                    let (order, state) = ("seek", self.state.name());
                    Err(Rejection::State {
                        order,
                        state,
                        remedy: "play a clip first",
                    })
                }
            }
            Order::Follow(pose) if pose.len() != self.wanted.len() => Err(Rejection::PoseLength {
                want: self.wanted.len(),
                got: pose.len(),
            }),
            Order::Follow(pose) => {
                let known = self
                    .playback
                    .as_mut()
                    .is_some_and(|playback| playback.update_live(&pose));
                Ok((!known).then(|| Playback::of_live(pose)))
            }
            _ => Ok(None),
        };
        match result {
            Ok(Some(playback)) => {
                self.followers.iter_mut().for_each(Follower::count_anew);
                self.playback = Some(playback);
                self.state = State::Playing;
                self.stance = Stance::Stand;
            }
            Ok(None) => {}
            Err(rejection) => self.reject(rejection),
        }
    }

    /// One period of playing: sets the wishes of this tick.
    pub(crate) fn play_further(&mut self, now: Instant, dt_secs: f64) {
        let Some(mut playback) = self.playback.take() else {
            self.state = State::Holding;
            self.stance = Stance::Stand;
            return;
        };
        if !self.lines.all_armed() {
            playback.phase = Phase::Pinning;
        }
        if playback.phase != Phase::Running {
            self.clip_interrupted();
        }
        match playback.phase {
            Phase::Idle | Phase::Pinning | Phase::Braking => self.come_to_stand(&mut playback),
            Phase::Approaching => self.approach(&mut playback, dt_secs),
            Phase::Running => {
                if self.run_on(&mut playback, now, dt_secs) == Step::Ended {
                    // The last pose stays the wish, so that the joints arrive at it.
                    self.state = State::Holding;
                    return;
                }
            }
        }
        self.playback = Some(playback);
    }

    fn come_to_stand(&mut self, playback: &mut Playback) {
        self.stance = Stance::Stand;
        if !self.lines.all_armed() {
            return;
        }
        playback.phase = Phase::Braking;
        if !self.lines.all_still() {
            return;
        }
        // Joints that are not played are wished to be where they stand.
        self.lines.goals_into(&mut self.wanted);
        let from = self.wanted.clone();
        playback.pose(&mut self.wanted);
        playback.approach.begin(
            &from,
            &self.wanted,
            &self.lines.limits,
            self.config.approach_share,
        );
        self.wanted = from;
        playback.waited = Duration::ZERO;
        playback.phase = Phase::Approaching;
        self.stance = Stance::Pose;
    }

    fn approach(&mut self, playback: &mut Playback, dt_secs: f64) {
        playback.approach.advance(dt_secs);
        playback.pose(&mut self.wanted);
        let over = playback.approach.is_over();
        if over && self.has_arrived(playback, dt_secs) {
            playback.phase = Phase::Running;
            self.leads_begin();
        } else {
            playback.approach.blend(&mut self.wanted);
        }
    }

    /// Whether goals stand at the first pose and the joints have followed, or were waited for long enough.
    fn has_arrived(&self, playback: &mut Playback, dt_secs: f64) -> bool {
        let mut settled = true;
        for (joint, (wanted, limits)) in self.wanted.iter().zip(&self.lines.limits).enumerate() {
            let Some(goal) = self.lines.goal_rad(joint) else {
                return false;
            };
            let reachable = wanted.clamp(limits.min_rad(), limits.max_rad());
            // A wish that is no number is not waited for; the limiter refuses it.
            if reachable.is_finite() && (goal - reachable).abs() > self.config.arrived_rad {
                return false;
            }
            let reading = self.lines.reading(joint);
            settled &=
                reading.is_some_and(|reading| (reading.position_rad - goal).abs() <= self.config.settled_rad);
        }
        playback.waited = playback.waited.saturating_add(Duration::from_secs_f64(dt_secs));
        settled || playback.waited >= self.config.arrival_patience
    }

    fn run_on(&mut self, playback: &mut Playback, now: Instant, dt_secs: f64) -> Step {
        let step = playback.advance(dt_secs);
        if step == Step::Seam {
            playback.phase = Phase::Braking;
            self.stance = Stance::Stand;
            return step;
        }
        self.move_leads(dt_secs);
        playback.pose_ahead(&self.leads, &mut self.wanted);
        self.note_clip(playback, now);
        step
    }
}
