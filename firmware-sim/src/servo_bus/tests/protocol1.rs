//! DYNAMIXEL protocol 1.0: its error bits, its lock, its deafness, its margins.

use super::*;

fn ax(ids: &[u8]) -> Host {
    Host::new(bus_of("ax-12a", BusOptions::default(), ids))
}

fn put(address: u8, bytes: &[u8]) -> Vec<u8> {
    summed_packet(1, 3, &[&[address], bytes].concat())
}

fn get(address: u8, length: u8) -> Vec<u8> {
    summed_packet(1, 2, &[address, length])
}

/// The error byte of the one answer to `bytes`.
fn error(host: &mut Host, bytes: &[u8]) -> Option<u8> {
    host.ask(bytes).get(4).copied()
}

#[test]
fn refusals_have_the_bits_of_the_manual() {
    let table: [(Vec<u8>, u8, &str); 10] = [
        (put(25, &[1]), 0, "LED"),
        (put(25, &[2]), 1 << 3, "LED is 0 or 1"),
        (put(30, &[0xFF, 0x03]), 0, "the last count"),
        (put(36, &[0, 0]), 1 << 3, "Present Position is read only"),
        (put(10, &[0]), 1 << 3, "no register"),
        (put(30, &[1]), 1 << 3, "half a goal"),
        (get(50, 1), 1 << 3, "beyond the table"),
        (summed_packet(1, 5, &[]), 1 << 6, "nothing registered"),
        (summed_packet(1, 8, &[]), 1 << 6, "no reboot in protocol 1.0"),
        (summed_packet(1, 0x77, &[]), 1 << 6, "no such instruction"),
    ];
    let mut host = ax(&[1]);
    for (bytes, bits, why) in table {
        assert_eq!(error(&mut host, &bytes), Some(bits), "{why}");
    }
    // A goal beyond the angle limits.
    let mut host = ax(&[1]);
    assert_eq!(error(&mut host, &put(8, &[0x00, 0x02])), Some(0));
    host.wait(100);
    assert_eq!(
        error(&mut host, &put(30, &[0x01, 0x02])),
        Some(1 << 1),
        "angle limit"
    );
    assert_eq!(error(&mut host, &put(30, &[0x00, 0x02])), Some(0));
}

#[test]
fn alarms_persist_while_data_are_served() {
    let mut host = ax(&[1]);
    host.bus
        .inject(0, &Fault::parse("servo 1 hot 90").expect("a fault"));
    host.wait(10);
    let heard = host.ask(&get(43, 1));
    assert_eq!(
        heard[4..6],
        [1 << 2, 90],
        "overheating, and the temperature all the same"
    );
    // Shutdown names heat: the motor lets go, and does not hold again.
    assert_eq!(error(&mut host, &put(24, &[1])), Some(1 << 2));
    assert!(!host.bus.servo(1).expect("there").torque_is_on());
}

#[test]
fn levels_say_what_is_answered() {
    let mut host = ax(&[1]);
    for (level, reads, writes) in [(2, true, true), (1, true, false), (0, false, false)] {
        host.ask(&put(16, &[level]));
        host.wait(100);
        assert!(
            !host.ask(&summed_packet(1, 1, &[])).is_empty(),
            "a ping at {level}"
        );
        assert_eq!(!host.ask(&get(43, 1)).is_empty(), reads, "a read at {level}");
        assert_eq!(!host.ask(&put(25, &[1])).is_empty(), writes, "a write at {level}");
    }
}

#[test]
fn a_spoilt_packet_is_dropped_or_told() {
    let mut spoilt = get(43, 1);
    *spoilt.last_mut().expect("a sum") ^= 1;
    assert_eq!(ax(&[1]).ask(&spoilt), []);
    let options = BusOptions {
        bad_crc: BadCrc::Answer,
        ..BusOptions::default()
    };
    let mut host = Host::new(bus_of("ax-12a", options.clone(), &[1]));
    assert_eq!(error(&mut host, &spoilt), Some(1 << 4));
    // Feetech has no bit for it.
    assert_eq!(Host::new(bus_of("sts3215", options, &[1])).ask(&spoilt), []);
}

