//! The puppet on the rig's desk: posed by hand, shown as its clip has it, and rehearsed before it moves.

use std::collections::BTreeMap;
use std::sync::Arc;

use device_profiles::Profiles;
use motion::{JointTrack, Kinetics};

use super::Rig;
use crate::command::{EditCommand, PuppetCommand, PuppetPose};
use crate::document::{self, Show};
use crate::feasibility::{FeasibilityView, Judged, Pace, Rehearsal, StretchView};
use crate::puppet::{Body, BodyError, Mannequin, Model, PuppetPoseView, Seat};
use crate::snapshot::{NoteLevel, PuppetView};

/// Stretches that a warning before playing names.
const STRETCHES_TOLD: usize = 3;

/// The puppet without its servos.
pub(super) struct Rehearsing {
    profile: device_profiles::PuppetProfile,
    mannequin: Mannequin,
    rehearsal: Rehearsal,
    /// The clip being edited, if it is one of joints.
    track: Option<JointTrack>,
    /// Playing was asked for while the clip was still being judged.
    play_waits: bool,
}

impl Rehearsing {
    /// Of the puppet on its seat, else of the one the show names; none of a puppet whose joints make no chain.
    pub(super) fn of(seat: Option<&Seat>, show: &Show, profiles: &Profiles) -> Option<Self> {
        let profile = match (seat, &show.puppet) {
            (Some(seat), _) => seat.profile().clone(),
            (None, Some(name)) => profiles.puppet(name).ok()?.clone(),
            (None, None) => return None,
        };
        let model = Arc::new(Model::new(&profile).ok()?);
        Some(Self {
            rehearsal: Rehearsal::new(Judged::new(&profile, Arc::clone(&model), profiles)),
            mannequin: Mannequin::new(model),
            profile,
            track: None,
            play_waits: false,
        })
    }

    /// Shows the puppet as it will be at a time, as far as that is known.
    pub(super) fn show(&mut self, secs: f64) {
        let judged = self.rehearsal.track().map(Arc::as_ref);
        if let Some(track) = self.track.as_ref().or(judged) {
            self.mannequin.show(track, secs);
        }
    }

    pub(super) fn stored(&mut self) {
        self.mannequin.stored();
    }

    pub(super) fn by_hand(&self) -> bool {
        self.mannequin.by_hand()
    }

    /// The pose that is the puppet's own and not the figure's.
    pub(super) fn posed(&self) -> Option<&[f64]> {
        (self.by_hand() || self.track.is_some()).then(|| self.mannequin.angles_rad())
    }

    /// The puppet as it is posed on screen.
    pub(super) fn mannequin(&self) -> &Mannequin {
        &self.mannequin
    }

    /// Angles of the joints that follow none, radians.
    pub(super) fn key(&self) -> BTreeMap<String, f64> {
        self.mannequin.key()
    }

    /// Goes on from such a pose; joints that are not there are left out.
    pub(super) fn resume(&mut self, angles_rad: &BTreeMap<String, f64>, by_hand: bool) {
        for (joint, &angle_rad) in angles_rad {
            let joint = joint.clone();
            let _ = self
                .mannequin
                .apply(&PuppetPose::Joint { joint, angle_rad }, None);
        }
        if !by_hand {
            self.mannequin.stored();
        }
    }

    pub(super) fn pose_view(&mut self) -> PuppetPoseView {
        self.mannequin.view()
    }

    pub(super) fn feasibility(&self) -> FeasibilityView {
        self.rehearsal.view()
    }
}

