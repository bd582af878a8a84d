//! Changes of the show that can be undone: each makes a new show or says why not.

use std::sync::Arc;

use motion::{FigureKey, FigurePose, Kinetics, KineticsError, KineticsMode};
use thiserror::Error;

use super::clip::ClipDoc;
use super::limits::KEYS_MAX;
use super::show::Show;
use crate::command::{self, EditCommand};

/// A changed show, ready for the history.
#[derive(Clone, Debug, PartialEq)]
pub struct Edited {
    /// The show after the change.
    pub show: Show,
    /// The change in words, for the undo menu.
    pub words: String,
    /// Equal for changes that belong to one movement of the hand; see [`History`](crate::history::History).
    pub gesture: Option<String>,
}

/// Why an edit was refused; nothing has changed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum EditError {
    /// Keys need someone who poses.
    #[error("this show has no figure, so there is nothing to key; import one first")]
    NoFigure,
    /// There is no clip to edit.
    #[error("no clip is chosen; store a key to begin one")]
    NoClip,
    /// Nothing is on screen to be stored.
    #[error("there is no pose on screen to store")]
    NoPose,
    /// The pose has another number of links.
    #[error("the pose has {links} links and the figure {wanted}")]
    PoseOfAnotherFigure {
        /// Links of the pose.
        links: usize,
        /// Links of the figure.
        wanted: usize,
    },
    /// The pose or time is NaN or infinite.
    #[error("the pose or its time is not finite; nothing is stored")]
    NotFinite,
    /// No key has this index.
    #[error("there is no key {key}; the clip has {count}, counted from 0")]
    NoSuchKey {
        /// The key asked for.
        key: usize,
        /// How many there are.
        count: usize,
    },
    /// A key would pass another or meet it.
    #[error("key {key} must stay between its neighbours, after {after_secs} s and before {before_secs} s")]
    PassesNeighbour {
        /// The key to be moved.
        key: usize,
        /// Time of the key before it.
        after_secs: f64,
        /// Time of the key after it.
        before_secs: f64,
    },
    /// A copy would lie on a key.
    #[error("there already is a key at {secs} s; choose another time")]
    TimeTaken {
        /// The time asked for.
        secs: f64,
    },
    /// The clip is as long as clips get.
    #[error("a clip has at most {KEYS_MAX} keys")]
    TooManyKeys,
    /// The kinetic spline cannot be changed so.
    #[error(transparent)]
    Kinetics(#[from] KineticsError),
    /// No clip has this name.
    #[error("there is no clip `{name}`; there are: {known}")]
    NoSuchClip {
        /// The name asked for.
        name: String,
        /// The names that exist.
        known: String,
    },
}

/// Name of the clip that the first stored key begins.
const FIRST_CLIP: &str = "clip";

/// Applies a command to a show. `pose` is the one on screen; only [`EditCommand::StoreKey`] needs it.
pub fn apply(show: &Show, edit: &EditCommand, pose: Option<&FigurePose>) -> Result<Edited, EditError> {
    match edit {
        EditCommand::StoreKey { secs } => store(show, *secs, pose),
        EditCommand::DeleteKey { key } => delete(show, *key),
        EditCommand::MoveKey { key, secs } => move_key(show, *key, *secs),
        EditCommand::CopyKey { key, secs } => copy(show, *key, *secs),
        EditCommand::Kinetics { coefficient, by } => adjust(show, *coefficient, *by),
        EditCommand::KineticsMode(mode) => choose_mode(show, *mode),
        EditCommand::ResetKinetics => {
            let clip = ClipDoc {
                coefficient_edits: Vec::new(),
                ..current(show)?.clone()
            };
            Ok(done(show, clip, "Reset kinetics".to_owned(), None))
        }
        EditCommand::ChooseClip(name) => choose_clip(show, name),
    }
}

fn current(show: &Show) -> Result<&ClipDoc, EditError> {
    show.current_clip().map(Arc::as_ref).ok_or(EditError::NoClip)
}

/// The show with its current clip replaced.
fn done(show: &Show, clip: ClipDoc, words: String, gesture: Option<String>) -> Edited {
    let gesture = gesture.map(|gesture| format!("{}: {gesture}", show.clip));
    Edited {
        show: show.with_clip(&show.clip, clip),
        words,
        gesture,
    }
}

fn key_of(clip: &ClipDoc, key: usize) -> Result<&Arc<FigureKey>, EditError> {
    clip.keys.get(key).ok_or(EditError::NoSuchKey {
        key,
        count: clip.keys.len(),
    })
}

fn store(show: &Show, secs: f64, pose: Option<&FigurePose>) -> Result<Edited, EditError> {
    let figure = show.figure.as_ref().ok_or(EditError::NoFigure)?;
    let pose = pose.ok_or(EditError::NoPose)?;
    let (links, wanted) = (pose.links.len(), figure.figure.len());
    if links != wanted {
        return Err(EditError::PoseOfAnotherFigure { links, wanted });
    }
    if !secs.is_finite() || !is_sound(pose) {
        return Err(EditError::NotFinite);
    }
    let begun = Show {
        clip: FIRST_CLIP.to_owned(),
        ..show.clone()
    };
    let (show, mut clip) = match show.current_clip() {
        Some(clip) => (show, ClipDoc::clone(clip)),
        None => (
            &begun,
            begun
                .current_clip()
                .map(|clip| ClipDoc::clone(clip))
                .unwrap_or_default(),
        ),
    };
    let key = Arc::new(FigureKey {
        secs,
        pose: pose.clone(),
    });
    let place = clip.keys.partition_point(|key| key.secs < secs);
    if clip.keys.get(place).is_some_and(|key| key.secs == secs) {
        clip.keys[place] = key;
        return Ok(done(show, clip, format!("Change key at {secs:.2} s"), None));
    }
    insert(&mut clip, place, key)?;
    Ok(done(show, clip, format!("Store key at {secs:.2} s"), None))
}

