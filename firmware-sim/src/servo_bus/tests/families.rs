//! Every model of every protocol, asked in its own language; and several languages on one line.

use super::*;
use crate::servo_bus::unit::Unit;
use device_profiles::{Role, ServoProfile, ServoProtocol, WordOrder};
use proptest::prelude::*;

/// All shipped models.
fn models() -> Vec<ServoProfile> {
    let profiles = Profiles::builtin();
    let all: Vec<ServoProfile> = profiles.servos().cloned().collect();
    assert!(all.len() >= 12, "{} models", all.len());
    all
}

fn is_summed(profile: &ServoProfile) -> bool {
    profile.protocol != ServoProtocol::Dynamixel2
}

/// An instruction for `profile`.
fn say(profile: &ServoProfile, id: u8, code: u8, params: &[u8]) -> Vec<u8> {
    if is_summed(profile) {
        summed_packet(id, code, params)
    } else {
        packet(id, code, params)
    }
}

/// A read or write of the register with `role`.
fn reading(profile: &ServoProfile, id: u8, role: Role) -> Vec<u8> {
    let row = profile.role(role).expect("the model has it");
    if is_summed(profile) {
        summed_packet(id, 2, &[row.address as u8, row.size])
    } else {
        read(id, row.address, row.size.into())
    }
}

fn writing(profile: &ServoProfile, id: u8, role: Role, value: u32) -> Vec<u8> {
    let row = profile.role(role).expect("the model has it");
    let mut bytes = value.to_le_bytes()[..usize::from(row.size)].to_vec();
    if profile.word_order() == WordOrder::Big {
        bytes.reverse();
    }
    if is_summed(profile) {
        summed_packet(id, 3, &[&[row.address as u8], &bytes[..]].concat())
    } else {
        write(id, row.address, &bytes)
    }
}

/// Number, error byte and parameters of the one answer in `bytes`.
fn answer(profile: &ServoProfile, bytes: &[u8]) -> Option<(u8, u8, Vec<u8>)> {
    let (id, error, params, tail) = if is_summed(profile) {
        (2, 4, 5, 1)
    } else {
        (4, 8, 9, 2)
    };
    let last = bytes.len().checked_sub(tail)?;
    Some((
        *bytes.get(id)?,
        *bytes.get(error)?,
        bytes.get(params..last)?.to_vec(),
    ))
}

fn bus_with(profile: &ServoProfile, ids: &[u8]) -> Host {
    let mut bus = ServoBus::new(BusOptions::default());
    for &id in ids {
        let unit = Unit {
            return_delay_us: Some(0),
            ..Unit::new(id)
        };
        bus.add(profile, unit).expect("fits");
    }
    Host::new(bus)
}

#[test]
fn every_model_tells_its_number_and_keeps_what_it_is_told() {
    for profile in models() {
        let name = &profile.name;
        let mut host = bus_with(&profile, &[1]);
        let ping = answer(&profile, &host.ask(&say(&profile, 1, 1, &[]))).expect("a ping is answered");
        assert_eq!((ping.0, ping.1), (1, 0), "{name}");
        let mut number = profile.model_number.to_le_bytes();
        if !is_summed(&profile) {
            assert_eq!(ping.2, [number[0], number[1], profile.firmware], "{name}");
        }
        if profile.word_order() == WordOrder::Big {
            number.reverse();
        }
        let read = host.ask(&reading(&profile, 1, Role::ModelNumber));
        assert_eq!(answer(&profile, &read), Some((1, 0, number.to_vec())), "{name}");
        // Everything that has a start value starts with it.
        for row in profile.registers.iter().filter(|row| row.count == 1) {
            let own = [Role::Id, Role::BaudRate, Role::ReturnDelay, Role::ModelNumber].map(Some);
            let measured = row.access == device_profiles::Access::R;
            if let Some(init) = row.init.filter(|_| !measured && !own.contains(&row.role)) {
                if row.role == Some(Role::GoalPosition) {
                    continue;
                }
                assert_eq!(host.register(1, &row.name), init, "{name} {}", row.name);
            }
        }
        let led = if profile.role(Role::Led).is_some() {
            Role::Led
        } else {
            Role::PositionP
        };
        let done = host.ask(&writing(&profile, 1, led, 1));
        assert_eq!(answer(&profile, &done), Some((1, 0, vec![])), "{name}");
        let kept = answer(&profile, &host.ask(&reading(&profile, 1, led))).expect("answers");
        assert_eq!(kept.2[0], 1, "{name}");
    }
}

