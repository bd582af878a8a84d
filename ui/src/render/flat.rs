//! A scene after projection: pixels, final colours, and the order of painting.
//!
//! Projection, depth cue and order are decided once here, so that the processor's and the graphics card's
//! pictures differ in nothing but how an edge is smoothed. Everything is rounded to 1/64 pixel: the last
//! bit of somebody's sine cannot change a picture's hash.

use glam::DVec3;

use super::camera::Camera;
use super::depth::{self, Depths, Plate};
use super::scene::{Ink, Layer, Mark, Place, Scene, Stroke};
use super::theme::{self, Rgb};

/// A rectangle of a picture, and how many of its pixels make one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// Left edge, pixels.
    pub x: f32,
    /// Upper edge, pixels.
    pub y: f32,
    /// Width, pixels.
    pub width: f32,
    /// Height, pixels.
    pub height: f32,
    /// Pixels per point: widths and type sizes are multiplied by it.
    pub scale: f32,
}

impl Viewport {
    /// A whole picture at one pixel per point.
    pub fn of_size(width: u32, height: u32) -> Viewport {
        Viewport {
            x: 0.0,
            y: 0.0,
            width: width as f32,
            height: height as f32,
            scale: 1.0,
        }
    }

    /// The same with another number of pixels per point.
    #[must_use]
    pub fn scaled(self, scale: f32) -> Viewport {
        Viewport { scale, ..self }
    }

    pub(super) fn pixel(&self, camera: &Camera, world: DVec3) -> ([f32; 2], f64) {
        let seen = camera.project(world);
        let half = f64::from(self.height) / 2.0;
        let x = f64::from(self.x) + f64::from(self.width) / 2.0 + seen.x * half;
        let y = f64::from(self.y) + half - seen.y * half;
        ([grained(x), grained(y)], seen.z)
    }
}

fn grained(pixels: f64) -> f32 {
    // Far outside any picture is far enough: keeps the graphics libraries' fixed point from overflowing.
    let bounded = if pixels.is_finite() {
        pixels.clamp(-32_000.0, 32_000.0)
    } else {
        -32_000.0
    };
    ((bounded * 64.0).round() / 64.0) as f32
}

/// What is painted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A line with round ends.
    Line {
        /// One end, pixels from the upper left.
        from: [f32; 2],
        /// The other end.
        to: [f32; 2],
        /// Width, pixels.
        width: f32,
    },
    /// A mark.
    Dot {
        /// Its middle, pixels from the upper left.
        at: [f32; 2],
        /// To its edge or corner, pixels.
        radius: f32,
        /// Which.
        mark: Mark,
    },
}

/// One thing to paint, in its final colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// What.
    pub shape: Shape,
    /// In which colour, opaque.
    pub colour: Rgb,
}

/// A line of text to paint.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// Where the upper left (or right) corner of the line stands, pixels.
    pub at: [f32; 2],
    /// Whether `at` is on the right.
    pub from_right: bool,
    /// The letters.
    pub text: String,
    /// Type size, pixels.
    pub size: f32,
    /// Colour, opaque.
    pub colour: Rgb,
}

/// A scene ready to paint: first the pieces, in order, then the texts.
#[derive(Clone, Debug, Default)]
pub struct Flat {
    /// Lines and marks, first to last.
    pub pieces: Vec<Piece>,
    /// How many of them lie under the surfaces.
    pub under: usize,
    /// The surfaces.
    pub plate: Option<Plate>,
    /// Text, over everything.
    pub texts: Vec<Text>,
}

/// The largest step of the depth cue inside one line that is not seen as a step.
const CUE_STEP: f64 = 0.06;

