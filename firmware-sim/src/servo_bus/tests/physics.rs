//! The motor behind a real shaft: what its maker prints, what a hand and a weight do, and that it repeats.

use super::*;
use crate::servo_bus::plant::Order;
use crate::servo_bus::reg::Reg;
use std::f64::consts::TAU;

const RAD: f64 = TAU / 4096.0;

fn real(count: u8) -> Host {
    let profiles = Profiles::builtin();
    let profile = profiles.servo("xl430-w250").expect("shipped");
    let mut bus = ServoBus::new(BusOptions::default());
    for id in 1..=count {
        let unit = Unit {
            return_delay_us: Some(0),
            plant: PlantKind::Real,
            ..Unit::new(id)
        };
        bus.add(profile, unit).expect("fits");
    }
    Host::new(bus)
}

fn shaft(host: &Host) -> f64 {
    host.bus.servo(1).expect("there").true_position_rad()
}

fn speed(host: &Host) -> f64 {
    host.bus.servo(1).expect("there").true_velocity_rad_per_s()
}

fn inject(host: &mut Host, text: &str) {
    host.bus.inject(host.now_us, &Fault::parse(text).expect(text));
}

/// Pulse width mode, torque on, this share of 885.
fn full_drive(host: &mut Host, pwm: i16) {
    assert_eq!(host.error_of(&write(1, 11, &[16])), Some(0));
    assert_eq!(host.error_of(&write(1, 64, &[1])), Some(0));
    assert_eq!(host.error_of(&write(1, 100, &pwm.to_le_bytes())), Some(0));
}

#[test]
fn at_full_drive_it_runs_at_its_printed_speed_and_stalls_at_its_printed_torque() {
    let facts = real(1).bus.servo(1).expect("there").motor();
    let mut host = real(1);
    inject(&mut host, &format!("supply {}V", facts.volts));
    full_drive(&mut host, 885);
    host.wait(1000);
    assert!(
        (speed(&host) / facts.no_load_rad_per_s - 1.0).abs() < 0.03,
        "{}",
        speed(&host)
    );
    let amperes = host.bus.servo(1).expect("there").supply_amperes();
    assert!(amperes < 0.2 * facts.stall_a, "hardly any current: {amperes}");
    // Against a little less than the printed torque it still moves; against a little more it is turned back.
    for (share, forward) in [(0.93, true), (1.07, false)] {
        let mut host = real(1);
        inject(&mut host, &format!("supply {}V", facts.volts));
        inject(&mut host, &format!("servo 1 load {}Nm", share * facts.stall_nm));
        full_drive(&mut host, 885);
        host.wait(300);
        assert_eq!(speed(&host) > 0.0, forward, "{share}: {}", speed(&host));
    }
}

#[test]
fn a_step_is_made_quickly_and_settles_within_what_friction_leaves() {
    let mut host = real(1);
    host.drive(1, 3000);
    host.wait(100);
    assert!(speed(&host) > 1.0);
    host.wait(1500);
    assert!(
        host.register(1, "Present Position").abs_diff(3000) <= 6,
        "{}",
        host.register(1, "Present Position")
    );
    assert!(speed(&host).abs() < 1e-6, "dry friction holds it: no hunting");
    let top = host.bus.servo(1).expect("there").counters().speed_max_rad_per_s;
    let motor = host.bus.servo(1).expect("there").motor();
    assert!(top <= motor.no_load_rad_per_s * 1.05, "{top}");
}

#[test]
fn a_profile_is_followed_with_a_lag() {
    let mut host = real(1);
    let bytes = [0i32.to_le_bytes(), 60i32.to_le_bytes()].concat();
    host.ask(&write(1, 108, &bytes));
    host.drive(1, 3000);
    host.wait(400);
    let behind = host.register(1, "Position Trajectory") - host.register(1, "Present Position");
    assert!((1..=60).contains(&behind), "{behind}");
    assert!(
        (speed(&host) - 60.0 * 0.229 * TAU / 60.0).abs() < 0.1,
        "{}",
        speed(&host)
    );
}

