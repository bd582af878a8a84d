//! What an operation node does to everything below it, ready to be applied.
//!
//! Apart from the operation as written because messages change the effect and leave the text alone.
//! Source: `docs/protocols/ps300.md`, "Display-tree nodes as sinks and sources".

mod accepts;
mod feed;
mod rendering;

pub(super) use accepts::{accepts, what};
pub(super) use rendering::{Drawing, Rendering};

use glam::{DMat2, DMat3, DMat4, DVec2};

use super::projection::{self, NoView};
use crate::display::Viewport;
use crate::language::{Axis, Comparison, Operation, Range};
use crate::names::{NameId, Names};

/// The change to the state of the traversal.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Effect {
    Model(DMat4),
    Look(DMat4),
    View {
        onto: DMat4,
        /// Whether depth runs from 0 to 1 between planes somebody chose.
        deep: bool,
    },
    Viewport {
        viewport: Viewport,
        /// Brightness of the farthest and the nearest.
        intensity: Option<[f64; 2]>,
    },
    /// Multiplies what characters are scaled and turned by.
    Characters(DMat2),
    /// Replaces it.
    CharactersOnly(DMat2),
    /// Nothing is the standard font.
    Font(Option<NameId>),
    Color {
        hue_deg: f64,
        saturation: f64,
    },
    /// The saturation of lists that are coloured vector by vector.
    Blending(f64),
    Intensity {
        on: bool,
        range: [f64; 2],
    },
    Contrast(f64),
    Bit {
        bit: u8,
        on: bool,
    },
    IfBit {
        bit: u8,
        on: bool,
    },
    Level(i32),
    LevelBy(i32),
    IfLevel(Comparison, i32),
    Rate(Rate),
    /// The phase is what messages say.
    Phase(bool),
    IfPhase(bool),
    DepthClipping(bool),
    Picking(bool),
    Identifier(NameId),
    PickWindow {
        center: DVec2,
        half: DVec2,
    },
    /// On the one screen there is.
    Shown(bool),
    Texture {
        around_corners: bool,
        mask: u8,
    },
    Rendering(Rendering),
    Sectioning,
    /// A place to be read, or kept for the text of the program only.
    Unseen,
}

/// Blinking, in displayed frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rate {
    on: u64,
    off: u64,
    initially: bool,
    delay: Option<u64>,
}

impl Rate {
    /// Whether the phase is on at a frame.
    pub(super) fn phase(self, frame: u64) -> bool {
        let length = |phase: bool| if phase { self.on } else { self.off };
        let first = self.delay.unwrap_or(length(self.initially));
        if frame < first {
            return self.initially;
        }
        let period = self.on + self.off;
        if period == 0 {
            return self.initially;
        }
        if (frame - first) % period < length(!self.initially) {
            !self.initially
        } else {
            self.initially
        }
    }
}

/// The number this program's screen answers to in SET DISPLAY. Our choice.
const SCREEN: u8 = 1;

impl Effect {
    /// `names` gives the entries of fonts and identifiers.
    pub(super) fn of(operation: &Operation, names: &mut Names) -> Result<Self, NoView> {
        Ok(match operation {
            Operation::CharacterFont(name) => Self::Font(Some(names.refer(name))),
            Operation::SetPickingIdentifier(name) => Self::Identifier(names.intern(name)),
            other => Self::unnamed(other)?,
        })
    }

    /// Whether an operation can be made.
    pub(super) fn check(operation: &Operation) -> Result<(), NoView> {
        Self::unnamed(operation).map(|_| ())
    }

