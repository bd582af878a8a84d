//! The look, decided once: colours, type sizes, spacing. Plain numbers, so that pictures without a window
//! and the window itself cannot drift apart.
//!
//! Four accents, each with one meaning: [`SELECTED`] is what the next action applies to, [`LIVE`] is what
//! moves or answers now, [`TOO_MUCH`] is more than a servo can do or should bear, [`FAULTED`] is a fault and
//! nothing else. Everything else is grey on near-black.
//! Contrast against [`PANEL`] (WCAG 2.1 ratio): text 13, dim text 6, accents above 5.

/// A colour as a screen takes it: sRGB, eight bits a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rgb(pub u8, pub u8, pub u8);

impl Rgb {
    /// Goes from `self` (0) to `other` (1) in sRGB steps; `share` outside 0…1 is clamped.
    #[must_use]
    pub fn mix(self, other: Rgb, share: f32) -> Rgb {
        let share = share.clamp(0.0, 1.0);
        let one = |a: u8, b: u8| (f32::from(a) + (f32::from(b) - f32::from(a)) * share).round() as u8;
        Rgb(one(self.0, other.0), one(self.1, other.1), one(self.2, other.2))
    }
}

/// The ground every figure is drawn on.
pub const GROUND: Rgb = Rgb(0x0a, 0x0c, 0x0f);
/// The ground of panels beside the figure.
pub const PANEL: Rgb = Rgb(0x11, 0x14, 0x19);
/// Buttons, dials and tracks at rest.
pub const RAISED: Rgb = Rgb(0x1c, 0x21, 0x29);
/// The same under the pointer.
pub const HOVERED: Rgb = Rgb(0x28, 0x2f, 0x3a);
/// The same while pressed.
pub const PRESSED: Rgb = Rgb(0x35, 0x3e, 0x4b);
/// Borders and separators.
pub const EDGE: Rgb = Rgb(0x2a, 0x31, 0x3b);
/// Grid lines, ticks, and what is off.
pub const FAINT: Rgb = Rgb(0x56, 0x60, 0x6d);
/// Secondary text.
pub const DIM: Rgb = Rgb(0x93, 0x9e, 0xad);
/// Text.
pub const TEXT: Rgb = Rgb(0xdd, 0xe2, 0xe9);
/// The figure's lines at their nearest.
pub const LINE: Rgb = Rgb(0xee, 0xf1, 0xf5);
/// What the next action applies to.
pub const SELECTED: Rgb = Rgb(0xff, 0xb4, 0x54);
/// What moves, plays or answers now.
pub const LIVE: Rgb = Rgb(0x45, 0xd6, 0xbd);
/// More than a servo can do or should bear: too fast, too far, too hot. Nothing has failed yet.
pub const TOO_MUCH: Rgb = Rgb(0xc9, 0x8b, 0xff);
/// A fault, and nothing else.
pub const FAULTED: Rgb = Rgb(0xff, 0x4b, 0x4b);

/// Label displays, ruler numbers, table heads; points.
pub const SIZE_SMALL: f32 = 11.0;
/// Everything that is read; points.
pub const SIZE_BODY: f32 = 13.0;
/// Panel titles and the big button; points.
pub const SIZE_TITLE: f32 = 15.0;
/// The time read-out; points.
pub const SIZE_READOUT: f32 = 20.0;

/// The spacing step everything is a multiple of; points.
pub const STEP: f32 = 4.0;
/// Between things that belong together; points.
pub const GAP: f32 = 2.0 * STEP;
/// Inside panels, and between groups; points.
pub const MARGIN: f32 = 3.0 * STEP;
/// Corner radius of everything that has corners; points.
pub const ROUND: f32 = 3.0;
/// Height of a button and of a row that can be clicked; points.
pub const ROW: f32 = 24.0;

/// Width of a figure's limb; points.
pub const WIDTH_LINK: f32 = 3.0;
/// Width of the selected limb; points.
pub const WIDTH_SELECTED: f32 = 4.0;
/// Width of ghosts and trails; points.
pub const WIDTH_GHOST: f32 = 1.3;
/// Width of a stretch of a trail that must be noticed; points.
pub const WIDTH_STRETCH: f32 = 2.4;
/// Width of grid lines; points.
pub const WIDTH_GRID: f32 = 1.0;
/// What is left of a line's brightness at the far end of the depth cue.
pub const CUE_FAR: f32 = 0.34;

#[cfg(test)]
mod tests {
    use super::*;

    fn luminance(colour: Rgb) -> f64 {
        let linear = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.040_45 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }
        };
        0.2126 * linear(colour.0) + 0.7152 * linear(colour.1) + 0.0722 * linear(colour.2)
    }

    #[test]
    fn text_can_be_read_on_every_ground() {
        for (name, colour, at_least) in [
            ("text", TEXT, 10.0),
            ("dim", DIM, 5.0),
            ("selected", SELECTED, 5.0),
            ("live", LIVE, 5.0),
            ("too much", TOO_MUCH, 5.0),
            ("faulted", FAULTED, 4.5),
        ] {
            for ground in [GROUND, PANEL, RAISED] {
                let ratio = (luminance(colour) + 0.05) / (luminance(ground) + 0.05);
                assert!(
                    ratio >= at_least,
                    "{name} on {ground:?}: contrast {ratio:.1}, wanted {at_least}"
                );
            }
        }
    }

    #[test]
    fn mixing_ends_at_both_ends() {
        assert_eq!(GROUND.mix(LINE, 0.0), GROUND);
        assert_eq!(GROUND.mix(LINE, 1.0), LINE);
        assert_eq!(GROUND.mix(LINE, 7.0), LINE);
    }
}
