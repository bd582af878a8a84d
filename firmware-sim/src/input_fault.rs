//! What may go wrong between an input device and its host, by name: the same words for USB and for serial lines.
//!
//! Knows: messages, whatever they are on the wire (a report, a packet, a line of text), and which of them are struck.
//! Must not know: what any of them means, nor when one is due.

use std::collections::VecDeque;

/// One fault. Messages are struck in the order the faults were brought in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum InputFault {
    /// So many of the next reports are lost on the way.
    Drop(u32),
    /// One frame of nonsense comes before the next report, as an HS610 was recorded to send.
    Garbage,
    /// The next report ends after half of its bytes.
    Short,
    /// The next report has eight bytes more than it should.
    Long,
    /// The next report bears an id, or a first byte, that is no other's.
    Wrong,
    /// The second half of the next report and of the one after it change places.
    Interleaved,
    /// The device repeats what it has to say this often, hertz, for so long, microseconds; a slow line takes as much of
    /// it as it can.
    Flood {
        /// Reports a second.
        hz: u32,
        /// Duration.
        for_us: u64,
    },
    /// The cable comes out at the request after so many more: outputs, features, strings and vendor requests count. A
    /// serial line has no requests, and whoever holds its cable counts for it.
    UnplugAfterRequests(u32),
}

/// A text names no fault.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected garbage, short, long, wrong, interleaved, `drop 3`, `flood 8000Hz for 2s` or `unplug after 3`, found \
     `{text}`"
)]
pub struct InputFaultError {
    /// As given.
    pub text: String,
}

impl InputFault {
    /// Reads a fault as people write it.
    pub fn parse(text: &str) -> Result<Self, InputFaultError> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let found = match words[..] {
            ["garbage"] => Some(Self::Garbage),
            ["short"] => Some(Self::Short),
            ["long"] => Some(Self::Long),
            ["wrong"] => Some(Self::Wrong),
            ["interleaved"] => Some(Self::Interleaved),
            ["drop", count] => count.parse().ok().filter(|&count| count > 0).map(Self::Drop),
            ["unplug", "after", count] => count.parse().ok().map(Self::UnplugAfterRequests),
            ["flood", rate, "for", time] => flood(rate, time),
            _ => None,
        };
        found.ok_or_else(|| InputFaultError {
            text: text.to_owned(),
        })
    }
}

fn flood(rate: &str, time: &str) -> Option<InputFault> {
    let hz: u32 = rate.strip_suffix("Hz")?.parse().ok()?;
    let secs: f64 = time.strip_suffix('s')?.parse().ok()?;
    ((1..=100_000).contains(&hz) && (0.0..=3600.0).contains(&secs)).then(|| InputFault::Flood {
        hz,
        for_us: (secs * 1e6).round() as u64,
    })
}

/// Four bytes three times: what an HS610 sends now and then (input-device facts, `enabled/pen_coords`, second frame).
const NONSENSE: [u8; 12] = [0x78, 0xCC, 0, 8, 0x78, 0xCC, 0, 8, 0x78, 0xCC, 0, 8];
/// An id that no device here has.
const NO_ID: u8 = 0xEE;

/// Something that goes over the wire in one piece.
pub(crate) trait Message: Sized {
    /// Its bytes.
    fn bytes(&mut self) -> &mut Vec<u8>;
}

impl Message for Vec<u8> {
    fn bytes(&mut self) -> &mut Vec<u8> {
        self
    }
}

/// The faults of one device.
#[derive(Clone, Debug)]
pub(crate) struct Faults<M> {
    early: VecDeque<Vec<u8>>,
    strikes: VecDeque<InputFault>,
    flood: Option<Flood>,
    requests_left: Option<u32>,
    held: Option<M>,
}

#[derive(Clone, Copy, Debug)]
struct Flood {
    /// Microseconds, as are the rest.
    period: u64,
    next: u64,
    until: u64,
}

impl<M> Default for Faults<M> {
    fn default() -> Self {
        Self {
            early: VecDeque::new(),
            strikes: VecDeque::new(),
            flood: None,
            requests_left: None,
            held: None,
        }
    }
}