#[test]
fn a_weight_makes_it_sag_heats_it_and_drops_without_torque() {
    let mut host = real(1);
    host.ask(&write(1, 64, &[1]));
    inject(&mut host, "servo 1 carries 0.3kg at 0.15m");
    host.wait(2000);
    let sunk = 2048 - host.register(1, "Present Position");
    assert!((3..=200).contains(&sunk), "{sunk}");
    let load = host.register(1, "Present Load");
    assert!((200..=700).contains(&load), "it pulls up: {load}");
    host.wait(60_000);
    assert!(host.register(1, "Present Temperature") > 25);
    host.ask(&write(1, 64, &[0]));
    host.wait(100);
    assert!(speed(&host) < -0.5, "it falls: {}", speed(&host));
    host.wait(10_000);
    assert!(
        (shaft(&host) + TAU / 4.0).abs() < 0.2,
        "and hangs: {}",
        shaft(&host)
    );
}

#[test]
fn a_hand_takes_it_along_without_torque_and_meets_the_stops() {
    for kind in [PlantKind::Ideal, PlantKind::Real] {
        let profiles = Profiles::builtin();
        let mut bus = ServoBus::new(BusOptions::default());
        let unit = Unit {
            return_delay_us: Some(0),
            plant: kind,
            stops_rad: Some([-1.0, 1.2]),
            ..Unit::new(1)
        };
        bus.add(profiles.servo("xl430-w250").expect("shipped"), unit)
            .expect("fits");
        let mut host = Host::new(bus);
        let to = |to_rad| {
            Some(Hand::Guide {
                to_rad,
                over_secs: 0.5,
            })
        };
        assert!(host.bus.hand(0, 1, to(0.6)));
        assert!(!host.bus.hand(0, 9, None), "there is no such servo");
        host.wait(250);
        assert!(
            (0.2..0.4).contains(&shaft(&host)),
            "{kind:?}: half way {}",
            shaft(&host)
        );
        host.wait(1000);
        assert!((shaft(&host) - 0.6).abs() < 0.02, "{kind:?}: {}", shaft(&host));
        assert!((host.register(1, "Present Position") as f64 - 2048.0 - 0.6 / RAD).abs() < 15.0);
        host.bus.hand(host.now_us, 1, to(3.0));
        host.wait(1000);
        assert!(
            (shaft(&host) - 1.2).abs() < 1e-9,
            "{kind:?}: an end stop, {}",
            shaft(&host)
        );
        host.bus.hand(host.now_us, 1, to(-3.0));
        host.wait(1000);
        assert!(
            (shaft(&host) + 1.0).abs() < 1e-9,
            "{kind:?}: the other, {}",
            shaft(&host)
        );
        host.bus.hand(host.now_us, 1, None);
        host.wait(1000);
        assert!(
            (shaft(&host) + 1.0).abs() < 0.01,
            "{kind:?}: let go, it stays: {}",
            shaft(&host)
        );
        host.bus.hand(host.now_us, 1, Some(Hand::Pull { nm: 0.2 }));
        host.wait(200);
        assert!(speed(&host) > 0.1, "{kind:?}: pulled, it turns: {}", speed(&host));
    }
}

#[test]
fn torque_holds_against_a_hand_as_far_as_it_goes() {
    let mut host = real(1);
    host.ask(&write(1, 64, &[1]));
    host.bus.hand(host.now_us, 1, Some(Hand::Pull { nm: 0.4 }));
    host.wait(1000);
    assert!((0.005..0.3).contains(&shaft(&host)), "{}", shaft(&host));
    assert!(host.register(1, "Present Load") < -200, "it pulls back");
    host.bus.hand(host.now_us, 1, None);
    host.wait(1000);
    assert!(shaft(&host).abs() < 0.01, "{}", shaft(&host));
}

