//! A simulated USB input device in its place on the bench, and the host's end of its cable.
//!
//! `sim:NAME` is the interface that reports what the device is bought for. A device that leaves the bus is not in the
//! list until it is back, and whoever had it open finds it gone.

use std::sync::{Arc, Mutex};

use device::clock::{Clock, Instant};
use device::transport::{Boundary, Transport, TransportError, WAIT_STEP};
use device_profiles::InputProfile;
use firmware_sim::hands::Touch;
use firmware_sim::usb_device::{Shown, Stall};
use firmware_sim::{InputFault, UsbDevice};

use super::lock;
use super::seat::Measures;

/// A USB device with its cable.
pub(crate) struct UsbSeat {
    pub(crate) name: String,
    pub(crate) description: String,
    pub(crate) matches: Vec<String>,
    pub(crate) device: Box<dyn UsbDevice>,
    pub(super) measures: Measures,
    shown: Vec<Shown>,
    /// Reads, writes and questions that still succeed before the cable comes out by itself.
    calls_left: Option<u64>,
    /// Openings so far: one reader at a time, the last.
    openings: u64,
}

impl UsbSeat {
    pub(super) fn new(name: &str, profile: &InputProfile, device: Box<dyn UsbDevice>) -> Self {
        Self {
            name: name.to_owned(),
            description: format!("simulated: {}", profile.name),
            matches: vec![profile.key.clone()],
            device,
            measures: Measures::from(profile),
            shown: Vec::new(),
            calls_left: None,
            openings: 0,
        }
    }

    pub(super) fn is_connected(&mut self, now_us: u64) -> bool {
        self.device.arrival(now_us) != 0
    }

    pub(super) fn plug(&mut self, now_us: u64, connected: bool) {
        self.device.plug(now_us, connected);
    }

    pub(super) fn fail_after(&mut self, calls: u64) {
        self.calls_left = Some(calls);
    }

    pub(super) fn touch(&mut self, now_us: u64, touch: &Touch) -> bool {
        self.device.touch(now_us, touch)
    }

    pub(super) fn inject(&mut self, now_us: u64, fault: InputFault) {
        self.device.inject(now_us, fault);
    }

    /// Everything the host has had the device show, oldest first.
    pub(super) fn shown(&mut self) -> Vec<Shown> {
        let new = self.device.drain_shown().into_iter();
        self.shown.extend(new.map(|(_, shown)| shown));
        self.shown.clone()
    }

    /// Counts one call of the host's, and pulls the cable when it is time.
    fn call(&mut self, now_us: u64) {
        match &mut self.calls_left {
            Some(0) => {
                self.calls_left = None;
                self.plug(now_us, false);
            }
            Some(left) => *left -= 1,
            None => {}
        }
    }
}

/// The host's end of a simulated USB device's cable.
pub struct SimReports {
    address: String,
    seat: Arc<Mutex<UsbSeat>>,
    clock: Arc<dyn Clock>,
    /// The stay on the bus and the opening this end belongs to.
    stay: (u32, u64),
    interface: u8,
    numbered: bool,
    arrived: Option<Instant>,
    /// A report seen while looking whether there is one.
    held: Option<(u64, Vec<u8>)>,
}

impl SimReports {
    /// Opens the device's main interface; none while it is off the bus.
    pub(super) fn open(address: &str, seat: &Arc<Mutex<UsbSeat>>, clock: Arc<dyn Clock>) -> Option<Self> {
        let now_us = clock.now().as_micros();
        let mut there = lock(seat);
        let arrival = there.device.arrival(now_us);
        if arrival == 0 {
            return None;
        }
        there.openings += 1;
        let facts = there.device.facts();
        let interface = facts.main;
        let numbered = facts.interface(interface)?.numbered;
        there.device.listen(now_us, interface, true);
        let stay = (arrival, there.openings);
        drop(there);
        Some(Self {
            address: address.to_owned(),
            seat: Arc::clone(seat),
            clock,
            stay,
            interface,
            numbered,
            arrived: None,
            held: None,
        })
    }

    fn gone(&self) -> TransportError {
        TransportError::Gone {
            address: self.address.clone(),
        }
    }

    fn refused(&self, what: &str) -> TransportError {
        TransportError::Io {
            address: self.address.clone(),
            source: std::io::Error::other(format!("the device refused {what}")),
        }
    }

    fn is_there(&self, seat: &mut UsbSeat, now_us: u64) -> bool {
        (seat.device.arrival(now_us), seat.openings) == self.stay
    }

