//! Large networks: nothing that commands do takes longer for each instance because there are many.
//!
//! Were any of it quadratic in the number of instances, these tests would run for minutes, not seconds.

use std::fmt::Write;

use ps300::{Limits, Machine, Ran};

const MANY: usize = 50_000;

fn chain(count: usize) -> String {
    let mut text = String::new();
    for at in 0..count {
        let _ = writeln!(text, "n{at} := F:ADDC; SEND 1 TO <2>n{at};");
        let _ = match at.checked_sub(1) {
            None => writeln!(text, "CONNECT DIALS<1>:<1>n{at};"),
            Some(before) => writeln!(text, "CONNECT n{before}<1>:<1>n{at};"),
        };
    }
    text
}

fn machine() -> Machine {
    Machine::with_limits(Limits {
        fan_out_max: MANY,
        firings_per_batch: u32::MAX,
        ..Limits::default()
    })
}

fn turned(machine: &mut Machine) -> (Ran, Option<f64>) {
    let last = format!("n{}", MANY - 1);
    machine.watch(&last, 1);
    machine.emit("DIALS", 1, 0.5);
    let ran = machine.tick(0.0, 0, u32::MAX);
    let sum = machine
        .drain_watched()
        .last()
        .and_then(|watched| watched.value.as_number());
    (ran, sum)
}

#[test]
fn a_long_chain_is_loaded_run_printed_redefined_and_deleted() {
    let text = chain(MANY);
    let mut m = machine();
    assert_eq!(m.load(&text), []);
    let whole = (Ran::Quiet { firings: MANY as u32 }, Some(MANY as f64 + 0.5));
    assert_eq!(turned(&mut m), whole);
    let printed = m.network_text();
    let mut again = machine();
    assert_eq!(again.load(&printed), []);
    assert_eq!(turned(&mut again), whole);
    // Every name anew: each definition removes an instance with its wires.
    assert_eq!(again.load(&text), []);
    assert_eq!(turned(&mut again), whole);
    for at in (0..MANY).step_by(2) {
        let _ = again.load(&format!("DELETE n{at};"));
    }
    assert_eq!(again.load("DELETE n*;"), []);
    assert_eq!(again.instances().len(), Machine::new().instances().len());
    assert_eq!(again.load(&text), []);
    assert_eq!(turned(&mut again), whole);
}

#[test]
fn a_wide_fan_is_joined_and_parted() {
    let mut text = String::from("hub := F:NOP; sum := F:ACCUMULATE;\n");
    for at in 0..MANY {
        let _ = writeln!(
            text,
            "n{at} := F:NOP; CONNECT hub<1>:<1>n{at}; CONNECT n{at}<1>:<1>sum;"
        );
    }
    let mut m = machine();
    assert_eq!(m.load(&text), []);
    assert_eq!(m.outlet("hub", 1).map(|hub| m.listeners(hub)), Some(MANY));
    m.load("SEND 1 TO <1>hub;");
    m.tick(0.0, 0, u32::MAX);
    assert!(!m.remembered("sum").is_empty());
    assert_eq!(m.load("DELETE n*;"), []);
    assert_eq!(m.connections(), []);
}

#[test]
fn many_structures_are_redefined() {
    let mut text = String::new();
    for at in 0..MANY / 10 {
        let _ = writeln!(
            text,
            "s{at} := BEGIN_STRUCTURE a := SCALE BY 2; b := F:NOP; INSTANCE OF s{at}_; END_STRUCTURE;"
        );
    }
    let mut m = machine();
    for _ in 0..2 {
        let errors = m.load(&text);
        assert!(
            errors
                .iter()
                .all(|error| error.message.contains("nothing defines it")),
            "{:?}",
            errors.first()
        );
    }
    assert_eq!(m.instances().len(), Machine::new().instances().len() + MANY / 10);
}
