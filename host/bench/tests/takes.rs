//! Takes: what devices said, done again. The same network gives the same keys to the last bit, another one others;
//! a take is one step of undo, lives in the show's folder, and its keys are as near to what was seen as was asked for.

use std::sync::Arc;

use bench::Movement;
use bench::hands::Tool;
use bench::replay::{Journal, replay};
use bench::world::{DIAL_BOX, Equipment, TABLET, World, WorldOptions};
use device_profiles::Profiles;
use firmware_sim::hands::Turn;
use motion::thin::FigureTolerance;
use motion::{Clip, FigureKey, FigurePose};
use rig::document::{self, Show};
use rig::take::TakeTolerance;
use rig::{Command, NetworkEdit, NoteLevel, Snapshot, TakeCommand, Touch};

/// The longest a re-run and its thinning may take, seconds of the world.
const PATIENCE_SECS: f64 = 60.0;
const TOLERANCE: TakeTolerance = TakeTolerance {
    angle_rad: 0.01,
    distance_m: 0.002,
};

fn shipped() -> Show {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shows/salute");
    document::load(&folder).expect("the shipped show loads").show
}

fn world(show: Show, journal: Option<Journal>) -> World {
    let mut options = WorldOptions::new(show);
    options.equipment.puppet = None;
    options.journal = journal.map(|journal| Box::new(journal) as _);
    World::new(options).expect("the bench stands")
}

fn take(command: TakeCommand) -> [Command; 1] {
    [Command::Take(command)]
}

fn start(name: &str) -> [Command; 1] {
    take(TakeCommand::Start {
        name: name.to_owned(),
        devices: Vec::new(),
        tolerance: Some(TOLERANCE),
    })
}

fn again(clip: &str) -> [Command; 1] {
    take(TakeCommand::Rerun {
        take: "wave".to_owned(),
        clip: Some(clip.to_owned()),
        tolerance: Some(TOLERANCE),
    })
}

/// A hand that poses two links with the puck and twists one with a dial; what was seen after each step.
fn perform(world: &mut World) -> Vec<(f64, Arc<FigurePose>)> {
    let hands = world.hands();
    hands.begin(TABLET, 0.0, Movement::Take(Tool::Puck));
    let glide = |to, over_secs| Movement::Glide { to, over_secs };
    hands.begin(TABLET, 0.05, glide([0.3, 0.2], 0.8));
    hands.begin(
        TABLET,
        0.9,
        Movement::Click {
            button: 1,
            for_secs: 0.1,
        },
    );
    hands.begin(TABLET, 1.1, glide([-0.2, -0.4], 0.7));
    let turn = Movement::Turn {
        control: 3,
        by: Turn::Counts(90),
        over_secs: 0.6,
    };
    hands.begin(DIAL_BOX, 0.4, turn);
    let pose = |seen: &Snapshot| Arc::new(seen.figure.as_ref().expect("a figure").pose.clone());
    let from = world.secs();
    let mut seen = vec![(0.0, pose(world.seen()))];
    while world.secs() - from < 2.2 {
        let now = pose(world.step([]));
        seen.push((world.secs() - from, now));
    }
    seen
}

/// Waits until the keys are there.
fn finish(world: &mut World) {
    world
        .run_until("the keys of the take", PATIENCE_SECS, |seen, _| {
            seen.take.is_none()
        })
        .expect("they come");
}

fn keys(world: &World, clip: &str) -> Vec<FigureKey> {
    let show = Arc::clone(world.rig().show());
    let clip = show.clips.get(clip).unwrap_or_else(|| panic!("clip {clip}"));
    clip.keys.iter().map(|key| FigureKey::clone(key)).collect()
}

/// The numbers of keys, bit for bit.
fn bits(keys: &[FigureKey]) -> Vec<u64> {
    let numbers = keys.iter().flat_map(|key| {
        let links = key.pose.links.iter().flat_map(|link| {
            let [x, y, z] = link.direction.to_array();
            [x, y, z, link.twist_rad, link.length]
        });
        let [x, y, z] = key.pose.root.to_array();
        [key.secs, x, y, z].into_iter().chain(links).collect::<Vec<_>>()
    });
    numbers.map(f64::to_bits).collect()
}

fn warnings(world: &World) -> Vec<String> {
    let notes = world.seen().notes.iter();
    let warned = notes.filter(|note| note.level != NoteLevel::Info);
    warned.map(|note| note.text.clone()).collect()
}

/// A world with a take called wave in it, and what was seen while it was made.
fn recorded(journal: Option<Journal>) -> (World, Vec<(f64, Arc<FigurePose>)>) {
    let mut world = world(shipped(), journal);
    world.run_for(2.0);
    // Something before the take, so that counts and sums do not stand at nothing.
    let turn = Movement::Turn {
        control: 3,
        by: Turn::Counts(-37),
        over_secs: 0.2,
    };
    world.hands().begin(DIAL_BOX, 0.0, turn);
    world.run_for(0.5);
    world.step(start("wave"));
    let seen = perform(&mut world);
    world.step(take(TakeCommand::Stop));
    finish(&mut world);
    (world, seen)
}

