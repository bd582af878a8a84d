//! Whether a definition would make a part of the tree contain itself.

use std::collections::BTreeSet;

use super::{Body, NodeId, Structure};
use crate::names::{NameId, Names};

/// Whether going down from `from` leads to the entry `goal`.
pub(crate) fn reaches(structure: &Structure, names: &Names, from: NodeId, goal: NameId) -> bool {
    let mut seen = BTreeSet::from([from]);
    let mut open = vec![from];
    let mut below = Vec::new();
    while let Some(id) = open.pop() {
        below.clear();
        match structure.slot(id).map(|slot| &slot.body) {
            Some(Body::Instance(of)) => below.extend_from_slice(of),
            Some(Body::Operation {
                applied_to: Some(name),
                ..
            }) => below.push(*name),
            Some(Body::Structure(members)) => {
                open.extend(
                    members
                        .iter()
                        .map(|(_, member)| *member)
                        .filter(|member| seen.insert(*member)),
                );
            }
            _ => {}
        }
        if below.contains(&goal) {
            return true;
        }
        open.extend(
            below
                .iter()
                .filter_map(|&name| names.node(name))
                .filter(|node| seen.insert(*node)),
        );
    }
    false
}
