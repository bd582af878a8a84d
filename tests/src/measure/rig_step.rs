//! What a whole step of the rig costs for one dial event, beside merely decoding the same bytes.
//!
//! The simulated box talks with the rig over a line in memory; its own doing and the moving of bytes are outside
//! the measured time. Rig, show and network are the shipped ones.

use super::{Row, Subject, Tell, repeated};
use device::codec::sgi_dial_box::SgiDialBox as DialCodec;
use device::transport::memory::{MemoryTransport, pair};
use device::transport::{Transport, TransportError};
use device::{Clock, Codec, MonotonicClock, VirtualClock};
use device_profiles::Profiles;
use firmware_sim::{Firmware, SgiDialBox};
use rig::controls_calibration::Store;
use rig::{Command, Found, InputSpec, Ports, Rig, RigOptions, Snapshot};
use std::hint::black_box;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Name of the measure.
pub const NAME: &str = "rig-step";

/// Key of the box's profile.
const BOX: &str = "sgi-dialbox-display";
/// One report is three bytes, 3.1 ms at 9600 baud: between two steps of 10 ms it has always arrived whole.
const STEP: Duration = Duration::from_millis(10);
/// Longest time for box and rig to get to know each other, lamps and twenty labels included: 220 bytes at 1 ms.
const MEETING_STEPS: usize = 200;
const STEPS_A_ROUND: usize = 200;
const ROUNDS: usize = 51;

/// Nanoseconds that `act` took for each of `count` things.
pub(crate) fn nanos_per(count: usize, act: impl FnOnce()) -> f64 {
    let clock = MonotonicClock::new();
    let began = clock.now();
    act();
    clock.now().since(began).as_secs_f64() * 1e9 / count as f64
}

/// A rig with the shipped show, and the simulated box at its line.
pub struct DialRig {
    rig: Rig,
    clock: VirtualClock,
    dial_box: SgiDialBox,
    far: MemoryTransport,
    bytes: Vec<u8>,
}

/// One line in memory, given out once.
struct OneLine(Option<MemoryTransport>);

impl Ports for OneLine {
    fn list(&mut self) -> Vec<Found> {
        Vec::new()
    }

    fn open(&mut self, address: &str, _baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        match self.0.take() {
            Some(line) => Ok(Box::new(line)),
            None => Err(TransportError::NotFound {
                address: address.to_owned(),
            }),
        }
    }
}

impl DialRig {
    /// Sets both up and lets them talk until the box reports and everything has been shown on it.
    pub fn new() -> anyhow::Result<Self> {
        let profiles = Arc::new(Profiles::builtin());
        let show = rig::document::load(&shows().join("salute"))?.show;
        let (near, far) = pair();
        let clock = VirtualClock::new();
        let input = InputSpec {
            name: "dials".to_owned(),
            profile: BOX.to_owned(),
            address: "sim:dials".to_owned(),
        };
        let options = RigOptions {
            show,
            folder: None,
            profiles: Arc::clone(&profiles),
            inputs: vec![input],
            calibrations: Store::in_memory(),
            puppet: None,
            recorder: None,
        };
        let dial_box = SgiDialBox::new(profiles.input(BOX)?.into());
        let ports = Box::new(OneLine(Some(near)));
        let rig = Rig::new(Arc::new(clock.clone()), ports, options)?;
        let mut rig = Self {
            rig,
            clock,
            dial_box,
            far,
            bytes: Vec::new(),
        };
        for _ in 0..MEETING_STEPS {
            rig.move_bytes();
            rig.step();
        }
        let before = heard(&rig.step());
        rig.turn(0);
        let after = heard(&rig.step());
        anyhow::ensure!(
            after == before + 1,
            "the rig heard {} dial events, expected 1",
            after - before
        );
        Ok(rig)
    }

    /// Turns dial `control` by a count and brings the report to the rig's line. Returns it.
    pub fn turn(&mut self, control: u8) -> &[u8] {
        let now_us = self.clock.now().as_micros();
        self.dial_box.turn(now_us, control, 1, 0);
        self.move_bytes()
    }

