//! What controls cost in a step: no allocation, whether hands are still or move.

use allocation_counter::measure;

use super::bench::Bench;
use super::*;
use crate::command::LearnCommand;

/// Faders through functions to parameters, with labels of their own; a dial, a button and its lamp, a stick as a rate.
const PROGRAM: &str = "s := F:MULC; SEND 360 TO <2>s; a := F:ADDC; SEND -180 TO <2>a;
    CONNECT NANO<1>:<1>s; CONNECT s<1>:<1>a; CONNECT a<1>:<5>VIEW; SEND 'turn' TO <1>NANO_LABEL;
    t := F:MULC; SEND 180 TO <2>t; b := F:ADDC; SEND -90 TO <2>b; SEND 'tilt' TO <2>NANO_LABEL;
    CONNECT NANO<2>:<1>t; CONNECT t<1>:<1>b; CONNECT b<1>:<6>VIEW;
    d := F:MULC; SEND 90 TO <2>d; CONNECT NANO<3>:<1>d; CONNECT d<1>:<1>VIEW; CONNECT NANO<4>:<4>NANO_LAMP;
    e := F:MULC; SEND 20 TO <2>e; CONNECT NANO<5>:<1>e; CONNECT e<1>:<2>VIEW; SEND 'rate' TO <5>NANO_MODE;";

/// One step's share of controls; `event` is what a device said in it.
fn turn(bench: &mut Bench, place: usize, event: Option<InputEvent>) {
    let rig = &mut bench.rig;
    rig.refresh_controls();
    if let Some(what) = event {
        let event = Stamped { at: rig.now, what };
        let source = Source {
            counts_per_turn: 1.0,
            surface: None,
        };
        rig.hear(place, &event, source);
    }
    rig.pass_time();
    rig.take_requests();
    rig.show_on_devices();
    rig.steps += 1;
    rig.now = rig.now.after(std::time::Duration::from_millis(10));
}

fn moving(n: i32) -> InputEvent {
    let there_and_back = 500 + (n % 400 - 200).abs();
    match n % 6 {
        0 => InputEvent::Axis {
            control: 0,
            value: there_and_back,
        },
        1 => InputEvent::Axis {
            control: 1,
            value: there_and_back,
        },
        2 => InputEvent::Dial {
            control: 0,
            delta_counts: 1 - n % 3,
        },
        3 => InputEvent::Button {
            control: 0,
            down: n % 12 == 3,
        },
        4 => InputEvent::AxisTouched {
            control: 0,
            down: n % 12 == 4,
        },
        _ => InputEvent::Axis {
            control: 2,
            value: n % 100,
        },
    }
}

#[test]
fn controls_allocate_nothing_in_a_step() {
    let mut bench = Bench::new(PROGRAM);
    bench.step(&[Command::Learn(LearnCommand::Cancel)]);
    bench.wait(0.5);
    let place = bench.rig.controls.find("nano").expect("it is there");
    // Kept only for tests.
    bench.rig.controls.told.reserve(100_000);
    for n in 0..1200 {
        turn(&mut bench, place, Some(moving(n)).filter(|_| n < 600));
    }
    let still = measure(|| (0..600).for_each(|_| turn(&mut bench, place, None)));
    assert_eq!(still.count_total, 0, "still");
    let moved = measure(|| (0..600).for_each(|n| turn(&mut bench, place, Some(moving(n)))));
    assert_eq!(moved.count_total, 0, "moving");
    let shown = bench.rig.controls.told.len();
    assert!(shown > 100, "{shown} things were shown meanwhile");
}
