//! The machine's content as a program that makes it again.
//!
//! Definitions in the order they were made, then connections, constants and waiting messages, then what
//! is displayed. What messages have done to running sums and to display nodes is not part of it: a
//! reloaded machine starts from what was written.
//! A thing whose name was forgotten is printed under a spare name and forgotten again at the end.

use std::fmt::Write;

use super::Machine;
use crate::language::{Command, Definition, Input, InputOf, Name, OutputOf, Payload, print};
use crate::names::{Owner, Thing};
use crate::network::{Instance, InstanceId, Numbered, Role};
use crate::structure::{Body, NodeId};
use crate::value::Value;

impl Machine {
    /// The canonical text of everything commands have made; loading it into a new machine makes it again.
    pub fn network_text(&self) -> String {
        let mut text = String::new();
        for command in self.program() {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{}", print(&command));
        }
        text
    }

    /// The same as commands.
    pub fn program(&self) -> Vec<Command> {
        let mut program = Vec::new();
        let mut forgotten = Vec::new();
        for entry in self.names.defined() {
            let name = self.names.spelling(entry);
            let is_label = self.names.entry(entry).owner == Owner::Structure;
            match self.names.entry(entry).thing {
                Some(Thing::Instance(id)) => self.print_instance(id, &name, &mut program),
                Some(Thing::Node(id)) if !is_label => self.print_node(id, &name, &mut program),
                _ => {}
            }
            if !self.names.entry(entry).known && !is_label {
                forgotten.push(Command::Forget(name));
            }
        }
        self.print_wires(&mut program);
        self.print_messages(&mut program);
        program.extend(
            self.displayed
                .iter()
                .map(|&entry| Command::Display(self.names.spelling(entry))),
        );
        program.extend(forgotten);
        program
    }

    fn print_instance(&self, id: InstanceId, name: &Name, program: &mut Vec<Command>) {
        let Some(instance) = self.network.instance(id) else {
            return;
        };
        program.push(match instance.role {
            Role::Variable => Command::Variable(vec![name.clone()]),
            Role::Function | Role::Device => Command::Define {
                name: name.clone(),
                definition: Definition::Function {
                    function: Name::new(instance.spec.name),
                    size: instance.size.map(u16::from),
                },
            },
        });
    }

    fn print_node(&self, id: NodeId, name: &Name, program: &mut Vec<Command>) {
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

    fn print_wires(&self, program: &mut Vec<Command>) {
        for Numbered { id, instance } in self.network.instances() {
            let name = self.spelt(Thing::Instance(id), &instance.name);
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

    fn print_messages(&self, program: &mut Vec<Command>) {
        let instances = self.network.instances();
        let each = |visit: &mut dyn FnMut(Name, &Instance, u8)| {
            for Numbered { id, instance } in &instances {
                let name = self.spelt(Thing::Instance(*id), &instance.name);
                for input in 1..=instance.input_count() as u8 {
                    visit(name.clone(), instance, input);
                }
            }
        };
        let at = |name: Name, input: u8| InputOf {
            name,
            input: Input::Number(input.into()),
        };
        each(&mut |name, instance, input| {
            if let Some(constant) = instance.changed_cness(input) {
                program.push(Command::SetupCness {
                    constant,
                    input: at(name, input),
                });
            }
        });
        let mut send = |name, input, value: &Value| {
            program.push(Command::Send {
                payload: Payload::Value(value.clone()),
                to: at(name, input),
            });
        };
        each(&mut |name, instance, input| {
            if let Some(value) = instance.held_if_set(input) {
                send(name, input, value);
            }
        });
        each(&mut |name, instance, input| {
            for value in instance.queued(input) {
                send(name.clone(), input, value);
            }
        });
    }
}
