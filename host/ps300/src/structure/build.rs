//! From nodes as commands describe them to nodes of the tree, and back.

use super::effect::Effect;
use super::{Body, Change, Drawn, NoView, NodeId, Structure};
use crate::language::{Member, Name, Node, Operation};
use crate::names::Names;

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
    pub(crate) fn new(operation: Operation) -> Result<Self, NoView> {
        let effect = Effect::of(&operation)?;
        Ok(Self { operation, effect })
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
            Node::Operation { operation, .. } => Ok(Effect::of(operation).map(|_| ())?),
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
            } => Body::Operation {
                change: Change::new(operation.clone())?,
                applied_to: applied_to.as_ref().map(|name| names.refer(name)),
            },
            Node::VectorList(list) => Body::Vectors(Drawn::new(list.clone())),
            Node::Characters(characters) => Body::Characters(Drawn::new(characters.clone())),
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
            node => Body::Unseen(node.clone()),
        };
        Ok(self.add(name.clone(), body))
    }

    /// The same with data as messages have left it.
    pub(crate) fn describe_now(&self, id: NodeId, names: &Names) -> Node {
        match self.slot(id).map(|slot| &slot.body) {
            Some(Body::Vectors(list)) => Node::VectorList(list.now().clone()),
            Some(Body::Characters(characters)) => Node::Characters(characters.now().clone()),
            _ => self.describe(id, names),
        }
    }

    /// The node as a command would describe it now. What messages changed is not part of it.
    pub(crate) fn describe(&self, id: NodeId, names: &Names) -> Node {
        let spelt = |id: &crate::names::NameId| names.spelling(*id);
        match self.slot(id).map(|slot| &slot.body) {
            None | Some(Body::Nil) => Node::Nil,
            Some(Body::Instance(of)) => Node::Instance(of.iter().map(spelt).collect()),
            Some(Body::Operation { change, applied_to }) => Node::Operation {
                operation: change.operation.clone(),
                applied_to: applied_to.as_ref().map(spelt),
            },
            Some(Body::Vectors(list)) => Node::VectorList(list.written.clone()),
            Some(Body::Characters(characters)) => Node::Characters(characters.written.clone()),
            Some(Body::Unseen(node)) => node.clone(),
            Some(Body::Structure(members)) => Node::Structure(
                members
                    .iter()
                    .map(|(label, id)| Member {
                        label: label.clone(),
                        node: self.describe(*id, names),
                    })
                    .collect(),
            ),
        }
    }
}
