//! Simulated buses behind pseudo-terminals whose bytes come when the wire has carried them, to the microsecond.
//!
//! One thread serves them all. While anything is on a wire it does not sleep, for a sleeper is woken tens of
//! microseconds late, which at 4 Mbaud is a tenth of a cycle.

use super::{Setup, Way};
use device::transport::pty::Pty;
use device::transport::{Awaited, LINES_MAX, Transport, TransportError, wait_any};
use device::{Clock, Instant, MonotonicClock};
use device_profiles::{Profiles, ServoProfile};
use firmware_sim::servo_bus::{BusOptions, Unit};
use firmware_sim::{Fault, Firmware, ServoBus};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

/// So long after the last byte a wire counts as busy: longer than any answer takes to begin.
const BUSY: Duration = Duration::from_millis(6);
/// Longest sleep on quiet wires: how late the end is noticed. What the host sends wakes the thread at once.
pub(super) const QUIET: Duration = Duration::from_millis(20);

/// Served buses. Dropping it is pulling the plugs.
pub(crate) struct Far {
    paths: Vec<String>,
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

struct End {
    pty: Pty,
    bus: ServoBus,
    spoken: Instant,
}

impl Far {
    /// One bus for each setup.
    pub(crate) fn start(setups: &[Setup]) -> anyhow::Result<Self> {
        Self::start_with(setups, None)
    }

    /// The same, with something wrong.
    pub(crate) fn start_with(setups: &[Setup], fault: Option<&str>) -> anyhow::Result<Self> {
        let mut ends = Vec::new();
        for setup in setups {
            let mut bus = setup.bus()?;
            if let Some(fault) = fault {
                bus.inject(0, &Fault::parse(fault)?);
            }
            let pty = Pty::open()?;
            ends.push(End {
                pty,
                bus,
                spoken: Instant::ZERO,
            });
        }
        let paths = ends
            .iter()
            .map(|end| end.pty.path().to_string_lossy().into_owned())
            .collect();
        let ended = Arc::new(AtomicBool::new(false));
        let told = Arc::clone(&ended);
        Ok(Self {
            paths,
            ended,
            thread: Some(std::thread::spawn(move || serve(&mut ends, &told))),
        })
    }

    /// What a program opens.
    pub(crate) fn paths(&self) -> &[String] {
        &self.paths
    }
}

impl Drop for Far {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // A panic in the thread has been printed; a test that minds has failed of it already.
            let _ = thread.join();
        }
    }
}

fn serve(ends: &mut [End], ended: &AtomicBool) {
    let clock = MonotonicClock::new();
    let mut said = Vec::with_capacity(4096);
    while !ended.load(Ordering::Relaxed) {
        let mut busy = false;
        for end in ends.iter_mut() {
            // An error is nobody holding the other side: look again later.
            let _ = end.carry(&clock, &mut said);
            busy |= clock.now().since(end.spoken) < BUSY;
        }
        if !busy {
            let mut looked = [false; LINES_MAX];
            let mut lines: [Option<Awaited<'_>>; LINES_MAX] = [const { None }; LINES_MAX];
            for ((place, end), looked) in lines.iter_mut().zip(ends.iter_mut()).zip(&mut looked) {
                *place = Some(Awaited {
                    transport: &mut end.pty,
                    from: Instant::ZERO,
                    alert_until: Instant::ZERO,
                    looked,
                });
            }
            wait_any(&mut lines, &clock, clock.now().after(QUIET));
        }
    }
}

impl End {
    /// Whatever has come and is due.
    fn carry(&mut self, clock: &MonotonicClock, said: &mut Vec<u8>) -> Result<(), TransportError> {
        let mut heard = [0_u8; 4096];
        let count = self.pty.read(&mut heard)?;
        let now = clock.now();
        if count > 0 {
            self.bus
                .receive(now.as_micros(), heard.get(..count).unwrap_or_default());
        }
        said.clear();
        self.bus.transmit(now.as_micros(), said);
        if count > 0 || !said.is_empty() {
            self.spoken = now;
        }
        if said.is_empty() {
            return Ok(());
        }
        self.pty.write(said)
    }
}

impl Setup {
    /// The model of the servos.
    pub(crate) fn profile(self) -> anyhow::Result<ServoProfile> {
        let name = match self.way {
            Way::Sync | Way::Fast => "xl430-w250",
            Way::Sts => "sts3215",
        };
        Ok(Profiles::builtin().servo(name)?.clone())
    }

    /// Servos that answer at once.
    fn bus(self) -> anyhow::Result<ServoBus> {
        let options = BusOptions {
            baud: self.baud,
            ..BusOptions::default()
        };
        let mut bus = ServoBus::new(options);
        let profile = self.profile()?;
        for id in 1..=self.servos {
            let unit = Unit {
                return_delay_us: Some(0),
                ..Unit::new(id)
            };
            bus.add(&profile, unit)?;
        }
        Ok(bus)
    }
}