    fn unnamed(operation: &Operation) -> Result<Self, NoView> {
        if let Some(viewing) = Self::viewing(operation)? {
            return Ok(viewing);
        }
        Ok(match *operation {
            Operation::Rotate { axis, degrees } => {
                let radians = degrees.to_radians();
                Self::model(match axis {
                    Axis::X => DMat3::from_rotation_x(radians),
                    Axis::Y => DMat3::from_rotation_y(radians),
                    Axis::Z => DMat3::from_rotation_z(radians),
                })
            }
            Operation::Translate(by) => Self::Model(DMat4::from_translation(by)),
            Operation::Scale(by) => Self::model(DMat3::from_diagonal(by)),
            Operation::Matrix2(m) => Self::Characters(m),
            Operation::Matrix3(m) => Self::model(m),
            Operation::Matrix4x3(m) => Self::Model(m.into()),
            Operation::Matrix4(m) => Self::matrix4(m),
            Operation::CharacterScale(by) => Self::Characters(DMat2::from_diagonal(by)),
            Operation::CharacterRotate { degrees } => {
                Self::Characters(DMat2::from_angle(degrees.to_radians()))
            }
            Operation::TextSize(size) => Self::CharactersOnly(DMat2::from_diagonal(DVec2::splat(size))),
            Operation::StandardFont => Self::Font(None),
            Operation::SetColor { hue_deg, saturation } => Self::Color { hue_deg, saturation },
            Operation::SetColorBlending { saturation } => Self::Blending(saturation),
            Operation::SetIntensity { on, range } => Self::Intensity {
                on,
                range: span(range),
            },
            Operation::SetContrast(contrast) => Self::Contrast(contrast),
            Operation::SetConditionalBit { bit, on } => Self::Bit { bit, on },
            Operation::IfConditionalBit { bit, on } => Self::IfBit { bit, on },
            Operation::SetLevelOfDetail(level) => Self::Level(level),
            Operation::IncrementLevelOfDetail => Self::LevelBy(1),
            Operation::DecrementLevelOfDetail => Self::LevelBy(-1),
            Operation::IfLevelOfDetail { comparison, level } => Self::IfLevel(comparison, level),
            Operation::SetRate {
                on_frames,
                off_frames,
                initially,
                delay_frames,
            } => Self::Rate(Rate {
                on: on_frames.into(),
                off: off_frames.into(),
                initially: initially.unwrap_or(true),
                delay: delay_frames.map(u64::from),
            }),
            Operation::SetRateExternal => Self::Phase(true),
            Operation::IfPhase(on) => Self::IfPhase(on),
            Operation::SetDepthClipping(on) => Self::DepthClipping(on),
            Operation::SetPicking(on) => Self::Picking(on),
            Operation::SetPickingLocation { center, size } => Self::PickWindow { center, half: size },
            Operation::SetDisplay { number, on } if number == SCREEN => Self::Shown(on),
            Operation::SetLineTexture { around_corners, mask } => Self::Texture { around_corners, mask },
            Operation::SurfaceRendering => Self::Rendering(Rendering::new(false)),
            Operation::SolidRendering => Self::Rendering(Rendering::new(true)),
            Operation::SectioningPlane => Self::Sectioning,
            _ => Self::Unseen,
        })
    }

    fn viewing(operation: &Operation) -> Result<Option<Self>, NoView> {
        Ok(Some(match *operation {
            Operation::Look { at, from, up } => Self::Look(projection::look(at, from, up)?.into()),
            Operation::FieldOfView { degrees, boundaries } => {
                // Without planes: deep enough for any scene of this size, and depth is not cut.
                let [front, back] = boundaries.map_or(FAR_AND_WIDE, |b| [b.front, b.back]);
                Self::View {
                    onto: projection::perspective(degrees, front, back)?,
                    deep: boundaries.is_some(),
                }
            }
            Operation::Eye {
                back,
                right,
                up,
                width,
                boundaries,
            } => {
                let planes = boundaries.map_or(FAR_AND_WIDE, |b| [b.front, b.back]);
                Self::View {
                    onto: projection::eye(back, [right, up], width, planes)?,
                    deep: boundaries.is_some(),
                }
            }
            Operation::Window { x, y, boundaries } => {
                let depth = boundaries.map(|b| [b.front, b.back]);
                Self::View {
                    onto: projection::parallel([x.from, x.to], [y.from, y.to], depth)?,
                    deep: depth.is_some(),
                }
            }
            Operation::Viewport {
                horizontal,
                vertical,
                intensity,
            } => Self::Viewport {
                viewport: Viewport {
                    horizontal: span(horizontal),
                    vertical: span(vertical),
                },
                intensity: intensity.map(span),
            },
            _ => return Ok(None),
        }))
    }

    fn model(m: DMat3) -> Self {
        Self::Model(DMat4::from_mat3(m))
    }

    /// A 4x4 with a projective last row is a view; without, it is a transform like any other.
    fn matrix4(m: DMat4) -> Self {
        if m.row(3) == glam::DVec4::W {
            Self::Model(m)
        } else {
            Self::View {
                onto: m,
                deep: has_planes(&m),
            }
        }
    }
}

/// Depths where none are written.
const FAR_AND_WIDE: [f64; 2] = [1e-3, 1e6];

/// Whether a matrix of F:FOV or F:WINDOW was made with planes: without, depth stays as it was.
fn has_planes(m: &DMat4) -> bool {
    m.row(2) != glam::DVec4::Z
}

fn span(range: Range) -> [f64; 2] {
    [range.from, range.to]
}
