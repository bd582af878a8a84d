//! Every fault by its words, seen on the bytes.

use super::*;

fn host_of(ids: &[u8], faults: &[&str]) -> Host {
    let mut host = Host::new(bus(BusOptions::default(), ids));
    for text in faults {
        inject(&mut host, text);
    }
    host
}

fn inject(host: &mut Host, text: &str) {
    let fault = Fault::parse(text).expect(text);
    assert_eq!(host.bus.misfit(&fault), None, "{text}");
    host.bus.inject(host.now_us, &fault);
}

fn ping(id: u8) -> Vec<u8> {
    packet(id, 1, &[])
}

#[test]
fn words_that_are_nearly_right_are_named() {
    for (text, column, meant) in [
        ("servo 3 stuk at 2s", 9, Some("stuck")),
        ("servo 3 slient", 9, Some("silent")),
        ("cable cutt after 4", 7, Some("cut")),
        ("brownuot 1s", 1, Some("brownout")),
        ("servo 2 silent form 1s to 3s", 16, Some("from")),
        ("adapter latncy 16ms", 9, Some("latency")),
        ("lock left onn servo 1", 11, Some("on")),
        ("refuse write servo 2", 8, Some("writes")),
        ("servo 2 xyzzy", 9, None),
    ] {
        let error = Fault::parse(text).expect_err(text);
        assert_eq!(error.column, column, "{text}: {error}");
        assert!(error.message.starts_with("expected "), "{error}");
        let hint = error.message.split_once("did you mean ").map(|(_, hint)| hint);
        assert_eq!(
            hint,
            meant.map(|meant| format!("`{meant}`?")).as_deref(),
            "{error}"
        );
    }
    for (text, column) in [
        ("servo 2 silent from 3s to 1s", 27),
        ("servo 1 reboot for 2s every 1s", 29),
        ("servo 3 carries 1kg", 20),
        ("servo 3 load 2", 14),
        ("cable 500ohm", 7),
        ("servo 1 baud fast", 14),
        ("host", 5),
    ] {
        let error = Fault::parse(text).expect_err(text);
        assert_eq!(error.column, column, "{text}: {error}");
    }
    let bus = bus(BusOptions::default(), &[1, 2]);
    let fault = Fault::parse("servo 9 silent").expect("reads");
    assert_eq!(
        bus.misfit(&fault).as_deref(),
        Some("there is no servo 9; there are: 1, 2")
    );
}

#[test]
fn spans_repeat_and_end() {
    let mut host = host_of(&[1], &["servo 1 silent from 100ms to 200ms every 1s"]);
    let mut heard = Vec::new();
    for _ in 0..125 {
        heard.push(!host.ask(&ping(1)).is_empty());
    }
    // A question each 20 ms: five go unanswered in every second, three times over.
    let silent = |second: usize| {
        heard[second * 50..(second * 50 + 50).min(125)]
            .iter()
            .filter(|heard| !**heard)
            .count()
    };
    assert_eq!([silent(0), silent(1), silent(2)], [5, 5, 5]);
    let mut host = host_of(&[1], &["late 5ms once every 1s"]);
    let good = host.ask(&ping(1));
    host.wait(2000);
    inject(&mut host, "late 30ms once every 1s");
    assert_eq!(host.ask(&ping(1)), []);
    host.wait(100);
    assert_eq!(host.ask(&ping(1)), good);
    host.wait(1000);
    assert_eq!(host.ask(&ping(1)), [], "once more");
}

#[test]
fn a_deaf_servo_neither_obeys_nor_answers_and_keeps_its_torque() {
    let mut host = host_of(&[1, 2], &[]);
    host.drive(1, 2500);
    host.wait(500);
    inject(&mut host, "servo 1 deaf for 1s");
    assert_eq!(host.ask(&write(1, 116, &1000i32.to_le_bytes())), []);
    host.wait(500);
    assert_eq!(host.register(1, "Present Position"), 2500);
    assert!(host.bus.servo(1).expect("there").torque_is_on());
    assert_eq!(host.ask(&ping(2)).len(), 14, "its neighbours hear");
    host.wait(600);
    assert_eq!(host.ask(&ping(1)).len(), 14);
}

