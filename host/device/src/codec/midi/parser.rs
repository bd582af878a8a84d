//! The byte stream of MIDI 1.0 cut into messages, whatever it was cut into on the way.
//!
//! Knows running status, real-time bytes inside other messages, system exclusive messages up to a length. Must not
//! know what a message is for. Source: The Complete MIDI 1.0 Detailed Specification (1996), "Data Format" and
//! appendix 3; `docs/protocols/midi.md`.

/// Longest system exclusive message that is kept, without its first and last byte. An identity answer has 15, the
/// longest of the controllers known here 20; longer ones are counted and skipped.
pub const SYSEX_MAX: usize = 256;

const SYSEX: u8 = 0xF0;
const SYSEX_END: u8 = 0xF7;
/// From here on a byte may stand anywhere and belongs to no message.
const REAL_TIME: u8 = 0xF8;

/// What a byte has completed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Message<'a> {
    /// A message of a channel: status with the channel in its low half, then its one or two data bytes (the second 0
    /// where there is none).
    Channel {
        /// 0x80 to 0xEF.
        status: u8,
        /// 0 to 127.
        data: [u8; 2],
    },
    /// A system exclusive message without F0 and F7.
    Exclusive(&'a [u8]),
    /// A system message that says nothing here: song position and the like.
    System,
    /// A clock, start, stop, active sensing or reset.
    RealTime,
    /// A data byte that belongs to nothing, or a status that means nothing.
    Unknown,
    /// A message that ended before its time, or was longer than is kept. If another byte began the next, that one is
    /// being read.
    Rejected,
}

/// Where in the stream we are.
#[derive(Clone, Debug)]
pub struct Parser {
    /// The status of the message in hand, also running; 0: none.
    status: u8,
    data: [u8; 2],
    have: usize,
    exclusive: Vec<u8>,
    too_long: bool,
}

impl Default for Parser {
    fn default() -> Self {
        Self {
            status: 0,
            data: [0; 2],
            have: 0,
            exclusive: Vec::with_capacity(SYSEX_MAX),
            too_long: false,
        }
    }
}

impl Parser {
    /// Forgets what was in hand: the next byte is the first of a new stream.
    pub fn reset(&mut self) {
        self.status = 0;
        self.have = 0;
    }

    /// Takes one byte and says what it completes.
    pub fn push(&mut self, byte: u8) -> Option<Message<'_>> {
        match byte {
            0..0x80 => self.data(byte),
            REAL_TIME.. => Some(Message::RealTime),
            SYSEX_END => Some(self.end_exclusive()),
            0x80..REAL_TIME => self.begin(byte),
        }
    }

    fn begin(&mut self, status: u8) -> Option<Message<'_>> {
        let cut_short = self.status == SYSEX || self.have > 0;
        self.have = 0;
        self.status = status;
        let mut alone = None;
        match status {
            SYSEX => {
                self.exclusive.clear();
                self.too_long = false;
            }
            // Tune request: a whole message. F4 and F5 are undefined. Neither leaves a status running.
            0xF4..=0xF6 => {
                self.status = 0;
                alone = Some(if status == 0xF6 {
                    Message::System
                } else {
                    Message::Unknown
                });
            }
            _ => {}
        }
        if cut_short { Some(Message::Rejected) } else { alone }
    }

    fn data(&mut self, byte: u8) -> Option<Message<'_>> {
        let wanted = match self.status {
            SYSEX => {
                if self.exclusive.len() < SYSEX_MAX {
                    self.exclusive.push(byte);
                } else {
                    self.too_long = true;
                }
                return None;
            }
            0 => return Some(Message::Unknown),
            status => data_bytes(status),
        };
        if let Some(place) = self.data.get_mut(self.have) {
            *place = byte;
        }
        self.have += 1;
        if self.have < wanted {
            return None;
        }
        self.have = 0;
        if self.status >= SYSEX {
            self.status = 0;
            return Some(Message::System);
        }
        let second = if wanted > 1 { self.data[1] } else { 0 };
        Some(Message::Channel {
            status: self.status,
            data: [self.data[0], second],
        })
    }

    fn end_exclusive(&mut self) -> Message<'_> {
        let was = std::mem::take(&mut self.status);
        let cut_short = std::mem::take(&mut self.have) > 0;
        match was {
            SYSEX if self.too_long => Message::Rejected,
            SYSEX => Message::Exclusive(&self.exclusive),
            _ if cut_short => Message::Rejected,
            _ => Message::Unknown,
        }
    }
}

