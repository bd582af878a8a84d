//! Feetech STS and SCS: no error for a write, a lock that keeps it from lasting, sign and magnitude, either byte first.

use super::*;
use std::f64::consts::TAU;

fn sts(ids: &[u8]) -> Host {
    Host::new(bus_of("sts3215", BusOptions::default(), ids))
}

fn put(address: u8, bytes: &[u8]) -> Vec<u8> {
    summed_packet(1, 3, &[&[address], bytes].concat())
}

fn get(address: u8, length: u8) -> Vec<u8> {
    summed_packet(1, 2, &[address, length])
}

fn data(host: &mut Host, address: u8, length: u8) -> Vec<u8> {
    let heard = host.ask(&get(address, length));
    heard[5..heard.len() - 1].to_vec()
}

fn reboot(host: &mut Host) {
    host.bus
        .inject(host.now_us, &Fault::parse("supply 0 for 100ms").expect("a fault"));
    host.wait(1200);
}

#[test]
fn a_write_has_no_error_and_may_do_nothing() {
    let mut host = sts(&[1]);
    let table: [(Vec<u8>, &str, i64); 4] = [
        (put(56, &[1, 2]), "Present Position", 2048),
        (put(33, &[9]), "Operating Mode", 0),
        (put(40, &[77]), "Torque Enable", 0),
        (put(200, &[1]), "Goal Time", 0),
    ];
    for (bytes, name, still) in table {
        assert_eq!(host.ask(&bytes), [0xFF, 0xFF, 1, 2, 0, 0xFC], "{name}");
        assert_eq!(host.register(1, name), still, "{name}");
    }
    assert_eq!(
        host.ask(&summed_packet(1, 0x77, &[])),
        [],
        "what it does not know it does not answer"
    );
    assert_eq!(
        data(&mut host, 250, 4),
        [0; 4],
        "beyond the table there are zeros"
    );
    // Level 0 answers reads and pings only.
    host.ask(&put(8, &[0]));
    assert_eq!(host.ask(&put(41, &[1])), []);
    assert_eq!(data(&mut host, 41, 1), [1]);
}

#[test]
fn a_locked_servo_obeys_and_forgets() {
    for (model, lock) in [("sts3215", 55), ("scs0009", 48)] {
        let mut host = Host::new(bus_of(model, BusOptions::default(), &[1]));
        let before = host.register(1, "P Coefficient");
        let wear = host.bus.servo(1).expect("there").counters().eeprom_writes;
        host.ask(&put(21, &[77]));
        assert_eq!(host.register(1, "P Coefficient"), 77, "{model}: it takes effect");
        assert_eq!(host.bus.servo(1).expect("there").counters().eeprom_writes, wear);
        reboot(&mut host);
        assert_eq!(host.register(1, "P Coefficient"), before, "{model}: and is gone");
        host.ask(&put(lock, &[0]));
        host.ask(&put(21, &[78]));
        host.ask(&put(lock, &[1]));
        reboot(&mut host);
        assert_eq!(host.register(1, "P Coefficient"), 78, "{model}: kept");
        assert_eq!(host.register(1, "Lock"), 1, "{model}: locked again");
        assert_eq!(
            host.bus.servo(1).expect("there").counters().eeprom_writes,
            wear + 1
        );
    }
}

#[test]
fn numbers_below_zero_have_a_bit() {
    let mut host = sts(&[1]);
    host.ask(&put(31, &[0x64, 0x08]));
    assert_eq!(host.register(1, "Homing Offset"), -100);
    // Present is actual minus offset.
    assert_eq!(data(&mut host, 56, 2), 2148u16.to_le_bytes());
    // Velocity mode, backwards.
    host.ask(&put(33, &[1]));
    host.ask(&put(40, &[1]));
    host.ask(&put(46, &[0xE8, 0x83]));
    host.wait(500);
    assert_eq!(data(&mut host, 58, 2), [0xE8, 0x83]);
    let speed = host.bus.servo(1).expect("there").true_velocity_rad_per_s();
    assert!((speed + 1000.0 / 4096.0 * TAU).abs() < 1e-3, "{speed}");
}

#[test]
fn a_present_position_starts_over_after_a_turn_unless_turns_are_counted() {
    for (phase, expected) in [(0, 2048 + 2500 - 4096), (0x10, 2048 + 2500)] {
        let mut host = sts(&[1]);
        host.ask(&put(18, &[phase]));
        let turn = 2500.0 / 4096.0 * TAU;
        assert!(host.bus.push(host.now_us, 1, turn));
        assert_eq!(host.register(1, "Present Position"), expected, "phase {phase}");
    }
}

#[test]
fn the_middle_is_where_it_is_told() {
    let mut host = sts(&[1]);
    assert!(host.bus.push(0, 1, 300.0 / 4096.0 * TAU));
    host.ask(&put(40, &[128]));
    assert_eq!(host.register(1, "Present Position"), 2048);
    assert_eq!(host.register(1, "Torque Enable"), 0);
    assert_eq!(host.register(1, "Homing Offset"), 300);
    // Instruction 0B names the count.
    host.ask(&summed_packet(1, 0x0B, &[0xE8, 0x03]));
    assert_eq!(host.register(1, "Present Position"), 1000);
    reboot(&mut host);
    assert_eq!(
        host.register(1, "Present Position"),
        1000,
        "it lasts, locked or not"
    );
}

