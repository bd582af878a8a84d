//! Commands taking effect.

use std::collections::BTreeSet;

use super::{ExecuteError, Machine, numbered_inputs};
use crate::intrinsic;
use crate::language::{
    Command, Definition, Disconnection, Initialization, Input, InputOf, Name, Node, Operation, OutputOf,
    Payload,
};
use crate::names::{NameId, Thing};
use crate::network::{Cause, ConnectError, Inlet, Outlet, Role, input_text};
use crate::structure::{Body, BuildError, Change, NodeId, Structure, reaches};
use crate::value::{Kinds, Value};

type Done = Result<(), ExecuteError>;

impl Machine {
    /// Lets one command take effect, then runs the network. A command that is refused changes nothing.
    pub fn execute(&mut self, command: &Command) -> Result<(), ExecuteError> {
        self.take_effect(command)?;
        self.run();
        Ok(())
    }

    fn take_effect(&mut self, command: &Command) -> Done {
        match command {
            Command::Define {
                name,
                definition: Definition::Function { function, size },
            } => self.define_function(name, function, *size),
            Command::Define {
                name,
                definition: Definition::Node(node),
            } => self.define_node(name, node),
            Command::Variable(names) => names.iter().try_for_each(|name| self.define_variable(name)),
            Command::Connect { from, to } => self.connect(from, to),
            Command::Disconnect(what) => self.disconnect(what),
            Command::Send { payload, to } | Command::Store { payload, to } => {
                let value = match payload {
                    Payload::Value(value) => value.clone(),
                    Payload::Variable(name) => self.variable(name)?,
                };
                self.deliver(&to.name, to.input, &value)
            }
            Command::SetupCness { constant, input } => self.setup_cness(*constant, input),
            Command::Include { member, instance } => self.include(member, instance),
            Command::RemoveFrom { member, instance } => self.remove_from(member, instance),
            Command::Display(name) => self.show(name),
            Command::Remove(name) => self.hide(name),
            Command::Delete(name) => self.delete(name),
            Command::DeleteAll { prefix } => {
                let found = self.names.beginning(prefix);
                self.delete_all(&found);
                Ok(())
            }
            Command::Forget(name) => self.forget(name),
            Command::Follow { name, with } => self.insert(name, with, |slot| &mut slot.below, true),
            Command::Prefix { name, with } => self.insert(name, with, |slot| &mut slot.above, false),
            Command::Initialize(what) => {
                self.initialize(*what);
                Ok(())
            }
        }
    }

    fn unknown(&self, name: &Name) -> ExecuteError {
        ExecuteError::Unknown {
            name: name.clone(),
            alike: self.names.alike(name),
        }
    }

    fn thing(&self, name: &Name) -> Result<Thing, ExecuteError> {
        self.names.thing(name).ok_or_else(|| self.unknown(name))
    }

