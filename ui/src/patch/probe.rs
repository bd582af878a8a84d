//! A pinned read-out of one output: its last messages as numbers over time.

use std::collections::VecDeque;

use ps300::Value;
use ps300::language::Name;

use super::token;

/// Messages kept: as many as a read-out is points wide.
pub const KEPT: usize = 96;

/// One read-out.
#[derive(Clone, Debug)]
pub struct Probe {
    /// Whose output.
    pub name: Name,
    /// Which, from 1.
    pub output: u8,
    /// The last message in words.
    pub last: String,
    sent: Option<u64>,
    values: VecDeque<f64>,
}

impl Probe {
    /// A read-out without messages.
    pub fn new(name: Name, output: u8) -> Probe {
        Probe {
            name,
            output,
            last: String::new(),
            sent: None,
            values: VecDeque::with_capacity(KEPT),
        }
    }

    /// Takes note of the output's count and last message.
    pub fn see(&mut self, sent: u64, last: Option<&Value>) {
        let Some(value) = last.filter(|_| self.sent != Some(sent)) else {
            return;
        };
        self.sent = Some(sent);
        self.last = token::short(value);
        if let Some(number) = token::scalar(value) {
            if self.values.len() == KEPT {
                self.values.pop_front();
            }
            self.values.push_back(number);
        }
    }

    /// The messages as heights 0 to 1, oldest first; all the same is the middle.
    pub fn heights(&self) -> impl Iterator<Item = f32> + '_ {
        let low = self.values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = self.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let span = high - low;
        self.values.iter().map(move |value| {
            if span > 0.0 {
                ((value - low) / span) as f32
            } else {
                0.5
            }
        })
    }
}
