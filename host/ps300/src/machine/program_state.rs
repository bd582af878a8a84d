//! The part of a program that says what messages have done: constants, sums, node contents, labels, and
//! messages that still wait.
//!
//! Messages that wait are written so that the instances become ready in the order in which they are, and in
//! one group, so that none fires before all are there.

use std::collections::BTreeSet;

use super::Machine;
use crate::language::{Command, Input, InputOf, Name, Payload};
use crate::names::Thing;
use crate::network::{Instance, InstanceId, Numbered};
use crate::value::Value;

impl Machine {
    /// SETUP CNESS and the constants somebody sent.
    pub(super) fn print_constants(&self, program: &mut Vec<Command>) {
        let instances = self.network.instances();
        for numbered in &instances {
            self.each_input(*numbered, |at, instance, input| {
                if let Some(constant) = instance.changed_cness(input) {
                    program.push(Command::SetupCness { constant, input: at });
                }
            });
        }
        for numbered in &instances {
            self.each_input(*numbered, |at, instance, input| {
                program.extend(instance.held_if_set(input).and_then(|value| send(value, at)));
            });
        }
    }

    /// What functions remember, what display nodes were told, and what the panel shows.
    pub(super) fn print_state(&self, program: &mut Vec<Command>) {
        for Numbered { id, instance } in self.network.instances() {
            let values = instance.remembered();
            if !values.is_empty() && values.iter().all(has_literal) {
                let name = self.spelt(Thing::Instance(id), instance.name);
                program.push(Command::SetupState { name, values });
            }
        }
        for entry in self.names.defined() {
            let Some(Thing::Node(id)) = self.names.denoted(entry) else {
                continue;
            };
            let name = self.names.spelling(entry);
            let values = self.structure.remembered(id);
            if !values.is_empty() {
                program.push(Command::SetupState {
                    name: name.clone(),
                    values,
                });
            }
            for (input, value) in self.structure.told(id) {
                let (name, input) = (name.clone(), *input);
                program.extend(send(value, InputOf { name, input }));
            }
        }
        self.print_panel(program);
    }

    fn print_panel(&self, program: &mut Vec<Command>) {
        let mut show = |name: String, value: Value| {
            let name = Name::new(&name);
            let input = Input::Number(1);
            program.extend(send(&value, InputOf { name, input }));
        };
        let panel = &self.panel;
        let labels = [
            ("DLABEL", &panel.dial_labels[..]),
            ("FLABEL", &panel.key_labels[..]),
        ];
        for (device, labels) in labels {
            for (number, label) in (1..).zip(labels).filter(|(_, label)| !label.is_empty()) {
                show(format!("{device}{number}"), Value::from(label.as_str()));
            }
        }
        for lamp in (0..32).filter(|lamp| panel.lamps & (1 << lamp) != 0) {
            show("ONBUTTONLIGHTS".to_owned(), Value::Integer(lamp + 1));
        }
        if !panel.message.is_empty() {
            show("MESSAGE_DISPLAY".to_owned(), Value::from(panel.message.as_str()));
        }
    }

    /// Messages that wait: first those that set nothing off, then instance by instance in the order in which
    /// they will fire.
    pub(super) fn print_waiting(&self, program: &mut Vec<Command>) {
        let ready: Vec<InstanceId> = self.network.ready().collect();
        let among: BTreeSet<InstanceId> = ready.iter().copied().collect();
        if !ready.is_empty() {
            program.push(Command::BeginGroup);
        }
        let instances = self.network.instances();
        let idle = instances
            .into_iter()
            .filter(|numbered| !among.contains(&numbered.id));
        let turn = ready.iter().filter_map(|&id| {
            let instance = self.network.instance(id)?;
            Some(Numbered { id, instance })
        });
        for numbered in idle.chain(turn) {
            self.each_input(numbered, |at, instance, input| {
                program.extend(instance.queued(input).filter_map(|value| send(value, at.clone())));
            });
        }
        if !ready.is_empty() {
            program.push(Command::EndGroup);
        }
    }

    fn each_input(&self, numbered: Numbered<'_>, mut visit: impl FnMut(InputOf, Instance<'_>, u8)) {
        let Numbered { id, instance } = numbered;
        if instance.input_count() == 0 {
            return;
        }
        let name = self.spelt(Thing::Instance(id), instance.name);
        for input in 1..=instance.input_count() as u8 {
            let at = InputOf {
                name: name.clone(),
                input: Input::Number(input.into()),
            };
            visit(at, instance, input);
        }
    }
}

fn send(value: &Value, to: InputOf) -> Option<Command> {
    has_literal(value).then(|| Command::Send {
        payload: Payload::Value(value.clone()),
        to,
    })
}

fn has_literal(value: &Value) -> bool {
    !matches!(value, Value::Picks(_))
}
