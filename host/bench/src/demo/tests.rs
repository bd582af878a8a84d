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