#[test]
fn a_new_number_or_speed_counts_at_once_and_is_told_in_the_old_manner() {
    for profile in models() {
        let name = &profile.name;
        let mut host = bus_with(&profile, &[1]);
        let told = host.ask(&writing(&profile, 1, Role::Id, 7));
        assert_eq!(answer(&profile, &told).map(|told| told.0), Some(1), "{name}");
        host.wait(100);
        assert_eq!(host.ask(&say(&profile, 1, 1, &[])), [], "{name}");
        assert_eq!(
            answer(&profile, &host.ask(&say(&profile, 7, 1, &[]))).map(|told| told.0),
            Some(7),
            "{name}"
        );
        let code = profile.baud_code(57_600).expect("all have it");
        let told = host.ask(&writing(&profile, 7, Role::BaudRate, code.into()));
        assert!(answer(&profile, &told).is_some(), "{name}");
        host.wait(100);
        assert_eq!(host.ask(&say(&profile, 7, 1, &[])), [], "{name} at the old speed");
        host.bus.set_line_baud(host.now_us, 57_600);
        assert!(
            !host.ask(&say(&profile, 7, 1, &[])).is_empty(),
            "{name} at the new speed"
        );
        // Without power in between, and with.
        host.bus
            .inject(host.now_us, &Fault::parse("servo 7 reboot").expect("a fault"));
        host.wait(1000);
        let persists = host.ask(&say(&profile, 7, 1, &[]));
        // A Feetech servo is locked until it is told otherwise.
        let is_feetech = matches!(profile.protocol, ServoProtocol::Sts | ServoProtocol::Scs);
        assert_eq!(persists.is_empty(), is_feetech, "{name} after a reboot");
    }
}

#[test]
fn group_reads_are_answered_by_those_that_know_them() {
    for profile in models() {
        let name = &profile.name;
        let row = profile.role(Role::PresentPosition).expect("all have it");
        let (at, size) = (row.address as u8, row.size);
        let mut host = bus_with(&profile, &[4, 2]);
        let (sync, bulk) = if is_summed(&profile) {
            (
                summed_packet(254, 0x82, &[at, size, 2, 4]),
                summed_packet(254, 0x92, &[0, size, 2, at, size, 4, at]),
            )
        } else {
            (
                packet(254, 0x82, &[at, 0, size, 0, 2, 4]),
                packet(254, 0x92, &[2, at, 0, size, 0, 4, at, 0, size, 0]),
            )
        };
        let (start, overhead) = if is_summed(&profile) { (2, 6) } else { (4, 11) };
        let ids = |bytes: Vec<u8>| -> Vec<u8> {
            bytes
                .chunks(overhead + usize::from(size))
                .map(|status| status[start])
                .collect()
        };
        let both = |knows: bool| if knows { vec![2, 4] } else { vec![] };
        assert_eq!(ids(host.ask(&sync)), both(profile.sync_read), "{name} sync");
        assert_eq!(ids(host.ask(&bulk)), both(profile.bulk_read), "{name} bulk");
        // A ping to all: in order where they know how, garbled where they do not.
        let heard = host.ask(&say(&profile, 254, 1, &[]));
        let overhead = if is_summed(&profile) { 6 } else { 14 };
        let orderly: Vec<u8> = heard
            .chunks(overhead)
            .filter_map(|status| status.get(start).copied())
            .collect();
        assert_eq!(
            orderly == [2, 4],
            profile.broadcast_ping,
            "{name} ping to all: {heard:02X?}"
        );
        assert!(!heard.is_empty(), "{name}");
    }
}

