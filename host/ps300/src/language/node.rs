//! The display tree as commands describe it: operations, instances, data, structures.
//!
//! Apart from `command` because the display tree of the machine is made of the same parts.
//! Source: `docs/protocols/ps300.md`, sections "Modelling transforms and viewing", "Attributes,
//! conditionals" and "Data nodes".

use glam::{DAffine3, DMat2, DMat3, DMat4, DVec2, DVec3};

use super::{Name, Text};

/// What a name in the display tree denotes.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// `NIL`: a name with nothing below it.
    Nil,
    /// `INSTANCE OF a,b`: all of these, in this order.
    Instance(Vec<Name>),
    /// `BEGIN_STRUCTURE … END_STRUCTURE`. An operation without `applied_to` applies to all members after it.
    Structure(Vec<Member>),
    /// A transform, attribute or condition.
    Operation {
        /// What is changed for everything below.
        operation: Operation,
        /// `APPLIED TO name` (or `THEN name`); absent inside structures and where something follows later.
        applied_to: Option<Name>,
    },
    /// Lines or dots.
    VectorList(VectorList),
    /// Text in the model's space.
    Characters(Characters),
}

/// One element of a structure. The label is reached from outside as `structure.label`.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Without dots.
    pub label: Option<Name>,
    /// What the element is.
    pub node: Node,
}

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
}

impl Operation {
    /// Conditional bits are numbered below this.
    pub const CONDITIONAL_BITS: u8 = 15;
}

/// How the vectors of a list are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VectorClass {
    /// One polyline: a move to the first, then lines.
    Connected,
    /// A dot at each.
    Dots,
    /// Each says whether it is a move (P) or a line (L).
    Itemized,
    /// Pairs: move, line, move, line.
    Separate,
}

impl VectorClass {
    /// Whether the vector at `index` (from 0) is drawn to, for the classes that decide it by place.
    pub fn draws(self, index: usize) -> Option<bool> {
        match self {
            Self::Connected => Some(index > 0),
            Self::Dots => Some(true),
            Self::Itemized => None,
            Self::Separate => Some(index % 2 == 1),
        }
    }
}

/// `VECTOR_LIST …`.
#[derive(Clone, Debug, PartialEq)]
pub struct VectorList {
    /// How the vectors are joined.
    pub class: VectorClass,
    /// In drawing order.
    pub vectors: Vec<Vector>,
}

/// One element of a vector list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector {
    /// In the list's own space; z is 0 for lists written in two dimensions.
    pub at: DVec3,
    /// A line (L) from the vector before, or a dot; false is a move (P). Always what
    /// [`VectorClass::draws`] says, except in itemized lists.
    pub draw: bool,
    /// `I=`: brightness 0 to 1; absent is full.
    pub intensity: Option<f64>,
}

/// `CHARACTERS [x,y[,z]] [STEP dx,dy] 'text'`.
#[derive(Clone, Debug, PartialEq)]
pub struct Characters {
    /// Lower left corner of the first character; the origin unless written.
    pub at: DVec3,
    /// From one character to the next, in character widths and heights; (1, 0) unless written.
    pub step: DVec2,
    /// What is written.
    pub text: Text,
}
