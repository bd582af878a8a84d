//! Pictures for a Stream Deck +: its strip above the dials and its keys take JPEG in pieces; labels are drawn as pictures.
//!
//! Source: abcminiuser/python-elgato-streamdeck, `StreamDeckPlus.py` at 4ec7c733. The typeface is egui's own, Ubuntu Light.

use crate::codec::{Feedback, Outgoing, Picture};
use ab_glyph::{Font, FontRef, Glyph, PxScale, ScaleFont, point};
use device_profiles::{InputProfile, OutputKind, PixelCoding};
use image::ExtendedColorType;
use image::codecs::jpeg::JpegEncoder;
use std::collections::BTreeMap;

/// Every report with a piece of a picture is as long.
const REPORT_BYTES: usize = 1024;
/// JPEG quality: text stays clean, a picture of the strip takes some 5 KiB.
const QUALITY: u8 = 90;
/// Text is at most so large, and at least, as shares of the picture's height; longer text is cut.
const TEXT_LARGEST: f32 = 0.5;
const TEXT_SMALLEST: f32 = 0.2;
/// Free on either side of the text, as a share of the width.
const TEXT_MARGIN: f32 = 0.04;

/// The pictures of one device.
#[derive(Clone, Debug, Default)]
pub(super) struct Pictures {
    screens: Vec<Screen>,
    /// What is to be seen behind the labels, in the size of the screen.
    under: BTreeMap<usize, Picture>,
    texts: BTreeMap<usize, String>,
    wanted: BTreeMap<usize, Picture>,
    sent: BTreeMap<usize, Picture>,
}

/// One place for a picture.
#[derive(Clone, Copy, Debug)]
struct Screen {
    coding: PixelCoding,
    size: [u16; 2],
    /// Number among those of its kind.
    number: u16,
}

impl Pictures {
    /// The screens of the profile's outputs, in their order: those of dials before those of keys.
    pub(super) fn new(profile: &InputProfile) -> Self {
        let mut screens = Vec::new();
        for output in profile.outputs.iter().filter(|o| o.kind == OutputKind::Picture) {
            if let (Some(coding), Some(size)) = (output.pixels, output.size) {
                screens.extend((0..output.count).map(|number| Screen { coding, size, number }));
            }
        }
        Self {
            screens,
            ..Self::default()
        }
    }

    /// Notes what is wanted, and sends what is new.
    pub(super) fn want(&mut self, feedback: &Feedback, started: bool, out: &mut Outgoing) {
        let (Feedback::Picture { control, .. } | Feedback::Label { control, .. }) = feedback else {
            return;
        };
        let at = usize::from(*control);
        let Some(screen) = self.screens.get(at) else {
            return;
        };
        match feedback {
            Feedback::Picture { picture, .. } => {
                self.under.insert(at, fitted(picture, screen.size));
            }
            Feedback::Label { text, .. } => {
                self.texts.insert(at, text.clone());
            }
            _ => {}
        }
        let picture = match (self.under.get(&at), self.texts.get(&at)) {
            (under, Some(text)) => drawn(text, screen.size, under),
            (Some(under), None) => Some(under.clone()),
            (None, None) => None,
        };
        if let Some(picture) = picture {
            self.wanted.insert(at, picture);
        }
        if started {
            self.send_changes(out);
        }
    }

    /// After a start: the screens show the maker's pictures.
    pub(super) fn send_everything(&mut self, out: &mut Outgoing) {
        self.sent.clear();
        self.send_changes(out);
    }

    fn send_changes(&mut self, out: &mut Outgoing) {
        for (at, picture) in &self.wanted {
            if self.sent.get(at) == Some(picture) {
                continue;
            }
            if let Some(screen) = self.screens.get(*at) {
                screen.send(picture, out);
                self.sent.insert(*at, picture.clone());
            }
        }
    }
}

impl Screen {
    fn send(self, picture: &Picture, out: &mut Outgoing) {
        let mut jpeg = Vec::new();
        let [width, height] = picture.size().map(u32::from);
        let encoder = &mut JpegEncoder::new_with_quality(&mut jpeg, QUALITY);
        // Writing to memory does not fail, and the picture has the bytes its size needs.
        if encoder
            .encode(picture.rgb(), width, height, ExtendedColorType::Rgb8)
            .is_err()
        {
            return;
        }
        let room = REPORT_BYTES - self.head(0, false, 0).len();
        let pieces = jpeg.chunks(room).count();
        for (page, piece) in (0_u16..).zip(jpeg.chunks(room)) {
            let last = usize::from(page) + 1 == pieces;
            let mut report = self.head(page, last, piece.len() as u16);
            report.extend_from_slice(piece);
            report.resize(REPORT_BYTES, 0);
            out.report(&report);
        }
    }

