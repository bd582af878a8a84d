//! What nobody should send and somebody will: the machine says so, drops it, and goes on.

use std::fmt::Write;

use ps300::language::{Input, Severity};
use ps300::{Kinds, Limits, Machine, Ran, Value};

fn said(machine: &mut Machine) -> String {
    let lines: Vec<_> = machine.reports().iter().map(ToString::to_string).collect();
    lines.join("\n")
}

fn errors(machine: &mut Machine, text: &str) -> usize {
    let found = machine.load(text);
    found
        .iter()
        .filter(|found| found.severity == Severity::Error)
        .count()
}

/// Whether a dial still turns something, whatever happened before.
fn goes_on(machine: &mut Machine) -> bool {
    assert_eq!(errors(machine, "alive := F:NOP; CONNECT DIALS<8>:<1>alive;"), 0);
    machine.watch("alive", 1);
    machine.drain_watched().count();
    machine.emit("DIALS", 8, 0.5);
    machine.settle();
    machine
        .drain_watched()
        .any(|watched| watched.value == Value::Real(0.5))
}

#[test]
fn a_text_of_many_commands_ends_although_something_goes_round() {
    let limits = Limits {
        firings_per_command: 1000,
        firings_per_load: 10_000,
        ..Limits::default()
    };
    let mut m = Machine::with_limits(limits);
    m.load("a := F:NOP; b := F:NOP; CONNECT a<1>:<1>b; CONNECT b<1>:<1>a; SEND 1 TO <1>a;");
    let mut text = String::from("sum := F:ACCUMULATE; SEND 0 TO <2>sum;\n");
    for _ in 0..5000 {
        text.push_str("SEND 1 TO <1>sum;\n");
    }
    m.watch("a", 1);
    assert_eq!(errors(&mut m, &text), 0);
    // Every command could have had a thousand firings: five million.
    let turns = m.drain_watched().count();
    assert!((4000..100_000).contains(&turns), "{turns}");
    m.settle();
    assert_eq!(m.remembered("sum").first(), Some(&Value::Real(5000.0)));
    assert!(goes_on(&mut m));
}

#[test]
fn names_are_240_characters_long_or_warned_of_and_work_all_the_same() {
    for (length, warned) in [(240, false), (241, true), (5000, true)] {
        let name = "n".repeat(length);
        let mut m = Machine::new();
        let found = m.load(&format!(
            "{name} := F:ADD; CONNECT DIALS<1>:<1>{name}; SEND 2 TO <2>{name};"
        ));
        assert_eq!(!found.is_empty(), warned, "{length}");
        assert!(
            found.iter().all(|found| found.severity == Severity::Warning),
            "{length}"
        );
        m.watch(&name.to_uppercase(), 1);
        m.emit("DIALS", 1, 1.0);
        m.tick(0.0, 0, 10);
        let sums: Vec<_> = m.drain_watched().map(|watched| watched.value).collect();
        assert_eq!(sums, [Value::Real(3.0)], "{length}");
        let mut again = Machine::new();
        assert_eq!(errors(&mut again, &m.network_text()), 0, "{length}");
        assert!(again.is_defined(&name), "{length}");
    }
}