    /// One request of the host's: gone before it or in it, refused, or done.
    fn request<T>(
        &self,
        what: &str,
        ask: impl FnOnce(&mut dyn UsbDevice, u64) -> Result<T, Stall>,
    ) -> Result<T, TransportError> {
        let now_us = self.clock.now().as_micros();
        let mut seat = lock(&self.seat);
        seat.call(now_us);
        if !self.is_there(&mut seat, now_us) {
            return Err(self.gone());
        }
        let done = ask(&mut *seat.device, now_us);
        if done.is_err() && !self.is_there(&mut seat, now_us) {
            return Err(self.gone());
        }
        done.map_err(|_| self.refused(what))
    }

    /// Reports that hosts write begin with an id everywhere; the wire has one only where reports are numbered.
    fn wire<'a>(&self, bytes: &'a [u8]) -> &'a [u8] {
        let skipped = usize::from(!self.numbered).min(bytes.len());
        &bytes[skipped..]
    }

    /// The next report of this interface; those of others have readers of their own.
    fn next(&mut self, seat: &mut UsbSeat, now_us: u64) -> Option<(u64, Vec<u8>)> {
        if let Some(held) = self.held.take() {
            return Some(held);
        }
        while let Some((at_us, report)) = seat.device.arrived_report(now_us) {
            if report.interface == self.interface {
                return Some((at_us, report.bytes));
            }
        }
        None
    }
}

impl Transport for SimReports {
    fn boundary(&self) -> Boundary {
        Boundary::Reports
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let now_us = self.clock.now().as_micros();
        let shared = Arc::clone(&self.seat);
        let mut seat = lock(&shared);
        seat.call(now_us);
        if !self.is_there(&mut seat, now_us) {
            return Err(self.gone());
        }
        let Some((at_us, bytes)) = self.next(&mut seat, now_us) else {
            return Ok(0);
        };
        self.arrived = Some(Instant::from_nanos(at_us * 1000));
        let count = bytes.len().min(buffer.len());
        buffer[..count].copy_from_slice(&bytes[..count]);
        Ok(count)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let wire = self.wire(bytes);
        let interface = self.interface;
        self.request("the output report", |device, now_us| {
            device.output(now_us, interface, wire)
        })
    }

    fn write_feature(&mut self, bytes: &[u8]) -> Result<Option<()>, TransportError> {
        let wire = self.wire(bytes);
        let interface = self.interface;
        let set = self.request("the feature report", |device, now_us| {
            device.set_feature(now_us, interface, wire)
        });
        set.map(Some)
    }

    fn read_feature(&mut self, id: u8, buffer: &mut [u8]) -> Result<Option<usize>, TransportError> {
        let interface = self.interface;
        let wire = self.request("to say a feature report", |device, now_us| {
            device.feature(now_us, interface, id)
        })?;
        let mut bytes = wire;
        if !self.numbered {
            bytes.insert(0, 0);
        }
        let count = bytes.len().min(buffer.len());
        buffer[..count].copy_from_slice(&bytes[..count]);
        Ok(Some(count))
    }

    fn read_string(&mut self, index: u8) -> Result<Option<Vec<u8>>, TransportError> {
        self.request("to say a string", |device, now_us| device.string(now_us, index))
            .map(Some)
    }

    fn report_descriptor(&mut self) -> Result<Vec<u8>, TransportError> {
        let interface = self.interface;
        self.request("to say its report descriptor", |device, _| {
            let interface = device.facts().interface(interface).ok_or(Stall)?;
            Ok(interface.descriptor.clone())
        })
    }

    fn arrived(&self) -> Option<Instant> {
        self.arrived
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        while clock.now() < until && !self.ready() {
            let soon = clock.now().after(WAIT_STEP);
            let due = lock(&self.seat).device.next_report_us();
            let due = due.map(|us| Instant::from_nanos(us * 1000));
            clock.sleep_until(until.min(due.map_or(soon, |due| due.min(soon).max(clock.now()))));
        }
    }

    fn ready(&mut self) -> bool {
        let now_us = self.clock.now().as_micros();
        let shared = Arc::clone(&self.seat);
        let mut seat = lock(&shared);
        if !self.is_there(&mut seat, now_us) {
            return true;
        }
        self.held = self.next(&mut seat, now_us);
        self.held.is_some()
    }
}

impl Drop for SimReports {
    fn drop(&mut self) {
        let now_us = self.clock.now().as_micros();
        let mut seat = lock(&self.seat);
        if self.is_there(&mut seat, now_us) {
            seat.device.listen(now_us, self.interface, false);
        }
    }
}

#[cfg(test)]
#[path = "usb_tests.rs"]
mod tests;
