//! Which inputs operation nodes have, and what nodes are called.

use crate::language::Operation;
use crate::value::{Kind, Kinds};

const MATRIX3: Kinds = Kinds::of(&[Kind::Matrix3]);
const VECTOR2: Kinds = Kinds::of(&[Kind::Vector2]);
const MATRIX4: Kinds = Kinds::of(&[Kind::Matrix4]);
const SCALE: Kinds = Kinds::NUMBER.or(Kinds::of(&[Kind::Matrix3, Kind::Vector3]));
const POINT: Kinds = Kinds::of(&[Kind::Vector2, Kind::Vector3]);
const HUE: Kinds = Kinds::NUMBER.or(VECTOR2);
const CHARACTERS: Kinds = Kinds::of(&[Kind::Matrix2]);
const SIZE: Kinds = CHARACTERS.or(Kinds::NUMBER).or(VECTOR2);
const EYE: Kinds = Kinds::of(&[Kind::Matrix4x3]);
const RENDERING: Kinds = Kinds::BOOLEAN.or(Kinds::INTEGER);

/// What the inputs of an operation node take, from <1>.
pub(in super::super) fn accepts(operation: &Operation) -> &'static [Kinds] {
    match operation {
        Operation::Rotate { .. } | Operation::Matrix3(_) | Operation::Viewport { .. } => &[MATRIX3],
        Operation::Scale(_) => &[SCALE],
        Operation::Translate(_) => &[POINT],
        Operation::Matrix2(_) | Operation::CharacterRotate { .. } => &[CHARACTERS],
        Operation::CharacterScale(_) | Operation::TextSize(_) => &[SIZE],
        Operation::Matrix4x3(_) | Operation::Look { .. } => &[EYE],
        Operation::Matrix4(_)
        | Operation::FieldOfView { .. }
        | Operation::Window { .. }
        | Operation::Eye { .. } => &[MATRIX4],
        Operation::SetColor { .. } => &[HUE, Kinds::NUMBER],
        Operation::SetColorBlending { .. } | Operation::SetContrast(_) => &[Kinds::NUMBER],
        Operation::SetIntensity { .. } => &[Kinds::BOOLEAN, VECTOR2],
        Operation::SetPickingLocation { .. } => &[VECTOR2, VECTOR2],
        Operation::SetLevelOfDetail(_)
        | Operation::IncrementLevelOfDetail
        | Operation::DecrementLevelOfDetail => &[Kinds::INTEGER],
        Operation::SetDepthClipping(_)
        | Operation::SetPicking(_)
        | Operation::SetRateExternal
        | Operation::SetDisplay { .. }
        | Operation::SetConditionalBit { .. } => &[Kinds::BOOLEAN],
        Operation::SurfaceRendering | Operation::SolidRendering => &[RENDERING, Kinds::BOOLEAN],
        Operation::SetPickingIdentifier(_)
        | Operation::IfConditionalBit { .. }
        | Operation::IfLevelOfDetail { .. }
        | Operation::SetRate { .. }
        | Operation::IfPhase(_)
        | Operation::SetPlotter(_)
        | Operation::SetLineTexture { .. }
        | Operation::CharacterFont(_)
        | Operation::StandardFont
        | Operation::XformMatrix
        | Operation::XformVectorList
        | Operation::SectioningPlane => &[],
    }
}

/// As reports and drawings name it.
pub(in super::super) fn what(operation: &Operation) -> &'static str {
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
        Operation::Eye { .. } => "EYE",
        Operation::Viewport { .. } => "VIEWPORT",
        Operation::SetColor { .. } => "SET COLOR",
        Operation::SetColorBlending { .. } => "SET COLOR BLENDING",
        Operation::SetContrast(_) => "SET CONTRAST",
        Operation::SetIntensity { .. } => "SET INTENSITY",
        Operation::SetDepthClipping(_) => "SET DEPTH_CLIPPING",
        Operation::SetPicking(_)
        | Operation::SetPickingIdentifier(_)
        | Operation::SetPickingLocation { .. } => "SET PICKING",
        Operation::SetConditionalBit { .. } => "SET CONDITIONAL_BIT",
        Operation::IfConditionalBit { .. } => "IF CONDITIONAL_BIT",
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
        Operation::XformMatrix | Operation::XformVectorList => "XFORM",
        Operation::SurfaceRendering => "SURFACE_RENDERING",
        Operation::SolidRendering => "SOLID_RENDERING",
        Operation::SectioningPlane => "SECTIONING_PLANE",
    }
}
