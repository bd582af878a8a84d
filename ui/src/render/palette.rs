//! The 256 colours of a film: ramps from the ground to every colour the theme knows, and a small wheel for
//! what users colour themselves. Fixed, so that frames compress against each other and nothing flickers.

use super::theme::{self, Rgb};

/// Index of the colour that means "as in the frame before".
pub const UNCHANGED: u8 = 255;

/// The palette and a table that finds the nearest entry.
pub struct Palette {
    colours: Vec<Rgb>,
    /// Nearest entry for each of 32 steps of red, green and blue.
    nearest: Vec<u8>,
}

impl Default for Palette {
    fn default() -> Self {
        Palette::new()
    }
}

/// Steps of one channel in the table of nearest entries; 5 bits.
const STEPS: usize = 32;

impl Palette {
    /// Builds the palette; always the same.
    pub fn new() -> Palette {
        let mut colours = Vec::with_capacity(256);
        ramp(&mut colours, theme::LINE, 64);
        ramp(&mut colours, theme::SELECTED, 40);
        ramp(&mut colours, theme::LIVE, 40);
        ramp(&mut colours, theme::FAULTED, 24);
        // Twelve hues, seven brightnesses each.
        for twelfth in 0..12_u8 {
            ramp(&mut colours, hue(f32::from(twelfth) * 30.0), 7);
        }
        colours.truncate(usize::from(UNCHANGED));
        let nearest = (0..STEPS * STEPS * STEPS)
            .map(|cell| nearest_entry(&colours, centre(cell)))
            .collect();
        Palette { colours, nearest }
    }

    /// Red, green, blue of all 256 entries, as a GIF stores them.
    pub fn bytes(&self) -> Vec<u8> {
        let mut bytes: Vec<u8> = self.colours.iter().flat_map(|c| [c.0, c.1, c.2]).collect();
        bytes.resize(256 * 3, 0);
        bytes
    }

    /// The entry closest to a colour.
    pub fn index(&self, r: u8, g: u8, b: u8) -> u8 {
        let step = |c: u8| usize::from(c) >> 3;
        self.nearest[(step(r) * STEPS + step(g)) * STEPS + step(b)]
    }

    /// The colour of an entry; the ground for [`UNCHANGED`].
    pub fn colour(&self, index: u8) -> Rgb {
        self.colours
            .get(usize::from(index))
            .copied()
            .unwrap_or(theme::GROUND)
    }
}

/// `steps` colours from just above the ground to `colour`; the first ramp includes the ground.
fn ramp(colours: &mut Vec<Rgb>, colour: Rgb, steps: u16) {
    if colours.is_empty() {
        colours.push(theme::GROUND);
    }
    colours.extend((1..=steps).map(|s| theme::GROUND.mix(colour, f32::from(s) / f32::from(steps))));
}

/// A full colour of the wheel, 0 red, 120 green, 240 blue.
fn hue(degrees: f32) -> Rgb {
    let channel = |offset: f32| {
        let away = ((degrees + offset).rem_euclid(360.0) - 180.0).abs();
        (((away - 60.0) / 60.0).clamp(0.0, 1.0) * 255.0).round() as u8
    };
    Rgb(channel(0.0), channel(240.0), channel(120.0))
}

/// The middle of a cell of the table; the ground's own cell answers with the ground.
fn centre(cell: usize) -> Rgb {
    let of = |step: usize| (step * 8 + 4) as u8;
    let cell_of = |c: Rgb| ((c.0 as usize >> 3) * STEPS + (c.1 as usize >> 3)) * STEPS + (c.2 as usize >> 3);
    if cell == cell_of(theme::GROUND) {
        return theme::GROUND;
    }
    Rgb(
        of(cell / STEPS / STEPS),
        of(cell / STEPS % STEPS),
        of(cell % STEPS),
    )
}

fn nearest_entry(colours: &[Rgb], to: Rgb) -> u8 {
    let apart = |a: u8, b: u8| (i32::from(a) - i32::from(b)).pow(2);
    let distance = |c: &Rgb| 3 * apart(c.0, to.0) + 4 * apart(c.1, to.1) + 2 * apart(c.2, to.2);
    let (index, _) = colours
        .iter()
        .enumerate()
        .min_by_key(|(_, c)| distance(c))
        .unwrap_or((0, &to));
    index as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn theme_colours_come_back_nearly_themselves() {
        let palette = Palette::new();
        for colour in [
            theme::GROUND,
            theme::LINE,
            theme::SELECTED,
            theme::LIVE,
            theme::FAULTED,
        ] {
            let Rgb(r, g, b) = palette.colour(palette.index(colour.0, colour.1, colour.2));
            let off = [(r, colour.0), (g, colour.1), (b, colour.2)].map(|(x, y)| x.abs_diff(y));
            assert!(
                off.iter().all(|&o| o <= 10),
                "{colour:?} came back as {r} {g} {b}"
            );
        }
        assert_eq!(
            palette.index(theme::GROUND.0, theme::GROUND.1, theme::GROUND.2),
            0
        );
        assert_eq!(palette.bytes().len(), 768);
        assert!(palette.colours.len() <= usize::from(UNCHANGED));
    }

    #[test]
    fn the_wheel_has_its_corners() {
        assert_eq!(hue(0.0), Rgb(255, 0, 0));
        assert_eq!(hue(120.0), Rgb(0, 255, 0));
        assert_eq!(hue(240.0), Rgb(0, 0, 255));
    }
}
