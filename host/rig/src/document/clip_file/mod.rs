//! Clip files: key poses as TOML a person can read and change.
//!
//! A key names every link with its direction; twist and length stand only where they say something. Clips
//! of very many keys use the form of [`rows`] instead. Version 0 counted frames instead of seconds and gave
//! z-y-z angles instead of directions; it is read, never written. Clips of a puppet's own joints have a form of
//! their own, see [`joints`].

mod bind;
mod joints;
mod read;
mod rows;
mod version_0;
mod write;

pub(super) use joints::{is_of_joints, read_joints, write_joints};
pub(super) use read::read;
pub(super) use write::write;

use glam::DVec3;
use motion::{DirectionLaw, KineticsMode, TwistLaw};

use super::clip::ClipDoc;

/// The version written.
const VERSION: u64 = 1;

const DIRECTION_LAWS: [(&str, DirectionLaw); 2] = [
    ("constant", DirectionLaw::Constant),
    ("chord", DirectionLaw::Chord),
];
const TWIST_LAWS: [(&str, TwistLaw); 2] = [("transport", TwistLaw::Transport), ("zyz", TwistLaw::Zyz)];
const KINETICS: [(&str, KineticsMode); 3] = [
    ("natural", KineticsMode::Natural),
    ("monotone", KineticsMode::Monotone),
    ("linear", KineticsMode::Linear),
];

/// A clip file before its link names have been looked up in a figure.
#[derive(Debug, Default)]
struct ClipText<'t> {
    laws: ClipDoc,
    /// Where `adjust` stands; the beginning of the file if it is not there.
    adjust_at: usize,
    keys: Vec<KeyText<'t>>,
}

/// A key of such a file.
#[derive(Debug)]
struct KeyText<'t> {
    at: usize,
    secs: f64,
    root: DVec3,
    links: Vec<LinkText<'t>>,
}

/// One link of a key; `length` only where it differs from the figure's.
#[derive(Clone, Copy, Debug)]
struct LinkText<'t> {
    name: &'t str,
    at: usize,
    direction: DVec3,
    twist_rad: f64,
    length: Option<f64>,
}
