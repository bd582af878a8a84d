//! How messages move: queues, constants, order, bounds, and what becomes of connections.

use std::fmt::Write;

use ps300::language::{Input, literal};
use ps300::{Kinds, Limits, Machine, Ran, Value};

fn machine(program: &str) -> Machine {
    let mut machine = Machine::new();
    let diagnostics = machine.load(program);
    assert!(diagnostics.is_empty(), "{diagnostics:?}");
    machine
}

/// What the named outputs have sent since the last look, as `f<1> 2`.
fn seen(machine: &mut Machine) -> Vec<String> {
    machine
        .drain_watched()
        .map(|watched| format!("{}<{}> {}", watched.name, watched.output, literal(&watched.value)))
        .collect()
}

fn reports(machine: &mut Machine) -> Vec<String> {
    machine.reports().iter().map(ToString::to_string).collect()
}

fn errors(machine: &mut Machine, program: &str) -> Vec<String> {
    machine.load(program).iter().map(ToString::to_string).collect()
}

#[test]
fn unequal_streams_pair_first_with_first() {
    let mut m = machine("a := F:ADD;");
    m.watch("a", 1);
    m.load("SEND 1 TO <1>a; SEND 2 TO <1>a; SEND 3 TO <1>a; SEND 10 TO <2>a; SEND 20 TO <2>a;");
    assert_eq!(seen(&mut m), ["a<1> 11", "a<1> 22"]);
    assert_eq!(m.instances().last().map(|a| a.inputs[0].waiting), Some(1));
}

#[test]
fn constants_are_sampled_and_do_not_fire() {
    let mut m = machine("a := F:ADDC;");
    m.watch("a", 1);
    m.load("SEND 1 TO <2>a; SEND 2 TO <2>a;");
    assert_eq!(seen(&mut m), [""; 0]);
    m.load("SEND 10 TO <1>a; SEND 3 TO <2>a; SEND 10 TO <1>a;");
    assert_eq!(seen(&mut m), ["a<1> 12", "a<1> 13"]);
}

#[test]
fn a_constant_that_was_missing_releases_what_waited_for_it() {
    let mut m = machine("a := F:ADDC; SEND 1 TO <1>a; SEND 2 TO <1>a;");
    m.watch("a", 1);
    m.load("SEND 10 TO <2>a;");
    assert_eq!(seen(&mut m), ["a<1> 11", "a<1> 12"]);
}

#[test]
fn cness_changes_one_input_of_one_instance() {
    let mut m = machine("a := F:ADD; b := F:ADD; SETUP CNESS TRUE <2>a;");
    m.watch("a", 1);
    m.watch("b", 1);
    m.load("SEND 1 TO <2>a; SEND 5 TO <1>a; SEND 6 TO <1>a; SEND 1 TO <2>b; SEND 5 TO <1>b; SEND 6 TO <1>b;");
    assert_eq!(seen(&mut m), ["a<1> 6", "a<1> 7", "b<1> 6"]);
    m.load("SETUP CNESS FALSE <2>a; SEND 7 TO <1>a; SEND 2 TO <2>a;");
    assert_eq!(seen(&mut m), ["a<1> 9"]);
}

#[test]
fn an_instance_of_constants_only_never_fires() {
    let mut m = machine("a := F:NOP; SETUP CNESS TRUE <1>a; SEND 1 TO <1>a;");
    m.watch("a", 1);
    assert_eq!(m.tick(0.0, 0, 100), Ran::Quiet { firings: 0 });
    assert_eq!(seen(&mut m), [""; 0]);
}

#[test]
fn one_output_delivers_in_the_order_of_connect_and_twice_is_once() {
    let mut m = machine(
        "n := F:NOP; c := F:CONCATENATE; CONNECT n<1>:<2>c; CONNECT n<1>:<1>c; CONNECT n<1>:<2>c;
         x := F:NOP; y := F:NOP; CONNECT n<1>:<1>y; CONNECT n<1>:<1>x;",
    );
    assert_eq!(
        reports(&mut m),
        ["n (output <1>, made at line 1 \"n := F:NOP;\"): already connected to <2>c; nothing changed"]
    );
    for name in ["c", "x", "y"] {
        m.watch(name, 1);
    }
    m.load("SEND 'a' TO <1>n;");
    assert_eq!(seen(&mut m), ["c<1> 'aa'", "y<1> 'a'", "x<1> 'a'"]);
}