#[test]
fn play_shows_at_the_horn_and_a_dry_gear_stays_where_it_is() {
    let mut host = real(1);
    inject(&mut host, "servo 1 backlash 2deg");
    host.ask(&write(1, 64, &[1]));
    // A load takes the horn to one side of the play, the other way to the other.
    let mut ends = Vec::new();
    for nm in [0.1, -0.1] {
        inject(&mut host, &format!("servo 1 load {nm}Nm for 1s"));
        host.ask(&write(1, 64, &[0]));
        host.bus.push(host.now_us, 1, -shaft(&host));
        host.ask(&write(1, 64, &[1]));
        host.wait(900);
        ends.push(shaft(&host));
        host.wait(300);
    }
    let play = (ends[1] - ends[0]).to_degrees();
    assert!(play > 1.0, "{play}");
}

#[test]
fn a_jammed_motor_overloads_heats_and_lets_go() {
    let mut host = real(1);
    inject(&mut host, "servo 1 stuck");
    host.drive(1, 3500);
    host.wait(500);
    let motor = host.bus.servo(1).expect("there").motor();
    let amperes = host.bus.servo(1).expect("there").supply_amperes();
    assert!(
        (0.7..1.1).contains(&(amperes / motor.stall_a)),
        "stall current at its supply: {amperes}"
    );
    assert_eq!(host.register(1, "Present PWM"), 885);
    let winding = host.bus.servo(1).expect("there").winding_c();
    assert!(winding > 25.5, "{winding}");
    host.wait(1500);
    assert_eq!(host.register(1, "Hardware Error Status"), 1 << 5);
    assert!(!host.bus.servo(1).expect("there").torque_is_on());
    // What was stored in the winding goes on into the housing.
    let housing = host.bus.servo(1).expect("there").temperature_c();
    host.wait(10_000);
    assert!(host.bus.servo(1).expect("there").temperature_c() > housing);
}

#[test]
fn current_mode_is_a_torque() {
    let profiles = Profiles::builtin();
    let mut bus = ServoBus::new(BusOptions::default());
    let unit = Unit {
        return_delay_us: Some(0),
        plant: PlantKind::Real,
        ..Unit::new(1)
    };
    bus.add(profiles.servo("xl330-m288").expect("shipped"), unit)
        .expect("fits");
    let mut host = Host::new(bus);
    assert_eq!(host.error_of(&write(1, 11, &[0])), Some(0));
    host.ask(&write(1, 64, &[1]));
    host.ask(&write(1, 102, &300i16.to_le_bytes()));
    host.wait(100);
    let early = speed(&host);
    assert!(early > 0.1);
    inject(&mut host, "servo 1 stuck");
    host.wait(100);
    let bytes = host.ask(&read(1, 126, 2));
    let milliamperes = i16::from_le_bytes([bytes[9], bytes[10]]);
    assert!(
        (297..=303).contains(&milliamperes),
        "what was asked for: {milliamperes}"
    );
}

#[test]
fn the_same_story_comes_out_the_same_however_it_is_asked_for() {
    let play = |cut: u64| {
        let mut host = real(3);
        for text in [
            "cable 0.5ohm",
            "servo 2 jitter 2",
            "servo 3 backlash 1deg",
            "servo 1 carries 0.1kg at 0.1m",
        ] {
            inject(&mut host, text);
        }
        host.bus.receive(0, &packet(254, 3, &[64, 0, 1]));
        host.bus.receive(0, &packet(254, 3, &[116, 0, 0, 12, 0, 0]));
        let mut out = Vec::new();
        let mut at = 0;
        while at < 900_000 {
            at += cut;
            host.bus.transmit(at.min(900_000), &mut out);
        }
        let servos = host.bus.servos().iter();
        servos
            .map(|servo| servo.true_position_rad().to_bits())
            .collect::<Vec<_>>()
    };
    assert_eq!(play(900_000), play(777));
}

