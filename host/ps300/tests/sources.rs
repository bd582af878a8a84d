//! Senders that a host declares: they come at any time, stay, and show in no program but by their wires.

use ps300::machine::DeclareError;
use ps300::{Kinds, Limits, Machine, Value};

const OUTPUTS: [Kinds; 2] = [Kinds::REAL, Kinds::BOOLEAN];

fn machine() -> Machine {
    let mut machine = Machine::new();
    machine
        .declare_sink("VIEW", &[Kinds::ANY, Kinds::STRING])
        .expect("a name of its own");
    machine
}

fn arrived(machine: &mut Machine) -> Vec<(u8, Value)> {
    let mut all = Vec::new();
    machine.drain_sinks(|_, _, input, value| all.push((input, value)));
    all
}

#[test]
fn a_source_sends_and_commands_leave_it_alone() {
    let mut m = machine();
    let source = m.declare_source("knobs2", &OUTPUTS).expect("a name of its own");
    assert_eq!(
        m.load("CONNECT KNOBS2<1>:<1>VIEW; CONNECT knobs2<2>:<1>VIEW;"),
        []
    );
    m.emit_from(source.outlet(1), 0.25);
    m.emit_from(source.outlet(3), 9.0);
    assert!(m.emit("Knobs2", 2, true) && !m.emit("knobs2", 3, 1.0));
    m.settle();
    assert_eq!(
        arrived(&mut m),
        [(1, Value::Real(0.25)), (1, Value::Boolean(true))]
    );
    for text in [
        "knobs2 := F:NOP;",
        "DELETE knobs2;",
        "FORGET knobs2;",
        "CONNECT knobs2<3>:<1>VIEW;",
        "CONNECT knobs2<1>:<2>VIEW;",
        "SEND 1 TO <1>knobs2;",
    ] {
        assert_eq!(m.load(text).len(), 1, "{text}");
    }
    assert_eq!(m.load("DELETE k*;"), []);
    assert!(m.is_defined("knobs2"));
}

#[test]
fn declared_again_alike_it_is_the_same_with_its_wires() {
    let mut m = machine();
    let first = m.declare_source("box", &OUTPUTS).expect("a name of its own");
    m.load("CONNECT box<1>:<1>VIEW;");
    let again = m.declare_source("BOX", &OUTPUTS);
    assert_eq!(again, Ok(first));
    m.emit_from(first.outlet(1), 1.0);
    m.settle();
    assert_eq!(arrived(&mut m), [(1, Value::Real(1.0))]);
}

#[test]
fn what_cannot_be_declared_is_said() {
    let mut m = machine();
    m.load("mine := F:NOP;");
    for (name, outputs, refused) in [
        ("VIEW", &OUTPUTS[..], "denotes something already"),
        ("mine", &OUTPUTS[..], "denotes something already"),
        ("DIALS", &OUTPUTS[..], "denotes something already"),
        ("2nd", &OUTPUTS[..], "is not a name"),
        ("none", &[][..], "0 outputs"),
        ("many", &[Kinds::REAL; 128][..], "128 outputs"),
    ] {
        let error = m.declare_source(name, outputs).expect_err(name);
        assert!(error.to_string().contains(refused), "{name}: {error}");
    }
    m.declare_source("box", &OUTPUTS).expect("a name of its own");
    assert!(m.declare_source("box", &OUTPUTS[..1]).is_err(), "it has others");
    let mut full = Machine::with_limits(Limits {
        instances_max: ps300::machine::devices::SOURCES.len(),
        ..Limits::default()
    });
    let error = full.declare_source("box", &OUTPUTS).expect_err("no room");
    assert!(matches!(error, DeclareError::Full { .. }), "{error}");
}

