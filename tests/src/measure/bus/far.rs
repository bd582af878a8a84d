//! Simulated buses behind pseudo-terminals whose answers come when the wire has carried them, to the microsecond.
//!
//! One thread serves them all. An answer is handed over in one piece when its last byte is out, as a good adapter does.
//! The thread sleeps until shortly before and then stays awake, for a sleeper is woken tens of microseconds late,
//! which at 4 Mbaud is a tenth of a cycle.

use super::{Setup, Way};
use device::transport::pty::Pty;
use device::transport::{Awaited, LINES_MAX, Transport, TransportError, wait_any};
use device::{Clock, Instant, MonotonicClock};
use device_profiles::{Profiles, ServoProfile};
use firmware_sim::servo_bus::{BusOptions, Unit};
use firmware_sim::{Fault, Firmware, ServoBus};
use std::num::NonZeroU64;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

/// So long before something is due the thread is awake.
const AWAKE: Duration = Duration::from_micros(80);
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
    /// Time of a byte.
    byte: Duration,
    /// When there is something to do; none: when the host says something.
    due: Option<Instant>,
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
                byte: Duration::from_secs(10) / setup.baud,
                due: None,
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
    // Only exactness is lost where the kernel refuses.
    let _ = rustix::thread::set_current_timer_slack(NonZeroU64::new(super::TIMER_SLACK_NANOS));
    let clock = MonotonicClock::new();
    let mut said = Vec::with_capacity(4096);
    while !ended.load(Ordering::Relaxed) {
        for end in ends.iter_mut() {
            // An error is nobody holding the other side: look again later.
            let _ = end.carry(&clock, &mut said);
        }
        let now = clock.now();
        let due = ends.iter().filter_map(|end| end.due).min();
        let until = due.unwrap_or(now.after(QUIET));
        if until.since(now) > AWAKE {
            let until = Instant::from_nanos(until.as_nanos() - AWAKE.as_nanos() as u64);
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
            wait_any(&mut lines, &clock, until);
        }
    }
}

impl End {
    /// Whatever has come and is due.
    fn carry(&mut self, clock: &MonotonicClock, said: &mut Vec<u8>) -> Result<(), TransportError> {
        let mut heard = [0_u8; 4096];
        let count = self.pty.read(&mut heard)?;
        let now = clock.now();
        let now_us = now.as_micros();
        self.bus.receive(now_us, heard.get(..count).unwrap_or_default());
        if count > 0 {
            // Nobody answers before the question is out.
            self.due = Some(now.after(self.byte * count as u32));
            return Ok(());
        }
        if self.due.is_none_or(|due| now < due) {
            return Ok(());
        }
        // Answers come one behind the other, so the last one known ends last.
        let ends_us = self.bus.statuses().last().map(|status| status.last_us);
        let ends = ends_us.map(|us| Instant::from_nanos((us + 1) * 1000));
        if let Some(ends) = ends.filter(|ends| *ends > now) {
            self.due = Some(ends);
            return Ok(());
        }
        said.clear();
        self.bus.transmit(now_us, said);
        self.due = None;
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
