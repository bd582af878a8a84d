//! Captures of a rig that runs: each file is whole, has everything that passed, and plays back as it was; also begun in
//! the middle, with the cable out meanwhile, and where the program is killed.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use bench::Movement;
use bench::hands::Tool;
use bench::world::{DIAL_BOX, TABLET, World, WorldOptions};
use device_profiles::Profiles;
use firmware_sim::hands::Turn;
use rig::capture::{Played, replay};
use rig::{CaptureView, Command, NoteLevel, Touch};

fn world(folder: &Path) -> World {
    let show = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shows/salute");
    let mut options = WorldOptions::new(rig::document::load(&show).expect("the shipped show loads").show);
    options.equipment.puppet = None;
    let mut world = World::new(options).expect("the bench stands");
    world.keep_captures_in(folder.to_owned());
    world
}

fn start(devices: &[&str]) -> [Command; 1] {
    let devices = devices.iter().map(|name| (*name).to_owned()).collect();
    [Command::StartCapture { devices }]
}

fn stop() -> [Command; 1] {
    [Command::StopCapture { devices: Vec::new() }]
}

fn turn(world: &mut World, by: i32, over_secs: f64) {
    let turn = Movement::Turn {
        control: 3,
        by: Turn::Counts(by),
        over_secs,
    };
    world.hands().begin(DIAL_BOX, 0.0, turn);
}

fn cable(world: &mut World, device: &str, connected: bool) {
    let touch = Touch::Cable { connected };
    world.step([Command::Touch {
        device: device.to_owned(),
        touch,
    }]);
}

fn view(world: &World, device: &str) -> CaptureView {
    let device = world.seen().devices.iter().find(|it| it.name == device);
    device.and_then(|it| it.capture.clone()).expect("it was captured")
}

fn events(world: &World, device: &str) -> u64 {
    let device = world.seen().devices.iter().find(|it| it.name == device);
    device.expect("it is there").events
}

/// The file played back by the codec of its profile; it must do exactly what the file says.
fn played(file: &Path) -> Played {
    let text = fs::read_to_string(file).expect("it can be read");
    let played =
        replay(file, &text, None, &Profiles::builtin()).map_err(|errors| format!("{errors:?}\n{text}"));
    let played = played.expect("it is an exchange");
    assert!(played.differences.is_empty(), "{:?}\n{text}", played.differences);
    played
}

#[test]
fn everything_that_passes_is_in_the_file_and_plays_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("captures");
    let mut world = world(&place);
    world.run_for(2.0);
    // A count that the file must know to understand the next one.
    turn(&mut world, -37, 0.2);
    world.run_for(0.5);
    let before = [DIAL_BOX, TABLET].map(|device| events(&world, device));
    world.step(start(&[]));
    turn(&mut world, 90, 0.6);
    world.hands().begin(TABLET, 0.0, Movement::Take(Tool::Puck));
    let glide = |to, over_secs| Movement::Glide { to, over_secs };
    world.hands().begin(TABLET, 0.05, glide([0.3, 0.2], 0.1));
    world.hands().begin(TABLET, 0.2, glide([-0.3, 0.1], 0.6));
    world.run_for(1.0);
    let running = view(&world, DIAL_BOX);
    assert!(
        running.running && running.file.ends_with("captures/dial-box-1.txt.part"),
        "{running:?}"
    );
    assert!(
        (running.secs - 1.0).abs() < 0.03 && running.bytes > 0,
        "{running:?}"
    );
    world.step(stop());
    let heard = [DIAL_BOX, TABLET].map(|device| events(&world, device));
    for (at, device) in [DIAL_BOX, TABLET].into_iter().enumerate() {
        let ended = view(&world, device);
        assert!(!ended.running && ended.trouble.is_none(), "{ended:?}");
        let file = place.join(format!("{device}-1.txt"));
        assert_eq!(ended.file, file.display().to_string());
        assert_eq!(ended.bytes, fs::metadata(&file).expect("it is there").len());
        let played = played(&file);
        assert!(heard[at] > before[at] + 20, "{device}: {before:?} {heard:?}");
        assert_eq!(
            played.events.len() as u64,
            heard[at],
            "{device}: all since it was there"
        );
        assert_eq!(ended.events, heard[at]);
    }
    // The next one does not take the place of the first.
    world.step(start(&[DIAL_BOX]));
    assert!(view(&world, DIAL_BOX).file.ends_with("dial-box-2.txt.part"));
    assert!(!view(&world, TABLET).running);
}

