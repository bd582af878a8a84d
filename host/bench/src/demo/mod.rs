//! The whole chain as one story, without pictures: hands on simulated controls pose the printed human key by key,
//! retime it, play it on screen and perform it on a simulated puppet.
//!
//! Everything that is posed or ordered enters as bytes of the dial box and the tablet and goes through the
//! function network. The story is told step by step to a callback, from which films and key pictures are made.

mod aim;
mod pose;
mod report;
mod solo;
mod story;
mod watch;

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use device_profiles::Profiles;
use rig::Snapshot;
use rig::document::Show;

pub use report::{DemoReport, LagReport, Limits, ServoReport, ServoRow, csv};

use crate::replay::{Journal, ReplayError, replay};
use crate::stand::HandError;
use crate::world::{Equipment, Late, World, WorldError, WorldOptions};
use solo::Solo;
use story::Story;

/// What the demo begins with.
pub struct DemoOptions {
    /// A show with a figure and a clip, whose keys are entered anew, and a puppet; or with a clip of the puppet's own
    /// joints, which it performs by itself.
    pub show: Show,
    /// Hardware knowledge.
    pub profiles: Arc<Profiles>,
    /// How many keys at most, from the first; none: all.
    pub keys_max: Option<usize>,
}

/// Where the story is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Chapter {
    /// Devices introduce themselves.
    Beginning,
    /// A key pose is being entered.
    Posing {
        /// Which, from 0.
        key: usize,
        /// Of how many.
        of: usize,
    },
    /// The kinetic curve is being adjusted.
    Retiming,
    /// The clip plays on screen.
    Playing,
    /// The puppet is measured, pinned and switched on.
    Arming,
    /// The puppet goes to the first pose and performs the clip.
    Performing,
    /// The puppet holds and is let go.
    Ending,
}

/// One step of the story.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// Where the story is.
    pub chapter: Chapter,
    /// Whether a key was stored in this step: the moment for its picture.
    pub key_stored: bool,
    /// The rig after the step.
    pub snapshot: &'a Arc<Snapshot>,
}

/// The demo could not be told to its end.
#[derive(Debug, thiserror::Error)]
pub enum DemoError {
    /// The world cannot begin.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The show has not what the demo needs.
    #[error("the demo needs a show with {missing}; take shows/salute")]
    Show {
        /// What is missing.
        missing: &'static str,
    },
    /// Something did not happen.
    #[error(transparent)]
    Late(#[from] Late),
    /// A hand could not do something.
    #[error(transparent)]
    Hand(#[from] HandError),
    /// The journal could not be played again.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// The callback asked for the end. Torque is off if the flag says so.
    #[error("stopped before the end{}", if *.torque_off { "" } else { "; torque could not be confirmed to be off" })]
    Stopped {
        /// Whether torque is known to be off.
        torque_off: bool,
    },
}

/// The demo, told.
#[derive(Debug)]
pub struct Demo {
    /// What was found out.
    pub report: DemoReport,
    /// Goals and readings of every control cycle with torque.
    pub rows: Vec<ServoRow>,
    /// Names of the puppet's joints, by place.
    pub joints: Vec<String>,
    /// The journal.
    pub journal: String,
    /// The show as it was left: the clip that was entered.
    pub show: Arc<Show>,
}

/// Where the puppet hangs at first, radians: slumped, and nowhere near the clip's first pose.
const HANGING: [(&str, f64); 10] = [
    ("neck_pitch", 0.6),
    ("neck_roll", 0.2),
    ("waist_pitch", 0.35),
    ("right_shoulder_pitch", 0.5),
    ("right_elbow", 0.4),
    ("left_shoulder_pitch", 0.3),
    ("left_shoulder_roll", 0.25),
    ("left_elbow", 0.6),
    ("right_knee", 0.5),
    ("right_hip_pitch", 0.35),
];
/// How fast joints that are let go sink back, radians a second; ours, a slow fall.
const SAG_RAD_PER_S: f64 = 0.8;

/// Tells the story. `seen` gets every step and may end it.
pub fn run(
    options: DemoOptions,
    seen: &mut dyn FnMut(Scene<'_>) -> ControlFlow<()>,
) -> Result<Demo, DemoError> {
    // A puppet that follows no figure performs by itself; there is nothing for hands to pose.
    let solo = options.show.current_joint_clip().is_some();
    let (targets, show) = if solo {
        (Vec::new(), options.show.clone())
    } else {
        let targets = pose::targets(&options)?;
        let show = pose::stripped(&options.show, &targets);
        (targets, show)
    };
    let mut equipment = Equipment {
        puppet: show.puppet.clone(),
        ..Equipment::default()
    };
    if solo {
        (equipment.knobs, equipment.tablet) = (None, None);
    }
    if equipment.puppet.is_none() {
        return Err(DemoError::Show { missing: "a puppet" });
    }
    let hanging: BTreeMap<_, _> = HANGING
        .iter()
        .map(|(joint, rad)| ((*joint).to_owned(), *rad))
        .collect();
    // Another puppet than the shipped one has other joints: those it lacks begin at 0.
    let profile = options
        .profiles
        .puppet(equipment.puppet.as_deref().unwrap_or_default());
    let profile = profile.map_err(|error| WorldError::Stand(error.into()))?;
    equipment.plan.start_rad = if solo {
        solo::hanging(profile)
    } else {
        hanging
            .into_iter()
            .filter(|(joint, _)| profile.joint(joint).is_some())
            .collect()
    };
    equipment.plan.sag_rad_per_s = Some(SAG_RAD_PER_S);
    let joints: Vec<String> = profile.joints().map(|joint| joint.name.clone()).collect();
    let journal = Journal::new();
    let world = World::new(WorldOptions {
        profiles: Arc::clone(&options.profiles),
        equipment: equipment.clone(),
        journal: Some(Box::new(journal.clone())),
        ..WorldOptions::new(show.clone())
    })?;
    let told = if solo {
        Solo::new(world, seen).tell()?
    } else {
        Story::new(world, seen)?.tell(&targets)?
    };
    let text = journal.text();
    let replayed = replay(&text, show, options.profiles, &equipment)?;
    let report = DemoReport {
        journal_hash: journal.hash(),
        journal_replay_identical: replayed.is_identical(),
        ..told.report
    };
    Ok(Demo {
        report,
        rows: told.rows,
        joints,
        journal: text,
        show: told.show,
    })
}

#[cfg(test)]
mod tests;
