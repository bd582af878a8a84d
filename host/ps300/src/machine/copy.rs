//! COPY: data taken from another node as messages have left it, when the definition is executed.
//!
//! The copy is a node of its own: what becomes of the original later does not change it, and the program that
//! is written of it has the data, not the command.

use super::{ExecuteError, Machine};
use crate::language::{Characters, Labels, Member, Name, Node, VectorList};
use crate::names::Thing;

impl Machine {
    /// A definition with the data that it copies in it; nothing if it copies none.
    pub(super) fn with_copies(&self, node: &Node) -> Result<Option<Node>, ExecuteError> {
        match node {
            Node::Copy { of, start, count } => self.copied(of, *start, *count).map(Some),
            Node::Structure(members) => {
                let mut copied = None;
                for (at, Member { node, .. }) in members.iter().enumerate() {
                    if let Some(node) = self.with_copies(node)? {
                        copied.get_or_insert_with(|| members.clone())[at].node = node;
                    }
                }
                Ok(copied.map(Node::Structure))
            }
            _ => Ok(None),
        }
    }

    fn copied(&self, of: &Name, start: Option<u32>, count: Option<u32>) -> Result<Node, ExecuteError> {
        let thing = self.thing(of)?;
        let not = |wanted| ExecuteError::NotA {
            name: of.clone(),
            is: self.what_is(thing),
            wanted,
        };
        let Thing::Node(id) = thing else {
            return Err(not("part of the display tree"));
        };
        let first = start.map_or(0, |start| start.saturating_sub(1) as usize);
        let most = count.map_or(usize::MAX, |count| count as usize);
        match self.structure.describe_now(id, &self.names) {
            Node::VectorList(list) => Ok(Node::VectorList(some_vectors(list, first, most))),
            Node::Characters(from) => Ok(Node::Characters(Characters {
                text: from
                    .text
                    .chars()
                    .skip(first)
                    .take(most)
                    .collect::<String>()
                    .into(),
                ..from
            })),
            Node::Labels(from) => Ok(Node::Labels(Labels {
                labels: from.labels.into_iter().skip(first).take(most).collect(),
            })),
            node @ (Node::BSpline(_) | Node::Polynomial(_) | Node::Polygons(_) | Node::Pattern(_))
                if start.is_none() && count.is_none() =>
            {
                Ok(node)
            }
            Node::BSpline(_) | Node::Polynomial(_) | Node::Polygons(_) | Node::Pattern(_) => Err(not(
                "a list that can be copied in part; leave START and COUNT out",
            )),
            _ => Err(not("data that can be copied")),
        }
    }
}

/// Part of a list, drawn as its class says: the first of a part is moved to where it cannot be drawn to.
fn some_vectors(list: VectorList, first: usize, most: usize) -> VectorList {
    let class = list.class;
    let vectors = list.vectors.into_iter().skip(first).take(most).enumerate();
    let vectors = vectors.map(|(at, mut vector)| {
        vector.draw = class.draws(at).unwrap_or(vector.draw && at > 0);
        vector
    });
    VectorList {
        vectors: vectors.collect(),
        ..list
    }
}