    /// The step that hears it.
    pub fn step(&mut self) -> Arc<Snapshot> {
        self.rig.step(&mut std::iter::empty::<Command>())
    }

    /// Lets time pass and the line carry what is on it.
    fn move_bytes(&mut self) -> &[u8] {
        let mut asked = [0; 4096];
        let count = self.far.read(&mut asked).unwrap_or(0);
        let now_us = self.clock.now().as_micros();
        self.dial_box
            .receive(now_us, asked.get(..count).unwrap_or_default());
        self.clock.advance(STEP);
        self.bytes.clear();
        self.dial_box
            .transmit(self.clock.now().as_micros(), &mut self.bytes);
        // The rig holds the other end as long as this exists.
        let _ = self.far.write(&self.bytes);
        &self.bytes
    }
}

/// Events of all input devices so far.
fn heard(snapshot: &Snapshot) -> u64 {
    snapshot.devices.iter().map(|device| device.events).sum()
}

/// Where the shipped shows lie.
fn shows() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shows")
}

/// A codec that hears the box's reports from the middle of a conversation.
pub fn listening_codec() -> anyhow::Result<DialCodec> {
    Ok(DialCodec::listening(Profiles::builtin().input(BOX)?))
}

/// Takes the measure.
pub fn take(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    let reports = reports()?;
    let mut turned = DialRig::new()?;
    let mut idle = DialRig::new()?;
    let mut codec = listening_codec()?;
    let mut subjects = [
        Subject {
            row: "bare decode of one dial report".to_owned(),
            name: "codec",
            repeat: Box::new(|| Ok(decode(&mut codec, &reports))),
        },
        Subject {
            row: "step that hears one dial report".to_owned(),
            name: "dialrig",
            repeat: Box::new(|| Ok(steps(&mut turned, true))),
        },
        Subject {
            row: "step that hears nothing".to_owned(),
            name: "dialrig",
            repeat: Box::new(|| Ok(steps(&mut idle, false))),
        },
    ];
    let taken = repeated(&mut subjects, ROUNDS)?;
    let decoded = taken.first().map_or(f64::NAN, |taken| taken.median);
    for (at, (subject, taken)) in subjects.iter().zip(taken).enumerate() {
        tell(&Row {
            measure: NAME,
            row: subject.row.clone(),
            subject: subject.name,
            value: taken.median,
            best: taken.least,
            unit: "ns",
            limit: (at > 0).then_some(decoded),
            ratio: (at > 0).then_some(taken.median / decoded),
        });
    }
    Ok(())
}

/// The reports of one round, as the rig hears them.
fn reports() -> anyhow::Result<Vec<Vec<u8>>> {
    let mut rig = DialRig::new()?;
    let report = |at: usize| {
        let bytes = rig.turn((at % 8) as u8).to_vec();
        rig.step();
        anyhow::ensure!(
            bytes.len() == 3,
            "expected one report of 3 bytes, found {bytes:02x?}"
        );
        Ok(bytes)
    };
    (0..STEPS_A_ROUND).map(report).collect()
}

fn decode(codec: &mut DialCodec, reports: &[Vec<u8>]) -> f64 {
    // Often enough that reading the clock does not count.
    const TIMES: usize = 100;
    nanos_per(reports.len() * TIMES, || {
        for report in std::iter::repeat_n(reports, TIMES).flatten() {
            codec.decode(black_box(report), &mut |event| {
                black_box(event);
            });
        }
    })
}

fn steps(rig: &mut DialRig, turning: bool) -> f64 {
    let mut nanos = 0.0;
    for at in 0..STEPS_A_ROUND {
        if turning {
            rig.turn((at % 8) as u8);
        } else {
            rig.move_bytes();
        }
        nanos += nanos_per(1, || {
            black_box(rig.step());
        });
    }
    nanos / STEPS_A_ROUND as f64
}
