//! Each trouble under each policy, and what is left of the puppet after it.

use super::*;
use crate::trouble::Trouble;

const VOLTAGE: usize = 144;
const CURRENT: usize = 126;
const ALL: [Reaction; 3] = [Reaction::BackOff, Reaction::Hold, Reaction::Release];

/// A policy that says the same to everything.
fn policy(reaction: Reaction) -> Policy {
    Policy {
        on_heat: reaction,
        on_overload: reaction,
        on_brownout: reaction,
        on_lost_host: reaction,
        ..Policy::default()
    }
}

impl Bench {
    /// Playing for a while under a policy, then this happens to servo 1 of the upper bus, neck_yaw.
    fn spoiled(reaction: Reaction, spoil: fn(&mut Bench)) -> Self {
        let mut bench = Self::with_policy(PlayerConfig::default(), policy(reaction));
        bench.tick(vec![Order::Arm]);
        bench.until("holding");
        bench.tick(vec![Bench::play(-1.0, 1.0, true)]);
        while bench.tick(vec![]).phase != Phase::Running {}
        spoil(&mut bench);
        bench
    }

    fn run(&mut self, secs: f64) {
        for _ in 0..(secs / PERIOD.as_secs_f64()) as usize {
            self.tick(vec![]);
        }
    }
}

fn hot(bench: &mut Bench) {
    bench.far[0].desk().set(1, TEMPERATURE, &[63]);
}

fn loaded(bench: &mut Bench) {
    bench.far[0].desk().set(1, CURRENT, &1500_u16.to_le_bytes());
}

fn held(bench: &mut Bench) {
    bench.far[0].desk().stuck.insert(1);
}

fn sagging(bench: &mut Bench) {
    bench.far[0].desk().set(1, VOLTAGE, &35_u16.to_le_bytes());
}

