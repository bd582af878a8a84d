//! What all simulated devices on serial lines have in common: power, line, hands, scripts, faults. The rest is
//! [`Inside`].
//!
//! Everything happens at its own moment and in one order: power, then the host's byte, then hands, then what the device
//! does by itself. How often it was looked at changes nothing.
//! Must not know: any wire format. Start reading at [`Inside`].

use crate::dial_box::Output;
use crate::firmware::Firmware;
use crate::hands::{Hands, Schedule, Touch, noise};
use crate::input_fault::{Faults, InputFault};
use crate::line::{Line, shortened};
use crate::script::{Device, Script};
use crate::serial_kinds::SerialDevice;
use crate::uart::Parity;

/// What differs from device to device. Nothing here knows the time but by its [`Wire`].
pub trait Inside: Send {
    /// A byte of the host's has arrived. Not called while the device boots.
    fn hear(&mut self, wire: &mut Wire, byte: u8);

    /// When the device next does something by itself (says what it has to say, moves on in a turn), nanoseconds.
    fn next_ns(&self, wire: &Wire) -> Option<u64>;

    /// Does it. Called once for each moment that [`Inside::next_ns`] named.
    fn happen(&mut self, wire: &mut Wire);

    /// A hand does something; false: there is no such control. Power and noise are seen to already.
    fn touch(&mut self, wire: &mut Wire, touch: &Touch) -> bool;

    /// Power was lost and is back, and what was under way is gone: modes are as they come, hands stay where they are. A
    /// device that needs a while says so with `Wire::boot`.
    fn lose_power(&mut self, wire: &mut Wire);

    /// The device has booted.
    fn booted(&mut self, _wire: &mut Wire) {}

    /// The host is about to put bytes on the line.
    fn host_writes(&mut self, _wire: &mut Wire) {}

    /// The host opens its port, which raises DTR.
    fn port_opened(&mut self, _wire: &mut Wire) {}

    /// Whether a movement that a script began is still under way.
    fn is_moving(&self) -> bool {
        false
    }

    /// Whether the cable has a speed that no host can change.
    fn has_one_speed(&self) -> bool {
        false
    }

    /// What hands may do to it.
    fn controls(&self) -> Device;
}

/// The device's end of its cable, and its sense of time.
#[derive(Clone, Debug)]
pub struct Wire {
    line: Line,
    /// Speed and parity at which a host's port must begin.
    home: (u32, Parity),
    reached_ns: u64,
    booting_until_ns: Option<u64>,
    schedule: Schedule,
    outputs: Vec<(u64, Output)>,
    faults: Faults<Vec<u8>>,
    /// What was said last: what a flood is made of.
    last: Vec<u8>,
}

impl Wire {
    fn new(baud: u32, parity: Parity, drift_ppm: i32) -> Self {
        Self {
            line: Line::with_parity(baud, parity, drift_ppm),
            home: (baud, parity),
            reached_ns: 0,
            booting_until_ns: None,
            schedule: Schedule::default(),
            outputs: Vec::new(),
            faults: Faults::default(),
            last: Vec::new(),
        }
    }

    /// Now, in nanoseconds of the host's time.
    pub(crate) fn now_ns(&self) -> u64 {
        self.reached_ns
    }

    /// So much of the device's own time, in true nanoseconds.
    pub(crate) fn span_ns(&self, ns: u64) -> u64 {
        shortened(ns, self.line.drift_ppm())
    }

    /// Puts one whole message on the line, now or behind what is on it already.
    pub(crate) fn say(&mut self, message: &[u8]) {
        self.last.clear();
        self.last.extend_from_slice(message);
        let became = self.faults.mangle(message.to_vec());
        if became.is_empty() {
            self.line.device_loses(self.reached_ns, message.len());
        }
        for struck in became {
            self.line.device_sends(self.reached_ns, &struck);
        }
    }

    /// From when on the device's side of the line is idle, no earlier than now.
    pub(crate) fn free_ns(&self) -> u64 {
        self.line.device_free_ns().max(self.reached_ns)
    }

