use super::*;
use crate::hands::Turn;
use crate::input_fault::InputFault;

fn listened() -> Box<dyn UsbDevice> {
    let mut knob = powermate();
    knob.listen(0, 0, true);
    knob
}

fn reports(knob: &mut dyn UsbDevice, until_us: u64) -> Vec<Vec<u8>> {
    std::iter::from_fn(|| knob.report(until_us))
        .map(|report| report.bytes)
        .collect()
}

#[test]
fn a_fast_turn_is_cut_into_steps_of_seven_ten_milliseconds_apart() {
    let mut knob = listened();
    let turn = Touch::Dial {
        control: 0,
        by: Turn::Counts(-16),
        over_us: 0,
    };
    assert!(knob.touch(1_000, &turn));
    assert_eq!(reports(&mut *knob, 1_000), [[0, 0xF9, 0, 0, 0, 0]]);
    assert_eq!(reports(&mut *knob, 10_999), Vec::<Vec<u8>>::new());
    assert_eq!(reports(&mut *knob, 11_000), [[0, 0xF9, 0, 0, 0, 0]]);
    assert_eq!(reports(&mut *knob, 60_000), [[0, 0xFE, 0, 0, 0, 0]]);
}

#[test]
fn presses_within_one_interval_are_two_reports_and_turns_stay_on_their_side_of_them() {
    let mut knob = listened();
    let dial = |counts| Touch::Dial {
        control: 0,
        by: Turn::Counts(counts),
        over_us: 0,
    };
    let press = |down| Touch::Button { control: 0, down };
    for touch in [dial(1), press(true), dial(2), dial(1), press(false)] {
        knob.touch(0, &touch);
    }
    let got: Vec<_> = reports(&mut *knob, 100_000)
        .iter()
        .map(|bytes| (bytes[0], bytes[1]))
        .collect();
    // The first left before the press; what was turned while down is reported while down.
    assert_eq!(got, [(0, 1), (1, 3), (0, 0)]);
}

#[test]
fn a_turn_over_time_loses_nothing() {
    let mut knob = listened();
    let turn = Touch::Dial {
        control: 0,
        by: Turn::Turns(3.0),
        over_us: 2_000_000,
    };
    knob.touch(0, &turn);
    let got = reports(&mut *knob, 3_000_000);
    let sum: i32 = got.iter().map(|bytes| i32::from(bytes[1] as i8)).sum();
    assert_eq!(sum, 3 * 94);
    assert!(got.iter().all(|bytes| (bytes[1] as i8).abs() <= 7));
}

#[test]
fn the_lamp_is_set_three_ways_and_said_back() {
    let mut knob = listened();
    knob.output(0, 0, &[0x40]).expect("brightness");
    knob.set_feature(5, 0, &[0x41, 1, 1, 0, 0x80, 0, 0, 0])
        .expect("the same by feature");
    let pulse = Request {
        kind: 0x41,
        request: 1,
        value: 3,
        index: 1,
    };
    knob.request(7, pulse, &[]).expect("pulses while awake");
    let speed = Request {
        value: 4,
        index: 0x0A02,
        ..pulse
    };
    knob.request(8, speed, &[]).expect("ten times as fast");
    assert_eq!(
        knob.drain_shown(),
        [
            (0, Shown::Level(0x40)),
            (5, Shown::Level(0x80)),
            (
                7,
                Shown::Pulse {
                    speed: [0, 0],
                    awake: true,
                    asleep: false
                }
            ),
            (
                8,
                Shown::Pulse {
                    speed: [2, 10],
                    awake: true,
                    asleep: false
                }
            ),
        ]
    );
    knob.touch(
        20_000,
        &Touch::Button {
            control: 0,
            down: true,
        },
    );
    assert_eq!(reports(&mut *knob, 20_000), [[1, 0, 0, 0x80, 1, 10]]);
    let unknown = Request { value: 9, ..pulse };
    assert_eq!(knob.request(9, unknown, &[]), Err(Stall));
    assert_eq!(knob.set_feature(9, 0, &[0x42, 1, 1, 0, 0, 0, 0, 0]), Err(Stall));
}

#[test]
fn a_flood_keeps_its_rate_and_ends() {
    let mut knob = listened();
    let flood = InputFault::parse("flood 8000Hz for 0.5s").expect("reads");
    knob.inject(0, flood);
    assert_eq!(reports(&mut *knob, 2_000_000).len(), 4000);
}

#[test]
fn without_its_cable_it_forgets_the_lamp_and_answers_nothing() {
    let mut knob = listened();
    knob.output(0, 0, &[9]).expect("there");
    assert_eq!(knob.arrival(0), 1);
    knob.plug(10, false);
    assert_eq!(knob.arrival(10), 0);
    assert_eq!(knob.output(11, 0, &[9]), Err(Stall));
    let press = Touch::Button {
        control: 0,
        down: true,
    };
    knob.touch(12, &press);
    knob.plug(20, true);
    assert_eq!(knob.arrival(20), 2);
    knob.listen(20, 0, true);
    assert_eq!(
        reports(&mut *knob, 50_000),
        Vec::<Vec<u8>>::new(),
        "what happened meanwhile is gone"
    );
    let release = Touch::Button {
        control: 0,
        down: false,
    };
    knob.touch(60_000, &release);
    assert_eq!(reports(&mut *knob, 60_000), [[0; 6]]);
}

#[test]
fn the_cable_comes_out_inside_any_step_of_a_conversation() {
    for step in 0..4 {
        let mut knob = listened();
        knob.inject(0, InputFault::UnplugAfterRequests(step));
        let answers: Vec<bool> = (0..4).map(|n| knob.output(n, 0, &[n as u8]).is_ok()).collect();
        let want: Vec<bool> = (0..4).map(|n| n < step).collect();
        assert_eq!(answers, want);
        assert_eq!(knob.arrival(10), 0);
    }
}
