//! The network edited while the rig steps: undone without loss, looked at, saved, and replayed.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use device::transport::{Transport, TransportError};
use device::{Clock, VirtualClock};
use ps300::value::Value;
use rig::controls_calibration::Store;
use rig::document::{self, NetworkFile, Show};
use rig::journal::{Digest, Recorder, Script};
use rig::{Command, Found, Live, NetworkEdit, NetworkLook, Ports, Profiles, Rig, RigOptions, Snapshot};

/// A clock that streams into a sum, and beside it something to edit.
const NETWORK: &str = "{ beats }
beat := F:CLTICKS; sum := F:ACCUMULATE; CONNECT beat<1>:<1>sum;
gain := F:MULC; SEND 2 TO <2>gain; VARIABLE out; CONNECT sum<1>:<1>gain; CONNECT gain<1>:<1>out;
";

struct NoPorts;

impl Ports for NoPorts {
    fn list(&mut self) -> Vec<Found> {
        Vec::new()
    }

    fn open(&mut self, address: &str, _baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        Err(TransportError::NotFound {
            address: address.to_owned(),
        })
    }
}

/// Text that several hold.
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

impl std::io::Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().expect("nobody panics").extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

struct Stage {
    rig: Rig,
    clock: VirtualClock,
    seen: Arc<Snapshot>,
}

impl Stage {
    fn new(recorder: Option<Recorder>) -> Self {
        let show = Show {
            name: "edits".into(),
            networks: vec![Arc::new(NetworkFile {
                name: "beats".into(),
                text: NETWORK.into(),
            })],
            ..Show::default()
        };
        let clock = VirtualClock::new();
        let options = RigOptions {
            show,
            folder: None,
            profiles: Arc::new(Profiles::builtin()),
            inputs: Vec::new(),
            calibrations: Store::in_memory(),
            puppet: None,
            recorder,
        };
        let rig = Rig::new(Arc::new(clock.clone()), Box::new(NoPorts), options).expect("it begins");
        let mut stage = Self {
            rig,
            clock,
            seen: Arc::default(),
        };
        stage.ask(Command::LookAtNetwork(true));
        stage
    }

    fn ask(&mut self, command: Command) -> &Snapshot {
        self.clock.advance(Duration::from_millis(10));
        self.seen = self.rig.step(&mut std::iter::once(command));
        &self.seen
    }

    fn edit(&mut self, edit: NetworkEdit) -> &Snapshot {
        self.ask(Command::Network(edit))
    }

    fn commands(&mut self, text: &str) -> &Snapshot {
        self.edit(NetworkEdit::Commands(text.to_owned()))
    }

    fn wait(&mut self, steps: u32) {
        for _ in 0..steps {
            self.clock.advance(Duration::from_millis(10));
            self.seen = self.rig.step(&mut std::iter::empty());
        }
    }

    fn look(&self) -> &NetworkLook {
        self.seen.network.as_ref().expect("somebody looks")
    }

    /// What waits at or is held by the first input of a box.
    fn front(&self, name: &str) -> Option<f64> {
        let look = self.look();
        let shown = &look.picture.boxes[look.picture.find(&name.into())?];
        let front = look.activity.inputs[shown.first_input].front.as_ref();
        front.and_then(Value::as_number)
    }
}

/// The sum of all beats from 0 to `last`.
fn beats(last: f64) -> f64 {
    last * (last + 1.0) / 2.0
}

#[test]
fn undo_brings_back_what_an_edit_lost_and_nothing_else_notices() {
    let mut stage = Stage::new(None);
    stage.wait(9);
    assert_eq!(stage.front("out"), Some(2.0 * beats(9.0)));
    let words = stage.commands("DELETE gain; sum := F:NOP;").undo.clone();
    assert_eq!(words.as_deref(), Some("network commands"));
    stage.wait(1);
    assert!(stage.look().can_undo && stage.seen.unsaved);
    stage.edit(NetworkEdit::Undo);
    // Beats 0 to 9 before the edit; the two that came while the sum was away are gone.
    assert_eq!(stage.front("out"), Some(2.0 * (beats(9.0) + 12.0)));
    assert!(stage.look().can_redo && !stage.seen.unsaved);
    stage.edit(NetworkEdit::Redo);
    assert_eq!(stage.look().picture.find(&"gain".into()), None);
    stage.edit(NetworkEdit::Undo);
    let before = stage.front("out").expect("a number");
    for edit in ["SEND 3 TO <2>gain;", "other := F:NOP; CONNECT beat<1>:<1>other;"] {
        stage.commands(edit);
    }
    stage.edit(NetworkEdit::Undo);
    stage.edit(NetworkEdit::Undo);
    stage.wait(1);
    let after = stage.front("out").expect("a number");
    assert_eq!(
        after - before,
        2.0 * (15.0 + 16.0 + 17.0 + 18.0 + 19.0),
        "every beat was heard"
    );
}

