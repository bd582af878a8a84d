//! Copies of boxes: the same functions with the same constants, wired among each other as their models are.

use std::collections::{BTreeMap, BTreeSet};

use ps300::intrinsic;
use ps300::language::{Command, Definition, InputOf, Name, Payload};

use super::edit::{self, fresh_name};
use super::look::{Look, Role};
use super::scene::Scene;

/// The commands of a copy, and for each model the name of its copy.
pub fn duplicate(
    look: &Look,
    scene: &Scene,
    boxes: &BTreeSet<usize>,
) -> Option<(String, BTreeMap<Name, Name>)> {
    let mut text = String::new();
    let mut copies: BTreeMap<usize, Name> = BTreeMap::new();
    let mut taken = BTreeSet::new();
    for &index in boxes {
        let shown = &scene.boxes[index];
        let stem = shown.title().trim_end_matches(|c: char| c.is_ascii_digit());
        let name = fresh_name(stem, look, &taken);
        match shown.role {
            Role::Variable => text.push_str(&edit::variable(&name)),
            Role::Function => {
                let Some((function, size)) = definition(shown.kind_word()) else {
                    continue;
                };
                text.push_str(&edit::line(&Command::Define {
                    name: name.clone(),
                    definition: Definition::Function { function, size },
                }));
                constants(look, scene, index, &name, &mut text);
            }
            _ => continue,
        }
        taken.insert(name.clone());
        copies.insert(index, name);
    }
    for (index, wire) in scene.wires.iter().enumerate() {
        if let (Some(from), Some(to)) = (copies.get(&wire.from.0), copies.get(&wire.to.0)) {
            let (mut output, mut input) = {
                let (output, input) = edit::ends(scene, index);
                (output.clone(), input.clone())
            };
            (output.of, input.of) = (from.clone(), to.clone());
            text.push_str(&edit::connect(&output, &input));
        }
    }
    let names = copies
        .into_iter()
        .map(|(index, copy)| (scene.boxes[index].name.clone(), copy))
        .collect();
    (!text.is_empty()).then_some((text, names))
}

/// `ROUTE(4)` taken apart; nothing for what is no known function.
fn definition(word: &str) -> Option<(Name, Option<u16>)> {
    let (name, size) = match word.split_once('(') {
        Some((name, size)) => (name, size.trim_end_matches(')').parse().ok()),
        None => (word, None),
    };
    Some((Name::new(intrinsic::find(name)?.name), size))
}

fn constants(look: &Look, scene: &Scene, index: usize, name: &Name, text: &mut String) {
    for port in scene.boxes[index].inputs.iter().filter(|port| port.constant) {
        let seen = port.activity.and_then(|at| look.activity.inputs.get(at));
        let Some(value) = seen.and_then(|input| input.front.clone()) else {
            continue;
        };
        let to = InputOf {
            name: name.clone(),
            input: port.input,
        };
        text.push_str(&edit::line(&Command::Send {
            payload: Payload::Value(value),
            to,
        }));
    }
}
