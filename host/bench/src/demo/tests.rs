use super::*;
use std::path::Path;

fn salute() -> Show {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shows/salute");
    rig::document::load(&path).expect("the shipped show").show
}

fn options(keys_max: usize) -> DemoOptions {
    DemoOptions {
        show: salute(),
        profiles: Arc::new(Profiles::builtin()),
        keys_max: Some(keys_max),
    }
}

#[test]
fn two_keys_are_entered_and_performed() {
    let mut stored = 0;
    let demo = run(options(2), &mut |scene| {
        stored += usize::from(scene.key_stored);
        ControlFlow::Continue(())
    })
    .expect("the story is told");
    let report = &demo.report;
    assert_eq!((stored, report.keys_entered), (2, 2));
    assert!(report.journal_replay_identical);
    assert_eq!(report.stale_reads, 0);
    assert!(report.reads > 1000);
    assert!(report.pose_error_deg < 6.0, "{}", report.pose_error_deg);
    assert!(
        report.servo.start_jump_deg < 0.1,
        "{}",
        report.servo.start_jump_deg
    );
    assert!(report.servo.max_speed_ratio <= 1.0 && report.servo.max_accel_ratio <= 1.0);
    assert!(csv(&demo.rows, &demo.joints).starts_with("t_secs,joint,goal_rad,measured_rad\n"));
}

#[test]
fn the_same_story_is_told_the_same_way() {
    let mut listener = |_: Scene<'_>| ControlFlow::Continue(());
    let first = run(options(2), &mut listener).expect("told");
    let second = run(options(2), &mut listener).expect("told again");
    assert_eq!(first.report, second.report);
    assert_eq!(first.rows, second.rows);
    let last = options(2).show.current_clip().expect("a clip").keys[1].secs;
    let entered = first.show.current_clip().expect("entered").keys[1].secs;
    // A count of the time dial is 1/64 s.
    assert!(
        (entered - last).abs() <= 1.0 / 128.0 + 1e-9,
        "{entered} for {last}"
    );
}

#[test]
fn a_listener_may_stop_it_safely() {
    let mut steps = 0;
    let error = run(options(2), &mut |_| {
        steps += 1;
        if steps < 50 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    })
    .expect_err("stopped");
    assert!(
        matches!(error, DemoError::Stopped { torque_off: true }),
        "{error}"
    );
}

#[test]
fn an_arm_performs_by_itself_and_its_lag_is_made_up_for() {
    let options = DemoOptions {
        show: rig::document::from_texts(&rig::shipped::arm()).expect("the shipped arm"),
        profiles: Arc::new(Profiles::builtin()),
        keys_max: None,
    };
    let demo = run(options, &mut |_| ControlFlow::Continue(())).expect("the story is told");
    let servo = &demo.report.servo;
    assert!(demo.report.journal_replay_identical && demo.report.stale_reads == 0 && demo.report.reads > 1000);
    assert!(servo.start_jump_deg < 0.1, "{}", servo.start_jump_deg);
    assert!(servo.max_speed_ratio <= 1.0 && servo.max_accel_ratio <= 1.0);
    let (before, after) = (servo.clip_rms_error_before_deg, servo.clip_rms_error_after_deg);
    assert!(before > Some(0.2) && after < before, "{before:?} {after:?}");
    assert_eq!(servo.lag.len(), 6);
    for (joint, lag) in &servo.lag {
        let (before, after) = (lag.before_ms.expect("it moved"), lag.after_ms.expect("it moved"));
        assert!(
            before > 5.0 && after.abs() < before / 2.0,
            "{joint}: {before} {after}"
        );
    }
}