impl Rig {
    /// Lets the puppet follow the show's figure from now on.
    pub(super) fn lead_puppet(&mut self) {
        let Some(rehearsing) = &mut self.rehearsing else {
            return;
        };
        let body = self.history.present().figure.as_ref().map(|doc| {
            let rest = doc.rest_frames();
            Body::new(&rehearsing.profile, &doc.figure, rest.as_deref())
        });
        let body = match body {
            Some(Ok(body)) => Some(body),
            None => None,
            Some(Err(error)) => {
                // A puppet with a figure of its own was meant to follow; others are posed by themselves.
                if rehearsing.profile.figure.is_some() || !matches!(error, BodyError::NoSuchLink { .. }) {
                    self.note(NoteLevel::Warning, error.to_string());
                }
                None
            }
        };
        if let Some(rehearsing) = &mut self.rehearsing {
            rehearsing.rehearsal.lead_by(body.clone());
        }
        if let Some(puppet) = &mut self.puppet {
            puppet.lead_by(body);
        }
    }

    /// Takes over the clip being edited where it is one of joints; its kinetics.
    pub(super) fn set_joint_clip(&mut self, show: &Show) -> Option<Kinetics> {
        let clip = show.current_joint_clip();
        let Some(rehearsing) = &mut self.rehearsing else {
            let times = clip
                .map(|clip| clip.times_secs())
                .filter(|times| !times.is_empty())?;
            return clip?.timing().kinetics(&times).ok();
        };
        let judged = rehearsing.rehearsal.judged();
        let (track, error) = match clip.map_or(Ok(None), |clip| judged.track(clip)) {
            Ok(track) => (track, None),
            Err(error) => (None, Some(format!("clip {}: {error}", show.clip))),
        };
        rehearsing.track = track;
        let kinetics = rehearsing.track.as_ref().map(|track| track.kinetics.clone());
        if let Some(error) = error {
            self.note(NoteLevel::Error, error);
        }
        kinetics
    }

    /// Takes the clip being edited into rehearsal.
    pub(super) fn rehearse_clip(&mut self, show: &Show) {
        let Some(rehearsing) = &mut self.rehearsing else {
            return;
        };
        rehearsing.play_waits = false;
        match (&rehearsing.track, &self.clip) {
            (Some(track), _) => rehearsing.rehearsal.set_track(track),
            (None, Some(clip)) => rehearsing.rehearsal.set_clip(show, clip),
            (None, None) => rehearsing.rehearsal.set_none(),
        }
    }

    /// One step's piece of rehearsal, and what waited for it.
    pub(super) fn rehearse(&mut self) {
        let show = Arc::clone(self.history.present());
        let Some(rehearsing) = &mut self.rehearsing else {
            return;
        };
        let was_busy = rehearsing.rehearsal.is_busy();
        let pace = if rehearsing.play_waits {
            Pace::Awaited
        } else {
            Pace::Aside
        };
        let slowed = rehearsing.rehearsal.advance(&show, pace);
        let done = was_busy && !rehearsing.rehearsal.is_busy();
        let play = done && std::mem::take(&mut rehearsing.play_waits);
        if done && !self.by_hand() {
            let secs = self.timeline.secs();
            if let Some(rehearsing) = &mut self.rehearsing {
                rehearsing.show(secs);
            }
        }
        if play && let Err(why) = self.play_puppet() {
            self.note(NoteLevel::Warning, why);
        }
        match slowed {
            Some(Ok(times_secs)) => self.slowed(times_secs),
            Some(Err(why)) => self.note(NoteLevel::Warning, why),
            None => {}
        }
    }

    fn slowed(&mut self, times_secs: Vec<f64>) {
        let before = self.history.present().key_times_secs();
        let span = |times: &[f64]| times.last().unwrap_or(&0.0) - times.first().unwrap_or(&0.0);
        let words = format!(
            "slowed to fit: {:.2} s became {:.2} s",
            span(&before),
            span(&times_secs)
        );
        let retime = EditCommand::Retime { times_secs };
        match document::apply(self.history.present(), &retime, None) {
            Ok(edited) => {
                self.change(edited.show, "Slow to fit".to_owned(), None);
                self.set_clip();
                self.note(NoteLevel::Info, words);
            }
            Err(error) => self.note(NoteLevel::Warning, error.to_string()),
        }
    }