impl<M: Message> Faults<M> {
    pub(crate) fn add(&mut self, now_us: u64, fault: InputFault) {
        match fault {
            InputFault::Garbage => self.early.push_back(NONSENSE.to_vec()),
            InputFault::Flood { hz, for_us } => {
                self.flood = Some(Flood {
                    period: (1_000_000 / u64::from(hz.max(1))).max(1),
                    next: now_us,
                    until: now_us + for_us,
                });
            }
            InputFault::UnplugAfterRequests(count) => self.requests_left = Some(count),
            strike => self.strikes.push_back(strike),
        }
    }

    /// Counts one request; true when the cable comes out before it.
    pub(crate) fn unplugs_at_this_request(&mut self) -> bool {
        match &mut self.requests_left {
            Some(0) => {
                self.requests_left = None;
                true
            }
            Some(left) => {
                *left -= 1;
                false
            }
            None => false,
        }
    }

    /// Whether bytes wait that the device itself knows nothing of.
    pub(crate) fn has_early(&self) -> bool {
        !self.early.is_empty()
    }

    pub(crate) fn early(&mut self) -> Option<Vec<u8>> {
        self.early.pop_front()
    }

    pub(crate) fn flood_slot_us(&self) -> Option<u64> {
        self.flood.map(|flood| flood.next)
    }

    /// Whether a slot of a flood is due; it moves on to its next.
    pub(crate) fn flood_begins_slot(&mut self, now_us: u64) -> bool {
        let Some(flood) = &mut self.flood else {
            return false;
        };
        if flood.next > now_us {
            return false;
        }
        flood.next += flood.period;
        if flood.next >= flood.until {
            self.flood = None;
        }
        true
    }

    /// What becomes of a message: itself, another, none yet, none at all, or two.
    pub(crate) fn mangle(&mut self, mut message: M) -> Vec<M> {
        if let Some(mut first) = self.held.take() {
            let (here, there) = (first.bytes(), message.bytes());
            let cut = here.len().min(there.len()) / 2;
            let ends = here.iter_mut().zip(there).skip(cut);
            ends.for_each(|(here, there)| std::mem::swap(here, there));
            return vec![first, message];
        }
        let bytes = message.bytes();
        match self.strikes.pop_front() {
            Some(InputFault::Drop(count)) => {
                if count > 1 {
                    self.strikes.push_front(InputFault::Drop(count - 1));
                }
                return Vec::new();
            }
            Some(InputFault::Short) => bytes.truncate(bytes.len() / 2),
            Some(InputFault::Long) => bytes.extend([0xA5; 8]),
            Some(InputFault::Wrong) => {
                if let Some(first) = bytes.first_mut() {
                    *first = NO_ID;
                }
            }
            Some(InputFault::Interleaved) => {
                self.held = Some(message);
                return Vec::new();
            }
            _ => {}
        }
        vec![message]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_read_as_they_are_written() {
        let rows = [
            ("garbage", InputFault::Garbage),
            ("interleaved", InputFault::Interleaved),
            ("drop 3", InputFault::Drop(3)),
            ("unplug after 3", InputFault::UnplugAfterRequests(3)),
            (
                "flood 8000Hz for 0.5s",
                InputFault::Flood {
                    hz: 8000,
                    for_us: 500_000,
                },
            ),
        ];
        for (text, want) in rows {
            assert_eq!(InputFault::parse(text), Ok(want), "{text}");
        }
        for text in [
            "",
            "flood",
            "flood 0Hz for 1s",
            "flood 8000Hz for -1s",
            "unplug after x",
            "drop 0",
        ] {
            let error = InputFault::parse(text).expect_err(text).to_string();
            assert!(error.contains(&format!("found `{text}`")), "{error}");
        }
    }

    #[test]
    fn interleaved_reports_change_their_ends() {
        let mut faults = Faults::default();
        faults.add(0, InputFault::Interleaved);
        assert!(faults.mangle(vec![1; 4]).is_empty());
        assert_eq!(faults.mangle(vec![2; 4]), [[1, 1, 2, 2], [2, 2, 1, 1]]);
    }

    #[test]
    fn as_many_are_dropped_as_was_said_and_then_it_goes_on() {
        let mut faults = Faults::default();
        faults.add(0, InputFault::Drop(2));
        faults.add(0, InputFault::Short);
        let became: Vec<Vec<Vec<u8>>> = (0..4).map(|n| faults.mangle(vec![n; 4])).collect();
        let want = [vec![], vec![], vec![vec![2, 2]], vec![vec![3; 4]]];
        assert_eq!(became, want);
    }
}