impl Flat {
    /// Projects `scene` into `port` and puts it into painting order.
    pub fn new(scene: &Scene, port: &Viewport) -> Flat {
        let surfaces = if scene.surfaces.is_empty() {
            None
        } else {
            Some(depth::cast(&scene.surfaces, &scene.camera, port))
        };
        let mut ordered: Vec<(Ink, f64, Piece)> = Vec::with_capacity(scene.strokes.len() * 2);
        let depths = surfaces.as_ref().map(|(depths, _)| depths);
        for stroke in &scene.strokes {
            let hidden_by = depths.filter(|_| stroke.ink.layer == Layer::Figure);
            add_stroke(stroke, &scene.camera, port, hidden_by, &mut ordered);
        }
        for (surface, seen) in scene
            .surfaces
            .iter()
            .zip(surfaces.iter().flat_map(|(_, seen)| seen))
        {
            for edge in surface.edges.iter().filter(|_| *seen) {
                add_stroke(edge, &scene.camera, port, depths, &mut ordered);
            }
        }
        for dot in &scene.dots {
            let (at, depth) = port.pixel(&scene.camera, dot.at);
            let shape = Shape::Dot {
                at,
                radius: dot.radius * port.scale,
                mark: dot.mark,
            };
            // A hair nearer than the lines that end in it.
            ordered.push((
                dot.ink,
                depth + 1e-3,
                Piece {
                    shape,
                    colour: inked(dot.ink, depth),
                },
            ));
        }
        // Depth in steps of 1e-6 for the same reason as the pixels; the sort is stable.
        ordered.sort_by_key(|(ink, depth, _)| (ink.layer, (depth.clamp(-1e6, 1e6) * 1e6).round() as i64));
        Flat {
            under: ordered
                .iter()
                .take_while(|(ink, ..)| ink.layer < Layer::Figure)
                .count(),
            plate: depths.and_then(Depths::plate),
            pieces: ordered.into_iter().map(|(_, _, piece)| piece).collect(),
            texts: scene
                .labels
                .iter()
                .map(|label| text(label, scene, port))
                .collect(),
        }
    }
}

/// The way along a line between two looks at what hides it, pixels.
const LOOK_STEP: f64 = 1.0;
/// Looks along one line; a longer one is looked at more coarsely.
const LOOKS_MAX: f64 = 4096.0;

/// Adds a line in pieces no longer than the depth cue allows, and only where no surface hides it.
fn add_stroke(
    stroke: &Stroke,
    camera: &Camera,
    port: &Viewport,
    depths: Option<&Depths>,
    ordered: &mut Vec<(Ink, f64, Piece)>,
) {
    let (from, from_depth) = port.pixel(camera, stroke.from);
    let (to, to_depth) = port.pixel(camera, stroke.to);
    let cued = if stroke.ink.cued {
        (from_depth.clamp(-1.0, 1.0) - to_depth.clamp(-1.0, 1.0)).abs() / 2.0
    } else {
        0.0
    };
    let faded = f64::from((stroke.to_strength - stroke.ink.strength).abs());
    let Some(depths) = depths else {
        let steps = (cued.max(faded) / CUE_STEP).ceil().clamp(1.0, 32.0) as u32;
        let share = |step: u32| f64::from(step) / f64::from(steps);
        for step in 0..steps {
            add_piece(stroke, camera, port, [share(step), share(step + 1)], ordered);
        }
        return;
    };
    let length = f64::from(to[0] - from[0]).hypot(f64::from(to[1] - from[1]));
    let looks = (length / LOOK_STEP).ceil().clamp(1.0, LOOKS_MAX) as u32;
    let pieces = (cued.max(faded) / CUE_STEP).ceil().clamp(1.0, 32.0);
    let longest = (f64::from(looks) / pieces).ceil().max(1.0) as u32;
    let mut begin = None;
    for look in 0..=looks {
        // Looks are at the middles of steps; behind the last there is nothing.
        let share = (f64::from(look) + 0.5) / f64::from(looks);
        let along = |a: f32, b: f32| f64::from(a) + f64::from(b - a) * share;
        let at = [along(from[0], to[0]), along(from[1], to[1])];
        let seen = look < looks && depths.shows(at, from_depth + (to_depth - from_depth) * share);
        let full = begin.is_some_and(|begin| look - begin >= longest);
        if let (Some(first), true) = (begin, !seen || full) {
            let part = [f64::from(first), f64::from(look)].map(|at| at / f64::from(looks));
            add_piece(stroke, camera, port, part, ordered);
            begin = None;
        }
        if seen && begin.is_none() {
            begin = Some(look);
        }
    }
}

/// Adds the part of a line between two shares of it.
fn add_piece(
    stroke: &Stroke,
    camera: &Camera,
    port: &Viewport,
    part @ [begin, end]: [f64; 2],
    ordered: &mut Vec<(Ink, f64, Piece)>,
) {
    let [(from, near), (to, far)] = part.map(|share| port.pixel(camera, stroke.from.lerp(stroke.to, share)));
    let depth = f64::midpoint(near, far);
    let middle = f64::midpoint(begin, end) as f32;
    let strength = stroke.ink.strength + (stroke.to_strength - stroke.ink.strength) * middle;
    let shape = Shape::Line {
        from,
        to,
        width: stroke.width * port.scale,
    };
    let colour = inked(stroke.ink.faded(strength), depth);
    ordered.push((stroke.ink, depth, Piece { shape, colour }));
}

