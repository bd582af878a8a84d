//! One input device: a transport, the codec that understands it, and whether it is well.

mod steps;

use steps::Steps;

use crate::clock::{Clock, Instant};
use crate::codec::hid::{self, HidCodec};
use crate::codec::{self, Codec, Counters, Feedback, InputEvent, Stamped, Stand, Surface, UnknownFormat};
use crate::transport::{Closed, Transport, TransportError};
use device_profiles::InputProfile;
use std::time::Duration;

/// Bytes taken in one look; a kernel's terminal buffer is as large.
const READ_BYTES: usize = 4096;
/// Bytes and looks in one poll, so that a device that never stops talking cannot hold up the others: 256 KiB is two
/// seconds of the fastest line there is, 4096 reports half a second of the fastest device.
const POLL_BYTES_MAX: usize = 256 * 1024;
const READS_MAX: usize = 4096;
/// Rounds of answers and new questions in one poll.
const ROUNDS_MAX: usize = 16;

/// How a device is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Health {
    /// Answered and reporting; saying nothing is well too.
    Present,
    /// Asked and has not answered, since then.
    Silent {
        /// When it was first asked, or last stopped answering.
        since: Instant,
    },
    /// The line is gone; everything held has been let go. [`Device::reconnect`] brings it back.
    Lost,
}

/// An input device, from bytes to events.
pub struct Device {
    /// What the rig calls it.
    pub name: String,
    profile: String,
    transport: Box<dyn Transport>,
    codec: Box<dyn Codec>,
    /// How long a board that starts anew when its port is opened is left alone.
    boot_wait: Duration,
    boot_until: Option<Instant>,
    begun: bool,
    silent_since: Option<Instant>,
    lost: Option<TransportError>,
    /// What was held when somebody let go of the line, to be told by the next poll.
    let_go: Vec<InputEvent>,
    steps: Steps,
    /// The latest poll's time.
    now: Instant,
    buffer: Vec<u8>,
}

impl Device {
    /// A device whose profile's key is `profile`; nothing is sent before the first poll.
    pub fn new(
        name: impl Into<String>,
        profile: impl Into<String>,
        transport: Box<dyn Transport>,
        codec: Box<dyn Codec>,
    ) -> Self {
        Self {
            name: name.into(),
            profile: profile.into(),
            transport,
            codec,
            boot_wait: Duration::ZERO,
            boot_until: None,
            begun: false,
            silent_since: None,
            lost: None,
            let_go: Vec::new(),
            steps: Steps::default(),
            now: Instant::ZERO,
            buffer: vec![0; READ_BYTES],
        }
    }

    /// The device a profile describes.
    pub fn of_profile(
        name: impl Into<String>,
        profile: &InputProfile,
        transport: Box<dyn Transport>,
    ) -> Result<Self, UnknownFormat> {
        let codec = codec::of_profile(profile, Stand::Unasked)?;
        let mut device = Self::new(name, &profile.key, transport, codec);
        let boot_wait_ms = profile.line.map_or(0, |line| line.boot_wait_ms);
        device.boot_wait = Duration::from_millis(boot_wait_ms.into());
        Ok(device)
    }

    /// A device that no profile knows, by its own report descriptor, and what it has, as a profile would say it. An error
    /// in words.
    pub fn generic(
        name: impl Into<String>,
        mut transport: Box<dyn Transport>,
    ) -> Result<(Self, InputProfile), String> {
        let descriptor = transport.report_descriptor().map_err(|error| error.to_string())?;
        let codec = HidCodec::generic(&descriptor).map_err(|error| error.to_string())?;
        if !codec.tells_anything() {
            return Err("its report descriptor tells of nothing that a hand does".to_owned());
        }
        let profile = hid::describe(&descriptor).map_err(|error| error.to_string())?;
        Ok((Self::new(name, "", transport, Box::new(codec)), profile))
    }

    /// Takes what has arrived, goes on with the conversation, and appends the events. Never waits.
    pub fn poll(&mut self, now: Instant, events: &mut Vec<Stamped<InputEvent>>) -> Health {
        self.tell_let_go(now, events);
        if self.lost.is_some() {
            return Health::Lost;
        }
        let done = self.converse(now, events);
        if let Err(error) = done {
            self.lose(now, error, events);
            return Health::Lost;
        }
        self.silent_since = match self.silent_since {
            _ if self.codec.started() => None,
            None => Some(now),
            since => since,
        };
        match self.silent_since {
            None => Health::Present,
            Some(since) => Health::Silent { since },
        }
    }

