//! Pictures of the puppet panel and of clips that ask too much, from a whole rig on the bench: three of them are in
//! `docs/pictures`.

use std::sync::Arc;

use bench::world::{Equipment, World, WorldOptions};
use rig::document::Show;
use rig::{
    Command, EditCommand, PoseCommand, PuppetCommand, PuppetPose, PuppetState, Snapshot, TransportCommand,
};
use ui::render::theme;

use crate::studio_pictures::{SIZES, count, draw, keep, no_adapter, playing, state, world};

/// The forearms of the shipped figure, by their places in it.
const RIGHT_FOREARM: u16 = 3;
/// How much quicker than it was made the clip is to be.
const HURRY: f64 = 0.35;

/// The elbow and the shoulder of the raised arm are hot; the puppet's policy is to do less.
fn hot() -> World {
    let mut world = playing();
    for fault in ["servo 14 hot 63", "servo 11 hot 61"] {
        world
            .stand()
            .fault("upper", fault)
            .expect("they are on that line");
    }
    let backs_off = |seen: &Snapshot| {
        seen.puppet
            .as_ref()
            .is_some_and(|p| p.backing_off.is_some() && p.pace < 0.9)
    };
    world
        .run_until("doing less", 5.0, |seen, _| backs_off(seen))
        .expect("heat is noticed");
    world
}

/// The same elbow, hotter than doing less can help.
fn too_hot() -> World {
    let mut world = hot();
    world
        .stand()
        .fault("upper", "servo 14 hot 69")
        .expect("it is on that line");
    let faulted = |seen: &Snapshot| state(seen) == Some(PuppetState::Faulted);
    world
        .run_until("the fault", 5.0, |seen, _| faulted(seen))
        .expect("it does not cook");
    world.run_for(0.3);
    world
}

fn judged(seen: &Snapshot) -> bool {
    seen.feasibility
        .as_ref()
        .is_some_and(|view| view.progress >= 1.0 && !view.slowing)
}

/// The shipped clip in a third of its time.
fn hurried() -> World {
    let mut world = world();
    let times_secs = world.seen().keys.iter().map(|key| key.secs * HURRY).collect();
    world.step([
        Command::Edit(EditCommand::Retime { times_secs }),
        Command::Pose(PoseCommand::Select(RIGHT_FOREARM)),
    ]);
    let too_fast =
        |seen: &Snapshot| judged(seen) && seen.feasibility.iter().any(|view| !view.stretches.is_empty());
    world
        .run_until("the clip judged", 10.0, |seen, _| too_fast(seen))
        .expect("it is too fast");
    let view = world.seen().feasibility.clone().expect("it was just there");
    let worst = view.stretches.iter().filter(|stretch| stretch.slowable);
    let worst = worst
        .max_by(|a, b| a.factor.total_cmp(&b.factor))
        .expect("speed is too much");
    let secs = f64::midpoint(worst.from_secs, worst.to_secs);
    world.step([Command::Transport(TransportCommand::Seek { secs })]);
    world.run_for(0.2);
    world
}