#[test]
fn a_write_to_eeprom_is_answered_at_once_and_then_nothing() {
    let mut host = ax(&[1]);
    // Two bytes: deaf for 12 ms.
    assert_eq!(error(&mut host, &put(8, &[0x00, 0x03])), Some(0));
    let mut host = ax(&[1]);
    host.bus.receive(host.now_us, &put(8, &[0x00, 0x03]));
    assert_eq!(host.wait(1).len(), 6);
    host.bus.receive(host.now_us, &get(8, 2));
    assert_eq!(host.wait(5), [], "deaf");
    host.wait(8);
    host.bus.receive(host.now_us, &get(8, 2));
    assert_eq!(host.wait(5)[5..7], [0x00, 0x03]);
}

#[test]
fn a_lock_holds_until_power_is_off() {
    let mut host = ax(&[1]);
    assert_eq!(error(&mut host, &put(47, &[1])), Some(0));
    assert_eq!(error(&mut host, &put(18, &[4])), Some(1 << 3), "locked");
    assert_eq!(host.register(1, "Shutdown"), 36);
    assert_eq!(error(&mut host, &put(47, &[0])), Some(0));
    assert_eq!(host.register(1, "Lock"), 1, "a 0 changes nothing");
    host.bus
        .inject(host.now_us, &Fault::parse("supply 0 for 100ms").expect("a fault"));
    host.wait(1000);
    assert_eq!(error(&mut host, &put(18, &[4])), Some(0));
    // Torque locks it as well.
    host.wait(20);
    assert_eq!(error(&mut host, &put(24, &[1])), Some(0));
    assert_eq!(error(&mut host, &put(18, &[36])), Some(1 << 3));
}

#[test]
fn registered_writes_wait_for_their_action() {
    let mut host = ax(&[1]);
    assert_eq!(error(&mut host, &summed_packet(1, 4, &[30, 0x58, 0x02])), Some(0));
    assert_eq!(host.register(1, "Registered"), 1);
    assert_ne!(host.register(1, "Goal Position"), 600);
    host.ask(&summed_packet(254, 5, &[]));
    assert_eq!(
        (host.register(1, "Registered"), host.register(1, "Goal Position")),
        (0, 600)
    );
}

#[test]
fn a_goal_takes_its_speed_along_and_margins_are_left_alone() {
    let mut host = ax(&[1]);
    // 300 counts at Moving Speed 100: 100 units of 0.111 rpm are 227.3 counts/s.
    assert_eq!(error(&mut host, &put(30, &[212, 0, 100, 0])), Some(0));
    assert!(host.bus.servo(1).expect("there").torque_is_on(), "a goal arms");
    host.wait(660);
    let half = host.register(1, "Present Position");
    assert!((350..=372).contains(&half), "{half}");
    assert_eq!(host.register(1, "Present Speed"), -100);
    assert_eq!(host.register(1, "Moving"), 1);
    host.wait(900);
    assert_eq!(host.register(1, "Present Position"), 212);
    assert_eq!(host.register(1, "Moving"), 0);
    // One count away is within the margin.
    host.ask(&put(30, &[213, 0]));
    host.wait(500);
    assert_eq!(host.register(1, "Present Position"), 212);
    host.ask(&put(30, &[214, 0]));
    host.wait(500);
    assert_eq!(host.register(1, "Present Position"), 214);
}

#[test]
fn both_limits_zero_make_a_wheel() {
    let mut host = ax(&[1]);
    for address in [6, 8] {
        host.ask(&put(address, &[0, 0]));
        host.wait(20);
    }
    assert_eq!(error(&mut host, &put(24, &[1])), Some(0));
    // Half of all there is, clockwise: bit 10.
    assert_eq!(error(&mut host, &put(32, &[0xF4, 0x05])), Some(0));
    host.wait(500);
    let speed = host.bus.servo(1).expect("there").true_velocity_rad_per_s();
    assert!((-3.2..-2.9).contains(&speed), "{speed}");
    // Behind the potentiometer's end it sees the end.
    let seen = host.register(1, "Present Position");
    assert!((0..=1023).contains(&seen), "{seen}");
}
