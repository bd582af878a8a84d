//! Nodes of the display tree as canonical text.

use std::fmt;

use glam::{DVec2, DVec3};

use super::literal::{affine_rows, numbers, point, quoted, real, rows};
use crate::language::{
    Axis, Boundaries, Characters, Member, Name, Node, Operation, Range, VectorClass, VectorList,
};

/// Names with commas between them.
pub(super) struct Joined<'a>(pub(super) &'a [Name]);

/// How many structures are open around a line.
#[derive(Clone, Copy, Default)]
pub(super) struct Indent(usize);

impl fmt::Display for Indent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\n{:width$}", "", width = self.0 * 4)
    }
}

/// Vector lists longer than this are written one vector a line.
const VECTORS_ON_A_LINE_MAX: usize = 4;

pub(super) fn print_node(f: &mut fmt::Formatter<'_>, node: &Node, indent: Indent) -> fmt::Result {
    match node {
        Node::Nil => f.write_str("NIL"),
        Node::Instance(names) => write!(f, "INSTANCE OF {}", Joined(names)),
        Node::Structure(members) => print_structure(f, members, indent),
        Node::Operation {
            operation,
            applied_to,
        } => {
            write!(f, "{operation}")?;
            match applied_to {
                None => Ok(()),
                Some(name) if matches!(operation, Operation::IfConditionalBit { .. }) => {
                    write!(f, " THEN {name}")
                }
                Some(name) => write!(f, " APPLIED TO {name}"),
            }
        }
        Node::VectorList(list) => print_vector_list(f, list, Indent(indent.0 + 1)),
        Node::Characters(characters) => print_characters(f, characters),
    }
}

fn print_structure(f: &mut fmt::Formatter<'_>, members: &[Member], indent: Indent) -> fmt::Result {
    let inner = Indent(indent.0 + 1);
    f.write_str("BEGIN_STRUCTURE")?;
    for Member { label, node } in members {
        write!(f, "{inner}")?;
        if let Some(label) = label {
            write!(f, "{label} := ")?;
        }
        print_node(f, node, inner)?;
        f.write_str(";")?;
    }
    write!(f, "{indent}END_STRUCTURE")
}

fn print_vector_list(f: &mut fmt::Formatter<'_>, list: &VectorList, indent: Indent) -> fmt::Result {
    let class = match list.class {
        VectorClass::Connected => "CONNECTED",
        VectorClass::Dots => "DOTS",
        VectorClass::Itemized => "ITEMIZED",
        VectorClass::Separate => "SEPARATE",
    };
    write!(f, "VECTOR_LIST {class} N={}", list.vectors.len())?;
    for vector in &list.vectors {
        if list.vectors.len() > VECTORS_ON_A_LINE_MAX {
            write!(f, "{indent}")?;
        } else {
            f.write_str(" ")?;
        }
        if list.class == VectorClass::Itemized {
            f.write_str(if vector.draw { "L " } else { "P " })?;
        }
        f.write_str(&point(vector.at))?;
        if let Some(intensity) = vector.intensity {
            write!(f, " I={}", real(intensity))?;
        }
    }
    Ok(())
}

fn print_characters(f: &mut fmt::Formatter<'_>, characters: &Characters) -> fmt::Result {
    f.write_str("CHARACTERS ")?;
    // By bits: a negative zero is not the default.
    if point(characters.at) != point(DVec3::ZERO) {
        write!(f, "{} ", point(characters.at))?;
    }
    if numbers(&characters.step.to_array()) != numbers(&DVec2::X.to_array()) {
        write!(f, "STEP {} ", numbers(&characters.step.to_array()))?;
    }
    f.write_str(&quoted(&characters.text))
}

impl fmt::Display for Operation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rotate { axis, degrees } => {
                let axis = match axis {
                    Axis::X => "X",
                    Axis::Y => "Y",
                    Axis::Z => "Z",
                };
                write!(f, "ROTATE IN {axis} {}", real(*degrees))
            }
            Self::Translate(by) => write!(f, "TRANSLATE BY {}", point(*by)),
            Self::Scale(by) => {
                let [x, y, z] = by.to_array().map(f64::to_bits);
                let text = if x == y && y == z { real(by.x) } else { point(*by) };
                write!(f, "SCALE BY {text}")
            }
            Self::Matrix2(m) => write!(f, "MATRIX_2x2 {}", rows(&m.transpose().to_cols_array(), 2)),
            Self::Matrix3(m) => write!(f, "MATRIX_3x3 {}", rows(&m.transpose().to_cols_array(), 3)),
            Self::Matrix4x3(m) => write!(f, "MATRIX_4x3 {}", rows(&affine_rows(m), 4)),
            Self::Matrix4(m) => write!(f, "MATRIX_4x4 {}", rows(&m.transpose().to_cols_array(), 4)),
            Self::Look { at, from, up } => {
                write!(f, "LOOK AT {} FROM {}", point(*at), point(*from))?;
                up.map_or(Ok(()), |up| write!(f, " UP {}", point(up)))
            }
            Self::FieldOfView { degrees, boundaries } => {
                write!(f, "FIELD_OF_VIEW {}", real(*degrees))?;
                print_boundaries(f, boundaries.as_ref())
            }
            Self::Window { x, y, boundaries } => {
                write!(f, "WINDOW X={x} Y={y}")?;
                print_boundaries(f, boundaries.as_ref())
            }
            Self::Viewport {
                horizontal,
                vertical,
                intensity,
            } => {
                write!(f, "VIEWPORT HORIZONTAL={horizontal} VERTICAL={vertical}")?;
                intensity.map_or(Ok(()), |range| write!(f, " INTENSITY={range}"))
            }
            attribute => print_attribute(f, attribute),
        }
    }
}

fn print_attribute(f: &mut fmt::Formatter<'_>, operation: &Operation) -> fmt::Result {
    let state = |on: bool| if on { "ON" } else { "OFF" };
    match operation {
        Operation::SetColor { hue_deg, saturation } => {
            write!(f, "SET COLOR {},{}", real(*hue_deg), real(*saturation))
        }
        Operation::SetIntensity { on, range } => write!(f, "SET INTENSITY {} {range}", state(*on)),
        Operation::SetDepthClipping(on) => write!(f, "SET DEPTH_CLIPPING {}", state(*on)),
        Operation::SetPicking(on) => write!(f, "SET PICKING {}", state(*on)),
        Operation::SetPickingIdentifier(name) => write!(f, "SET PICKING IDENTIFIER={name}"),
        Operation::SetConditionalBit { bit, on } => write!(f, "SET CONDITIONAL_BIT {bit} {}", state(*on)),
        Operation::IfConditionalBit { bit, on } => write!(f, "IF CONDITIONAL_BIT {bit} IS {}", state(*on)),
        transform => unreachable!("{transform:?} is printed with the transforms"),
    }
}

fn print_boundaries(f: &mut fmt::Formatter<'_>, boundaries: Option<&Boundaries>) -> fmt::Result {
    boundaries.map_or(Ok(()), |boundaries| {
        write!(
            f,
            " FRONT BOUNDARY={} BACK BOUNDARY={}",
            real(boundaries.front),
            real(boundaries.back)
        )
    })
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", real(self.from), real(self.to))
    }
}
