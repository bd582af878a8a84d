//! One simulated device with its cable: firmware on the far side, whoever opened the port on the near side.
//!
//! The firmware is advanced lazily, to the moment of each look; since what it says depends only on what went in
//! and when, looking more or less often changes nothing.

use std::collections::{BTreeMap, VecDeque};

use device_profiles::{ControlClass, InputProfile};
use firmware_sim::Parity;
use firmware_sim::dial_box::Output;
use firmware_sim::hands::Touch;
use firmware_sim::midi_box::Glow;
use firmware_sim::servo_bus::StatusSent;
use firmware_sim::{Firmware, InputFault, MidiShown, SerialDevice, ServoBus};

use super::surface::Surface;

/// What a seat holds.
pub(crate) enum Simulated {
    /// An input device on a serial line.
    Input(Box<dyn SerialDevice>, Measures),
    /// Servos on one line.
    Bus(Box<ServoBus>),
}

/// What hands must know of an input device to move it by other measures than its own.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Measures {
    /// Counts in a turn of its dials, where it has any.
    pub(crate) counts_per_turn: Option<u32>,
    /// The active area of a tablet.
    pub(crate) surface: Option<Surface>,
}

impl From<&InputProfile> for Measures {
    fn from(profile: &InputProfile) -> Self {
        let turns = profile.count(ControlClass::Dial) > 0;
        Self {
            counts_per_turn: turns.then(|| profile.counts_per_turn() as u32),
            surface: profile.surface.is_some().then(|| Surface::from(profile)),
        }
    }
}

/// What a dial box shows, as the eye sees it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Shown {
    /// Lit lamps, bit n for button n.
    pub lamps: u64,
    /// Texts by control (0–7 dials, 8–19 keys 1–12), without the padding.
    pub labels: BTreeMap<u8, String>,
    /// Lit lamps around dials by dial, bit 0 the leftmost.
    pub rings: BTreeMap<u8, u16>,
    /// Lamps of two colours by their maker's number: red and green, 0 to 3.
    pub colours: BTreeMap<u8, [u8; 2]>,
}

impl Shown {
    /// Each thing that is lit or written, in words: `lamp 3`, `label 2 TIME`, `ring 0 lamps 4 5`, `lamp 8 red 3 green 0`.
    pub fn words(&self) -> Vec<String> {
        let lamps = (0..64).filter(|lamp| self.lamps >> lamp & 1 == 1);
        let mut words: Vec<String> = lamps.map(|lamp| format!("lamp {lamp}")).collect();
        let written = self.labels.iter().filter(|(_, text)| !text.is_empty());
        words.extend(written.map(|(control, text)| format!("label {control} {text}")));
        for (dial, &mask) in self.rings.iter().filter(|&(_, &mask)| mask != 0) {
            let lit: Vec<String> = (0..16)
                .filter(|lamp| mask >> lamp & 1 == 1)
                .map(|lamp| lamp.to_string())
                .collect();
            words.push(format!("ring {dial} lamps {}", lit.join(" ")));
        }
        for (index, [red, green]) in self.colours.iter().filter(|(_, colour)| **colour != [0, 0]) {
            words.push(format!("lamp {index} red {red} green {green}"));
        }
        words
    }

    /// Blinking counts as lit.
    fn see(&mut self, output: MidiShown) {
        match output {
            MidiShown::Lamp { control, glow } => {
                let bit = 1_u64.checked_shl(control.into()).unwrap_or(0);
                self.lamps = match glow {
                    Glow::Off => self.lamps & !bit,
                    Glow::On | Glow::Blinking => self.lamps | bit,
                };
            }
            MidiShown::Ring { control, lamps, .. } => {
                self.rings.insert(control, lamps);
            }
            MidiShown::Colour {
                index, red, green, ..
            } => {
                self.colours.insert(index, [red, green]);
            }
            MidiShown::Mode(_) | MidiShown::Layer(_) => {}
        }
    }
}

/// What went over a bus since it was last asked: when the host wrote, and when servos measured what they sent.
#[derive(Clone, Debug, Default)]
pub struct Traffic {
    /// Times at which the host handed bytes to the port, microseconds.
    pub writes_us: Vec<u64>,
    /// Answers, in their order on the wire.
    pub answers: Vec<StatusSent>,
}

/// A device in its place on the bench.
pub(crate) struct Seat {
    pub(crate) name: String,
    pub(crate) description: String,
    pub(crate) matches: Vec<String>,
    pub(crate) device: Simulated,
    pub(crate) shown: Shown,
    connected: bool,
    /// Counts openings; a port opened before the cable was out is not this one.
    opening: u64,
    /// Reads and writes that still succeed before the cable comes out by itself.
    calls_left: Option<u64>,
    inbox: VecDeque<u8>,
    scratch: Vec<u8>,
    writes_us: Option<Vec<u64>>,
    answered_us: u64,
}

impl Seat {
    pub(crate) fn new(name: &str, description: String, matches: Vec<String>, device: Simulated) -> Self {
        Self {
            name: name.to_owned(),
            description,
            matches,
            device,
            shown: Shown::default(),
            connected: true,
            opening: 0,
            calls_left: None,
            inbox: VecDeque::new(),
            scratch: Vec::new(),
            writes_us: None,
            answered_us: 0,
        }
    }

