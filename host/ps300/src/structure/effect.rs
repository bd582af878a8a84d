//! What an operation node does to everything below it, ready to be applied.
//!
//! Apart from the operation as written because messages change the effect and leave the text alone.
//! Source: `docs/protocols/ps300.md`, "Display-tree nodes as sinks and sources".

use glam::{DMat2, DMat3, DMat4, DVec3};

use super::projection::{self, NoView};
use crate::display::Viewport;
use crate::language::{Axis, Input, Operation, Range};
use crate::network::Refusal;
use crate::value::{Kind, Kinds, Value};

/// The change to the state of the traversal.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Effect {
    Model(DMat4),
    View(DMat4),
    Viewport(Viewport),
    Characters(DMat2),
    Color {
        hue_deg: f64,
        saturation: f64,
    },
    Intensity {
        on: bool,
        brightest: f64,
    },
    Bit {
        bit: u8,
        on: bool,
    },
    If {
        bit: u8,
        on: bool,
    },
    /// Kept for the text of the program; pictures do not show it.
    Unseen,
}

impl Effect {
    pub(super) fn of(operation: &Operation) -> Result<Self, NoView> {
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
            Operation::Look { at, from, up } => Self::View(projection::look(at, from, up)?.into()),
            Operation::FieldOfView { degrees, boundaries } => {
                // Without planes: deep enough for any scene of this size, and depth is not cut.
                let [front, back] = boundaries.map_or([1e-3, 1e6], |b| [b.front, b.back]);
                Self::View(projection::perspective(degrees, front, back)?)
            }
            Operation::Window { x, y, boundaries } => {
                let depth = boundaries.map(|b| [b.front, b.back]);
                Self::View(projection::parallel([x.from, x.to], [y.from, y.to], depth)?)
            }
            Operation::Viewport {
                horizontal,
                vertical,
                intensity,
            } => Self::Viewport(Viewport {
                horizontal: span(horizontal),
                vertical: span(vertical),
                intensity: intensity.map_or([0.0, 1.0], span),
            }),
            Operation::SetColor { hue_deg, saturation } => Self::Color { hue_deg, saturation },
            Operation::SetIntensity { on, range } => Self::Intensity {
                on,
                brightest: range.to,
            },
            Operation::SetConditionalBit { bit, on } => Self::Bit { bit, on },
            Operation::IfConditionalBit { bit, on } => Self::If { bit, on },
            Operation::SetDepthClipping(_)
            | Operation::SetPicking(_)
            | Operation::SetPickingIdentifier(_)
            | Operation::Eye { .. }
            | Operation::SetColorBlending { .. }
            | Operation::SetContrast(_)
            | Operation::SetPickingLocation { .. }
            | Operation::SetLevelOfDetail(_)
            | Operation::IncrementLevelOfDetail
            | Operation::DecrementLevelOfDetail
            | Operation::IfLevelOfDetail { .. }
            | Operation::SetRate { .. }
            | Operation::SetRateExternal
            | Operation::IfPhase(_)
            | Operation::SetDisplay { .. }
            | Operation::SetPlotter(_)
            | Operation::SetLineTexture { .. }
            | Operation::CharacterScale(_)
            | Operation::CharacterRotate { .. }
            | Operation::CharacterFont(_)
            | Operation::StandardFont
            | Operation::TextSize(_)
            | Operation::XformMatrix
            | Operation::XformVectorList
            | Operation::SurfaceRendering
            | Operation::SolidRendering
            | Operation::SectioningPlane => Self::Unseen,
        })
    }

    fn model(m: DMat3) -> Self {
        Self::Model(DMat4::from_mat3(m))
    }

    /// A 4x4 with a projective last row is a view; without, it is a transform like any other.
    fn matrix4(m: DMat4) -> Self {
        if m.row(3) == glam::DVec4::W {
            Self::Model(m)
        } else {
            Self::View(m)
        }
    }

    /// Takes a message. The kind has been checked against [`accepts`].
    pub(super) fn feed(&mut self, operation: &Operation, input: Input, value: &Value) -> Result<(), Refusal> {
        let second = input == Input::Number(2);
        match (&mut *self, value) {
            (Self::Color { saturation, .. }, value) if second => {
                *saturation = number(value, 0.0, 1.0)?;
            }
            (Self::Color { hue_deg, saturation }, Value::Vector2(v)) => (*hue_deg, *saturation) = (v.x, v.y),
            (Self::Color { hue_deg, .. }, value) => *hue_deg = number(value, f64::MIN, f64::MAX)?,
            (Self::Intensity { brightest, .. }, Value::Vector2(v)) => *brightest = v.y,
            (Self::Intensity { on, .. } | Self::Bit { on, .. }, Value::Boolean(b)) => *on = *b,
            (Self::Viewport(viewport), Value::Matrix3(m)) => {
                let row = |n: usize| [m.row(n).x, m.row(n).y];
                *viewport = Viewport {
                    horizontal: row(0),
                    vertical: row(1),
                    intensity: row(2),
                };
            }
            (_, Value::Matrix2(m)) => *self = Self::Characters(**m),
            (_, Value::Matrix3(m)) => *self = Self::model(**m),
            (_, Value::Matrix4(m)) => {
                let view = matches!(
                    operation,
                    Operation::FieldOfView { .. } | Operation::Window { .. }
                );
                *self = if view { Self::View(**m) } else { Self::matrix4(**m) };
            }
            (Self::View(view), Value::Matrix4x3(m)) => *view = (**m).into(),
            (Self::Model(model), Value::Matrix4x3(m)) => *model = (**m).into(),
            (Self::Model(model), Value::Vector2(v)) => *model = DMat4::from_translation(v.extend(0.0)),
            (Self::Model(model), Value::Vector3(v)) => {
                let scales = matches!(operation, Operation::Scale(_));
                *model = if scales {
                    DMat4::from_scale(*v)
                } else {
                    DMat4::from_translation(*v)
                };
            }
            (Self::Model(model), value) => {
                *model = DMat4::from_scale(DVec3::splat(number(value, f64::MIN, f64::MAX)?));
            }
            _ => {}
        }
        Ok(())
    }
}

