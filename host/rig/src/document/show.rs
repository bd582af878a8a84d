//! The show as a value: everything that undo brings back and a folder keeps.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::clip::{ClipDoc, JointClipDoc};
use super::demands::Demands;
use super::figure::FigureDoc;
use crate::snapshot::ViewState;
use crate::take::{Keyed, Take};

/// One show. Never changed in place: an edit makes another one, sharing what stayed the same, so cloning
/// costs a few reference counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Show {
    /// What the show is called.
    pub name: String,
    /// Who moves; `None` for a show that is a network alone.
    pub figure: Option<Arc<FigureDoc>>,
    /// Clips of that figure by name. Empty without a figure.
    pub clips: BTreeMap<String, Arc<ClipDoc>>,
    /// Clips of the puppet's own joints by name; no name is in both.
    pub joint_clips: BTreeMap<String, Arc<JointClipDoc>>,
    /// Name of the clip being edited, a key of `clips` or `joint_clips`; empty when there is none.
    pub clip: String,
    /// Function networks, in the order they are executed.
    pub networks: Vec<Arc<NetworkFile>>,
    /// Network commands given while the show ran, executed after the files; one text, in order.
    pub patches: Arc<str>,
    /// Performances by name.
    pub takes: BTreeMap<String, Arc<Take>>,
    /// Name of the puppet profile the figure is played on.
    pub puppet: Option<String>,
    /// What the show demands of its puppet beside the profile.
    pub demands: Demands,
    /// From where the figure is looked at; `None` for the front view that holds all of it.
    pub view: Option<ViewState>,
}

/// A text in the network's command language.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NetworkFile {
    /// Its name: the file's without `.ps300`.
    pub name: String,
    /// The commands.
    pub text: String,
}

impl Show {
    /// The clip being edited, if it is one of the figure.
    pub fn current_clip(&self) -> Option<&Arc<ClipDoc>> {
        self.clips.get(&self.clip)
    }

    /// The clip being edited, if it is one of the puppet's joints.
    pub fn current_joint_clip(&self) -> Option<&Arc<JointClipDoc>> {
        self.joint_clips.get(&self.clip)
    }

    /// Key times of the clip being edited, of either kind, seconds.
    pub fn key_times_secs(&self) -> Vec<f64> {
        let of_joints = || self.current_joint_clip().map(|clip| clip.times_secs());
        let of_figure = self.current_clip().map(|clip| clip.times_secs());
        of_figure.or_else(of_joints).unwrap_or_default()
    }

    /// Names of all clips, in order.
    pub fn clip_names(&self) -> impl Iterator<Item = &str> {
        let mut names: Vec<&str> = self
            .clips
            .keys()
            .chain(self.joint_clips.keys())
            .map(String::as_str)
            .collect();
        names.sort_unstable();
        names.into_iter()
    }

    /// The show with one clip of joints put in place of that of the same name, or added.
    #[must_use]
    pub fn with_joint_clip(&self, name: &str, clip: JointClipDoc) -> Self {
        let mut joint_clips = self.joint_clips.clone();
        joint_clips.insert(name.to_owned(), Arc::new(clip));
        Self {
            joint_clips,
            ..self.clone()
        }
    }

    /// The show with network commands added to its patches.
    #[must_use]
    pub fn with_patch(&self, text: &str) -> Self {
        let mut patches = String::from(&*self.patches);
        if !patches.is_empty() && !patches.ends_with('\n') {
            patches.push('\n');
        }
        patches.push_str(text);
        Self {
            patches: patches.into(),
            ..self.clone()
        }
    }

    /// Puts a take's clip in place of that of the same name of either kind, and chooses it.
    pub(crate) fn put_clip(&mut self, name: &str, keyed: Keyed) {
        self.clips.remove(name);
        self.joint_clips.remove(name);
        match keyed {
            Keyed::Figure(clip) => drop(self.clips.insert(name.to_owned(), Arc::new(clip))),
            Keyed::Joints(clip) => drop(self.joint_clips.insert(name.to_owned(), Arc::new(clip))),
        }
        name.clone_into(&mut self.clip);
    }

    /// The show with that clip chosen, if there is one of that name.
    #[must_use]
    pub(crate) fn with_clip_chosen(&self, name: &str) -> Self {
        let there = self.clips.contains_key(name) || self.joint_clips.contains_key(name);
        let clip = if there { name } else { "" };
        Self {
            clip: clip.to_owned(),
            ..self.clone()
        }
    }

    /// The show without a take.
    #[must_use]
    pub(crate) fn without_take(&self, name: &str) -> Self {
        let mut show = self.clone();
        show.takes.remove(name);
        show
    }

    /// The show with one clip put in place of that of the same name, or added.
    #[must_use]
    pub fn with_clip(&self, name: &str, clip: ClipDoc) -> Self {
        let mut clips = self.clips.clone();
        clips.insert(name.to_owned(), Arc::new(clip));
        Self {
            clips,
            ..self.clone()
        }
    }
}

/// Whether a name can also be a file's, on every system: letters, digits, spaces, `-`, `_` and inner dots.
pub fn is_file_name(name: &str) -> bool {
    let plain = |letter: char| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_' | '.');
    !name.is_empty()
        && name.len() <= 100
        && name.chars().all(plain)
        && !name.starts_with(['.', ' '])
        && !name.ends_with(['.', ' '])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_parts_can_be_names_of_files() {
        for good in ["salute", "01_01", "walk 2", "v1.2", "躍"] {
            assert!(is_file_name(good), "{good}");
        }
        for bad in ["", ".", "..", "a/b", "a\\b", " a", "a ", ".hidden", "a\nb", "a:b"] {
            assert!(!is_file_name(bad), "{bad}");
        }
    }

    #[test]
    fn patches_are_kept_in_order_one_a_line() {
        let show = Show::default()
            .with_patch("SEND 1 TO <1>A;")
            .with_patch("SEND 2 TO <1>A;");
        assert_eq!(&*show.patches, "SEND 1 TO <1>A;\nSEND 2 TO <1>A;");
    }
}
