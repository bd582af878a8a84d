//! One simulated device with its cable: firmware on the far side, whoever opened the port on the near side.
//!
//! The firmware is advanced lazily, to the moment of each look; since what it says depends only on what went in
//! and when, looking more or less often changes nothing.

use std::collections::{BTreeMap, VecDeque};

use firmware_sim::dial_box::Output;
use firmware_sim::hands::{Hands, Touch};
use firmware_sim::midi_box::Glow;
use firmware_sim::servo_bus::StatusSent;
use firmware_sim::{Firmware, MidiShown, SerialDevice, ServoBus, SgiDialBox, WacomIv};

use super::surface::Surface;

/// What a seat holds.
pub(crate) enum Simulated {
    /// Dials and keys, with the counts of a dial's turn.
    DialBox(Box<SgiDialBox>, u32),
    /// Pen and puck, with the active area.
    Tablet(Box<WacomIv>, Surface),
    /// Any other input device on a serial line, with the active area of a tablet.
    Serial(Box<dyn SerialDevice>, Option<Surface>),
    /// Servos on one line.
    Bus(Box<ServoBus>),
}

/// What a dial box shows, as the eye sees it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Shown {
    /// Lit lamps, bit n for button n.
    pub lamps: u32,
    /// Texts by control (0–7 dials, 8–19 keys 1–12), without the padding.
    pub labels: BTreeMap<u8, String>,
    /// Lit lamps around dials by dial, bit 0 the leftmost.
    pub rings: BTreeMap<u8, u16>,
    /// Lamps of two colours by their maker's number: red and green, 0 to 3.
    pub colours: BTreeMap<u8, [u8; 2]>,
}

impl Shown {
    /// Blinking counts as lit.
    fn see(&mut self, output: MidiShown) {
        match output {
            MidiShown::Lamp { control, glow } => {
                let bit = 1_u32.checked_shl(control.into()).unwrap_or(0);
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
            Simulated::DialBox(dial_box, _) => &mut **dial_box,
            Simulated::Tablet(tablet, _) => &mut **tablet,
            Simulated::Serial(device, _) => &mut **device,
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
            Output::Lamps(lamps) => shown.lamps = lamps,
            Output::Label { control, text } => {
                shown.labels.insert(control, text.trim_end().to_owned());
            }
            Output::Midi(output) => shown.see(output),
        };
        match &mut self.device {
            Simulated::DialBox(dial_box, _) => dial_box.drain_outputs().for_each(|(_, output)| see(output)),
            Simulated::Serial(device, _) => device.drain_outputs(&mut |_, output| see(output)),
            Simulated::Tablet(..) | Simulated::Bus(_) => {}
        }
    }

    pub(crate) fn is_connected(&self) -> bool {
        self.connected
    }

    /// Opens the port; whoever had it open before finds the device gone.
    pub(crate) fn open(&mut self, now_us: u64, baud: u32) -> Option<u64> {
        self.advance(now_us);
        if !self.connected {
            return None;
        }
        // What arrived before anybody listened is not kept by a port that was closed.
        self.inbox.clear();
        self.firmware().set_line_baud(now_us, baud);
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
            Simulated::DialBox(dial_box, _) => dial_box.touch(now_us, touch),
            Simulated::Tablet(tablet, _) => tablet.touch(now_us, touch),
            Simulated::Serial(device, _) => device.touch(now_us, touch),
            Simulated::Bus(_) => false,
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
