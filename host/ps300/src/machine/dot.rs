//! The network and the display tree as a drawing for graphviz.

use std::fmt::Write;

use super::Machine;
use crate::names::Thing;
use crate::network::{Numbered, Role, input_text};

impl Machine {
    /// A `digraph` of everything that is connected and everything commands have made.
    pub fn dot(&self) -> String {
        let mut text = String::from("digraph network {\n  rankdir=LR;\n  node [shape=box];\n");
        for Numbered { id, instance } in self.network.instances() {
            let idle =
                (1..=instance.output_count() as u8).all(|output| self.destinations(id, output).is_empty());
            if instance.role == Role::Device && idle {
                continue;
            }
            let shape = if instance.role == Role::Device {
                ", shape=house"
            } else {
                ""
            };
            let label = format!("{}\n{}", instance.name, instance.what());
            line(
                &mut text,
                &format!(
                    "{} [label={}{shape}]",
                    quoted(instance.name.as_str()),
                    quoted(&label)
                ),
            );
        }
        for entry in self.names.defined() {
            if let Some(Thing::Node(id)) = self.names.denoted(entry) {
                let name = self.names.spelling(entry);
                let label = format!("{name}\n{}", self.structure.what(id));
                line(
                    &mut text,
                    &format!(
                        "{} [label={}, style=rounded]",
                        quoted(name.as_str()),
                        quoted(&label)
                    ),
                );
                for below in self.structure.below(id) {
                    let below = self.names.spelling(below);
                    line(
                        &mut text,
                        &format!(
                            "{} -> {} [style=dashed]",
                            quoted(name.as_str()),
                            quoted(below.as_str())
                        ),
                    );
                }
            }
        }
        for wire in self.connections() {
            let label = format!("<{}> {}", wire.output, input_text(wire.to.input));
            let (from, to) = (quoted(wire.from.as_str()), quoted(wire.to.name.as_str()));
            line(&mut text, &format!("{from} -> {to} [label={}]", quoted(&label)));
        }
        text.push_str("}\n");
        text
    }
}

fn line(text: &mut String, statement: &str) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "  {statement};");
}

fn quoted(text: &str) -> String {
    let escaped = text
        .replace('\\', "\\\\")
        .replace('"', "\\\"")
        .replace('\n', "\\n");
    format!("\"{escaped}\"")
}