#[test]
fn every_model_gets_there_and_stands() {
    let profiles = Profiles::builtin();
    let mut told = String::new();
    for profile in profiles.servos() {
        let mut bus = ServoBus::new(BusOptions {
            baud: profile.bauds[0],
            ..BusOptions::default()
        });
        let unit = Unit {
            plant: PlantKind::Real,
            ..Unit::new(1)
        };
        bus.add(profile, unit).expect("fits");
        bus.set_line_baud(0, profile.bauds[0]);
        let [low, high] = profile.position_counts;
        let from = i64::from(profile.centre_counts);
        let to = from + (high - low) / 5;
        let servo = bus.servo_mut(1).expect("there");
        servo.torque_on(0);
        servo.table.set(Reg::GoalPosition, to);
        servo.pursue(0);
        bus.transmit(3_000_000, &mut Vec::new());
        let servo = bus.servo(1).expect("there");
        let off = servo.present_counts() - to;
        let speed = servo.true_velocity_rad_per_s();
        let top = servo.counters().speed_max_rad_per_s / servo.motor().no_load_rad_per_s;
        told = format!(
            "{told}{}: off {off}, speed {speed:.4}, top {top:.2}\n",
            profile.key
        );
        // Friction leaves a little; without a punch nothing makes up for it.
        let allowed = (profile.counts_per_turn / 120.0) as i64;
        assert!(off.abs() <= allowed && speed.abs() < 0.01, "{told}");
        assert!((0.15..1.3).contains(&top), "{told}");
    }
}

#[test]
fn every_model_runs_and_stalls_as_printed() {
    for profile in Profiles::builtin().servos() {
        let Some(printed) = &profile.motor else { continue };
        let mut bus = ServoBus::new(BusOptions {
            baud: profile.bauds[0],
            ..BusOptions::default()
        });
        let unit = Unit {
            plant: PlantKind::Real,
            ..Unit::new(1)
        };
        bus.add(profile, unit).expect("fits");
        let run = |needed_nm: f64| {
            let mut servo = bus.servos()[0].clone();
            servo.plant.load.pull_nm = needed_nm;
            for _ in 0..2000 {
                let full = Order::Duty {
                    counts: 0.0,
                    share: 1.0,
                };
                servo.plant.drive(full, printed.rated_voltage_v);
            }
            servo.true_velocity_rad_per_s()
        };
        let share = run(0.0) / printed.no_load_speed_rad_per_s;
        assert!(
            (share - 1.0).abs() < 0.01,
            "{}: {share} of its speed",
            profile.key
        );
        let stall_nm = printed.stall_torque_nm;
        assert!(run(0.95 * stall_nm) > 0.0, "{} lifts 95 % of it", profile.key);
        assert!(run(1.05 * stall_nm) <= 0.0, "{} does not lift 105 %", profile.key);
    }
}

#[test]
fn what_all_draw_together_resets_the_last_of_the_chain() {
    let mut host = real(6);
    host.ask(&packet(254, 3, &[64, 0, 1]));
    inject(&mut host, "cable 0.5ohm");
    inject(&mut host, "every servo stuck for 100ms");
    host.ask(&packet(254, 3, &[&[116, 0][..], &3500i32.to_le_bytes()].concat()));
    let last = host.bus.servo(6).expect("there");
    assert!(
        last.counters().reboots > 0,
        "{:.1} V at the end",
        last.supply_volts()
    );
    assert_eq!(host.ask(&packet(6, 1, &[])), [], "it starts over");
    host.wait(500);
    assert_eq!(
        host.register(6, "Torque Enable"),
        0,
        "and has forgotten its torque"
    );
    let first = host.bus.servo(1).expect("there");
    assert_eq!(first.counters().reboots, 0);
    assert!(first.torque_is_on(), "the first of the chain has enough");
}