    fn converse(
        &mut self,
        now: Instant,
        events: &mut Vec<Stamped<InputEvent>>,
    ) -> Result<(), TransportError> {
        self.now = now;
        if !self.begun {
            let until = *self.boot_until.get_or_insert(now.after(self.boot_wait));
            if now < until {
                // What a boot loader says is not for us.
                return self.take_in(now, None);
            }
            self.begun = true;
            self.codec.start(now, &mut self.steps.queue);
        }
        // What was sent before the line went is taken in first.
        self.take_in(now, Some(&mut *events))?;
        for _ in 0..ROUNDS_MAX {
            let mut emit = |what| events.push(Stamped { at: now, what });
            self.codec.advance(now, &mut self.steps.queue, &mut emit);
            if !self
                .steps
                .run(now, self.transport.as_mut(), self.codec.as_mut())?
            {
                break;
            }
        }
        Ok(())
    }

    /// Decodes what has arrived; every event bears the time its last byte arrived. Without `events` it is thrown away.
    fn take_in(
        &mut self,
        now: Instant,
        mut events: Option<&mut Vec<Stamped<InputEvent>>>,
    ) -> Result<(), TransportError> {
        let mut taken = 0;
        for _ in 0..READS_MAX {
            let count = self.transport.read(&mut self.buffer)?;
            if count == 0 {
                break;
            }
            if let Some(events) = &mut events {
                let at = self.transport.arrived().map_or(now, |at| at.min(now));
                let bytes = self.buffer.get(..count).unwrap_or_default();
                self.codec.decode(bytes, &mut |what| {
                    events.push(Stamped { at, what });
                });
            }
            taken += count;
            if taken >= POLL_BYTES_MAX {
                break;
            }
        }
        Ok(())
    }

    fn lose(&mut self, now: Instant, error: TransportError, events: &mut Vec<Stamped<InputEvent>>) {
        tracing::warn!(device = self.name, %error, "input device lost");
        self.codec
            .let_go(&mut |what| events.push(Stamped { at: now, what }));
        self.lost = Some(error);
    }

    /// Lets go of the line on purpose. [`Device::tell_let_go`] says what is not held any more, and [`Device::reconnect`]
    /// goes on, also with the line of another device of the kind.
    pub fn close(&mut self) {
        let held = &mut self.let_go;
        self.codec.let_go(&mut |what| held.push(what));
        let name = self.name.clone();
        self.transport = Box::new(Closed { name: name.clone() });
        self.lost = Some(TransportError::Gone { address: name });
    }

    /// Appends what was held when the line was let go of; once.
    pub fn tell_let_go(&mut self, now: Instant, events: &mut Vec<Stamped<InputEvent>>) {
        let let_go = self.let_go.drain(..);
        events.extend(let_go.map(|what| Stamped { at: now, what }));
    }

    /// Has the device show something; kept and sent later where it is not ready. A line that is gone is found
    /// out by the next poll as well.
    pub fn show(&mut self, feedback: &Feedback) -> Result<(), TransportError> {
        self.codec.encode(feedback, &mut self.steps.queue);
        if self.lost.is_some() || !self.begun {
            self.steps.clear();
            return Ok(());
        }
        self.steps
            .run(self.now, self.transport.as_mut(), self.codec.as_mut())
            .map(|_| ())
    }

    /// Goes on with a new line to the same device: it is asked again and shown everything again.
    pub fn reconnect(&mut self, transport: Box<dyn Transport>) {
        self.transport = transport;
        self.steps.clear();
        self.boot_until = None;
        self.begun = false;
        self.silent_since = None;
        self.lost = None;
    }

    /// Returns at `until`, or earlier when bytes are there.
    pub fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        self.transport.wait(clock, until);
    }

    /// The profile's key.
    pub fn profile(&self) -> &str {
        &self.profile
    }

    /// Why the device is lost, if it is.
    pub fn lost(&self) -> Option<&TransportError> {
        self.lost.as_ref()
    }

    /// Whether the device has answered and reports.
    pub fn started(&self) -> bool {
        self.codec.started()
    }

    /// What its codec has counted.
    pub fn counters(&self) -> Counters {
        self.codec.counters()
    }

    /// Reports thrown away because they came faster than they were taken in.
    pub fn dropped(&self) -> u64 {
        self.transport.dropped()
    }

    /// Reports the device would not take.
    pub fn refused(&self) -> u64 {
        self.steps.refused
    }

    /// Why the device has not started, in words, where that is known.
    pub fn trouble(&self) -> Option<&str> {
        self.codec.trouble()
    }

    /// The tablet's active area; `None` for what has none.
    pub fn surface(&self) -> Option<Surface> {
        self.codec.surface()
    }

    /// What the device calls itself, once it has said so.
    pub fn identity(&self) -> Option<&str> {
        self.codec.identity()
    }
}

#[cfg(test)]
mod handshake_tests;
#[cfg(test)]
mod tests;
