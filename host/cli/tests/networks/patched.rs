//! Shipped networks exchanged for one another while they run: what they have in common goes on as it was.

use ps300::Value;
use ps300::language::{Command, Located, parse, print};

use crate::hands::{Draws, Hands};
use crate::session::root;
use crate::shipped::{act, shipped, with_what_it_needs};

/// What files of `networks` say, one after the other.
fn program(names: &[&str]) -> Vec<Command> {
    let read = |name: &&str| {
        let text = std::fs::read_to_string(root().join("networks").join(name)).expect("readable");
        let (commands, remarks) = parse(&text);
        assert_eq!(remarks, [], "{name}");
        commands
    };
    let commands = names.iter().flat_map(read);
    commands.map(|Located { what, .. }| what).collect()
}

/// What a machine is made of: definitions, wires and what is displayed, without what was sent, in any order.
fn made_of(hands: &Hands) -> Vec<String> {
    let all = hands.machine.program();
    let made = all
        .iter()
        .filter(|command| !matches!(command, Command::Send { .. }));
    let mut made: Vec<String> = made.map(print).collect();
    made.sort();
    made
}

#[test]
fn a_network_patched_to_what_it_is_goes_on_as_if_nothing_had_been() {
    for name in &shipped() {
        let files = with_what_it_needs(name);
        let mut hands = Hands::on(&files);
        let mut draws = Draws(11);
        (0..60).for_each(|_| act(&mut draws)(&mut hands));
        let before = hands.machine.network_text_with_state();
        assert_eq!(hands.machine.patch(&program(&files)), [], "{name}");
        assert!(hands.machine.network_text_with_state() == before, "{name}");
    }
}

#[test]
fn any_network_becomes_any_other_while_hands_are_on_it() {
    let names = shipped();
    for from in &names {
        let mut hands = Hands::on(&with_what_it_needs(from));
        let mut draws = Draws(13);
        for to in &names {
            (0..8).for_each(|_| act(&mut draws)(&mut hands));
            let files = with_what_it_needs(to);
            assert_eq!(hands.machine.patch(&program(&files)), [], "{from}, then {to}");
            assert_eq!(made_of(&hands), made_of(&Hands::on(&files)), "{from}, then {to}");
        }
    }
}

#[test]
fn the_hand_keeps_its_angles_when_it_is_patched_from_the_lamp_to_the_figure() {
    let both = ["mirror/lamp.ps300", "mirror/figure.ps300"];
    let to = |name: &'static str| program(&[both[0], both[1], name]);
    let mut hands = Hands::on(&[both[0], both[1], "mirror/dials-to-lamp.ps300"]);
    for name in ["turn", "figure_turn", "lamp_turn"] {
        assert!(hands.machine.watch(name, 1), "{name}");
    }
    let angle = |hands: &mut Hands, turns: f64| {
        hands.turn(1, turns);
        let seen: Vec<_> = hands.machine.drain_watched().collect();
        let names: Vec<_> = seen.iter().map(|seen| seen.name.as_str().to_owned()).collect();
        let angle = seen.first().map(|seen| seen.value.clone());
        (angle, names.join(" "))
    };
    assert_eq!(
        angle(&mut hands, 0.25),
        (Some(Value::from(45.0)), "turn lamp_turn".to_owned())
    );
    assert_eq!(hands.machine.patch(&to("mirror/dials-to-figure.ps300")), []);
    assert_eq!(
        angle(&mut hands, 0.25),
        (Some(Value::from(90.0)), "turn figure_turn".to_owned())
    );
    assert_eq!(hands.machine.patch(&to("mirror/dials-to-lamp.ps300")), []);
    assert_eq!(
        angle(&mut hands, -0.5),
        (Some(Value::from(0.0)), "turn lamp_turn".to_owned())
    );
}