#[test]
fn a_file_begun_with_the_device_has_the_whole_conversation() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut world = world(folder.path());
    world.step(start(&[]));
    world.run_for(2.0);
    turn(&mut world, 64, 0.3);
    world.run_for(0.5);
    world.step(stop());
    for device in [DIAL_BOX, TABLET] {
        let file = folder.path().join(format!("{device}-1.txt"));
        let text = fs::read_to_string(&file).expect("it can be read");
        assert!(text.contains("host   >") && text.contains("device <"), "{text}");
        played(&file);
    }
}

#[test]
fn a_cable_that_comes_out_meanwhile_loses_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut world = world(folder.path());
    world.run_for(2.0);
    turn(&mut world, 20, 0.1);
    world.run_for(0.3);
    world.step(start(&[]));
    for round in 0..3 {
        turn(&mut world, 50, 0.4);
        // In the middle of the turn.
        world.run_for(0.1 + 0.1 * f64::from(round));
        for device in [DIAL_BOX, TABLET] {
            cable(&mut world, device, false);
        }
        world.run_for(1.3);
        for device in [DIAL_BOX, TABLET] {
            cable(&mut world, device, true);
        }
        world.run_for(3.0);
    }
    turn(&mut world, 7, 0.1);
    world.run_for(0.5);
    world.step(stop());
    for device in [DIAL_BOX, TABLET] {
        let file = folder.path().join(format!("{device}-1.txt"));
        let text = fs::read_to_string(&file).expect("it can be read");
        assert_eq!(text.matches("device gone").count(), 3, "{text}");
        assert_eq!(text.matches("device back").count(), 3, "{text}");
        assert_eq!(
            played(&file).events.len() as u64,
            events(&world, device),
            "{device}"
        );
    }
}

#[test]
fn what_is_written_when_the_program_is_killed_can_be_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut world = world(folder.path());
    world.run_for(2.0);
    world.step(start(&[DIAL_BOX]));
    turn(&mut world, 90, 0.6);
    world.run_for(0.4);
    let heard = events(&world, DIAL_BOX);
    // Nobody ends anything.
    std::mem::forget(world);
    let part = folder.path().join("dial-box-1.txt.part");
    assert!(!folder.path().join("dial-box-1.txt").exists());
    assert_eq!(played(&part).events.len() as u64, heard);
}

#[test]
fn a_rig_that_ends_ends_its_captures() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut world = world(folder.path());
    world.run_for(2.0);
    world.step(start(&[TABLET]));
    world.run_for(0.2);
    world.close();
    played(&folder.path().join("tablet-1.txt"));
}

#[test]
fn what_cannot_be_captured_is_said_and_changes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let in_the_way = folder.path().join("file");
    fs::write(&in_the_way, "").expect("it is written");
    let mut world = world(&in_the_way);
    world.run_for(2.0);
    let before = Arc::clone(world.rig().show());
    for (command, words) in [
        (start(&[DIAL_BOX]), "file: cannot write"),
        (start(&["piano"]), "there is no input device piano"),
        (stop(), "nothing is captured"),
    ] {
        world.step(command);
        let warned = world
            .seen()
            .notes
            .iter()
            .filter(|note| note.level != NoteLevel::Info);
        let told: Vec<&str> = warned.map(|note| note.text.as_str()).collect();
        assert!(told.iter().any(|text| text.contains(words)), "{words}: {told:?}");
    }
    assert!(Arc::ptr_eq(&before, world.rig().show()));
    let seen = world.seen();
    assert!(seen.devices.iter().all(|device| device.capture.is_none()));
}
