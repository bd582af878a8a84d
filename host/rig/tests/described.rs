//! A device that no profile knows, captured and performed with: its own description is kept with what it said.

use std::sync::Arc;
use std::time::Duration;

use device::clock::{Clock, VirtualClock};
use device::transport::memory::reports::{ReportDevice, ReportTransport, pair};
use device::transport::{Transport, TransportError};
use device_profiles::Profiles;
use rig::capture::replay;
use rig::document::{NetworkFile, Show};
use rig::{Command, Found, NetworkEdit, NoteLevel, Plug, Ports, Rig, RigOptions, Snapshot, TakeCommand};

/// A multi-axis controller with one axis of eight bits.
const AXIS: [u8; 20] = [
    0x05, 1, 0x09, 8, 0xA1, 1, 0x09, 0x30, 0x15, 0, 0x26, 0xFF, 0, 0x75, 8, 0x95, 1, 0x81, 2, 0xC0,
];
const NAME: &str = "hid-1209-0001";
const PROGRAM: &str = "s := F:MULC; SEND 90 TO <2>s; SEND 'jump' TO <1>HID_1209_0001_MODE;
    CONNECT HID_1209_0001<1>:<1>s; CONNECT s<1>:<1>PUPPET.elbow_flex;";

/// A place where lines are plugged in, and taken by themselves.
#[derive(Clone, Default)]
struct Socket(Arc<std::sync::Mutex<Option<ReportTransport>>>);

impl Ports for Socket {
    fn list(&mut self) -> Vec<Found> {
        let plug = Plug {
            name: NAME.to_owned(),
            profile: None,
            slot: 1,
            baud: 0,
            identity: String::new(),
        };
        let found = Found {
            address: "/dev/hidraw0".to_owned(),
            plug: Some(plug),
            ..Found::default()
        };
        let there = self.0.lock().expect("nobody panics").is_some();
        there.then_some(found).into_iter().collect()
    }

    fn open(&mut self, address: &str, _baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        let line = self.0.lock().expect("nobody panics").take();
        match line {
            Some(line) => Ok(Box::new(line)),
            None => Err(TransportError::NotFound {
                address: address.to_owned(),
            }),
        }
    }
}

struct Desk {
    rig: Rig,
    clock: VirtualClock,
    socket: Socket,
    far: Option<ReportDevice>,
    seen: Arc<Snapshot>,
}

impl Desk {
    fn new() -> Self {
        let clock = VirtualClock::new();
        let socket = Socket::default();
        let show = Show {
            name: "arm".into(),
            puppet: Some("so-101".into()),
            networks: vec![Arc::new(NetworkFile {
                name: "arm".into(),
                text: PROGRAM.into(),
            })],
            ..Show::default()
        };
        let options = RigOptions {
            show,
            folder: None,
            profiles: Arc::new(Profiles::builtin()),
            inputs: Vec::new(),
            calibrations: rig::controls_calibration::Store::in_memory(),
            puppet: None,
            recorder: None,
        };
        let rig = Rig::new(Arc::new(clock.clone()), Box::new(socket.clone()), options).expect("it begins");
        let mut desk = Self {
            rig,
            clock,
            socket,
            far: None,
            seen: Arc::default(),
        };
        desk.plug();
        desk.wait(1.0);
        desk
    }

    fn plug(&mut self) {
        let (near, far) = pair("/dev/hidraw0");
        far.set_descriptor(&AXIS);
        *self.socket.0.lock().expect("nobody panics") = Some(near);
        self.far = Some(far);
    }

    fn step(&mut self, commands: &[Command]) {
        self.clock.advance(Duration::from_millis(10));
        self.seen = self.rig.step(&mut commands.iter().cloned());
    }

    fn wait(&mut self, secs: f64) {
        for _ in 0..(secs * 100.0) as u32 {
            self.step(&[]);
        }
    }

    fn push(&mut self, from: u8, to: u8) {
        for place in from..to {
            if let Some(far) = &self.far {
                far.report_at(&[place], self.clock.now());
            }
            self.step(&[]);
        }
    }

    fn take(&mut self, command: TakeCommand) {
        self.step(&[Command::Take(command)]);
        for _ in 0..6000 {
            match &self.seen.take {
                Some(take) if !take.recording => self.step(&[]),
                _ => return,
            }
        }
        panic!("its keys do not come: {:?}", self.seen.notes);
    }

    fn keys(&self, clip: &str) -> Vec<u64> {
        let show = Arc::clone(self.rig.show());
        let keys = &show.joint_clips.get(clip).expect("there is a clip").keys;
        let numbers = keys
            .iter()
            .flat_map(|key| [key.secs, key.angles_rad["elbow_flex"]].map(f64::to_bits));
        numbers.collect()
    }

    fn warnings(&self) -> Vec<String> {
        let notes = self.seen.notes.iter();
        let all = notes.filter(|note| note.level != NoteLevel::Info);
        all.map(|note| note.text.clone()).collect()
    }
}

/// Its reports bear the time of the step before the one that hears them.
#[test]
fn a_take_of_it_is_done_again_without_a_profile() {
    let mut desk = Desk::new();
    desk.push(128, 150);
    // On another line than that on which it described itself.
    desk.far = None;
    desk.wait(0.3);
    desk.plug();
    desk.wait(1.5);
    desk.push(128, 140);
    desk.take(TakeCommand::Start {
        name: "wave".into(),
        devices: Vec::new(),
        tolerance: None,
    });
    desk.push(140, 200);
    desk.far = None;
    desk.wait(0.5);
    desk.plug();
    desk.wait(1.5);
    desk.push(60, 90);
    desk.take(TakeCommand::Stop);
    let told = desk.warnings();
    assert!(
        !told.iter().any(|it| it.contains("not quite what was seen")),
        "{told:?}"
    );
    let first = desk.keys("wave");
    assert!(first.len() > 6, "{first:?}");
    let again = |clip: &str| TakeCommand::Rerun {
        take: "wave".into(),
        clip: Some(clip.into()),
        tolerance: None,
    };
    desk.take(again("again"));
    assert_eq!(desk.keys("again"), first);
    desk.step(&[Command::Network(NetworkEdit::Commands("SEND 45 TO <2>s;".into()))]);
    desk.take(again("other"));
    assert_ne!(desk.keys("other"), first);
}

#[test]
fn a_capture_of_it_plays_back_by_its_own_description() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = Desk::new();
    desk.rig.keep_captures_in(folder.path().to_owned());
    desk.push(128, 140);
    desk.step(&[Command::StartCapture { devices: Vec::new() }]);
    desk.push(140, 160);
    desk.step(&[Command::StopCapture { devices: Vec::new() }]);
    let file = folder.path().join(format!("{NAME}-1.txt"));
    let text = std::fs::read_to_string(&file).expect("it was written");
    let played = replay(&file, &text, None, &Profiles::builtin());
    let played = played
        .map_err(|errors| format!("{errors:?}\n{text}"))
        .expect("it can be played");
    assert!(played.differences.is_empty(), "{:?}\n{text}", played.differences);
    let moved = played.events.iter();
    let moved = moved.filter(|it| matches!(it.what, rig::listen::InputEvent::Axis { .. }));
    assert_eq!(moved.count(), 32);
}
