//! What may go wrong between a USB input device and its host, by name.

use super::Report;
use std::collections::VecDeque;

/// One fault. Reports are struck in the order the faults were brought in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UsbFault {
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
    /// The device repeats what it has to say this often, hertz, for so long, microseconds.
    Flood {
        /// Reports a second.
        hz: u32,
        /// Duration.
        for_us: u64,
    },
    /// The cable comes out at the request after so many more: outputs, features, strings and vendor requests count.
    UnplugAfterRequests(u32),
}

/// A text names no fault.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected garbage, short, long, wrong, interleaved, `flood 8000Hz for 2s` or `unplug after 3`, found `{text}`"
)]
pub struct UsbFaultError {
    /// As given.
    pub text: String,
}

impl UsbFault {
    /// Reads a fault as people write it.
    pub fn parse(text: &str) -> Result<Self, UsbFaultError> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let found = match words[..] {
            ["garbage"] => Some(Self::Garbage),
            ["short"] => Some(Self::Short),
            ["long"] => Some(Self::Long),
            ["wrong"] => Some(Self::Wrong),
            ["interleaved"] => Some(Self::Interleaved),
            ["unplug", "after", count] => count.parse().ok().map(Self::UnplugAfterRequests),
            ["flood", rate, "for", time] => flood(rate, time),
            _ => None,
        };
        found.ok_or_else(|| UsbFaultError {
            text: text.to_owned(),
        })
    }
}

fn flood(rate: &str, time: &str) -> Option<UsbFault> {
    let hz: u32 = rate.strip_suffix("Hz")?.parse().ok()?;
    let secs: f64 = time.strip_suffix('s')?.parse().ok()?;
    ((1..=100_000).contains(&hz) && (0.0..=3600.0).contains(&secs)).then(|| UsbFault::Flood {
        hz,
        for_us: (secs * 1e6).round() as u64,
    })
}

/// Four bytes three times: what an HS610 sends now and then (input-device facts, `enabled/pen_coords`, second frame).
const NONSENSE: [u8; 12] = [0x78, 0xCC, 0, 8, 0x78, 0xCC, 0, 8, 0x78, 0xCC, 0, 8];
/// An id that no device here has.
const NO_ID: u8 = 0xEE;

/// The faults of one device.
#[derive(Clone, Debug, Default)]
pub(super) struct Faults {
    early: VecDeque<Report>,
    strikes: VecDeque<UsbFault>,
    flood: Option<Flood>,
    requests_left: Option<u32>,
    held: Option<Report>,
}

#[derive(Clone, Copy, Debug)]
struct Flood {
    /// Microseconds, as are the rest.
    period: u64,
    next: u64,
    until: u64,
}

impl Faults {
    pub(super) fn add(&mut self, now_us: u64, interface: u8, fault: UsbFault) {
        match fault {
            UsbFault::Garbage => self.early.push_back(Report {
                interface,
                bytes: NONSENSE.to_vec(),
            }),
            UsbFault::Flood { hz, for_us } => {
                self.flood = Some(Flood {
                    period: (1_000_000 / u64::from(hz.max(1))).max(1),
                    next: now_us,
                    until: now_us + for_us,
                });
            }
            UsbFault::UnplugAfterRequests(count) => self.requests_left = Some(count),
            strike => self.strikes.push_back(strike),
        }
    }

    /// Counts one request; true when the cable comes out before it.
    pub(super) fn unplugs_at_this_request(&mut self) -> bool {
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

    /// Whether a frame waits that the device itself knows nothing of.
    pub(super) fn has_report(&self) -> bool {
        !self.early.is_empty()
    }

    pub(super) fn early(&mut self) -> Option<Report> {
        self.early.pop_front()
    }

    pub(super) fn flood_slot_us(&self) -> Option<u64> {
        self.flood.map(|flood| flood.next)
    }

    /// Whether a slot of a flood is due; it moves on to its next.
    pub(super) fn flood_begins_slot(&mut self, now_us: u64) -> bool {
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

    /// What becomes of a report: itself, another, none yet, or two.
    pub(super) fn mangle(&mut self, mut report: Report) -> Vec<Report> {
        if let Some(mut first) = self.held.take() {
            let cut = first.bytes.len().min(report.bytes.len()) / 2;
            let ends = first.bytes.iter_mut().zip(&mut report.bytes).skip(cut);
            ends.for_each(|(here, there)| std::mem::swap(here, there));
            return vec![first, report];
        }
        match self.strikes.pop_front() {
            Some(UsbFault::Short) => report.bytes.truncate(report.bytes.len() / 2),
            Some(UsbFault::Long) => report.bytes.extend([0xA5; 8]),
            Some(UsbFault::Wrong) => {
                if let Some(first) = report.bytes.first_mut() {
                    *first = NO_ID;
                }
            }
            Some(UsbFault::Interleaved) => {
                self.held = Some(report);
                return Vec::new();
            }
            _ => {}
        }
        vec![report]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_read_as_they_are_written() {
        let rows = [
            ("garbage", UsbFault::Garbage),
            ("interleaved", UsbFault::Interleaved),
            ("unplug after 3", UsbFault::UnplugAfterRequests(3)),
            (
                "flood 8000Hz for 0.5s",
                UsbFault::Flood {
                    hz: 8000,
                    for_us: 500_000,
                },
            ),
        ];
        for (text, want) in rows {
            assert_eq!(UsbFault::parse(text), Ok(want), "{text}");
        }
        for text in [
            "",
            "flood",
            "flood 0Hz for 1s",
            "flood 8000Hz for -1s",
            "unplug after x",
        ] {
            let error = UsbFault::parse(text).expect_err(text).to_string();
            assert!(error.contains(&format!("found `{text}`")), "{error}");
        }
    }

    #[test]
    fn interleaved_reports_change_their_ends() {
        let mut faults = Faults::default();
        faults.add(0, 0, UsbFault::Interleaved);
        let report = |byte| Report {
            interface: 0,
            bytes: vec![byte; 4],
        };
        assert_eq!(faults.mangle(report(1)), []);
        let both = faults.mangle(report(2));
        let bytes: Vec<_> = both.into_iter().map(|report| report.bytes).collect();
        assert_eq!(bytes, [[1, 1, 2, 2], [2, 2, 1, 1]]);
    }
}
