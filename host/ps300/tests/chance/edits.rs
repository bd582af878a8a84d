//! Edits of a running network that are taken back and made again.

use ps300::Machine;

/// Lines of a program that say what messages have done, and not what there is.
const SAID: [&str; 4] = ["SEND ", "SETUP STATE", "BEGIN;", "END;"];

/// The texts before and after each edit.
#[derive(Default)]
pub(crate) struct Edits {
    past: Vec<[String; 2]>,
    future: Vec<[String; 2]>,
    forgetful: bool,
}

impl Edits {
    /// Hears of commands that are not to be taken back. Who forgets a name and then takes it back finds what
    /// referred to it referring to something else of that name, so from then on edits are only made.
    pub(crate) fn hear(&mut self, text: &str) {
        self.forgetful |= text.contains("FORGET ");
    }

    /// Executes commands, as a person does who may regret it.
    pub(crate) fn edit(&mut self, machine: &mut Machine, text: &str) {
        self.hear(text);
        // Texts say nothing of messages that are not yet let in.
        machine.settle();
        let before = machine.network_text_with_state();
        machine.load(text);
        let after = machine.network_text_with_state();
        self.past.push([before, after]);
        self.future.clear();
    }

    /// Takes the last edit back.
    pub(crate) fn undo(&mut self, machine: &mut Machine) {
        if let Some([before, after]) = self.past.pop() {
            self.restore(machine, &after, &before);
            self.future.push([before, after]);
        }
    }

    /// Makes the last one that was taken back again.
    pub(crate) fn redo(&mut self, machine: &mut Machine) {
        if let Some([before, after]) = self.future.pop() {
            self.restore(machine, &before, &after);
            self.past.push([before, after]);
        }
    }

    /// Whether a name was forgotten.
    pub(crate) fn forgetful(&self) -> bool {
        self.forgetful
    }

    fn restore(&self, machine: &mut Machine, from: &str, to: &str) {
        machine.settle();
        let as_left = makes_the_same(&machine.network_text(), from);
        machine.restore(from, to);
        let now = machine.network_text();
        // Between the edit and now, commands may have made other changes; those stay.
        assert!(
            self.forgetful || !as_left || makes_the_same(&now, to),
            "from\n{from}\nto\n{to}\nis\n{now}"
        );
    }
}

/// Whether two texts make the same things and wires. Of things without a name only those that are used are made again,
/// so texts that have any are not compared.
pub(crate) fn makes_the_same(one: &str, other: &str) -> bool {
    let made = |text: &'_ str| -> Vec<String> {
        let lines = text
            .lines()
            .filter(|line| !SAID.iter().any(|word| line.starts_with(word)));
        lines.map(str::to_owned).collect()
    };
    [one, other].iter().any(|text| text.contains("FORGET ")) || made(one) == made(other)
}
