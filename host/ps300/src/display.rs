//! What is on the screen: the display tree walked through, as strokes and texts in world space.
//!
//! Apart from `structure` because it is what hosts draw from and keep; nothing in it refers back.

use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3};

use crate::language::Name;

/// A line between two points, or a dot where they are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// In world space.
    pub from: DVec3,
    /// In world space.
    pub to: DVec3,
    /// 0 blue, 120 red, 240 green.
    pub hue_deg: f64,
    /// 0 white to 1 full.
    pub saturation: f64,
    /// Brightness, 0 to 1; in a depth-cued part that of its nearest point.
    pub intensity: f64,
    /// Index into [`DisplayList::views`].
    pub view: u16,
}

/// A line of text in world space.
#[derive(Clone, Debug, PartialEq)]
pub struct Lettering {
    /// Lower left corner of the first character, in world space.
    pub at: DVec3,
    /// A character's width, in world space.
    pub right: DVec3,
    /// A character's height, in world space.
    pub up: DVec3,
    /// From one character to the next, in widths and heights.
    pub step: DVec2,
    /// What is written.
    pub text: Arc<str>,
    /// 0 blue, 120 red, 240 green.
    pub hue_deg: f64,
    /// 0 white to 1 full.
    pub saturation: f64,
    /// Brightness, 0 to 1.
    pub intensity: f64,
    /// Index into [`DisplayList::views`].
    pub view: u16,
}

/// Part of the screen, -1 to 1 each way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// Left and right.
    pub horizontal: [f64; 2],
    /// Bottom and top.
    pub vertical: [f64; 2],
    /// Brightness of the farthest and the nearest, 0 to 1.
    pub intensity: [f64; 2],
}

impl Default for Viewport {
    fn default() -> Self {
        Self {
            horizontal: [-1.0, 1.0],
            vertical: [-1.0, 1.0],
            intensity: [0.0, 1.0],
        }
    }
}

/// What the viewing nodes above a stroke ask for. World space is what is below the last of them.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct View {
    /// Perspective or window times eye; nothing where no viewing node stood above, so that the host's own
    /// camera applies.
    pub screen_from_world: Option<DMat4>,
    /// Where on the screen.
    pub viewport: Viewport,
}

/// A part of the tree that is missing from the list.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Cut {
    /// Deeper than any meant structure.
    #[error("{name} lies deeper than {max} levels and is not shown")]
    Depth {
        /// The node that was left out.
        name: Name,
        /// The bound.
        max: usize,
    },
    /// A structure that contains itself.
    #[error("{name} contains itself and is shown once only")]
    Cycle {
        /// The node that was left out.
        name: Name,
    },
    /// Shared instances multiplied beyond what can be drawn.
    #[error("the picture has more than {max} parts; from {name} on it is not shown")]
    Size {
        /// The first node that was left out.
        name: Name,
        /// The bound.
        max: usize,
    },
}

/// What is on the screen, in the order of DISPLAY and of the tree.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DisplayList {
    /// Lines and dots.
    pub strokes: Vec<Stroke>,
    /// Texts.
    pub letterings: Vec<Lettering>,
    /// The views strokes and texts refer to.
    pub views: Vec<View>,
    /// What was left out, and why.
    pub cuts: Vec<Cut>,
}

impl DisplayList {
    /// Empties it and keeps its memory.
    pub fn clear(&mut self) {
        self.strokes.clear();
        self.letterings.clear();
        self.views.clear();
        self.cuts.clear();
    }
}
