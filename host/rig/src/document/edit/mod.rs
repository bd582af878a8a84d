//! Changes of the show that can be undone: each makes a new show or says why not.
//!
//! Changes of keys and of timing each have their own file; what they have in common is here.

mod keys;
mod timing;

use motion::{FigureKey, FigurePose, JointKey, KineticsError};
use thiserror::Error;

use super::clip::{ClipDoc, JointClipDoc, Keyed};
use super::limits::{KEYS_MAX, SECS_MAX};
use super::show::{Show, is_file_name};
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
    /// A stored pose of joints names none, or an angle is not finite.
    #[error("the puppet's pose has no joint, or an angle that is not finite; nothing is stored")]
    BadJoints,
    /// The clip being edited is of the other kind.
    #[error("clip `{name}` is of the figure; begin or choose one of the puppet's joints to store them")]
    NotOfJoints {
        /// The clip's name.
        name: String,
    },
    /// The clip being edited is of the other kind.
    #[error("clip `{name}` is of the puppet's joints; choose one of the figure to store its pose")]
    NotOfFigure {
        /// The clip's name.
        name: String,
    },
    /// New times are not one for each key, or not in order.
    #[error("{given} times for {wanted} keys, each later than the one before; nothing is changed")]
    BadTimes {
        /// How many came.
        given: usize,
        /// How many keys there are.
        wanted: usize,
    },
    /// A clip cannot have this name.
    #[error("`{name}` is no name for a new clip: it is taken, or no file can be called so")]
    BadClipName {
        /// The name asked for.
        name: String,
    },
    /// No clip has this name.
    #[error("there is no clip `{name}`; there are: {known}")]
    NoSuchClip {
        /// The name asked for.
        name: String,
        /// The names that exist.
        known: String,
    },
}

/// What a change of a clip says about itself: words for the undo menu, and the gesture it is part of.
struct Said {
    words: String,
    gesture: Option<String>,
}

/// Applies a command to a show. `pose` is the one on screen; only [`EditCommand::StoreKey`] needs it.
pub fn apply(show: &Show, edit: &EditCommand, pose: Option<&FigurePose>) -> Result<Edited, EditError> {
    match edit {
        EditCommand::StoreKey { secs } => keys::store(show, *secs, pose),
        EditCommand::StoreJoints { secs, angles_rad } => keys::store_joints(show, *secs, angles_rad),
        EditCommand::BeginJointClip(name) => begin_joint_clip(show, name),
        EditCommand::DeleteKey { key } => change(show, |c| keys::delete(c, *key), |c| keys::delete(c, *key)),
        EditCommand::MoveKey { key, secs } => change(
            show,
            |c| keys::move_to(c, *key, *secs),
            |c| keys::move_to(c, *key, *secs),
        ),
        EditCommand::CopyKey { key, secs } => change(
            show,
            |c| keys::copy(c, *key, *secs),
            |c| keys::copy(c, *key, *secs),
        ),
        EditCommand::Retime { times_secs } => change(
            show,
            |c| timing::retime(c, times_secs),
            |c| timing::retime(c, times_secs),
        ),
        EditCommand::Kinetics { coefficient, by } => change(
            show,
            |c| timing::adjust(c, *coefficient, *by),
            |c| timing::adjust(c, *coefficient, *by),
        ),
        EditCommand::KineticsMode(mode) => change(
            show,
            |c| Ok(timing::choose_mode(c, *mode)),
            |c| Ok(timing::choose_mode(c, *mode)),
        ),
        EditCommand::ResetKinetics => change(show, |c| Ok(timing::reset(c)), |c| Ok(timing::reset(c))),
        EditCommand::ChooseClip(name) => choose_clip(show, name),
    }
}

/// Changes the clip being edited, whichever kind it is.
fn change(
    show: &Show,
    of_figure: impl FnOnce(&mut ClipDoc) -> Result<Said, EditError>,
    of_joints: impl FnOnce(&mut JointClipDoc) -> Result<Said, EditError>,
) -> Result<Edited, EditError> {
    if let Some(clip) = show.current_clip() {
        let mut clip = ClipDoc::clone(clip);
        let said = of_figure(&mut clip)?;
        return done(show, clip, said);
    }
    let clip = show.current_joint_clip().ok_or(EditError::NoClip)?;
    let mut clip = JointClipDoc::clone(clip);
    let said = of_joints(&mut clip)?;
    done(show, clip, said)
}

/// A clip that knows where in a show it belongs.
trait Belongs: Keyed + Sized {
    fn into(clip: ClipDoc<Self>, show: &Show) -> Show;
}

impl Belongs for FigureKey {
    fn into(clip: ClipDoc, show: &Show) -> Show {
        show.with_clip(&show.clip, clip)
    }
}

impl Belongs for JointKey {
    fn into(clip: JointClipDoc, show: &Show) -> Show {
        show.with_joint_clip(&show.clip, clip)
    }
}

fn begin_joint_clip(show: &Show, name: &str) -> Result<Edited, EditError> {
    if !is_file_name(name) || show.clip_names().any(|known| known == name) {
        return Err(EditError::BadClipName {
            name: name.to_owned(),
        });
    }
    let mut begun = show.with_joint_clip(name, JointClipDoc::default());
    name.clone_into(&mut begun.clip);
    Ok(Edited {
        show: begun,
        words: format!("Begin clip {name}"),
        gesture: None,
    })
}

fn choose_clip(show: &Show, name: &str) -> Result<Edited, EditError> {
    if !show.clip_names().any(|known| known == name) {
        let known: Vec<&str> = show.clip_names().collect();
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

/// The show with its current clip replaced, if that still has a timing.
fn done<K: Belongs>(show: &Show, clip: ClipDoc<K>, said: Said) -> Result<Edited, EditError> {
    clip.check_timing()?;
    let gesture = said.gesture.map(|gesture| format!("{}: {gesture}", show.clip));
    Ok(Edited {
        show: K::into(clip, show),
        words: said.words,
        gesture,
    })
}
