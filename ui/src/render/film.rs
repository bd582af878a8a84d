//! Pictures become files: PNG for one, an endlessly looping GIF for many.
//!
//! A GIF stores, per frame, only the rectangle that changed, and in it "unchanged" wherever nothing did: a
//! line figure on black costs a few kilobytes a frame. Source: GIF89a specification, CompuServe 1990.

use std::io::Write;

use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};

use super::palette::{Palette, UNCHANGED};
use super::picture::Picture;

/// What can go wrong while writing a film.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// The picture does not have the film's size.
    #[error("frame {frame} is {got:?} pixels where the film is {want:?}; give every frame the film's size")]
    Size {
        /// The frame's number, from 0.
        frame: u64,
        /// The film's size.
        want: [u32; 2],
        /// The frame's size.
        got: [u32; 2],
    },
    /// A GIF cannot be that large.
    #[error("a GIF of {0:?} pixels cannot be written; no side may be 0 or above 65535")]
    TooLarge([u32; 2]),
    /// The GIF could not be written.
    #[error("the GIF could not be written: {0}")]
    Gif(#[from] gif::EncodingError),
    /// The PNG could not be written.
    #[error("the PNG could not be written: {0}")]
    Png(#[from] image::ImageError),
}

/// Writes one picture as a PNG.
pub fn write_png(picture: &Picture, out: impl Write) -> Result<(), FilmError> {
    let encoder = PngEncoder::new(out);
    Ok(encoder.write_image(
        &picture.rgba,
        picture.width,
        picture.height,
        ExtendedColorType::Rgba8,
    )?)
}

/// A GIF being written, frame by frame.
pub struct GifFilm<W: Write> {
    encoder: gif::Encoder<W>,
    palette: Palette,
    size: [u32; 2],
    fps: f64,
    frames: u64,
    shown: Vec<u8>,
}

impl<W: Write> GifFilm<W> {
    /// Begins a film of `width` by `height` pixels at `fps` frames a second (brought into 1…50, which is
    /// what viewers honour), repeated for ever.
    pub fn new(out: W, width: u32, height: u32, fps: f64) -> Result<GifFilm<W>, FilmError> {
        let palette = Palette::new();
        let side = |pixels: u32| u16::try_from(pixels).ok().filter(|&p| p > 0);
        let (Some(w), Some(h)) = (side(width), side(height)) else {
            return Err(FilmError::TooLarge([width, height]));
        };
        let mut encoder = gif::Encoder::new(out, w, h, &palette.bytes())?;
        encoder.set_repeat(gif::Repeat::Infinite)?;
        let fps = if fps.is_finite() {
            fps.clamp(1.0, 50.0)
        } else {
            25.0
        };
        Ok(GifFilm {
            encoder,
            palette,
            size: [width, height],
            fps,
            frames: 0,
            shown: Vec::new(),
        })
    }

    /// Adds a frame.
    pub fn frame(&mut self, picture: &Picture) -> Result<(), FilmError> {
        let got = [picture.width, picture.height];
        if got != self.size {
            return Err(FilmError::Size {
                frame: self.frames,
                want: self.size,
                got,
            });
        }
        let now: Vec<u8> = picture
            .rgba
            .chunks_exact(4)
            .map(|p| self.palette.index(p[0], p[1], p[2]))
            .collect();
        let frame = self.changes(&now);
        self.encoder.write_frame(&frame)?;
        self.shown = now;
        self.frames += 1;
        Ok(())
    }

    fn changes(&self, now: &[u8]) -> gif::Frame<'static> {
        let width = self.size[0] as usize;
        let changed = |i: usize| self.shown.get(i) != Some(&now[i]);
        let mut area = Area::default();
        for index in (0..now.len()).filter(|&i| changed(i)) {
            area.include(index % width, index / width);
        }
        let mut buffer = Vec::with_capacity(area.width() * area.height());
        for y in area.top..area.bottom {
            for x in area.left..area.right {
                let index = y * width + x;
                buffer.push(if changed(index) { now[index] } else { UNCHANGED });
            }
        }
        if buffer.is_empty() {
            buffer.push(UNCHANGED);
        }
        gif::Frame {
            left: area.left as u16,
            top: area.top as u16,
            width: area.width() as u16,
            height: area.height() as u16,
            buffer: buffer.into(),
            delay: self.delay(),
            dispose: gif::DisposalMethod::Keep,
            transparent: Some(UNCHANGED),
            ..gif::Frame::default()
        }
    }

    /// Hundredths of a second this frame stays, such that rounding never adds up.
    fn delay(&self) -> u16 {
        let at = |frame: u64| (100.0 * frame as f64 / self.fps).round();
        (at(self.frames + 1) - at(self.frames)) as u16
    }

    /// Ends the film and gives back what it was written into.
    pub fn finish(self) -> Result<W, FilmError> {
        Ok(self.encoder.into_inner()?)
    }
}

