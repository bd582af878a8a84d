//! The same doings twice give the same journal, snapshots, bytes and pictures; and the journal alone, without any
//! device, gives them a third time.

use bench::replay::Journal;
use bench::world::{DIAL_BOX, Equipment, PERIOD, TABLET, World, WorldOptions};
use bench::{Movement, hands::Tool};
use device::{Clock, VirtualClock};
use device_profiles::Profiles;
use firmware_sim::hands::Turn;
use rig::controls_calibration::Store;
use rig::document::Show;
use rig::journal::{Digest, Ending, Recorder, RecordingPorts, Script};
use rig::{
    Command, EditCommand, NetworkEdit, Pace, PuppetCommand, Rig, RigOptions, Snapshot, Touch,
    TransportCommand,
};
use std::sync::Arc;
use ui::render::{frame, stage::Look};

/// Every so many steps a picture is made.
const STEPS_A_PICTURE: u64 = 40;
/// Small, because only sameness is looked for.
const PICTURE: [u32; 2] = [160, 120];

fn show() -> Show {
    let folder = crate::source::root().join("shows/salute");
    rig::document::load(&folder).expect("the shipped show loads").show
}

/// All that a session gives.
#[derive(Debug, PartialEq, Eq)]
struct Outcome {
    /// A digest after each step: a difference is found where it begins.
    snapshots: Vec<String>,
    pictures: Vec<u64>,
}

impl Outcome {
    fn new() -> Self {
        Self {
            snapshots: Vec::new(),
            pictures: Vec::new(),
        }
    }

    fn take(&mut self, snapshot: &Snapshot) {
        let mut digest = Digest::default();
        snapshot.digest(&mut digest);
        self.snapshots.push(digest.hex());
        if snapshot.step.is_multiple_of(STEPS_A_PICTURE) {
            let [width, height] = PICTURE;
            self.pictures
                .push(frame::draw(snapshot, &Look::default(), width, height).hash());
        }
    }

    /// The first step in which two differ.
    fn parts_from(&self, other: &Self) -> Option<usize> {
        (0..self.snapshots.len().max(other.snapshots.len()))
            .find(|&step| self.snapshots.get(step) != other.snapshots.get(step))
    }
}

/// What is asked for at which step; hands are begun before.
fn asked(step: u64) -> Vec<Command> {
    let cable = |device: &str, connected| Command::Touch {
        device: device.to_owned(),
        touch: Touch::Cable { connected },
    };
    match step {
        260 => vec![Command::Edit(EditCommand::StoreKey { secs: 0.75 })],
        270 => vec![Command::Network(NetworkEdit::Commands(
            "SEND TRUE TO <1>root_page;".to_owned(),
        ))],
        280 => vec![Command::Undo, Command::Puppet(PuppetCommand::Arm)],
        300 => vec![Command::Transport(TransportCommand::Play)],
        330 => vec![cable(TABLET, false)],
        390 => vec![Command::Puppet(PuppetCommand::Play)],
        420 => vec![cable(TABLET, true)],
        520 => vec![Command::Puppet(PuppetCommand::Follow)],
        640 => vec![Command::Puppet(PuppetCommand::Stop)],
        _ => Vec::new(),
    }
}

const STEPS: u64 = 760;