#[test]
fn trouble_is_answered_as_the_policy_says() {
    type Case = (fn(&mut Bench), Trouble, &'static str);
    let cases: [Case; 4] = [
        (hot, Trouble::Heat, "hot"),
        (loaded, Trouble::Overload, "overloaded"),
        (held, Trouble::Overload, "strained"),
        (sagging, Trouble::BrownOut, "brown-out"),
    ];
    for (spoil, trouble, name) in cases {
        for reaction in ALL {
            let what = format!("{name}, {reaction:?}");
            let mut bench = Bench::spoiled(reaction, spoil);
            if reaction == Reaction::BackOff {
                let mut waited = 0;
                while bench.tick(vec![]).backing_off != Some((trouble, 0)) {
                    waited += 1;
                    assert!(waited < 250, "{what}: {:?}", bench.player.report());
                }
                bench.run(0.8);
                let report = bench.player.report();
                assert_eq!(report.state, State::Playing, "{what}");
                assert!(report.pace < 0.65, "{what}: {}", report.pace);
                continue;
            }
            bench.run(4.0);
            let report = bench.player.report().clone();
            let State::Faulted(fault) = &report.state else {
                panic!("{what}: {:?}", report.state)
            };
            assert_eq!(fault.name(), name, "{what}");
            assert!(
                fault
                    .to_string()
                    .contains("\"neck_yaw\" (bus \"upper\", servo 1)"),
                "{fault}"
            );
            assert_eq!(bench.torque(), reaction == Reaction::Hold, "{what}");
            assert!(bench.player.lines.all_still(), "{what}");
            bench.run(2.0);
            assert!(
                matches!(bench.player.state(), State::Faulted(_)),
                "latched: {what}"
            );
            bench.tick(vec![Order::Reset]);
            bench.until("released");
            assert!(!bench.torque(), "{what}");
        }
    }
}

#[test]
fn a_goal_retreats_from_what_holds_the_joint_and_returns() {
    let mut bench = Bench::spoiled(Reaction::BackOff, held);
    let yaw = bench.player.puppet().joint("neck_yaw").unwrap();
    let distance = |report: &Report| {
        let joint = &report.joints[yaw];
        (joint.goal_rad.unwrap() - joint.measured_rad.unwrap()).abs()
    };
    let mut farthest = 0.0_f64;
    while bench.player.report().backing_off.is_none() {
        let report = bench.tick(vec![]);
        farthest = farthest.max(distance(&report));
    }
    assert!(farthest > 0.6, "{farthest}");
    let mut nearest = f64::INFINITY;
    for _ in 0..100 {
        let report = bench.tick(vec![]);
        nearest = nearest.min(distance(&report));
    }
    assert!(nearest < 0.01, "{nearest}");
    bench.far[0].desk().stuck.clear();
    bench.run(6.0);
    let report = bench.player.report();
    assert_eq!((report.backing_off, report.pace), (None, 1.0));
    assert_eq!(report.joints[yaw].retreat, 0.0);
    assert_eq!(*bench.player.state(), State::Playing);
}

#[test]
fn backing_off_that_does_not_help_ends_in_a_stand_where_the_joint_is() {
    let mut bench = Bench::spoiled(Reaction::BackOff, held);
    let mut ticks = 0;
    while !matches!(bench.player.state(), State::Faulted(_)) {
        bench.tick(vec![]);
        ticks += 1;
        assert!(ticks < 1500, "it never gives up");
    }
    bench.run(4.0);
    assert!(bench.torque(), "a hold");
    let joint = bench.player.report().joints[0];
    let apart = joint.goal_rad.unwrap() - joint.measured_rad.unwrap();
    assert!(apart.abs() < 0.05, "it goes on pushing: {apart}");
}

#[test]
fn a_servo_that_gets_hotter_while_it_does_less_is_let_go() {
    let mut bench = Bench::spoiled(Reaction::BackOff, hot);
    bench.run(3.0);
    assert_eq!(*bench.player.state(), State::Playing);
    bench.far[0].desk().set(1, TEMPERATURE, &[69]);
    bench.until("faulted");
    bench.run(3.0);
    assert!(!bench.torque());
    // The same when it gets too hot only after a fault that ended in a hold.
    let mut bench = Bench::spoiled(Reaction::Hold, hot);
    bench.run(3.0);
    assert!(bench.torque());
    bench.far[0].desk().set(1, TEMPERATURE, &[69]);
    bench.run(3.0);
    assert!(!bench.torque());
}

#[test]
fn a_stop_lets_go_of_what_a_fault_holds() {
    let mut bench = Bench::spoiled(Reaction::Hold, sagging);
    bench.run(3.0);
    assert!(bench.torque());
    bench.tick(vec![Order::Stop]);
    bench.run(2.0);
    assert!(!bench.torque());
    assert_eq!(*bench.player.state(), State::Faulted(Fault::StopPressed));
}

#[test]
fn lines_that_are_left_do_as_the_policy_says_when_one_is_lost() {
    for reaction in ALL {
        let mut bench = Bench::spoiled(reaction, |bench| bench.far[0].desk().gone = true);
        bench.until("faulted");
        bench.run(3.0);
        let on = {
            let desk = bench.far[1].desk();
            desk.servos.keys().any(|id| desk.get(*id, TORQUE, 1) == 1)
        };
        assert_eq!(on, reaction != Reaction::Release, "{reaction:?}");
    }
}

#[test]
fn a_joint_that_stands_backs_off_too() {
    let mut bench = Bench::with_policy(PlayerConfig::default(), policy(Reaction::BackOff));
    bench.tick(vec![Order::Arm]);
    bench.until("holding");
    bench.far[0].desk().stuck.insert(1);
    bench.far[0].desk().set(1, POSITION, &2200_u32.to_le_bytes());
    loaded(&mut bench);
    bench.run(3.0);
    let joint = bench.player.report().joints[0];
    let apart = joint.goal_rad.unwrap() - joint.measured_rad.unwrap();
    assert!(apart.abs() < 0.002, "{apart}");
    assert_eq!(*bench.player.state(), State::Holding);
}