fn span(range: Range) -> [f64; 2] {
    [range.from, range.to]
}

fn number(value: &Value, low: f64, high: f64) -> Result<f64, Refusal> {
    match value.as_number() {
        Some(x) => Ok(x.clamp(low, high)),
        None => Err(Refusal::Kind(Kinds::NUMBER)),
    }
}

const MATRIX3: Kinds = Kinds::of(&[Kind::Matrix3]);
const VECTOR2: Kinds = Kinds::of(&[Kind::Vector2]);
const MATRIX4: Kinds = Kinds::of(&[Kind::Matrix4]);
const SCALE: Kinds = Kinds::NUMBER.or(Kinds::of(&[Kind::Matrix3, Kind::Vector3]));
const POINT: Kinds = Kinds::of(&[Kind::Vector2, Kind::Vector3]);
const HUE: Kinds = Kinds::NUMBER.or(VECTOR2);
const CHARACTERS: Kinds = Kinds::of(&[Kind::Matrix2]);
const EYE: Kinds = Kinds::of(&[Kind::Matrix4x3]);

/// What the inputs of an operation node take, from <1>.
pub(super) fn accepts(operation: &Operation) -> &'static [Kinds] {
    match operation {
        Operation::Rotate { .. } | Operation::Matrix3(_) | Operation::Viewport { .. } => &[MATRIX3],
        Operation::Scale(_) => &[SCALE],
        Operation::Translate(_) => &[POINT],
        Operation::Matrix2(_) => &[CHARACTERS],
        Operation::Matrix4x3(_) | Operation::Look { .. } => &[EYE],
        Operation::Matrix4(_) | Operation::FieldOfView { .. } | Operation::Window { .. } => &[MATRIX4],
        Operation::SetColor { .. } => &[HUE, Kinds::NUMBER],
        Operation::SetIntensity { .. } => &[Kinds::BOOLEAN, VECTOR2],
        Operation::SetDepthClipping(_) | Operation::SetPicking(_) | Operation::SetConditionalBit { .. } => {
            &[Kinds::BOOLEAN]
        }
        _ => &[],
    }
}

/// As reports and drawings name it.
pub(super) fn what(operation: &Operation) -> &'static str {
    match operation {
        Operation::Rotate { .. } => "ROTATE",
        Operation::Translate(_) => "TRANSLATE",
        Operation::Scale(_) => "SCALE",
        Operation::Matrix2(_) => "MATRIX_2X2",
        Operation::Matrix3(_) => "MATRIX_3X3",
        Operation::Matrix4x3(_) => "MATRIX_4X3",
        Operation::Matrix4(_) => "MATRIX_4X4",
        Operation::Look { .. } => "LOOK",
        Operation::FieldOfView { .. } => "FIELD_OF_VIEW",
        Operation::Window { .. } => "WINDOW",
        Operation::Viewport { .. } => "VIEWPORT",
        Operation::SetColor { .. } => "SET COLOR",
        Operation::SetIntensity { .. } => "SET INTENSITY",
        Operation::SetDepthClipping(_) => "SET DEPTH_CLIPPING",
        Operation::SetPicking(_)
        | Operation::SetPickingIdentifier(_)
        | Operation::SetPickingLocation { .. } => "SET PICKING",
        Operation::SetConditionalBit { .. } => "SET CONDITIONAL_BIT",
        Operation::IfConditionalBit { .. } => "IF CONDITIONAL_BIT",
        Operation::Eye { .. } => "EYE",
        Operation::SetColorBlending { .. } => "SET COLOR BLENDING",
        Operation::SetContrast(_) => "SET CONTRAST",
        Operation::SetLevelOfDetail(_) => "SET LEVEL_OF_DETAIL",
        Operation::IncrementLevelOfDetail => "INCREMENT LEVEL_OF_DETAIL",
        Operation::DecrementLevelOfDetail => "DECREMENT LEVEL_OF_DETAIL",
        Operation::IfLevelOfDetail { .. } => "IF LEVEL_OF_DETAIL",
        Operation::SetRate { .. } | Operation::SetRateExternal => "SET RATE",
        Operation::IfPhase(_) => "IF PHASE",
        Operation::SetDisplay { .. } => "SET DISPLAY",
        Operation::SetPlotter(_) => "SET PLOTTER",
        Operation::SetLineTexture { .. } => "SET LINE_TEXTURE",
        Operation::CharacterScale(_) => "CHARACTER SCALE",
        Operation::CharacterRotate { .. } => "CHARACTER ROTATE",
        Operation::CharacterFont(_) => "CHARACTER FONT",
        Operation::StandardFont => "STANDARD FONT",
        Operation::TextSize(_) => "TEXT SIZE",
        Operation::XformMatrix => "XFORM MATRIX",
        Operation::XformVectorList => "XFORM VECTOR_LIST",
        Operation::SurfaceRendering => "SURFACE_RENDERING",
        Operation::SolidRendering => "SOLID_RENDERING",
        Operation::SectioningPlane => "SECTIONING_PLANE",
    }
}
