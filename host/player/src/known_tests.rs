//! What is known of torque, of whoever is in charge, and of lags.

use super::*;

#[test]
fn a_line_that_is_gone_leaves_torque_unknown_until_its_servos_have_answered() {
    let mut bench = Bench::new(PlayerConfig::default());
    assert!(!bench.tick(vec![]).torque_unknown, "nothing was switched on");
    bench.tick(vec![Order::Arm]);
    assert!(!bench.until("holding").torque_unknown, "it is known to be on");
    bench.far[1].desk().gone = true;
    assert!(bench.until("faulted").torque_unknown);
    for _ in 0..150 {
        assert!(bench.tick(vec![]).torque_unknown);
    }
    assert!(!bench.player.report().torque, "nothing more can be done about it");
    bench.far[1].desk().gone = false;
    let transport = bench.far[1].transport();
    bench.player.reconnect("lower", transport).unwrap();
    bench.tick(vec![Order::Reset]);
    assert!(!bench.until("released").torque_unknown);
    assert!(!bench.torque());
}

#[test]
fn a_servo_that_never_says_that_it_let_go_leaves_torque_unknown() {
    let mut bench = Bench::holding();
    bench.far[0].desk().silent.insert(12);
    bench.until("faulted");
    for _ in 0..300 {
        bench.tick(vec![]);
    }
    assert!(bench.player.report().torque_unknown);
    bench.far[0].desk().silent.clear();
    bench.tick(vec![Order::Reset]);
    bench.until("released");
    bench.tick(vec![Order::Arm]);
    bench.until("holding");
    bench.tick(vec![Order::Release]);
    assert!(!bench.until("released").torque_unknown);
}

#[test]
fn a_puppet_that_needs_a_heartbeat_is_played_only_while_one_comes() {
    let mut bench = Bench::new(PlayerConfig {
        heartbeat_max: Some(Duration::from_millis(300)),
        ..PlayerConfig::default()
    });
    let refused = bench.tick(vec![Order::Arm]).rejected.expect("nobody is there");
    assert!(refused.to_string().contains("needs a heartbeat"), "{refused}");
    bench.tick(vec![Order::Heartbeat, Order::Arm]);
    for tick in 0..100 {
        let beats = if tick % 10 == 0 {
            vec![Order::Heartbeat]
        } else {
            vec![]
        };
        bench.tick(beats);
    }
    assert_eq!(*bench.player.state(), State::Holding);
    // Other orders are signs of the operator's life, not of the one that the puppet needs.
    for _ in 0..20 {
        bench.tick(vec![Order::Alive]);
    }
    assert_eq!(*bench.player.state(), State::Faulted(Fault::HeartbeatLost));
    for _ in 0..60 {
        bench.tick(vec![Order::Heartbeat]);
    }
    assert_eq!(
        *bench.player.state(),
        State::Faulted(Fault::HeartbeatLost),
        "latched"
    );
    assert!(!bench.torque());
    bench.tick(vec![Order::Reset]);
    bench.until("released");
}

#[test]
fn compensation_takes_goals_ahead_slowly_and_only_while_playing() {
    let mut bench = Bench::holding();
    bench.tick(vec![Order::CompensateLag(true), Bench::play(-1.0, 1.0, true)]);
    let mut report = bench.tick(vec![]);
    while report.phase != Phase::Running {
        assert!(report.joints.iter().all(|joint| joint.tracking.lead_secs == 0.0));
        report = bench.tick(vec![]);
    }
    let yaw = bench.player.puppet().joint("neck_yaw").unwrap();
    for _ in 0..80 {
        report = bench.tick(vec![]);
    }
    let tracking = report.joints[yaw].tracking;
    let lag = tracking.lag_secs.expect("it has moved");
    // The far end obeys at once; what it says was measured before the goal of the same tick.
    assert!((0.0..0.03).contains(&lag), "{tracking:?}");
    assert!(tracking.lead_secs <= lag + 0.005, "{tracking:?}");
    assert!(tracking.speed_ratio_max > 0.1 && tracking.speed_ratio_max <= 1.0);
    assert!(tracking.goal_samples > 60);
    let still = bench.player.puppet().joint("neck_pitch").unwrap();
    assert_eq!(report.joints[still].lag_secs, None, "it stands");
}
