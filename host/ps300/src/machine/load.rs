//! Whole programs.

use super::{ExecuteError, Machine};
use crate::language::{Command, Definition, Diagnostic, Located, Name, Node, Position, parse};
use crate::network::{Made, Places};

/// Firings a command has in any case: enough for most, and few enough for a text of a million commands that are
/// given while something goes round for ever.
const FIRINGS_LEAST: u32 = 16;

impl Machine {
    /// Reads a program and executes it command by command. What could not be read or executed is left out
    /// and named, in the order of the text; so is what display nodes refer to and nothing defines.
    pub fn load(&mut self, text: &str) -> Vec<Diagnostic> {
        self.load_named("", text)
    }

    /// The same of a text called `source`, usually its file: reports then say where things were made.
    pub fn load_named(&mut self, source: &str, text: &str) -> Vec<Diagnostic> {
        let (commands, mut diagnostics) = parse(text);
        let places = Places::new(source, text);
        let mut referred = Vec::new();
        let limits = self.network.limits;
        let mut left = limits.firings_per_load;
        for Located { at, what } in &commands {
            let firings = limits.firings_per_command.min(left.max(FIRINGS_LEAST));
            let made = is_making(what).then(|| places.at(*at));
            match self.execute_made(made, |machine| machine.execute_within(firings, what)) {
                Ok(fired) => {
                    left = left.saturating_sub(fired);
                    references(what, *at, &mut referred);
                }
                Err(error) => diagnostics.push(Diagnostic::error(*at, error.to_string())),
            }
        }
        if let Some(last) = commands.last().filter(|_| self.end_groups()) {
            let message = "BEGIN has no END; the group ends with the text";
            diagnostics.push(Diagnostic::warning(last.at, message));
        }
        for (at, name) in referred {
            if self.names.thing(&name).is_none() {
                let message = format!("{name} is used here and nothing defines it");
                diagnostics.push(Diagnostic::warning(at, message));
            }
        }
        diagnostics.sort_by_key(|diagnostic| (diagnostic.line, diagnostic.column));
        diagnostics
    }
}

impl Machine {
    /// Executes a command of a text, so that reports say where what it makes was made.
    pub fn execute_at(&mut self, command: &Command, made: Made) -> Result<(), ExecuteError> {
        self.execute_made(Some(made), |machine| machine.execute(command))
    }

    pub(super) fn execute_made<T>(&mut self, made: Option<Made>, execute: impl FnOnce(&mut Self) -> T) -> T {
        self.names.making.clone_from(&made);
        self.network.making = made;
        let done = execute(self);
        self.names.making = None;
        self.network.making = None;
        done
    }
}

/// Whether a command may make something; those that do not are the most, and their place is not looked up.
fn is_making(command: &Command) -> bool {
    !matches!(
        command,
        Command::Send { .. }
            | Command::Store { .. }
            | Command::Connect { .. }
            | Command::SetupCness { .. }
            | Command::SetupState { .. }
    )
}

/// The names a command uses that may still be undefined when it is executed.
fn references(command: &Command, at: Position, into: &mut Vec<(Position, Name)>) {
    match command {
        Command::Define {
            definition: Definition::Node(node),
            ..
        } => node_references(node, at, into),
        Command::Include { member, .. } => into.push((at, member.clone())),
        Command::Display(name) => into.push((at, name.clone())),
        // It was defined, and what referred to it still does.
        Command::Forget(name) => into.retain(|(_, referred)| referred != name),
        _ => {}
    }
}

fn node_references(node: &Node, at: Position, into: &mut Vec<(Position, Name)>) {
    match node {
        Node::Instance(of) => into.extend(of.iter().map(|name| (at, name.clone()))),
        Node::Operation {
            applied_to: Some(name),
            ..
        } => into.push((at, name.clone())),
        Node::Polygons(polygons) => {
            into.extend(
                polygons
                    .iter()
                    .filter_map(|polygon| polygon.attributes.clone())
                    .map(|name| (at, name)),
            );
        }
        Node::Structure(members) => {
            for member in members {
                node_references(&member.node, at, into);
            }
        }
        _ => {}
    }
}
