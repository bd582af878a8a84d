//! Whatever a puppet is asked to do, in whatever order and with whatever going wrong: no simulated servo turns
//! faster than its limit, none is led away from where it stands, and torque is off in the end.
//!
//! Sequences are made from a seed that is printed with a failure: `DIALRIG_SEED=n DIALRIG_CASES=m` runs others.

use crate::rehearsal::{Rehearsal, clip, play};
use player::Order;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use std::sync::Arc;

/// Joints of the rehearsed puppet.
const JOINTS: usize = 5;
/// Cases in an ordinary run; a night takes more.
const CASES: u32 = 48;

fn setting(name: &str, usual: u64) -> u64 {
    std::env::var(name)
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(usual)
}

/// Runs `test` on sequences made from the seed.
fn run<S: Strategy>(strategy: &S, cases: u32, test: impl Fn(S::Value) -> Result<(), TestCaseError>)
where
    S::Value: std::fmt::Debug,
{
    let seed = setting("DIALRIG_SEED", 1);
    let cases = setting("DIALRIG_CASES", u64::from(cases)) as u32;
    let config = Config {
        cases,
        failure_persistence: None,
        max_shrink_iters: 400,
        ..Config::default()
    };
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &bytes));
    if let Err(failure) = runner.run(strategy, test) {
        panic!("DIALRIG_SEED={seed} DIALRIG_CASES={cases}: {failure}");
    }
}

/// Something that happens to a puppet.
#[derive(Clone, Debug)]
enum Doing {
    Arm,
    Play {
        clip: usize,
        from_secs: f64,
        speed: f64,
        looped: bool,
    },
    Seek(f64),
    Follow(Vec<f64>),
    Hold,
    Release,
    Stop,
    Reset,
    Alive,
    Stall(f64),
    Plug(usize, bool),
    Fault(usize, String),
    Push(usize, f64),
}

/// An angle as anybody might ask for it: most inside the ranges, some far outside, some no numbers at all.
fn angle() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => -1.5..1.5_f64,
        3 => -9.0..9.0_f64,
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(1e300), Just(-0.0)],
    ]
}

/// What may go wrong. Not a jammed horn that comes free: it leaps to where it should be as fast as the motor can,
/// and nobody on the wire can help that.
fn fault() -> impl Strategy<Value = String> {
    let servo = 1..4_u8;
    prop_oneof![
        Just("drop 20% for 400ms".to_owned()),
        Just("noise 2% for 300ms".to_owned()),
        (1..60_u32).prop_map(|ms| format!("late {ms}ms once")),
        (servo.clone(), 1..900_u32).prop_map(|(id, ms)| format!("servo {id} silent for {ms}ms")),
        (1..600_u32).prop_map(|ms| format!("stall for {ms}ms")),
        (1..400_u32).prop_map(|ms| format!("echo for {ms}ms")),
        (0..3_u8, 1..600_u32).prop_map(|(after, ms)| format!("cable cut after {after} for {ms}ms")),
        servo.prop_map(|id| format!("servo {id} reboot")),
        Just("brownout for 200ms".to_owned()),
    ]
}

fn doing() -> impl Strategy<Value = Doing> {
    let secs = prop_oneof![8 => -1.0..4.0_f64, 1 => Just(f64::NAN), 1 => Just(1e18)];
    let speed = prop_oneof![8 => 0.1..10.0_f64, 1 => Just(f64::NAN), 1 => -1.0..20.0_f64];
    prop_oneof![
        5 => Just(Doing::Arm),
        6 => (0..3_usize, secs.clone(), speed, any::<bool>())
            .prop_map(|(clip, from_secs, speed, looped)| Doing::Play { clip, from_secs, speed, looped }),
        2 => secs.prop_map(Doing::Seek),
        4 => prop::collection::vec(angle(), JOINTS).prop_map(Doing::Follow),
        1 => Just(Doing::Hold),
        1 => Just(Doing::Release),
        1 => Just(Doing::Stop),
        3 => Just(Doing::Reset),
        1 => Just(Doing::Alive),
        2 => (0.001..0.6_f64).prop_map(Doing::Stall),
        1 => (0..2_usize, any::<bool>()).prop_map(|(bus, connected)| Doing::Plug(bus, connected)),
        2 => (0..2_usize, fault()).prop_map(|(bus, text)| Doing::Fault(bus, text)),
        1 => (0..2_usize, -0.4..0.4_f64).prop_map(|(bus, rad)| Doing::Push(bus, rad)),
    ]
}

/// Doings, each with the ticks until the next. Every sequence begins armed, or hardly any would come to play.
fn sequence() -> impl Strategy<Value = Vec<(Doing, u32)>> {
    prop::collection::vec((doing(), 0..60_u32), 1..24).prop_map(|mut doings| {
        doings.insert(0, (Doing::Arm, 50));
        doings
    })
}

/// Clips that ask for too much: rows anywhere, far apart, soon after each other.
fn clips() -> impl Strategy<Value = Vec<(f64, Vec<Vec<f64>>)>> {
    let rows = (1..=JOINTS)
        .prop_flat_map(|joints| prop::collection::vec(prop::collection::vec(-4.0..4.0_f64, joints), 2..8));
    prop::collection::vec((0.02..0.8_f64, rows), 3)
}