#[test]
fn a_silent_one_obeys() {
    let mut host = host_of(&[1], &["servo 1 silent"]);
    assert_eq!(host.ask(&write(1, 64, &[1])), []);
    assert!(host.bus.servo(1).expect("there").torque_is_on());
}

#[test]
fn numbers_collide_and_come_back() {
    let mut host = host_of(&[4, 5], &[]);
    let good = host.ask(&ping(4));
    inject(&mut host, "servo 5 id 4 for 1s");
    assert_eq!(host.ask(&ping(5)), []);
    let both = host.ask(&ping(4));
    assert!(both != good && both.len() == 14, "two talk at once: {both:02X?}");
    host.wait(1000);
    assert_eq!(host.ask(&ping(4)), good);
    assert_eq!(host.ask(&ping(5)).len(), 14);
}

#[test]
fn another_speed_is_silence_until_the_host_speaks_it() {
    let mut host = host_of(&[3], &["servo 3 baud 57600"]);
    assert_eq!(host.ask(&ping(3)), []);
    host.bus.set_line_baud(host.now_us, 57_600);
    assert_eq!(host.ask(&ping(3)).len(), 14);
    // A speed that no register can hold.
    inject(&mut host, "servo 3 baud 250000");
    assert_eq!(host.ask(&ping(3)), []);
    host.bus.set_line_baud(host.now_us, 250_000);
    assert_eq!(host.ask(&ping(3)).len(), 14);
}

#[test]
fn a_clock_too_far_off_is_another_speed() {
    let mut host = host_of(&[1], &["servo 1 drift 20000ppm"]);
    assert_eq!(host.ask(&ping(1)).len(), 14, "two per cent are harmless");
    inject(&mut host, "servo 1 drift 50000ppm");
    assert_eq!(host.ask(&ping(1)), [], "five are not");
}

#[test]
fn writes_are_refused_and_reads_are_not() {
    let mut host = host_of(&[2], &["refuse writes servo 2"]);
    assert_eq!(host.error_of(&write(2, 64, &[1])), Some(7));
    assert!(!host.bus.servo(2).expect("there").torque_is_on());
    assert_eq!(host.error_of(&read(2, 132, 4)), Some(0));
    host.bus.mend(host.now_us);
    assert_eq!(host.error_of(&write(2, 64, &[1])), Some(0));
}

#[test]
fn old_firmware_answers_no_fast_read() {
    let ask = packet(254, 0x8A, &[132, 0, 4, 0, 1, 2]);
    let mut host = host_of(&[1, 2], &[]);
    assert!(!host.ask(&ask).is_empty());
    inject(&mut host, "firmware without fast read for 1s");
    assert_eq!(host.ask(&ask), []);
    host.wait(1000);
    assert!(!host.ask(&ask).is_empty());
    inject(&mut host, "servo 1 firmware 40");
    assert_eq!(host.ask(&ping(1))[11], 40);
    assert_eq!(host.ask(&ask), [], "the first of the packet has no fast read");
}

#[test]
fn one_servos_bytes_are_spoilt_and_the_others_are_not() {
    let mut host = host_of(&[1, 2], &[]);
    let good = [1, 2].map(|id| host.ask(&ping(id)));
    inject(&mut host, "servo 2 flips 100%");
    assert_eq!(host.ask(&ping(1)), good[0]);
    let bad = host.ask(&ping(2));
    assert_eq!(bad.len(), 14);
    let flipped: u32 = bad.iter().zip(&good[1]).map(|(a, b)| (a ^ b).count_ones()).sum();
    assert_eq!(flipped, 14, "a bit in every byte");
    host.bus.mend(host.now_us);
    inject(&mut host, "servo 1 drop 100%");
    inject(&mut host, "servo 2 late 30ms");
    assert_eq!(host.ask(&ping(1)), []);
    assert_eq!(host.ask(&ping(2)), []);
    assert_eq!(host.wait(20), good[1]);
}

