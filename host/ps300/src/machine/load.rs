//! Whole programs.

use super::Machine;
use crate::language::{Command, Definition, Diagnostic, Located, Name, Node, Position, parse};

/// Firings a command has in any case: enough for most, and few enough for a text of a million commands that are
/// given while something goes round for ever.
const FIRINGS_LEAST: u32 = 16;

impl Machine {
    /// Reads a program and executes it command by command. What could not be read or executed is left out
    /// and named, in the order of the text; so is what display nodes refer to and nothing defines.
    pub fn load(&mut self, source: &str) -> Vec<Diagnostic> {
        let (commands, mut diagnostics) = parse(source);
        let mut referred = Vec::new();
        let limits = self.network.limits;
        let mut left = limits.firings_per_load;
        for Located { at, what } in &commands {
            let firings = limits.firings_per_command.min(left.max(FIRINGS_LEAST));
            match self.execute_within(firings, what) {
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
