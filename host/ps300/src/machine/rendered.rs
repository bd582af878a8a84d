//! What rendering nodes send: a message when a rendering is done.
//!
//! Such a node that somebody is connected to has an instance in the network, of its own name, which passes
//! on what the node was told once it has taken effect. Source: `docs/protocols/ps300.md`, "Codes sent to <1>
//! of a rendering node".

use std::collections::{BTreeMap, BTreeSet};

use super::execute::Done;
use super::{ExecuteError, Machine};
use crate::intrinsic::{Confidence, InputSpec, OutputSpec, Spec};
use crate::language::Name;
use crate::names::Thing;
use crate::network::{InstanceId, Outlet, Role};
use crate::structure::NodeId;
use crate::value::Kinds;

/// Who sends for a node.
pub(super) type Senders = BTreeMap<NodeId, InstanceId>;

pub(super) const MESSAGE: Kinds = Kinds::INTEGER.or(Kinds::BOOLEAN);

static SENDER: Spec = Spec::pure(
    "RENDERED",
    &[InputSpec::active(MESSAGE)],
    &[OutputSpec::of(MESSAGE)],
    |inputs, outputs| {
        outputs.send(1, inputs.get(1).clone());
        Ok(())
    },
)
.says("Output <1> of a rendering node: what the node was told, when it is done.")
.known(
    Confidence::Used,
    "inferred from D0's completion wiring; what is sent ours",
);

impl Machine {
    /// Gives a rendering node its sender before something is connected to it.
    pub(super) fn make_sender(&mut self, name: &Name) -> Done {
        let Some(Thing::Node(node)) = self.names.thing(name) else {
            return Ok(());
        };
        if !self.structure.renders(node) || self.senders.contains_key(&node) {
            return Ok(());
        }
        let written = self
            .structure
            .slot(node)
            .map_or_else(|| name.clone(), |slot| slot.name.clone());
        let Some(sender) = self.network.add(written, &SENDER, None, Role::Node) else {
            return Err(ExecuteError::TooMany {
                max: self.network.limits.instances_max,
            });
        };
        self.senders.insert(node, sender);
        Ok(())
    }

    /// An output that is to be looked at, whether or not anything is connected to it yet.
    pub(super) fn outlet_made(&mut self, name: &str, output: u8) -> Option<Outlet> {
        // Without a sender there is no outlet, which is the answer.
        let _ = self.make_sender(&Name::new(name));
        self.outlet(name, output)
    }

    /// The instance that sends for what a name denotes.
    pub(super) fn sender(&self, thing: Thing) -> Option<InstanceId> {
        match thing {
            Thing::Instance(id) => Some(id),
            Thing::Node(node) => self.senders.get(&node).copied(),
            Thing::Sink(_) => None,
        }
    }

    /// What an instance sends for: a node, or itself.
    pub(super) fn sends_for(&self, id: InstanceId) -> Thing {
        let node = self.senders.iter().find(|(_, sender)| **sender == id);
        node.map_or(Thing::Instance(id), |(&node, _)| Thing::Node(node))
    }

    /// Takes the senders of nodes that go.
    pub(super) fn drop_senders(&mut self, gone: &BTreeSet<NodeId>) -> Vec<InstanceId> {
        gone.iter().filter_map(|node| self.senders.remove(node)).collect()
    }
}
