//! Keys stored, moved, copied and deleted. They stay apart and in order.

use std::sync::Arc;

use motion::{FigureKey, FigurePose, LinkPose};

use super::{EditError, Edited, current, done};
use crate::document::clip::ClipDoc;
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

fn place_of(clip: &ClipDoc, secs: f64) -> Result<Place, EditError> {
    check_time(secs)?;
    let near = |key: &Arc<FigureKey>| (key.secs - secs).abs() < KEY_GAP_SECS_MIN;
    Ok(match clip.keys.iter().position(near) {
        Some(place) => Place::Taken(place),
        None => Place::Free(clip.keys.partition_point(|key| key.secs < secs)),
    })
}

fn check_time(secs: f64) -> Result<(), EditError> {
    if secs.abs() <= SECS_MAX {
        Ok(())
    } else {
        Err(EditError::BadTime { secs })
    }
}

fn key_of(clip: &ClipDoc, key: usize) -> Result<&FigureKey, EditError> {
    let count = clip.keys.len();
    clip.keys
        .get(key)
        .map(Arc::as_ref)
        .ok_or(EditError::NoSuchKey { key, count })
}

/// Adds a key. Kinetic adjustments belong to the coefficients of the old keys and go.
fn insert(clip: &mut ClipDoc, place: usize, key: FigureKey) -> Result<(), EditError> {
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
    if show.current_clip().is_none() {
        FIRST_CLIP.clone_into(&mut show.clip);
    }
    let mut clip = current(&show).unwrap_or_default();
    let pose = pose.clone();
    match place_of(&clip, secs)? {
        Place::Taken(place) => {
            let secs = clip.keys[place].secs;
            clip.keys[place] = Arc::new(FigureKey { secs, pose });
            done(&show, clip, format!("Change key at {secs:.2} s"), None)
        }
        Place::Free(place) => {
            insert(&mut clip, place, FigureKey { secs, pose })?;
            done(&show, clip, format!("Store key at {secs:.2} s"), None)
        }
    }
}

fn is_sound(link: &LinkPose) -> bool {
    let direction = link.direction.is_finite() && link.direction.length_squared() > 0.0;
    direction && link.twist_rad.is_finite() && link.length.is_finite() && link.length > 0.0
}

/// Takes a key away.
pub(super) fn delete(show: &Show, key: usize) -> Result<Edited, EditError> {
    let mut clip = current(show)?;
    let secs = key_of(&clip, key)?.secs;
    clip.keys.remove(key);
    clip.coefficient_edits.clear();
    done(show, clip, format!("Delete key at {secs:.2} s"), None)
}

/// Gives a key another time between its neighbours; one gesture a key.
pub(super) fn move_to(show: &Show, key: usize, secs: f64) -> Result<Edited, EditError> {
    let mut clip = current(show)?;
    let pose = key_of(&clip, key)?.pose.clone();
    check_time(secs)?;
    let time = |place: Option<usize>| place.and_then(|place| clip.keys.get(place)).map(|key| key.secs);
    let after_secs = time(key.checked_sub(1)).unwrap_or(-SECS_MAX - KEY_GAP_SECS_MIN);
    let before_secs = time(key.checked_add(1)).unwrap_or(SECS_MAX + KEY_GAP_SECS_MIN);
    if secs - after_secs < KEY_GAP_SECS_MIN || before_secs - secs < KEY_GAP_SECS_MIN {
        return Err(EditError::PassesNeighbour {
            key,
            after_secs,
            before_secs,
        });
    }
    clip.keys[key] = Arc::new(FigureKey { secs, pose });
    let gesture = format!("move key {key}");
    done(
        show,
        clip,
        format!("Move key {key} to {secs:.2} s"),
        Some(gesture),
    )
}

/// Puts a key's pose at another time as well.
pub(super) fn copy(show: &Show, key: usize, secs: f64) -> Result<Edited, EditError> {
    let mut clip = current(show)?;
    let pose = key_of(&clip, key)?.pose.clone();
    let Place::Free(place) = place_of(&clip, secs)? else {
        return Err(EditError::TimeTaken { secs });
    };
    insert(&mut clip, place, FigureKey { secs, pose })?;
    done(show, clip, format!("Copy key {key} to {secs:.2} s"), None)
}