#[test]
fn a_cut_data_line_leaves_the_power() {
    let mut host = host_of(&[1, 2, 3], &[]);
    host.ask(&packet(254, 3, &[64, 0, 1]));
    inject(&mut host, "data cut after 1");
    assert_eq!(host.ask(&ping(1)).len(), 14);
    assert_eq!(host.ask(&ping(3)), []);
    assert!(host.bus.servos().iter().all(Servo::torque_is_on), "they hold");
}

#[test]
fn the_hosts_own_stall_delays_what_it_wrote() {
    let mut host = host_of(&[1], &["host stall 300ms at 10ms"]);
    host.wait(20);
    assert_eq!(host.ask(&ping(1)), []);
    assert_eq!(host.wait(200), []);
    assert!(!host.bus.servo(1).expect("there").counters().instructions > 0);
    assert_eq!(host.wait(100).len(), 14);
    inject(&mut host, "stall 50ms");
    assert_eq!(host.ask(&write(1, 64, &[1])), []);
    assert!(
        host.bus.servo(1).expect("there").torque_is_on(),
        "only the way back is stopped"
    );
    assert_eq!(host.wait(40).len(), 11);
}

#[test]
fn a_stall_without_end_ends_when_it_is_mended() {
    let mut host = host_of(&[1], &["host stall", "echo"]);
    assert_eq!(host.ask(&ping(1)), []);
    assert_eq!(host.wait(500), []);
    host.bus.mend(host.now_us);
    assert_eq!(host.wait(5).len(), 14, "what had been kept leaves at last");
    assert_eq!(host.ask(&ping(1)).len(), 14);
    inject(&mut host, "host stall 10s");
    host.ask(&ping(1));
    host.bus.mend(host.now_us);
    assert_eq!(host.wait(5).len(), 14, "mended early");
}

#[test]
fn a_slow_adapter_keeps_what_is_short() {
    let mut host = host_of(&[1], &["adapter latency 16ms"]);
    host.bus.receive(host.now_us, &ping(1));
    assert_eq!(host.wait(15), []);
    assert_eq!(host.wait(3).len(), 14);
    host.bus.mend(host.now_us);
    host.bus.receive(host.now_us, &ping(1));
    assert_eq!(host.wait(1).len(), 14, "mended, it hands over at once");
}

#[test]
fn a_thin_supply_line_starves_its_end() {
    let mut host = host_of(&[1, 2, 3, 4], &["cable 0.75ohm"]);
    host.ask(&packet(254, 3, &[64, 0, 1]));
    inject(&mut host, "every servo load 0.5");
    host.wait(50);
    let volts: Vec<i64> = (1..=4)
        .map(|id| host.register(id, "Present Input Voltage"))
        .collect();
    assert!(volts.is_sorted_by(|near, far| near > far), "{volts:?}");
    // Read on the wire as well, in the servo's own unit.
    assert_eq!(i64::from(host.ask(&read(4, 144, 2))[9]), volts[3]);
    assert_eq!(
        host.register(4, "Hardware Error Status") & 1,
        1,
        "below its limit: {volts:?}"
    );
    host.bus.mend(host.now_us);
    host.wait(10);
    assert!(host.register(4, "Present Input Voltage") >= volts[0]);
}

#[test]
fn a_load_is_a_share_a_torque_or_a_weight() {
    for (text, load) in [
        ("servo 1 load 0.5", 500..=500),
        ("servo 1 load -0.25", -250..=-250),
        ("servo 1 load 0.3Nm", 1..=999),
        ("servo 1 carries 0.2kg at 0.1m", 1..=999),
    ] {
        let mut host = host_of(&[1], &[text]);
        host.ask(&write(1, 64, &[1]));
        host.wait(50);
        let found = host.register(1, "Present Load");
        assert!(load.contains(&found), "{text}: {found}");
        let bytes = host.ask(&read(1, 126, 2));
        assert_eq!(
            i64::from(i16::from_le_bytes([bytes[9], bytes[10]])),
            found,
            "{text}"
        );
    }
    // A link is heavy while it is level and weighs nothing upright.
    let mut host = host_of(&[1], &["servo 1 carries 0.2kg at 0.1m"]);
    host.drive(1, 2048 + 1024);
    host.wait(2000);
    assert!(host.register(1, "Present Load").abs() <= 1);
}

