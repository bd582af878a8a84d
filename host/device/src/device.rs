//! One input device: a transport, the codec that understands it, and whether it is well.

use crate::clock::{Clock, Instant};
use crate::codec::sgi_dial_box::SgiDialBox;
use crate::codec::wacom_iv::WacomIv;
use crate::codec::{Codec, Counters, Feedback, InputEvent, Outgoing, Stamped, Step, Surface};
use crate::transport::{Transport, TransportError};
use device_profiles::InputProfile;

/// Bytes taken in one look; a kernel's terminal buffer is as large.
const READ_BYTES: usize = 4096;
/// Looks in one poll, so that a device that never stops talking cannot hold up the others: 256 KiB is two
/// seconds of the fastest line there is.
const READS_MAX: usize = 64;

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
    begun: bool,
    silent_since: Option<Instant>,
    lost: Option<TransportError>,
    outgoing: Outgoing,
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
            begun: false,
            silent_since: None,
            lost: None,
            outgoing: Outgoing::new(),
            buffer: vec![0; READ_BYTES],
        }
    }

    /// The device a profile describes.
    pub fn of_profile(
        name: impl Into<String>,
        profile: &InputProfile,
        transport: Box<dyn Transport>,
    ) -> Result<Self, UnknownFormat> {
        let codec: Box<dyn Codec> = match profile.format.as_str() {
            "sgi-dial-box" => Box::new(SgiDialBox::new(profile)),
            "wacom-iv" => Box::new(WacomIv::new(profile)),
            other => {
                return Err(UnknownFormat {
                    profile: profile.key.clone(),
                    format: other.to_owned(),
                });
            }
        };
        Ok(Self::new(name, &profile.key, transport, codec))
    }

    /// Takes what has arrived, goes on with the conversation, and appends the events. Never waits.
    pub fn poll(&mut self, now: Instant, events: &mut Vec<Stamped<InputEvent>>) -> Health {
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
        let mut emit = |what| events.push(Stamped { at: now, what });
        if !self.begun {
            self.begun = true;
            self.codec.start(now, &mut self.outgoing);
        }
        // What was sent before the line went is taken in first.
        let mut ended = Ok(());
        for _ in 0..READS_MAX {
            match self.transport.read(&mut self.buffer) {
                Ok(0) => break,
                Ok(count) => self
                    .codec
                    .decode(self.buffer.get(..count).unwrap_or_default(), &mut emit),
                Err(error) => {
                    ended = Err(error);
                    break;
                }
            }
        }
        ended?;
        self.codec.advance(now, &mut self.outgoing, &mut emit);
        self.send()
    }

    fn send(&mut self) -> Result<(), TransportError> {
        for step in self.outgoing.drain() {
            match step {
                Step::Bytes(bytes) => self.transport.write(&bytes)?,
                Step::Baud(baud) => self.transport.set_baud(baud)?,
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

    /// Has the device show something; kept and sent later where it is not ready. A line that is gone is found
    /// out by the next poll as well.
    pub fn show(&mut self, feedback: &Feedback) -> Result<(), TransportError> {
        self.codec.encode(feedback, &mut self.outgoing);
        if self.lost.is_some() || !self.begun {
            self.outgoing.clear();
            return Ok(());
        }
        self.send()
    }

    /// Goes on with a new line to the same device: it is asked again and shown everything again.
    pub fn reconnect(&mut self, transport: Box<dyn Transport>) {
        self.transport = transport;
        self.outgoing.clear();
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

    /// The tablet's active area; `None` for what has none.
    pub fn surface(&self) -> Option<Surface> {
        self.codec.surface()
    }

    /// What the device calls itself, once it has said so.
    pub fn identity(&self) -> Option<&str> {
        self.codec.identity()
    }
}

/// A profile's format that no codec here reads.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "profile \"{profile}\" has format \"{format}\", which is not known here; known are: sgi-dial-box, wacom-iv"
)]
pub struct UnknownFormat {
    /// The profile's key.
    pub profile: String,
    /// What it says.
    pub format: String,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::memory::{MemoryTransport, pair};
    use device_profiles::Profiles;
    use std::time::Duration;

    fn device() -> (Device, MemoryTransport) {
        let (host, far) = pair();
        let all = Profiles::builtin();
        let profile = all.input("sgi-dialbox").expect("it is built in");
        (
            Device::of_profile("box", profile, Box::new(host)).expect("its format is known"),
            far,
        )
    }

    fn at_ms(ms: u64) -> Instant {
        Instant::ZERO.after(Duration::from_millis(ms))
    }

    fn read_all(far: &mut MemoryTransport) -> Vec<u8> {
        let mut buffer = [0; 256];
        let count = far.read(&mut buffer).expect("the host is there");
        buffer[..count].to_vec()
    }

    #[test]
    fn silence_becomes_presence_with_the_first_answer() {
        let (mut device, mut far) = device();
        let mut events = Vec::new();
        assert_eq!(
            device.poll(at_ms(5), &mut events),
            Health::Silent { since: at_ms(5) }
        );
        assert_eq!(read_all(&mut far), [0x20]);
        assert_eq!(
            device.poll(at_ms(9), &mut events),
            Health::Silent { since: at_ms(5) }
        );
        far.write(&[0x20]).expect("the host is there");
        assert_eq!(device.poll(at_ms(12), &mut events), Health::Present);
        assert_eq!(
            events,
            [Stamped {
                at: at_ms(12),
                what: InputEvent::Started
            }]
        );
    }

    #[test]
    fn a_lost_device_lets_go_and_comes_back_with_its_lamps() {
        let (mut device, mut far) = device();
        let mut events = Vec::new();
        device.poll(at_ms(0), &mut events);
        far.write(&[0x20]).expect("the host is there");
        device.poll(at_ms(1), &mut events);
        device.show(&Feedback::Lamps(4)).expect("the box is there");
        far.write(&[0xD8]).expect("the host is there");
        drop(far);
        events.clear();
        assert_eq!(device.poll(at_ms(2), &mut events), Health::Lost);
        let button = |down| InputEvent::Button { control: 0, down };
        let said: Vec<_> = events.drain(..).map(|e| e.what).collect();
        assert_eq!(said, [button(true), button(false)]);
        assert!(device.lost().is_some_and(TransportError::is_gone));

        let (host, mut far) = pair();
        device.reconnect(Box::new(host));
        device.poll(at_ms(3), &mut events);
        far.write(&[0x20]).expect("the host is there");
        assert_eq!(device.poll(at_ms(4), &mut events), Health::Present);
        assert!(read_all(&mut far).ends_with(&[0x75, 4, 0, 0, 0]));
        assert_eq!(events.last().map(|e| &e.what), Some(&InputEvent::Restarted));
    }
}
