//! What is being played and how far it is. Numbers only: it moves nothing.

use crate::approach::Approach;
use crate::order::Rejection;
use crate::report::Phase;
use motion::joint_clip::JointClip;
use std::sync::Arc;
use std::time::Duration;

/// Fastest playing; beyond it everything would only be the limiter's motion.
const SPEED_MAX: f64 = 10.0;

/// Where poses come from.
#[derive(Debug, Clone)]
enum Source {
    Clip(Playing),
    Live(Arc<[f64]>),
}

#[derive(Debug, Clone)]
struct Playing {
    clip: Arc<JointClip>,
    /// The puppet's joint for each of the clip's.
    joints: Vec<usize>,
    angles: Vec<f64>,
    secs: f64,
    speed: f64,
    looped: bool,
    /// End and beginning are so alike that a loop needs no approach.
    seamless: bool,
}

impl Playing {
    /// Tells each joint's angle so many seconds of playing after this moment.
    fn each(&self, ahead_secs: &dyn Fn(usize) -> f64, tell: &mut dyn FnMut(usize, f64)) {
        let duration = self.clip.duration_secs();
        for (place, joint) in self.joints.iter().enumerate() {
            let mut secs = self.secs + ahead_secs(*joint) * self.speed;
            if self.looped && self.seamless && duration > 0.0 {
                secs = secs.rem_euclid(duration);
            }
            if let Some(angle) = self.clip.sample_joint(place, secs) {
                tell(*joint, angle);
            }
        }
    }
}

/// One thing being played.
#[derive(Debug, Clone)]
pub(crate) struct Playback {
    source: Source,
    pub(crate) phase: Phase,
    pub(crate) approach: Approach,
    /// How long the joints have been waited for at the end of the approach.
    pub(crate) waited: Duration,
}

/// What a step of time led to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Step {
    /// Time runs on.
    Running,
    /// A loop's end that does not meet its beginning: approach it.
    Seam,
    /// The clip is over; its last pose is the wish from now on.
    Ended,
}

impl Playback {
    /// A clip for a puppet with these joints.
    pub(crate) fn of_clip(
        clip: Arc<JointClip>,
        from_secs: f64,
        speed: f64,
        looped: bool,
        known: &[String],
        seam_rad: f64,
    ) -> Result<Self, Rejection> {
        if !from_secs.is_finite() {
            return Err(Rejection::Value {
                what: "start",
                value: from_secs,
                expected: "seconds of the clip",
            });
        }
        if !(speed > 0.0 && speed <= SPEED_MAX) {
            return Err(Rejection::Value {
                what: "speed",
                value: speed,
                expected: "above 0, at most 10",
            });
        }
        if clip.joints().is_empty() {
            return Err(Rejection::EmptyClip);
        }
        let mut joints = Vec::with_capacity(clip.joints().len());
        for name in clip.joints() {
            let Some(at) = known.iter().position(|joint| joint == name) else {
                return Err(Rejection::UnknownJoint {
                    joint: name.clone(),
                    known: known.join(", "),
                });
            };
            joints.push(at);
        }
        let mut angles = vec![0.0; joints.len()];
        let mut first = angles.clone();
        clip.sample(0.0, &mut first);
        clip.sample(clip.duration_secs(), &mut angles);
        let seamless = first
            .iter()
            .zip(&angles)
            .all(|(first, last)| (first - last).abs() <= seam_rad);
        let secs = from_secs.clamp(0.0, clip.duration_secs().max(0.0));
        Ok(Self::new(Source::Clip(Playing {
            clip,
            joints,
            angles,
            secs,
            speed,
            looped,
            seamless,
        })))
    }

    /// A live pose.
    pub(crate) fn of_live(pose: Arc<[f64]>) -> Self {
        Self::new(Source::Live(pose))
    }

    fn new(source: Source) -> Self {
        Self {
            source,
            phase: Phase::Braking,
            approach: Approach::default(),
            waited: Duration::ZERO,
        }
    }

    /// A newer live pose; false if something else is being played.
    pub(crate) fn update_live(&mut self, pose: &Arc<[f64]>) -> bool {
        let Source::Live(there) = &mut self.source else {
            return false;
        };
        *there = Arc::clone(pose);
        true
    }

    /// Another moment of the clip; false if none is being played.
    pub(crate) fn seek(&mut self, to_secs: f64) -> bool {
        let Source::Clip(playing) = &mut self.source else {
            return false;
        };
        playing.secs = to_secs.clamp(0.0, playing.clip.duration_secs().max(0.0));
        self.phase = Phase::Braking;
        true
    }

