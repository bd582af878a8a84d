//! Where the horn goes: profiles, modes, signs and offsets, gravity and hands.

use super::*;
use std::f64::consts::TAU;

/// Radians per second for one count of a velocity register: 0.229 rpm.
const SPEED_UNIT: f64 = 0.229 * TAU / 60.0;

/// Sets Profile Acceleration and Velocity.
fn profile(host: &mut Host, acceleration: i32, velocity: i32) {
    let bytes = [acceleration.to_le_bytes(), velocity.to_le_bytes()].concat();
    assert_eq!(host.error_of(&write(1, 108, &bytes)), Some(0));
}

/// Milliseconds until Moving Status says the profile is over.
fn profile_millis(host: &mut Host) -> u64 {
    let mut millis = 0;
    while host.register(1, "Moving Status") & 2 != 0 && millis < 20_000 {
        host.wait(1);
        millis += 1;
    }
    millis
}

#[test]
fn the_true_speed_never_exceeds_the_profiles() {
    for (acceleration, velocity) in [(0, 20), (0, 200), (10, 100), (3, 40), (500, 100)] {
        let mut host = Host::new(bus(BusOptions::default(), &[1]));
        profile(&mut host, acceleration, velocity);
        host.drive(1, 3500);
        host.wait(700);
        // Turned round in mid flight.
        host.ask(&write(1, 116, &600i32.to_le_bytes()));
        host.wait(12_000);
        assert!(host.register(1, "Present Position").abs_diff(600) <= 1);
        let fastest = host.bus.servo(1).expect("there").counters().speed_max_rad_per_s;
        let limit = f64::from(velocity) * SPEED_UNIT;
        assert!(fastest <= limit * 1.000_001, "{fastest} above {limit}");
        assert!(fastest > limit * 0.9 || acceleration == 3);
        // A profile's acceleration bounds the true one as well.
        if acceleration > 0 {
            let hardest = host
                .bus
                .servo(1)
                .expect("there")
                .counters()
                .acceleration_max_rad_per_s2;
            assert!(hardest <= f64::from(acceleration) * 0.374_51 * 1.001, "{hardest}");
        }
    }
}

#[test]
fn profiles_take_the_times_of_the_manual() {
    // V 100, A 10: t1 = 640 ms; 2048 counts at 1563 counts/s: 640 + 1310 ms in all.
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    profile(&mut host, 10, 100);
    host.drive(1, 0);
    assert_eq!(
        host.register(1, "Moving Status") & 0x32,
        0x32,
        "a trapezoid under way"
    );
    let millis = profile_millis(&mut host);
    assert!((1925..=1935).contains(&millis), "{millis}");
    host.wait(300);
    assert_eq!(
        (host.register(1, "Moving Status"), host.register(1, "Moving")),
        (1, 0)
    );
    // Time based: 1 s in all, 200 ms of it speeding up.
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    assert_eq!(host.error_of(&write(1, 10, &[4])), Some(0));
    profile(&mut host, 200, 1000);
    assert_eq!(host.error_of(&write(1, 112, &32_750i32.to_le_bytes())), Some(4));
    host.drive(1, 1000);
    let millis = profile_millis(&mut host);
    assert!((975..=985).contains(&millis), "{millis}");
}

#[test]
fn without_a_profile_only_the_motor_is_the_limit() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.drive(1, 4095);
    assert_eq!(host.register(1, "Position Trajectory"), 4095);
    host.wait(2000);
    assert_eq!(host.register(1, "Present Position"), 4095);
    let fastest = host.bus.servo(1).expect("there").counters().speed_max_rad_per_s;
    assert!(fastest <= 265.0 * SPEED_UNIT * 1.000_001 && fastest > 200.0 * SPEED_UNIT);
}

#[test]
fn torque_on_goes_for_the_goal_register_at_once() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    assert_eq!(host.register(1, "Goal Position"), 2048, "as found at power-up");
    host.bus.push(host.now_us, 1, 0.5);
    host.ask(&write(1, 64, &[1]));
    host.wait(500);
    assert_eq!(
        host.register(1, "Present Position"),
        2048,
        "nobody had pinned the goal"
    );
}

#[test]
fn signs_and_offsets_are_the_manuals() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.bus.push(0, 1, 100.0 * TAU / 4096.0);
    assert_eq!(host.register(1, "Present Position"), 2148);
    host.ask(&write(1, 20, &500i32.to_le_bytes()));
    assert_eq!(host.register(1, "Present Position"), 2648);
    host.ask(&write(1, 20, &1025i32.to_le_bytes()));
    assert_eq!(
        host.register(1, "Present Position"),
        2148,
        "too large an offset is ignored"
    );
    host.ask(&write(1, 20, &500i32.to_le_bytes()));
    host.ask(&write(1, 10, &[1]));
    assert_eq!(
        host.register(1, "Present Position"),
        1948 + 500,
        "reversed, the offset keeps its sign"
    );
    host.drive(1, 2000);
    host.wait(1000);
    assert_eq!(host.register(1, "Present Position"), 2000);
    let shaft = host.bus.servo(1).expect("there").true_position_rad();
    assert!((shaft - (4096.0 - 1500.0 - 2048.0) * TAU / 4096.0).abs() < 1e-3);
}

#[test]
fn velocity_mode_turns_until_told_otherwise() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.ask(&write(1, 11, &[1]));
    host.ask(&write(1, 64, &[1]));
    host.ask(&write(1, 104, &(-100i32).to_le_bytes()));
    host.wait(1000);
    assert_eq!(host.register(1, "Present Velocity"), -100);
    host.ask(&write(1, 104, &0i32.to_le_bytes()));
    host.wait(300);
    assert_eq!(host.register(1, "Present Velocity"), 0);
}

#[test]
fn without_torque_it_sinks_and_yields() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.bus.set_sag(
        0,
        1,
        Some(Sag {
            to_rad: -1.0,
            rad_per_s: 0.5,
        }),
    );
    host.wait(1000);
    let sunk = host.bus.servo(1).expect("there").true_position_rad();
    assert!((sunk + 0.5).abs() < 0.02, "{sunk}");
    host.wait(3000);
    assert!((host.bus.servo(1).expect("there").true_position_rad() + 1.0).abs() < 1e-6);
    host.drive(1, 2048);
    host.wait(2000);
    assert_eq!(
        host.register(1, "Present Position"),
        2048,
        "torque holds against it"
    );
    host.bus.push(host.now_us, 1, 0.2);
    host.wait(500);
    assert_eq!(host.register(1, "Present Position"), 2048, "and pulls back");
}

#[test]
fn the_tick_counts_milliseconds_by_the_servos_own_clock() {
    let profiles = Profiles::builtin();
    let mut bus = ServoBus::new(BusOptions::default());
    let unit = Unit {
        drift_ppm: 10_000,
        ..Unit::new(1)
    };
    bus.add(profiles.servo("xl430-w250").expect("shipped"), unit)
        .expect("fits");
    let mut host = Host::new(bus);
    host.wait(10_000);
    assert_eq!(host.register(1, "Realtime Tick"), 10_100);
    host.wait(30_000);
    assert_eq!(host.register(1, "Realtime Tick"), 40_400 - 32_768);
}

#[test]
fn drive_mode_bit_three_switches_torque_on_by_a_goal() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.ask(&write(1, 10, &[8]));
    host.ask(&write(1, 116, &1000i32.to_le_bytes()));
    host.wait(1000);
    assert!(host.bus.servo(1).expect("there").torque_is_on());
    assert_eq!(host.register(1, "Present Position"), 1000);
}