fn text(label: &super::scene::Label, scene: &Scene, port: &Viewport) -> Text {
    let s = port.scale;
    let (at, from_right, depth) = match label.place {
        Place::World(world, [right, down]) => {
            let ([x, y], depth) = port.pixel(&scene.camera, world);
            ([x + right * s, y + down * s], false, depth)
        }
        Place::UpperLeft([right, down]) => ([port.x + right * s, port.y + down * s], false, 1.0),
        Place::LowerLeft([right, up]) => (
            [port.x + right * s, port.y + port.height - (up + label.size) * s],
            false,
            1.0,
        ),
        Place::UpperRight([left, down]) => ([port.x + port.width - left * s, port.y + down * s], true, 1.0),
    };
    Text {
        at,
        from_right,
        text: label.text.clone(),
        size: label.size * s,
        colour: inked(label.ink, depth),
    }
}

/// The colour of `ink` at a depth of −1 (far) … 1 (near).
fn inked(ink: Ink, depth: f64) -> Rgb {
    let cue = if ink.cued {
        let near = f32::midpoint(depth.clamp(-1.0, 1.0) as f32, 1.0);
        // The root keeps the middle of the picture bright and lets only the far half sink.
        let [far_strength, near_strength] = ink.cue;
        far_strength + (near_strength - far_strength) * near.sqrt()
    } else {
        1.0
    };
    theme::GROUND.mix(ink.colour, ink.strength * cue)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn looking_ahead() -> Scene {
        Scene::new(Camera::turned(0.0, 0.0, DVec3::ZERO, 1.0))
    }

    #[test]
    fn the_near_lies_over_the_far_and_layers_over_both() {
        let mut scene = looking_ahead();
        let figure = Ink::new(theme::LINE, Layer::Figure);
        scene.stroke(DVec3::new(0.0, 0.0, 0.5), DVec3::new(1.0, 0.0, 0.5), 1.0, figure);
        scene.stroke(
            DVec3::new(0.0, 0.0, -0.5),
            DVec3::new(1.0, 0.0, -0.5),
            2.0,
            figure,
        );
        scene.stroke(DVec3::Z, DVec3::ONE, 3.0, Ink::new(theme::DIM, Layer::Ground));
        let widths: Vec<f32> = Flat::new(&scene, &Viewport::of_size(100, 100))
            .pieces
            .iter()
            .map(|piece| match piece.shape {
                Shape::Line { width, .. } => width,
                Shape::Dot { .. } => 0.0,
            })
            .collect();
        assert_eq!(widths, [3.0, 2.0, 1.0]);
    }

    #[test]
    fn distance_takes_brightness() {
        let mut scene = looking_ahead();
        let figure = Ink::new(theme::LINE, Layer::Figure);
        scene.stroke(DVec3::NEG_Z, DVec3::NEG_Z, 1.0, figure);
        scene.stroke(DVec3::Z, DVec3::Z, 1.0, figure);
        let flat = Flat::new(&scene, &Viewport::of_size(100, 100));
        assert!(flat.pieces[0].colour.1 < 100 && flat.pieces[1].colour == theme::LINE);
    }

    #[test]
    fn a_line_into_the_depth_is_cut_so_that_no_step_shows() {
        let mut scene = looking_ahead();
        scene.stroke(
            DVec3::NEG_Z,
            DVec3::new(1.0, 0.0, 1.0),
            1.0,
            Ink::new(theme::LINE, Layer::Figure),
        );
        scene.stroke(
            DVec3::NEG_Z,
            DVec3::Z,
            1.0,
            Ink::new(theme::LINE, Layer::Figure).flat(),
        );
        assert_eq!(
            Flat::new(&scene, &Viewport::of_size(100, 100)).pieces.len(),
            17 + 1
        );
    }

    #[test]
    fn nonsense_stays_outside_the_picture() {
        let mut scene = looking_ahead();
        scene.stroke(
            DVec3::NAN,
            DVec3::INFINITY,
            1.0,
            Ink::new(theme::LINE, Layer::Figure),
        );
        for piece in Flat::new(&scene, &Viewport::of_size(100, 100)).pieces {
            let Shape::Line { from, to, .. } = piece.shape else {
                continue;
            };
            assert!(from.iter().chain(&to).all(|c| c.is_finite()));
        }
    }
}
