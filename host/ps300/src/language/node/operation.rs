//! Transforms, attributes and conditions.

use glam::{DAffine3, DMat2, DMat3, DMat4, DVec2, DVec3};

use crate::language::Name;

/// An axis of the left-handed space: x right, y up, z into the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it all")]
pub enum Axis {
    X,
    Y,
    Z,
}

/// A span of numbers written `a:b`; `a` may be the larger, which mirrors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Before the colon.
    pub from: f64,
    /// After it.
    pub to: f64,
}

/// The clipping planes written `FRONT BOUNDARY=f BACK BOUNDARY=b`, as distances from the eye along z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boundaries {
    /// Nearest depth drawn.
    pub front: f64,
    /// Farthest depth drawn.
    pub back: f64,
}

/// How IF LEVEL_OF_DETAIL compares the level of the traversal with its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it all")]
pub enum Comparison {
    Less,
    Equal,
    LessEqual,
    Greater,
    NotEqual,
    GreaterEqual,
}

impl Comparison {
    /// All of them with their spelling, in the order of their codes 0 to 5 in the vendor's constants file.
    pub const ALL: [(&'static str, Self); 6] = [
        ("<", Self::Less),
        ("=", Self::Equal),
        ("<=", Self::LessEqual),
        (">", Self::Greater),
        ("<>", Self::NotEqual),
        (">=", Self::GreaterEqual),
    ];

    /// Whether it holds between `left` and `right`.
    pub fn holds(self, left: i32, right: i32) -> bool {
        match self {
            Self::Less => left < right,
            Self::Equal => left == right,
            Self::LessEqual => left <= right,
            Self::Greater => left > right,
            Self::NotEqual => left != right,
            Self::GreaterEqual => left >= right,
        }
    }
}

/// What an operation node changes for everything below it.
#[derive(Clone, Debug, PartialEq)]
pub enum Operation {
    /// `ROTATE IN X 90`: anticlockwise by the right-hand formula.
    Rotate {
        /// Turned about.
        axis: Axis,
        /// As written; any number of turns.
        degrees: f64,
    },
    /// `TRANSLATE BY x,y[,z]`; z is 0 unless written.
    Translate(DVec3),
    /// `SCALE BY s` or `sx,sy[,sz]`; one number scales all axes, two leave z at 1.
    Scale(DVec3),
    /// `MATRIX_2x2`, written row by row.
    Matrix2(DMat2),
    /// `MATRIX_3x3`, written row by row.
    Matrix3(DMat3),
    /// `MATRIX_4x3`: three rows of four, the last column a translation.
    Matrix4x3(DAffine3),
    /// `MATRIX_4x4`, written row by row.
    Matrix4(DMat4),
    /// `LOOK AT … FROM … [UP …]`. All three are points in world space.
    Look {
        /// The point in the middle of the picture.
        at: DVec3,
        /// Where the eye is.
        from: DVec3,
        /// A point above the eye; absent means straight up (+y) from `from`.
        up: Option<DVec3>,
    },
    /// `FIELD_OF_VIEW angle [FRONT BOUNDARY=f BACK BOUNDARY=b]`.
    FieldOfView {
        /// The full angle.
        degrees: f64,
        /// Depth clipping, if said.
        boundaries: Option<Boundaries>,
    },
    /// `WINDOW X=a:b Y=c:d [FRONT BOUNDARY=f BACK BOUNDARY=b]`: parallel projection.
    Window {
        /// Horizontal extent.
        x: Range,
        /// Vertical extent.
        y: Range,
        /// Depth clipping, if said.
        boundaries: Option<Boundaries>,
    },
    /// `EYE BACK z [RIGHT x] [UP y] FROM SCREEN AREA w WIDE [FRONT BOUNDARY=f BACK BOUNDARY=b]`: perspective
    /// of an eye in front of a screen that stands in the plane z = 0 of eye space.
    Eye {
        /// How far the eye is behind the middle of the screen.
        back: f64,
        /// How far right of it; LEFT is negative.
        right: f64,
        /// How far above it; DOWN is negative.
        up: f64,
        /// Width and height of the screen, in the units of the rest.
        width: f64,
        /// Depth clipping, if said.
        boundaries: Option<Boundaries>,
    },
    /// `VIEWPORT HORIZONTAL=a:b VERTICAL=c:d [INTENSITY=i:j]`: part of the screen, -1 to 1 each way.
    Viewport {
        /// Left and right.
        horizontal: Range,
        /// Bottom and top.
        vertical: Range,
        /// Farthest and nearest brightness, 0 to 1, if said.
        intensity: Option<Range>,
    },
    /// `SET COLOR hue,saturation`. Hue 0 is blue, 120 red, 240 green; saturation 0 is white.
    SetColor {
        /// 0 to 360.
        hue_deg: f64,
        /// 0 to 1.
        saturation: f64,
    },
    /// `SET INTENSITY ON 0.5:1`: depth cueing between two brightnesses.
    SetIntensity {
        /// Whether the range is in force.
        on: bool,
        /// Farthest and nearest brightness, 0 to 1.
        range: Range,
    },
    /// `SET DEPTH_CLIPPING ON`.
    SetDepthClipping(bool),
    /// `SET PICKING ON`.
    SetPicking(bool),
    /// `SET PICKING IDENTIFIER=name`.
    SetPickingIdentifier(Name),
    /// `SET CONDITIONAL_BIT k ON`.
    SetConditionalBit {
        /// 0 to 14.
        bit: u8,
        /// The state below.
        on: bool,
    },
    /// `IF CONDITIONAL_BIT k IS ON`: what is below is drawn only then.
    IfConditionalBit {
        /// 0 to 14.
        bit: u8,
        /// The state in which the traversal goes on.
        on: bool,
    },
    /// `SET COLOR BLENDING s`: vectors of lists with COLOR have this saturation.
    SetColorBlending {
        /// 0 to 1.
        saturation: f64,
    },
    /// `SET CONTRAST TO c`.
    SetContrast(f64),
    /// `SET PICKING LOCATION=x,y sx,sy`: where picks are looked for.
    SetPickingLocation {
        /// Middle, on the screen of -1 to 1 each way.
        center: DVec2,
        /// Half its width and height.
        size: DVec2,
    },
    /// `SET LEVEL_OF_DETAIL TO i`.
    SetLevelOfDetail(i32),
    /// `INCREMENT LEVEL_OF_DETAIL`.
    IncrementLevelOfDetail,
    /// `DECREMENT LEVEL_OF_DETAIL`.
    DecrementLevelOfDetail,
    /// `IF LEVEL_OF_DETAIL >= i`: what is below is drawn only then.
    IfLevelOfDetail {
        /// Between the level of the traversal, on the left, and `level`.
        comparison: Comparison,
        /// On the right.
        level: i32,
    },
    /// `SET RATE on off [ON/OFF] [delay]`: blinking. All are counted in displayed frames.
    SetRate {
        /// How long the phase is on.
        on_frames: u32,
        /// How long it is off.
        off_frames: u32,
        /// The phase it begins in; on unless written.
        initially: Option<bool>,
        /// How long the first phase lasts, if not as long as the others.
        delay_frames: Option<u32>,
    },
    /// `SET RATE EXTERNAL`: the phase is what messages say.
    SetRateExternal,
    /// `IF PHASE IS ON`: what is below is drawn only then.
    IfPhase(bool),
    /// `SET DISPLAY n ON`: whether what is below appears on screen `n` of a machine with several.
    SetDisplay {
        /// As the machine numbers its screens.
        number: u8,
        /// Whether it appears there.
        on: bool,
    },
    /// `SET PLOTTER ON`.
    SetPlotter(bool),
    /// `SET LINE_TEXTURE [AROUND_CORNERS] t`: dashes by a mask of seven bits.
    SetLineTexture {
        /// Whether the mask goes on from one vector to the next.
        around_corners: bool,
        /// 1 to 127, highest bit first; 127 is solid.
        mask: u8,
    },
    /// `CHARACTER SCALE sx[,sy]`.
    CharacterScale(DVec2),
    /// `CHARACTER ROTATE a`: anticlockwise.
    CharacterRotate {
        /// As written; any number of turns.
        degrees: f64,
    },
    /// `CHARACTER FONT f`.
    CharacterFont(Name),
    /// `STANDARD FONT`: the machine's own.
    StandardFont,
    /// `TEXT SIZE s`: characters are s high and wide, whatever stood above.
    TextSize(f64),
    /// `XFORM MATRIX`: a place whose accumulated transform F:XFORMDATA reads.
    XformMatrix,
    /// `XFORM VECTOR_LIST`: a place below which F:XFORMDATA reads transformed vectors.
    XformVectorList,
    /// `SURFACE_RENDERING`: the polygons below can be rendered as open sheets.
    SurfaceRendering,
    /// `SOLID_RENDERING`: the polygons below can be rendered as a closed volume.
    SolidRendering,
    /// `SECTIONING_PLANE`: the plane of the first polygon below cuts.
    SectioningPlane,
}

impl Operation {
    /// Conditional bits are numbered below this.
    pub const CONDITIONAL_BITS: u8 = 15;
    /// A line texture has seven bits.
    pub const LINE_TEXTURE_MAX: u8 = 127;

    /// Whether it lets the traversal go on or not, and is written with THEN.
    pub fn is_condition(&self) -> bool {
        matches!(
            self,
            Self::IfConditionalBit { .. } | Self::IfLevelOfDetail { .. } | Self::IfPhase(_)
        )
    }
}
