//! Rehearsal before anything moves: what joints the clip asks for, whether the puppet can, and how slow it must be.
//!
//! Every step does a bounded piece, counted and not timed, so that the rig never stands still for it and a journal
//! plays it again exactly. What comes out is also what the puppet is played from: what was judged is what moves.

mod leader;
mod view;
mod whole;

use std::sync::Arc;

use device_profiles::{Profiles, PuppetProfile};
use motion::feasibility::{JointLimits, Judge, Kind, Loads, Slowing, Stretch, Timing};
use motion::joint_track::survey::Survey;
use motion::{Clip, JointPath, JointTrack, Kinetics};

pub use view::{FeasibilityView, StretchKind, StretchView};
pub use whole::{JudgeError, JudgedClip, judge};

use crate::document::{JointClipDoc, JointClipDocError, Show};
use crate::puppet::{Body, Model};
use leader::FigureLeader;

/// Work of one step, about microseconds: a tenth of a step at a hundred a second.
const STEP_WORK: usize = 1000;
/// The same while somebody waits for the puppet to play: most of a step, for there is nothing better to do with it.
const STEP_WORK_AWAITED: usize = 6000;

/// Who is judged: the same for all clips.
#[derive(Clone, Debug)]
pub(crate) struct Judged {
    model: Arc<Model>,
    limits: Arc<[JointLimits]>,
    loads: Option<Arc<Loads>>,
    unjudged: Arc<[String]>,
}

impl Judged {
    pub(crate) fn new(profile: &PuppetProfile, model: Arc<Model>, profiles: &Profiles) -> Self {
        let loads = model.loads(profile, profiles);
        let unknown: Vec<&str> = loads
            .unknown()
            .map(|joint| model.joints[joint].as_str())
            .collect();
        let some = unknown.len() < model.joints.len();
        let words = match unknown.as_slice() {
            [] => Vec::new(),
            _ if !some => vec!["torque: the profile knows no masses, or no motors".to_owned()],
            joints => vec![format!(
                "torque of {}: a mass or a motor is not in the profile",
                joints.join(", ")
            )],
        };
        Self {
            limits: Model::limits(profile),
            model,
            loads: some.then(|| Arc::new(loads)),
            unjudged: words.into(),
        }
    }

    /// A clip of joints as the puppet plays it, led joints included; `None` while it has no key.
    pub(crate) fn track(&self, clip: &JointClipDoc) -> Result<Option<JointTrack>, JointClipDocError> {
        let chain = &self.model.chain;
        let track = clip.track(&self.model.joints, &chain.rest_angles())?;
        Ok(track.map(|track| JointTrack {
            path: Arc::new(track.path.coupled(chain.couplings())),
            kinetics: track.kinetics,
        }))
    }
}

/// What is being found out.
enum Work {
    /// There is nothing to judge.
    Nothing,
    Surveying {
        survey: Box<Survey>,
        leader: Box<FigureLeader>,
        kinetics: Kinetics,
    },
    Judging {
        track: Arc<JointTrack>,
        judge: Judge,
    },
    Judged {
        track: Arc<JointTrack>,
    },
}

/// How much of a rehearsal is done in one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pace {
    /// A little: other things matter more.
    Aside,
    /// Much: somebody waits for the end of it.
    Awaited,
    /// All there is: nothing else goes on.
    AtOnce,
}

/// The clip in rehearsal.
pub(crate) struct Rehearsal {
    judged: Judged,
    work: Work,
    /// The path and the keys it came from; timing may change without it.
    known: Option<(Poses, Arc<JointPath>)>,
    /// The largest angle between a link and what its joints could do about it, along that path.
    error_rad: f64,
    body: Option<Body>,
    stretches: Arc<[StretchView]>,
    slow_down: f64,
    slow_wanted: bool,
    slowing: Option<Box<Slowing>>,
}

/// The path of a clip apart from its timing, to tell whether it changed.
struct Poses(crate::document::ClipDoc);

impl Poses {
    fn of(show: &Show) -> Option<Self> {
        let mut clip = crate::document::ClipDoc::clone(show.current_clip()?);
        clip.kinetics = motion::KineticsMode::default();
        clip.coefficient_edits.clear();
        clip.keep_forward = false;
        Some(Self(clip))
    }

