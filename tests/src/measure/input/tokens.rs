//! Bytes to network tokens: a whole step of the rig that finds one report at a line in memory.

use super::super::rig_step::nanos_per;
use super::frames::{Layout, MEASURED};
use device::transport::memory::reports::{ReportDevice, ReportTransport, pair};
use device::transport::{Transport, TransportError};
use device::{Clock, VirtualClock};
use rig::controls_calibration::Store;
use rig::{Command, Found, InputSpec, Ports, Rig, RigOptions, Snapshot};
use std::hint::black_box;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Between two steps.
pub(super) const STEP: Duration = Duration::from_millis(10);
/// Steps in one repetition.
const STEPS: usize = 100;
/// Steps after which everything has the size it keeps.
const SETTLED: usize = 600;

/// One line in memory, given out once.
struct OneLine(Option<ReportTransport>);

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

/// A rig with the shipped show, and a device at its line.
pub(super) struct Heard {
    rig: Rig,
    clock: VirtualClock,
    line: ReportDevice,
    reports: Vec<Vec<u8>>,
    next: usize,
}

impl Heard {
    pub(super) fn new(layout: &Layout) -> anyhow::Result<Self> {
        let profiles = Arc::new(layout.profiles()?);
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shows/salute");
        let (near, line) = pair("sim:measured");
        let clock = VirtualClock::new();
        let options = RigOptions {
            show: rig::document::load(&folder)?.show,
            folder: None,
            profiles,
            inputs: vec![InputSpec {
                name: MEASURED.to_owned(),
                profile: MEASURED.to_owned(),
                address: "sim:measured".to_owned(),
            }],
            calibrations: Store::in_memory(),
            puppet: None,
            recorder: None,
        };
        let rig = Rig::new(Arc::new(clock.clone()), Box::new(OneLine(Some(near))), options)?;
        let mut heard = Self {
            rig,
            clock,
            line,
            reports: layout.reports(),
            next: 0,
        };
        // The rig opens the line and begins.
        for _ in 0..10 {
            heard.step();
        }
        let before = events(&heard.step());
        heard.report();
        heard.report();
        let after = events(&heard.step());
        anyhow::ensure!(
            after > before,
            "{}: the rig heard nothing of two reports",
            layout.name
        );
        Ok(heard)
    }

    /// The device sends its next report.
    pub(super) fn report(&mut self) {
        if let Some(report) = self.reports.get(self.next % self.reports.len().max(1)) {
            self.line.report_at(report, self.clock.now());
        }
        self.next += 1;
    }

    /// A step, and the time that passes until the next.
    pub(super) fn step(&mut self) -> Arc<Snapshot> {
        self.clock.advance(STEP);
        self.rig.step(&mut std::iter::empty::<Command>())
    }

    /// Allocations of steps that hear a report, less those of steps that hear nothing: what is seen of a step is made
    /// anew in both.
    pub(super) fn allocations(&mut self) -> f64 {
        for _ in 0..SETTLED {
            self.report();
            self.step();
        }
        let mut count = |reports: bool| {
            let mut counted = 0;
            for _ in 0..STEPS {
                if reports {
                    self.report();
                }
                self.clock.advance(STEP);
                let rig = &mut self.rig;
                counted += allocation_counter::measure(|| {
                    black_box(rig.step(&mut std::iter::empty::<Command>()));
                })
                .count_total;
            }
            counted as f64 / STEPS as f64
        };
        // Still ones first: what moves goes on moving its picture for a moment.
        let still = count(false);
        count(true) - still
    }

    /// Nanoseconds of a step that hears one report.
    pub(super) fn nanos(&mut self) -> f64 {
        let mut nanos = 0.0;
        for _ in 0..STEPS {
            self.report();
            self.clock.advance(STEP);
            let rig = &mut self.rig;
            nanos += nanos_per(1, || {
                black_box(rig.step(&mut std::iter::empty::<Command>()));
            });
        }
        nanos / STEPS as f64
    }
}

/// Events of all devices so far.
pub(super) fn events(snapshot: &Snapshot) -> u64 {
    snapshot.devices.iter().map(|device| device.events).sum()
}
