//! Exchanges: what a host and a device said to each other, as text that people write and read.
//!
//! Apart from the codecs because both sides are held against the same file: the codec, and separately the
//! simulated firmware. Captures and takes are written in the same words. Pure: text in, records out, and a codec
//! played through them on times of the file's own. The form: `docs/formats.md`, "Exchanges".

mod events;
mod play;
mod read;
mod shows;
mod words;
mod write;

pub use events::{event_words, read_event};
pub use play::{Difference, Played, agrees, play};
pub use read::{ExchangeError, read, read_readable};
pub use shows::show_words;
pub use write::{time_words, write, write_record};

use crate::codec::{Answer, Feedback, InputEvent, Step};
use std::time::Duration;

/// A conversation, from its first line to its last.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exchange {
    /// What is known about it.
    pub head: Head,
    /// What was said, in order.
    pub records: Vec<Record>,
}

/// The lines before the first record.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Head {
    /// The device's profile, `profile: NAME`.
    pub profile: Option<String>,
    /// Where it is from, `source: TEXT`.
    pub source: Option<String>,
    /// The simulated device that says the same, `simulator: NAME`.
    pub simulator: Option<String>,
    /// The interface of a USB device that is spoken with, `interface: N`; the first unless said.
    pub interface: Option<u8>,
    /// The device reported already when the first byte was taken, `begins: reporting`.
    pub reporting: bool,
}

/// One line.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Seconds since the conversation began, `@ 0.123`; `None`: as soon as it happens.
    pub at: Option<Duration>,
    /// What.
    pub what: What,
    /// Where it stands in its file, from 1; 0 for what was not read.
    pub line: u32,
}

impl Record {
    /// A record that was not read from a file.
    pub fn new(at: Duration, what: What) -> Self {
        Self {
            at: Some(at),
            what,
            line: 0,
        }
    }
}

/// What a line tells.
#[derive(Clone, Debug, PartialEq)]
pub enum What {
    /// `host > …`: the host sends, asks or sets.
    Host(Step),
    /// `device < 01 02`: bytes of a stream, or one report as the device sent it.
    Device(Vec<u8>),
    /// `device < feature|string|descriptor …`: what came back for a question.
    Answer(Answer),
    /// `device gone`: the line is no more.
    Gone,
    /// `device back`: the same device on a new line; it is asked again.
    Back,
    /// `event …`: what the codec makes of it.
    Event(InputEvent),
    /// `surface X Y pressure P`: the active area the codec knows by now.
    Surface {
        /// Largest x and y.
        max_counts: [u32; 2],
        /// Largest pressure.
        pressure_max: u32,
    },
    /// `show …`: somebody wants the device to show something.
    Show(Feedback),
    /// `hand …`: a hand on the simulated device, in the words of its scripts without the time.
    Hand(String),
    /// `pause @ T`: nothing is said until then.
    Pause,
}