#[test]
fn many_outputs_to_one_input_merge_in_the_order_of_arrival() {
    let mut m = machine(
        "x := F:XVECTOR; y := F:YVECTOR; a := F:ACCUMULATE; SEND V3D(0,0,0) TO <2>a;
         CONNECT x<1>:<1>a; CONNECT y<1>:<1>a; CONNECT DIALS<1>:<1>x; CONNECT DIALS<2>:<1>y;",
    );
    m.watch("a", 1);
    m.emit("dials", 2, 2.0);
    m.emit("DIALS", 1, 1.0);
    m.tick(0.0, 0, 100);
    assert_eq!(seen(&mut m), ["a<1> V3D(0,2,0)", "a<1> V3D(1,2,0)"]);
}

#[test]
fn disconnecting_leaves_what_is_queued() {
    let mut m = machine("n := F:NOP; a := F:ADD; CONNECT n<1>:<1>a; SEND 1 TO <1>n; DISCONNECT n<1>:<1>a;");
    m.watch("a", 1);
    m.load("SEND 5 TO <1>n; SEND 10 TO <2>a; SEND 10 TO <2>a;");
    assert_eq!(seen(&mut m), ["a<1> 11"]);
    assert_eq!(
        errors(&mut m, "DISCONNECT n<1>:<1>a;"),
        ["1:1: error: n<1> is not connected to <1>a"]
    );
}

#[test]
fn a_redefined_name_starts_empty_and_unconnected() {
    let mut m = machine(
        "n := F:NOP; a := F:ADD; b := F:NOP; CONNECT n<1>:<1>a; CONNECT a<1>:<1>b; SEND 1 TO <1>a; a := F:ADD;",
    );
    m.watch("a", 1);
    m.watch("b", 1);
    m.load("SEND 9 TO <1>n; SEND 2 TO <1>a; SEND 3 TO <2>a;");
    assert_eq!(seen(&mut m), ["a<1> 5"]);
}

#[test]
fn a_wrong_kind_is_dropped_alone_and_reported_once() {
    let mut m = machine("a := F:ADD; n := F:NOP; CONNECT n<1>:<1>a;");
    m.watch("a", 1);
    m.load("SEND 1 TO <1>n; SEND TRUE TO <1>n; SEND FALSE TO <1>n; SEND 2 TO <1>n; SEND 5 TO <2>a; SEND 5 TO <2>a;");
    assert_eq!(seen(&mut m), ["a<1> 6", "a<1> 7"]);
    let expected = "a (F:ADD, made at line 1 \"a := F:ADD;\"): input <1> takes integer or real or vector2 or vector3 or vector4 or matrix2 or \
                    matrix3 or matrix4, got boolean TRUE; the message was dropped (2 times)";
    assert_eq!(reports(&mut m), [expected]);
    assert_eq!(reports(&mut m), [""; 0]);
}

#[test]
fn a_loop_without_end_uses_its_budget_and_lets_others_live() {
    let mut m = machine("a := F:NOP; b := F:NOP; c := F:NOP; CONNECT a<1>:<1>b; CONNECT b<1>:<1>a;");
    m.watch("c", 1);
    m.load("SEND 1 TO <1>a; SEND 7 TO <1>c;");
    assert_eq!(seen(&mut m), ["c<1> 7"]);
    let report = reports(&mut m).join("");
    assert!(
        report.contains("did not come to rest") && report.contains("F:NOP"),
        "{report}"
    );
    m.send("c", Input::Number(1), 8.0).unwrap();
    assert_eq!(
        m.tick(0.0, 0, 3),
        Ran::OutOfBudget {
            firings: 3,
            waiting: 1
        }
    );
    assert_eq!(seen(&mut m), ["c<1> 8"]);
    m.load("DISCONNECT b<1>:ALL;");
    assert_eq!(m.tick(0.0, 0, 3), Ran::Quiet { firings: 0 });
}

