//! What is on the screen: the display tree walked through, as strokes and faces in world space.
//!
//! Apart from `structure` because it is what hosts draw from and keep; nothing in it refers back. Text is
//! strokes like everything else, so that every host, and every pick, sees the same letters.

mod face;
mod shade;

pub use face::{Corner, Face, Fill, Light, Material};
pub use shade::{rgb, shade};

use glam::{DMat4, DVec3};

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
    /// Brightness at `from` and at `to`, 0 to 1. With a projection of its own, the depth cue is in it; without,
    /// it is as if all were nearest.
    pub intensity: [f64; 2],
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
}

impl Default for Viewport {
    fn default() -> Self {
        Self {
            horizontal: [-1.0, 1.0],
            vertical: [-1.0, 1.0],
        }
    }
}

/// What the viewing nodes above a stroke ask for. World space is what is below the last of them.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct View {
    /// Perspective or window times eye; nothing where no viewing node stood above, so that the host's own
    /// camera applies. Depth 0 is the front, 1 the back.
    pub screen_from_world: Option<DMat4>,
    /// Where on the screen.
    pub viewport: Viewport,
    /// Brightness of the farthest and the nearest, 0 to 1, where the program said so. For hosts that bring
    /// their own camera: of strokes without a projection the nearest is in their intensity already.
    pub cue: Option<[f64; 2]>,
}

impl View {
    /// The screen, -1 to 1 each way, from what the projection makes of the same.
    pub fn onto_screen(&self, projected: DVec3) -> DVec3 {
        let along = |[low, high]: [f64; 2], at: f64| low + (high - low) * (at + 1.0) / 2.0;
        DVec3::new(
            along(self.viewport.horizontal, projected.x),
            along(self.viewport.vertical, projected.y),
            projected.z,
        )
    }
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
    /// Lines, dots and letters.
    pub strokes: Vec<Stroke>,
    /// Rendered polygons; those that are not are strokes.
    pub faces: Vec<Face>,
    /// The borders of faces.
    pub corners: Vec<Corner>,
    /// The edges of faces, drawn where the face is seen.
    pub edges: Vec<Stroke>,
    /// How faces look.
    pub materials: Vec<Material>,
    /// What shines on faces.
    pub lights: Vec<Light>,
    /// The views strokes and faces refer to.
    pub views: Vec<View>,
    /// What was left out, and why.
    pub cuts: Vec<Cut>,
}

impl DisplayList {
    /// Empties it and keeps its memory.
    pub fn clear(&mut self) {
        self.strokes.clear();
        self.faces.clear();
        self.corners.clear();
        self.edges.clear();
        self.materials.clear();
        self.lights.clear();
        self.views.clear();
        self.cuts.clear();
    }

    /// Whether nothing is shown.
    pub fn is_empty(&self) -> bool {
        self.strokes.is_empty() && self.faces.is_empty()
    }
}
