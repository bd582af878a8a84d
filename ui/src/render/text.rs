//! Letters for pictures without a window: the fonts of the window, drawn on the processor.

use ab_glyph::{Font, FontRef, Glyph, PxScale, ScaleFont, point};

use super::theme::Rgb;

/// Hack: digits of one width, made for small sizes on screens.
/// Source: crate `epaint_default_fonts`, the window's own monospaced font.
pub struct Type {
    font: FontRef<'static>,
}

impl Default for Type {
    fn default() -> Self {
        Type::new()
    }
}

impl Type {
    /// The window's monospaced font.
    pub fn new() -> Type {
        let font = FontRef::try_from_slice(epaint_default_fonts::HACK_REGULAR)
            .expect("the font is compiled in and does not change");
        Type { font }
    }

    /// Width of one line, pixels.
    pub fn width(&self, text: &str, size: f32) -> f32 {
        let font = self.font.as_scaled(PxScale::from(size));
        text.chars().map(|c| font.h_advance(font.glyph_id(c))).sum()
    }

    /// Draws one line with its upper left corner at `at`, calling `paint(x, y, coverage 0…1)` for each pixel
    /// touched, which may lie outside the picture.
    pub fn draw(&self, text: &str, size: f32, at: [f32; 2], paint: &mut dyn FnMut(i32, i32, f32)) {
        let font = self.font.as_scaled(PxScale::from(size));
        let baseline = (at[1] + font.ascent()).round();
        // Whole pixels: the same letter looks the same wherever it stands.
        let mut x = at[0].round();
        for letter in text.chars() {
            let id = font.glyph_id(letter);
            let glyph = Glyph {
                id,
                scale: PxScale::from(size),
                position: point(x.round(), baseline),
            };
            if let Some(outline) = self.font.outline_glyph(glyph) {
                let corner = outline.px_bounds().min;
                outline.draw(|column, row, coverage| {
                    paint(
                        corner.x as i32 + column as i32,
                        corner.y as i32 + row as i32,
                        coverage,
                    );
                });
            }
            x += font.h_advance(id);
        }
    }
}

/// Lays `colour` over one pixel.
pub(super) fn cover(pixel: &mut [u8], colour: Rgb, coverage: f32) {
    let ground = Rgb(pixel[0], pixel[1], pixel[2]);
    let Rgb(r, g, b) = ground.mix(colour, coverage);
    pixel[..3].copy_from_slice(&[r, g, b]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_have_one_width_and_leave_ink() {
        let font = Type::new();
        assert!((font.width("111", 12.0) - font.width("MMM", 12.0)).abs() < 1e-3);
        let mut ink = 0.0;
        font.draw("0.48 s", 12.0, [0.0, 0.0], &mut |_, _, coverage| ink += coverage);
        assert!(ink > 20.0, "{ink}");
    }
}