#[test]
fn full_queues_full_networks_and_full_hosts_are_named() {
    let limits = Limits {
        queue_max: 4,
        behind_max: 6,
        undrained_max: 3,
        ..Limits::default()
    };
    let mut m = Machine::with_limits(limits);
    m.declare_sink("view", &[Kinds::ANY]).unwrap();
    m.load("a := F:ADD; b := F:ADD; c := F:NOP; CONNECT c<1>:<1>view;");
    m.watch("c", 1);
    for number in 0..6 {
        for name in ["a", "b", "c"] {
            m.send(name, Input::Number(1), f64::from(number)).unwrap();
        }
        m.tick(0.0, 0, 100);
    }
    let text = said(&mut m);
    for part in [
        "a (F:ADD, made at line 1 \"a := F:ADD;\"): the queue of input <1> is full; the newest message, 4, was dropped \
         (2 times)",
        "b (F:ADD, made at line 1 \"b := F:ADD;\"): the queue of input <1> is full; the newest message, 4, was dropped",
        "view (host input): the queue of input <1> is full; the newest message, 3, was dropped (3 times)",
        "too many watched messages were not taken; the newest was not recorded (3 times)",
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    m.load("d := F:ADD; SEND 1 TO <1>d; SEND 2 TO <1>d;");
    assert!(
        said(&mut m)
            .contains("d (F:ADD, made at line 1 \"d := F:ADD;\"): the network holds as many messages")
    );
    m.drain_watched().count();
    assert!(goes_on(&mut m));
}

#[test]
fn results_that_are_no_numbers_stay_where_they_arose() {
    let huge = 1e308;
    for (function, sent) in [
        ("ADD", [huge, huge]),
        ("SUB", [-huge, huge]),
        ("MUL", [huge, -huge]),
        ("DIV", [huge, 1e-300]),
        ("DIV", [1.0, 0.0]),
    ] {
        let mut m = Machine::new();
        m.load(&format!(
            "f := F:{function}; after := F:NOP; CONNECT f<1>:<1>after;"
        ));
        m.watch("after", 1);
        for (input, number) in (1..).zip(sent) {
            m.send("f", Input::Number(input), number).unwrap();
        }
        m.settle();
        assert_eq!(m.drain_watched().count(), 0, "{function}");
        assert_eq!(m.reports().len(), 1, "{function}");
        assert!(goes_on(&mut m), "{function}");
    }
    let mut m = Machine::new();
    m.load("sum := F:ACCUMULATE; SEND 0 TO <2>sum; turn := F:DXROTATE; SEND 1e308 TO <3>turn;");
    m.watch("sum", 1);
    for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(m.send("sum", Input::Number(1), number).is_err());
        m.emit("DIALS", 1, number);
    }
    m.load("SEND 1e308 TO <1>sum; SEND 1e308 TO <1>sum; SEND 1 TO <1>sum; SEND 1e308 TO <1>turn;");
    assert_eq!(m.drain_watched().count(), 2);
    let text = said(&mut m);
    for part in [
        "DIALS (device): the result is not a finite number (NaN)",
        "sum (F:ACC",
        "turn (F:DX",
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
}

#[test]
fn a_megabyte_of_anything_is_read() {
    let mut valid = String::from("sum := F:ACCUMULATE; SEND 0 TO <2>sum;\n");
    while valid.len() < 1 << 20 {
        valid.push_str("SEND 1 TO <1>sum;\n");
    }
    let mut m = Machine::new();
    assert_eq!(m.load(&valid), []);
    assert_eq!(m.remembered("sum").first(), Some(&Value::Real(58_253.0)));
    for piece in [
        "x",
        ";",
        "(",
        "'",
        "{",
        "}",
        "<",
        "-",
        "1",
        "1,",
        "\u{2603}",
        "\0",
        "BEGIN_STRUCTURE ",
        "BEGIN ",
        "n := ",
        "SEND 1 TO ",
        "SEND 1 TO <1>sum, ",
        "a := F:NOP; ",
        "CONNECT a<1>:<1>a; ",
        "VECTOR_LIST N=2 0,0 ",
    ] {
        let text = piece.repeat((1 << 20) / piece.len());
        assert!(m.load(&text).len() < 1000, "{piece:?}");
        let text = piece.repeat((1 << 16) / piece.len());
        let text = format!("v := VECTOR_LIST {text}; w := CHARACTERS '{text}';");
        assert!(m.load(&text).len() < 1000, "{piece:?}");
    }
    m.load("INITIALIZE;");
    assert!(goes_on(&mut m));
}

#[test]
fn deep_nesting_and_long_references_are_cut() {
    let mut m = Machine::new();
    let deep = |count: usize| {
        let text = "s := BEGIN_STRUCTURE ".to_owned() + &"t := BEGIN_STRUCTURE ".repeat(count);
        text + "NIL; " + &"END_STRUCTURE; ".repeat(count + 1)
    };
    assert_eq!(errors(&mut m, &deep(20)), 0);
    assert!(errors(&mut m, &deep(20_000)) > 0);
    assert!(errors(&mut m, &("v := V3D".to_owned() + &"(".repeat(100_000))) > 0);
    let mut text = String::from("n0 := VECTOR_LIST N=2 0,0 1,1;\n");
    for at in 1..20_000 {
        let _ = writeln!(text, "n{at} := SCALE BY 1 THEN n{};", at - 1);
    }
    text.push_str("DISPLAY n19999; n0 := INSTANCE OF n19999;");
    assert_eq!(errors(&mut m, &text), 1, "only the last would contain itself");
    assert!(m.display().strokes.is_empty(), "cut before the lines are reached");
    assert!(goes_on(&mut m));
}

#[test]
fn what_is_not_there_is_not_sent_to() {
    let mut m = Machine::new();
    m.declare_sink("view", &[Kinds::ANY]).unwrap();
    m.load("s := F:SEND; SETUP CNESS TRUE <2>s; SETUP CNESS TRUE <3>s; n := F:NOP; t := SCALE BY 1;");
    for (name, input) in [
        ("n", 2),
        ("n", 0),
        ("n", 300),
        ("n", -1),
        ("view", 2),
        ("t", 2),
        ("gone", 1),
        ("s", 99),
    ] {
        m.load(&format!(
            "SEND '{name}' TO <2>s; SEND FIX({input}) TO <3>s; SEND 5 TO <1>s;"
        ));
        let text = said(&mut m);
        assert_eq!(text.lines().count(), 1, "{name} {input}: {text}");
    }
    assert!(!m.emit("DIALS", 9, 1.0) && !m.emit("DIALS", 0, 1.0) && !m.emit("nobody", 1, 1.0));
    m.load("x := F:XVECTOR; CONNECT DIALS<1>:<1>x;");
    m.emit("DIALS", 1, "a string, from a dial");
    m.settle();
    assert!(said(&mut m).contains("input <1> takes integer or real, got string 'a string, from a dial'"));
    assert!(goes_on(&mut m));
    assert!(matches!(m.tick(-1.0, 0, 10), Ran::Quiet { .. }));
    assert!(matches!(m.tick(f64::NAN, 0, 10), Ran::Quiet { .. }));
    assert_eq!(m.secs(), 0.0);
    m.tick(f64::INFINITY, u64::MAX, u32::MAX);
    assert!(m.secs().is_finite(), "{}", m.secs());
}
