//! The limits hold for every goal, whatever is wished; and a wish that keeps them is followed.

use super::*;
use proptest::prelude::*;

const STEP: f64 = 0.02;

fn limits() -> Limits {
    Limits::new([-2.0, 2.0], 3.0, 12.0).unwrap()
}

/// Runs wishes through a limiter and checks every goal it gives.
struct Judge {
    limiter: Limiter,
    limits: Limits,
    position: f64,
    velocity: f64,
}

impl Judge {
    fn at(limits: Limits, start: f64) -> Self {
        let limiter = Limiter::at_rest(limits, start).unwrap();
        Self {
            limiter,
            limits,
            position: start,
            velocity: 0.0,
        }
    }

    fn step(&mut self, target: f64, dt: f64) -> Limited {
        let limited = self.limiter.step(target, dt);
        self.check(limited, dt);
        limited
    }

    fn check(&mut self, limited: Limited, dt: f64) {
        let Limits {
            min_rad,
            max_rad,
            velocity_max_rad_per_s,
            acceleration_max_rad_per_s2,
            jerk_max_rad_per_s3: _,
        } = self.limits;
        let velocity = (limited.position_rad - self.position) / dt;
        let acceleration = (velocity - self.velocity) / dt;
        assert!(
            velocity.abs() <= velocity_max_rad_per_s,
            "velocity {velocity} {limited:?}"
        );
        assert!(
            acceleration.abs() <= acceleration_max_rad_per_s2,
            "acceleration {acceleration} {limited:?}"
        );
        let outside = |rad: f64| (min_rad - rad).max(rad - max_rad).max(0.0);
        assert!(
            outside(limited.position_rad) <= outside(self.position),
            "leaves its range: {limited:?}"
        );
        self.position = limited.position_rad;
        self.velocity = velocity;
    }
}

#[test]
fn nonsense_is_no_limit_and_no_start() {
    for (range, velocity, acceleration, text) in [
        ([1.0, -1.0], 1.0, 1.0, "range 1 to -1"),
        ([f64::NAN, 1.0], 1.0, 1.0, "range NaN"),
        ([0.0, f64::INFINITY], 1.0, 1.0, "range 0 to inf"),
        ([0.0, 1.0], 0.0, 1.0, "speed limit 0"),
        ([0.0, 1.0], 1.0, -1.0, "acceleration limit -1"),
        ([0.0, 1.0], 1.0, f64::NAN, "acceleration limit NaN"),
    ] {
        let error = Limits::new(range, velocity, acceleration).unwrap_err();
        assert!(error.to_string().contains(text), "{error}");
    }
    assert!(Limiter::at_rest(limits(), f64::NAN).is_err());
}

#[test]
fn a_jump_is_reached_without_overshoot_and_in_good_time() {
    for (start, target) in [
        (0.0, 1.5),
        (-2.0, 2.0),
        (2.0, -2.0),
        (0.3, 0.31),
        (1.9, 5.0),
        (-1.0, -1.0),
    ] {
        let mut judge = Judge::at(limits(), start);
        let end = f64::clamp(target, -2.0, 2.0);
        let way = (end - start).abs();
        // Trapezoid of speed: full speed for the way, plus one time to full speed; ten steps for sampling.
        let time = way / 3.0 + 3.0 / 12.0 + 10.0 * STEP;
        for _ in 0..(time / STEP) as usize {
            judge.step(target, STEP);
            assert!(
                (judge.position - start) * (end - start).signum() <= way + 1e-12,
                "overshoot"
            );
        }
        assert!(
            (judge.position - end).abs() < 1e-9,
            "{start} to {target}: {}",
            judge.position
        );
        assert!(judge.velocity.abs() < 1e-6);
    }
}

#[test]
fn a_wish_within_limits_is_followed_exactly_once_caught_up_with() {
    let ramp = |t: f64| -1.0 + 0.9 * t;
    let wave = |t: f64| 1.2 * (1.7 * t).sin();
    let sway = |t: f64| 0.5 * (4.0 * t).sin() - 0.2 * (2.0 * t).cos();
    for (what, wish) in [
        ("ramp", &ramp as &dyn Fn(f64) -> f64),
        ("wave", &wave),
        ("sway", &sway),
    ] {
        let mut judge = Judge::at(limits(), 0.4);
        for tick in 1..150 {
            let t = f64::from(tick) * STEP;
            let limited = judge.step(wish(t), STEP);
            if t > 1.6 {
                assert!(
                    (limited.position_rad - wish(t)).abs() < 1e-9,
                    "{what} lags at {t}: {limited:?}"
                );
                assert_eq!(limited.change, None, "{what} at {t}");
            }
        }
    }
}

#[test]
fn a_ramp_is_caught_up_with_from_behind_without_overshoot() {
    let mut judge = Judge::at(limits(), -1.5);
    for tick in 1..200 {
        let target = -0.5 + 0.01 * f64::from(tick);
        judge.step(target, STEP);
        assert!(judge.position <= target + 1e-9, "overshoot at {tick}");
    }
    assert!((judge.position - 1.49).abs() < 1e-9);
}

#[test]
fn what_is_no_number_brakes_and_is_said() {
    let mut judge = Judge::at(limits(), 0.0);
    for _ in 0..20 {
        judge.step(2.0, STEP);
    }
    assert!(judge.velocity > 2.0);
    for target in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY]
        .into_iter()
        .cycle()
        .take(40)
    {
        assert_eq!(judge.step(target, STEP).change, Some(Change::NotFinite));
    }
    assert!(judge.limiter.is_still());
    assert_eq!(judge.velocity, 0.0);
}

