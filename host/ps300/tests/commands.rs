//! Commands beyond definitions and wires: groups, copies, functions inside structures, states, resets.

use ps300::Machine;
use ps300::value::Value;

fn machine(program: &str) -> Machine {
    let mut machine = Machine::new();
    assert_eq!(machine.load(program), [], "{program}");
    machine
}

fn errors(machine: &mut Machine, program: &str) -> Vec<String> {
    machine.load(program).iter().map(ToString::to_string).collect()
}

fn held(machine: &Machine, name: &str) -> Option<f64> {
    machine.held(name).and_then(Value::as_number)
}

#[test]
fn the_network_runs_once_at_the_end_of_a_group() {
    let mut m = machine("add := F:ADD; VARIABLE v; CONNECT add<1>:<1>v; r := ROTATE IN X 0; DISPLAY r;");
    let before = m.picture_revision();
    for (command, shown) in [
        ("BEGIN", None),
        ("SEND 1 TO <1>add;", None),
        ("SEND 2 TO <2>add;", None),
        ("r := SCALE BY 2;", None),
        ("BEGIN", None),
        ("END;", None),
        ("END;", Some(3.0)),
    ] {
        let (commands, _) = ps300::language::parse(command);
        m.execute(&commands[0].what).expect(command);
        assert_eq!(held(&m, "v"), shown, "{command}");
        assert_eq!(m.picture_revision() == before, shown.is_none(), "{command}");
    }
    assert_eq!(
        errors(&mut m, "END;"),
        ["1:1: error: there is no BEGIN to this END"]
    );
    let got = errors(&mut m, "BEGIN SEND 4 TO <1>add; SEND 5 TO <2>add;");
    assert_eq!(
        got,
        ["1:25: warning: BEGIN has no END; the group ends with the text"]
    );
    assert_eq!(held(&m, "v"), Some(9.0));
}

#[test]
fn reset_ends_what_is_open_and_status_says_what_is() {
    let mut m = machine("a := F:ADD; OPTIMIZE STRUCTURE; b := NIL;");
    assert_eq!(errors(&mut m, "BEGIN COMMAND STATUS; END;"), [] as [String; 0]);
    assert_eq!(
        m.panel().message,
        "a group is open; OPTIMIZE STRUCTURE is open; 1 functions, 0 variables, 0 connections, 0 messages wait"
    );
    assert_eq!(errors(&mut m, "!RESET; COMMAND STATUS;"), [] as [String; 0]);
    assert!(
        m.panel().message.starts_with("1 functions"),
        "{}",
        m.panel().message
    );
    assert_eq!(errors(&mut m, "END OPTIMIZE;").len(), 1);
    assert_eq!(errors(&mut m, "RESERVE_WORKING_STORAGE 1000;"), [] as [String; 0]);
    assert_eq!(m.reports(), []);
}

#[test]
fn copies_have_the_data_as_it_is() {
    let mut m =
        machine("l := VECTOR_LIST N=3 0,0 1,0 2,0; SEND V2D(3,0) TO <append>l; c := COPY l START=2 COUNT=2;");
    m.load("SEND TRUE TO <clear>l; s := BEGIN_STRUCTURE c := COPY c; END_STRUCTURE; DISPLAY s;");
    let points: Vec<[f64; 2]> = m.display().strokes.iter().map(|s| [s.from.x, s.to.x]).collect();
    assert_eq!(points, [[1.0, 2.0]]);
    let again = machine(&m.network_text());
    assert_eq!(again.display(), m.display());
    let mut m = machine("t := CHARACTERS 'abcdef'; u := COPY t START=2, COUNT=3; DISPLAY u;");
    assert_eq!(
        m.display(),
        machine("t := CHARACTERS 'bcd'; DISPLAY t;").display()
    );
    let got = errors(
        &mut m,
        "x := COPY nothing; f := F:NOP; y := COPY f; i := INSTANCE OF t; z := COPY i;",
    );
    assert_eq!(got.len(), 3, "{got:?}");
}

const HOUSE: &str = "
arm := BEGIN_STRUCTURE
  turn := ROTATE IN X 0;
  dial := F:XROTATE;
  sum := F:ADDC;
  VECTOR_LIST N=2 0,0 1,0;
END_STRUCTURE;
CONNECT arm.dial<1>:<1>arm.turn; CONNECT DIALS<1>:<1>arm.sum; CONNECT arm.sum<1>:<1>arm.dial; SEND 1 TO <2>arm.sum;
";

#[test]
fn functions_come_and_go_with_their_structure() {
    let mut m = machine(HOUSE);
    m.emit("DIALS", 1, 89.0);
    m.tick(0.0, 0, 1000);
    let at = m.display_of("arm", glam::DMat4::IDENTITY).strokes[0].to;
    assert!((at - glam::DVec3::X).length() < 1e-9, "about x, along x: {at}");
    let text = m.network_text();
    assert_eq!(machine(&text).network_text(), text);
    assert!(text.contains("sum := F:ADDC"), "{text}");
    let got = errors(&mut m, "DELETE arm.sum; arm.sum := F:NOP;");
    assert_eq!(got.len(), 2, "a label is its structure's: {got:?}");
    m.load("DELETE arm;");
    assert!(!m.is_defined("arm.sum") && m.connections().is_empty());
    assert_eq!(
        m.instances()
            .iter()
            .filter(|it| it.name.as_str().starts_with("arm"))
            .count(),
        0
    );
}

#[test]
fn a_structure_defined_anew_has_new_functions() {
    let mut m = machine(HOUSE);
    assert_eq!(
        m.load("arm := BEGIN_STRUCTURE sum := F:SUBC; sum := F:ADDC; END_STRUCTURE;"),
        []
    );
    assert!(m.connections().is_empty());
    assert_eq!(
        m.instances()
            .iter()
            .filter(|it| it.name.as_str() == "arm.sum")
            .count(),
        1
    );
    let got = errors(&mut m, "arm := BEGIN_STRUCTURE x := F:NOTHING; END_STRUCTURE;");
    assert!(got[0].contains("there is no function"), "{got:?}");
    assert!(m.is_defined("arm.sum"), "what is refused changes nothing");
}

#[test]
fn a_state_is_taken_up_or_refused() {
    let mut m =
        machine("a := F:ACCUMULATE; VARIABLE v; CONNECT a<1>:<1>v; SETUP STATE 5,5 IN a; SEND 1 TO <1>a;");
    assert_eq!(held(&m, "v"), Some(6.0));
    let got = errors(
        &mut m,
        "SETUP STATE 'x' IN a; SETUP STATE 1 IN DLABEL1; SETUP STATE 1 IN nobody;",
    );
    assert_eq!(got.len(), 3, "{got:?}");
    m.load("SEND 1 TO <1>a;");
    assert_eq!(held(&m, "v"), Some(7.0));
}
