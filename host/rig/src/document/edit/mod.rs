//! Changes of the show that can be undone: each makes a new show or says why not.
//!
//! Changes of keys and of timing each have their own file; what they have in common is here.

mod keys;
mod timing;

use motion::{FigurePose, KineticsError};
use thiserror::Error;

use super::clip::ClipDoc;
use super::limits::{KEYS_MAX, SECS_MAX};
use super::show::Show;
use crate::command::EditCommand;

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
    /// The pose is NaN or infinite, or has a link without direction or length.
    #[error("the pose on screen is not finite; nothing is stored")]
    BadPose,
    /// No key can be there.
    #[error("{secs} s is no time for a key; times lie within {SECS_MAX} s of 0")]
    BadTime {
        /// The time asked for.
        secs: f64,
    },
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

/// Applies a command to a show. `pose` is the one on screen; only [`EditCommand::StoreKey`] needs it.
pub fn apply(show: &Show, edit: &EditCommand, pose: Option<&FigurePose>) -> Result<Edited, EditError> {
    match edit {
        EditCommand::StoreKey { secs } => keys::store(show, *secs, pose),
        EditCommand::DeleteKey { key } => keys::delete(show, *key),
        EditCommand::MoveKey { key, secs } => keys::move_to(show, *key, *secs),
        EditCommand::CopyKey { key, secs } => keys::copy(show, *key, *secs),
        EditCommand::Kinetics { coefficient, by } => timing::adjust(show, *coefficient, *by),
        EditCommand::KineticsMode(mode) => timing::choose_mode(show, *mode),
        EditCommand::ResetKinetics => timing::reset(show),
        EditCommand::ChooseClip(name) => choose_clip(show, name),
    }
}

fn choose_clip(show: &Show, name: &str) -> Result<Edited, EditError> {
    if !show.clips.contains_key(name) {
        let known: Vec<&str> = show.clips.keys().map(String::as_str).collect();
        let (name, known) = (name.to_owned(), known.join(", "));
        return Err(EditError::NoSuchClip { name, known });
    }
    let mut chosen = show.clone();
    name.clone_into(&mut chosen.clip);
    let words = format!("Choose clip {name}");
    Ok(Edited {
        show: chosen,
        words,
        gesture: None,
    })
}

/// A copy of the clip being edited.
fn current(show: &Show) -> Result<ClipDoc, EditError> {
    show.current_clip()
        .map(|clip| ClipDoc::clone(clip))
        .ok_or(EditError::NoClip)
}

/// The show with its current clip replaced, if that still has a timing.
fn done(show: &Show, clip: ClipDoc, words: String, gesture: Option<String>) -> Result<Edited, EditError> {
    clip.check_timing()?;
    let gesture = gesture.map(|gesture| format!("{}: {gesture}", show.clip));
    let show = show.with_clip(&show.clip, clip);
    Ok(Edited { show, words, gesture })
}
