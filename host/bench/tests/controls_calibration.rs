//! What was calibrated on controls, through journals, takes and restarts: the same turn is the same turn again.

use std::collections::BTreeMap;
use std::sync::Arc;

use bench::Movement;
use bench::replay::{Journal, replay};
use bench::world::{DIAL_BOX, World, WorldOptions};
use device_profiles::Profiles;
use firmware_sim::hands::Turn;
use rig::controls_calibration::ControlsCalibration;
use rig::document::{self, Show};
use rig::{CalibrateControl, Command, TakeCommand};

/// By what the rig knows the dial box of the bench.
const KNOWN_BY: &str = "sgi-dialbox-display@sim:dial-box";

fn shipped() -> Show {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shows/salute");
    document::load(&folder).expect("the shipped show loads").show
}

/// A box whose first and fourth dials have 200 counts in a turn.
fn known() -> BTreeMap<String, ControlsCalibration> {
    let calibration = ControlsCalibration {
        dials: BTreeMap::from([(0, 200.0), (3, 200.0)]),
        ..ControlsCalibration::default()
    };
    BTreeMap::from([(KNOWN_BY.to_owned(), calibration)])
}

fn world(journal: Option<&Journal>) -> World {
    let mut options = WorldOptions::new(shipped());
    options.equipment.puppet = None;
    options.calibrations = known();
    options.journal = journal.map(|journal| Box::new(journal.clone()) as _);
    let mut world = World::new(options).expect("the bench stands");
    world.run_for(1.5);
    world
}

fn turn(world: &mut World, control: u8, counts: i32) {
    let by = Turn::Counts(counts);
    let over_secs = 0.3;
    world.hands().begin(
        DIAL_BOX,
        0.0,
        Movement::Turn {
            control,
            by,
            over_secs,
        },
    );
    world.run_for(0.5);
}

fn ask(world: &mut World, command: CalibrateControl) {
    world.step([Command::CalibrateControl(command)]);
}

fn azimuth_rad(world: &World) -> f64 {
    world.seen().view.azimuth_rad
}

#[test]
fn what_is_known_of_a_device_holds_from_the_beginning_and_on_the_desk_too() {
    let mut world = world(None);
    turn(&mut world, 0, 100);
    assert!(
        (azimuth_rad(&world) - std::f64::consts::FRAC_PI_2).abs() < 1e-9,
        "half a turn of 200"
    );
    let turned = |world: &World, dial: usize| world.seen().desk.dials[dial].turns;
    // Steps of a two-hundredth add up to a half but for the rounding of each.
    assert!((turned(&world, 0) - 0.5).abs() < 1e-12);
    turn(&mut world, 1, 64);
    assert_eq!(turned(&world, 1), 0.25, "the profile's 256");
}

#[test]
fn a_journal_knows_what_was_calibrated_before_and_meanwhile() {
    let journal = Journal::new();
    let mut world = world(Some(&journal));
    turn(&mut world, 0, 50);
    let (device, control, turns) = (DIAL_BOX.to_owned(), 1, 1);
    ask(
        &mut world,
        CalibrateControl::Dial {
            device,
            control,
            turns,
        },
    );
    turn(&mut world, 0, 160);
    ask(&mut world, CalibrateControl::Next);
    ask(&mut world, CalibrateControl::Take);
    turn(&mut world, 0, 40);
    let want = std::f64::consts::PI * (50.0 / 200.0 + 40.0 / 160.0);
    assert!(
        (azimuth_rad(&world) - want).abs() < 1e-9,
        "{}",
        azimuth_rad(&world)
    );
    let equipment = WorldOptions::new(shipped()).equipment;
    let equipment = bench::world::Equipment {
        puppet: None,
        ..equipment
    };
    world.close();
    let again = |text: &str| {
        let profiles = Arc::new(Profiles::builtin());
        replay(text, shipped(), profiles, &equipment).expect("a whole journal")
    };
    let text = journal.text();
    assert!(again(&text).is_identical());
    let without: Vec<&str> = text.lines().filter(|line| !line.contains("calibrated")).collect();
    assert!(
        without.len() + 1 == text.lines().count(),
        "it has one line about it"
    );
    assert!(!again(&without.join("\n")).is_identical(), "and that counts");
}

#[test]
fn a_take_has_what_was_calibrated_when_it_began() {
    let mut world = world(None);
    world.step([Command::Take(TakeCommand::Start {
        name: "wave".to_owned(),
        devices: Vec::new(),
        tolerance: None,
    })]);
    turn(&mut world, 3, 90);
    world.step([Command::Take(TakeCommand::Stop)]);
    world
        .run_until("the keys of the take", 60.0, |seen, _| seen.take.is_none())
        .expect("they come");
    let notes: Vec<&str> = world.seen().notes.iter().map(|note| note.text.as_str()).collect();
    assert!(
        notes.iter().any(|note| note.contains("poses became")),
        "{notes:?}"
    );
    assert!(
        !notes.iter().any(|note| note.contains("not quite what was seen")),
        "{notes:?}"
    );
    let show = Arc::clone(world.rig().show());
    let heard = &show.takes["wave"].devices[DIAL_BOX];
    assert_eq!(heard.calibration, known()[KNOWN_BY]);
    // It lives in the take's file.
    let folder = tempfile::tempdir().expect("a folder");
    document::save(&show, &folder.path().join("s")).expect("it is written");
    let read = document::load(&folder.path().join("s")).expect("it reads").show;
    assert_eq!(
        read.takes["wave"].devices[DIAL_BOX].calibration,
        known()[KNOWN_BY]
    );
}
