//! Simulated buses behind TCP or pseudo-terminals whose answers come when the wire has carried them, to the microsecond.
//!
//! One thread serves them all. An answer is handed over in one piece when its last byte is out, as a good adapter does.
//! A wire does not sleep, but a thread does, and is woken tens of microseconds late, which at 4 Mbaud is a tenth of a
//! cycle. So the thread is awake when something is due, and for a while after an answer, when the next question comes.
//!
//! A link takes time of its own, which is no part of any wire: 7 us there and back by TCP inside the machine, always
//! the same; by a pseudo-terminal, where a worker of the kernel hands bytes over, 28 to 40 us. It is measured first, both
//! ends awake (module `channel`), and an answer is handed over that much earlier, so that a program has it when the
//! wire would have carried it. The quickest quarter counts, so that it comes rather late than early.

use super::{Setup, Way, channel};
use device::transport::pty::Pty;
use device::transport::tcp::{self, TcpTransport};
use device::transport::{Awaited, LINES_MAX, Transport, TransportError, wait_any};
use device::{Clock, Instant, MonotonicClock};
use device_profiles::{Profiles, ServoProfile};
use firmware_sim::servo_bus::{BusOptions, Unit};
use firmware_sim::{Fault, Firmware, ServoBus};
use std::net::TcpListener;
use std::num::NonZeroU64;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

/// So long before something is due the thread is awake.
const AWAKE: Duration = Duration::from_micros(150);
/// So long after an answer it listens for the next question without sleeping.
const ATTENTIVE: Duration = Duration::from_micros(500);
/// So much later than reckoned the simulated bus may have heard a question.
const ROUNDING: Duration = Duration::from_micros(3);
/// Longest sleep on quiet wires: how late the end is noticed. What the host sends wakes the thread at once.
pub(super) const QUIET: Duration = Duration::from_millis(20);

/// Served buses. Dropping it is pulling the plugs.
pub(super) struct Far {
    paths: Vec<String>,
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// How programs reach a bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Link {
    /// A pseudo-terminal, which programs take for a serial port.
    Terminal,
    /// A connection inside this machine: nearly nothing beside the wire, and no worker of the kernel.
    Tcp,
}

/// This side of a link.
pub(super) enum Socket {
    Terminal(Pty),
    Listening(TcpListener),
    Connected(TcpTransport),
}

struct End {
    socket: Socket,
    bus: ServoBus,
    /// What the link itself takes, there and back.
    channel: Duration,
    /// Time of a byte.
    byte: Duration,
    /// The answer that is on the wire.
    said: Vec<u8>,
    /// When there is something to do; none: when the host says something.
    due: Option<Instant>,
    /// Until when the host's next question is listened for without sleeping.
    attentive_until: Instant,
}

impl Far {
    /// One bus for each setup.
    pub(super) fn start(link: Link, setups: &[Setup]) -> anyhow::Result<Self> {
        Self::start_with(link, setups, None)
    }

    /// The same, with something wrong.
    pub(super) fn start_with(link: Link, setups: &[Setup], fault: Option<&str>) -> anyhow::Result<Self> {
        let mut ends = Vec::new();
        let mut paths = Vec::new();
        for setup in setups {
            let mut bus = setup.bus()?;
            if let Some(fault) = fault {
                bus.inject(0, &Fault::parse(fault)?);
            }
            let (socket, path) = link.open()?;
            paths.push(path);
            ends.push(End {
                socket,
                channel: channel::there_and_back(link)?,
                bus,
                byte: Duration::from_secs(10) / setup.baud,
                said: Vec::with_capacity(4096),
                due: None,
                attentive_until: Instant::ZERO,
            });
        }
        let ended = Arc::new(AtomicBool::new(false));
        let told = Arc::clone(&ended);
        Ok(Self {
            paths,
            ended,
            thread: Some(std::thread::spawn(move || serve(&mut ends, &told))),
        })
    }