fn is_sound(pose: &FigurePose) -> bool {
    let link = |link: &motion::LinkPose| {
        link.direction.is_finite()
            && link.direction.length_squared() > 0.0
            && link.twist_rad.is_finite()
            && link.length.is_finite()
            && link.length > 0.0
    };
    pose.root.is_finite() && pose.links.iter().all(link)
}

/// Adds a key. Kinetic adjustments belong to the coefficients of the old keys and go.
fn insert(clip: &mut ClipDoc, place: usize, key: Arc<FigureKey>) -> Result<(), EditError> {
    if clip.keys.len() >= KEYS_MAX {
        return Err(EditError::TooManyKeys);
    }
    clip.keys.insert(place, key);
    clip.coefficient_edits.clear();
    Ok(())
}

fn delete(show: &Show, key: usize) -> Result<Edited, EditError> {
    let mut clip = current(show)?.clone();
    let secs = key_of(&clip, key)?.secs;
    clip.keys.remove(key);
    clip.coefficient_edits.clear();
    Ok(done(show, clip, format!("Delete key at {secs:.2} s"), None))
}

fn move_key(show: &Show, key: usize, secs: f64) -> Result<Edited, EditError> {
    let mut clip = current(show)?.clone();
    let old = Arc::clone(key_of(&clip, key)?);
    if !secs.is_finite() {
        return Err(EditError::NotFinite);
    }
    let neighbour = |place: Option<usize>| place.and_then(|place| clip.keys.get(place)).map(|key| key.secs);
    let after_secs = neighbour(key.checked_sub(1)).unwrap_or(f64::NEG_INFINITY);
    let before_secs = neighbour(key.checked_add(1)).unwrap_or(f64::INFINITY);
    if secs <= after_secs || secs >= before_secs {
        return Err(EditError::PassesNeighbour {
            key,
            after_secs,
            before_secs,
        });
    }
    clip.keys[key] = Arc::new(FigureKey {
        secs,
        pose: old.pose.clone(),
    });
    Ok(done(
        show,
        clip,
        format!("Move key {key} to {secs:.2} s"),
        Some(format!("move key {key}")),
    ))
}

fn copy(show: &Show, key: usize, secs: f64) -> Result<Edited, EditError> {
    let mut clip = current(show)?.clone();
    let pose = key_of(&clip, key)?.pose.clone();
    if !secs.is_finite() {
        return Err(EditError::NotFinite);
    }
    let place = clip.keys.partition_point(|key| key.secs < secs);
    if clip.keys.get(place).is_some_and(|key| key.secs == secs) {
        return Err(EditError::TimeTaken { secs });
    }
    insert(&mut clip, place, Arc::new(FigureKey { secs, pose }))?;
    Ok(done(show, clip, format!("Copy key {key} to {secs:.2} s"), None))
}

fn adjust(show: &Show, coefficient: usize, by: f64) -> Result<Edited, EditError> {
    let mut clip = current(show)?.clone();
    // Judged alone: the sum with earlier adjustments is as good as its newest part.
    Kinetics::new(&clip.times_secs(), clip.kinetics)?
        .edited(&[(coefficient, by)], motion::kinetics::Ordering::Free)?;
    match clip
        .coefficient_edits
        .binary_search_by_key(&coefficient, |&(index, _)| index)
    {
        Ok(place) => clip.coefficient_edits[place].1 += by,
        Err(place) => clip.coefficient_edits.insert(place, (coefficient, by)),
    }
    clip.coefficient_edits.retain(|&(_, by)| by != 0.0);
    if clip.coefficient_edits.iter().any(|&(_, by)| !by.is_finite()) {
        return Err(EditError::NotFinite);
    }
    let words = format!("Adjust timing at coefficient {coefficient}");
    Ok(done(
        show,
        clip,
        words,
        Some(format!("coefficient {coefficient}")),
    ))
}

fn choose_mode(show: &Show, mode: command::KineticsMode) -> Result<Edited, EditError> {
    let (kinetics, word) = match mode {
        command::KineticsMode::Natural => (KineticsMode::Natural, "natural"),
        command::KineticsMode::Monotone => (KineticsMode::Monotone, "monotone"),
        command::KineticsMode::Linear => (KineticsMode::Linear, "linear"),
    };
    let clip = ClipDoc {
        kinetics,
        ..current(show)?.clone()
    };
    Ok(done(show, clip, format!("Make timing {word}"), None))
}

fn choose_clip(show: &Show, name: &str) -> Result<Edited, EditError> {
    if !show.clips.contains_key(name) {
        let known: Vec<&str> = show.clips.keys().map(String::as_str).collect();
        return Err(EditError::NoSuchClip {
            name: name.to_owned(),
            known: known.join(", "),
        });
    }
    let chosen = Show {
        clip: name.to_owned(),
        ..show.clone()
    };
    Ok(Edited {
        show: chosen,
        words: format!("Choose clip {name}"),
        gesture: None,
    })
}
