//! The display tree as commands describe it: operations, instances, data, structures.
//!
//! Apart from `command` because the display tree of the machine is made of the same parts; one file for
//! each sort of data.
//! Source: `docs/protocols/ps300.md`, sections "Modelling transforms and viewing", "Attributes,
//! conditionals", "Data nodes" and "Rendering".

mod characters;
mod curve;
mod font;
mod operation;
mod pattern;
mod polygon;
mod surface;
mod vectors;

pub use characters::{Characters, Label, Labels};
pub use curve::{BSpline, Polynomial};
pub use font::{Font, Glyph, GlyphVector};
pub use operation::{Axis, Boundaries, Comparison, Operation, Range};
pub use pattern::Pattern;
pub use polygon::{Polygon, PolygonVertex};
pub use surface::{Attributes, Illumination, Surface, SurfaceColor};
pub use vectors::{Dimension, Vector, VectorClass, VectorList};

use super::Name;

/// What a name in the display tree denotes.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// `NIL`: a name with nothing below it.
    Nil,
    /// `INSTANCE OF a,b`: all of these, in this order.
    Instance(Vec<Name>),
    /// `BEGIN_STRUCTURE … END_STRUCTURE`. An operation without `applied_to` applies to all members after it.
    Structure(Vec<Member>),
    /// `F:TYPE` or `F:TYPE(k)` as a labelled member of a structure, and nowhere else: the function instance
    /// `structure.label`, which comes and goes with the structure. This project's own.
    Function {
        /// The type without `F:`.
        function: Name,
        /// The number of inputs or outputs, for the types that have it.
        size: Option<u16>,
    },
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
    /// Several short texts, each with a place of its own.
    Labels(Labels),
    /// A curve by control points.
    BSpline(BSpline),
    /// A curve by coefficients.
    Polynomial(Polynomial),
    /// Faces. Never empty.
    Polygons(Vec<Polygon>),
    /// How faces look; polygons refer to it by name.
    Attributes(Attributes),
    /// A light.
    Illumination(Illumination),
    /// How lines are dashed; the command PATTERN … WITH refers to it by name.
    Pattern(Pattern),
    /// The shapes of characters; CHARACTER FONT refers to it by name.
    Font(Font),
    /// `COPY a [START=i] [COUNT=k]`: the elements of a data node as they are when the command is executed.
    Copy {
        /// A data node.
        of: Name,
        /// The first element copied, from 1; the first there is unless written.
        start: Option<u32>,
        /// How many; all from there on unless written.
        count: Option<u32>,
    },
}

/// One element of a structure. The label is reached from outside as `structure.label`.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Without dots; a function always has one.
    pub label: Option<Name>,
    /// What the element is.
    pub node: Node,
}
