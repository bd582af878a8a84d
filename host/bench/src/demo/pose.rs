//! What the hands are to enter: the keys of the shipped clip, taken out of the show before it begins.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use rig::ViewState;
use rig::document::{ClipDoc, NetworkFile, Show};

use super::{DemoError, DemoOptions};

/// More keys of the dial box than carry labels.
const MORE_KEYS: &str = include_str!("more-keys.ps300");
/// The view is this much nearer than the one that holds the figure at rest: the tablet's shorter side reaches
/// 0.73 of its longer one, a whole figure then 0.66, and every count is a little finer.
const NEARER: f64 = 1.2;

/// One key to enter.
#[derive(Clone, Debug)]
pub(super) struct Target {
    pub(super) secs: f64,
    pub(super) root: DVec3,
    pub(super) links: Vec<LinkTarget>,
}

/// One link of a key.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinkTarget {
    /// Unit vector, world axes.
    pub(super) direction: DVec3,
    pub(super) twist_rad: f64,
}

/// The keys of the show's clip.
pub(super) fn targets(options: &DemoOptions) -> Result<Vec<Target>, DemoError> {
    if options.show.figure.is_none() {
        return Err(DemoError::Show { missing: "a figure" });
    }
    let clip = options
        .show
        .current_clip()
        .ok_or(DemoError::Show { missing: "a clip" })?;
    let targets: Vec<Target> = clip
        .keys
        .iter()
        .take(options.keys_max.unwrap_or(usize::MAX))
        .map(|key| Target {
            secs: key.secs,
            root: key.pose.root,
            links: key
                .pose
                .links
                .iter()
                .map(|link| LinkTarget {
                    direction: link.direction,
                    twist_rad: link.twist_rad,
                })
                .collect(),
        })
        .collect();
    if targets.len() < 2 {
        return Err(DemoError::Show {
            missing: "a clip of at least two keys",
        });
    }
    Ok(targets)
}

/// The show as the hands find it: the clip is empty, and the view holds every pose that is to come.
pub(super) fn stripped(show: &Show, targets: &[Target]) -> Show {
    let mut bare = show.clone();
    if let Some(clip) = show.current_clip() {
        let empty = ClipDoc {
            keys: Vec::new(),
            coefficient_edits: Vec::new(),
            ..ClipDoc::clone(clip)
        };
        bare.clips = BTreeMap::from([(show.clip.clone(), Arc::new(empty))]);
    }
    bare.networks.push(Arc::new(NetworkFile {
        name: "more-keys".to_owned(),
        text: MORE_KEYS.to_owned(),
    }));
    bare.view = view(show, targets.len());
    bare
}

fn view(show: &Show, keys: usize) -> Option<ViewState> {
    let figure = &show.figure.as_ref()?.figure;
    let mut all = Vec::new();
    for key in show.current_clip()?.keys.iter().take(keys) {
        let mut placed = Vec::new();
        figure.place(&key.pose, &mut placed);
        all.append(&mut placed);
    }
    let whole = ViewState::holding(&all);
    Some(ViewState {
        scale: whole.scale * NEARER,
        ..whole
    })
}
