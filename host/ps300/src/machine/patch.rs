//! Changing a machine into what a program makes, while it runs: only what differs is touched.
//!
//! The program is executed in a machine of its own first, so whatever commands it uses, what counts is what it
//! makes. Then the two are compared thing by thing (`difference`). What stays keeps its queues, sums and
//! pictures; what is made anew is told what the program tells it.

use std::collections::BTreeMap;

use super::{ExecuteError, Machine};
use crate::language::{Command, Diagnostic, Name, Severity, parse, print};
use crate::network::SinkId;
use crate::value::Kinds;

/// What reports call a program that was edited whole.
const PROGRAM: &str = "program";

/// A command of a program that was refused.
#[derive(Clone, Debug, PartialEq)]
pub struct Refused {
    /// Its index in the program.
    pub command: usize,
    /// Why.
    pub error: ExecuteError,
}

impl Machine {
    /// Makes this machine what `program` makes of a new one, by changing only what differs. A constant that no
    /// wire feeds counts as part of the program; one that is fed is what the network made of it, and stays. What
    /// the program could not make is named and left out.
    pub fn patch(&mut self, program: &[Command]) -> Vec<Refused> {
        let mut wanted = self.sketch();
        let mut refused = Vec::new();
        for (command, it) in program.iter().enumerate() {
            if let Err(error) = wanted.execute(it) {
                refused.push(Refused { command, error });
            }
        }
        wanted.end_groups();
        let remade = self.become_like(&wanted, None);
        self.tell(program, |to, _| remade.anew.contains(to));
        self.forget_remade(&remade);
        refused
    }

    /// Makes the change from one program to another, both whole: what the two have in common stays as it is here.
    /// Commands that send and stand in the second alone are executed. If it has errors that the first has not,
    /// they are returned and nothing is changed.
    pub fn edit_program(&mut self, from: &str, to: &str) -> Vec<Diagnostic> {
        let (before, known) = self.sketch_of(PROGRAM, from);
        let (wanted, found) = self.sketch_of(PROGRAM, to);
        let is_error = |it: &&Diagnostic| it.severity == Severity::Error;
        let fault = |it: &Diagnostic| !known.iter().any(|other| other.message == it.message);
        if found.iter().filter(is_error).any(fault) {
            return found;
        }
        let remade = self.become_like(&wanted, Some(&before));
        let mut told: BTreeMap<String, u32> = BTreeMap::new();
        for command in commands(from) {
            *told.entry(print(&command)).or_default() += 1;
        }
        self.tell(&commands(to), |to, command| {
            let left = told.get_mut(&print(command)).filter(|left| **left > 0);
            let is_new = left.map(|left| *left -= 1).is_none();
            is_new || remade.anew.contains(to)
        });
        self.forget_remade(&remade);
        found
    }

    /// Takes the change from one program to another back or makes it again, both as
    /// [`Machine::network_text_with_state`] wrote them before and after it. Messages are told to what has to be
    /// made anew, or had been, and to nothing else: what was sent is not taken back.
    pub fn restore(&mut self, from: &str, to: &str) {
        let (before, _) = self.sketch_of("", from);
        let (wanted, _) = self.sketch_of("", to);
        let remade = self.become_like(&wanted, Some(&before));
        let used = wanted.made_used(&before);
        self.tell(&commands(to), |to, _| {
            remade.anew.contains(to) || used.contains(to)
        });
        self.forget_remade(&remade);
    }

    /// A new machine with the same host parameters, the same declared senders and the same time.
    fn sketch(&self) -> Self {
        let mut sketch = Self::with_limits(self.network.limits);
        let sinks = (0..self.network.sink_count() as u32).map(SinkId);
        for sink in sinks.filter(|&id| !self.readouts.has(id)) {
            if let Some(sink) = self.network.sink(sink) {
                let kinds: Vec<Kinds> = sink.inputs.iter().map(|input| input.kinds).collect();
                // The same parameters were declared here without complaint.
                let _ = sketch.declare_sink(sink.name.as_str(), &kinds);
            }
        }
        for (name, outputs) in self.sources() {
            // Likewise.
            let _ = sketch.declare_source(name.as_str(), &outputs);
        }
        sketch.ticked = self.ticked;
        sketch.network.now = self.network.now;
        sketch
    }

    fn sketch_of(&self, called: &str, text: &str) -> (Self, Vec<Diagnostic>) {
        let mut sketch = self.sketch();
        let found = sketch.load_named(called, text);
        (sketch, found)
    }

    /// Executes those commands of a program that send something `wanted`, given the name of what they send to.
    fn tell(&mut self, program: &[Command], mut wanted: impl FnMut(&Name, &Command) -> bool) {
        let defined = last_definitions(program);
        let gone = |at: usize, name: &Name| {
            let mut around = enclosing(name).chain([name.clone()]);
            around.any(|name| defined.get(&name).is_some_and(|&last| last > at))
        };
        let mut told = Vec::new();
        for (at, command) in program.iter().enumerate() {
            match told_by(command) {
                Some(to) if !gone(at, to) && wanted(to, command) => told.push(command),
                None if matches!(command, Command::BeginGroup | Command::EndGroup) => told.push(command),
                _ => {}
            }
        }
        for command in told {
            // What cannot be told here could not be told to the program's own machine.
            let _ = self.execute(command);
        }
        self.end_groups();
    }
}

fn commands(text: &str) -> Vec<Command> {
    parse(text).0.into_iter().map(|located| located.what).collect()
}

/// What a command sends to or sets up.
fn told_by(command: &Command) -> Option<&Name> {
    match command {
        Command::Send { to, .. } | Command::Store { to, .. } => Some(&to.name),
        Command::SetupCness { input, .. } => Some(&input.name),
        Command::SetupState { name, .. } => Some(name),
        _ => None,
    }
}

/// Where in a program each name was defined last: what was told to it before is gone then.
fn last_definitions(program: &[Command]) -> BTreeMap<&Name, usize> {
    let mut last = BTreeMap::new();
    for (at, command) in program.iter().enumerate() {
        match command {
            Command::Define { name, .. } | Command::Delete(name) => {
                last.insert(name, at);
            }
            Command::Variable(names) => last.extend(names.iter().map(|name| (name, at))),
            _ => {}
        }
    }
    last
}

/// The structures that a label lies in.
fn enclosing(name: &Name) -> impl Iterator<Item = Name> {
    let dots = name.as_str().match_indices('.');
    dots.map(|(at, _)| Name::new(&name.as_str()[..at]))
}
