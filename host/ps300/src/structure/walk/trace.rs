//! Where strokes come from, kept while looking for a pick.

use glam::{DVec2, DVec3};

use super::Walk;
use super::state::State;
use crate::language::Dimension;
use crate::names::NameId;
use crate::pick::Picked;
use crate::structure::NodeId;

/// Pick identifiers met in one walk; further ones are left out. Far more than any tree has.
const IDENTIFIERS_MAX: usize = 1 << 16;

/// A stroke's origin, in step with the strokes of the display list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trace {
    /// In [`Traced::sources`].
    pub(crate) source: u32,
    /// From 1 within its list.
    pub(crate) index: i32,
    /// In the node's own space.
    pub(crate) ends: [DVec3; 2],
    /// How far along the line or curve the ends are, 0 to 1.
    pub(crate) along: [f64; 2],
}

/// A data node as the walk met it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source {
    pub(crate) node: NodeId,
    pub(crate) kind: Picked,
    pub(crate) dimension: Dimension,
    pub(crate) identifier: Option<u32>,
    pub(crate) window: Option<[DVec2; 2]>,
    pub(crate) picking: bool,
}

/// Everything a walk noted for a pick.
#[derive(Debug, Default)]
pub(crate) struct Traced {
    pub(crate) traces: Vec<Trace>,
    pub(crate) sources: Vec<Source>,
    /// Each with the one it stands in.
    identifiers: Vec<(NameId, Option<u32>)>,
}

impl Traced {
    /// The identifiers above a source, innermost first.
    pub(crate) fn identifiers(&self, source: &Source) -> impl Iterator<Item = NameId> + '_ {
        let at = |index: Option<u32>| self.identifiers.get(index? as usize);
        std::iter::successors(at(source.identifier), move |(_, outer)| at(*outer)).map(|(name, _)| *name)
    }
}

impl Walk<'_> {
    /// The entry of an identifier inside those above it. Only picks ask for them.
    pub(super) fn identify(&mut self, name: NameId, outer: Option<u32>) -> Option<u32> {
        let traced = self.traced.as_deref_mut()?;
        if traced.identifiers.len() >= IDENTIFIERS_MAX {
            return outer;
        }
        traced.identifiers.push((name, outer));
        Some(traced.identifiers.len() as u32 - 1)
    }

    /// Begins a data node.
    pub(super) fn source(&mut self, node: NodeId, kind: Picked, dimension: Dimension, state: &State) {
        if let Some(traced) = self.traced.as_deref_mut() {
            traced.sources.push(Source {
                node,
                kind,
                dimension,
                identifier: state.identifier,
                window: state.window,
                picking: state.picking,
            });
        }
    }
}