#[test]
fn a_dragged_value_is_one_step() {
    let mut stage = Stage::new(None);
    for value in 3..9 {
        stage.commands(&format!("SEND {value} TO <2>gain;"));
    }
    stage.edit(NetworkEdit::Undo);
    assert!(!stage.look().can_undo);
    stage.wait(1);
    assert_eq!(stage.front("out"), Some(2.0 * beats(8.0)));
}

#[test]
fn a_program_edited_whole_is_one_step_and_errors_have_places() {
    let mut stage = Stage::new(None);
    stage.wait(3);
    assert_eq!(&*stage.look().text, NETWORK);
    let faulty = NETWORK.replace("CONNECT gain", "CONNECT again");
    let seen = stage.edit(NetworkEdit::Program(faulty));
    let look = seen.network.as_ref().expect("somebody looks");
    let places: Vec<(u32, u32)> = look.diagnostics.iter().map(|it| (it.line, it.column)).collect();
    assert_eq!(places, [(3, 74)], "{:?}", look.diagnostics);
    assert_eq!(&*look.text, NETWORK, "refused as a whole");
    assert!(
        seen.notes
            .iter()
            .any(|note| note.text.contains("did you mean gain"))
    );
    let text = NETWORK.replace("MULC; SEND 2", "ADDC; SEND 1000");
    stage.edit(NetworkEdit::Program(text.clone()));
    assert_eq!(stage.look().diagnostics.len(), 0);
    assert_eq!(&*stage.look().text, text, "with its comments");
    assert_eq!(stage.front("out"), Some(1000.0 + beats(5.0)));
    stage.edit(NetworkEdit::Undo);
    assert_eq!(stage.front("out"), Some(2.0 * beats(6.0)));
}

#[test]
fn what_is_frozen_counts_and_is_not_part_of_the_show() {
    let mut stage = Stage::new(None);
    let freeze = |on| NetworkEdit::Freeze {
        name: "gain".into(),
        output: 1,
        on,
    };
    stage.edit(freeze(true));
    stage.wait(2);
    let look = stage.look();
    let at = look.picture.boxes[look.picture.find(&"gain".into()).expect("is there")].first_output;
    assert_eq!(
        (
            look.activity.outputs[at].frozen,
            look.activity.outputs[at].withheld
        ),
        (true, 3)
    );
    assert!(!look.can_undo && !stage.seen.unsaved);
    stage.edit(freeze(false));
    assert_eq!(stage.front("out"), Some(2.0 * beats(4.0)));
}

#[test]
fn edits_are_saved_with_the_show() {
    let mut stage = Stage::new(None);
    stage.commands("extra := F:NOP; CONNECT nobody<1>:<1>extra;");
    stage.commands("CONNECT beat<1>:<1>extra;");
    let folder = tempfile::tempdir().expect("a folder");
    document::save(stage.rig.show(), folder.path()).expect("is written");
    let show = document::load(folder.path()).expect("is read").show;
    assert_eq!(
        &*show.patches, "extra := F:NOP;\nCONNECT beat<1>:<1>extra;",
        "without what was refused"
    );
    assert_eq!(show.networks[0].text, NETWORK);
}

#[test]
fn nothing_is_kept_ready_for_nobody() {
    let mut stage = Stage::new(None);
    stage.wait(1);
    let before = stage.look().clone();
    stage.edit(NetworkEdit::Commands("{ nothing }".into()));
    assert!(Arc::ptr_eq(&before.picture, &stage.look().picture));
    assert!(Arc::ptr_eq(&before.text, &stage.look().text));
    assert!(stage.ask(Command::LookAtNetwork(false)).network.is_none());
}