    fn same(&self, other: &Self) -> bool {
        let (a, b) = (&self.0, &other.0);
        let poses = || a.keys.iter().zip(&b.keys);
        (a.direction_law, a.twist_law, a.keys.len()) == (b.direction_law, b.twist_law, b.keys.len())
            && poses().all(|(a, b)| Arc::ptr_eq(a, b) || a.pose == b.pose)
    }
}

impl Rehearsal {
    pub(crate) fn new(judged: Judged) -> Self {
        Self {
            judged,
            work: Work::Nothing,
            known: None,
            error_rad: 0.0,
            body: None,
            stretches: Arc::default(),
            slow_down: 1.0,
            slow_wanted: false,
            slowing: None,
        }
    }

    /// Who follows the figure from now on.
    pub(crate) fn lead_by(&mut self, body: Option<Body>) {
        self.body = body;
        self.known = None;
        self.nothing();
    }

    fn nothing(&mut self) {
        self.work = Work::Nothing;
        self.stretches = Arc::default();
        self.slow_down = 1.0;
        (self.slow_wanted, self.slowing) = (false, None);
    }

    /// Takes a clip of the figure into rehearsal; one that differs in timing alone is not surveyed again.
    pub(crate) fn set_clip(&mut self, show: &Show, clip: &Arc<Clip>) {
        (self.slow_wanted, self.slowing) = (false, None);
        let (Some(body), Some(poses)) = (&self.body, Poses::of(show)) else {
            self.nothing();
            return;
        };
        let kinetics = clip.kinetics().clone();
        if let Some((_, path)) = self.known.as_ref().filter(|(known, _)| known.same(&poses)) {
            let path = Arc::clone(path);
            self.judge(JointTrack { path, kinetics });
            return;
        }
        let (joints, rest) = (
            self.judged.model.joints.clone(),
            self.judged.model.chain.rest_angles(),
        );
        self.known = None;
        self.work = Work::Surveying {
            survey: Box::new(Survey::new(joints, &rest, kinetics.last_key())),
            leader: Box::new(FigureLeader::new(Arc::clone(clip), body)),
            kinetics,
        };
    }

    /// Takes a clip of joints into rehearsal.
    pub(crate) fn set_track(&mut self, track: &JointTrack) {
        (self.slow_wanted, self.slowing, self.known) = (false, None, None);
        self.error_rad = 0.0;
        self.judge(track.clone());
    }

    /// There is no clip.
    pub(crate) fn set_none(&mut self) {
        self.nothing();
    }

    fn judge(&mut self, track: JointTrack) {
        let judge = Judge::new(Arc::clone(&self.judged.limits), self.judged.loads.clone());
        let track = Arc::new(track);
        self.work = Work::Judging { track, judge };
    }

    /// Does a step's piece of what is to be done, a larger one while somebody waits for the end of it. The key times
    /// that slowing came to, once it did.
    pub(crate) fn advance(&mut self, show: &Show, pace: Pace) -> Option<Result<Vec<f64>, String>> {
        let work = match pace {
            Pace::Aside => STEP_WORK,
            Pace::Awaited => STEP_WORK_AWAITED,
            Pace::AtOnce => usize::MAX,
        };
        match &mut self.work {
            Work::Nothing => {}
            Work::Surveying {
                survey,
                leader,
                kinetics,
            } => {
                if let Some(path) = survey.advance(&mut **leader, work) {
                    self.error_rad = leader.error_rad();
                    let (path, kinetics) = (Arc::new(path), kinetics.clone());
                    self.known = Poses::of(show).map(|poses| (poses, Arc::clone(&path)));
                    self.judge(JointTrack { path, kinetics });
                }
            }
            Work::Judging { track, judge } => {
                if let Some(found) = judge.advance(track, work) {
                    self.slow_down = found.iter().filter_map(|s| s.slow_down).fold(1.0, f64::max);
                    self.stretches = found.iter().map(|stretch| self.seen(stretch)).collect();
                    let Work::Judging { track, .. } = std::mem::replace(&mut self.work, Work::Nothing) else {
                        return None;
                    };
                    self.work = Work::Judged { track };
                }
            }
            Work::Judged { .. } => return self.slow(show, work),
        }
        None
    }

