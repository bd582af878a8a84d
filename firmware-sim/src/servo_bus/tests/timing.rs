//! When bytes appear: the wire, delays, gaps, adapters, collisions, and the same bytes however one asks.

use super::*;
use proptest::prelude::*;

#[test]
fn a_read_takes_the_time_of_its_bytes_and_its_delay() {
    let profiles = Profiles::builtin();
    let profile = profiles.servo("xl430-w250").expect("shipped");
    for (delay_us, unit) in [
        (500, Unit::new(1)),
        (
            0,
            Unit {
                return_delay_us: Some(0),
                ..Unit::new(1)
            },
        ),
    ] {
        let mut bus = ServoBus::new(BusOptions::default());
        bus.add(profile, unit).expect("fits");
        bus.receive(0, &read(1, 132, 4));
        // 14 bytes out and 15 back at 10 us each.
        let mut out = Vec::new();
        bus.transmit(290 + delay_us - 1, &mut out);
        assert_eq!(out.len(), 14);
        bus.transmit(290 + delay_us, &mut out);
        assert_eq!(out.len(), 15);
    }
}

#[test]
fn a_cycle_of_twenty_is_the_wires_limit() {
    let ids: Vec<u8> = (1..=20).collect();
    let mut bus = bus(BusOptions::default(), &ids);
    let mut ask = vec![132, 0, 4, 0];
    ask.extend(&ids);
    bus.receive(0, &packet(254, 0x82, &ask));
    let mut out = Vec::new();
    bus.transmit(1_000_000, &mut out);
    assert_eq!(out.len(), 20 * 15);
    // 14 + N + N(11 + L) bytes.
    let last = bus.statuses().last().expect("twenty").last_us;
    assert_eq!(last, (14 + 20 + 20 * 15) * 10);
    let sampled: Vec<u64> = bus.statuses().map(|status| status.sampled_us).collect();
    assert!(
        sampled.windows(2).all(|pair| pair[0] < pair[1]),
        "each measures at its own turn"
    );
}

#[test]
fn a_pause_inside_a_packet_loses_it() {
    let ask = packet(1, 1, &[]);
    for (pause_us, answers) in [(1_400, true), (1_700, false)] {
        let mut bus = bus(BusOptions::default(), &[1]);
        bus.receive(0, &ask[..5]);
        bus.receive(50 + pause_us, &ask[5..]);
        let mut out = Vec::new();
        bus.transmit(50_000, &mut out);
        assert_eq!(!out.is_empty(), answers, "{pause_us}");
    }
    let mut bus = bus(
        BusOptions {
            wire: WireTime::None,
            ..BusOptions::default()
        },
        &[1],
    );
    bus.receive(0, &ask[..5]);
    bus.receive(9_000_000, &ask[5..]);
    let mut out = Vec::new();
    bus.transmit(9_000_000, &mut out);
    assert_eq!(
        out.len(),
        14,
        "without wire time there are no gaps and no waiting"
    );
}

#[test]
fn garbage_before_a_packet_does_no_harm() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    for noise in [
        &[0xFF][..],
        &[0xFF, 0xFF],
        &[0xFF, 0xFF, 0xFD],
        &[0xFF, 0xFF, 0xFD, 0xFD],
        &[0, 1, 2, 3],
    ] {
        let ask = [noise, &packet(1, 1, &[])].concat();
        assert_eq!(host.ask(&ask).len(), 14, "{noise:02x?}");
    }
    // A length no servo can take, then a good packet.
    let ask = [&[0xFF, 0xFF, 0xFD, 0, 1, 0xFF, 0xFF][..], &packet(1, 1, &[])].concat();
    assert_eq!(host.ask(&ask).len(), 14);
}

#[test]
fn a_header_inside_a_packet_is_data_or_a_new_start() {
    // As a host that does not stuff writes it: goal 0x00FDFFFF, unstuffed, with its checksum.
    let mut unstuffed = vec![0xFF, 0xFF, 0xFD, 0, 1, 9, 0, 3, 224, 0, 0xFF, 0xFF, 0xFD, 0];
    let checksum = super::super::dynamixel2::crc::extend(0, &unstuffed);
    unstuffed.extend_from_slice(&checksum.to_le_bytes());
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    assert_eq!(host.error_of(&unstuffed), Some(0));
    assert_eq!(host.ask(&read(1, 224, 4))[9..14], [0xFF, 0xFF, 0xFD, 0xFD, 0]);
    let options = BusOptions {
        inner_header: InnerHeader::Restart,
        ..BusOptions::default()
    };
    assert_eq!(Host::new(bus(options, &[1])).ask(&unstuffed), []);
}

