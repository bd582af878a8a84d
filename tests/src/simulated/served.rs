//! Simulated firmware behind a pseudo-terminal, kept going by a thread, so that any program can open it like a
//! serial port.

use super::Wired;
use device::transport::TransportError;
use device::transport::pty::Pty;
use device::{Clock, Instant, MonotonicClock, Transport};
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// Longest sleep while an answer may be on its way.
const LOOK: Duration = Duration::from_micros(500);
/// Longest sleep on a quiet line: how late the end is noticed. What the host sends wakes the thread at once.
const QUIET: Duration = Duration::from_millis(20);
/// A line is quiet when so long nothing was said.
const QUIET_AFTER: Duration = Duration::from_millis(50);
/// The kernel wakes a sleeper up to 50 us late by default to save power; a wire is not late.
const TIMER_SLACK_NANOS: u64 = 1_000;

/// A device behind a pseudo-terminal. Dropping it is pulling the plug.
pub struct Served<F> {
    path: PathBuf,
    device: Arc<Mutex<F>>,
    clock: MonotonicClock,
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl<F: Wired> Served<F> {
    /// Serves `device` from now on.
    pub fn start(device: F) -> Result<Self, TransportError> {
        let pty = Pty::open()?;
        let path = pty.path().to_owned();
        let device = Arc::new(Mutex::new(device));
        let clock = MonotonicClock::new();
        let ended = Arc::new(AtomicBool::new(false));
        let server = Server {
            pty,
            device: Arc::clone(&device),
            clock,
            ended: Arc::clone(&ended),
        };
        Ok(Self {
            path,
            device,
            clock,
            ended,
            thread: Some(std::thread::spawn(move || server.run())),
        })
    }

    /// What a program opens.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The same as text; names of pseudo-terminals are ASCII.
    pub fn path_text(&self) -> String {
        self.path.to_string_lossy().into_owned()
    }

    /// Does something to the device now, or looks at it.
    pub fn with<T>(&self, act: impl FnOnce(&mut F, u64) -> T) -> T {
        let mut device = self.device.lock().unwrap_or_else(PoisonError::into_inner);
        act(&mut device, self.clock.now().as_micros())
    }
}

impl<F> Drop for Served<F> {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // A panic in the thread has been printed; a test that minds has failed of it already.
            let _ = thread.join();
        }
    }
}

struct Server<F> {
    pty: Pty,
    device: Arc<Mutex<F>>,
    clock: MonotonicClock,
    ended: Arc<AtomicBool>,
}

impl<F: Wired> Server<F> {
    fn run(mut self) {
        // Only exactness is lost where the kernel refuses.
        let _ = rustix::thread::set_current_timer_slack(NonZeroU64::new(TIMER_SLACK_NANOS));
        let mut spoken = Instant::ZERO;
        let mut baud = None;
        let mut heard = [0_u8; 4096];
        let mut said = Vec::with_capacity(4096);
        while !self.ended.load(Ordering::Relaxed) {
            // An error is nobody holding the other side, or the terminal gone: look again later.
            let count = self.pty.read(&mut heard).unwrap_or_default();
            let now = self.clock.now();
            let now_us = now.as_micros();
            let host_baud = self.pty.host_baud();
            said.clear();
            let whole = {
                let mut device = self.device.lock().unwrap_or_else(PoisonError::into_inner);
                if let Some(host_baud) = host_baud.filter(|_| host_baud != baud) {
                    device.set_line_baud(now_us, host_baud);
                    baud = Some(host_baud);
                }
                device.receive(now_us, heard.get(..count).unwrap_or_default());
                device.transmit(now_us, &mut said);
                device.whole_us(now_us)
            };
            if !said.is_empty() && self.pty.write(&said).is_err() {
                // As on a wire with nothing at its end.
                said.clear();
            }
            if count > 0 || !said.is_empty() {
                spoken = now;
            }
            let quiet = now.since(spoken) > QUIET_AFTER;
            let look = now.after(if quiet { QUIET } else { LOOK });
            let next = whole.map_or(look, |us| Instant::from_nanos((us + 1) * 1000).min(look));
            self.pty.wait(&self.clock, next);
        }
    }
}
