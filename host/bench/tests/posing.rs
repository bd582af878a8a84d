//! A puppet that follows no figure, posed by hand while its simulated servos follow: live, within every limit, and
//! taken over from where they were left.

use std::sync::Arc;

use bench::world::{Equipment, World, WorldOptions};
use device_profiles::Profiles;
use rig::{Command, PuppetCommand, PuppetPose, PuppetState, Snapshot};

fn world() -> World {
    let show = rig::document::from_texts(&rig::shipped::arm()).expect("the shipped arm");
    let mut equipment = Equipment {
        knobs: None,
        tablet: None,
        puppet: show.puppet.clone(),
        ..Equipment::default()
    };
    equipment.plan.start_rad = [("shoulder_pan".to_owned(), 0.7), ("elbow_flex".to_owned(), 0.4)].into();
    World::new(WorldOptions {
        show,
        profiles: Arc::new(Profiles::builtin()),
        equipment,
        calibrations: <_>::default(),
        journal: None,
        dut: None,
    })
    .expect("a world")
}

fn held(seen: &Snapshot) -> bool {
    seen.puppet
        .as_ref()
        .is_some_and(|puppet| puppet.state == PuppetState::Holding)
}

/// The largest distance of a servo from the pose on screen, radians.
fn apart_rad(seen: &Snapshot) -> f64 {
    let (Some(puppet), Some(pose)) = (&seen.puppet, &seen.puppet_pose) else {
        return f64::INFINITY;
    };
    let off =
        |(joint, angle): (&rig::JointView, &f64)| (joint.measured_rad.unwrap_or(f64::NAN) - angle).abs();
    puppet
        .joints
        .iter()
        .zip(&pose.angles_rad)
        .map(off)
        .fold(0.0, f64::max)
}

#[test]
fn servos_go_where_they_are_dragged_and_never_jump() {
    let mut world = world();
    world.run_for(0.5);
    world.step([Command::Puppet(PuppetCommand::Arm)]);
    world
        .run_until("holding", 5.0, |seen, _| held(seen))
        .expect("armed");
    // What the servos say becomes the pose, so that following begins with nothing to do.
    world.step([Command::PuppetPose(PuppetPose::FromMeasured)]);
    assert!(apart_rad(world.seen()) < 1e-9);
    world.step([Command::Puppet(PuppetCommand::Follow)]);
    let seen = world
        .run_until("following", 5.0, |seen, _| !held(seen))
        .expect("follows");
    let hand = |seen: &Snapshot| {
        let pose = seen.puppet_pose.as_ref().expect("a pose");
        pose.ends
            .iter()
            .find(|end| end.link == "gripper")
            .expect("an end")
            .at
    };
    let from = hand(&seen);
    let mut goals: Vec<Option<f64>> = Vec::new();
    for step in 1..=100 {
        let to = from + glam::DVec3::new(-0.0006, 0.0004, -0.0003) * f64::from(step);
        let drag = PuppetPose::Drag {
            link: "gripper".into(),
            to: to.to_array(),
        };
        world.step([Command::PuppetPose(drag)]);
        let joints = &world.seen().puppet.as_ref().expect("a puppet").joints;
        for (before, joint) in goals.iter().zip(joints) {
            if let (Some(before), Some(now)) = (before, joint.goal_rad) {
                // 3.5 rad/s at a hundred steps a second.
                assert!(
                    (now - before).abs() <= 0.035 + 1e-9,
                    "{}: {before} to {now}",
                    joint.name
                );
            }
        }
        goals = joints.iter().map(|joint| joint.goal_rad).collect();
    }
    assert!(hand(world.seen()).distance(from) > 0.05);
    world
        .run_until("the servos being there", 5.0, |seen, _| apart_rad(seen) < 0.01)
        .expect("follows");
    world.step([Command::Puppet(PuppetCommand::Release)]);
    world.run_for(1.0);
    assert!(world.close());
}
