//! How things are arranged and joined, made as another machine has it: order, wires, constants, labels, and what
//! is displayed.
//!
//! Apart from `difference`, which sees to it that both machines have the same things.

use std::collections::{BTreeMap, BTreeSet};

use super::Machine;
use crate::language::{Input, Name};
use crate::names::{NameId, Thing};
use crate::network::{Inlet, InstanceId, Numbered, Outlet, Role};
use crate::value::Value;

impl Machine {
    /// Everything that has a name, by the name a program calls it.
    pub(super) fn called(&self) -> BTreeMap<Name, Thing> {
        let defined = self.names.defined().into_iter().filter_map(|entry| {
            let thing = self.names.denoted(entry)?;
            Some((self.names.spelling(entry), thing))
        });
        let fixed = self.names.fixed().map(|(name, thing)| (name.clone(), thing));
        defined.chain(fixed).collect()
    }

    /// Puts definitions and wires in the order of `wanted`.
    pub(super) fn rearrange(&mut self, wanted: &Self) {
        let here = self.called();
        let entries: BTreeMap<Name, NameId> = self
            .names
            .defined()
            .into_iter()
            .map(|entry| (self.names.spelling(entry), entry))
            .collect();
        let order = wanted.names.defined().into_iter();
        let order: Vec<NameId> = order
            .filter_map(|entry| entries.get(&wanted.names.spelling(entry)).copied())
            .collect();
        self.names.reorder(&order);
        let names: BTreeMap<Thing, Name> = wanted
            .called()
            .into_iter()
            .map(|(name, thing)| (thing, name))
            .collect();
        let find = |thing: Thing| here.get(names.get(&thing)?).copied();
        let mut order = Vec::new();
        let mut joined = BTreeSet::new();
        for Numbered { id, instance } in wanted.network.instances() {
            let Some(name) = names.get(&wanted.sends_for(id)) else {
                continue;
            };
            // Only rendering nodes need one, and the same node has one there.
            let _ = self.make_sender(name);
            let Some(from) = here.get(name).and_then(|&thing| self.sender(thing)) else {
                continue;
            };
            joined.insert(from);
            if instance.role != Role::Device {
                order.push(from);
            }
            for output in 1..=instance.output_count() as u8 {
                let to = wanted.network.destinations(Outlet { from: id, output });
                let to: Vec<Inlet> = to.iter().filter_map(|&inlet| translated(inlet, find)).collect();
                let from = Outlet { from, output };
                if self.network.destinations(from) != to {
                    self.network.set_destinations(from, &to);
                }
            }
        }
        let idle = self.senders.values().filter(|sender| !joined.contains(sender));
        for from in idle.copied().collect::<Vec<_>>() {
            self.network.disconnect_all(from);
        }
        self.network.renumber(&order);
    }

    /// Dashes what `wanted` dashes.
    pub(super) fn dash_alike(&mut self, wanted: &Self) {
        let here = self.called();
        for (name, thing) in wanted.called() {
            let (Thing::Node(there), Some(&Thing::Node(id))) = (thing, here.get(&name)) else {
                continue;
            };
            let pattern = wanted.pattern_of(there).map(|entry| wanted.names.spelling(entry));
            let pattern = pattern.map(|name| self.entry_called(&name));
            if self.pattern_of(id) != pattern {
                self.structure.set_pattern(id, pattern);
            }
        }
    }

    pub(super) fn set_constants(&mut self, wanted: &Self, before: Option<&Self>, anew: &BTreeSet<Name>) {
        let here = self.called();
        for (name, thing) in wanted.called() {
            let (Thing::Instance(from), Some(&Thing::Instance(to))) = (thing, here.get(&name)) else {
                continue;
            };
            let Some(from) = wanted.network.instance(from).filter(|_| !anew.contains(&name)) else {
                continue;
            };
            let before = before.map(|before| match before.names.thing(&name) {
                Some(Thing::Instance(id)) => before.network.instance(id),
                _ => None,
            });
            for (input, port) in (1..).zip(from.input_ports()) {
                let Some(now) = self
                    .network
                    .instance(to)
                    .and_then(|it| it.input_ports().get(usize::from(input - 1)))
                else {
                    continue;
                };
                if now.constant != port.constant {
                    self.network.set_constant(to, input, port.constant);
                }
                let value = from.held_if_set(input);
                let held = match before {
                    Some(before) => Some(before.and_then(|it| it.held_if_set(input))),
                    None if from.role == Role::Variable || self.network.is_input_fed(to, input) => None,
                    None => Some(self.network.instance(to).and_then(|it| it.held_if_set(input))),
                };
                let differs = held.is_some_and(|held| held != value);
                if differs && port.constant {
                    self.set_constant(to, input, value);
                }
            }
        }
    }

    fn set_constant(&mut self, to: InstanceId, input: u8, value: Option<&Value>) {
        let Some(value) = value else {
            return self.network.unset(to, input);
        };
        let inlet = Inlet::Function { to, input };
        super::with_network!(self, |network, around| network.deliver(inlet, value, around));
    }

    /// Labels that the program wants otherwise than the one before.
    pub(super) fn set_panel(&mut self, wanted: &Self, before: Option<&Self>) {
        let Some(before) = before else {
            return;
        };
        let first = Input::Number(1);
        for (device, [was, now]) in [
            (
                "DLABEL",
                [&before.panel.dial_labels[..], &wanted.panel.dial_labels[..]],
            ),
            (
                "FLABEL",
                [&before.panel.key_labels[..], &wanted.panel.key_labels[..]],
            ),
        ] {
            for (number, (was, now)) in (1..).zip(was.iter().zip(now)) {
                if was != now {
                    // A label takes any text.
                    let _ = self.deliver(
                        &Name::new(&format!("{device}{number}")),
                        first,
                        &now.as_str().into(),
                    );
                }
            }
        }
    }

    pub(super) fn show_alike(&mut self, wanted: &Self) {
        let names = wanted.displayed.iter().map(|&entry| wanted.names.spelling(entry));
        let displayed: Vec<NameId> = names.map(|name| self.entry_called(&name)).collect();
        if self.displayed != displayed {
            self.displayed = displayed;
            self.structure.revision += 1;
        }
    }

    /// The entry that a program calls so, which FORGET may have taken the name from.
    fn entry_called(&mut self, name: &Name) -> NameId {
        let forgotten = self
            .names
            .defined()
            .into_iter()
            .find(|&entry| !self.names.entry(entry).known && self.names.spelling(entry) == *name);
        forgotten.unwrap_or_else(|| self.names.refer(name))
    }
}

/// The same inlet in another machine.
fn translated(inlet: Inlet, find: impl Fn(Thing) -> Option<Thing>) -> Option<Inlet> {
    match inlet {
        Inlet::Function { to, input } => match find(Thing::Instance(to))? {
            Thing::Instance(to) => Some(Inlet::Function { to, input }),
            _ => None,
        },
        Inlet::Node { to, input } => match find(Thing::Node(to))? {
            Thing::Node(to) => Some(Inlet::Node { to, input }),
            _ => None,
        },
        Inlet::Sink { to, input } => match find(Thing::Sink(to))? {
            Thing::Sink(to) => Some(Inlet::Sink { to, input }),
            _ => None,
        },
    }
}
