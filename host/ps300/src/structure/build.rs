//! From nodes as commands describe them to nodes of the tree, and back.

use super::curve::Curve;
use super::effect::Effect;
use super::font::Typeface;
use super::polygon::Polygons;
use super::{Body, Change, Drawn, NoView, NodeId, Structure, effect};
use crate::language::{Member, Name, Node, Operation, Polygon};
use crate::names::{NameId, Names};

/// Why a node could not be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BuildError {
    NoView(&'static str),
    Depth,
}

impl From<NoView> for BuildError {
    fn from(NoView(why): NoView) -> Self {
        Self::NoView(why)
    }
}

/// Structures inside structures deeper than this are refused.
const NESTED_MAX: usize = 64;

impl Change {
    pub(crate) fn new(operation: Operation, names: &mut Names) -> Result<Self, NoView> {
        let effect = Effect::of(&operation, names)?;
        Ok(Self {
            inputs: effect::accepts(&operation),
            operation,
            effect,
        })
    }
}

impl Structure {
    /// Whether `node` can be built, so that a definition either happens or leaves everything as it was.
    pub(crate) fn check(node: &Node) -> Result<(), BuildError> {
        Self::check_nested(node, 0)
    }

    fn check_nested(node: &Node, depth: usize) -> Result<(), BuildError> {
        match node {
            _ if depth > NESTED_MAX => Err(BuildError::Depth),
            Node::Operation { operation, .. } => Ok(Effect::check(operation)?),
            Node::Structure(members) => members
                .iter()
                .try_for_each(|member| Self::check_nested(&member.node, depth + 1)),
            _ => Ok(()),
        }
    }

    /// Makes a node. `labelled` hears of every labelled member with its full name.
    pub(crate) fn build(
        &mut self,
        name: &Name,
        node: &Node,
        names: &mut Names,
        labelled: &mut dyn FnMut(Name, NodeId),
    ) -> Result<NodeId, BuildError> {
        let body = match node {
            Node::Nil => Body::Nil,
            Node::Instance(of) => Body::Instance(of.iter().map(|name| names.refer(name)).collect()),
            Node::Operation {
                operation,
                applied_to,
            } => {
                let change = Change::new(operation.clone(), names)?;
                self.note_rate(&change);
                Body::Operation {
                    change,
                    applied_to: applied_to.as_ref().map(|name| names.refer(name)),
                }
            }
            Node::Structure(members) => {
                let mut nodes = Vec::with_capacity(members.len());
                for Member { label, node } in members {
                    let full = label.as_ref().map(|label| Name::new(&format!("{name}.{label}")));
                    let id = self.build(full.as_ref().unwrap_or(name), node, names, labelled)?;
                    if let Some(full) = full {
                        labelled(full, id);
                    }
                    nodes.push((label.clone(), id));
                }
                Body::Structure(nodes)
            }
            written => data(written.clone(), names),
        };
        Ok(self.add(name.clone(), body))
    }

    /// The same with data as messages have left it.
    pub(crate) fn describe_now(&self, id: NodeId, names: &Names) -> Node {
        match self.slot(id).map(|slot| &slot.body) {
            Some(Body::Vectors { list, .. }) => Node::VectorList(list.now().clone()),
            Some(Body::Curve { curve, .. }) => curve.now().clone().into(),
            Some(Body::Characters(characters)) => Node::Characters(characters.now().clone()),
            Some(Body::Labels(labels)) => Node::Labels(labels.now().clone()),
            _ => self.describe(id, names),
        }
    }

    /// The node as a command would describe it now. What messages changed is not part of it.
    pub(crate) fn describe(&self, id: NodeId, names: &Names) -> Node {
        let spelt = |id: &NameId| names.spelling(*id);
        match self.slot(id).map(|slot| &slot.body) {
            None | Some(Body::Nil) => Node::Nil,
            Some(Body::Instance(of)) => Node::Instance(of.iter().map(spelt).collect()),
            Some(Body::Operation { change, applied_to }) => Node::Operation {
                operation: change.operation.clone(),
                applied_to: applied_to.as_ref().map(spelt),
            },
            Some(Body::Structure(members)) => Node::Structure(
                members
                    .iter()
                    .map(|(label, id)| Member {
                        label: label.clone(),
                        node: self.describe(*id, names),
                    })
                    .collect(),
            ),
            Some(Body::Vectors { list, .. }) => Node::VectorList(list.written.clone()),
            Some(Body::Curve { curve, .. }) => curve.written.clone().into(),
            Some(Body::Characters(characters)) => Node::Characters(characters.written.clone()),
            Some(Body::Labels(labels)) => Node::Labels(labels.written.clone()),
            Some(Body::Polygons(polygons)) => {
                let named = |(polygon, attributes): (&Polygon, &Option<NameId>)| Polygon {
                    attributes: attributes.as_ref().map(spelt),
                    ..polygon.clone()
                };
                Node::Polygons(
                    polygons
                        .written
                        .iter()
                        .zip(&polygons.attributes)
                        .map(named)
                        .collect(),
                )
            }
            Some(Body::Attributes(attributes)) => Node::Attributes(attributes.clone()),
            Some(Body::Illumination(light)) => Node::Illumination(*light),
            Some(Body::Pattern(pattern)) => Node::Pattern(pattern.clone()),
            Some(Body::Font(font)) => Node::Font(font.written.clone()),
            Some(Body::Function { function, size }) => Node::Function {
                function: function.clone(),
                size: *size,
            },
        }
    }
}

/// Data and what data refers to.
fn data(node: Node, names: &mut Names) -> Body {
    match node {
        Node::VectorList(list) => Body::Vectors {
            list: Drawn::new(list),
            pattern: None,
        },
        Node::BSpline(spline) => curve(Curve::BSpline(spline)),
        Node::Polynomial(polynomial) => curve(Curve::Polynomial(polynomial)),
        Node::Characters(characters) => Body::Characters(Drawn::new(characters)),
        Node::Labels(labels) => Body::Labels(Drawn::new(labels)),
        Node::Polygons(polygons) => {
            let named = |polygon: &Polygon| polygon.attributes.as_ref().map(|name| names.refer(name));
            let attributes = polygons.iter().map(named).collect();
            Body::Polygons(Polygons::new(polygons, attributes))
        }
        Node::Attributes(attributes) => Body::Attributes(attributes),
        Node::Illumination(light) => Body::Illumination(light),
        Node::Pattern(pattern) => Body::Pattern(pattern),
        Node::Font(font) => Body::Font(Typeface::new(font)),
        Node::Function { function, size } => Body::Function { function, size },
        Node::Nil | Node::Instance(_) | Node::Structure(_) | Node::Operation { .. } | Node::Copy { .. } => {
            Body::Nil
        } // Built by the caller.
    }
}

fn curve(curve: Curve) -> Body {
    Body::Curve {
        curve: Drawn::new(curve),
        pattern: None,
    }
}
