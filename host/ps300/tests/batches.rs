//! Batches: what the host sends between two ticks is over before the next is let in, whatever the host allows.

use ps300::language::Input;
use ps300::{Kinds, Limits, Machine, Ran, Value};

fn with(limits: Limits, program: &str) -> Machine {
    let mut machine = Machine::with_limits(limits);
    assert_eq!(machine.load(program), []);
    machine
}

fn small() -> Limits {
    Limits {
        firings_per_batch: 100,
        arrivals_max: 4,
        batches_max: 3,
        ..Limits::default()
    }
}

fn reports(machine: &mut Machine) -> Vec<String> {
    machine.reports().iter().map(ToString::to_string).collect()
}

const ENDLESS: &str = "
    a := F:NOP; b := F:NOP; CONNECT a<1>:<1>b; CONNECT b<1>:<1>a; SEND 1 TO <1>a;
    heard := F:NOP; CONNECT DIALS<1>:<1>heard;";

#[test]
fn messages_of_two_batches_do_not_meet() {
    // Dial 2 overtakes dial 1 if both are let in together, since its way is shorter.
    let long =
        "x := F:NOP; y := F:NOP; z := F:NOP; CONNECT DIALS<1>:<1>x; CONNECT x<1>:<1>y; CONNECT y<1>:<1>z;
                CONNECT DIALS<2>:<1>z;";
    for firings in [1, u32::MAX] {
        let mut m = with(Limits::default(), long);
        m.watch("z", 1);
        m.emit("DIALS", 1, 1.0);
        m.tick(0.0, 0, firings);
        m.emit("DIALS", 2, 2.0);
        while !matches!(m.tick(0.0, 0, firings), Ran::Quiet { .. }) {}
        let seen: Vec<_> = m.drain_watched().map(|watched| watched.value).collect();
        assert_eq!(seen, [Value::Real(1.0), Value::Real(2.0)]);
    }
}

#[test]
fn messages_bear_the_time_of_their_batch() {
    let mut m = with(
        Limits::default(),
        "x := F:NOP; y := F:NOP; CONNECT DIALS<1>:<1>x; CONNECT x<1>:<1>y;",
    );
    m.watch("y", 1);
    m.emit("DIALS", 1, 1.0);
    m.tick(1.0, 1, 1);
    m.emit("DIALS", 1, 2.0);
    m.tick(2.0, 2, 1);
    m.tick(3.0, 3, 100);
    let seen: Vec<_> = m
        .drain_watched()
        .map(|watched| (watched.secs, watched.value))
        .collect();
    assert_eq!(seen, [(1.0, Value::Real(1.0)), (2.0, Value::Real(2.0))]);
    assert_eq!(m.secs(), 3.0);
}

#[test]
fn what_goes_round_for_ever_shuts_out_nobody() {
    let mut m = with(small(), ENDLESS);
    m.watch("heard", 1);
    for turn in 0..10 {
        m.emit("DIALS", 1, f64::from(turn));
        assert!(m.tick(f64::from(turn), 0, 150).firings() <= 150);
    }
    let heard = m.drain_watched().count();
    assert_eq!(heard, 10);
    assert_eq!(m.load("DISCONNECT b<1>:<1>a;"), []);
    assert!(matches!(m.tick(10.0, 0, 100), Ran::Quiet { .. }));
    let reports = reports(&mut m).join("\n");
    assert!(reports.contains("did not come to rest"), "{reports}");
}

#[test]
fn an_endless_tick_ends_and_so_does_settling() {
    let mut m = with(small(), ENDLESS);
    assert_eq!(
        m.tick(0.0, 0, u32::MAX),
        Ran::OutOfBudget {
            firings: 100,
            waiting: 1
        }
    );
    for _ in 0..3 {
        m.emit("DIALS", 1, 1.0);
        m.tick(0.0, 0, 0);
    }
    assert!(matches!(m.settle(), Ran::OutOfBudget { firings: 300, .. }));
}

#[test]
fn breeding_fills_its_own_queues_and_nobody_elses() {
    let limits = Limits {
        behind_max: 10,
        ..small()
    };
    let program = "a := F:SYNC(2); b := F:NOP; CONNECT a<1>:<1>a; CONNECT a<2>:<2>a; CONNECT a<1>:<1>b;
        CONNECT b<1>:<1>a; CONNECT b<1>:<2>a; SEND 1 TO <1>a; SEND 1 TO <2>a;
        x := F:NOP; y := F:NOP; CONNECT DIALS<1>:<1>x; CONNECT x<1>:<1>y;";
    let mut m = with(limits, program);
    m.watch("y", 1);
    for _ in 0..20 {
        m.emit("DIALS", 1, 1.0);
        m.tick(0.0, 0, u32::MAX);
    }
    assert_eq!(m.drain_watched().count(), 20);
    let reports = reports(&mut m).join("\n");
    assert!(
        reports.contains("a (F:SYNC(2), made at ")
            && reports
                .contains("): the network holds as many messages as it may; the newest message, 1, was"),
        "{reports}"
    );
}

#[test]
fn a_full_backlog_drops_the_newest_and_says_whose() {
    let mut m = with(small(), ENDLESS);
    m.declare_sink("view", &[Kinds::ANY]).unwrap();
    m.load("t := TRANSLATE BY 0,0,0;");
    m.watch("heard", 1);
    reports(&mut m);
    m.tick(0.0, 0, 1);
    for turn in 0..6 {
        m.emit("DIALS", 1, f64::from(turn));
    }
    m.send("heard", Input::Number(1), 6.0).unwrap();
    m.send("view", Input::Number(1), 7.0).unwrap();
    m.send("t", Input::Number(1), glam::DVec3::X).unwrap();
    let expected = [
        "DIALS (device): ",
        "heard (F:NOP, made at line 3 \"heard := F:NOP;\"): ",
        "view (host input): ",
        "t (TRANSLATE node, made at line 1 \"t := TRANSLATE BY 0,0,0;\"): ",
    ];
    let dropped = [
        "4, was dropped (2 times)",
        "6, was dropped",
        "7, was dropped",
        "V3D(1,0,0), was dropped",
    ];
    let full = "too many messages wait for the network to come to rest; the newest message, ";
    let expected: Vec<_> = expected
        .iter()
        .zip(dropped)
        .map(|(who, what)| format!("{who}{full}{what}"))
        .collect();
    assert_eq!(reports(&mut m), expected);
    m.settle();
    let heard: Vec<_> = m
        .drain_watched()
        .filter_map(|watched| watched.value.as_number())
        .collect();
    assert_eq!(heard, [0.0, 1.0, 2.0, 3.0]);
}

#[test]
fn ticks_beyond_the_bound_are_taken_together() {
    let mut m = with(small(), &format!("{ENDLESS} c := F:CLTICKS;"));
    m.watch("c", 2);
    reports(&mut m);
    for tick in 1..=8 {
        m.tick(f64::from(tick), 0, 1);
    }
    assert!(
        reports(&mut m)
            .join("")
            .contains("network (network): the network cannot keep up; ticks are taken together")
    );
    m.tick(9.0, 0, u32::MAX);
    m.tick(10.0, 0, u32::MAX);
    assert_eq!(
        m.drain_watched().filter(|watched| watched.output == 2).count(),
        10
    );
}
