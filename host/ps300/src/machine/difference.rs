//! What differs between this machine and the one a program made, and the changes that leave no difference.
//!
//! Things are compared by name: what is defined alike stays, everything else goes and is made anew. How they are
//! arranged and joined comes after, in `arrangement`.

use std::collections::{BTreeMap, BTreeSet};

use super::Machine;
use super::define::Kept;
use crate::language::{Command, Definition, Input, Name, Node};
use crate::names::{NameId, Owner, Thing};
use crate::network::{InstanceId, Made as Place, Role};
use crate::structure::NodeId;
use crate::value::Value;

/// A definition, to be compared: its kind for functions and variables, the commands for display nodes.
#[derive(PartialEq)]
enum Made {
    Function(&'static str, Option<u8>),
    Variable,
    Node(Vec<Command>),
}

/// Something that commands have defined, apart from members of structures.
struct Listed {
    name: Name,
    entry: NameId,
    thing: Thing,
    made: Made,
    /// False after FORGET.
    known: bool,
    /// The command that made it, where that has a place in a text of its own.
    place: Option<Place>,
}

/// What a display node was told, for one that is made alike again.
struct Carried {
    name: Name,
    node: Node,
    told: Vec<(Input, Value)>,
    remembered: Vec<Value>,
}

/// What became of the things of a program.
pub(super) struct Remade {
    /// The names of what was made anew and has to be told what the program tells it.
    pub(super) anew: BTreeSet<Name>,
    forgotten: Vec<NameId>,
}

impl Machine {
    /// Leaves no difference to `wanted` but what its messages have done. Constants are changed where they differ
    /// from `before`, or without it where no wire feeds them. Names that the program forgets are known until
    /// [`Machine::forget_remade`].
    pub(super) fn become_like(&mut self, wanted: &Self, before: Option<&Self>) -> Remade {
        self.end_groups();
        self.settle();
        let new = wanted.listed();
        let (kept, carried, mut anew) = self.take_away(wanted, &new);
        for listed in new.iter().filter(|listed| anew.contains(&listed.name)) {
            self.execute_made(listed.place.clone(), |machine| machine.make_alike(listed, &kept));
        }
        let made = new.iter().filter(|listed| anew.contains(&listed.name));
        let labels: Vec<Name> = made.flat_map(|listed| wanted.labels_in(listed.thing)).collect();
        anew.extend(labels);
        for name in kept.keys() {
            anew.remove(name);
        }
        for carried in carried {
            if self.carry(&carried) {
                anew.remove(&carried.name);
            }
        }
        self.rearrange(wanted);
        self.dash_alike(wanted);
        self.set_constants(wanted, before, &anew);
        self.set_panel(wanted, before);
        self.show_alike(wanted);
        let forgotten = new.iter().filter(|listed| !listed.known);
        let forgotten = forgotten
            .filter_map(|listed| self.names.find(&listed.name))
            .collect();
        self.topology += 1;
        let firings = self.network.limits.firings_per_command;
        super::with_network!(self, |network, around| network.run_command(firings, around));
        Remade { anew, forgotten }
    }

    /// Takes the names from what the program forgets, once everything is told.
    pub(super) fn forget_remade(&mut self, remade: &Remade) {
        for &entry in &remade.forgotten {
            if self.names.denoted(entry).is_some() {
                self.names.forget(entry);
            }
        }
    }

    fn listed(&self) -> Vec<Listed> {
        let defined = self.names.defined().into_iter();
        let commands = defined.filter(|&entry| self.names.entry(entry).owner == Owner::Commands);
        commands.filter_map(|entry| self.listed_as(entry)).collect()
    }

    fn listed_as(&self, entry: NameId) -> Option<Listed> {
        let name = self.names.spelling(entry);
        let thing = self.names.denoted(entry)?;
        let made = match thing {
            Thing::Instance(id) => {
                let instance = self.network.instance(id)?;
                match instance.role {
                    Role::Variable => Made::Variable,
                    _ => Made::Function(instance.spec.name, instance.size),
                }
            }
            Thing::Node(id) => {
                let mut commands = Vec::new();
                self.print_node(id, &name, &mut commands);
                Made::Node(commands)
            }
            Thing::Sink(_) => return None,
        };
        let known = self.names.entry(entry).known;
        let place = self.names.entry(entry).made.clone();
        Some(Listed {
            name,
            entry,
            thing,
            made,
            known,
            place: place.filter(|place| !place.source.is_empty()),
        })
    }

    /// Deletes what is not wanted or not as it is. Returns functions that changed structures keep, what changed
    /// nodes were told, and the names of all that is to be made.
    fn take_away(&mut self, wanted: &Self, new: &[Listed]) -> (Kept, Vec<Carried>, BTreeSet<Name>) {
        let old = self.listed();
        let by_name: BTreeMap<&Name, &Listed> = new.iter().map(|listed| (&listed.name, listed)).collect();
        let mut anew: BTreeSet<Name> = new.iter().map(|listed| listed.name.clone()).collect();
        let (mut kept, mut carried, mut gone) = (Kept::new(), Vec::new(), Vec::new());
        for listed in &old {
            let alike = by_name.get(&listed.name);
            if !listed.known && alike.is_some_and(|new| new.known) {
                self.names.remember(listed.entry);
            }
            if alike.is_some_and(|new| new.made == listed.made) {
                anew.remove(&listed.name);
                continue;
            }
            gone.push(listed.entry);
            if let (Thing::Node(id), Some(_)) = (listed.thing, alike) {
                kept.extend(self.functions_alike(id, wanted));
                carried.extend(self.carried(id, &listed.name));
            }
        }
        self.delete_all_but(&gone, &kept);
        for name in &anew {
            self.names.revive(name);
        }
        (kept, carried, anew)
    }