#[test]
fn the_same_network_gives_the_same_keys_and_another_one_others() {
    let (mut world, seen) = recorded(None);
    assert_eq!(warnings(&world), Vec::<String>::new());
    let first = keys(&world, "wave");
    assert!(first.len() >= 4, "{} keys", first.len());
    assert!(
        first.len() < seen.len() / 2,
        "{} keys of {} poses",
        first.len(),
        seen.len()
    );

    world.step(again("again"));
    finish(&mut world);
    assert_eq!(bits(&keys(&world, "again")), bits(&first));

    // A gain that is halved: other twists, and nothing else about the take has changed.
    world.step([Command::Network(NetworkEdit::Commands(
        "SEND 180 TO <2>twist;".into(),
    ))]);
    world.step(again("halved"));
    finish(&mut world);
    let halved = keys(&world, "halved");
    assert_ne!(bits(&halved), bits(&first));
    let twist = |keys: &[FigureKey]| {
        let last = keys.last().expect("keys").pose.links.iter();
        last.map(|link| link.twist_rad).sum::<f64>()
    };
    assert!(
        (twist(&halved) - twist(&first)).abs() > 0.1,
        "{} {}",
        twist(&halved),
        twist(&first)
    );

    // Undone, the network is the old one, and so are the keys.
    world.step([Command::Undo]);
    world.step([Command::Undo]);
    world.step(again("undone"));
    finish(&mut world);
    assert_eq!(bits(&keys(&world, "undone")), bits(&first));
}

#[test]
fn the_clip_is_as_near_to_what_was_seen_as_was_asked_for() {
    let (world, seen) = recorded(None);
    let show = Arc::clone(world.rig().show());
    let figure = &show.figure.as_ref().expect("a figure").figure;
    let clip: Clip = show.clips["wave"]
        .clip(figure)
        .expect("it plays")
        .expect("it has keys");
    let tolerance = FigureTolerance {
        angle_rad: TOLERANCE.angle_rad,
        distance_m: TOLERANCE.distance_m,
    };
    let mut shown = FigurePose::default();
    let mut moved = 0.0_f64;
    for (secs, pose) in &seen {
        clip.sample(*secs, &mut shown);
        let off = tolerance.off(&shown, pose);
        assert!(off <= 1.0 + 1e-9, "{off} times what is tolerated at {secs} s");
        moved = moved.max(tolerance.off(pose, &seen[0].1));
    }
    assert!(moved > 10.0, "the hands moved nothing");
}

#[test]
fn a_take_is_one_step_of_undo_and_is_read_back_from_its_folder() {
    let (mut world, _) = recorded(None);
    let first = keys(&world, "wave");
    let folder = tempfile::tempdir().expect("a folder");
    document::save(world.rig().show(), folder.path()).expect("it is saved");
    world.step([Command::Undo]);
    assert_eq!(**world.rig().show(), shipped(), "one step takes all of it back");
    world.step([Command::Redo]);
    assert_eq!(world.seen().takes, ["wave"]);

    // Another day, without that session's devices having said anything.
    let loaded = document::load(&folder.path().join("show.toml")).expect("it loads");
    assert_eq!(loaded.show.takes, world.rig().show().takes);
    let mut later = self::world(loaded.show, None);
    later.run_for(0.3);
    later.step(again("later"));
    finish(&mut later);
    assert_eq!(warnings(&later), Vec::<String>::new());
    assert_eq!(bits(&keys(&later, "later")), bits(&first));
}

#[test]
fn a_device_that_goes_and_comes_back_belongs_to_the_take() {
    let mut world = world(shipped(), None);
    world.run_for(2.5);
    world.step(start("wave"));
    let cable = |connected| Command::Touch {
        device: TABLET.to_owned(),
        touch: Touch::Cable { connected },
    };
    perform(&mut world);
    world.step([cable(false)]);
    world.run_for(1.5);
    world.step([cable(true)]);
    world.run_for(3.5);
    perform(&mut world);
    world.step(take(TakeCommand::Stop));
    finish(&mut world);
    let words = warnings(&world);
    assert!(
        !words.iter().any(|text| text.contains("not quite what was seen")),
        "{words:?}"
    );
    let first = keys(&world, "wave");
    world.step(again("again"));
    finish(&mut world);
    assert_eq!(bits(&keys(&world, "again")), bits(&first));
    assert!(first.last().expect("keys").secs > 9.0);
}

#[test]
fn a_journal_with_a_take_in_it_repeats_itself() {
    let journal = Journal::new();
    let (world, _) = recorded(Some(journal.clone()));
    world.close();
    let equipment = Equipment::default();
    let replayed = replay(
        &journal.text(),
        shipped(),
        Arc::new(Profiles::builtin()),
        &equipment,
    );
    assert!(replayed.expect("it can be read").is_identical());
}

#[test]
fn what_cannot_be_taken_says_why_and_changes_nothing() {
    let mut world = world(shipped(), None);
    world.run_for(2.5);
    let before = Arc::clone(world.rig().show());
    for (command, words) in [
        (TakeCommand::Stop, "no take is being made"),
        (
            TakeCommand::Rerun {
                take: "nothing".into(),
                clip: None,
                tolerance: None,
            },
            "there is no take `nothing`",
        ),
        (
            TakeCommand::Delete("nothing".into()),
            "there is no take `nothing`",
        ),
        (
            TakeCommand::Start {
                name: "a/b".into(),
                devices: Vec::new(),
                tolerance: None,
            },
            "cannot be the name of a take",
        ),
        (
            TakeCommand::Start {
                name: "a".into(),
                devices: vec!["piano".into()],
                tolerance: None,
            },
            "there is no device `piano`",
        ),
    ] {
        world.step(take(command));
        world.step([]);
        let told = warnings(&world);
        assert!(told.iter().any(|text| text.contains(words)), "{words}: {told:?}");
    }
    assert!(Arc::ptr_eq(&before, world.rig().show()));
}