/// The smallest rectangle around what changed; one pixel where nothing did.
#[derive(Default)]
struct Area {
    left: usize,
    top: usize,
    right: usize,
    bottom: usize,
}

impl Area {
    fn include(&mut self, x: usize, y: usize) {
        if self.right == 0 {
            *self = Area {
                left: x,
                top: y,
                right: x + 1,
                bottom: y + 1,
            };
        }
        self.left = self.left.min(x);
        self.top = self.top.min(y);
        self.right = self.right.max(x + 1);
        self.bottom = self.bottom.max(y + 1);
    }

    fn width(&self) -> usize {
        (self.right - self.left).max(1)
    }

    fn height(&self) -> usize {
        (self.bottom - self.top).max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::raster::Canvas;
    use crate::render::theme;

    fn frame_with_square(at: f32) -> Picture {
        let mut canvas = Canvas::new(64, 48);
        canvas.rectangle([at, 10.0], [8.0, 8.0], theme::LINE);
        canvas.finish()
    }

    #[test]
    fn a_still_costs_almost_nothing_and_time_does_not_drift() {
        let mut film = GifFilm::new(Vec::new(), 64, 48, 30.0).unwrap();
        let delays: Vec<u16> = (0..30)
            .map(|_| {
                let delay = film.delay();
                film.frame(&frame_with_square(4.0)).unwrap();
                delay
            })
            .collect();
        assert_eq!(delays.iter().map(|&d| u32::from(d)).sum::<u32>(), 100);
        let bytes = film.finish().unwrap();
        assert!(bytes.len() < 2500, "{} bytes", bytes.len());
        assert!(bytes.windows(11).any(|w| w == b"NETSCAPE2.0"), "it loops");
    }

    #[test]
    fn what_is_written_is_what_is_read() {
        let mut film = GifFilm::new(Vec::new(), 64, 48, 25.0).unwrap();
        let pictures: Vec<Picture> = (0..3).map(|i| frame_with_square(i as f32 * 12.0)).collect();
        for picture in &pictures {
            film.frame(picture).unwrap();
        }
        let bytes = film.finish().unwrap();
        let decoder = image::codecs::gif::GifDecoder::new(std::io::Cursor::new(bytes)).unwrap();
        let frames = image::AnimationDecoder::into_frames(decoder)
            .collect_frames()
            .unwrap();
        assert_eq!(frames.len(), 3);
        for (frame, picture) in frames.iter().zip(&pictures) {
            let worst = frame
                .buffer()
                .as_raw()
                .iter()
                .zip(&picture.rgba)
                .map(|(a, b)| a.abs_diff(*b))
                .max();
            assert!(worst <= Some(10), "{worst:?}");
        }
    }

    #[test]
    fn a_frame_of_another_size_is_refused() {
        let mut film = GifFilm::new(Vec::new(), 32, 32, 25.0).unwrap();
        let error = film.frame(&frame_with_square(0.0)).unwrap_err().to_string();
        assert!(error.contains("64") && error.contains("32"), "{error}");
        assert!(GifFilm::new(Vec::new(), 0, 32, 25.0).is_err());
    }

    #[test]
    fn a_png_comes_back() {
        let picture = frame_with_square(20.0);
        let mut bytes = Vec::new();
        write_png(&picture, &mut bytes).unwrap();
        let read = image::load_from_memory(&bytes).unwrap().into_rgba8();
        assert_eq!(read.as_raw(), &picture.rgba);
    }
}