/// A session of edits; a digest of each snapshot.
fn session(recorder: Option<Recorder>) -> Vec<String> {
    let mut stage = Stage::new(recorder);
    let mut digests = Vec::new();
    let mut take = |seen: &Snapshot| {
        let mut digest = Digest::default();
        seen.digest(&mut digest);
        digests.push(digest.hex());
    };
    for step in 0..60_u32 {
        take(match step {
            5 => stage.commands("extra := F:ACCUMULATE; CONNECT beat<1>:<1>extra;"),
            15 => stage.commands("DELETE extra; SEND 7 TO <2>gain;"),
            20 | 30 => stage.ask(Command::Undo),
            25 => stage.ask(Command::Redo),
            35 => stage.edit(NetworkEdit::Program(NETWORK.replace("MULC", "ADDC"))),
            40 => stage.edit(NetworkEdit::Undo),
            _ => {
                stage.wait(1);
                &stage.seen
            }
        });
    }
    stage.rig.close();
    digests
}

#[test]
fn edits_replay() {
    let journal = Shared::default();
    let first = session(Some(Recorder::new(Box::new(journal.clone()), BTreeMap::new())));
    assert_eq!(first, session(None));
    let text = String::from_utf8(journal.0.lock().expect("nobody panics").clone()).expect("JSON");
    let script = Script::parse(&text).expect("a whole journal");
    let mut stage = Stage::new(None);
    for (step, digest) in script.steps.iter().skip(1).zip(&first) {
        stage.clock.sleep_until(step.now);
        let seen = stage.rig.step(&mut step.commands.iter().cloned());
        let mut again = Digest::default();
        seen.digest(&mut again);
        assert_eq!(&again.hex(), digest);
    }
}

#[test]
fn edits_through_the_running_rig_disturb_no_step() {
    let stage = Stage::new(None);
    let clock: Arc<dyn Clock> = Arc::new(stage.clock.clone());
    let steps: Arc<Mutex<Vec<Arc<Snapshot>>>> = Arc::default();
    let seen = Arc::clone(&steps);
    let allowed = Arc::new(AtomicUsize::new(1));
    let may = Arc::clone(&allowed);
    let live = Live::start(stage.rig, clock, move |snapshot| {
        let mut seen = seen.lock().expect("nobody panics");
        seen.push(Arc::clone(snapshot));
        let count = seen.len();
        drop(seen);
        // Virtual time would run away from the test.
        while count > may.load(Ordering::Relaxed) {
            std::thread::yield_now();
        }
    })
    .expect("the thread starts");
    let taken = || steps.lock().expect("nobody panics").len();
    live.send(Command::LookAtNetwork(true));
    for round in 0..200 {
        let name = round % 5;
        let edit = match round % 8 {
            0 | 3 => format!("f{name} := F:ACCUMULATE; CONNECT beat<1>:<1>f{name};"),
            1 => format!("CONNECT sum<1>:<1>f{name};"),
            5 => format!("DELETE f{name};"),
            _ => String::new(),
        };
        live.send(Command::Network(match round % 8 {
            2 | 6 => NetworkEdit::Undo,
            4 | 7 => NetworkEdit::Redo,
            _ => NetworkEdit::Commands(edit),
        }));
        let wanted = taken() + 3;
        allowed.store(wanted, Ordering::Relaxed);
        while taken() < wanted {
            std::thread::yield_now();
        }
    }
    allowed.store(usize::MAX, Ordering::Relaxed);
    live.close();
    let steps = steps.lock().expect("nobody panics");
    let last = steps.last().expect("it went on");
    for two in steps.windows(2) {
        assert_eq!(two[1].step, two[0].step + 1);
        assert!((two[1].at_secs - two[0].at_secs - 0.01).abs() < 1e-9);
    }
    let look = last.network.as_ref().expect("somebody looks");
    let out = look.picture.find(&"out".into()).expect("nobody deleted it");
    let held = &look.activity.inputs[look.picture.boxes[out].first_input].front;
    let sum = held.as_ref().and_then(Value::as_number);
    assert_eq!(
        sum,
        Some(2.0 * beats((last.step - 1) as f64)),
        "every beat was heard"
    );
}
