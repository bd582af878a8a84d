//! Patching: a machine becomes what a program makes, and only what differs is touched.

use ps300::language::{Input, Severity, parse};
use ps300::network::Watched;
use ps300::{Command, Machine, Value};

fn machine(program: &str) -> Machine {
    let mut machine = Machine::new();
    assert_eq!(machine.load(program), [], "{program}");
    machine
}

fn commands(text: &str) -> Vec<Command> {
    let (commands, found) = parse(text);
    assert_eq!(found, [], "{text}");
    commands.into_iter().map(|located| located.what).collect()
}

fn turn(machine: &mut Machine, by: f64) {
    machine.emit("DIALS", 1, by);
    machine.settle();
}

fn sum(machine: &Machine, name: &str) -> Option<Value> {
    machine.remembered(name).first().cloned()
}

const BASE: &str = "
a := F:ACCUMULATE; b := F:ADDC; SEND 5 TO <2>b; r := TRANSLATE BY 0,0 THEN l; l := VECTOR_LIST N=2 0,0 1,0;
v := F:XVECTOR; CONNECT DIALS<1>:<1>a; CONNECT a<1>:<1>b; CONNECT a<1>:<1>v; CONNECT v<1>:<1>r; DISPLAY r;
";

#[test]
fn what_stays_goes_on_and_what_differs_is_as_written() {
    let other = "
        v := F:XVECTOR; a := F:ACCUMULATE; c := F:MULC; SEND 2 TO <2>c; l := VECTOR_LIST N=2 0,0 1,0;
        r := TRANSLATE BY 0,0 THEN l; CONNECT a<1>:<1>v; CONNECT a<1>:<1>c; CONNECT DIALS<1>:<1>a; CONNECT v<1>:<1>r;
        DISPLAY r;";
    let mut m = machine(BASE);
    turn(&mut m, 3.0);
    let seen = m.display();
    assert_eq!(m.patch(&commands(other)), []);
    assert_eq!(sum(&m, "a"), Some(Value::Real(3.0)));
    assert_eq!(m.display(), seen, "the picture stays where messages put it");
    assert!(!m.is_defined("b"));
    assert_eq!(
        m.network_text(),
        machine(other).network_text(),
        "in the same order too"
    );
    turn(&mut m, 1.0);
    assert_eq!(sum(&m, "a"), Some(Value::Real(4.0)));
}

#[test]
fn messages_are_delivered_in_the_order_of_the_program() {
    let order = |wires: [&str; 3]| {
        let wires = wires.map(|to| format!("CONNECT n<1>:<1>{to};")).concat();
        format!("n := F:NOP; x := F:NOP; y := F:NOP; z := F:NOP; {wires}")
    };
    let heard = |m: &mut Machine| {
        for name in ["x", "y", "z"] {
            m.watch(name, 1);
        }
        m.send("n", Input::Number(1), 1.0).expect("takes it");
        m.settle();
        m.drain_watched().map(|watched| watched.name).collect::<Vec<_>>()
    };
    let mut m = machine(&order(["x", "y", "z"]));
    for wires in [["z", "y", "x"], ["y", "x", "z"], ["x", "z", "y"]] {
        m.patch(&commands(&order(wires)));
        assert_eq!(heard(&mut m), heard(&mut machine(&order(wires))), "{wires:?}");
    }
}

#[test]
fn constants_change_where_the_program_changes_them() {
    let held = |m: &Machine, name: &str| {
        let views = m.instances();
        let view = views
            .iter()
            .find(|it| it.name.as_str() == name)
            .expect("is there");
        view.inputs[1].front.cloned()
    };
    let text = "b := F:ADDC; c := F:ADDC; SEND 1 TO <2>b; SEND 1 TO <2>c; CONNECT DIALS<2>:<2>c;";
    let mut m = machine(text);
    m.emit("DIALS", 2, 9.0);
    m.settle();
    m.load("SEND 7 TO <2>b;");
    m.patch(&commands(text));
    assert_eq!(held(&m, "b"), Some(Value::Real(1.0)), "the program's");
    assert_eq!(held(&m, "c"), Some(Value::Real(9.0)), "the dial's");
    assert_eq!(m.edit_program(text, &text.replace("1 TO <2>c", "2 TO <2>c")), []);
    assert_eq!(held(&m, "c"), Some(Value::Real(2.0)), "the editor's");
    assert_eq!(m.edit_program(text, &text.replace("SEND 1 TO <2>b;", "")), []);
    assert_eq!(held(&m, "b"), None, "not sent any more");
}

#[test]
fn an_edited_program_tells_what_is_new_and_nothing_else() {
    let text = "a := F:ACCUMULATE; SEND 1 TO <1>a;";
    let mut m = machine(text);
    assert_eq!(sum(&m, "a"), Some(Value::Real(1.0)));
    assert_eq!(m.edit_program(text, &format!("{text} SEND 10 TO <1>a;")), []);
    assert_eq!(sum(&m, "a"), Some(Value::Real(11.0)));
    let more = format!("{text} SEND 10 TO <1>a; b := F:ACCUMULATE; CONNECT b<1>:<1>a; SEND 100 TO <1>b;");
    assert_eq!(m.edit_program(&format!("{text} SEND 10 TO <1>a;"), &more), []);
    assert_eq!(
        sum(&m, "a"),
        Some(Value::Real(111.0)),
        "what is new reaches what was there"
    );
    let found = m.edit_program(&more, &more.replace("CONNECT b<1>", "CONNECT nobody<1>"));
    assert_eq!(
        found.iter().filter(|it| it.severity == Severity::Error).count(),
        1
    );
    assert_eq!(m.connections().len(), 1, "with a new error nothing is changed");
}