#[test]
fn firmware_before_3_10_cannot_be_told_its_position() {
    let profiles = Profiles::builtin();
    let mut bus = ServoBus::new(BusOptions::default());
    let unit = Unit {
        firmware_minor: 9,
        ..Unit::new(1)
    };
    bus.add(profiles.servo("sts3215").expect("shipped"), unit)
        .expect("fits");
    let mut host = Host::new(bus);
    assert_eq!(data(&mut host, 0, 2), [3, 9]);
    assert_eq!(host.ask(&summed_packet(1, 0x0B, &[0, 0])), []);
    assert_eq!(host.register(1, "Present Position"), 2048);
}

#[test]
fn one_write_of_goal_and_manner_is_one_move() {
    // Acceleration 0, goal 3048, time 0, speed 1000: one second.
    let mut host = sts(&[1]);
    host.ask(&put(41, &[0, 0xE8, 0x0B, 0, 0, 0xE8, 0x03]));
    assert!(host.bus.servo(1).expect("there").torque_is_on(), "a goal arms");
    host.wait(480);
    let half = host.register(1, "Present Position");
    assert!((2510..=2549).contains(&half), "{half}");
    host.wait(700);
    assert_eq!(host.register(1, "Present Position"), 3048);
    // In 400 ms by time, back again.
    host.ask(&put(42, &[0x00, 0x08, 0x90, 0x01]));
    host.wait(180);
    let half = host.register(1, "Present Position");
    assert!((2500..=2650).contains(&half), "{half}");
    host.wait(500);
    assert_eq!(host.register(1, "Present Position"), 2048);
    // An acceleration of 10 is 1000 steps/s2: 500 steps take 2 * sqrt(0.5) s.
    host.ask(&put(41, &[10, 0xF4, 0x09, 0, 0, 0, 0]));
    host.wait(1200);
    assert_ne!(host.register(1, "Present Position"), 2548);
    host.wait(500);
    assert_eq!(host.register(1, "Present Position"), 2548);
    let counters = host.bus.servo(1).expect("there").counters();
    assert!(counters.torque_ons == 1, "{counters:?}");
}

#[test]
fn goals_end_at_the_limits_and_never_cross_the_seam() {
    let mut host = sts(&[1]);
    host.ask(&put(11, &3000u16.to_le_bytes()));
    host.ask(&put(42, &3900u16.to_le_bytes()));
    host.wait(2000);
    assert_eq!(host.register(1, "Present Position"), 3000);
    assert_eq!(host.register(1, "Goal Position"), 3900);
    assert_eq!(host.register(1, "Target Position"), 3000);
    // With an offset the seam lies elsewhere; the way from 100 to 4000 is still through 2048.
    let mut host = sts(&[1]);
    host.ask(&put(31, &500u16.to_le_bytes()));
    host.ask(&put(42, &100u16.to_le_bytes()));
    host.wait(2000);
    let start = host.bus.servo(1).expect("there").true_position_rad();
    host.ask(&put(42, &4000u16.to_le_bytes()));
    host.wait(3000);
    let way = host.bus.servo(1).expect("there").true_position_rad() - start;
    assert!((way - 3900.0 / 4096.0 * TAU).abs() < 0.01, "{way}");
    assert_eq!(host.register(1, "Present Position"), 4000);
}

#[test]
fn a_step_is_from_here() {
    let mut host = sts(&[1]);
    host.ask(&put(33, &[3]));
    host.ask(&put(40, &[1]));
    for expected in [2148, 2248] {
        host.ask(&put(42, &[100, 0, 0, 0, 0xE8, 0x03]));
        host.wait(500);
        assert_eq!(host.register(1, "Present Position"), expected);
    }
    host.ask(&put(42, &[100, 0x80, 0, 0, 0xE8, 0x03]));
    host.wait(500);
    assert_eq!(host.register(1, "Present Position"), 2148);
}

#[test]
fn resets_and_reboots() {
    let mut host = sts(&[9]);
    host.ask(&summed_packet(9, 3, &[55, 0]));
    host.ask(&summed_packet(9, 3, &[21, 99]));
    // Recovery keeps the number.
    host.ask(&summed_packet(9, 6, &[]));
    host.wait(1000);
    assert_eq!(host.register(9, "P Coefficient"), 32);
    // A reboot has no answer and takes 800 ms.
    assert_eq!(host.ask(&summed_packet(9, 8, &[])), []);
    host.wait(700);
    assert_eq!(host.ask(&summed_packet(9, 1, &[])), []);
    host.wait(100);
    assert_eq!(host.ask(&summed_packet(9, 1, &[])).len(), 6);
}

#[test]
fn scs_has_its_high_byte_first() {
    let mut host = Host::new(bus_of("scs0009", BusOptions::default(), &[1]));
    assert_eq!(data(&mut host, 3, 2), [0x05, 0x04]);
    // Goal 812 in 500 ms.
    host.ask(&put(42, &[0x03, 0x2C, 0x01, 0xF4]));
    assert_eq!(host.register(1, "Goal Position"), 812);
    host.wait(230);
    let half = host.register(1, "Present Position");
    assert!((630..=700).contains(&half), "{half}");
    host.wait(500);
    assert_eq!(data(&mut host, 56, 2), [0x03, 0x2C]);
    // Both limits 0: Goal Time is an effort, bit 10 its sign.
    host.ask(&put(9, &[0, 0, 0, 0]));
    host.ask(&put(44, &[0x05, 0xF4]));
    host.wait(300);
    let speed = host.bus.servo(1).expect("there").true_velocity_rad_per_s();
    assert!(speed < -1.0, "{speed}");
}