    /// The functions of a structure that a structure of `wanted` has as well.
    fn functions_alike(&self, structure: NodeId, wanted: &Self) -> Vec<(Name, InstanceId)> {
        let function = |machine: &Self, label: &Name| match machine.names.thing(label) {
            Some(Thing::Instance(id)) => {
                let entry = machine.names.find(label)?;
                let housed = machine.names.entry(entry).owner == Owner::Structure;
                let instance = machine.network.instance(id).filter(|_| housed)?;
                Some((id, instance.spec.name, instance.size))
            }
            _ => None,
        };
        let alike = |label: Name| {
            let (id, name, size) = function(self, &label)?;
            let (_, wanted_name, wanted_size) = function(wanted, &label)?;
            (name == wanted_name && size == wanted_size).then_some((label, id))
        };
        self.structure
            .functions(structure)
            .into_iter()
            .filter_map(alike)
            .collect()
    }

    /// What a node and its labelled members were told.
    fn carried(&self, id: NodeId, name: &Name) -> Vec<Carried> {
        let mut nodes = vec![(name.clone(), id)];
        nodes.extend(self.labelled(id));
        let carried = nodes.into_iter().map(|(name, id)| Carried {
            name,
            node: self.structure.describe(id, &self.names),
            told: self.structure.told(id).to_vec(),
            remembered: self.structure.remembered(id),
        });
        carried.collect()
    }

    /// The labelled nodes inside a structure, by full name.
    fn labelled(&self, id: NodeId) -> Vec<(Name, NodeId)> {
        let labels = self.structure.labels(id).into_iter();
        labels
            .filter_map(|name| match self.names.thing(&name) {
                Some(Thing::Node(id)) => Some((name, id)),
                _ => None,
            })
            .collect()
    }

    fn labels_in(&self, thing: Thing) -> Vec<Name> {
        match thing {
            Thing::Node(id) => self.structure.labels(id),
            _ => Vec::new(),
        }
    }

    fn make_alike(&mut self, listed: &Listed, kept: &Kept) {
        let name = &listed.name;
        // It could be made in the other machine, of the same bounds, so it can be made here.
        let _ = match &listed.made {
            Made::Function(function, size) => {
                self.define_function(name, &Name::new(function), size.map(u16::from))
            }
            Made::Variable => self.define_variable(name),
            Made::Node(commands) => commands.iter().try_for_each(|command| match command {
                Command::Define {
                    name,
                    definition: Definition::Node(node),
                } => self.define_node_keeping(name, node, kept),
                other => self.take_effect(other),
            }),
        };
    }

    /// Tells a node what one like it was told before; false if it is not like it.
    fn carry(&mut self, carried: &Carried) -> bool {
        let Some(Thing::Node(id)) = self.names.thing(&carried.name) else {
            return false;
        };
        let alike = match (self.structure.describe(id, &self.names), &carried.node) {
            (
                Node::Operation { operation, .. },
                Node::Operation {
                    operation: before, ..
                },
            ) => operation == *before,
            (Node::Structure(_), _) => false,
            (node, before) => node == *before,
        };
        if alike {
            for (input, value) in &carried.told {
                // A node alike took it.
                let _ = self.structure.feed(id, *input, value);
            }
            if !carried.remembered.is_empty() {
                self.structure.recall(id, &carried.remembered);
            }
        }
        alike
    }

    /// What a change from `before` to this machine reversed from new to used: what had been made anew under the
    /// same name and kind.
    pub(super) fn made_used(&self, before: &Self) -> BTreeSet<Name> {
        let called = before.called();
        let was_new = |name: &Name| called.get(name).is_some_and(|&thing| before.is_as_new(thing));
        let mut used: BTreeSet<Name> = BTreeSet::new();
        for (name, thing) in self.called() {
            if !self.is_as_new(thing) && was_new(&name) {
                used.insert(name);
            }
        }
        used
    }

    /// Whether nothing was ever sent to a thing, as far as one can see.
    fn is_as_new(&self, thing: Thing) -> bool {
        match thing {
            Thing::Instance(id) => self.network.instance(id).is_none_or(|instance| {
                let mut inputs = 1..=instance.input_count() as u8;
                instance.remembered().is_empty()
                    && inputs.all(|input| {
                        instance.changed_cness(input).is_none()
                            && instance.held_if_set(input).is_none()
                            && instance.queued(input).next().is_none()
                    })
            }),
            Thing::Node(id) => self.structure.told(id).is_empty() && self.structure.remembered(id).is_empty(),
            Thing::Sink(_) => true,
        }
    }
}