    fn head(self, page: u16, last: bool, length: u16) -> Vec<u8> {
        let [page, length] = [page, length].map(u16::to_le_bytes);
        match self.coding {
            PixelCoding::StreamDeckStrip => {
                let [width, height] = self.size;
                let mut head = vec![0x02, 0x0C];
                for number in [self.number * width, 0, width, height] {
                    head.extend(number.to_le_bytes());
                }
                head.push(u8::from(last));
                head.extend(page);
                head.extend(length);
                head.push(0);
                head
            }
            PixelCoding::StreamDeckKey => {
                let mut head = vec![0x02, 0x07, self.number as u8, u8::from(last)];
                head.extend(length);
                head.extend(page);
                head
            }
        }
    }
}

/// The picture in another size, each pixel the nearest one's.
fn fitted(picture: &Picture, [width, height]: [u16; 2]) -> Picture {
    let [from_width, from_height] = picture.size().map(usize::from);
    let (width_px, height_px) = (usize::from(width), usize::from(height));
    let mut rgb = Vec::with_capacity(width_px * height_px * 3);
    for y in 0..height_px {
        for x in 0..width_px {
            let at = (y * from_height / height_px * from_width + x * from_width / width_px) * 3;
            rgb.extend_from_slice(picture.rgb().get(at..at + 3).unwrap_or(&[0; 3]));
        }
    }
    Picture::new(width, height, rgb).unwrap_or_else(|| picture.clone())
}

/// Text in the middle, as large as it fits: white on black, or upon a picture, on a light one black.
fn drawn(text: &str, [width, height]: [u16; 2], under: Option<&Picture>) -> Option<Picture> {
    let font = FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).ok()?;
    let [wide, high] = [width, height].map(f32::from);
    let room = wide * (1.0 - 2.0 * TEXT_MARGIN);
    let mut text = text.trim();
    let mut scale = high * TEXT_LARGEST;
    let length = |text: &str, scale: f32| {
        let font = font.as_scaled(PxScale::from(scale));
        text.chars()
            .map(|c| font.h_advance(font.glyph_id(c)))
            .sum::<f32>()
    };
    let full = length(text, scale);
    if full > room {
        scale = (scale * room / full).max(high * TEXT_SMALLEST);
    }
    while length(text, scale) > room {
        let (last, _) = text.char_indices().next_back()?;
        text = text.get(..last)?;
    }
    let mut light = vec![0_u8; usize::from(width) * usize::from(height)];
    let scaled = font.as_scaled(PxScale::from(scale));
    let mut x = (wide - length(text, scale)) / 2.0;
    let y = (high + scaled.ascent() + scaled.descent()) / 2.0;
    for c in text.chars() {
        let glyph: Glyph = scaled.glyph_id(c).with_scale_and_position(scale, point(x, y));
        x += scaled.h_advance(glyph.id);
        let Some(outline) = font.outline_glyph(glyph) else {
            continue;
        };
        let origin = outline.px_bounds().min;
        outline.draw(|dx, dy, cover| {
            let (px, py) = (origin.x as i64 + i64::from(dx), origin.y as i64 + i64::from(dy));
            if (0..i64::from(width)).contains(&px) && (0..i64::from(height)).contains(&py) {
                let at = py as usize * usize::from(width) + px as usize;
                if let Some(pixel) = light.get_mut(at) {
                    *pixel = pixel.saturating_add((cover.clamp(0.0, 1.0) * 255.0) as u8);
                }
            }
        });
    }
    Picture::new(
        width,
        height,
        upon(&light, under.map(Picture::rgb).unwrap_or_default()),
    )
}