/// A desk arm without a figure, posed by its end while its servos still stand where they were.
fn arm() -> World {
    let show = Show {
        name: "pick and place".to_owned(),
        puppet: Some("so-101".to_owned()),
        ..Show::default()
    };
    let options = WorldOptions {
        equipment: Equipment {
            puppet: show.puppet.clone(),
            ..Equipment::default()
        },
        show,
        profiles: Arc::new(rig::shipped::profiles(None).expect("the shipped profiles are whole")),
        calibrations: <_>::default(),
        journal: None,
        dut: None,
    };
    let mut world = World::new(options).expect("the bench stands");
    world.run_for(0.5);
    world.step([Command::Puppet(PuppetCommand::Arm)]);
    let holding = |seen: &Snapshot| state(seen) == Some(PuppetState::Holding);
    world
        .run_until("the arm holding", 5.0, |seen, _| holding(seen))
        .expect("it arms");
    for (secs, by_m) in [
        (0.0, [0.0, 0.0, 0.0]),
        (1.2, [0.1, 0.06, -0.05]),
        (2.0, [-0.12, 0.05, 0.0]),
    ] {
        let pose = world.seen().puppet_pose.clone().expect("an arm can be posed");
        let end = pose.ends.last().expect("it has an end").clone();
        let to = [0, 1, 2].map(|axis| end.at[axis] + by_m[axis]);
        world.step([
            Command::Transport(TransportCommand::Seek { secs }),
            Command::PuppetPose(PuppetPose::Drag { link: end.link, to }),
            Command::Edit(EditCommand::StoreKey { secs }),
        ]);
        world.run_for(0.1);
    }
    let joint = |seen: &Snapshot| seen.puppet_pose.as_ref().map(|pose| pose.names[0].clone());
    let joint = joint(world.seen()).expect("it has joints");
    world.step([Command::PuppetPose(PuppetPose::JointBy { joint, by_rad: 0.4 })]);
    world.run_for(0.1);
    world
}

/// Makes a studio in one state.
type Make = fn() -> World;

#[test]
fn a_hot_a_failed_and_an_overasked_puppet_are_told_apart_by_their_colours() {
    if no_adapter() {
        return;
    }
    // Name, what makes it, least of what is too much, and of what has failed.
    let rows: [(&str, Make, usize, usize); 4] = [
        ("hot", hot, 300, 0),
        ("too-hot", too_hot, 0, 4000),
        ("hurried", hurried, 1500, 0),
        ("arm", arm, 0, 0),
    ];
    for (name, make, much, failed) in rows {
        let world = make();
        for size in SIZES {
            let picture = draw(world.seen(), size);
            keep(&picture, name);
            let (violet, red) = (count(&picture, theme::TOO_MUCH), count(&picture, theme::FAULTED));
            assert!(
                violet >= much,
                "{name} {size:?}: {violet} pixels of what is too much"
            );
            assert!(red >= failed, "{name} {size:?}: {red} pixels of what has failed");
            if failed == 0 {
                assert_eq!(red, 0, "{name} {size:?}: red where nothing has failed");
            }
        }
    }
}

#[test]
fn slow_to_fit_takes_the_colour_away_and_undo_brings_it_back() {
    let mut world = hurried();
    let slowable = |seen: &Snapshot| {
        let view = seen.feasibility.as_ref().expect("a puppet's clip is judged");
        view.stretches.iter().filter(|stretch| stretch.slowable).count()
    };
    let before = (world.seen().keys.clone(), slowable(world.seen()));
    world.step([Command::SlowToFit]);
    world
        .run_until("the clip slowed", 60.0, |seen, _| {
            judged(seen) && seen.keys.last() != before.0.last() && slowable(seen) == 0
        })
        .expect("more time is enough");
    world.step([Command::Undo]);
    world
        .run_until("the clip as it was", 20.0, |seen, _| {
            judged(seen) && slowable(seen) == before.1
        })
        .expect("one step of undo");
    let times = |keys: &[rig::KeyView]| keys.iter().map(|key| key.secs).collect::<Vec<_>>();
    assert_eq!(times(&world.seen().keys), times(&before.0));
}

#[test]
fn the_arm_on_screen_is_stored_and_the_servos_stay() {
    let world = arm();
    let seen = world.seen();
    assert_eq!(seen.keys.len(), 3);
    let pose = seen.puppet_pose.as_ref().expect("an arm can be posed");
    assert!(pose.by_hand, "turned since the last key");
    let puppet = seen.puppet.as_ref().expect("it is driven");
    let apart = |(a, b): (&f64, &rig::JointView)| (a - b.measured_rad.unwrap_or(*a)).abs() > 0.2;
    assert!(
        pose.angles_rad.iter().zip(&puppet.joints).any(apart),
        "nobody has played what was posed"
    );
    assert_eq!(puppet.goal_bones.len(), puppet.bones.len());
}