    /// How long a byte of the device's takes.
    pub(crate) fn byte_ns(&self) -> u64 {
        self.line.device_byte_ns()
    }

    /// The speed the device speaks and hears at.
    pub(crate) fn baud(&self) -> u32 {
        self.line.device_baud()
    }

    /// The device changes its own speed; what it has said goes at the old one.
    pub(crate) fn set_baud(&mut self, baud: u32) {
        self.line.set_device_baud(baud);
    }

    /// The device sets its speed by what the host sends.
    pub(crate) fn find_speed(&mut self) {
        self.line.find_speed();
    }

    /// Whether the device is starting and neither hears nor says anything.
    pub(crate) fn is_booting(&self) -> bool {
        self.booting_until_ns.is_some()
    }

    /// Begins to start, which takes so long.
    pub(crate) fn boot(&mut self, for_ns: u64) {
        self.line.device_stops(self.reached_ns);
        self.booting_until_ns = Some(self.reached_ns + for_ns);
    }

    /// What has been said and is not yet on the wire never will be.
    pub(crate) fn stop(&mut self) {
        self.line.device_stops(self.reached_ns);
    }

    /// Reporting is on: scripts count from the first time.
    pub(crate) fn begin_script(&mut self) {
        self.schedule.begin(self.reached_ns);
    }

    /// The host has had something shown.
    pub(crate) fn show(&mut self, output: Output) {
        self.outputs.push((self.reached_ns / 1000, output));
    }

    fn flood_ns(&self) -> Option<u64> {
        self.faults.flood_slot_us().map(|us| us * 1000)
    }

    fn is_due(&self, event_ns: Option<u64>) -> bool {
        event_ns.is_some_and(|at_ns| at_ns <= self.reached_ns)
    }

    /// Says the last message again if there is room for it.
    fn flood(&mut self) {
        let due = self.faults.flood_begins_slot(self.reached_ns / 1000);
        if due && self.line.device_free_ns() <= self.reached_ns {
            self.line.device_sends(self.reached_ns, &self.last);
        }
    }

    fn strike(&mut self, fault: InputFault) -> bool {
        if matches!(fault, InputFault::UnplugAfterRequests(_)) {
            return false;
        }
        self.faults.add(self.reached_ns / 1000, fault);
        while let Some(nonsense) = self.faults.early() {
            self.line.device_sends(self.reached_ns, &nonsense);
        }
        true
    }
}

/// A device, its line, and the hands on it.
#[derive(Clone, Debug)]
pub struct SerialChassis<D> {
    pub(crate) inside: D,
    pub(crate) wire: Wire,
}

impl<D: Inside> SerialChassis<D> {
    /// A device that has been on for a while, at this speed and parity, by a clock that is `drift_ppm` millionths fast.
    pub(crate) fn around(inside: D, baud: u32, parity: Parity, drift_ppm: i32) -> Self {
        Self {
            inside,
            wire: Wire::new(baud, parity, drift_ppm),
        }
    }

    /// Plays `script` as well, its times counted from [`Hands::reporting_since_us`].
    pub fn play(&mut self, script: &Script) {
        self.wire.schedule.play(script);
    }

    /// Whether every scripted touch has been made.
    pub fn script_is_done(&self) -> bool {
        self.wire.schedule.is_done() && !self.inside.is_moving()
    }

