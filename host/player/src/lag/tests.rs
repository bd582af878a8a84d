use super::*;

/// What a joint is asked: never the same twice, both directions, and still for a while.
fn wave(secs: f64) -> f64 {
    let still = if secs > 6.0 { 6.0 } else { secs };
    0.6 * (1.7 * still).sin() + 0.3 * (4.1 * still + 1.0).sin()
}

/// Lets a joint follow `asked` with a delay, a sag, and the encoder's steps.
fn follow(
    asked: fn(f64) -> f64,
    delay_secs: f64,
    sag_rad: f64,
    period_secs: f64,
    until_secs: f64,
) -> Follower {
    let mut follower = Follower::default();
    let mut at_secs = 0.0;
    while at_secs < until_secs {
        // Measured some time after the last goal went out, as on a wire.
        let measured_secs = at_secs - 0.3 * period_secs;
        let count = std::f64::consts::TAU / 4096.0;
        let angle = ((asked(measured_secs - delay_secs) + sag_rad) / count).round() * count;
        follower.goal_sent(at_secs, asked(at_secs), [10.0, 100.0]);
        follower.clip_ahead(at_secs, asked(at_secs + AHEAD_SECS));
        follower.lead(false, period_secs);
        follower.measured(measured_secs, angle);
        at_secs += period_secs;
    }
    follower
}

#[test]
fn a_delay_is_found_whatever_the_rate_and_under_gravity() {
    for delay_secs in [0.0, 0.013, 0.045, 0.09, 0.205, 0.28] {
        for sag_rad in [0.0, -0.08] {
            for period_secs in [0.002, 0.01, 0.02] {
                let known = follow(wave, delay_secs, sag_rad, period_secs, 5.0).tracking();
                for found in [known.lag_secs, known.behind_clip_secs] {
                    let found = found.expect("it has moved enough");
                    assert!(
                        (found - delay_secs).abs() < 0.004,
                        "{delay_secs} s, sag {sag_rad}, every {period_secs} s: {found}"
                    );
                }
            }
        }
    }
}

#[test]
fn one_direction_alone_tells_a_delay_too() {
    let found = follow(|secs| 0.4 * secs, 0.08, 0.0, 0.01, 3.0).lag_secs();
    assert!((found.expect("it moves") - 0.08).abs() < 0.004, "{found:?}");
}

#[test]
fn nothing_is_said_of_what_cannot_be_known() {
    let stands: fn(f64) -> f64 = |_| 0.25;
    assert_eq!(follow(stands, 0.05, 0.0, 0.01, 5.0).lag_secs(), None);
    assert_eq!(follow(wave, 0.05, 0.0, 0.01, 0.5).lag_secs(), None, "too little");
    assert_eq!(follow(wave, 0.6, 0.0, 0.01, 5.0).lag_secs(), None, "too long");
    let mut blocked = Follower::default();
    for tick in 0..500 {
        let at_secs = f64::from(tick) * 0.01;
        blocked.measured(at_secs, 0.2);
        blocked.goal_sent(at_secs, wave(at_secs), [10.0, 100.0]);
    }
    assert_eq!(blocked.lag_secs(), None, "it does not follow");
}

#[test]
fn what_is_known_outlasts_a_pause() {
    let long = follow(wave, 0.06, 0.0, 0.01, 30.0).lag_secs();
    assert!((long.expect("known from before the pause") - 0.06).abs() < 0.004);
}

#[test]
fn a_lead_grows_slowly_to_the_lag_and_takes_it_away() {
    let lag_secs = 0.08;
    let period_secs = 0.01;
    let mut follower = Follower::default();
    let mut lead_secs = 0.0;
    let mut sent: Vec<(f64, f64)> = Vec::new();
    for tick in 0..1200 {
        let at_secs = f64::from(tick) * period_secs;
        let asked = |secs: f64| 0.5 * (2.0 * secs).sin();
        // The joint is where the goal was `lag_secs` ago.
        let steps = (lag_secs / period_secs) as usize;
        if let Some((_, angle)) = sent.len().checked_sub(steps + 1).and_then(|at| sent.get(at)) {
            follower.measured(at_secs - period_secs, *angle);
        }
        let before = lead_secs;
        lead_secs = follower.lead(true, period_secs);
        assert!((lead_secs - before).abs() <= LEAD_RATE * period_secs + 1e-12);
        let goal = asked(at_secs + lead_secs);
        follower.goal_sent(at_secs, goal, [10.0, 100.0]);
        follower.clip_ahead(at_secs, asked(at_secs + AHEAD_SECS));
        sent.push((at_secs, goal));
    }
    let known = follower.tracking();
    assert!((known.lead_secs - lag_secs).abs() < 0.006, "{known:?}");
    assert!(known.behind_clip_secs.expect("known").abs() < 0.006, "{known:?}");
    // 0.5 · 2 rad/s · 80 ms / √2 is what the lag makes of the error.
    assert!((known.goal_error_rms_rad - 0.0565).abs() < 0.006, "{known:?}");
    assert!(known.clip_error_rms_rad < 0.006, "{known:?}");
}
