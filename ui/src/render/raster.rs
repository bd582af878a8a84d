//! The renderer without a graphics card: a scene becomes the same bytes on every machine.
//!
//! Films, contact sheets and picture hashes come from here and nowhere else.

use tiny_skia::{Color, FillRule, LineCap, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, Transform};

use super::depth::Plate;
use super::flat::{Flat, Piece, Shape, Viewport};
use super::picture::Picture;
use super::scene::{Mark, Scene};
use super::text::{Type, cover};
use super::theme::{self, Rgb};

/// The largest side of a picture, pixels: a film's, with room; keeps a slip of the keyboard from asking for
/// more memory than there is.
pub const SIDE_MAX: u32 = 8192;

/// A picture being painted.
pub struct Canvas {
    pixels: Pixmap,
    letters: Type,
}

impl Canvas {
    /// An empty near-black picture; sides are brought into 1…[`SIDE_MAX`].
    pub fn new(width: u32, height: u32) -> Canvas {
        let side = |pixels: u32| pixels.clamp(1, SIDE_MAX);
        let mut pixels = Pixmap::new(side(width), side(height)).expect("both sides are above 0 and bounded");
        pixels.fill(opaque(theme::GROUND));
        Canvas {
            pixels,
            letters: Type::new(),
        }
    }

    /// Paints a projected scene over what is there.
    pub fn paint(&mut self, flat: &Flat) {
        let (under, over) = flat.pieces.split_at(flat.under.min(flat.pieces.len()));
        for piece in under {
            self.piece(piece);
        }
        if let Some(plate) = &flat.plate {
            self.plate(plate);
        }
        for piece in over {
            self.piece(piece);
        }
        for text in &flat.texts {
            let width = if text.from_right {
                self.letters.width(&text.text, text.size)
            } else {
                0.0
            };
            self.text(
                &text.text,
                text.size,
                [text.at[0] - width, text.at[1]],
                text.colour,
            );
        }
    }

    /// Lays filled surfaces over what is there.
    fn plate(&mut self, plate: &Plate) {
        let (width, height) = (self.pixels.width(), self.pixels.height());
        let pixels = self.pixels.data_mut();
        for (index, rgba) in plate.rgba.chunks_exact(4).enumerate() {
            let x = plate.x + index as u32 % plate.width;
            let y = plate.y + index as u32 / plate.width;
            if x < width && y < height && rgba[3] > 0 {
                let at = ((y * width + x) * 4) as usize;
                let colour = Rgb(rgba[0], rgba[1], rgba[2]);
                cover(&mut pixels[at..at + 4], colour, f32::from(rgba[3]) / 255.0);
            }
        }
    }

    fn piece(&mut self, piece: &Piece) {
        match piece.shape {
            Shape::Line { from, to, width } if from == to => {
                self.fill(
                    PathBuilder::from_circle(from[0], from[1], width / 2.0),
                    piece.colour,
                );
            }
            Shape::Line { from, to, width } => self.line(from, to, width, piece.colour),
            Shape::Dot {
                at: [x, y],
                radius,
                mark,
            } => match mark {
                Mark::Disc => self.fill(PathBuilder::from_circle(x, y, radius), piece.colour),
                Mark::Ring => {
                    // Filled with the ground, so that lines end at the ring and not inside it.
                    self.fill(PathBuilder::from_circle(x, y, radius), theme::GROUND);
                    let width = ring_width(radius);
                    let circle = PathBuilder::from_circle(x, y, radius - width / 2.0);
                    self.stroke(circle, width, piece.colour);
                }
                Mark::Diamond => self.diamond([x, y], radius, piece.colour),
            },
        }
    }

    /// A line with round ends; pixels.
    pub fn line(&mut self, from: [f32; 2], to: [f32; 2], width: f32, colour: Rgb) {
        let mut path = PathBuilder::new();
        path.move_to(from[0], from[1]);
        path.line_to(to[0], to[1]);
        self.stroke(path.finish(), width, colour);
    }

    /// A line through points; pixels.
    pub fn polyline(&mut self, points: &[[f32; 2]], width: f32, colour: Rgb) {
        let mut path = PathBuilder::new();
        for (index, &[x, y]) in points.iter().enumerate() {
            if index == 0 {
                path.move_to(x, y);
            } else {
                path.line_to(x, y);
            }
        }
        self.stroke(path.finish(), width, colour);
    }

