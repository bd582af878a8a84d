//! Messages in steady state ask for no memory: what fires a hundred million times a second must not.

use std::fmt::Write;

use ps300::network::Outlet;
use ps300::{Machine, Ran};

/// Allocations while eight dials are turned a thousand times, once everything has happened a few times.
fn allocations(program: &str) -> u64 {
    let mut machine = Machine::new();
    assert_eq!(machine.load(program), []);
    let dials: Vec<Outlet> = (1..=7).filter_map(|dial| machine.outlet("DIALS", dial)).collect();
    let mut turn = |frame: u32| {
        for &dial in &dials {
            machine.emit_from(dial, 1.0 / 256.0);
        }
        machine.emit("DIALS", 8, 1.0 / 256.0);
        let ran = machine.tick(f64::from(frame) / 60.0, frame.into(), 10_000);
        assert!(matches!(ran, Ran::Quiet { firings: 1.. }), "{ran:?}");
        machine.drain_sinks(|_, _, _, _| {});
        machine.drain_watched().count();
    };
    (0..8).for_each(&mut turn);
    let counted = allocation_counter::measure(|| (8..1008).for_each(&mut turn));
    counted.count_total
}

const SCALARS: &str = "
    rx := F:ADDC; SEND 200 TO <2>rx; CONNECT DIALS<1>:<1>rx;
    held := F:ACCUMULATE; SEND 0 TO <2>held; SEND 5 TO <5>held; SEND -5 TO <6>held; CONNECT rx<1>:<1>held;
    sc := F:MULC; SEND FIX(3) TO <2>sc; CONNECT DIALS<2>:<1>sc; CONNECT sc<1>:<1>held;
    tx := F:XVECTOR; ty := F:YVECTOR; tz := F:ZVECTOR; tr := F:ACCUMULATE;
    SEND V3D(0,0,0) TO <2>tr; SEND 100 TO <4>tr;
    CONNECT DIALS<5>:<1>tx; CONNECT DIALS<6>:<1>ty; CONNECT DIALS<7>:<1>tz;
    CONNECT tx<1>:<1>tr; CONNECT ty<1>:<1>tr; CONNECT tz<1>:<1>tr;
    place := TRANSLATE BY 0,0,0; CONNECT tr<1>:<1>place;
    parts := F:PARTS; pair := F:VEC; CONNECT tr<1>:<1>parts; CONNECT parts<1>:<1>pair; CONNECT parts<2>:<2>pair;
    above := F:GTC; SEND 0 TO <2>above; CONNECT parts<3>:<1>above; way := F:BROUTE;
    CONNECT above<1>:<1>way; CONNECT pair<1>:<2>way;
    whole := F:ROUND; CONNECT parts<3>:<1>whole;
    both := F:SYNC(2); CONNECT whole<1>:<1>both; CONNECT way<1>:<2>both; CONNECT way<2>:<2>both;
    VARIABLE kept; CONNECT both<2>:<1>kept; name := F:FETCH; SEND 'kept' TO <2>name; CONNECT both<1>:<1>name;
    twice := F:SYNC(2); CONNECT DIALS<1>:<1>twice; CONNECT DIALS<2>:<1>twice; CONNECT DIALS<3>:<2>twice;
    CONNECT DIALS<4>:<2>twice;
";

const DIALS: &str = "
    rotx := ROTATE IN X 0; roty := ROTATE IN Y 0; rotz := ROTATE IN Z 0; size := SCALE BY 1; place := TRANSLATE BY 0,0,0;
    rx := F:DXROTATE; SEND 0 TO <2>rx; SEND 200 TO <3>rx; CONNECT DIALS<1>:<1>rx; CONNECT rx<1>:<1>rotx;
    ry := F:DYROTATE; SEND 0 TO <2>ry; SEND 200 TO <3>ry; CONNECT DIALS<2>:<1>ry; CONNECT ry<1>:<1>roty;
    rz := F:DZROTATE; SEND 0 TO <2>rz; SEND 200 TO <3>rz; CONNECT DIALS<3>:<1>rz; CONNECT rz<1>:<1>rotz;
    sc := F:DSCALE; SEND 1 TO <2>sc; SEND 0.2 TO <3>sc; SEND 1000 TO <4>sc; SEND 0.01 TO <5>sc;
    CONNECT DIALS<4>:<1>sc; CONNECT sc<1>:<1>size;
    tx := F:XVECTOR; ty := F:YVECTOR; tz := F:ZVECTOR; tr := F:ACCUMULATE;
    SEND V3D(0,0,0) TO <2>tr; SEND 100 TO <4>tr;
    CONNECT DIALS<5>:<1>tx; CONNECT DIALS<6>:<1>ty; CONNECT DIALS<7>:<1>tz;
    CONNECT tx<1>:<1>tr; CONNECT ty<1>:<1>tr; CONNECT tz<1>:<1>tr; CONNECT tr<1>:<1>place;
    coarse := F:MULC; SEND 50 TO <2>coarse; CONNECT DIALS<8>:<1>coarse; CONNECT coarse<1>:<1>sc;
";

fn chain(function: &str, count: usize) -> String {
    let mut text = String::from("n0 := F:NOP; CONNECT DIALS<1>:<1>n0;");
    for at in 1..count {
        let before = at - 1;
        let _ = writeln!(text, "n{at} := F:{function}; CONNECT n{before}<1>:<1>n{at};");
    }
    text
}

fn fan_out(count: usize) -> String {
    let mut text = String::new();
    for at in 0..count {
        let _ = writeln!(text, "n{at} := F:NOP; CONNECT DIALS<1>:<1>n{at};");
    }
    text
}

#[test]
fn a_message_asks_for_no_memory() {
    let watched_chain = chain("NOP", 100);
    for (what, program) in [
        ("chain of NOP", watched_chain.as_str()),
        ("chain of ROUND and NOP", &chain("ROUND", 100)),
        ("fan-out", &fan_out(100)),
        ("numbers, Booleans and vectors", SCALARS),
        ("dials with matrices", DIALS),
    ] {
        assert_eq!(allocations(program), 0, "{what}");
    }
}
