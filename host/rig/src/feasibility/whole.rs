//! A whole show judged at once, for those who have nothing else to do meanwhile.

use std::sync::Arc;

use device_profiles::{ProfileError, Profiles};
use motion::{ChainError, ClipError};

use super::{FeasibilityView, Judged, Pace, Rehearsal};
use crate::document::{JointClipDocError, Show};
use crate::puppet::{Body, BodyError, Model};

/// A clip of a show, judged.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedClip {
    /// The clip's name.
    pub clip: String,
    /// Whether the puppet can do it.
    pub feasibility: FeasibilityView,
    /// The largest angle between a link of the figure and what the joints could do about it, radians; 0 for clips of
    /// joints.
    pub error_rad: f64,
}

/// A show cannot be judged.
#[derive(Debug, thiserror::Error)]
pub enum JudgeError {
    /// No such puppet; the message lists what there is.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// The puppet's joints make no chain.
    #[error("puppet {puppet}: {source}")]
    Chain {
        /// The puppet.
        puppet: String,
        /// Why.
        source: ChainError,
    },
    /// The puppet cannot follow the figure.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// A clip cannot be played.
    #[error("clip {clip}: {source}")]
    Clip {
        /// Its name.
        clip: String,
        /// Why.
        source: ClipError,
    },
    /// A clip of joints does not suit the puppet.
    #[error("clip {clip}: {source}")]
    Joints {
        /// Its name.
        clip: String,
        /// Why.
        source: JointClipDocError,
    },
}

/// Judges every clip of a show that has keys, on a puppet.
pub fn judge(show: &Show, puppet: &str, profiles: &Profiles) -> Result<Vec<JudgedClip>, JudgeError> {
    let profile = profiles.puppet(puppet)?;
    let model = Model::new(profile).map_err(|source| JudgeError::Chain {
        puppet: profile.name.clone(),
        source,
    })?;
    let judged = Judged::new(profile, Arc::new(model), profiles);
    let body = match &show.figure {
        Some(figure) if !show.clips.is_empty() => {
            let rest = figure.rest_frames();
            Some(Body::new(profile, &figure.figure, rest.as_deref())?)
        }
        _ => None,
    };
    let mut all = Vec::new();
    for name in show.clip_names() {
        let mut chosen = show.clone();
        name.clone_into(&mut chosen.clip);
        let mut rehearsal = Rehearsal::new(judged.clone());
        rehearsal.lead_by(body.clone());
        if !begin(&mut rehearsal, &judged, &chosen)? {
            continue;
        }
        while rehearsal.is_busy() {
            rehearsal.advance(&chosen, Pace::AtOnce);
        }
        all.push(JudgedClip {
            clip: name.to_owned(),
            error_rad: rehearsal.error_rad(),
            feasibility: rehearsal.view(),
        });
    }
    Ok(all)
}

/// Takes the chosen clip into rehearsal; false where there is nothing in it.
fn begin(rehearsal: &mut Rehearsal, judged: &Judged, show: &Show) -> Result<bool, JudgeError> {
    let clip = show.clip.clone();
    if let (Some(doc), Some(figure)) = (show.current_clip(), &show.figure) {
        let built = doc
            .clip(&figure.figure)
            .map_err(|source| JudgeError::Clip { clip, source })?;
        let Some(built) = built else { return Ok(false) };
        rehearsal.set_clip(show, &Arc::new(built));
        return Ok(true);
    }
    let Some(doc) = show.current_joint_clip() else {
        return Ok(false);
    };
    let track = judged
        .track(doc)
        .map_err(|source| JudgeError::Joints { clip, source })?;
    let Some(track) = track else { return Ok(false) };
    rehearsal.set_track(&track);
    Ok(true)
}