/// In whatever order devices come, and whatever was made and deleted before, the text is the same.
#[test]
fn the_text_does_not_depend_on_when_devices_came() {
    let program = "a := F:NOP; CONNECT box<1>:<1>a; CONNECT axes<2>:<1>a; CONNECT a<1>:<1>VIEW;";
    let text = |names: &[&str]| {
        let mut m = machine();
        m.load("gone := F:NOP; gone_too := F:NOP;");
        m.declare_source(names[0], &OUTPUTS).expect("a name of its own");
        m.load("DELETE gone; DELETE gone_too;");
        m.declare_source(names[1], &OUTPUTS).expect("a name of its own");
        assert_eq!(m.load(program), []);
        (m.network_text(), m.network_text_with_state(), m.dot())
    };
    let all = text(&["box", "axes"]);
    assert_eq!(all, text(&["axes", "box"]));
    assert!(!all.0.contains("box :="), "{}", all.0);
    assert!(all.0.contains("CONNECT box<1>:<1>a;"), "{}", all.0);
}

#[test]
fn edits_and_their_undo_leave_wires_of_devices_alone() {
    let mut m = machine();
    m.declare_source("box", &OUTPUTS).expect("a name of its own");
    let (from, to) = (
        "a := F:ADDC; CONNECT box<1>:<1>a; CONNECT a<1>:<1>VIEW; SEND 1 TO <2>a;",
        "a := F:ADDC; CONNECT box<1>:<1>a; CONNECT box<1>:<1>VIEW; CONNECT a<1>:<1>VIEW; SEND 1 TO <2>a;",
    );
    assert_eq!(m.load(from), []);
    let before = m.network_text_with_state();
    assert_eq!(m.edit_program(from, to), []);
    let after = m.network_text_with_state();
    let sent = |m: &mut Machine| {
        m.emit("box", 1, 2.0);
        m.settle();
        arrived(m).into_iter().map(|(_, value)| value).collect::<Vec<_>>()
    };
    assert_eq!(sent(&mut m), [Value::Real(2.0), Value::Real(3.0)]);
    m.restore(&after, &before);
    assert_eq!(sent(&mut m), [Value::Real(3.0)]);
    assert_eq!(m.network_text_with_state(), before);
    // A device that comes now has no part in what is taken back.
    m.declare_source("late", &OUTPUTS).expect("a name of its own");
    m.load("CONNECT late<1>:<1>VIEW;");
    assert_eq!(m.load("DISCONNECT late<1>:<1>VIEW; CONNECT late<2>:<1>VIEW;"), []);
    m.restore(&before, &after);
    assert!(!sent(&mut m).is_empty());
}

/// Each message with a time of its own: what lies between two counts, however many ticks there are.
#[test]
fn time_passes_between_messages_of_one_tick() {
    let lag = |times: &[f64]| {
        let mut m = machine();
        m.declare_source("pen", &[Kinds::REAL])
            .expect("a name of its own");
        assert_eq!(
            m.load("f := F:DR_ONE_EURO; CONNECT pen<1>:<1>f; CONNECT f<1>:<1>VIEW;"),
            []
        );
        m.tick(0.0, 0, 1000);
        for (at, secs) in times.iter().enumerate() {
            m.pass_to(*secs, 1000);
            m.emit("pen", 1, at as f64);
            m.go_on(1000);
        }
        arrived(&mut m)
    };
    assert_ne!(lag(&[0.01, 0.02, 0.03]), lag(&[0.03, 0.03, 0.03]));
    assert_eq!(lag(&[0.01, 0.02, 0.03]), lag(&[0.01, 0.02, 0.03]));
    let mut m = machine();
    m.load("t := F:CLTICKS; SEND FIX(1) TO <1>t; SEND 0 TO <2>t; SEND 1 TO <3>t; SEND TRUE TO <4>t;");
    m.tick(1.0, 1, 10);
    m.pass_to(0.5, 10);
    m.pass_to(f64::NAN, 10);
    m.pass_to(1.5, 10);
    assert_eq!(m.secs(), 1.5);
    m.tick(1.25, 2, 10);
    assert_eq!(m.secs(), 1.5, "time does not go back");
}