#[test]
fn behind_an_absent_servo_it_is_as_the_switch_says() {
    let profiles = Profiles::builtin();
    for (model, bulk, goes_on) in [
        ("sts3215", false, true),
        ("mx-28", true, false),
        ("xl-320", false, true),
    ] {
        let profile = profiles.servo(model).expect("shipped");
        let ask = match (is_summed(profile), bulk) {
            (true, false) => summed_packet(254, 0x82, &[56, 2, 1, 2, 3]),
            (true, true) => summed_packet(254, 0x92, &[0, 2, 1, 36, 2, 2, 36, 2, 3, 36]),
            (false, _) => packet(254, 0x82, &[37, 0, 2, 0, 1, 2, 3]),
        };
        for absent in [Absent::Silence, Absent::GoOnAfter(500)] {
            let mut bus = ServoBus::new(BusOptions {
                absent,
                ..BusOptions::default()
            });
            for id in [1, 3] {
                bus.add(profile, Unit::new(id)).expect("fits");
            }
            let start = if is_summed(profile) { 2 } else { 4 };
            let overhead = if is_summed(profile) { 8 } else { 13 };
            let heard = Host::new(bus).ask(&ask);
            let ids: Vec<u8> = heard.chunks(overhead).map(|status| status[start]).collect();
            let expected: &[u8] = if goes_on && absent != Absent::Silence {
                &[1, 3]
            } else {
                &[1]
            };
            assert_eq!(ids, expected, "{model} {absent:?}");
        }
    }
}

#[test]
fn four_languages_share_one_line() {
    let profiles = Profiles::builtin();
    let mut bus = ServoBus::new(BusOptions::default());
    let models = ["xl430-w250", "ax-12a", "sts3215", "scs0009"];
    for (id, model) in (1..).zip(models) {
        let unit = Unit {
            return_delay_us: Some(0),
            ..Unit::new(id)
        };
        bus.add(profiles.servo(model).expect("shipped"), unit)
            .expect("fits");
    }
    let mut host = Host::new(bus);
    for round in 0..20 {
        for (id, model) in (1..).zip(models) {
            let profile = profiles.servo(model).expect("shipped");
            let heard = host.ask(&reading(profile, id, Role::ModelNumber));
            let (who, error, _) = answer(profile, &heard).expect("an answer");
            assert_eq!((who, error), (id, 0), "{model}, round {round}");
            // The other framing reaches nobody.
            let foreign = if is_summed(profile) {
                packet(id, 1, &[])
            } else {
                summed_packet(id, 1, &[])
            };
            assert_eq!(host.ask(&foreign), [], "{model}");
        }
    }
    assert_eq!(host.bus.dropped_packets(), 0);
}

#[test]
fn other_firmware_has_other_rows() {
    let profiles = Profiles::builtin();
    let profile = profiles.servo("xl330-m288").expect("shipped");
    for (firmware, data) in [(53, 224), (52, 208)] {
        let mut bus = ServoBus::new(BusOptions::default());
        let unit = Unit {
            firmware: Some(firmware),
            ..Unit::new(1)
        };
        bus.add(profile, unit).expect("fits");
        let mut host = Host::new(bus);
        assert_eq!(
            host.error_of(&write(1, data, &[0x5A])),
            Some(0),
            "firmware {firmware}"
        );
        assert_eq!(host.ask(&read(1, data, 1))[9], 0x5A);
        let other = if data == 224 { None } else { Some(7) };
        if let Some(error) = other {
            // 228 and beyond is nothing before 53.
            assert_eq!(host.error_of(&write(1, 240, &[1])), Some(error));
        }
    }
}

#[test]
fn a_servo_as_it_comes_out_of_its_box() {
    let profiles = Profiles::builtin();
    for (model, baud) in [
        ("xl430-w250", 57_600),
        ("ax-12a", 1_000_000),
        ("mx-28", 57_600),
        ("sts3215", 1_000_000),
    ] {
        let profile = profiles.servo(model).expect("shipped");
        let unit = Unit::factory(profile);
        assert_eq!((unit.id, unit.baud), (1, Some(baud)), "{model}");
    }
}

