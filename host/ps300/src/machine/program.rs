//! The machine's content as a program that makes it again.
//!
//! Definitions in the order they were made, then connections, constants and waiting messages, then what
//! is displayed. What messages have done to running sums, to display nodes and to the panel is part of it only
//! where that is asked for: without it a reloaded machine starts from what was written.
//! A thing whose name was forgotten is printed under a spare name and forgotten again at the end.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::Machine;
use crate::language::{Command, Definition, InputOf, Name, OutputOf, print};
use crate::names::{NameId, Owner, Thing};
use crate::network::{InstanceId, Numbered, Role};
use crate::structure::{Body, NodeId};

impl Machine {
    /// The canonical text of everything commands have made; loading it into a new machine makes it again.
    pub fn network_text(&self) -> String {
        written(&self.program())
    }

    /// The same with what messages have done since: loaded into a new machine with the same host parameters it
    /// goes on where this one is. Give the new machine its network time before, or clocks begin anew from there.
    /// Lists of picks that wait have no text and are left out, as are messages of the host that are not yet
    /// let in.
    pub fn network_text_with_state(&self) -> String {
        written(&self.program_with_state())
    }

    /// What [`Machine::network_text`] writes, as commands.
    pub fn program(&self) -> Vec<Command> {
        self.print(false)
    }

    /// What [`Machine::network_text_with_state`] writes, as commands.
    pub fn program_with_state(&self) -> Vec<Command> {
        self.print(true)
    }

    fn print(&self, with_state: bool) -> Vec<Command> {
        let mut program = Vec::new();
        let mut forgotten = Vec::new();
        for entry in self.names.defined() {
            let name = self.names.spelling(entry);
            let is_label = self.names.entry(entry).owner == Owner::Structure;
            match self.names.entry(entry).thing {
                Some(Thing::Instance(id)) if !is_label => self.print_instance(id, &name, &mut program),
                Some(Thing::Node(id)) if !is_label => self.print_node(id, &name, &mut program),
                _ => {}
            }
            if !self.names.entry(entry).known && !is_label {
                forgotten.push(Command::Forget(name));
            }
        }
        self.print_patterns(&mut program);
        self.print_wires(&mut program);
        self.print_constants(&mut program);
        if with_state {
            self.print_state(&mut program);
        }
        self.print_waiting(&mut program);
        program.extend(
            self.displayed
                .iter()
                .map(|&entry| Command::Display(self.names.spelling(entry))),
        );
        program.extend(forgotten);
        program
    }

    pub(super) fn print_instance(&self, id: InstanceId, name: &Name, program: &mut Vec<Command>) {
        let Some(instance) = self.network.instance(id) else {
            return;
        };
        program.push(match instance.role {
            Role::Variable => Command::Variable(vec![name.clone()]),
            Role::Function | Role::Device | Role::Node => Command::Define {
                name: name.clone(),
                definition: Definition::Function {
                    function: Name::new(instance.spec.name),
                    size: instance.size.map(u16::from),
                },
            },
        });
    }

    pub(super) fn print_node(&self, id: NodeId, name: &Name, program: &mut Vec<Command>) {
        let node = self.structure.describe(id, &self.names);
        program.push(Command::Define {
            name: name.clone(),
            definition: Definition::Node(node),
        });
        self.print_insertions(id, name, program);
    }

    /// PREFIX and FOLLOW of a node and of its labelled members.
    fn print_insertions(&self, id: NodeId, name: &Name, program: &mut Vec<Command>) {
        let Some(slot) = self.structure.slot(id) else {
            return;
        };
        for change in &slot.above {
            program.push(Command::Prefix {
                name: name.clone(),
                with: change.operation.clone(),
            });
        }
        for change in slot.below.iter().rev() {
            program.push(Command::Follow {
                name: name.clone(),
                with: change.operation.clone(),
            });
        }
        if let Body::Structure(members) = &slot.body {
            for (label, member) in members {
                let full = label.as_ref().map(|label| Name::new(&format!("{name}.{label}")));
                self.print_insertions(*member, full.as_ref().unwrap_or(name), program);
            }
        }
    }

    /// PATTERN … WITH: after all definitions, as either may have been made anew.
    fn print_patterns(&self, program: &mut Vec<Command>) {
        for entry in self.names.defined() {
            let pattern = self.names.node(entry).and_then(|id| self.pattern_of(id));
            if let Some(pattern) = pattern {
                program.push(Command::PatternWith {
                    list: self.names.spelling(entry),
                    pattern: self.names.spelling(pattern),
                });
            }
        }
    }

    /// What a node is dashed with, if that is a pattern still.
    pub(super) fn pattern_of(&self, id: NodeId) -> Option<NameId> {
        self.structure.pattern(id).filter(|&name| self.is_pattern(name))
    }

    fn is_pattern(&self, name: NameId) -> bool {
        let node = self.names.node(name).and_then(|id| self.structure.slot(id));
        matches!(node.map(|slot| &slot.body), Some(Body::Pattern(_)))
    }

    fn print_wires(&self, program: &mut Vec<Command>) {
        let defined = self.names.defined().into_iter();
        let place: BTreeMap<Name, usize> = defined.map(|entry| self.names.spelling(entry)).zip(0..).collect();
        let senders = self.network.instances().into_iter();
        let mut senders: Vec<(Name, Numbered<'_>)> = senders
            .map(|it| (self.spelt(Thing::Instance(it.id), it.instance.name), it))
            .collect();
        // What sends for a node is made when that is first connected, so they follow in the order of the nodes.
        senders.sort_by_key(|(name, it)| (it.instance.role == Role::Node).then(|| place.get(name)));
        for (name, Numbered { id, instance }) in senders {
            for output in 1..=instance.output_count() as u8 {
                for (to, inlet) in self
                    .destinations(id, output)
                    .into_iter()
                    .zip(self.things_fed(id, output))
                {
                    let to = InputOf {
                        name: self.spelt(inlet, &to.name),
                        input: to.input,
                    };
                    program.push(Command::Connect {
                        from: OutputOf {
                            name: name.clone(),
                            output,
                        },
                        to,
                    });
                }
            }
        }
    }
}

fn written(program: &[Command]) -> String {
    let mut text = String::new();
    for command in program {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}", print(command));
    }
    text
}
