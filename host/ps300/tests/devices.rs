//! The names every machine has: each is there, takes what it says and shows what it should.

use ps300::language::Input;
use ps300::machine::devices::{READOUTS, Readout, SOURCES};
use ps300::{Machine, Value};

/// Section "Initial structure" of `docs/protocols/ps300.md`, without what functions and pictures are.
const NAMES: &str = "DIALS DLABEL1 DLABEL8 DSET1 DSET8 FKEYS FLABEL0 FLABEL1 FLABEL12 CLEAR_LABELS BUTTONSIN \
    ONBUTTONLIGHTS OFFBUTTONLIGHTS TABLETIN TABLETOUT KEYBOARD KBHANDLER SPECKEYS HOST_MESSAGE MESSAGE_DISPLAY \
    ES_TE MEMORY_MONITOR MEMORY_ALERT INFORMATION WARNING ERROR TURNONDISPLAY SHADINGENVIRONMENT";

#[test]
fn every_device_is_there_and_stays() {
    let mut machine = Machine::new();
    for name in NAMES.split_whitespace() {
        assert!(machine.is_defined(name), "{name}");
        let refused = machine.load(&format!("{name} := F:NOP; DELETE {name};"));
        assert_eq!(refused.len(), 2, "{name}: {refused:?}");
    }
    let all = SOURCES.iter().map(|source| source.name.to_owned());
    for name in all.chain(READOUTS.iter().flat_map(Readout::names)) {
        assert!(machine.is_defined(&name), "{name}");
    }
}

/// What programs of the time send at start-up is taken without a word.
#[test]
fn start_up_commands_of_the_time_are_taken() {
    let mut machine = Machine::new();
    let program = "SEND FIX(1) TO <5>SHADINGENVIRONMENT; SEND TRUE TO <15>SHADINGENVIRONMENT; \
        SEND FIX(0) TO <1>TURNONDISPLAY; SEND FIX(60) TO <3>MEMORY_MONITOR; SEND FIX(0) TO <1>OFFBUTTONLIGHTS; \
        SEND TRUE TO <1>CLEAR_LABELS; SEND TRUE TO <2>DSET3; SEND 'ready' TO <1>HOST_MESSAGE; \
        keys := F:NOP; CONNECT KBHANDLER<4>:<1>keys; CONNECT KEYBOARD<1>:<1>keys; CONNECT keys<1>:<1>ES_TE;";
    assert_eq!(machine.load(program), []);
    assert!(machine.emit("KBHANDLER", 4, "a") && machine.emit("KEYBOARD", 1, "b"));
    machine.tick(0.0, 0, 100);
    assert_eq!(machine.reports(), []);
    let mut lines = Vec::new();
    machine.drain_sinks(|_, name, input, value| {
        if name == "HOST_MESSAGE" {
            lines.push((input, value));
        }
    });
    assert_eq!(lines, [(1, Value::from("ready"))]);
    assert_eq!(machine.panel().terminal.lines(), ["ab"]);
}

/// Messages to the terminal, and what it shows then.
const TERMINAL: &[(&[&str], &[&str])] = &[
    (&["one\r\ntwo"], &["one", "two"]),
    (&["one\rt"], &["tne"]),
    (&["one\ntwo"], &["one", "   two"]),
    (&["one\u{8}\u{8}X"], &["oXe"]),
    (&["one\u{1b}[2J\u{1b}[Htwo"], &["two"]),
    (&["one\u{1b}", "[2", "J", "x"], &["   x"]),
    (&["one two\u{1b}[1;4H\u{1b}[Kx"], &["onex"]),
    (&["a\r\nb\r\nc\u{1b}[2;1H\u{1b}[J"], &["a"]),
    (
        &["\u{1b}[3;2Hx\u{1b}[9;99H\u{1b}[5mno"],
        &["", "", " x", "", "", "", "", "", LAST],
    ),
    (&["x\u{1b}[2K\u{7}y"], &[" y"]),
];

/// A line with characters at its very end, beyond which it goes on in the next.
const LAST: &str = "                                                                               n";

#[test]
fn the_terminal_obeys() {
    for (messages, lines) in TERMINAL {
        let mut machine = Machine::new();
        for message in *messages {
            machine
                .send("ES_TE", Input::Number(1), *message)
                .expect("takes text");
            machine.settle();
        }
        let shown = machine.panel().terminal.lines();
        let fits = shown.iter().zip(*lines).all(|(shown, line)| shown == line);
        assert!(fits && shown.len() >= lines.len(), "{messages:?}: {shown:?}");
    }
    let mut machine = Machine::new();
    for number in 0..30 {
        let text = format!("line {number}");
        machine
            .send("WARNING", Input::Number(1), text.as_str())
            .expect("takes text");
    }
    machine.settle();
    let lines = machine.panel().terminal.lines();
    assert_eq!((lines.len(), lines[0].as_str()), (23, "WARNING: line 7"));
}
