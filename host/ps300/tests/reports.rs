//! What reports say: who, made where, which input, which message.

use ps300::language::{Input, parse};
use ps300::network::Places;
use ps300::{Kinds, Machine};

const PROGRAM: &str = "{ Trouble of every kind. }
adder := F:ADDC; SEND 1 TO <2>adder; wrong := F:NOP; CONNECT wrong<1>:<1>adder;
  ratio := F:DIV; huge := F:MULC;
SEND 1e300 TO <2>huge;
turn := ROTATE IN X 0; any := F:NOP; CONNECT any<1>:<1>turn;
nest := BEGIN_STRUCTURE
    inner := F:DIVC;
END_STRUCTURE;
VARIABLE kept, other; fetch := F:FETCH; SEND 'nothing' TO <2>fetch;
";

fn said(machine: &mut Machine) -> Vec<String> {
    machine.reports().iter().map(ToString::to_string).collect()
}

#[test]
fn a_report_names_function_place_input_and_message() {
    let mut m = Machine::new();
    assert_eq!(m.load_named("dials.ps300", PROGRAM), []);
    let kinds = "integer or real or vector2 or vector3 or vector4 or matrix2 or matrix3 or matrix4";
    for (sent, expected) in [
        (
            "SEND 'x' TO <1>wrong;",
            format!(
                "adder (F:ADDC, made at dials.ps300:2 \"adder := F:ADDC;\"): input <1> takes {kinds}, got string 'x'; \
                 the message was dropped"
            ),
        ),
        (
            "SEND 5 TO <1>ratio; SEND 0 TO <2>ratio; SEND 6 TO <1>ratio; SEND 0 TO <2>ratio;",
            "ratio (F:DIV, made at dials.ps300:3 \"ratio := F:DIV;\"): division by zero (2 times); input <1> had 5"
                .to_owned(),
        ),
        (
            "SEND -1e300 TO <1>huge;",
            "huge (F:MULC, made at dials.ps300:3 \"huge := F:MULC;\"): the result is not a finite number (-inf); it \
             was not sent"
                .to_owned(),
        ),
        (
            "SEND FIX(7) TO <1>any;",
            "turn (ROTATE node, made at dials.ps300:5 \"turn := ROTATE IN X 0;\"): input <1> takes matrix3, got \
             integer FIX(7); the message was dropped"
                .to_owned(),
        ),
        (
            "SEND 0 TO <2>nest.inner; SEND 1 TO <1>nest.inner;",
            "nest.inner (F:DIVC, made at dials.ps300:6 \"nest := BEGIN_STRUCTURE\"): division by zero; input <1> had 1"
                .to_owned(),
        ),
        (
            "SEND TRUE TO <1>fetch;",
            "fetch (F:FETCH, made at dials.ps300:9 \"fetch := F:FETCH;\"): there is no \"nothing\"".to_owned(),
        ),
    ] {
        assert_eq!(m.load(sent), [], "{sent}");
        assert_eq!(said(&mut m), [expected], "{sent}");
    }
}

#[test]
fn what_was_made_anew_was_made_elsewhere() {
    let mut m = Machine::new();
    m.load_named("first.ps300", "d := F:DIVC; SEND 0 TO <2>d;");
    m.load("SEND 1 TO <1>d; d := F:DIVC; SEND 0 TO <2>d; SEND 1 TO <1>d;");
    let places: Vec<_> = m
        .reports()
        .iter()
        .filter_map(|report| report.made.clone())
        .collect();
    let shown: Vec<_> = places.iter().map(ToString::to_string).collect();
    assert_eq!(shown, ["first.ps300:1 \"d := F:DIVC;\""]);
    m.load("SEND 1 TO <1>d;");
    assert!(said(&mut m)[0].contains("made at line 1 \"d := F:DIVC;\""));
}

#[test]
fn commands_given_one_by_one_have_places_too() {
    let text = "\n d := F:DIVC; SEND 0 TO <2>d; SEND 1 TO <1>d;";
    let places = Places::new("session", text);
    let mut m = Machine::new();
    for located in parse(text).0 {
        m.execute_at(&located.what, places.at(located.at)).unwrap();
    }
    assert!(said(&mut m)[0].contains("made at session:2 \"d := F:DIVC;\""));
}

#[test]
fn long_messages_are_cut_and_storms_counted() {
    let mut m = Machine::new();
    m.load("n := F:NOT; any := F:NOP; CONNECT any<1>:<1>n;");
    let view = m.declare_sink("view", &[Kinds::NUMBER]).unwrap();
    m.load("CONNECT any<1>:<1>view;");
    for _ in 0..1000 {
        m.send("any", Input::Number(1), "w".repeat(4000).as_str())
            .unwrap();
        m.tick(0.0, 0, 10);
    }
    let said = said(&mut m);
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(
        said.iter()
            .all(|line| line.ends_with("(1000 times)") && line.len() < 250),
        "{said:?}"
    );
    assert!(
        said[1].starts_with("view (host input): input <1> takes integer or real, got string 'www"),
        "{said:?}"
    );
    assert_eq!(m.sink_last(view, 1), None);
}
