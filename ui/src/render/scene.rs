//! What a picture shows, before anybody decides how it is drawn: strokes, dots and labels in the world or on
//! the screen, and a camera. Both renderers (processor and graphics card) and all films start here.

use glam::DVec3;

use super::camera::Camera;
use super::theme::Rgb;

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
    /// Colour.
    pub ink: Ink,
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
            dots: self.dots.clone(),
            labels: Vec::new(),
        }
    }

    /// Adds a line.
    pub fn stroke(&mut self, from: DVec3, to: DVec3, width: f32, ink: Ink) {
        self.strokes.push(Stroke { from, to, width, ink });
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
