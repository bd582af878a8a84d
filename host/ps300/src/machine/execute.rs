//! Commands taking effect.

use super::{ExecuteError, Machine};
use crate::intrinsic;
use crate::language::{Command, Definition, Initialization, Name, Node, Payload};
use crate::names::{Owner, Thing};
use crate::network::Role;
use crate::structure::{BuildError, Structure, reaches};

pub(super) type Done = Result<(), ExecuteError>;

impl Machine {
    /// Lets what came before the command be over, then the command take effect, then runs the network. A command
    /// that is refused changes nothing.
    pub fn execute(&mut self, command: &Command) -> Result<(), ExecuteError> {
        let firings = self.network.limits.firings_per_command;
        self.execute_within(firings, command).map(|_| ())
    }

    /// The same with as many firings as are said. Returns how many there were.
    pub(super) fn execute_within(&mut self, firings: u32, command: &Command) -> Result<u32, ExecuteError> {
        self.settle();
        self.take_effect(command)?;
        Ok(super::with_network!(self, |network, around| network.run_command(firings, around)))
    }

    fn take_effect(&mut self, command: &Command) -> Done {
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
            Command::PatternWith { list, pattern } => {
                self.thing(list)?;
                self.thing(pattern).map(|_| ())
            }
            Command::SetupState { name, values } => self.setup_state(name, values),
            Command::BeginGroup
            | Command::EndGroup
            | Command::Optimize
            | Command::EndOptimize
            | Command::ReserveWorkingStorage { .. }
            | Command::CommandStatus
            | Command::Reset => Ok(()),
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
        let entry = self.names.define(name, Thing::Instance(id));
        self.displayed.retain(|&displayed| displayed != entry); // It is nothing to look at any more.
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
                .is_some_and(|entry| self.names.entry(entry).owner == Owner::Machine)
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
    pub(super) fn clear(&mut self, name: &Name) {
        if let Some(id) = self.names.find(name) {
            self.delete_all(&[id]);
        }
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

pub(super) fn build_error(name: &Name, error: BuildError) -> ExecuteError {
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