    pub(super) fn what_is(&self, thing: Thing) -> &'static str {
        match thing {
            Thing::Node(_) => "part of the display tree",
            Thing::Sink(_) => "an output of the machine to its host",
            Thing::Instance(id) => match self.network.instance(id).map(|instance| instance.role) {
                Some(Role::Device) => "a device of the machine",
                Some(Role::Variable) => "a variable",
                _ => "a function instance",
            },
        }
    }

    /// Refuses names that commands may not give a new meaning.
    fn free(&self, name: &Name) -> Done {
        match self.names.find(name).map(|id| self.names.entry(id)) {
            Some(entry) if entry.fixed => {
                let is = entry.thing.map_or("reserved", |thing| self.what_is(thing));
                Err(ExecuteError::Fixed {
                    name: name.clone(),
                    is,
                })
            }
            Some(entry) if entry.label => Err(ExecuteError::Fixed {
                name: name.clone(),
                is: "a label inside a structure",
            }),
            _ => Ok(()),
        }
    }

    fn define_function(&mut self, name: &Name, function: &Name, size: Option<u16>) -> Done {
        self.free(name)?;
        let Some(spec) = intrinsic::find(function.as_str()) else {
            return Err(no_function(function));
        };
        let size = match (spec.sizes, size) {
            (None, None) => None,
            (Some((least, most)), Some(size)) if (u16::from(least)..=u16::from(most)).contains(&size) => {
                Some(size as u8)
            }
            (Some((least, most)), _) => {
                let wanted = format!("needs a size from {least} to {most}: F:{}({least})", spec.name);
                return Err(ExecuteError::Size {
                    function: spec.name,
                    wanted,
                });
            }
            (None, Some(_)) => {
                let wanted = "has no size; leave the brackets out".to_owned();
                return Err(ExecuteError::Size {
                    function: spec.name,
                    wanted,
                });
            }
        };
        self.make(name, spec, size, Role::Function)
    }

    fn define_variable(&mut self, name: &Name) -> Done {
        self.free(name)?;
        self.make(name, &intrinsic::VARIABLE, None, Role::Variable)
    }

    fn make(&mut self, name: &Name, spec: &'static intrinsic::Spec, size: Option<u8>, role: Role) -> Done {
        self.clear(name);
        let written = self.written(name);
        let Some(id) = self.network.add(written, spec, size, role) else {
            return Err(ExecuteError::TooMany {
                max: self.network.limits.instances_max,
            });
        };
        self.names.define(name, Thing::Instance(id));
        Ok(())
    }

    /// The spelling a name was first given.
    fn written(&self, name: &Name) -> Name {
        self.names
            .find(name)
            .map_or_else(|| name.clone(), |id| self.names.entry(id).name.clone())
    }

    fn define_node(&mut self, name: &Name, node: &Node) -> Done {
        self.free(name)?;
        Structure::check(node).map_err(|error| build_error(name, error))?;
        let written = self.written(name);
        let mut labelled = Vec::new();
        let built = self
            .structure
            .build(&written, node, &mut self.names, &mut |full, id| {
                labelled.push((full, id));
            });
        let id = built.map_err(|error| build_error(name, error))?;
        let contains_itself = match self.names.find(name) {
            Some(entry) if self.names.entry(entry).referenced => {
                reaches(&self.structure, &self.names, id, entry)
            }
            _ => false,
        };
        let taken = labelled.iter().find(|(full, _)| {
            self.names
                .find(full)
                .is_some_and(|entry| self.names.entry(entry).fixed)
        });
        if contains_itself || taken.is_some() {
            self.structure.remove(id);
            return match taken {
                Some((full, _)) => self.free(full),
                None => Err(ExecuteError::Cycle { name: name.clone() }),
            };
        }
        self.clear(name);
        self.names.define(name, Thing::Node(id));
        for (full, id) in labelled {
            self.clear(&full);
            self.names.define_label(&full, id);
        }
        Ok(())
    }

    /// Removes what a name denotes, with its members and connections, so that it can denote anew.
    fn clear(&mut self, name: &Name) {
        if let Some(id) = self.names.find(name) {
            self.delete_all(&[id]);
        }
    }

    fn delete(&mut self, name: &Name) -> Done {
        self.free(name)?;
        self.thing(name)?;
        self.clear(name);
        Ok(())
    }

    /// Deletes what entries denote, except devices and host parameters.
    fn delete_all(&mut self, entries: &[NameId]) {
        let mut instances = BTreeSet::new();
        let mut nodes = BTreeSet::new();
        for &entry in entries {
            if self.names.entry(entry).fixed || self.names.entry(entry).label {
                continue; // Labels go with their structure.
            }
            match self.names.entry(entry).thing {
                Some(Thing::Instance(id)) => {
                    instances.insert(id);
                }
                Some(Thing::Node(id)) => nodes.extend(self.structure.remove(id)),
                _ => {}
            }
            self.names.clear(entry);
        }
        if !nodes.is_empty() {
            self.drop_labels(&nodes);
        }
        self.network.remove(&instances, &nodes);
    }

    /// Labels of deleted structures denote nothing any more.
    fn drop_labels(&mut self, gone: &BTreeSet<NodeId>) {
        for entry in self.names.defined() {
            if self.names.node(entry).is_some_and(|node| gone.contains(&node)) {
                self.names.clear(entry);
            }
        }
    }

    fn forget(&mut self, name: &Name) -> Done {
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

    fn initialize(&mut self, what: Initialization) {
        if matches!(what, Initialization::Display | Initialization::Everything) {
            self.displayed.clear();
            self.structure.revision += 1;
        }
        if matches!(what, Initialization::Connections | Initialization::Everything) {
            self.network.disconnect_everything();
        }
        if matches!(what, Initialization::Names | Initialization::Everything) {
            let all = self.names.defined();
            self.delete_all(&all);
        }
    }

    fn outlet_of(&self, from: &OutputOf) -> Result<Outlet, ExecuteError> {
        match self.thing(&from.name)? {
            Thing::Instance(id) => self.network.outlet(id, from.output).ok_or_else(|| {
                let has = self
                    .network
                    .instance(id)
                    .map_or(0, |instance| instance.output_count());
                ConnectError::NoOutput {
                    name: from.name.clone(),
                    output: from.output,
                    has,
                }
                .into()
            }),
            other => {
                let is = self.what_is(other);
                Err(ExecuteError::NotA {
                    name: from.name.clone(),
                    is,
                    wanted: "something that sends",
                })
            }
        }
    }

    /// Where messages to an input go, and what it takes.
    fn inlet_of(&self, name: &Name, input: Input) -> Result<(Inlet, Kinds), ExecuteError> {
        let thing = self.thing(name)?;
        let numbered = match input {
            Input::Number(number) => u8::try_from(number).ok(),
            _ => None,
        };
        let (found, has) = match thing {
            Thing::Instance(to) => {
                let kinds = numbered.and_then(|input| self.network.accepts(to, input));
                let inlet = numbered.map(|input| Inlet::Function { to, input });
                let count = self
                    .network
                    .instance(to)
                    .map_or(0, |instance| instance.input_count());
                (inlet.zip(kinds), numbered_inputs(count))
            }
            Thing::Sink(to) => {
                let sink = self.network.sink(to);
                let port = numbered.and_then(|n| sink?.inputs.get(usize::from(n).checked_sub(1)?));
                let inlet = numbered.map(|input| Inlet::Sink { to, input });
                let count = sink.map_or(0, |sink| sink.inputs.len());
                (inlet.zip(port.map(|port| port.kinds)), numbered_inputs(count))
            }
            Thing::Node(to) => {
                let kinds = self.structure.accepts(to, input);
                (
                    kinds.map(|kinds| (Inlet::Node { to, input }, kinds)),
                    self.structure.inputs_text(to),
                )
            }
        };
        found.ok_or_else(|| {
            ConnectError::NoInput {
                name: name.clone(),
                input: input_text(input),
                has,
            }
            .into()
        })
    }

    fn connect(&mut self, from: &OutputOf, to: &InputOf) -> Done {
        let outlet = self.outlet_of(from)?;
        let (inlet, accepted) = self.inlet_of(&to.name, to.input)?;
        if !self.network.connect(outlet, inlet, accepted)? {
            let other = format!("{}{}", input_text(to.input), to.name);
            self.note(
                &from.name,
                &format!("output <{}>", from.output),
                Cause::AlreadyConnected { to: other },
            );
        }
        Ok(())
    }

    fn disconnect(&mut self, what: &Disconnection) -> Done {
        match what {
            Disconnection::Pair { from, to } => {
                let outlet = self.outlet_of(from)?;
                let (inlet, _) = self.inlet_of(&to.name, to.input)?;
                if !self.network.disconnect(outlet, inlet)? {
                    let what = format!(
                        "{}<{}> is not connected to {}{}",
                        from.name,
                        from.output,
                        input_text(to.input),
                        to.name
                    );
                    return Err(ExecuteError::Nothing { what });
                }
            }
            Disconnection::Output(from) => {
                let outlet = self.outlet_of(from)?;
                self.network.disconnect_output(outlet)?;
            }
            Disconnection::All(name) => match self.thing(name)? {
                Thing::Instance(id) => self.network.disconnect_all(id),
                other => {
                    let is = self.what_is(other);
                    let wanted = "something that sends";
                    return Err(ExecuteError::NotA {
                        name: name.clone(),
                        is,
                        wanted,
                    });
                }
            },
        }
        Ok(())
    }

    fn variable(&self, name: &Name) -> Result<Value, ExecuteError> {
        match self.thing(name)? {
            Thing::Instance(id)
                if self
                    .network
                    .instance(id)
                    .is_some_and(|it| it.role == Role::Variable) =>
            {
                let held = self.network.held(id).cloned();
                held.ok_or_else(|| ExecuteError::Empty { name: name.clone() })
            }
            other => {
                let is = self.what_is(other);
                Err(ExecuteError::NotA {
                    name: name.clone(),
                    is,
                    wanted: "a variable",
                })
            }
        }
    }

    pub(super) fn deliver(&mut self, name: &Name, input: Input, value: &Value) -> Done {
        let (inlet, expected) = self.inlet_of(name, input)?;
        let (name, input) = (name.clone(), input_text(input));
        if !expected.has(value.kind()) {
            return Err(ExecuteError::Kind {
                name,
                input,
                expected,
                got: value.kind(),
            });
        }
        if !value.is_finite() {
            return Err(ExecuteError::NotFinite { name, input });
        }
        super::with_network!(self, |network, around| network.deliver(inlet, value, around));
        Ok(())
    }

    fn setup_cness(&mut self, constant: bool, input: &InputOf) -> Done {
        match self.inlet_of(&input.name, input.input)?.0 {
            Inlet::Function { to, input: number } => {
                let role = self.network.instance(to).map(|instance| instance.role);
                if role == Some(Role::Variable) {
                    let (name, wanted) = (input.name.clone(), "a function instance");
                    return Err(ExecuteError::NotA {
                        name,
                        is: "a variable",
                        wanted,
                    });
                }
                self.network.set_constant(to, number, constant);
                Ok(())
            }
            _ => {
                let is = self.what_is(self.thing(&input.name)?);
                Err(ExecuteError::NotA {
                    name: input.name.clone(),
                    is,
                    wanted: "a function instance",
                })
            }
        }
    }

    fn node_named(&self, name: &Name) -> Result<NodeId, ExecuteError> {
        match self.thing(name)? {
            Thing::Node(id) => Ok(id),
            other => {
                let is = self.what_is(other);
                Err(ExecuteError::NotA {
                    name: name.clone(),
                    is,
                    wanted: "part of the display tree",
                })
            }
        }
    }

    fn members(&mut self, instance: &Name) -> Result<&mut Vec<NameId>, ExecuteError> {
        let id = self.node_named(instance)?;
        let not = ExecuteError::NotA {
            name: instance.clone(),
            is: self.structure.what(id),
            wanted: "an INSTANCE",
        };
        match self.structure.slot_mut(id).map(|slot| &mut slot.body) {
            Some(Body::Instance(of)) => Ok(of),
            _ => Err(not),
        }
    }

    fn include(&mut self, member: &Name, instance: &Name) -> Done {
        self.members(instance)?;
        let entry = self.names.refer(member);
        let around = self.names.refer(instance);
        let below = self.names.node(entry);
        if entry == around || below.is_some_and(|id| reaches(&self.structure, &self.names, id, around)) {
            return Err(ExecuteError::Cycle {
                name: instance.clone(),
            });
        }
        let members = self.members(instance)?;
        if !members.contains(&entry) {
            members.push(entry);
        }
        Ok(())
    }

    fn remove_from(&mut self, member: &Name, instance: &Name) -> Done {
        let entry = self.names.find(member).ok_or_else(|| self.unknown(member))?;
        let members = self.members(instance)?;
        match members.iter().position(|&id| id == entry) {
            Some(at) => {
                members.remove(at);
                Ok(())
            }
            None => Err(ExecuteError::Nothing {
                what: format!("{member} is not in {instance}"),
            }),
        }
    }

    fn show(&mut self, name: &Name) -> Done {
        if self.names.thing(name).is_some() {
            self.node_named(name)?;
        }
        let entry = self.names.refer(name);
        if !self.displayed.contains(&entry) {
            self.displayed.push(entry);
            self.structure.revision += 1;
        }
        Ok(())
    }

    fn hide(&mut self, name: &Name) -> Done {
        let entry = self.names.find(name).ok_or_else(|| self.unknown(name))?;
        match self.displayed.iter().position(|&id| id == entry) {
            Some(at) => {
                self.displayed.remove(at);
                self.structure.revision += 1;
                Ok(())
            }
            None => Err(ExecuteError::Nothing {
                what: format!("{name} is not displayed"),
            }),
        }
    }

    /// FOLLOW and PREFIX: both put an operation directly next to the node, so FOLLOW in front of what
    /// followed before, PREFIX behind what was there.
    fn insert(
        &mut self,
        name: &Name,
        with: &Operation,
        side: fn(&mut crate::structure::Slot) -> &mut Vec<Change>,
        operation_only: bool,
    ) -> Done {
        let id = self.node_named(name)?;
        let change = Change::new(with.clone()).map_err(|error| build_error(name, BuildError::from(error)))?;
        let is = self.structure.what(id);
        let Some(slot) = self.structure.slot_mut(id) else {
            return Ok(());
        };
        if operation_only {
            if !matches!(slot.body, Body::Operation { .. }) {
                return Err(ExecuteError::NotA {
                    name: name.clone(),
                    is,
                    wanted: "an operation",
                });
            }
            side(slot).insert(0, change);
        } else {
            side(slot).push(change);
        }
        Ok(())
    }
}

fn build_error(name: &Name, error: BuildError) -> ExecuteError {
    let name = name.clone();
    match error {
        BuildError::NoView(why) => ExecuteError::NoView { name, why },
        BuildError::Depth => ExecuteError::Depth { name },
    }
}

fn no_function(function: &Name) -> ExecuteError {
    let absent = intrinsic::ABSENT
        .iter()
        .find(|absent| absent.name.eq_ignore_ascii_case(function.as_str()));
    if let Some(absent) = absent {
        return ExecuteError::AbsentFunction {
            function: absent.name,
            purpose: absent.purpose,
        };
    }
    let alike = intrinsic::alike(function.as_str())
        .into_iter()
        .map(Name::new)
        .collect();
    ExecuteError::NoFunction {
        function: function.clone(),
        alike,
    }
}