#[test]
fn a_loop_that_breeds_is_bounded_and_named() {
    let limits = Limits {
        queue_max: 16,
        firings_per_command: 500,
        ..Limits::default()
    };
    let mut m = Machine::with_limits(limits);
    m.load("a := F:SYNC(2); CONNECT a<1>:<1>a; CONNECT a<2>:<2>a; b := F:NOP; CONNECT a<1>:<1>b; CONNECT b<1>:<1>a;");
    m.load("CONNECT b<1>:<2>a; SEND 1 TO <1>a; SEND 1 TO <2>a; SEND 'x' TO <2>a; SEND 'y' TO <1>a;");
    let reports = reports(&mut m).join("\n");
    assert!(
        reports.contains("a (F:SYNC(2), made at line 1 \"a := F:SYNC(2);\"): the queue of input <"),
        "{reports}"
    );
    assert!(
        m.instances()
            .iter()
            .all(|it| it.inputs.iter().all(|input| input.waiting <= 16))
    );
}

#[test]
fn joining_in_a_loop_stops_at_the_bound_of_text() {
    let mut m = machine(
        "c := F:CONCATENATE; CONNECT c<1>:<1>c; CONNECT c<1>:<2>c; SEND 'ab' TO <1>c; SEND 'ab' TO <2>c;",
    );
    assert!(reports(&mut m).join("").contains("longer than 4096 bytes"));
    assert_eq!(m.tick(0.0, 0, 10), Ran::Quiet { firings: 0 });
}

#[test]
fn fan_out_is_delivered_whole_and_bounded() {
    let limits = Limits {
        fan_out_max: 1000,
        ..Limits::default()
    };
    let mut m = Machine::with_limits(limits);
    let mut program = String::from("s := F:NOP;\n");
    for i in 0..1001 {
        let _ = writeln!(program, "n{i} := F:NOP; CONNECT s<1>:<1>n{i};");
    }
    let diagnostics = m.load(&program);
    assert_eq!(diagnostics.len(), 1);
    assert!(
        diagnostics[0].message.contains("s<1> already feeds 1000 inputs"),
        "{}",
        diagnostics[0].message
    );
    assert_eq!(m.outlet("s", 1).map(|s| m.listeners(s)), Some(1000));
    m.send("s", Input::Number(1), 1.0).unwrap();
    assert_eq!(m.tick(0.0, 0, 2000), Ran::Quiet { firings: 1001 });
}

#[test]
fn infinities_do_not_travel() {
    let mut m = machine("a := F:MULC; b := F:NOP; CONNECT a<1>:<1>b; SEND 1e308 TO <2>a;");
    m.watch("b", 1);
    m.load("SEND 1e308 TO <1>a; SEND 1 TO <1>a;");
    assert_eq!(seen(&mut m).len(), 1);
    assert_eq!(
        reports(&mut m),
        [
            "a (F:MULC, made at line 1 \"a := F:MULC;\"): the result is not a finite number (inf); it was not sent"
        ]
    );
    assert!(m.send("b", Input::Number(1), f64::NAN).is_err());
    m.emit("dials", 1, f64::INFINITY);
    assert!(reports(&mut m).join("").contains("DIALS (device)"));
}

#[test]
fn names_are_found_in_any_case_and_said_when_missing() {
    let mut m = machine("Turner := F:NOP; send 1 to <1>TURNER;");
    assert_eq!(
        errors(
            &mut m,
            "SEND 1 TO <1>turnr; CONNECT dials<9>:<1>turner; x := F:ADDD; y := F:DEMUX; z := F:ROUTE;"
        ),
        [
            "1:1: error: there is no turnr; did you mean Turner?",
            "1:21: error: dials has no output <9>; it has 8",
            "1:49: error: there is no function F:ADDD; did you mean ADD or ADDC or AND?",
            "1:62: error: F:DEMUX is known by name only (took a host's stream of bytes apart) and cannot be run; \
             `dialrig net functions` lists what can",
            "1:76: error: F:ROUTE needs a size from 1 to 127: F:ROUTE(1)",
        ]
        .map(str::to_owned)
    );
}