fn perform(rehearsal: &mut Rehearsal, clips: &[Arc<motion::JointClip>], doing: &Doing) {
    let order = match doing.clone() {
        Doing::Arm => Order::Arm,
        Doing::Play {
            clip,
            from_secs,
            speed,
            looped,
        } => Order::Play {
            clip: Arc::clone(&clips[clip]),
            from_secs,
            speed,
            looped,
        },
        Doing::Seek(secs) => Order::Seek(secs),
        Doing::Follow(pose) => Order::Follow(pose.into()),
        Doing::Hold => Order::Hold,
        Doing::Release => Order::Release,
        Doing::Stop => Order::Stop,
        Doing::Reset => Order::Reset,
        Doing::Alive => Order::Alive,
        Doing::Stall(secs) => return rehearsal.stall(secs),
        Doing::Plug(bus, connected) => return rehearsal.plug(bus, connected),
        Doing::Fault(bus, text) => return rehearsal.inject(bus, &text),
        Doing::Push(bus, rad) => return rehearsal.push(bus, rad),
    };
    rehearsal.tick([order]);
}

fn nothing_wrong(rehearsal: &Rehearsal) -> Result<(), TestCaseError> {
    let wrong = rehearsal.wrong();
    prop_assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    Ok(())
}

#[test]
fn no_sequence_moves_a_servo_faster_or_further_than_it_may() {
    let strategy = (sequence(), clips(), -0.4..0.4_f64, any::<u64>());
    run(&strategy, CASES, |(doings, clips, start_rad, seed)| {
        let mut rehearsal = Rehearsal::new(start_rad, seed);
        let clips: Vec<_> = clips.iter().map(|(period, rows)| clip(*period, rows)).collect();
        for (doing, ticks) in &doings {
            perform(&mut rehearsal, &clips, doing);
            for _ in 0..*ticks {
                rehearsal.tick([]);
            }
        }
        nothing_wrong(&rehearsal)?;
        let on = rehearsal.close();
        prop_assert!(on.is_empty(), "torque is still on after closing: {on:?}");
        nothing_wrong(&rehearsal)
    });
}

#[test]
fn sequences_without_faults_keep_to_the_ranges_and_their_orders() {
    let calm = sequence().prop_map(|doings| {
        let disturbs = |doing: &Doing| {
            matches!(
                doing,
                Doing::Plug(..) | Doing::Fault(..) | Doing::Push(..) | Doing::Stall(..)
            )
        };
        let kept = doings.into_iter().filter(|(doing, _)| !disturbs(doing));
        kept.collect::<Vec<_>>()
    });
    run(&(calm, clips()), CASES / 2, |(doings, clips)| {
        let mut rehearsal = Rehearsal::new(0.0, 0);
        let clips: Vec<_> = clips.iter().map(|(period, rows)| clip(*period, rows)).collect();
        for (doing, ticks) in &doings {
            perform(&mut rehearsal, &clips, doing);
            for _ in 0..*ticks {
                let report = rehearsal.tick([]);
                let (torque, at) = (report.torque, report.at);
                if !torque {
                    let on = rehearsal.with_torque();
                    prop_assert!(on.is_empty(), "{at:?}: said to be off, but on: {on:?}");
                }
            }
            if matches!(doing, Doing::Stop | Doing::Release) {
                rehearsal.run(3.0);
                let on = rehearsal.with_torque();
                prop_assert!(on.is_empty(), "torque is still on after {doing:?}: {on:?}");
            }
        }
        let outside = rehearsal.outside_range();
        prop_assert!(outside.is_empty(), "{outside:?}");
        let on = rehearsal.close();
        prop_assert!(on.is_empty(), "torque is still on after closing: {on:?}");
        nothing_wrong(&rehearsal)
    });
}

#[test]
fn goals_that_are_no_numbers_never_move_a_joint() {
    let mut rehearsal = Rehearsal::new(0.3, 0);
    rehearsal.tick([Order::Arm]);
    assert!(rehearsal.run_until("holding", 2.0));
    for pose in [
        [f64::NAN; JOINTS],
        [f64::INFINITY; JOINTS],
        [f64::NEG_INFINITY; JOINTS],
    ] {
        rehearsal.tick([Order::Follow(Arc::from(pose))]);
        rehearsal.run(2.0);
        for joint in &rehearsal.player.report().joints {
            let goal = joint.goal_rad.expect("it is armed");
            assert!((goal - 0.3).abs() < 0.002, "{goal}");
        }
    }
    assert!(rehearsal.player.report().interventions.not_finite > 0);
    assert!(rehearsal.goals_sent() > 0);
    assert_eq!(rehearsal.close(), [""; 0]);
    assert_eq!(rehearsal.wrong(), [""; 0]);
}

#[test]
fn sagging_joints_are_pinned_where_they_are_met() {
    let mut rehearsal = Rehearsal::new(0.3, 0);
    for hung in &rehearsal.buses {
        hung.sag(0.5);
    }
    rehearsal.run(0.2);
    rehearsal.tick([Order::Arm]);
    assert!(rehearsal.run_until("holding", 3.0));
    let far = clip(1.0, &[vec![0.0; JOINTS], vec![0.5; JOINTS]]);
    rehearsal.tick([play(&far)]);
    assert!(rehearsal.run_until("holding", 10.0));
    assert_eq!(rehearsal.close(), [""; 0]);
    assert_eq!(rehearsal.wrong(), [""; 0]);
}
