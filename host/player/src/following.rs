//! What joints were asked and did, for their lag; and the lead that takes it away.

use crate::lag::{AHEAD_SECS, Follower};
use crate::playback::Playback;
use crate::player::Player;
use device::Instant;

impl Player {
    /// After goals went out: notes them, and what has been measured.
    pub(crate) fn note_following(&mut self, now: Instant) {
        let Self { followers, lines, .. } = self;
        for (joint, follower) in followers.iter_mut().enumerate() {
            match (lines.goal_rad(joint), lines.goals_at(joint)) {
                (Some(goal_rad), Some(at)) if at == now => {
                    let limits = lines.limits.get(joint).map_or([f64::INFINITY; 2], |limits| {
                        [
                            limits.velocity_max_rad_per_s(),
                            limits.acceleration_max_rad_per_s2(),
                        ]
                    });
                    follower.goal_sent(now.as_secs_f64(), goal_rad, limits);
                }
                (Some(_), Some(_)) => {}
                _ => follower.forget_courses(),
            }
            // After the goal, so that a measurement lies between two of them.
            if let Some(reading) = lines.reading(joint) {
                follower.measured(reading.at.as_secs_f64(), reading.position_rad);
            }
        }
    }

    /// Moves the leads towards the joints' lags, as far as the time allows.
    pub(crate) fn move_leads(&mut self, dt_secs: f64) {
        let compensate = self.report.compensates_lag;
        for (lead, follower) in self.leads.iter_mut().zip(&mut self.followers) {
            *lead = follower.lead(compensate, dt_secs);
        }
    }

    /// Goals stand at the first pose: playing begins without a lead.
    pub(crate) fn leads_begin(&mut self) {
        self.leads.fill(0.0);
        self.followers.iter_mut().for_each(Follower::playing_begins);
    }

    /// Notes where the clip goes from here.
    pub(crate) fn note_clip(&mut self, playback: &Playback, now: Instant) {
        let followers = &mut self.followers;
        playback.ahead(AHEAD_SECS, &mut |joint, angle_rad| {
            if let Some(follower) = followers.get_mut(joint) {
                follower.clip_ahead(now.as_secs_f64(), angle_rad);
            }
        });
    }

    /// The clip's time stands still or jumps.
    pub(crate) fn clip_interrupted(&mut self) {
        self.followers.iter_mut().for_each(Follower::clip_interrupted);
    }
}
