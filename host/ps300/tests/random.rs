//! What must hold for every session, thrown with dice. The fuzzer tries the same laws for longer.

mod chance;

use chance::commands::{LIVELY, REMEMBERING, anything, lively};
use chance::session::{Act, acts};
use chance::{Dice, laws};
use proptest::prelude::*;
use ps300::Machine;

fn dice(most: usize) -> impl Strategy<Value = Vec<Dice>> {
    prop::collection::vec(any::<Dice>(), 0..most)
}

/// What a host does, in numbers.
fn session(most: usize) -> impl Strategy<Value = Vec<Act>> {
    prop::collection::vec(any::<[u8; 7]>(), 0..most).prop_map(|bytes| acts(bytes.as_flattened()))
}

fn loaded(program: &str) -> Machine {
    let mut machine = Machine::new();
    machine.load(program);
    machine
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_laws_hold_from_an_empty_machine(acts in session(96)) {
        laws::hold(&acts);
    }

    #[test]
    fn the_laws_hold_with_any_program(commands in dice(60), acts in session(32)) {
        let program: String = commands.into_iter().map(|dice| anything(dice) + "\n").collect();
        laws::hold(&[vec![Act::Load(program)], acts].concat());
    }

    #[test]
    fn the_laws_hold_where_most_messages_are_answered(
        functions in any::<Dice>(), links in dice(16), acts in session(48),
    ) {
        let table = [&LIVELY[..], &REMEMBERING[..]].concat();
        laws::hold(&[vec![Act::Load(lively(functions, &links, &table))], acts].concat());
    }

    #[test]
    fn an_edited_network_is_the_one_its_text_makes(one in dice(40), other in dice(40)) {
        // Without messages: what those have done is meant to stay.
        let written = |commands: Vec<Dice>| {
            let commands = commands.into_iter().map(|dice| anything(dice) + "\n");
            let silent = commands.filter(|text| !text.contains("SEND") && !text.contains("STORE"));
            loaded(&silent.collect::<String>()).network_text()
        };
        let (one, other) = (written(one), written(other));
        let mut machine = loaded(&one);
        machine.edit_program(&one, &other);
        let wanted = loaded(&other);
        prop_assert_eq!(machine.network_text(), wanted.network_text(), "{}", one);
        prop_assert_eq!(machine.display(), wanted.display());
        machine.edit_program(&other, &one);
        prop_assert_eq!(machine.network_text(), loaded(&one).network_text(), "{}", other);
    }
}