    pub(crate) fn firmware(&mut self) -> &mut dyn Firmware {
        match &mut self.device {
            Simulated::Input(device, _) => &mut **device,
            Simulated::Bus(bus) => &mut **bus,
        }
    }

    /// Lets the device live until `now_us`; what it says without a cable is lost.
    pub(crate) fn advance(&mut self, now_us: u64) {
        let mut said = std::mem::take(&mut self.scratch);
        said.clear();
        self.firmware().transmit(now_us, &mut said);
        if self.connected {
            self.inbox.extend(&said);
        }
        self.scratch = said;
        let shown = &mut self.shown;
        let mut see = |output: Output| match output {
            Output::Lamps(lamps) => shown.lamps = lamps.into(),
            Output::Label { control, text } => {
                shown.labels.insert(control, text.trim_end().to_owned());
            }
            Output::Midi(output) => shown.see(output),
        };
        if let Simulated::Input(device, _) = &mut self.device {
            device.take_outputs(&mut |_, output| see(output));
        }
    }

    pub(crate) fn is_connected(&self) -> bool {
        self.connected
    }

    /// Opens the port; whoever had it open before finds the device gone.
    pub(crate) fn open(&mut self, now_us: u64, baud: u32, parity: Parity) -> Option<u64> {
        self.advance(now_us);
        if !self.connected {
            return None;
        }
        // What arrived before anybody listened is not kept by a port that was closed.
        self.inbox.clear();
        self.firmware().set_line_baud(now_us, baud);
        self.firmware().set_line_parity(now_us, parity);
        self.firmware().port_opened(now_us);
        self.opening += 1;
        Some(self.opening)
    }

    /// Counts one read or write of a port; false when the device is gone for it.
    pub(crate) fn call(&mut self, opening: u64, now_us: u64) -> bool {
        match &mut self.calls_left {
            Some(0) => {
                self.calls_left = None;
                self.plug(now_us, false);
            }
            Some(left) => *left -= 1,
            None => {}
        }
        self.is_there(opening)
    }

    pub(crate) fn is_there(&self, opening: u64) -> bool {
        self.connected && opening == self.opening
    }

    pub(crate) fn take(&mut self, buffer: &mut [u8]) -> usize {
        let count = self.inbox.len().min(buffer.len());
        for (place, byte) in buffer.iter_mut().zip(self.inbox.drain(..count)) {
            *place = byte;
        }
        count
    }

    pub(crate) fn has_bytes(&self) -> bool {
        !self.inbox.is_empty()
    }

    pub(crate) fn put(&mut self, now_us: u64, bytes: &[u8]) {
        if let Some(writes_us) = &mut self.writes_us {
            writes_us.push(now_us);
        }
        self.firmware().receive(now_us, bytes);
    }

    /// Takes the cable out or puts it back. The device keeps its power.
    pub(crate) fn plug(&mut self, now_us: u64, connected: bool) {
        self.advance(now_us);
        self.connected = connected;
        self.inbox.clear();
        if !connected {
            self.opening += 1;
        }
    }

    pub(crate) fn fail_after(&mut self, calls: u64) {
        self.calls_left = Some(calls);
    }

    /// Lays a hand on the device; false when it has no such control.
    pub(crate) fn touch(&mut self, now_us: u64, touch: &Touch) -> bool {
        if *touch == Touch::PowerCycle {
            self.shown = Shown::default();
        }
        match &mut self.device {
            Simulated::Input(device, _) => device.touch(now_us, touch),
            Simulated::Bus(_) => false,
        }
    }

    /// Brings a fault onto an input device; false on a bus, which has faults of its own.
    pub(crate) fn inject(&mut self, now_us: u64, fault: InputFault) -> bool {
        self.advance(now_us);
        match (&mut self.device, fault) {
            (Simulated::Bus(_), _) => false,
            (_, InputFault::UnplugAfterRequests(calls)) => {
                self.fail_after(calls.into());
                true
            }
            (Simulated::Input(device, _), fault) => device.inject(now_us, fault),
        }
    }

    /// What hands must know of it.
    pub(crate) fn measures(&self) -> Measures {
        match &self.device {
            Simulated::Input(_, measures) => *measures,
            Simulated::Bus(_) => Measures::default(),
        }
    }

    pub(crate) fn keep_traffic(&mut self) {
        self.writes_us = Some(Vec::new());
    }

    /// What went over the line since the last call.
    pub(crate) fn take_traffic(&mut self, now_us: u64) -> Traffic {
        self.advance(now_us);
        let mut traffic = Traffic::default();
        if let Some(writes_us) = &mut self.writes_us {
            traffic.writes_us = std::mem::take(writes_us);
        }
        if let Simulated::Bus(bus) = &self.device {
            let new = bus
                .statuses()
                .skip_while(|status| status.last_us <= self.answered_us);
            traffic
                .answers
                .extend(new.filter(|status| status.last_us <= now_us));
        }
        if let Some(last) = traffic.answers.last() {
            self.answered_us = last.last_us;
        }
        traffic
    }
}
