//! Nodes of the display tree as canonical text: structures, instances, and who refers to whom.

use std::fmt;

use super::data;
use crate::language::{Member, Name, Node};

/// Names with commas between them.
pub(super) struct Joined<'a>(pub(super) &'a [Name]);

/// How many structures are open around a line.
#[derive(Clone, Copy, Default)]
pub(super) struct Indent(pub(super) usize);

impl Indent {
    pub(super) fn deeper(self) -> Self {
        Self(self.0 + 1)
    }
}

impl fmt::Display for Indent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\n{:width$}", "", width = self.0 * 4)
    }
}

pub(super) fn print_node(f: &mut fmt::Formatter<'_>, node: &Node, indent: Indent) -> fmt::Result {
    let inner = indent.deeper();
    match node {
        Node::Nil => f.write_str("NIL"),
        Node::Instance(names) if names.is_empty() => f.write_str("INSTANCE"),
        Node::Instance(names) => write!(f, "INSTANCE OF {}", Joined(names)),
        Node::Structure(members) => print_structure(f, members, indent),
        Node::Function { function, size } => print_function(f, function, *size),
        Node::Operation {
            operation,
            applied_to,
        } => {
            write!(f, "{operation}")?;
            match applied_to {
                None => Ok(()),
                Some(name) if operation.is_condition() => write!(f, " THEN {name}"),
                Some(name) => write!(f, " APPLIED TO {name}"),
            }
        }
        Node::VectorList(list) => write!(f, "VECTOR_LIST {}", data::Listed(list, Some(inner))),
        Node::Characters(characters) => data::print_characters(f, characters),
        Node::Labels(labels) => data::print_labels(f, labels, inner),
        Node::BSpline(curve) => data::print_bspline(f, curve, inner),
        Node::Polynomial(curve) => data::print_polynomial(f, curve, inner),
        Node::Polygons(polygons) => data::print_polygons(f, polygons, inner),
        Node::Attributes(attributes) => data::print_attributes(f, attributes),
        Node::Illumination(light) => data::print_illumination(f, light),
        Node::Pattern(pattern) => data::print_pattern(f, pattern),
        Node::Font(font) => data::print_font(f, font, indent),
        Node::Copy { of, start, count } => {
            write!(f, "COPY {of}")?;
            start.map_or(Ok(()), |start| write!(f, " START={start}"))?;
            count.map_or(Ok(()), |count| write!(f, " COUNT={count}"))
        }
    }
}

pub(super) fn print_function(f: &mut fmt::Formatter<'_>, function: &Name, size: Option<u16>) -> fmt::Result {
    write!(f, "F:{function}")?;
    size.map_or(Ok(()), |size| write!(f, "({size})"))
}

fn print_structure(f: &mut fmt::Formatter<'_>, members: &[Member], indent: Indent) -> fmt::Result {
    let inner = indent.deeper();
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