#[test]
fn a_structure_made_anew_keeps_the_functions_it_still_has() {
    let structure = |more: &str| {
        format!(
            "s := BEGIN_STRUCTURE t := TRANSLATE BY 0,0; x := F:ACCUMULATE; y := F:ADDC; {more} END_STRUCTURE;
            CONNECT DIALS<1>:<1>s.x; CONNECT s.x<1>:<1>s.y;"
        )
    };
    let mut m = machine(&structure(""));
    m.load("SEND V2D(4,4) TO <1>s.t;");
    turn(&mut m, 2.0);
    let next = structure("INSTANCE OF l;").replace("F:ADDC", "F:MULC");
    assert_eq!(m.patch(&commands(&next)), []);
    assert_eq!(sum(&m, "s.x"), Some(Value::Real(2.0)));
    assert_eq!(m.network_text(), {
        let mut fresh = Machine::new();
        fresh.load(&next);
        fresh.network_text()
    });
    assert!(
        m.network_text_with_state().contains("V2D(4,4) TO <1>s.t"),
        "a member alike is told again"
    );
}

#[test]
fn undo_brings_back_what_was_lost_and_leaves_the_rest() {
    let mut m = machine(BASE);
    turn(&mut m, 3.0);
    for edit in [
        "DELETE a;",
        "a := F:NOP;",
        "DELETE *;",
        "INITIALIZE;",
        "FORGET l;",
        "r := NIL;",
        "PREFIX r WITH SCALE BY 2; FOLLOW r WITH SCALE BY 3;",
        "DISCONNECT a:ALL; CONNECT a<1>:<1>v; CONNECT a<1>:<1>b;",
        "SEND 6 TO <2>b;",
        "REMOVE r; DISPLAY l; DISPLAY r;",
    ] {
        let before = m.network_text_with_state();
        m.load(edit);
        let after = m.network_text_with_state();
        m.restore(&after, &before);
        assert_eq!(m.network_text_with_state(), before, "{edit}");
        m.restore(&before, &after);
        assert_eq!(m.network_text_with_state(), after, "{edit}");
        m.restore(&after, &before);
    }
    let before = m.network_text_with_state();
    m.load("DELETE b;");
    let after = m.network_text_with_state();
    turn(&mut m, 1.0);
    m.restore(&after, &before);
    assert_eq!(
        sum(&m, "a"),
        Some(Value::Real(4.0)),
        "what came between the two stays"
    );
}

#[test]
fn what_is_refused_is_named() {
    let mut m = machine(BASE);
    let refused = m.patch(&commands("a := F:NOTHING; b := F:NOP;"));
    assert_eq!(refused.len(), 1);
    assert_eq!(refused[0].command, 0);
    assert!(m.is_defined("b") && !m.is_defined("a"));
}

#[test]
fn host_parameters_stay() {
    let mut m = Machine::new();
    m.declare_sink("POSE", &[ps300::Kinds::NUMBER]).expect("a name");
    let text = "n := F:NOP; CONNECT n<1>:<1>POSE;";
    assert_eq!(m.load(text), []);
    m.patch(&commands(
        "n := F:NOP; z := F:NOP; CONNECT z<1>:<1>POSE; CONNECT n<1>:<1>z;",
    ));
    m.send("n", Input::Number(1), 2.0).expect("takes it");
    m.settle();
    let mut arrived = Vec::new();
    m.drain_sinks(|_, name, _, value| arrived.push((name.to_owned(), value)));
    assert_eq!(arrived, [("POSE".to_owned(), Value::Real(2.0))]);
    let _: Vec<Watched> = m.drain_watched().collect();
}

#[test]
fn trouble_is_traced_to_the_text_that_made_it() {
    let mut m = Machine::new();
    assert_eq!(
        m.load_named("first.ps300", "a := F:ADDC; SEND 1 TO <2>a; b := F:NOP;"),
        []
    );
    let from = m.network_text();
    assert_eq!(
        m.edit_program(&from, &format!("{from}\nc := F:ADDC; SEND 1 TO <2>c;")),
        []
    );
    for name in ["a", "c"] {
        m.send(name, Input::Number(1), "text").expect_err("takes numbers");
        m.load(&format!(
            "VARIABLE v; STORE V2D(1,2) IN <1>v; SEND VALUE(v) TO <1>{name};"
        ));
    }
    let said: Vec<String> = m.reports().iter().map(ToString::to_string).collect();
    assert!(said[0].contains("first.ps300:1"), "{said:?}");
    assert!(said[1].contains("program:"), "{said:?}");
}
