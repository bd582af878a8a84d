//! What goes wrong when it is told to, and what stays wrong afterwards.

use super::*;

fn inject(host: &mut Host, text: &str) {
    host.bus.inject(host.now_us, &Fault::parse(text).expect(text));
}

#[test]
fn faults_read_back_as_they_print() {
    for text in [
        "servo 3 stuck at 2s",
        "cable cut after 4 at 5s",
        "cable cut",
        "drop 1%",
        "late 30ms once",
        "noise",
        "noise 0.5% for 100ms",
        "silent 5",
        "servo 5 silent",
        "servo 2 hot",
        "servo 2 hot 90C",
        "servo 1 error 36",
        "servo 1 load -0.5",
        "servo 9 reboot at 1.5s",
        "brownout",
        "brownout 4.2V for 2s",
        "supply 11.1",
        "stall for 1s",
        "echo",
    ] {
        let fault = Fault::parse(text).expect(text);
        assert_eq!(Fault::parse(&fault.to_string()), Ok(fault), "{text}");
    }
    for (text, column) in [
        ("", 1),
        ("explode", 1),
        ("servo x stuck", 7),
        ("servo 254 stuck", 7),
        ("servo 3", 8),
        ("drop 1", 6),
        ("drop 101%", 6),
        ("late 30", 6),
        ("cable tie", 7),
        ("noise sometimes", 7),
        ("silent 5 at", 12),
        ("stall in 3s", 7),
    ] {
        assert_eq!(Fault::parse(text).expect_err(text).column, column, "{text}");
    }
}

#[test]
fn a_jammed_horn_pulls_until_it_shuts_down_for_good() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    inject(&mut host, "servo 1 stuck");
    host.drive(1, 3000);
    host.wait(500);
    assert_eq!(host.register(1, "Present Load"), 1000);
    assert_eq!(host.register(1, "Moving Status") & 8, 8, "following error");
    host.wait(1500);
    assert_eq!(host.register(1, "Hardware Error Status"), 1 << 5);
    assert!(!host.bus.servo(1).expect("there").torque_is_on());
    host.bus.mend(host.now_us);
    assert_eq!(
        host.error_of(&packet(1, 1, &[])),
        Some(0x80),
        "the alert bit is in every answer"
    );
    assert_eq!(host.error_of(&write(1, 64, &[1])), Some(0x80));
    assert_eq!(host.register(1, "Torque Enable"), 0, "only a reboot clears it");
    host.ask(&packet(1, 8, &[]));
    host.wait(300);
    assert_eq!(host.error_of(&write(1, 64, &[1])), Some(0));
    assert_eq!(host.register(1, "Torque Enable"), 1);
}

#[test]
fn a_brown_out_is_latched_where_shutdown_names_it() {
    for (model, latched) in [("xl330-m288", true), ("xl430-w250", false)] {
        let mut host = Host::new(bus_of(model, BusOptions::default(), &[1]));
        host.ask(&write(1, 64, &[1]));
        inject(&mut host, "supply 3.2 for 500ms");
        host.wait(250);
        assert_eq!(host.register(1, "Hardware Error Status"), 1);
        assert_eq!(host.register(1, "Present Input Voltage"), 32);
        host.wait(500);
        assert_eq!(
            host.register(1, "Hardware Error Status"),
            i64::from(latched),
            "{model}"
        );
        assert_eq!(host.bus.servo(1).expect("there").torque_is_on(), !latched);
    }
}

#[test]
fn a_hot_motor_shuts_down() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.ask(&write(1, 64, &[1]));
    inject(&mut host, "servo 1 hot 80");
    host.wait(10);
    assert_eq!(
        (
            host.register(1, "Present Temperature"),
            host.register(1, "Hardware Error Status")
        ),
        (80, 4)
    );
    assert_eq!(host.register(1, "Torque Enable"), 0);
}

#[test]
fn work_makes_heat() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.ask(&write(1, 64, &[1]));
    inject(&mut host, "servo 1 load 0.8");
    host.wait(180_000);
    let warm = host.register(1, "Present Temperature");
    assert!((50..60).contains(&warm), "{warm}");
}