#[test]
fn a_wrong_checksum_is_dropped_or_answered() {
    let mut ask = packet(1, 1, &[]);
    ask[9] ^= 1;
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    assert_eq!(host.ask(&ask), []);
    assert_eq!(host.bus.dropped_packets(), 1);
    let mut host = Host::new(bus(
        BusOptions {
            bad_crc: BadCrc::Answer,
            ..BusOptions::default()
        },
        &[1],
    ));
    assert_eq!(host.error_of(&ask), Some(3));
}

#[test]
fn the_wrong_speed_is_silence() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.bus.set_line_baud(0, 57_600);
    assert_eq!(host.ask(&packet(1, 1, &[])), []);
    host.bus.set_line_baud(host.now_us, 1_020_000);
    assert_eq!(
        host.ask(&packet(1, 1, &[])).len(),
        14,
        "two per cent is near enough"
    );
}

#[test]
fn two_of_one_number_garble_each_other() {
    let mut host = Host::new(bus(BusOptions::default(), &[4, 4]));
    let alone = Host::new(bus(BusOptions::default(), &[4])).ask(&packet(4, 1, &[]));
    let both = host.ask(&packet(4, 1, &[]));
    assert_eq!(both.len(), alone.len());
    assert_ne!(both, alone);
    assert_ne!(host.ask(&packet(254, 1, &[])), alone);
}

#[test]
fn speaking_while_a_servo_speaks_spoils_both() {
    let mut bus = bus(BusOptions::default(), &[1]);
    bus.receive(0, &packet(1, 1, &[]));
    bus.receive(150, &packet(1, 1, &[]));
    let mut out = Vec::new();
    bus.transmit(50_000, &mut out);
    assert!(bus.collisions() > 0);
    assert_ne!(out, bus_answer());
}

fn bus_answer() -> Vec<u8> {
    Host::new(bus(BusOptions::default(), &[1])).ask(&packet(1, 1, &[]))
}

#[test]
fn an_adapter_hands_over_in_pieces_and_an_echo_comes_first() {
    let mut bus = bus(
        BusOptions {
            adapter: Some(Adapter::default()),
            echo: true,
            ..BusOptions::default()
        },
        &[1],
    );
    let ask = packet(1, 1, &[]);
    bus.receive(0, &ask);
    let mut out = Vec::new();
    bus.transmit(10 + 15_999, &mut out);
    assert_eq!(out, []);
    bus.transmit(10 + 16_000, &mut out);
    assert_eq!(out, [ask, bus_answer()].concat());
}

proptest! {
    #[test]
    fn how_calls_are_cut_up_changes_nothing(
        asks in proptest::collection::vec((0u64..3_000, 0usize..8), 1..25),
        cuts in proptest::collection::vec(0u64..80_000, 0..60),
        adapter: bool, echo: bool, seed: u64,
    ) {
        let packets = [
            packet(1, 1, &[]), packet(254, 1, &[]), read(2, 116, 36), write(1, 64, &[1]),
            write(1, 116, &1500i32.to_le_bytes()), packet(254, 0x82, &[120, 0, 16, 0, 2, 1]),
            packet(254, 0x8A, &[132, 0, 4, 0, 1, 2]), packet(2, 8, &[]),
        ];
        let play = |cuts: &[u64]| {
            let options = BusOptions { adapter: adapter.then(Adapter::default), echo, seed, ..BusOptions::default() };
            let mut bus = bus(options, &[1, 2]);
            for text in ["noise 0.2%", "drop 5% at 20ms", "servo 2 stuck at 10ms for 9ms", "late 1ms once at 5ms"] {
                bus.inject(0, &Fault::parse(text).expect("reads"));
            }
            let mut doings = Vec::new();
            let mut at = 0;
            for &(pause, ask) in &asks {
                at += pause;
                doings.push((at, Some(ask)));
            }
            doings.extend(cuts.iter().map(|&cut| (cut, None)));
            doings.sort_by_key(|&(at, _)| at);
            let mut out = Vec::new();
            for (at, doing) in doings {
                match doing {
                    Some(ask) => bus.receive(at, &packets[ask]),
                    None => bus.transmit(at, &mut out),
                }
            }
            bus.transmit(200_000, &mut out);
            (out, bus.servo(1).map(Servo::true_position_rad))
        };
        prop_assert_eq!(play(&[]), play(&cuts));
    }

    #[test]
    fn any_bytes_at_all_are_survived(bytes in proptest::collection::vec(
        prop_oneof![Just(0xFFu8), Just(0xFD), Just(0), Just(1), Just(3), Just(116), any::<u8>()], 0..300)) {
        let mut host = Host::new(bus(BusOptions::default(), &[1, 2]));
        host.ask(&bytes);
        host.wait(5);
        prop_assert_eq!(host.ask(&packet(1, 1, &[])).len() % 14, 0);
    }
}