    pub(super) fn slow_to_fit(&mut self) -> Result<(), String> {
        match &mut self.rehearsing {
            Some(rehearsing) => rehearsing.rehearsal.slow_to_fit(),
            None => Err("this show has no puppet that something could be too fast for".into()),
        }
    }

    pub(super) fn pose_puppet(&mut self, pose: &PuppetPose) -> Result<(), String> {
        let secs = self.timeline.secs();
        let seen: Option<PuppetView> = match pose {
            PuppetPose::FromMeasured => self.puppet.as_mut().map(|puppet| puppet.view(self.now)),
            _ => None,
        };
        let Some(rehearsing) = &mut self.rehearsing else {
            return Err("this show has no puppet to pose; name one in show.toml".into());
        };
        rehearsing.mannequin.apply(pose, seen.as_ref())?;
        if *pose == PuppetPose::FromClip {
            rehearsing.mannequin.stored();
            rehearsing.show(secs);
        }
        Ok(())
    }

    /// A pose stored where the clip is one of joints, or where there is no figure to store, is the puppet's.
    pub(super) fn store_joints(&self, edit: &EditCommand) -> Option<EditCommand> {
        let EditCommand::StoreKey { secs } = *edit else {
            return None;
        };
        let show = self.history.present();
        let of_joints = show.current_joint_clip().is_some() || show.figure.is_none();
        let mannequin = &self.rehearsing.as_ref().filter(|_| of_joints)?.mannequin;
        let angles_rad = mannequin.key();
        Some(EditCommand::StoreJoints { secs, angles_rad })
    }

    pub(super) fn order_puppet(&mut self, order: &PuppetCommand) -> Result<(), String> {
        let Some(puppet) = &mut self.puppet else {
            return Err("this show has no puppet; name one in show.toml or with --puppet".into());
        };
        puppet.order(order)?;
        if matches!(order, PuppetCommand::Heartbeat | PuppetCommand::CompensateLag(_)) {
            return Ok(());
        }
        if let Some(rehearsing) = &mut self.rehearsing {
            rehearsing.play_waits = false;
        }
        match order {
            PuppetCommand::Play => self.play_puppet(),
            PuppetCommand::Follow if self.stage.is_none() && self.rehearsing.is_none() => {
                Err("there is nothing that the puppet could follow".into())
            }
            _ => Ok(()),
        }
    }

    /// Plays the clip if it has been judged; else as soon as it has been.
    fn play_puppet(&mut self) -> Result<(), String> {
        let Some(rehearsing) = &mut self.rehearsing else {
            return Err("the joints of this puppet make no chain".into());
        };
        if rehearsing.rehearsal.is_busy() {
            rehearsing.play_waits = true;
            return Ok(());
        }
        let Some(track) = rehearsing.rehearsal.track().map(Arc::clone) else {
            return Err(match self.clip {
                None => "there is no clip to play; store keys first".into(),
                Some(_) => "the puppet has no figure to follow".into(),
            });
        };
        let warning = too_much(rehearsing.rehearsal.stretches());
        if let Some(puppet) = &mut self.puppet {
            puppet.play(&track, self.timeline.view())?;
        }
        if let Some(warning) = warning {
            self.note(NoteLevel::Warning, warning);
        }
        Ok(())
    }
}

/// What is said before a puppet plays what it cannot do.
fn too_much(stretches: &[StretchView]) -> Option<String> {
    let mut worst: Vec<&StretchView> = stretches.iter().collect();
    worst.sort_by(|a, b| b.factor.total_cmp(&a.factor));
    let told: Vec<String> = worst
        .iter()
        .take(STRETCHES_TOLD)
        .map(ToString::to_string)
        .collect();
    let more = match worst.len().saturating_sub(STRETCHES_TOLD) {
        0 => String::new(),
        more => format!("; and {more} more"),
    };
    (!told.is_empty()).then(|| {
        format!(
            "the puppet keeps its limits and will not do all of this clip: {}{more}. Slow it to fit, or change the poses",
            told.join("; ")
        )
    })
}