#[test]
fn one_that_babbles_speaks_when_others_are_asked() {
    let mut host = host_of(&[1, 2], &[]);
    let good = host.ask(&ping(1));
    inject(&mut host, "servo 2 babbles");
    let heard: Vec<_> = (0..100).map(|_| host.ask(&ping(1))).collect();
    assert!(
        heard.iter().all(|bytes| *bytes != good),
        "garbage in or around every answer"
    );
    let whole = heard
        .iter()
        .filter(|bytes| bytes.windows(good.len()).any(|part| part == good))
        .count();
    assert!(
        (50..100).contains(&whole),
        "most answers come through whole, some do not: {whole}"
    );
    inject(&mut host, "cable cut after 1");
    host.wait(10);
    assert_eq!(host.ask(&ping(1)), good, "without power it is quiet");
}

#[test]
fn encoders_jitter_when_told_to() {
    let mut host = host_of(&[1], &["servo 1 jitter 3"]);
    let mut seen = std::collections::BTreeSet::new();
    for _ in 0..50 {
        host.wait(1);
        seen.insert(host.register(1, "Present Position"));
    }
    assert!(
        seen.len() > 3 && seen.iter().all(|count| count.abs_diff(2048) <= 3),
        "{seen:?}"
    );
    assert!(
        host.bus.servo(1).expect("there").true_position_rad().abs() < 1e-9,
        "the shaft stands"
    );
}

#[test]
fn what_somebody_left_in_a_register_is_found_there() {
    let mut host = host_of(&[1], &["servo 1 has homing-offset -300 for 1s"]);
    let bytes = host.ask(&read(1, 20, 4));
    assert_eq!(
        i32::from_le_bytes([bytes[9], bytes[10], bytes[11], bytes[12]]),
        -300
    );
    assert_eq!(host.register(1, "Present Position"), 2048 - 300);
    host.wait(1000);
    assert_eq!(host.register(1, "Present Position"), 2048);
    inject(&mut host, "servo 1 has return-delay 250");
    let asked_us = host.now_us;
    host.ask(&ping(1));
    let answer = host.bus.statuses().last().expect("answered");
    assert_eq!(answer.first_us - asked_us, 100 + 500, "ten bytes, then the delay");
}

#[test]
fn a_lock_is_a_register_where_there_is_one() {
    // The X series has none: nothing happens, and nothing breaks.
    let mut host = host_of(&[1], &["lock left on servo 1"]);
    assert_eq!(host.error_of(&write(1, 20, &5i32.to_le_bytes())), Some(0));
}

#[test]
fn a_reboot_forgets_ram_and_is_silent_meanwhile() {
    let mut host = host_of(&[1], &[]);
    host.ask(&write(1, 64, &[1]));
    inject(&mut host, "servo 1 reboot at 100ms");
    host.wait(110);
    assert_eq!(host.ask(&ping(1)), []);
    host.wait(300);
    assert_eq!(host.ask(&ping(1)).len(), 14);
    assert_eq!(host.register(1, "Torque Enable"), 0);
}

#[test]
fn a_plain_brownout_is_below_every_models_minimum() {
    for model in ["xl330-m288", "xl430-w250"] {
        let mut host = Host::new(bus_of(model, BusOptions::default(), &[1]));
        inject(&mut host, "brownout 1s");
        host.wait(100);
        assert_eq!(host.ask(&ping(1))[8], 0x80, "{model}: the alert bit");
        assert_eq!(host.register(1, "Hardware Error Status"), 1);
    }
    // Farther down the controller stops, and comes back by itself without its RAM.
    let mut host = host_of(&[1], &[]);
    host.ask(&write(1, 64, &[1]));
    inject(&mut host, "supply 2V for 100ms");
    assert_eq!(host.ask(&ping(1)), []);
    host.wait(500);
    assert_eq!(host.ask(&ping(1)).len(), 14);
    assert_eq!(host.register(1, "Torque Enable"), 0);
}
