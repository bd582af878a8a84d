//! The network as text: where each name is defined, which name the cursor is on, and what is wrong with it.

use std::collections::BTreeMap;

use ps300::language::{self, Command, Definition, Diagnostic, Name, Node};
use ps300::machine::Machine;

use super::look::{Picture, Role};

/// By name, the line of its definition, from 1.
pub fn definitions(text: &str) -> BTreeMap<Name, u32> {
    let mut found = BTreeMap::new();
    for command in language::parse(text).0 {
        let line = command.at.line;
        match command.what {
            Command::Define { name, definition } => {
                if let Definition::Node(Node::Structure(members)) = definition {
                    let labels: Vec<Name> = members.into_iter().filter_map(|member| member.label).collect();
                    find_labels(text, line, &name, &labels, &mut found);
                }
                found.insert(name, line);
            }
            Command::Variable(names) => found.extend(names.into_iter().map(|name| (name, line))),
            _ => {}
        }
    }
    found
}

/// Labels stand in the order of the members, each before `:=`.
fn find_labels(text: &str, first: u32, structure: &Name, labels: &[Name], found: &mut BTreeMap<Name, u32>) {
    let mut labels = labels.iter().peekable();
    for (index, line) in text.lines().enumerate().skip(first.saturating_sub(1) as usize) {
        for piece in line.split(';') {
            let Some(label) = labels.peek() else {
                return;
            };
            let before = piece.split(":=").next().unwrap_or_default();
            let word = before.split_whitespace().next_back().unwrap_or_default();
            if piece.contains(":=") && word.eq_ignore_ascii_case(label.as_str()) {
                found.insert(Name::new(&format!("{structure}.{label}")), index as u32 + 1);
                labels.next();
            }
        }
    }
}

/// The name that begins, ends or goes on at a character of the text, counted from 0.
pub fn name_at(text: &str, character: usize) -> Option<Name> {
    let continues = |c: char| c.is_alphanumeric() || matches!(c, '_' | '$' | '.');
    let characters: Vec<char> = text.chars().collect();
    let end = (character..characters.len())
        .find(|&at| !continues(characters[at]))
        .unwrap_or(characters.len());
    let start = (0..character.min(end))
        .rev()
        .find(|&at| !continues(characters[at]))
        .map_or(0, |at| at + 1);
    let word: String = characters.get(start..end)?.iter().collect();
    Name::is_valid(&word).then(|| Name::new(&word))
}

/// What is wrong with a program, found by loading it into a machine of its own that has the parameters of this one.
pub fn check(text: &str, picture: &Picture) -> Vec<Diagnostic> {
    let mut machine = Machine::new();
    let parameters = picture
        .boxes
        .iter()
        .chain(&picture.unwired)
        .filter(|b| b.role == Role::Parameter);
    for parameter in parameters {
        let kinds: Vec<ps300::Kinds> = parameter.inputs.iter().map(|input| input.kinds).collect();
        // Labels and lamps are every machine's own; it has them already.
        let _ = machine.declare_sink(parameter.name.as_str(), &kinds);
    }
    let devices = picture.boxes.iter().chain(&picture.unwired);
    for device in devices.filter(|b| b.role == Role::Device && !b.outputs.is_empty()) {
        let kinds: Vec<ps300::Kinds> = device.outputs.iter().map(|output| output.kinds).collect();
        // Likewise of those that every machine has.
        let _ = machine.declare_source(device.name.as_str(), &kinds);
    }
    machine.load(text)
}

/// The byte at which line and column (both from 1, columns in characters) begin.
pub fn byte_of(text: &str, line: u32, column: u32) -> usize {
    let start: usize = text
        .split_inclusive('\n')
        .take(line.saturating_sub(1) as usize)
        .map(str::len)
        .sum();
    let rest = text.get(start..).unwrap_or_default();
    let within = rest
        .char_indices()
        .nth(column.saturating_sub(1) as usize)
        .map_or(rest.len(), |(at, _)| at);
    start + within
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "obj := BEGIN_STRUCTURE\n  a := ROTATE IN X 0; b := SCALE BY 1;\n  VECTOR_LIST N=2 0,0,0 1,1,1;\n\
                        END_STRUCTURE;\nadder := F:ADDC;\nVARIABLE v,w;\n";

    #[test]
    fn definitions_have_lines() {
        let found = definitions(TEXT);
        for (name, line) in [("obj", 1), ("obj.a", 2), ("obj.b", 2), ("adder", 5), ("w", 6)] {
            assert_eq!(found.get(&Name::new(name)), Some(&line), "{name}: {found:?}");
        }
    }

    #[test]
    fn the_name_under_the_cursor() {
        let text = "CONNECT rx<1>:<1>obj.rotx;";
        for (at, want) in [
            (8, Some("rx")),
            (10, Some("rx")),
            (20, Some("obj.rotx")),
            (12, None),
        ] {
            assert_eq!(name_at(text, at), want.map(Name::new), "{at}");
        }
    }

    #[test]
    fn faults_are_found_without_touching_the_network() {
        assert_eq!(check(TEXT, &Picture::default()), []);
        let wrong = check("a := F:ADDX;\nCONNECT a<1>:<1>b;\n", &Picture::default());
        assert_eq!(wrong.first().map(|d| d.line), Some(1), "{wrong:?}");
    }
}