#[test]
fn a_start_outside_the_range_only_moves_inwards() {
    for start in [2.7, -3.0] {
        for target in [5.0, -5.0, start, 0.0, f64::NAN] {
            let mut judge = Judge::at(limits(), start);
            for _ in 0..200 {
                judge.step(target, STEP);
            }
            if target.is_finite() {
                assert!(
                    (judge.position - target.clamp(-2.0, 2.0)).abs() < 1e-9,
                    "{start} {target}"
                );
            } else {
                assert_eq!(judge.position, start);
            }
        }
    }
}

#[test]
fn a_stall_of_the_host_brakes_instead_of_lunging() {
    for stall in [0.15, 0.3, 1.0, 3600.0] {
        let mut judge = Judge::at(limits(), -2.0);
        for _ in 0..30 {
            judge.step(2.0, STEP);
        }
        let before = judge.position;
        let limited = judge.step(2.0, stall);
        assert_eq!(limited.change, Some(Change::Stalled));
        // The most that full braking can cover in one step: v²/4a.
        assert!(
            judge.position - before <= 9.0 / 48.0,
            "lunge of {}",
            judge.position - before
        );
        for _ in 0..120 {
            judge.step(2.0, STEP);
        }
        assert!((judge.position - 2.0).abs() < 1e-9);
    }
}

#[test]
fn no_time_means_no_motion() {
    let mut limiter = Limiter::at_rest(limits(), 0.5).unwrap();
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(limiter.step(2.0, dt).position_rad, 0.5);
        assert_eq!(limiter.brake(dt).position_rad, 0.5);
    }
}

#[test]
fn changes_are_named() {
    let first = |target: f64, ticks: usize| {
        let mut limiter = Limiter::at_rest(limits(), 0.0).unwrap();
        for _ in 0..ticks {
            limiter.step(1.9, STEP);
        }
        limiter.step(target, STEP).change
    };
    assert_eq!(first(0.0, 0), None);
    assert_eq!(first(0.01, 0), Some(Change::Acceleration));
    assert_eq!(first(1.0, 0), Some(Change::Velocity));
    assert_eq!(first(2.5, 0), Some(Change::Position { by_rad: 0.5 }));
    assert_eq!(first(f64::NAN, 0), Some(Change::NotFinite));
}

#[derive(Debug, Clone)]
enum Wish {
    To(f64),
    Nonsense(f64),
    Brake,
    Ramp(f64),
}

fn wish() -> impl Strategy<Value = Wish> {
    prop_oneof![
        4 => (-4.0..4.0).prop_map(Wish::To),
        2 => prop_oneof![Just(-2.0), Just(2.0), Just(0.0)].prop_map(Wish::To),
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(f64::MAX)]
            .prop_map(Wish::Nonsense),
        1 => Just(Wish::Brake),
        2 => (-6.0..6.0).prop_map(Wish::Ramp),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    /// Every goal keeps speed, acceleration and range, for any wishes, limits, starts and irregular ticks.
    #[test]
    fn limits_hold_whatever_is_wished(
        start in -2.5..2.5,
        velocity in 0.05..12.0,
        acceleration in 0.1..200.0,
        wishes in proptest::collection::vec((wish(), 1_usize..40, 0.0005..0.05), 1..30),
        stalls in proptest::collection::vec((0_usize..600, 0.05..2.0), 0..4),
    ) {
        let limits = Limits::new([-2.0, 2.0], velocity, acceleration).unwrap();
        let mut judge = Judge::at(limits, start);
        let mut tick = 0;
        for (wish, ticks, dt) in wishes {
            let mut target = judge.position;
            for _ in 0..ticks {
                tick += 1;
                let jitter = 1.0 + 0.3 * f64::from(tick % 5) - 0.6;
                let stall = stalls.iter().find(|(at, _)| *at == tick as usize);
                let dt = stall.map_or(dt * jitter, |(_, stall)| *stall);
                match wish {
                    Wish::To(to) | Wish::Nonsense(to) => { judge.step(to, dt); }
                    Wish::Brake => {
                        let limited = judge.limiter.brake(dt);
                        judge.check(limited, dt);
                    }
                    Wish::Ramp(speed) => {
                        target += speed * dt;
                        judge.step(target, dt);
                    }
                }
            }
        }
    }

    /// However it is moving, it comes to the wish and stays there.
    #[test]
    fn every_constant_wish_is_reached(
        wishes in proptest::collection::vec(-2.0..2.0, 1..6),
        velocity in 0.2..8.0,
        acceleration in 1.0..80.0,
        dt in 0.002..0.03,
    ) {
        let limits = Limits::new([-2.0, 2.0], velocity, acceleration).unwrap();
        let mut judge = Judge::at(limits, 0.0);
        let last = wishes[wishes.len() - 1];
        for target in &wishes {
            for _ in 0..7 {
                judge.step(*target, dt);
            }
        }
        // Stop, turn round, cross the range.
        let time = 2.0 * velocity / acceleration + 4.0 / velocity + velocity / acceleration + 20.0 * dt;
        for _ in 0..(time / dt) as usize {
            judge.step(last, dt);
        }
        prop_assert!((judge.position - last).abs() < 1e-6, "{} not {}", judge.position, last);
        let limited = judge.step(last, dt);
        prop_assert!(limited.velocity_rad_per_s.abs() < 1e-4);
    }
}
