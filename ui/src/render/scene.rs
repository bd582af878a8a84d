//! What a picture shows, before anybody decides how it is drawn: strokes, dots and labels in the world or on
//! the screen, and a camera. Both renderers (processor and graphics card) and all films start here.

use glam::DVec3;
use ps300::display::{Corner, Fill, Light, Material};

use super::camera::Camera;
use super::theme::{self, Rgb};

/// Which things lie over which, regardless of depth; inside a layer the nearer lies over the farther.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layer {
    /// Floor and grid.
    Ground,
    /// Poses before and after the present one.
    Ghost,
    /// Trajectories and their equal-time ticks.
    Trail,
    /// The figure and the network's display structures.
    Figure,
    /// Cursor, candidates, names.
    Overlay,
}

/// How lines, dots and labels are coloured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ink {
    /// Colour at full strength and nearest to the viewer.
    pub colour: Rgb,
    /// 0 is the ground, 1 the full colour. Lines are mixed with the ground and then drawn opaque, so that
    /// joints of faint polylines do not shine through.
    pub strength: f32,
    /// Whether distance takes brightness away.
    pub cued: bool,
    /// How much of the strength is left at the far end and at the near end, where it does.
    pub cue: [f32; 2],
    /// What it lies over.
    pub layer: Layer,
}

impl Ink {
    /// Full strength, depth-cued.
    pub fn new(colour: Rgb, layer: Layer) -> Ink {
        Ink {
            colour,
            strength: 1.0,
            cued: true,
            cue: [theme::CUE_FAR, 1.0],
            layer,
        }
    }

    /// The same at another strength.
    #[must_use]
    pub fn faded(self, strength: f32) -> Ink {
        Ink { strength, ..self }
    }

    /// The same at any distance.
    #[must_use]
    pub fn flat(self) -> Ink {
        Ink { cued: false, ..self }
    }
}

/// A straight line in the world, with round ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// One end, metres, world axes.
    pub from: DVec3,
    /// The other end.
    pub to: DVec3,
    /// Width, points.
    pub width: f32,
    /// Colour, and strength at `from`.
    pub ink: Ink,
    /// Strength at `to`.
    pub to_strength: f32,
}

/// A surface with a border, seen from either side; lines and other surfaces behind it are hidden.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// The borders, each corner in the world; what lies inside an odd number of them is filled.
    pub corners: Vec<Corner>,
    /// What is drawn inside.
    pub fill: Fill,
    /// Whether nothing of it is drawn where it is seen from behind.
    pub one_sided: bool,
    /// On either side; where it points away from the viewer, it and the corners' are turned round.
    pub normal: DVec3,
    /// Towards the viewer in the space of normals and lights; nothing where that is the world.
    pub viewer: Option<DVec3>,
    /// Of the side whose first border goes clockwise on the screen, and of the other.
    pub materials: [Material; 2],
    /// What shines on it.
    pub lights: Vec<Light>,
    /// Brightness at the far end and at the near end.
    pub cue: [f32; 2],
    /// Lines along it, drawn where it is.
    pub edges: Vec<Stroke>,
}

/// The shape of a [`Dot`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A filled circle.
    Disc,
    /// A circle's outline.
    Ring,
    /// A square standing on its corner: a key.
    Diamond,
}

/// A mark at a world point that always has the same size on screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dot {
    /// Where, metres, world axes.
    pub at: DVec3,
    /// From the middle to the edge (or corner), points.
    pub radius: f32,
    /// Which shape.
    pub mark: Mark,
    /// Colour.
    pub ink: Ink,
}

/// Where a label stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// At a world point, moved by points to the right and down.
    World(DVec3, [f32; 2]),
    /// In the upper left corner, points to the right and down.
    UpperLeft([f32; 2]),
    /// In the lower left corner, points to the right and up.
    LowerLeft([f32; 2]),
    /// In the upper right corner, points to the left and down.
    UpperRight([f32; 2]),
}

/// Text on the screen.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Where its first (or, on the right, last) letter is.
    pub place: Place,
    /// One line.
    pub text: String,
    /// Type size, points.
    pub size: f32,
    /// Colour.
    pub ink: Ink,
}

/// One picture's contents.
#[derive(Clone, Debug)]
pub struct Scene {
    /// From where it is seen.
    pub camera: Camera,
    /// Lines.
    pub strokes: Vec<Stroke>,
    /// Filled surfaces; they hide what is behind them in [`Layer::Figure`].
    pub surfaces: Vec<Surface>,
    /// Marks.
    pub dots: Vec<Dot>,
    /// Text.
    pub labels: Vec<Label>,
}

impl Scene {
    /// An empty picture.
    pub fn new(camera: Camera) -> Scene {
        Scene {
            camera,
            strokes: Vec::new(),
            surfaces: Vec::new(),
            dots: Vec::new(),
            labels: Vec::new(),
        }
    }

    /// The same things from the side; see [`Camera::side`]. Labels are left out: the front view has them.
    #[must_use]
    pub fn side(&self) -> Scene {
        Scene {
            camera: self.camera.side(),
            strokes: self.strokes.clone(),
            surfaces: self.surfaces.clone(),
            dots: self.dots.clone(),
            labels: Vec::new(),
        }
    }

    /// Adds a line.
    pub fn stroke(&mut self, from: DVec3, to: DVec3, width: f32, ink: Ink) {
        self.strokes.push(Stroke {
            from,
            to,
            width,
            ink,
            to_strength: ink.strength,
        });
    }

    /// Adds a line from point to point.
    pub fn polyline(&mut self, points: &[DVec3], width: f32, ink: Ink) {
        for pair in points.windows(2) {
            self.stroke(pair[0], pair[1], width, ink);
        }
    }

    /// Adds a mark.
    pub fn dot(&mut self, at: DVec3, radius: f32, mark: Mark, ink: Ink) {
        self.dots.push(Dot {
            at,
            radius,
            mark,
            ink,
        });
    }

    /// Adds text.
    pub fn label(&mut self, place: Place, text: impl Into<String>, size: f32, ink: Ink) {
        self.labels.push(Label {
            place,
            text: text.into(),
            size,
            ink,
        });
    }
}
