//! What hands on the panel mean, as commands. Every function gives the text of one gesture.

use std::collections::BTreeSet;

use ps300::intrinsic::Spec;
use ps300::language::{self, Command, Definition, Disconnection, Input, InputOf, Name, OutputOf, Severity};

use super::look::{Look, Role};
use super::scene::{Part, Port, Scene};

/// Joins an output to an input.
pub fn connect(output: &Port, input: &Port) -> String {
    line(&Command::Connect {
        from: output_of(output),
        to: input_of(input),
    })
}

/// Parts an output from an input.
pub fn disconnect(output: &Port, input: &Port) -> String {
    line(&Command::Disconnect(Disconnection::Pair {
        from: output_of(output),
        to: input_of(input),
    }))
}

/// Makes an instance.
pub fn create(spec: &Spec, name: &Name, size: Option<u16>) -> String {
    line(&Command::Define {
        name: name.clone(),
        definition: Definition::Function {
            function: Name::new(spec.name),
            size,
        },
    })
}

/// Makes a variable.
pub fn variable(name: &Name) -> String {
    line(&Command::Variable(vec![name.clone()]))
}

/// Sends what was typed to an input: a literal of the language; a bare word that is none is meant as text.
pub fn send(typed: &str, input: &Port) -> Result<String, String> {
    let typed = typed.trim();
    let command = |value: &str| {
        format!(
            "SEND {value} TO <{}>{};",
            super::scene::input_word(input.input),
            input.of
        )
    };
    let read = |text: &str| match language::parse(text) {
        (commands, faults) if faults.is_empty() => match commands.as_slice() {
            [one] => Ok(one.what.clone()),
            _ => Err(String::from("one value is wanted")),
        },
        (_, faults) => Err(faults
            .first()
            .map_or_else(String::new, |fault| fault.message.clone())),
    };
    let text_wanted = input.kinds == ps300::Kinds::STRING && !typed.starts_with(['\'', '"']);
    let number = typed.parse::<i32>().ok();
    let integer_wanted = !input.kinds.has(ps300::Kind::Real) && input.kinds.has(ps300::Kind::Integer);
    let text = match number {
        _ if text_wanted => command(&language::literal(&ps300::Value::from(typed))),
        Some(number) if integer_wanted => command(&format!("FIX({number})")),
        _ => command(typed),
    };
    match read(&text)? {
        Command::Send {
            payload: language::Payload::Value(value),
            ..
        } if !input.kinds.has(value.kind()) => Err(format!(
            "{} takes {}, not {}",
            super::fit::input_text(input),
            input.kinds,
            value.kind()
        )),
        command @ Command::Send { .. } => Ok(line(&command)),
        _ => Err(String::from("one value is wanted")),
    }
}

/// Deletes boxes and parts wires. What commands cannot delete (devices, parameters, members of structures) loses
/// its wires instead. Nothing if nothing is to be done.
pub fn delete(scene: &Scene, boxes: &BTreeSet<usize>, wires: &BTreeSet<usize>) -> Option<String> {
    let deletable = |index: usize| {
        let shown = &scene.boxes[index];
        let made = matches!(shown.role, Role::Function | Role::Variable) && shown.structure.is_none();
        made || matches!(shown.part, Part::Folded(_))
    };
    let mut text = String::new();
    for (index, wire) in scene.wires.iter().enumerate() {
        let (from, to) = (wire.from.0, wire.to.0);
        let goes_with_a_box = [from, to]
            .into_iter()
            .any(|end| boxes.contains(&end) && deletable(end));
        let at_a_box = [from, to].into_iter().any(|end| boxes.contains(&end));
        if !goes_with_a_box && (wires.contains(&index) || at_a_box) {
            let (output, input) = ends(scene, index);
            text.push_str(&disconnect(output, input));
        }
    }
    for &index in boxes.iter().filter(|&&index| deletable(index)) {
        text.push_str(&line(&Command::Delete(scene.boxes[index].name.clone())));
    }
    (!text.is_empty()).then_some(text)
}

/// The two ports of a wire.
pub fn ends(scene: &Scene, wire: usize) -> (&Port, &Port) {
    let wire = scene.wires[wire];
    (
        &scene.boxes[wire.from.0].outputs[wire.from.1],
        &scene.boxes[wire.to.0].inputs[wire.to.1],
    )
}

/// Nobody makes more of one function by hand.
const MADE_MAX: u32 = 100_000;

/// A name nothing bears yet and that reads back as a name.
pub fn fresh_name(wanted: &str, look: &Look, also: &BTreeSet<Name>) -> Name {
    let wanted = wanted.to_lowercase();
    let base = if Name::is_valid(&wanted) {
        wanted.as_str()
    } else {
        "f"
    };
    let known = |name: &Name| {
        let boxes = look.picture.boxes.iter().chain(&look.picture.unwired);
        boxes
            .flat_map(|b| [Some(&b.name), b.structure.as_ref()])
            .flatten()
            .any(|taken| taken == name)
            || also.contains(name)
    };
    (1..=MADE_MAX)
        .map(|number: u32| {
            Name::new(&if number == 1 {
                base.to_owned()
            } else {
                format!("{base}{number}")
            })
        })
        .find(|name| !known(name) && reads_back(name))
        .unwrap_or_else(|| Name::new(base))
}

/// Some words of the language cannot be names of instances.
fn reads_back(name: &Name) -> bool {
    let (_, faults) = language::parse(&format!("{name} := F:NOP; CONNECT {name}<1>:<1>{name};"));
    faults.iter().all(|fault| fault.severity == Severity::Warning)
}

fn output_of(port: &Port) -> OutputOf {
    OutputOf {
        name: port.of.clone(),
        output: output_number(port),
    }
}

/// The number of an output, from 1.
pub fn output_number(port: &Port) -> u8 {
    match port.input {
        Input::Number(number) => u8::try_from(number).unwrap_or(u8::MAX),
        _ => 1,
    }
}

fn input_of(port: &Port) -> InputOf {
    InputOf {
        name: port.of.clone(),
        input: port.input,
    }
}

pub(super) fn line(command: &Command) -> String {
    format!("{}\n", language::print(command))
}