/// Mixes the text's light into what lies under it, black where there is nothing.
fn upon(light: &[u8], under: &[u8]) -> Vec<u8> {
    let sum = under.iter().map(|&part| u64::from(part)).sum::<u64>();
    let ink: u8 = if sum > under.len() as u64 * 128 { 0 } else { 255 };
    let mix = |cover: u8, part: u8| {
        let [cover, part, ink] = [cover, part, ink].map(u16::from);
        ((ink * cover + part * (255 - cover)) / 255) as u8
    };
    let part = |at: usize| under.get(at).copied().unwrap_or(0);
    let pixels = light.iter().enumerate();
    pixels
        .flat_map(|(at, &cover)| [0, 1, 2].map(|n| mix(cover, part(at * 3 + n))))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::Step;
    use device_profiles::Profiles;

    fn sent(pictures: &mut Pictures, feedback: &Feedback) -> Vec<Vec<u8>> {
        let mut out = Outgoing::new();
        pictures.want(feedback, true, &mut out);
        out.drain()
            .map(|step| match step {
                Step::Report(bytes) => bytes,
                other => panic!("{other:?}"),
            })
            .collect()
    }

    fn deck() -> Pictures {
        Pictures::new(
            Profiles::builtin()
                .input("stream-deck-plus")
                .expect("it is built in"),
        )
    }

    fn label(control: u16, text: &str) -> Feedback {
        Feedback::Label {
            control,
            text: text.to_owned(),
        }
    }

    /// The pieces put together again are a picture of the label's size, light in the middle and dark at the edge.
    #[test]
    fn a_label_is_drawn_on_its_part_of_the_strip() {
        let mut deck = deck();
        let reports = sent(&mut deck, &label(2, "Left elbow"));
        let mut jpeg = Vec::new();
        for (page, report) in reports.iter().enumerate() {
            assert_eq!(report.len(), 1024);
            // Third of four: 400 from the left, 200 by 100.
            assert_eq!(report[..10], [2, 12, 0x90, 1, 0, 0, 200, 0, 100, 0]);
            assert_eq!(report[10] == 1, page + 1 == reports.len());
            assert_eq!(usize::from(report[11]), page);
            let length = usize::from(u16::from_le_bytes([report[13], report[14]]));
            jpeg.extend(&report[16..16 + length]);
        }
        let picture = image::load_from_memory(&jpeg).expect("a JPEG").to_luma8();
        assert_eq!(picture.dimensions(), (200, 100));
        let brightest = |rows: std::ops::Range<u32>| {
            rows.map(|y| (0..200).map(|x| picture.get_pixel(x, y).0[0]).max())
                .max()
        };
        assert!(brightest(30..70) > Some(Some(200)));
        assert!(brightest(0..10) < Some(Some(60)));
        assert_eq!(sent(&mut deck, &label(2, "Left elbow")), Vec::<Vec<u8>>::new());
    }

    #[test]
    fn a_picture_is_fitted_to_its_key() {
        let red = Picture::new(2, 1, vec![255, 0, 0, 0, 0, 0]).expect("two pixels");
        let reports = sent(
            &mut deck(),
            &Feedback::Picture {
                control: 5,
                picture: red,
            },
        );
        let mut jpeg = Vec::new();
        for report in &reports {
            // The second key.
            assert_eq!(report[..3], [2, 7, 1]);
            let length = usize::from(u16::from_le_bytes([report[4], report[5]]));
            jpeg.extend(&report[8..8 + length]);
        }
        let picture = image::load_from_memory(&jpeg).expect("a JPEG").to_rgb8();
        assert_eq!(picture.dimensions(), (120, 120));
        assert!(picture.get_pixel(20, 60).0[0] > 200 && picture.get_pixel(100, 60).0[0] < 50);
        assert_eq!(sent(&mut deck(), &label(12, "no such")), Vec::<Vec<u8>>::new());
    }

    /// Yellow under black letters; the colour stays when the text changes.
    #[test]
    fn a_label_is_drawn_upon_a_picture() {
        let mut deck = deck();
        sent(&mut deck, &label(5, "Elbow"));
        let yellow = Picture::new(1, 1, vec![255, 230, 0]).expect("a pixel");
        let picture = Feedback::Picture {
            control: 5,
            picture: yellow,
        };
        assert!(!sent(&mut deck, &picture).is_empty());
        let both = deck.wanted.get(&5).expect("it is wanted").clone();
        assert_eq!(both.rgb()[..3], [255, 230, 0], "the corner");
        let darkest = both.rgb().chunks(3).map(|pixel| pixel[0]).min();
        assert!(darkest < Some(60), "{darkest:?}");
        assert!(!sent(&mut deck, &label(5, "Wrist")).is_empty());
        assert_eq!(deck.wanted[&5].rgb()[..3], [255, 230, 0]);
        assert_ne!(deck.wanted[&5], both);
    }

    #[test]
    fn text_of_any_length_stays_inside() {
        for text in [
            "",
            " ",
            "i",
            "a label that is far too long for any screen of this size, and goes on",
        ] {
            assert!(drawn(text, [200, 100], None).is_some(), "{text}");
        }
    }
}