#[test]
fn two_of_one_number_talk_over_each_other() {
    for profile in models() {
        let mut host = bus_with(&profile, &[5, 5]);
        let alone = bus_with(&profile, &[5]).ask(&reading(&profile, 5, Role::ModelNumber));
        let both = host.ask(&reading(&profile, 5, Role::ModelNumber));
        assert_eq!(both.len(), alone.len(), "{}", profile.name);
        assert_ne!(both, alone, "{}", profile.name);
        // Both obey what needs no answer.
        let id = profile.role(Role::Id).expect("has it").address;
        let write = if is_summed(&profile) {
            summed_packet(254, 3, &[id as u8, 6])
        } else {
            packet(254, 3, &[id as u8, 0, 6])
        };
        assert_eq!(host.ask(&write), [], "{}", profile.name);
        assert!(
            host.bus.servos().iter().all(|servo| servo.id() == 6),
            "{}",
            profile.name
        );
    }
}

/// Bytes that look like the beginnings of packets.
fn alphabet() -> impl Strategy<Value = Vec<u8>> {
    let byte = prop_oneof![
        Just(0x00u8),
        Just(0x01),
        Just(0x02),
        Just(0x03),
        Just(0xFD),
        Just(0xFE),
        Just(0xFF),
        any::<u8>(),
    ];
    proptest::collection::vec(byte, 0..200)
}

proptest! {
    /// Whatever was on the line, once it is silent long enough every servo hears its name again.
    #[test]
    fn any_bytes_are_survived_by_servos_of_any_language(noise in alphabet()) {
        let profiles = Profiles::builtin();
        let mut bus = ServoBus::new(BusOptions::default());
        let models = ["xl430-w250", "ax-12a", "sts3215", "scs0009"];
        for (id, model) in (11..).zip(models) {
            bus.add(profiles.servo(model).expect("shipped"), Unit::new(id)).expect("fits");
        }
        let mut host = Host::new(bus);
        host.ask(&noise);
        host.wait(3000);
        for (id, model) in (11..).zip(models) {
            let profile = profiles.servo(model).expect("shipped");
            // Noise may have been an instruction: to another number, speed or level, or to start over.
            let known = host.bus.servo(id).is_some_and(|servo| servo.counters().instructions == 0);
            if known {
                prop_assert!(!host.ask(&say(profile, id, 1, &[])).is_empty(), "{model}");
            }
        }
    }

    #[test]
    fn packets_arrive_as_they_were_meant(params in alphabet()) {
        let mut two = crate::servo_bus::dynamixel2::receiver::Receiver::default();
        let count = packet(1, 3, &params).iter().filter_map(|&byte| two.push(0, 0, byte)).count();
        prop_assert_eq!((count, two.params()), (1, &params[..]));
        let mut one = crate::servo_bus::summed::receiver::Receiver::default();
        let count = summed_packet(1, 3, &params).iter().filter_map(|&byte| one.push(0, 0, byte)).count();
        prop_assert_eq!((count, one.params()), (1, &params[..]));
    }
}

#[test]
fn every_model_gets_there_with_a_motor_of_its_own() {
    for profile in models() {
        let mut bus = ServoBus::new(BusOptions::default());
        let unit = Unit {
            return_delay_us: Some(0),
            plant: PlantKind::Real,
            ..Unit::new(1)
        };
        bus.add(&profile, unit).expect("fits");
        let mut host = Host::new(bus);
        host.ask(&writing(&profile, 1, Role::TorqueEnable, 1));
        let goal = profile.centre_counts + (profile.counts_per_turn / 12.0) as i32;
        host.ask(&writing(&profile, 1, Role::GoalPosition, goal as u32));
        host.wait(3000);
        let servo = host.bus.servo(1).expect("there");
        let off =
            servo.true_position_rad() - f64::from(goal - profile.centre_counts) * profile.rad_per_count();
        // Friction holds it off a little where there is no integral gain.
        assert!(off.abs() < 0.06, "{}: {off} rad off", profile.name);
        assert_eq!(servo.alarm_bits(), 0, "{}", profile.name);
        assert_eq!(host.register(1, moving(&profile)), 0, "{}", profile.name);
    }
}

/// What its maker calls the register that tells of a move.
fn moving(profile: &ServoProfile) -> &str {
    &profile.role(Role::Moving).expect("has it").name
}
