//! Late answers are recognised; jitter, drift, wrap and reboots are not mistaken for them.

use super::*;
use proptest::prelude::*;

/// The servo's turn comes after this long at the latest.
const TURN: Duration = Duration::from_millis(1);

fn at_ms(ms: f64) -> Instant {
    Instant::from_nanos((ms * 1e6) as u64)
}

/// A servo whose clock read `start` at host time zero and runs `rate` times as fast.
fn tick(host_ms: f64, start: f64, rate: f64) -> u16 {
    (start + host_ms * rate).rem_euclid(TICK_PERIOD_MS) as u16
}

#[test]
fn an_answer_of_the_cycle_before_is_stale() {
    for period in [5.0, 10.0, 20.0, 50.0] {
        let mut freshness = Freshness::default();
        for cycle in 0..50 {
            let sent = 1000.0 + f64::from(cycle) * period;
            let verdict = freshness.judge(tick(sent + 1.0, 77.0, 1.0), at_ms(sent), TURN, at_ms(sent + 3.0));
            assert_eq!(verdict, Verdict::Fresh);
        }
        let sent = 1000.0 + 50.0 * period;
        let late = tick(sent - period + 1.0, 77.0, 1.0);
        let verdict = freshness.judge(late, at_ms(sent), TURN, at_ms(sent + 0.5));
        assert!(
            matches!(verdict, Verdict::Stale { .. }),
            "period {period}: {verdict:?}"
        );
        assert_eq!(
            freshness.judge(tick(sent + 1.0, 77.0, 1.0), at_ms(sent), TURN, at_ms(sent + 3.0)),
            Verdict::Fresh
        );
    }
}

#[test]
fn answers_that_are_always_late_never_become_fresh() {
    let mut freshness = Freshness::default();
    for cycle in 0..20 {
        let sent = f64::from(cycle) * 20.0;
        assert_eq!(
            freshness.judge(
                tick(sent + 1.0, 9000.0, 1.0),
                at_ms(sent),
                TURN,
                at_ms(sent + 4.0)
            ),
            Verdict::Fresh
        );
    }
    for cycle in 21..300 {
        let sent = f64::from(cycle) * 20.0;
        let verdict = freshness.judge(
            tick(sent - 19.0, 9000.0, 1.0),
            at_ms(sent),
            TURN,
            at_ms(sent + 1.0),
        );
        let gap = sent - 380.0;
        if gap * DRIFT < 15.0 {
            assert!(
                matches!(verdict, Verdict::Stale { .. }),
                "cycle {cycle}: {verdict:?}"
            );
        }
    }
}

#[test]
fn a_reboot_is_seen() {
    let mut freshness = Freshness::default();
    for cycle in 0..20 {
        let sent = f64::from(cycle) * 20.0;
        freshness.judge(tick(sent, 20_000.0, 1.0), at_ms(sent), TURN, at_ms(sent + 4.0));
    }
    let sent = 900.0;
    assert_eq!(
        freshness.judge(150, at_ms(sent), TURN, at_ms(sent + 4.0)),
        Verdict::Restarted
    );
    assert_eq!(
        freshness.judge(170, at_ms(sent + 20.0), TURN, at_ms(sent + 24.0)),
        Verdict::Fresh
    );
}

#[test]
fn a_first_answer_that_was_late_is_put_right() {
    let mut freshness = Freshness::default();
    // Measured 60 ms before it was asked for, and believed for want of anything better.
    freshness.judge(tick(940.0, 5.0, 1.0), at_ms(1000.0), TURN, at_ms(1001.0));
    for cycle in 1..4 {
        let sent = 1000.0 + 20.0 * f64::from(cycle);
        assert_eq!(
            freshness.judge(tick(sent + 1.0, 5.0, 1.0), at_ms(sent), TURN, at_ms(sent + 3.0)),
            Verdict::Fresh
        );
    }
    let verdict = freshness.judge(tick(1061.0, 5.0, 1.0), at_ms(1080.0), TURN, at_ms(1081.0));
    assert!(matches!(verdict, Verdict::Stale { .. }), "{verdict:?}");
}

#[test]
fn a_servo_asked_earlier_in_the_chain_is_not_taken_for_late() {
    let mut freshness = Freshness::default();
    for cycle in 0..40 {
        let sent = 20.0 * f64::from(cycle);
        // Half-way through, return delays are set to nothing and its turn comes much sooner.
        let (turn, delay) = if cycle < 20 { (15, 9.0) } else { (4, 3.0) };
        let tick = tick(sent + delay, 12.0, 1.0);
        let verdict = freshness.judge(
            tick,
            at_ms(sent),
            Duration::from_millis(turn),
            at_ms(sent + delay + 1.0),
        );
        assert_eq!(verdict, Verdict::Fresh, "cycle {cycle}");
    }
}

proptest! {
    /// Fresh answers stay fresh through jitter, drift, changing turns and the wrap of the tick.
    #[test]
    fn fresh_answers_are_never_refused(
        start in 0.0..32_768.0,
        rate in 0.99..1.01,
        period in 2.0..60.0,
        share in 0.0..1.0,
        answers in proptest::collection::vec((0_u64..12, 0.0..0.9, 0.0..15.0), 2..200),
    ) {
        let mut freshness = Freshness::default();
        let mut sent = 10.0;
        for (turn, jitter, after) in answers {
            let measured = sent + turn as f64 * share + jitter;
            let turn = Duration::from_millis(turn);
            let verdict = freshness.judge(tick(measured, start, rate), at_ms(sent), turn, at_ms(measured + after));
            prop_assert_eq!(verdict, Verdict::Fresh);
            sent += period;
        }
    }
}
