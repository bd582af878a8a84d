//! A deej box: potentiometers on a small board that says all of them in a line of text, over and over.
//!
//! The sketch reads every pot, prints the line and waits ten milliseconds; printing waits where the board's buffer is
//! full, so that with a few pots at 9600 baud the line, not the pause, sets the pace. Opening the port restarts most
//! boards; one that does not restart is joined in the middle of a line.
//! Source: `docs/protocols/deej.md` (omriharel/deej at 9c0307b9, `arduino/` and `pkg/deej/serial.go`).

use crate::firmware::Firmware;
use crate::hands::{Hands, Schedule, Touch, noise};
use crate::line::{Line, shortened};
use crate::script::{Device, Script};
use crate::serial_kinds::SerialDevice;
use crate::travel::Travel;
use crate::uart::Parity;
use device_profiles::{ControlClass, InputProfile, Quirk};

/// Speed of the line.
pub const BAUD: u32 = 9600;
/// The pause of the sketch's loop.
const PAUSE_NS: u64 = 10_000_000;
/// What the board keeps of a line that the wire has not yet taken (Arduino, `SERIAL_TX_BUFFER_SIZE`).
const BUFFER_BYTES: u64 = 64;
/// Boot loader and start of the sketch. Ours; people say about two seconds.
const BOOT_NS: u64 = 1_600_000_000;
/// Ten bits of converter.
const COUNTS_MAX: f64 = 1023.0;

/// How this box differs from the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Potentiometers, numbered from 0.
    pub pots: u8,
    /// Opening the port restarts the board, as most do.
    pub restarts_when_opened: bool,
    /// A reading is off by up to so many counts.
    pub jitter_counts: u16,
    /// The pots are wired the other way round.
    pub inverted: bool,
    /// The board's clock is this many millionths fast.
    pub drift_ppm: i32,
    /// Decides the jitter.
    pub seed: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            pots: 5,
            restarts_when_opened: true,
            jitter_counts: 1,
            inverted: false,
            drift_ppm: 0,
            seed: 0,
        }
    }
}

impl From<&InputProfile> for Options {
    fn from(profile: &InputProfile) -> Self {
        Self {
            pots: profile.count(ControlClass::Axis).min(u16::from(u8::MAX)) as u8,
            restarts_when_opened: profile.quirks.contains(&Quirk::RestartsOnOpen),
            inverted: profile.lines.as_ref().is_some_and(|lines| lines.inverted),
            ..Self::default()
        }
    }
}

/// The box, its line, and the hands on it.
#[derive(Clone, Debug)]
pub struct Deej {
    options: Options,
    line: Line,
    reached_ns: u64,
    next_loop_ns: u64,
    pots: Vec<Travel>,
    chance: fastrand::Rng,
    schedule: Schedule,
}

impl Deej {
    /// A box that has been on for a while, every pot at its beginning; it is talking already.
    pub fn new(options: Options) -> Self {
        Self {
            line: Line::new(BAUD, options.drift_ppm),
            reached_ns: 0,
            next_loop_ns: 0,
            pots: vec![Travel::default(); usize::from(options.pots)],
            chance: fastrand::Rng::with_seed(options.seed),
            schedule: Schedule::default(),
            options,
        }
    }

    fn catch_up(&mut self, now_us: u64) -> u64 {
        let now_ns = (now_us * 1000).max(self.reached_ns);
        self.advance(now_ns);
        now_ns
    }

    fn advance(&mut self, to_ns: u64) {
        loop {
            let events = [
                self.line.next_arrival_ns(),
                self.schedule.next_ns(),
                Some(self.next_loop_ns),
            ];
            let Some(at_ns) = events.into_iter().flatten().min().filter(|&at| at <= to_ns) else {
                break;
            };
            self.reached_ns = self.reached_ns.max(at_ns);
            // The sketch never looks at what the host says.
            if self.line.arrival(self.reached_ns).is_some() {
                continue;
            }
            if self.schedule.next_ns().is_some_and(|due| due <= self.reached_ns) {
                if let Some(touch) = self.schedule.pop() {
                    self.touch_now(&touch);
                }
            } else {
                self.turn_round();
            }
        }
        self.reached_ns = self.reached_ns.max(to_ns);
    }

