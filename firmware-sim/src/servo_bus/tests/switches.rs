//! What the documents leave open, either way.

use super::*;
use crate::servo_bus::unit::{Gaps, Precedence};

fn one(unit: Unit, options: BusOptions) -> Host {
    let profiles = Profiles::builtin();
    let mut bus = ServoBus::new(options);
    bus.add(profiles.servo("xl430-w250").expect("shipped"), unit)
        .expect("fits");
    Host::new(bus)
}

#[test]
fn several_errors_are_one_in_three_ways() {
    // Profile Acceleration below zero (4, range), Profile Velocity right, a goal beyond its limit (6), then Realtime Tick
    // (7, read only) cut short.
    let bytes = [
        (-1i32).to_le_bytes(),
        7i32.to_le_bytes(),
        9999i32.to_le_bytes(),
        [0; 4],
    ]
    .concat();
    for (precedence, error) in [
        (Precedence::FirstAddress, 4),
        (Precedence::LowestNumber, 4),
        (Precedence::HighestNumber, 7),
    ] {
        let unit = Unit {
            precedence,
            ..Unit::new(1)
        };
        let mut host = one(unit, BusOptions::default());
        assert_eq!(
            host.error_of(&write(1, 108, &bytes)),
            Some(error),
            "{precedence:?}"
        );
        assert_eq!(host.register(1, "Profile Velocity"), 0, "nothing is written");
    }
    // The other way round: a limit first, a range behind it.
    let bytes = [9999i32.to_le_bytes()].concat();
    for precedence in [
        Precedence::FirstAddress,
        Precedence::LowestNumber,
        Precedence::HighestNumber,
    ] {
        let unit = Unit {
            precedence,
            ..Unit::new(1)
        };
        let mut host = one(unit, BusOptions::default());
        assert_eq!(
            host.error_of(&write(1, 116, &bytes)),
            Some(6),
            "alone it is what it is"
        );
        // Torque Enable 2 (4), LED 1, address 66 that nothing covers (7): the lowest address has the lowest number.
        let error = if precedence == Precedence::HighestNumber {
            7
        } else {
            4
        };
        assert_eq!(
            host.error_of(&write(1, 64, &[2, 1, 0])),
            Some(error),
            "{precedence:?}"
        );
        // Address 66 (7), 67 (7), Status Return Level 9 (4).
        let error = if precedence == Precedence::LowestNumber {
            4
        } else {
            7
        };
        assert_eq!(
            host.error_of(&write(1, 66, &[0, 0, 9])),
            Some(error),
            "{precedence:?}"
        );
    }
}

#[test]
fn gaps_are_zeros_or_an_error() {
    for (gaps, error) in [(Gaps::Zeros, 0), (Gaps::AccessError, 7)] {
        let unit = Unit { gaps, ..Unit::new(1) };
        let mut host = one(unit, BusOptions::default());
        // LED, two bytes of nothing, Status Return Level.
        assert_eq!(host.error_of(&read(1, 65, 4)), Some(error), "{gaps:?}");
    }
}

#[test]
fn a_header_inside_a_packet_is_data_or_a_start() {
    // A client that does not stuff: Indirect Data FF FF FD 00, checksum and all.
    let mut unstuffed = vec![0xFF, 0xFF, 0xFD, 0, 1, 9, 0, 3, 224, 0, 0xFF, 0xFF, 0xFD, 0];
    let checksum = super::super::dynamixel2::crc::extend(0, &unstuffed);
    unstuffed.extend_from_slice(&checksum.to_le_bytes());
    for (inner_header, error) in [(InnerHeader::Data, Some(0)), (InnerHeader::Restart, None)] {
        let options = BusOptions {
            inner_header,
            ..BusOptions::default()
        };
        let mut host = one(Unit::new(1), options);
        assert_eq!(host.error_of(&unstuffed), error, "{inner_header:?}");
    }
}

#[test]
fn how_calls_are_cut_up_changes_nothing_in_any_language() {
    let profiles = Profiles::builtin();
    let asks = [
        packet(1, 2, &[132, 0, 4, 0]),
        summed_packet(2, 2, &[36, 8]),
        summed_packet(254, 0x82, &[56, 6, 3, 9]),
        summed_packet(4, 3, &[42, 2, 88, 1, 244]),
        packet(254, 1, &[]),
        summed_packet(254, 1, &[]),
    ];
    let run = |step_us: u64| {
        let mut bus = ServoBus::new(BusOptions::default());
        for (id, model) in [(1, "xl430-w250"), (2, "ax-12a"), (3, "sts3215"), (4, "scs0009")] {
            bus.add(profiles.servo(model).expect("shipped"), Unit::new(id))
                .expect("fits");
        }
        let (mut now_us, mut heard) = (0, Vec::new());
        for ask in &asks {
            bus.receive(now_us, ask);
            let end_us = now_us + 30_000;
            while now_us < end_us {
                now_us = (now_us + step_us).min(end_us);
                bus.transmit(now_us, &mut heard);
            }
        }
        heard
    };
    let whole = run(30_000);
    assert!(whole.len() > 60, "{}", whole.len());
    for step_us in [1, 7, 333, 5000] {
        assert_eq!(run(step_us), whole, "steps of {step_us} us");
    }
}

#[test]
fn a_speed_that_changes_spoils_what_is_under_way() {
    let mut host = one(Unit::new(1), BusOptions::default());
    let ask = read(1, 132, 4);
    host.bus.receive(0, &ask[..6]);
    host.now_us = 1000;
    host.bus.set_line_baud(host.now_us, 57_600);
    host.bus.set_line_baud(host.now_us, 1_000_000);
    assert_eq!(host.ask(&ask[6..]), [], "its first half was lost");
    assert_eq!(host.bus.dropped_packets(), 1);
    // In the middle of the answer, 15 bytes of 10 us behind a delay of 500 us.
    host.bus.receive(host.now_us, &ask);
    let mut heard = Vec::new();
    host.now_us += 140 + 500 + 60;
    host.bus.transmit(host.now_us, &mut heard);
    host.bus.set_line_baud(host.now_us, 115_200);
    heard.extend(host.wait(20));
    assert_eq!(heard.len(), 15);
    assert_eq!(heard[..5], [0xFF, 0xFF, 0xFD, 0, 1]);
    assert_ne!(heard[7], 0x55, "the rest was heard at the wrong speed");
}