    /// Takes what the host has made it show, each with its time in microseconds.
    pub fn drain_outputs(&mut self) -> impl Iterator<Item = (u64, Output)> + '_ {
        self.wire.outputs.drain(..)
    }

    pub(crate) fn catch_up(&mut self, now_us: u64) -> u64 {
        let now_ns = (now_us * 1000).max(self.wire.reached_ns);
        self.advance(now_ns);
        now_ns
    }

    /// Lets everything happen, in its order, that happens up to `to_ns`.
    pub(crate) fn advance(&mut self, to_ns: u64) {
        loop {
            let wire = &self.wire;
            let events = [
                wire.booting_until_ns,
                wire.line.next_arrival_ns(),
                wire.schedule.next_ns(),
                self.inside.next_ns(wire),
                wire.flood_ns(),
            ];
            let Some(at_ns) = events.into_iter().flatten().min().filter(|&at| at <= to_ns) else {
                break;
            };
            self.wire.reached_ns = self.wire.reached_ns.max(at_ns);
            self.happen();
        }
        self.wire.reached_ns = self.wire.reached_ns.max(to_ns);
    }

    fn happen(&mut self) {
        let Self { inside, wire } = self;
        if wire.is_due(wire.booting_until_ns) {
            wire.booting_until_ns = None;
            inside.booted(wire);
        } else if let Some((_, byte)) = wire.line.arrival(wire.reached_ns) {
            if !wire.is_booting() {
                inside.hear(wire, byte);
            }
        } else if wire.is_due(wire.schedule.next_ns()) {
            if let Some(touch) = wire.schedule.pop() {
                self.touch_now(&touch);
            }
        } else if wire.is_due(inside.next_ns(wire)) {
            inside.happen(wire);
        } else {
            wire.flood();
        }
    }

    fn touch_now(&mut self, touch: &Touch) -> bool {
        let Self { inside, wire } = self;
        match touch {
            Touch::PowerCycle => {
                wire.stop();
                inside.lose_power(wire);
                true
            }
            Touch::Noise(bytes) => {
                wire.line.device_sends(wire.reached_ns, &noise(*bytes));
                true
            }
            touch => inside.touch(wire, touch),
        }
    }
}

impl<D: Inside> Firmware for SerialChassis<D> {
    fn receive(&mut self, now_us: u64, bytes: &[u8]) {
        let now_ns = self.catch_up(now_us);
        self.inside.host_writes(&mut self.wire);
        self.wire.line.host_sends(now_ns, bytes);
    }

    fn transmit(&mut self, now_us: u64, out: &mut Vec<u8>) {
        let now_ns = self.catch_up(now_us);
        self.wire.line.deliver(now_ns, out);
    }

    fn set_line_baud(&mut self, now_us: u64, baud: u32) {
        self.catch_up(now_us);
        if !self.inside.has_one_speed() {
            self.wire.line.set_host_baud(baud);
        }
    }

    fn set_line_parity(&mut self, now_us: u64, parity: Parity) {
        self.catch_up(now_us);
        if !self.inside.has_one_speed() {
            self.wire.line.set_host_parity(parity);
        }
    }

    fn port_opened(&mut self, now_us: u64) {
        self.catch_up(now_us);
        self.inside.port_opened(&mut self.wire);
    }

    fn next_byte_us(&self) -> Option<u64> {
        self.wire.line.next_delivery_ns().map(|ns| ns.div_ceil(1000))
    }
}

impl<D: Inside> Hands for SerialChassis<D> {
    fn touch(&mut self, now_us: u64, touch: &Touch) -> bool {
        let now_ns = self.catch_up(now_us);
        let touched = self.touch_now(touch);
        self.advance(now_ns);
        touched
    }

    fn reporting_since_us(&self) -> Option<u64> {
        self.wire.schedule.since_us()
    }
}

impl<D: Inside> SerialDevice for SerialChassis<D> {
    fn play(&mut self, script: &Script) {
        self.wire.schedule.play(script);
    }

    fn script_is_done(&self) -> bool {
        self.script_is_done()
    }

    fn take_outputs(&mut self, take: &mut dyn FnMut(u64, Output)) {
        for (at_us, output) in self.drain_outputs() {
            take(at_us, output);
        }
    }

    fn line(&self) -> (u32, Parity) {
        self.wire.home
    }

    fn controls(&self) -> Device {
        self.inside.controls()
    }

    fn inject(&mut self, now_us: u64, fault: InputFault) -> bool {
        self.catch_up(now_us);
        self.wire.strike(fault)
    }
}

#[cfg(test)]
mod tests;