    /// The clip's time.
    pub(crate) fn secs(&self) -> Option<f64> {
        match &self.source {
            Source::Clip(playing) => Some(playing.secs),
            Source::Live(_) => None,
        }
    }

    /// Writes the pose of this moment over the joints it names.
    pub(crate) fn pose(&mut self, wanted: &mut [f64]) {
        match &mut self.source {
            Source::Clip(playing) => {
                playing.clip.sample(playing.secs, &mut playing.angles);
                for (joint, angle) in playing.joints.iter().zip(&playing.angles) {
                    if let Some(wanted) = wanted.get_mut(*joint) {
                        *wanted = *angle;
                    }
                }
            }
            Source::Live(pose) => {
                for (wanted, angle) in wanted.iter_mut().zip(pose.iter()) {
                    *wanted = *angle;
                }
            }
        }
    }

    /// The pose of this moment with each joint as many seconds further on as `leads` says.
    pub(crate) fn pose_ahead(&mut self, leads: &[f64], wanted: &mut [f64]) {
        match &self.source {
            Source::Clip(playing) if leads.iter().any(|lead| *lead != 0.0) => {
                playing.each(
                    &|joint| leads.get(joint).copied().unwrap_or_default(),
                    &mut |joint, angle| {
                        if let Some(wanted) = wanted.get_mut(joint) {
                            *wanted = angle;
                        }
                    },
                );
            }
            _ => self.pose(wanted),
        }
    }

    /// Tells the angle of each joint that the clip moves, `ahead_secs` from this moment. A live pose has no future.
    pub(crate) fn ahead(&self, ahead_secs: f64, tell: &mut dyn FnMut(usize, f64)) {
        if let Source::Clip(playing) = &self.source {
            playing.each(&|_| ahead_secs, tell);
        }
    }

    /// Lets the clip's time run.
    pub(crate) fn advance(&mut self, dt_secs: f64) -> Step {
        let Source::Clip(playing) = &mut self.source else {
            return Step::Running;
        };
        let duration = playing.clip.duration_secs();
        playing.secs += dt_secs * playing.speed;
        if playing.secs < duration {
            return Step::Running;
        }
        if !playing.looped || duration <= 0.0 {
            playing.secs = duration.max(0.0);
            return Step::Ended;
        }
        if playing.seamless {
            playing.secs = playing.secs.rem_euclid(duration);
            return Step::Running;
        }
        playing.secs = 0.0;
        Step::Seam
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clip(rows: &[f64]) -> Arc<JointClip> {
        Arc::new(JointClip::new(vec!["b".to_owned()], 0.5, rows.to_vec()).unwrap())
    }

    fn known() -> Vec<String> {
        vec!["a".to_owned(), "b".to_owned()]
    }

    fn play(rows: &[f64], looped: bool) -> Playback {
        Playback::of_clip(clip(rows), 0.0, 1.0, looped, &known(), 0.02).unwrap()
    }

    #[test]
    fn a_clip_moves_only_the_joints_it_names() {
        let mut wanted = [7.0, 7.0];
        play(&[0.25, 0.5, 0.75], false).pose(&mut wanted);
        assert_eq!(wanted, [7.0, 0.25]);
    }

    #[test]
    fn what_happens_at_the_end_depends_on_the_loop_and_its_seam() {
        for (rows, looped, want, secs) in [
            (&[0.0, 0.5, 1.0][..], false, Step::Ended, 1.0),
            (&[0.0, 0.5, 1.0], true, Step::Seam, 0.0),
            (&[0.0, 0.5, 0.01], true, Step::Running, 0.25),
        ] {
            let mut playback = play(rows, looped);
            assert_eq!(playback.advance(0.75), Step::Running);
            assert_eq!(playback.advance(0.5), want, "{rows:?}");
            assert_eq!(playback.secs(), Some(secs), "{rows:?}");
        }
    }

    #[test]
    fn nonsense_is_refused_in_words() {
        let rows = &[0.0, 1.0];
        for (secs, speed, joints, text) in [
            (f64::NAN, 1.0, known(), "start NaN"),
            (0.0, 0.0, known(), "speed 0"),
            (0.0, f64::INFINITY, known(), "speed inf"),
            (
                0.0,
                1.0,
                vec!["a".to_owned()],
                "\"b\", which this puppet does not have; it has: a",
            ),
        ] {
            let error = Playback::of_clip(clip(rows), secs, speed, false, &joints, 0.02).unwrap_err();
            assert!(error.to_string().contains(text), "{error}");
        }
    }
}
