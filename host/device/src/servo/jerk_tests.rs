//! The limit of jerk holds for every wish in steady ticks, costs no other limit, and what is wished is reached.

use super::super::limit::{Change, Limiter, Limits};
use proptest::prelude::*;

const STEP: f64 = 0.01;

fn limits() -> Limits {
    Limits::new([-2.0, 2.0], 3.0, 12.0)
        .and_then(|limits| limits.with_jerk(120.0))
        .expect("numbers in order")
}

/// The goals for some wishes, each held for some ticks, with the highest speed, acceleration and jerk seen.
fn goals(limiter: &mut Limiter, wishes: &[f64], ticks: usize, dt: f64) -> (Vec<f64>, [f64; 3]) {
    let mut goals = vec![limiter.position_rad()];
    let (mut speed, mut acceleration, mut highest) = (0.0, 0.0, [0.0_f64; 3]);
    for &wish in wishes {
        for _ in 0..ticks {
            let before = goals[goals.len() - 1];
            let goal = limiter.step(wish, dt).position_rad;
            let now = (goal - before) / dt;
            let gained = (now - speed) / dt;
            let jerk = (gained - acceleration) / dt;
            for (most, seen) in highest.iter_mut().zip([now, gained, jerk]) {
                *most = most.max(seen.abs());
            }
            (speed, acceleration) = (now, gained);
            goals.push(goal);
        }
    }
    (goals, highest)
}

#[test]
fn without_the_limit_the_jerk_is_many_times_as_high() {
    let plain = Limits::new([-2.0, 2.0], 3.0, 12.0).expect("numbers in order");
    let [rounded, cornered] = [limits(), plain].map(|limits| {
        let mut limiter = Limiter::at_rest(limits, 0.0).expect("a number");
        goals(&mut limiter, &[1.5, -1.5], 200, STEP).1[2]
    });
    assert!(rounded <= 120.0 * (1.0 + 1e-3), "{rounded}");
    assert!(cornered > 1100.0, "{cornered}");
}

#[test]
fn what_is_wished_is_reached_and_stood_at() {
    let mut limiter = Limiter::at_rest(limits(), 0.3).expect("a number");
    assert!(limiter.is_still());
    let (goals, _) = goals(&mut limiter, &[-1.0], 400, STEP);
    assert!((goals[goals.len() - 1] + 1.0).abs() < 1e-6);
    assert!(
        goals.windows(2).all(|pair| pair[1] <= pair[0] + 1e-12),
        "it never turns back"
    );
}

#[test]
fn braking_is_as_short_as_without_it() {
    let plain = Limits::new([-2.0, 2.0], 3.0, 12.0).expect("numbers in order");
    let [rounded, cornered] = [limits(), plain].map(|limits| {
        let mut limiter = Limiter::at_rest(limits, -2.0).expect("a number");
        let mut ticks = 0;
        while limiter.velocity_rad_per_s() < 2.0 {
            limiter.step(2.0, STEP);
        }
        let speed = limiter.velocity_rad_per_s();
        while limiter.velocity_rad_per_s() != 0.0 {
            limiter.brake(STEP);
            ticks += 1;
        }
        assert!(limiter.is_still(), "nothing is left that would move it");
        (ticks as f64 * STEP - speed / 12.0).abs()
    });
    // A whole number of ticks, and the headroom.
    let tick = 1.01 * STEP;
    assert!(rounded <= tick && cornered <= tick, "{rounded} {cornered}");
}

#[test]
fn a_wish_outside_is_told_as_one() {
    let mut limiter = Limiter::at_rest(limits(), 0.0).expect("a number");
    let change = limiter.step(5.0, STEP).change;
    assert_eq!(change, Some(Change::Position { by_rad: 3.0 }));
    assert_eq!(limiter.step(f64::NAN, STEP).change, Some(Change::NotFinite));
}

#[test]
fn too_low_a_limit_is_refused_with_the_least() {
    let limits = Limits::new([0.0, 1.0], 1.0, 12.0).expect("numbers in order");
    let error = limits.with_jerk(1.0).expect_err("24 s of rounding").to_string();
    assert!(error.contains("at least 12"), "{error}");
    assert!(limits.with_jerk(0.0).is_err() && limits.with_jerk(f64::NAN).is_err());
}

proptest! {
    /// Of ticks that come evenly; whatever is wished.
    #[test]
    fn jerk_speed_and_acceleration_are_kept(
        wishes in proptest::collection::vec(-3.0..3.0, 1..12),
        ticks in 1_usize..80,
        velocity in 0.3..8.0,
        acceleration in 2.0..80.0,
        rounding_secs in 0.01..1.5,
        dt in 0.001..0.02,
    ) {
        let jerk = 2.0 * acceleration / rounding_secs;
        let limits = Limits::new([-2.0, 2.0], velocity, acceleration).and_then(|limits| limits.with_jerk(jerk));
        let mut limiter = Limiter::at_rest(limits.expect("numbers in order"), 0.5).expect("a number");
        let (goals, highest) = goals(&mut limiter, &wishes, ticks, dt);
        prop_assert!(goals.iter().all(|goal| goal.abs() <= 2.0));
        prop_assert!(highest[0] <= velocity && highest[1] <= acceleration, "{highest:?}");
        // Third differences of positions of about 2 rad: 1e-15 of them by dt cubed.
        prop_assert!(highest[2] <= jerk * (1.0 + 1e-4) + 1e-14 / dt.powi(3), "{} over {jerk}", highest[2]);
    }

    /// Of ticks that come as they like: range, speed and acceleration hold as they do without.
    #[test]
    fn nothing_else_depends_on_it(
        wishes in proptest::collection::vec((-3.0..3.0, 1e-4..0.15), 1..400),
    ) {
        let mut limiter = Limiter::at_rest(limits(), 0.5).expect("a number");
        let (mut position, mut speed) = (0.5, 0.0);
        for (wish, dt) in wishes {
            let goal = limiter.step(wish, dt).position_rad;
            let now = (goal - position) / dt;
            prop_assert!(goal.abs() <= 2.0 && now.abs() <= 3.0);
            prop_assert!(((now - speed) / dt).abs() <= 12.0);
            (position, speed) = (goal, now);
        }
    }
}

/// What a puppet's profile says arrives at the limiter that its goals pass.
#[test]
fn the_profile_of_a_joint_brings_its_limit() {
    let all = device_profiles::Profiles::builtin();
    let mut joint = all
        .puppet("starter")
        .expect("it is built in")
        .joints()
        .next()
        .expect("one")
        .clone();
    let servo = all.servo(&joint.model).expect("it is built in");
    let limit = |joint: &device_profiles::PuppetJoint| {
        let member = super::super::Member::of_joint(joint, servo);
        member.map(|member| member.limits().jerk_max_rad_per_s3())
    };
    assert_eq!(limit(&joint).expect("as shipped"), None);
    joint.jerk_max_rad_per_s3 = Some(500.0);
    assert_eq!(limit(&joint).expect("enough"), Some(500.0));
    joint.jerk_max_rad_per_s3 = Some(0.5);
    assert!(limit(&joint).is_err());
}