#[test]
fn what_could_never_pass_is_not_connected() {
    let mut m = machine("r := F:XROTATE; a := F:AND; t := TRANSLATE BY 0,0,0;");
    let got = errors(
        &mut m,
        "CONNECT r<1>:<1>a; CONNECT r<1>:<1>t; CONNECT r<1>:<2>t; SEND 1 TO <append>r;",
    );
    assert!(
        got[0].contains("r<1> sends matrix3, <1>a takes boolean or integer"),
        "{got:?}"
    );
    assert!(got[1].contains("r<1> sends matrix3"), "{got:?}");
    assert!(got[2].contains("t has no input <2>; it has <1>"), "{got:?}");
    assert!(got[3].contains("r has no input <append>; it has <1>"), "{got:?}");
}

#[test]
fn devices_stay_what_they_are() {
    let mut m = Machine::new();
    let got = errors(
        &mut m,
        "DIALS := F:NOP; DELETE dlabel1; FORGET fkeys; DELETE d*; INITIALIZE;",
    );
    assert_eq!(got.len(), 3, "{got:?}");
    assert!(
        got[0].contains("DIALS is a device of the machine and cannot be redefined"),
        "{got:?}"
    );
    assert!(m.is_defined("dials") && m.is_defined("DLABEL1"));
}

#[test]
fn labels_lamps_and_messages_reach_the_panel_and_the_host() {
    let mut m = machine(
        "SEND 'ROT X' TO <1>DLABEL1; SEND 'a text too long' TO <1>DLABEL8; SEND 'F1      F2' TO <1>FLABEL0;
         SEND FIX(3) TO <1>ONBUTTONLIGHTS; SEND FIX(32) TO <1>ONBUTTONLIGHTS; SEND FIX(3) TO <1>OFFBUTTONLIGHTS;
         SEND FIX(99) TO <1>ONBUTTONLIGHTS; SEND 'ready' TO <1>MESSAGE_DISPLAY;",
    );
    let panel = m.panel();
    assert_eq!(
        (&*panel.dial_labels[0], &*panel.dial_labels[7]),
        ("ROT X", "a text t")
    );
    assert_eq!((&*panel.key_labels[0], &*panel.key_labels[1]), ("F1      ", "F2"));
    assert_eq!((panel.lamps, &*panel.message), (1 << 31, "ready"));
    let mut names = Vec::new();
    m.drain_sinks(|_, name, input, _| names.push(format!("{name}<{input}>")));
    assert_eq!(names.len(), 8);
    assert_eq!(names[0], "DLABEL1<1>");
    m.load("SEND TRUE TO <1>CLEAR_LABELS;");
    assert_eq!(m.panel().dial_labels[0], "");
}

#[test]
fn host_parameters_are_connected_like_anything() {
    let mut m = Machine::new();
    let view = m.declare_sink("view", &[Kinds::NUMBER, Kinds::STRING]).unwrap();
    assert!(m.declare_sink("VIEW", &[Kinds::ANY]).is_err());
    assert!(m.declare_sink("no name", &[Kinds::ANY]).is_err());
    assert!(
        m.load("CONNECT DIALS<1>:<1>VIEW; SEND 'x' TO <2>view;")
            .is_empty()
    );
    let dial = m.outlet("DIALS", 1).unwrap();
    assert_eq!(m.listeners(dial), 1);
    m.emit_from(dial, 0.25);
    let mut got = Vec::new();
    m.drain_sinks(|sink, name, input, value| got.push((sink, name.to_owned(), input, value)));
    assert_eq!(got[1], (view, "view".to_owned(), 1, Value::Real(0.25)));
    assert_eq!(m.sink_last(view, 1), Some(&Value::Real(0.25)));
    let text = errors(&mut m, "CONNECT fkeys<1>:<2>view;");
    assert!(
        text[0].contains("FKEYS<1> sends integer, <2>view takes string"),
        "{text:?}"
    );
}

#[test]
fn variables_are_stored_and_fetched() {
    let mut m = machine("VARIABLE v, w; f := F:FETCH; SEND 'v' TO <2>f;");
    m.watch("f", 1);
    assert_eq!(
        errors(&mut m, "SEND VALUE(v) TO <1>w;"),
        ["1:1: error: v holds no value yet; SEND or STORE one first"]
    );
    m.load("STORE 3 IN <1>v; SEND VALUE(v) TO <1>w; SEND TRUE TO <1>f;");
    assert_eq!(seen(&mut m), ["f<1> 3"]);
    assert_eq!(m.held("w"), Some(&Value::Real(3.0)));
}

