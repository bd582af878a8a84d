//! Commands that take away: DELETE and FORGET, and every definition that replaces another.

use std::collections::BTreeSet;

use super::Machine;
use super::define::Kept;
use super::execute::Done;
use crate::language::Name;
use crate::names::{NameId, Owner, Thing};
use crate::network::InstanceId;
use crate::structure::NodeId;

impl Machine {
    pub(super) fn delete(&mut self, name: &Name) -> Done {
        self.free(name)?;
        self.thing(name)?;
        self.clear(name);
        Ok(())
    }

    /// Deletes what entries denote, except devices and host parameters.
    pub(super) fn delete_all(&mut self, entries: &[NameId]) {
        self.delete_all_but(entries, &Kept::new());
    }

    /// The same, leaving those functions of structures that are kept. They have no name until a structure takes
    /// them over.
    pub(super) fn delete_all_but(&mut self, entries: &[NameId], kept: &Kept) {
        let mut instances = BTreeSet::new();
        let mut nodes = BTreeSet::new();
        for &entry in entries {
            if self.names.entry(entry).owner != Owner::Commands {
                continue; // Labels go with their structure; devices and host parameters stay.
            }
            match self.names.entry(entry).thing {
                Some(Thing::Instance(id)) => {
                    instances.insert(id);
                }
                Some(Thing::Node(id)) => {
                    instances.extend(self.drop_functions(id, kept));
                    nodes.extend(self.structure.remove(id));
                }
                _ => {}
            }
            self.names.clear(entry);
        }
        if nodes.len() > 1 {
            self.drop_labels(&nodes);
        }
        instances.extend(self.drop_senders(&nodes));
        self.network.remove(&instances, &nodes);
    }

    /// Takes the names from the functions of a structure; returns those that go with it.
    fn drop_functions(&mut self, structure: NodeId, kept: &Kept) -> Vec<InstanceId> {
        let mut gone = Vec::new();
        for label in self.structure.functions(structure) {
            if let Some(entry) = self.names.find(&label)
                && let Some(Thing::Instance(id)) = self.names.denoted(entry)
            {
                self.names.clear(entry);
                if !kept.contains_key(&label) {
                    gone.push(id);
                }
            }
        }
        gone
    }

    /// Labels of deleted structures denote nothing any more.
    fn drop_labels(&mut self, gone: &BTreeSet<NodeId>) {
        for entry in self.names.defined() {
            if self.names.node(entry).is_some_and(|node| gone.contains(&node)) {
                self.names.clear(entry);
            }
        }
    }

    pub(super) fn forget(&mut self, name: &Name) -> Done {
        self.free(name)?;
        let thing = self.thing(name)?;
        let Some(entry) = self.names.find(name) else {
            return Ok(());
        };
        let kept = match thing {
            Thing::Instance(id) => self.network.is_fed(id),
            Thing::Node(_) | Thing::Sink(_) => {
                self.names.entry(entry).referenced || self.displayed.contains(&entry)
            }
        };
        if !kept {
            self.delete_all(&[entry]);
        }
        self.names.forget(entry);
        Ok(())
    }
}