#[test]
fn the_bus_watchdog_stops_the_motor_and_refuses_goals_until_cleared() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.ask(&write(1, 112, &20i32.to_le_bytes()));
    host.drive(1, 4000);
    assert_eq!(host.error_of(&write(1, 98, &[5])), Some(0));
    for _ in 0..10 {
        host.wait(50);
        host.ask(&packet(1, 1, &[]));
    }
    assert_eq!(host.register(1, "Bus Watchdog"), 5, "fed by any packet");
    host.wait(300);
    assert_eq!(host.register(1, "Bus Watchdog"), -1);
    assert_eq!(host.register(1, "Present Velocity"), 0);
    let stopped_at = host.register(1, "Present Position");
    assert!(stopped_at < 3000);
    assert_eq!(host.error_of(&write(1, 116, &4000i32.to_le_bytes())), Some(4));
    assert_eq!(host.ask(&read(1, 98, 1))[9], 255);
    assert_eq!(host.error_of(&write(1, 98, &[5])), Some(4));
    assert_eq!(host.error_of(&write(1, 98, &[0])), Some(0));
    host.wait(500);
    assert_eq!(
        host.register(1, "Present Position"),
        stopped_at,
        "stays until told"
    );
    assert_eq!(host.error_of(&write(1, 116, &4000i32.to_le_bytes())), Some(0));
}

#[test]
fn a_cut_cable_takes_power_and_answers_behind_it() {
    let mut host = Host::new(bus(
        BusOptions {
            absent: Absent::GoOnAfter(100),
            ..BusOptions::default()
        },
        &[1, 2, 3],
    ));
    host.ask(&packet(254, 3, &[64, 0, 1]));
    inject(&mut host, "cable cut after 1 at 100ms for 1s");
    assert_eq!(host.ask(&packet(254, 1, &[])).len(), 3 * 14);
    host.wait(200);
    assert_eq!(host.ask(&packet(254, 1, &[])).len(), 14);
    assert!(host.bus.servos()[0].torque_is_on());
    assert!(!host.bus.servos()[2].torque_is_on() && !host.bus.servos()[2].is_connected());
    host.wait(1500);
    assert_eq!(host.ask(&packet(254, 1, &[])).len(), 3 * 14);
    assert_eq!(host.register(3, "Torque Enable"), 0, "RAM is lost");
}

#[test]
fn answers_are_lost_late_or_spoilt() {
    let mut host = Host::new(bus(
        BusOptions {
            seed: 7,
            ..BusOptions::default()
        },
        &[1, 2],
    ));
    let good = host.ask(&packet(1, 1, &[]));
    inject(&mut host, "silent 1 for 100ms");
    assert_eq!(host.ask(&packet(1, 1, &[])), []);
    assert_eq!(host.ask(&packet(2, 1, &[])).len(), 14);
    host.wait(200);
    inject(&mut host, "drop 100% once");
    assert_eq!(host.ask(&packet(1, 1, &[])), []);
    assert_eq!(host.ask(&packet(1, 1, &[])), good);
    assert_eq!(host.bus.statuses().filter(|status| status.lost).count(), 1);
    inject(&mut host, "late 30ms once");
    assert_eq!(host.ask(&packet(1, 1, &[])), []);
    assert_eq!(host.wait(20), good);
    inject(&mut host, "stall for 50ms");
    assert_eq!(host.ask(&packet(1, 1, &[])), []);
    assert_eq!(host.wait(40), good);
    inject(&mut host, "noise 100% for 10ms");
    assert_ne!(host.ask(&packet(1, 1, &[])), good);
    host.wait(10);
    inject(&mut host, "echo");
    let ask = packet(1, 1, &[]);
    assert_eq!(host.ask(&ask), [ask.clone(), good].concat());
}

#[test]
fn the_same_seed_fails_the_same_way() {
    let play = |seed| {
        let mut host = Host::new(bus(
            BusOptions {
                seed,
                ..BusOptions::default()
            },
            &[1],
        ));
        inject(&mut host, "drop 30%");
        (0..40)
            .map(|_| !host.ask(&packet(1, 1, &[])).is_empty())
            .collect::<Vec<_>>()
    };
    assert_eq!(play(3), play(3));
    assert_ne!(play(3), play(4));
    assert!(play(3).contains(&false) && play(3).contains(&true));
}