/// Plays the session on the bench. Gives what came out, the journal, and how many rows of joints moved.
fn perform() -> (Outcome, Journal) {
    let journal = Journal::new();
    let mut options = WorldOptions::new(show());
    options.journal = Some(Box::new(journal.clone()));
    let mut world = World::new(options).expect("the bench stands");
    let mut outcome = Outcome::new();
    outcome.take(world.seen());
    let hands = world.hands();
    let turn = |control, counts| Movement::Turn {
        control,
        by: Turn::Counts(counts),
        over_secs: 0.4,
    };
    for (control, after_secs, counts) in [(0, 1.6, 60), (3, 1.8, -25), (5, 2.0, 40), (1, 5.3, 90)] {
        hands.begin(DIAL_BOX, after_secs, turn(control, counts));
    }
    hands.begin(
        DIAL_BOX,
        2.2,
        Movement::Press {
            control: 1,
            for_secs: 0.1,
        },
    );
    hands.begin(TABLET, 1.9, Movement::Take(Tool::Puck));
    hands.begin(
        TABLET,
        1.95,
        Movement::Glide {
            to: [0.2, -0.4],
            over_secs: 0.3,
        },
    );
    hands.begin(
        TABLET,
        2.3,
        Movement::Click {
            button: 1,
            for_secs: 0.1,
        },
    );
    for step in 0..STEPS {
        if step == 450 {
            world.stall(0.13);
        }
        if step == 480 {
            world
                .stand()
                .fault("upper", "drop 10% for 300ms")
                .expect("a bus and a fault");
        }
        let seen = Arc::clone(world.step(asked(step)));
        outcome.take(&seen);
    }
    assert_eq!(world.take_refused(), []);
    let moved = |joint: &rig::JointView| joint.measured_rad.is_some_and(|angle| angle.abs() > 0.01);
    let puppet = world.seen().puppet.clone().expect("a puppet");
    assert!(puppet.joints.iter().any(moved), "the session moves nothing");
    world.close();
    (outcome, journal)
}

/// Plays a journal without any device.
fn play_again(text: &str) -> (Outcome, Option<Ending>, Option<Ending>) {
    let mut script = Script::parse(text).expect("a whole journal");
    let profiles = Arc::new(Profiles::builtin());
    let clock = VirtualClock::new();
    let journal = Journal::new();
    let recorder = Recorder::new(Box::new(journal.clone()), script.show.clone());
    let ports = RecordingPorts::new(Box::new(script.take_ports()), recorder.clone());
    let equipment = Equipment {
        puppet: show().puppet,
        ..Equipment::default()
    };
    let options = RigOptions {
        show: show(),
        folder: None,
        profiles: Arc::clone(&profiles),
        inputs: equipment.inputs(),
        calibrations: Store::knowing(script.calibrated.clone()),
        puppet: equipment
            .puppet(&profiles, Pace::WithTheRig, PERIOD)
            .expect("a puppet"),
        recorder: Some(recorder),
    };
    let mut rig = Rig::new(Arc::new(clock.clone()), Box::new(ports), options).expect("it begins");
    let mut outcome = Outcome::new();
    for step in &script.steps {
        clock.sleep_until(step.now);
        outcome.take(&rig.step(&mut step.commands.iter().cloned()));
    }
    rig.close();
    let again = Script::parse(&journal.text()).expect("a whole journal");
    (outcome, script.ending, again.ending)
}

#[test]
fn a_session_repeats_itself_and_its_journal_repeats_it() {
    let (first, journal) = perform();
    let (second, journal_again) = perform();
    assert_eq!(first.parts_from(&second), None, "two runs part at this step");
    assert_eq!(first.pictures, second.pictures);
    assert!(journal.text() == journal_again.text(), "the journals differ");
    assert_eq!(journal.hash(), journal_again.hash());

    let (replayed, recorded, again) = play_again(&journal.text());
    assert_eq!(first.parts_from(&replayed), None, "the replay parts at this step");
    assert_eq!(first.pictures, replayed.pictures);
    let recorded = recorded.expect("the recording was closed");
    assert!(
        recorded.written.len() >= 4,
        "box, tablet and two buses were written to"
    );
    assert_eq!(Some(recorded), again);
    let different: std::collections::BTreeSet<_> = first.pictures.iter().collect();
    assert!(different.len() > 8, "the pictures show nothing happening");
}

#[test]
fn a_journal_that_was_cut_is_refused_or_said_to_have_no_end() {
    let (_, journal) = perform();
    let text = journal.text();
    let half = &text[..text.len() / 2];
    match Script::parse(half) {
        Err(error) => assert!(error.to_string().starts_with("line "), "{error}"),
        Ok(script) => assert_eq!(script.ending, None),
    }
    let whole_lines = half.rsplit_once('\n').expect("many lines").0;
    let script = Script::parse(whole_lines).expect("whole lines are read");
    assert_eq!(script.ending, None);
    assert!(Script::parse("").is_ok_and(|script| script.steps.is_empty()) || Script::parse("").is_err());
}