    fn seen(&self, stretch: &Stretch) -> StretchView {
        let body = self.body.as_ref().filter(|_| self.known.is_some());
        StretchView {
            from_secs: stretch.from_secs,
            to_secs: stretch.to_secs,
            joint: self
                .judged
                .model
                .joints
                .get(stretch.joint)
                .cloned()
                .unwrap_or_default(),
            link: body.and_then(|body| Some(body.leading_link(stretch.joint)?.0)),
            kind: match stretch.kind {
                Kind::Reach => StretchKind::Reach,
                Kind::Speed => StretchKind::Speed,
                Kind::Acceleration => StretchKind::Acceleration,
                Kind::Torque => StretchKind::Torque,
            },
            factor: stretch.factor,
            slowable: stretch.slow_down.is_some(),
        }
    }

    /// Begins to look for key times that the puppet can keep.
    pub(crate) fn slow_to_fit(&mut self) -> Result<(), String> {
        if matches!(self.work, Work::Nothing) {
            return Err("there is no clip that this puppet could do; store keys first".into());
        }
        self.slow_wanted = true;
        Ok(())
    }

    fn slow(&mut self, show: &Show, work: usize) -> Option<Result<Vec<f64>, String>> {
        if self.slow_wanted {
            self.slow_wanted = false;
            match self.begin_slowing(show) {
                Ok(slowing) => self.slowing = slowing.map(Box::new),
                Err(why) => return Some(Err(why)),
            }
        }
        let done = self.slowing.as_mut()?.advance(work)?;
        self.slowing = None;
        Some(done.map_err(|error| error.to_string()))
    }

    fn begin_slowing(&self, show: &Show) -> Result<Option<Slowing>, String> {
        let Work::Judged { track } = &self.work else {
            return Ok(None);
        };
        if !self.stretches.iter().any(|stretch| stretch.slowable) {
            return Err(match self.stretches.first() {
                None => "the puppet can do the clip as it is".to_owned(),
                Some(stretch) => format!("slowing does not help: {stretch}; change the pose"),
            });
        }
        let slowing = Slowing::new(
            Arc::clone(&track.path),
            timing_of(show).ok_or("there is no clip to slow")?,
            show.key_times_secs(),
            Arc::clone(&self.judged.limits),
            self.judged.loads.clone(),
        );
        slowing.map(Some).map_err(|error| error.to_string())
    }

    /// The judged motion; none while that is still being found out.
    pub(crate) fn track(&self) -> Option<&Arc<JointTrack>> {
        match &self.work {
            Work::Judged { track } => Some(track),
            _ => None,
        }
    }

    /// Whether something is being found out.
    pub(crate) fn is_busy(&self) -> bool {
        matches!(self.work, Work::Surveying { .. } | Work::Judging { .. })
    }

    pub(crate) fn judged(&self) -> &Judged {
        &self.judged
    }

    /// The largest angle between a link of the figure and what its joints could do about it, radians.
    pub(crate) fn error_rad(&self) -> f64 {
        self.error_rad
    }

    pub(crate) fn stretches(&self) -> &Arc<[StretchView]> {
        &self.stretches
    }

    pub(crate) fn view(&self) -> FeasibilityView {
        // Finding out the path takes most of the time where it has to be done at all.
        let progress = match &self.work {
            Work::Nothing | Work::Judged { .. } => 1.0,
            Work::Surveying { survey, .. } => 0.8 * survey.progress(),
            Work::Judging { track, judge } => 0.8 + 0.2 * judge.progress(track),
        };
        FeasibilityView {
            progress,
            stretches: Arc::clone(&self.stretches),
            unjudged: Arc::clone(&self.judged.unjudged),
            slow_down: self.slow_down,
            error_rad: self.error_rad,
            slowing: self.slow_wanted || self.slowing.is_some(),
        }
    }
}

fn timing_of(show: &Show) -> Option<Timing> {
    let of_joints = || show.current_joint_clip().map(|clip| clip.timing());
    show.current_clip().map(|clip| clip.timing()).or_else(of_joints)
}