    /// A filled rectangle; pixels.
    pub fn rectangle(&mut self, corner: [f32; 2], size: [f32; 2], colour: Rgb) {
        let rectangle = Rect::from_xywh(corner[0], corner[1], size[0], size[1]);
        self.fill(rectangle.map(PathBuilder::from_rect), colour);
    }

    /// A filled square standing on its corner; pixels.
    pub fn diamond(&mut self, [x, y]: [f32; 2], radius: f32, colour: Rgb) {
        let mut path = PathBuilder::new();
        path.move_to(x, y - radius);
        path.line_to(x + radius, y);
        path.line_to(x, y + radius);
        path.line_to(x - radius, y);
        path.close();
        self.fill(path.finish(), colour);
    }

    /// One line of text with its upper left corner at `at`; pixels.
    pub fn text(&mut self, text: &str, size: f32, at: [f32; 2], colour: Rgb) {
        let (width, height) = (self.pixels.width() as i32, self.pixels.height() as i32);
        let bytes = self.pixels.data_mut();
        self.letters.draw(text, size, at, &mut |x, y, coverage| {
            if (0..width).contains(&x) && (0..height).contains(&y) {
                let start = ((y * width + x) * 4) as usize;
                cover(&mut bytes[start..start + 4], colour, coverage);
            }
        });
    }

    /// Width of a line of text, pixels.
    pub fn text_width(&self, text: &str, size: f32) -> f32 {
        self.letters.width(text, size)
    }

    fn fill(&mut self, path: Option<Path>, colour: Rgb) {
        if let Some(path) = path {
            let (paint, winding) = (paint_of(colour), FillRule::Winding);
            self.pixels
                .fill_path(&path, &paint, winding, Transform::identity(), None);
        }
    }

    fn stroke(&mut self, path: Option<Path>, width: f32, colour: Rgb) {
        if let Some(path) = path {
            let stroke = Stroke {
                width,
                line_cap: LineCap::Round,
                ..Stroke::default()
            };
            self.pixels
                .stroke_path(&path, &paint_of(colour), &stroke, Transform::identity(), None);
        }
    }

    /// The finished picture.
    pub fn finish(self) -> Picture {
        let (width, height) = (self.pixels.width(), self.pixels.height());
        // Opaque throughout, so premultiplied and straight colours are the same bytes.
        Picture {
            width,
            height,
            rgba: self.pixels.take(),
        }
    }
}

/// Paints `scene` into a new picture; `scale` pixels make one point.
pub fn draw(scene: &Scene, width: u32, height: u32, scale: f32) -> Picture {
    let mut canvas = Canvas::new(width, height);
    canvas.paint(&Flat::new(scene, &Viewport::of_size(width, height).scaled(scale)));
    canvas.finish()
}

/// The width of the line of a ring; shared with the graphics card's shader.
pub(super) fn ring_width(radius: f32) -> f32 {
    (radius * 0.4).max(1.0)
}

fn opaque(Rgb(r, g, b): Rgb) -> Color {
    Color::from_rgba8(r, g, b, 255)
}

fn paint_of(Rgb(r, g, b): Rgb) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, 255);
    paint.anti_alias = true;
    paint
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::camera::Camera;
    use crate::render::scene::{Ink, Layer};
    use glam::DVec3;

    #[test]
    fn a_line_is_where_the_camera_says() {
        let mut scene = Scene::new(Camera::turned(0.0, 0.0, DVec3::ZERO, 1.0));
        let ink = Ink::new(theme::LINE, Layer::Figure).flat();
        scene.stroke(DVec3::new(-1.0, 0.5, 0.0), DVec3::new(1.0, 0.5, 0.0), 4.0, ink);
        let picture = draw(&scene, 200, 100, 1.0);
        assert_eq!(
            picture.pixel(100, 25),
            Some([theme::LINE.0, theme::LINE.1, theme::LINE.2])
        );
        assert_eq!(
            picture.pixel(100, 75),
            Some([theme::GROUND.0, theme::GROUND.1, theme::GROUND.2])
        );
        assert_eq!(
            picture.pixel(20, 25),
            picture.pixel(20, 75),
            "left of the line's end is ground"
        );
    }

    #[test]
    fn no_size_is_too_small_or_too_large() {
        assert_eq!(Canvas::new(0, 3).finish().width, 1);
        assert_eq!(Canvas::new(100_000, 1).finish().width, SIDE_MAX);
    }
}
