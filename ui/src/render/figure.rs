//! A posed figure as strokes: each link's shape where the link is, joints as small discs.

use glam::DVec3;
use motion::figure::Placed;
use ps300::display::{Stroke as Vector, rgb};

use super::scene::{Ink, Layer, Mark, Scene};
use super::theme::{self, Rgb};

/// How one pose is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// Colour, strength and layer of every link but the selected one.
    pub ink: Ink,
    /// Width of every link but the selected one, points.
    pub width: f32,
    /// The link drawn as selected.
    pub selected: Option<usize>,
    /// Whether joints are marked and shapes tinted with their own colours.
    pub detailed: bool,
}

impl Style {
    /// The pose on screen.
    pub fn present(selected: Option<usize>) -> Style {
        let ink = Ink::new(theme::LINE, Layer::Figure);
        Style {
            ink,
            width: theme::WIDTH_LINK,
            selected,
            detailed: true,
        }
    }

    /// A pose of another moment, `strength` 0…1.
    pub fn ghost(strength: f32) -> Style {
        let ink = Ink::new(theme::DIM, Layer::Ghost).faded(strength);
        Style {
            ink,
            width: theme::WIDTH_GHOST,
            selected: None,
            detailed: false,
        }
    }
}

/// How much of a shape's own colour shows in the figure; more would compete with the accents.
const TINT: f32 = 0.06;

/// Adds a pose. `shapes` has one list of vectors a link, in link axes; a link without one (or an empty
/// one) is drawn as a line from start to end.
pub fn add(scene: &mut Scene, placed: &[Placed], shapes: &[Vec<Vector>], style: Style) {
    for (index, link) in placed.iter().enumerate() {
        let selected = style.selected == Some(index);
        let (ink, width) = if selected {
            (
                Ink {
                    colour: theme::SELECTED,
                    ..style.ink
                },
                theme::WIDTH_SELECTED,
            )
        } else {
            (style.ink, style.width)
        };
        match shapes.get(index) {
            Some(shape) if !shape.is_empty() => {
                for vector in shape {
                    let tinted = style.detailed && !selected;
                    let ink = if tinted {
                        Ink {
                            colour: tinted_with(ink.colour, vector),
                            ..ink
                        }
                    } else {
                        ink
                    };
                    let at = |local: DVec3| link.start + link.world_from_link * local;
                    scene.stroke(at(vector.from), at(vector.to), width, ink);
                }
            }
            _ => scene.stroke(link.start, link.end, width, ink),
        }
        if style.detailed {
            scene.dot(
                link.start,
                theme::WIDTH_LINK,
                Mark::Disc,
                Ink {
                    colour: theme::DIM,
                    ..style.ink
                },
            );
        }
        if selected {
            scene.dot(link.end, 5.0, Mark::Ring, ink.flat());
        }
    }
}

fn tinted_with(colour: Rgb, vector: &Vector) -> Rgb {
    colour.mix(
        colour_of(vector.hue_deg, vector.saturation, vector.intensity[0]),
        TINT * vector.saturation as f32,
    )
}

/// A colour of the display structure: hue 0 blue, 120 red, 240 green; saturation 0 grey … 1 full; intensity
/// 0 black … 1 full.
/// Source: PS 300 Document Set, SET COLOR; TR-88-032, colour tables.
pub fn colour_of(hue_deg: f64, saturation: f64, intensity: f64) -> Rgb {
    let bytes = rgb(hue_deg, saturation, intensity) * 255.0;
    Rgb(
        bytes.x.round() as u8,
        bytes.y.round() as u8,
        bytes.z.round() as u8,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wheel_begins_at_blue() {
        for (hue, want) in [
            (0.0, Rgb(0, 0, 255)),
            (60.0, Rgb(255, 0, 255)),
            (120.0, Rgb(255, 0, 0)),
            (180.0, Rgb(255, 255, 0)),
            (240.0, Rgb(0, 255, 0)),
            (360.0, Rgb(0, 0, 255)),
        ] {
            assert_eq!(colour_of(hue, 1.0, 1.0), want, "hue {hue}");
        }
        assert_eq!(colour_of(77.0, 0.0, 0.5), Rgb(128, 128, 128));
    }
}