    /// What a program opens.
    pub(super) fn paths(&self) -> &[String] {
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
    while !ended.load(Ordering::Relaxed) {
        for end in ends.iter_mut() {
            // An error is nobody holding the other side: look again later.
            let _ = end.carry(&clock);
        }
        let now = clock.now();
        let due = ends.iter().filter_map(|end| end.due).min();
        let until = due.unwrap_or(now.after(QUIET));
        let attentive = ends.iter().any(|end| now < end.attentive_until);
        if !attentive && until.since(now) > AWAKE {
            let until = Instant::from_nanos(until.as_nanos() - AWAKE.as_nanos() as u64);
            let mut looked = [false; LINES_MAX];
            let mut lines: [Option<Awaited<'_>>; LINES_MAX] = [const { None }; LINES_MAX];
            let open = ends.iter_mut().filter_map(|end| end.socket.line());
            for ((place, transport), looked) in lines.iter_mut().zip(open).zip(&mut looked) {
                *place = Some(Awaited {
                    transport,
                    from: Instant::ZERO,
                    alert_until: Instant::ZERO,
                    looked,
                });
            }
            wait_any(&mut lines, &clock, until);
        }
    }
}

impl Link {
    /// For people.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Terminal => "a pseudo-terminal",
            Self::Tcp => "TCP",
        }
    }

    /// This side of a new one, and what a program opens.
    pub(super) fn open(self) -> anyhow::Result<(Socket, String)> {
        Ok(match self {
            Self::Terminal => {
                let pty = Pty::open()?;
                let path = pty.path().to_string_lossy().into_owned();
                (Socket::Terminal(pty), path)
            }
            Self::Tcp => {
                let listener = tcp::listen("127.0.0.1:0")?;
                let path = format!("tcp:{}", listener.local_addr()?);
                (Socket::Listening(listener), path)
            }
        })
    }
}

impl Socket {
    /// The line, once somebody has opened the other side.
    pub(super) fn line(&mut self) -> Option<&mut dyn Transport> {
        if let Self::Listening(listener) = self {
            let connected = tcp::accept(listener).ok().flatten()?;
            *self = Self::Connected(connected);
        }
        match self {
            Self::Terminal(pty) => Some(pty),
            Self::Connected(stream) => Some(stream),
            Self::Listening(_) => None,
        }
    }
}

impl End {
    /// Whatever has come and is due.
    fn carry(&mut self, clock: &MonotonicClock) -> Result<(), TransportError> {
        let mut heard = [0_u8; 4096];
        let Some(line) = self.socket.line() else {
            return Ok(());
        };
        let count = line.read(&mut heard)?;
        let now = clock.now();
        if count > 0 {
            let heard = heard.get(..count).unwrap_or_default();
            self.bus.receive(now.as_micros(), heard);
            self.said.clear();
            // Nobody answers before the question is out, and the simulated bus counts whole microseconds.
            self.due = Some(now.after(self.byte * count as u32 + ROUNDING));
            return Ok(());
        }
        if self.due.is_none_or(|due| now < due) {
            return Ok(());
        }
        if self.said.is_empty() {
            self.due = self.reckon(now);
            return Ok(());
        }
        self.due = None;
        line.write(&self.said)?;
        self.said.clear();
        self.attentive_until = clock.now().after(ATTENTIVE);
        Ok(())
    }

    /// The whole answer to a question that is out, worked out while the wire would carry it, and when to hand it over.
    fn reckon(&mut self, now: Instant) -> Option<Instant> {
        let mut until_us = now.as_micros();
        // Each answer is known once the one before it is out.
        loop {
            self.bus.receive(until_us, &[]);
            match self.bus.statuses().last().map(|status| status.last_us + 1) {
                Some(last_us) if last_us > until_us => until_us = last_us,
                _ => break,
            }
        }
        self.bus.transmit(until_us, &mut self.said);
        let there_us = until_us.saturating_sub(self.channel.as_micros() as u64);
        (!self.said.is_empty()).then_some(Instant::from_nanos(there_us * 1000))
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