    /// Once round the sketch's loop.
    fn turn_round(&mut self) {
        let at_ns = self.reached_ns;
        self.schedule.begin(at_ns);
        let mut text = String::with_capacity(5 * self.pots.len() + 2);
        for pot in 0..self.pots.len() {
            if pot > 0 {
                text.push('|');
            }
            text.push_str(&self.reading(pot, at_ns).to_string());
        }
        text.push_str("\r\n");
        self.line.device_sends(at_ns, text.as_bytes());
        // Printing returns when what is left fits into the buffer.
        let kept_ns = BUFFER_BYTES * self.line.device_byte_ns();
        let printed_ns = self.line.device_free_ns().saturating_sub(kept_ns).max(at_ns);
        self.next_loop_ns = printed_ns + shortened(PAUSE_NS, self.options.drift_ppm);
    }

    fn reading(&mut self, pot: usize, at_ns: u64) -> u16 {
        let share = self.pots[pot].at(at_ns);
        let share = if self.options.inverted { 1.0 - share } else { share };
        let jitter = i32::from(self.options.jitter_counts);
        let off = f64::from(self.chance.i32(-jitter..=jitter));
        (share * COUNTS_MAX + off).round().clamp(0.0, COUNTS_MAX) as u16
    }

    fn restart(&mut self) {
        self.line.device_stops(self.reached_ns);
        self.next_loop_ns = self.reached_ns + shortened(BOOT_NS, self.options.drift_ppm);
    }

    fn touch_now(&mut self, touch: &Touch) -> bool {
        match *touch {
            Touch::Axis { control, to, over_us } => {
                let Some(pot) = self.pots.get_mut(usize::from(control)) else {
                    return false;
                };
                pot.go(self.reached_ns, to, over_us * 1000);
            }
            Touch::PowerCycle => self.restart(),
            Touch::Noise(bytes) => self.line.device_sends(self.reached_ns, &noise(bytes)),
            _ => return false,
        }
        true
    }
}

impl Firmware for Deej {
    fn receive(&mut self, now_us: u64, bytes: &[u8]) {
        let now_ns = self.catch_up(now_us);
        self.line.host_sends(now_ns, bytes);
    }

    fn transmit(&mut self, now_us: u64, out: &mut Vec<u8>) {
        let now_ns = self.catch_up(now_us);
        self.line.deliver(now_ns, out);
    }

    fn set_line_baud(&mut self, now_us: u64, baud: u32) {
        self.catch_up(now_us);
        self.line.set_host_baud(baud);
    }

    fn set_line_parity(&mut self, now_us: u64, parity: Parity) {
        self.catch_up(now_us);
        self.line.set_host_parity(parity);
    }

    fn port_opened(&mut self, now_us: u64) {
        self.catch_up(now_us);
        if self.options.restarts_when_opened {
            self.restart();
        }
    }

    fn next_byte_us(&self) -> Option<u64> {
        self.line.next_delivery_ns().map(|ns| ns.div_ceil(1000))
    }
}

impl Hands for Deej {
    fn touch(&mut self, now_us: u64, touch: &Touch) -> bool {
        self.catch_up(now_us);
        self.touch_now(touch)
    }

    fn reporting_since_us(&self) -> Option<u64> {
        self.schedule.since_us()
    }
}

impl SerialDevice for Deej {
    fn play(&mut self, script: &Script) {
        self.schedule.play(script);
    }

    fn script_is_done(&self) -> bool {
        self.schedule.is_done()
    }

    fn line(&self) -> (u32, Parity) {
        (BAUD, Parity::None)
    }

    fn controls(&self) -> Device {
        Device::Controls {
            dials: 0,
            buttons: 0,
            axes: self.options.pots,
        }
    }
}

#[cfg(test)]
mod tests;