#[test]
fn send_reaches_what_it_names_when_it_fires() {
    let mut m = machine("s := F:SEND; n := F:NOP; SETUP CNESS TRUE <2>s; SETUP CNESS TRUE <3>s;");
    m.watch("n", 1);
    m.load("SEND 'n' TO <2>s; SEND FIX(1) TO <3>s; SEND 5 TO <1>s; SEND FIX(2) TO <3>s; SEND 6 TO <1>s;");
    assert_eq!(seen(&mut m), ["n<1> 5"]);
}

#[test]
fn clocks_run_on_network_time_alone() {
    let mut m = machine("c := F:CLCSECONDS; SEND FIX(50) TO <1>c; f := F:CLFRAMES; SEND FIX(60) TO <1>f;");
    m.watch("c", 1);
    m.watch("f", 1);
    for frame in 0..=120_u32 {
        m.tick(f64::from(frame) / 60.0, frame.into(), 100);
    }
    let at: Vec<_> = m
        .drain_watched()
        .map(|w| (w.name.to_string(), w.secs, w.value))
        .collect();
    let expected = [
        ("c", 0.5, 0),
        ("c", 1.0, 1),
        ("f", 1.0, 0),
        ("c", 1.5, 2),
        ("c", 2.0, 3),
        ("f", 2.0, 1),
    ];
    assert_eq!(
        at,
        expected.map(|(name, secs, n)| (name.to_owned(), secs, Value::Integer(n)))
    );
    m.tick(1e12, 0, 100);
    let report = reports(&mut m).join("");
    assert!(
        report.contains("c (F:CLCSECONDS, made at line 1 \"c := F:CLCSECONDS;\"): network time jumped"),
        "{report}"
    );
    assert!(m.drain_watched().count() <= 256);
}

#[test]
fn a_forgotten_function_goes_on_if_it_is_fed() {
    let mut m =
        machine("n := F:NOP; a := F:NOP; b := F:NOP; CONNECT n<1>:<1>a; CONNECT a<1>:<1>b; FORGET a;");
    m.watch("b", 1);
    m.load("SEND 1 TO <1>n; a := F:NOP;");
    assert_eq!(seen(&mut m), ["b<1> 1"]);
    let mut again = machine(&m.network_text());
    again.watch("b", 1);
    again.load("SEND 2 TO <1>n;");
    assert_eq!(seen(&mut again), ["b<1> 2"]);
}

#[test]
fn deleting_takes_the_connections_along() {
    let mut m = machine(
        "n := F:NOP; la := F:NOP; lb := F:NOP; CONNECT n<1>:<1>la; CONNECT n<1>:<1>lb; CONNECT n<1>:<1>dlabel1;",
    );
    assert_eq!(m.connections().len(), 3);
    m.load("DELETE la;");
    assert_eq!(m.connections().len(), 2);
    m.load("DELETE L*;");
    assert_eq!(m.connections().len(), 1);
    m.load("INITIALIZE;");
    assert!(!m.is_defined("n") && m.connections().is_empty());
}

#[test]
fn long_names_and_many_instances_are_only_slow_never_wrong() {
    let name = "n".repeat(240);
    let mut m = machine(&format!("{name} := F:NOP; SEND 1 TO <1>{name};"));
    assert!(m.is_defined(&name.to_uppercase()));
    let mut few = Machine::with_limits(Limits {
        instances_max: 13,
        ..Limits::default()
    });
    let got = errors(&mut few, "a := F:NOP; b := F:NOP; c := F:NOP; d := F:NOP;");
    assert_eq!(got, ["1:37: error: there are 13 instances already; delete some"]);
    assert!(reports(&mut m).is_empty());
}

#[test]
fn the_drawing_names_what_is_connected() {
    let m = machine(
        "s := SCALE BY 2 THEN l; l := VECTOR_LIST N=2 0,0 1,1; d := F:DSCALE; CONNECT DIALS<4>:<1>d; CONNECT d<1>:<1>s;",
    );
    let dot = m.dot();
    for part in [
        "\"DIALS\" -> \"d\"",
        "\"d\" -> \"s\"",
        "\"s\" -> \"l\" [style=dashed]",
        "d\\nF:DSCALE",
    ] {
        assert!(dot.contains(part), "{part} in {dot}");
    }
}
