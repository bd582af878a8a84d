//! Keys stored, moved, copied and deleted. They stay apart and in order.

use std::collections::BTreeMap;
use std::sync::Arc;

use motion::{FigureKey, FigurePose, JointKey, LinkPose};

use super::{EditError, Edited, Said, done};
use crate::document::clip::{ClipDoc, JointClipDoc, Keyed};
use crate::document::limits::{KEY_GAP_SECS_MIN, KEYS_MAX, SECS_MAX};
use crate::document::show::Show;

/// Name of the clip that the first stored key begins.
const FIRST_CLIP: &str = "clip";

/// Where a time falls among the keys of a clip.
enum Place {
    /// On this key.
    Taken(usize),
    /// Before this key, or after all.
    Free(usize),
}

fn place_of<K: Keyed>(clip: &ClipDoc<K>, secs: f64) -> Result<Place, EditError> {
    check_time(secs)?;
    let near = |key: &Arc<K>| (key.secs() - secs).abs() < KEY_GAP_SECS_MIN;
    Ok(match clip.keys.iter().position(near) {
        Some(place) => Place::Taken(place),
        None => Place::Free(clip.keys.partition_point(|key| key.secs() < secs)),
    })
}

fn check_time(secs: f64) -> Result<(), EditError> {
    if secs.abs() <= SECS_MAX {
        Ok(())
    } else {
        Err(EditError::BadTime { secs })
    }
}

fn key_of<K>(clip: &ClipDoc<K>, key: usize) -> Result<&K, EditError> {
    let count = clip.keys.len();
    clip.keys
        .get(key)
        .map(Arc::as_ref)
        .ok_or(EditError::NoSuchKey { key, count })
}

/// Adds a key. Kinetic adjustments belong to the coefficients of the old keys and go.
fn insert<K>(clip: &mut ClipDoc<K>, place: usize, key: K) -> Result<(), EditError> {
    if clip.keys.len() >= KEYS_MAX {
        return Err(EditError::TooManyKeys);
    }
    clip.keys.insert(place, Arc::new(key));
    clip.coefficient_edits.clear();
    Ok(())
}

/// Stores a pose as a key, or as the pose of the key that is there; begins a clip if there is none.
pub(super) fn store(show: &Show, secs: f64, pose: Option<&FigurePose>) -> Result<Edited, EditError> {
    let figure = show.figure.as_ref().ok_or(EditError::NoFigure)?;
    let pose = pose.ok_or(EditError::NoPose)?;
    let (links, wanted) = (pose.links.len(), figure.figure.len());
    if links != wanted {
        return Err(EditError::PoseOfAnotherFigure { links, wanted });
    }
    if !pose.root.is_finite() || !pose.links.iter().all(is_sound) {
        return Err(EditError::BadPose);
    }
    let mut show = show.clone();
    if show.current_clip().is_none() && show.current_joint_clip().is_none() {
        FIRST_CLIP.clone_into(&mut show.clip);
    }
    if show.current_joint_clip().is_some() {
        return Err(EditError::NotOfFigure { name: show.clip });
    }
    let mut clip = show
        .current_clip()
        .map(|clip| ClipDoc::clone(clip))
        .unwrap_or_default();
    let said = put(
        &mut clip,
        FigureKey {
            secs,
            pose: pose.clone(),
        },
    )?;
    done(&show, clip, said)
}

/// Stores a pose of the puppet's joints, or replaces that of the key that is there; begins a clip if there is none.
pub(super) fn store_joints(
    show: &Show,
    secs: f64,
    angles_rad: &BTreeMap<String, f64>,
) -> Result<Edited, EditError> {
    if angles_rad.is_empty() || !angles_rad.values().all(|angle| angle.is_finite()) {
        return Err(EditError::BadJoints);
    }
    if show.current_clip().is_some() {
        return Err(EditError::NotOfJoints {
            name: show.clip.clone(),
        });
    }
    let mut show = show.clone();
    if show.current_joint_clip().is_none() {
        FIRST_CLIP.clone_into(&mut show.clip);
    }
    let mut clip = show
        .current_joint_clip()
        .map(|clip| JointClipDoc::clone(clip))
        .unwrap_or_default();
    let angles_rad = angles_rad.clone();
    let said = put(&mut clip, JointKey { secs, angles_rad })?;
    done(&show, clip, said)
}

/// Adds a key, or puts its pose into the key that is there.
fn put<K: Keyed>(clip: &mut ClipDoc<K>, key: K) -> Result<Said, EditError> {
    let secs = key.secs();
    let words = match place_of(clip, secs)? {
        Place::Taken(place) => {
            let secs = clip.keys[place].secs();
            clip.keys[place] = Arc::new(key.at(secs));
            format!("Change key at {secs:.2} s")
        }
        Place::Free(place) => {
            insert(clip, place, key)?;
            format!("Store key at {secs:.2} s")
        }
    };
    Ok(Said { words, gesture: None })
}

fn is_sound(link: &LinkPose) -> bool {
    let direction = link.direction.is_finite() && link.direction.length_squared() > 0.0;
    direction && link.twist_rad.is_finite() && link.length.is_finite() && link.length > 0.0
}

/// Takes a key away.
pub(super) fn delete<K: Keyed>(clip: &mut ClipDoc<K>, key: usize) -> Result<Said, EditError> {
    let secs = key_of(clip, key)?.secs();
    clip.keys.remove(key);
    clip.coefficient_edits.clear();
    let words = format!("Delete key at {secs:.2} s");
    Ok(Said { words, gesture: None })
}

/// Gives a key another time between its neighbours; one gesture a key.
pub(super) fn move_to<K: Keyed>(clip: &mut ClipDoc<K>, key: usize, secs: f64) -> Result<Said, EditError> {
    let moved = key_of(clip, key)?.at(secs);
    check_time(secs)?;
    let time = |place: Option<usize>| place.and_then(|place| clip.keys.get(place)).map(|key| key.secs());
    let after_secs = time(key.checked_sub(1)).unwrap_or(-SECS_MAX - KEY_GAP_SECS_MIN);
    let before_secs = time(key.checked_add(1)).unwrap_or(SECS_MAX + KEY_GAP_SECS_MIN);
    if secs - after_secs < KEY_GAP_SECS_MIN || before_secs - secs < KEY_GAP_SECS_MIN {
        return Err(EditError::PassesNeighbour {
            key,
            after_secs,
            before_secs,
        });
    }
    clip.keys[key] = Arc::new(moved);
    Ok(Said {
        words: format!("Move key {key} to {secs:.2} s"),
        gesture: Some(format!("move key {key}")),
    })
}

/// Puts a key's pose at another time as well.
pub(super) fn copy<K: Keyed>(clip: &mut ClipDoc<K>, key: usize, secs: f64) -> Result<Said, EditError> {
    let copied = key_of(clip, key)?.at(secs);
    let Place::Free(place) = place_of(clip, secs)? else {
        return Err(EditError::TimeTaken { secs });
    };
    insert(clip, place, copied)?;
    let words = format!("Copy key {key} to {secs:.2} s");
    Ok(Said { words, gesture: None })
}