/// Data bytes of a message.
fn data_bytes(status: u8) -> usize {
    match status {
        // Program change and channel pressure; time code and song select.
        0xC0..=0xDF | 0xF1 | 0xF3 => 1,
        _ => 2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Everything a stream says, as text so that it owns itself.
    fn all(bytes: &[u8]) -> Vec<String> {
        let mut parser = Parser::default();
        let mut said = Vec::new();
        for &byte in bytes {
            if let Some(message) = parser.push(byte) {
                said.push(match message {
                    Message::Channel { status, data } => {
                        format!("{status:02x} {:02x} {:02x}", data[0], data[1])
                    }
                    Message::Exclusive(bytes) => format!("sysex {bytes:02x?}"),
                    other => format!("{other:?}"),
                });
            }
        }
        said
    }

    #[test]
    fn messages_of_every_shape() {
        let table: &[(&str, &[u8], &[&str])] = &[
            ("a control change", &[0xB0, 7, 100], &["b0 07 64"]),
            (
                "running status",
                &[0xB0, 7, 1, 7, 2, 8, 3],
                &["b0 07 01", "b0 07 02", "b0 08 03"],
            ),
            (
                "one data byte",
                &[0xC3, 5, 6, 0xD3, 7],
                &["c3 05 00", "c3 06 00", "d3 07 00"],
            ),
            (
                "real time inside a message and inside its running status",
                &[0xB0, 0xF8, 7, 0xFE, 100, 0xFA, 8, 0xF8, 9],
                &[
                    "RealTime", "RealTime", "b0 07 64", "RealTime", "RealTime", "b0 08 09",
                ],
            ),
            (
                "system exclusive with a clock in it",
                &[0xF0, 0x7E, 0xF8, 1, 0xF7],
                &["RealTime", "sysex [7e, 01]"],
            ),
            (
                "system exclusive ends running status",
                &[0xB0, 1, 2, 0xF0, 1, 0xF7, 3, 4],
                &["b0 01 02", "sysex [01]", "Unknown", "Unknown"],
            ),
            (
                "system exclusive cut off by a message",
                &[0xF0, 1, 2, 0x90, 60, 1],
                &["Rejected", "90 3c 01"],
            ),
            (
                "a message cut off by another",
                &[0xB0, 7, 0xB1, 7, 1],
                &["Rejected", "b1 07 01"],
            ),
            (
                "system messages",
                &[0xF2, 1, 2, 0xF1, 3, 0xF3, 4, 0xF6],
                &["System"; 4],
            ),
            ("nothing known", &[1, 2, 0xF7, 0xF4, 5], &["Unknown"; 5]),
            (
                "end of nothing with something begun",
                &[0xB0, 7, 0xF7, 1],
                &["Rejected", "Unknown"],
            ),
        ];
        for (name, bytes, wanted) in table {
            assert_eq!(all(bytes), *wanted, "{name}");
        }
    }

    #[test]
    fn an_endless_system_exclusive_is_bounded_and_counted_once() {
        let mut bytes = vec![0xF0];
        bytes.extend(std::iter::repeat_n(1, 100_000));
        bytes.extend([0xF7, 0xB0, 1, 2]);
        assert_eq!(all(&bytes), ["Rejected", "b0 01 02"]);
    }

    proptest! {
        /// Whatever comes before, a stream is understood again from the first status byte behind it.
        #[test]
        fn any_garbage_is_survived_and_left_behind(garbage in prop::collection::vec(any::<u8>(), 0..300)) {
            let mut bytes = garbage;
            bytes.extend([0x90, 60, 1, 0xB5, 7, 9]);
            let said = all(&bytes);
            prop_assert_eq!(&said[said.len() - 2..], ["90 3c 01", "b5 07 09"]);
        }

        /// A legal stream comes through whole, with real-time bytes strewn over it.
        #[test]
        fn legal_streams_come_through(
            messages in prop::collection::vec((0x80u8..0xF0, 0u8..128, 0u8..128), 1..40),
            clocks in prop::collection::vec(0usize..200, 0..30),
        ) {
            let mut bytes = Vec::new();
            let mut wanted = Vec::new();
            let mut running = 0;
            for (status, first, second) in messages {
                if status != running {
                    bytes.push(status);
                }
                running = status;
                bytes.push(first);
                let two = data_bytes(status) == 2;
                if two {
                    bytes.push(second);
                }
                wanted.push(format!("{status:02x} {first:02x} {:02x}", if two { second } else { 0 }));
            }
            for at in clocks {
                bytes.insert(at.min(bytes.len()), 0xF8);
            }
            let said: Vec<String> = all(&bytes).into_iter().filter(|text| text != "RealTime").collect();
            prop_assert_eq!(said, wanted);
        }
    }
}
