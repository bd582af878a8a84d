//! Commands taking effect.

use super::{ExecuteError, Machine};
use crate::language::{Command, Definition, Initialization, Name, Payload};
use crate::names::{Owner, Thing};
use crate::network::Role;

pub(super) type Done = Result<(), ExecuteError>;

impl Machine {
    /// Lets what came before the command be over, then the command take effect, then runs the network; while a
    /// group is open the command alone. A command that is refused changes nothing.
    pub fn execute(&mut self, command: &Command) -> Result<(), ExecuteError> {
        let firings = self.network.limits.firings_per_command;
        self.execute_within(firings, command).map(|_| ())
    }

    /// The same with as many firings as are said. Returns how many there were.
    pub(super) fn execute_within(&mut self, firings: u32, command: &Command) -> Result<u32, ExecuteError> {
        if !self.open.in_group() {
            self.settle();
        }
        self.take_effect(command)?;
        if self.open.in_group() {
            return Ok(0);
        }
        Ok(super::with_network!(self, |network, around| network.run_command(firings, around)))
    }

    pub(super) fn take_effect(&mut self, command: &Command) -> Done {
        if !matches!(command, Command::Send { .. } | Command::Store { .. }) {
            self.topology += 1;
        }
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
                    Payload::VectorsOf(name) => self.vectors_of(name)?,
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
            Command::PatternWith { list, pattern } => self.dash(list, pattern),
            Command::SetupState { name, values } => self.setup_state(name, values),
            Command::BeginGroup
            | Command::EndGroup
            | Command::Optimize
            | Command::EndOptimize
            | Command::ReserveWorkingStorage { .. }
            | Command::CommandStatus
            | Command::Reset => self.group(command),
        }
    }

    pub(super) fn unknown(&self, name: &Name) -> ExecuteError {
        ExecuteError::Unknown {
            name: name.clone(),
            alike: self.names.alike(name),
        }
    }

    pub(super) fn thing(&self, name: &Name) -> Result<Thing, ExecuteError> {
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
    pub(super) fn free(&self, name: &Name) -> Done {
        let Some(entry) = self.names.find(name).map(|id| self.names.entry(id)) else {
            return Ok(());
        };
        let is = match entry.owner {
            Owner::Commands => return Ok(()),
            Owner::Machine => entry.thing.map_or("reserved", |thing| self.what_is(thing)),
            Owner::Structure => "a label inside a structure",
        };
        Err(ExecuteError::Fixed {
            name: name.clone(),
            is,
        })
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
}
