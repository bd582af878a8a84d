//! A simulated USB input device as one of the kernel's own, through `/dev/uhid`: one node for each interface.
//!
//! The kernel knows nothing of USB here, so strings cannot be asked for: a device that becomes itself by a string
//! stays what it is before. Source: Linux, `include/uapi/linux/uhid.h` (one record of 4380 bytes each way).

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use device::clock::Clock;
use firmware_sim::script::ScriptError;
use firmware_sim::usb_device::{HidInterface, Shown, UsbFacts};
use firmware_sim::{InputFault, Script, USB_KINDS, UsbDevice, UsbKind, usb_kind};

use super::late::{LateFault, LateFaults};

/// Where the kernel takes devices.
pub const NODE: &str = "/dev/uhid";
const EVENT_BYTES: usize = 4380;
const DATA_MAX: usize = 4096;
const DESTROY: u32 = 1;
const OPEN: u32 = 4;
const CLOSE: u32 = 5;
const OUTPUT: u32 = 6;
const GET_REPORT: u32 = 9;
const GET_REPORT_REPLY: u32 = 10;
const CREATE: u32 = 11;
const INPUT: u32 = 12;
const SET_REPORT: u32 = 13;
const SET_REPORT_REPLY: u32 = 14;
const BUS_USB: u16 = 3;
const FEATURE_REPORT: u8 = 0;
/// `EIO`, the answer to what the device refuses.
const REFUSED: u16 = 5;
/// How soon a report, a request or a stop is noticed.
const LOOK: Duration = Duration::from_micros(500);

/// One interface as a node of the kernel's.
struct Node {
    file: File,
    interface: u8,
    numbered: bool,
}

/// A simulated USB input device ready to be served.
pub struct UsbServed {
    kind: &'static UsbKind,
    device: Box<dyn UsbDevice>,
    late: LateFaults,
}

/// Who speaks to a served device, and who hears of it.
pub struct UsbAudience<'a> {
    /// Called once its nodes are there.
    pub ready: &'a mut dyn FnMut(),
    /// What somebody at the keyboard wants of it now.
    pub orders: &'a mut dyn FnMut() -> Option<String>,
    /// Hears what it was made to show and when, microseconds since scripts count.
    pub shown: &'a mut dyn FnMut(u64, &Shown),
    /// Hears what came of an order and when, microseconds since it was served: what there is to say to it, or why not.
    pub answered: &'a mut dyn FnMut(u64, &Result<String, String>),
}

impl UsbServed {
    /// The device of this kind, plugged in; none where no such kind is simulated.
    pub fn of(kind: &str) -> Option<Self> {
        let kind = usb_kind(kind)?;
        Some(Self {
            kind,
            device: (kind.make)(),
            late: LateFaults::default(),
        })
    }

    /// The names of all kinds.
    pub fn kinds() -> impl Iterator<Item = &'static str> {
        USB_KINDS.iter().map(|kind| kind.name)
    }

    /// Plays a script, or says everything that is wrong with it.
    pub fn play(&mut self, text: &str) -> Result<(), Vec<ScriptError>> {
        self.device.play(&Script::parse(self.kind.controls, text)?);
        Ok(())
    }

    /// Brings a fault in when its time has come.
    pub fn fault(&mut self, fault: LateFault) {
        self.late.add(fault);
    }

    /// Is one of the kernel's devices until `stop` is set.
    pub fn run(
        &mut self,
        clock: &dyn Clock,
        stop: &AtomicBool,
        audience: &mut UsbAudience<'_>,
    ) -> io::Result<()> {
        let began = clock.now();
        let mut nodes = Nodes::default();
        let mut announced = false;
        while !stop.load(Ordering::Relaxed) {
            let now_us = clock.now().since(began).as_micros() as u64;
            if nodes.follow(&mut *self.device, now_us)? && !std::mem::replace(&mut announced, true) {
                (audience.ready)();
            }
            nodes.exchange(&mut *self.device, now_us)?;
            while let Some(fault) = self.late.take(self.device.reporting_since_us(), now_us) {
                self.device.inject(now_us, fault);
            }
            while let Some(order) = (audience.orders)() {
                (audience.answered)(now_us, &self.order(now_us, order.trim()));
            }
            let since_us = self.device.reporting_since_us().unwrap_or(now_us);
            for (at_us, shown) in self.device.drain_shown() {
                (audience.shown)(at_us.saturating_sub(since_us), &shown);
            }
            clock.sleep_until(clock.now().after(LOOK));
        }
        Ok(())
    }

    /// A hand, a fault, or the cable.
    fn order(&mut self, now_us: u64, order: &str) -> Result<String, String> {
        if let "unplug" | "plug" = order {
            self.device.plug(now_us, order == "plug");
            return Ok(order.to_owned());
        }
        if let Ok(fault) = InputFault::parse(order) {
            self.device.inject(now_us, fault);
            return Ok(order.to_owned());
        }
        let script = super::orders::hand(self.kind.controls, order)?;
        let touched = script
            .actions
            .iter()
            .all(|action| self.device.touch(now_us, &action.touch));
        let done = touched.then(|| order.to_owned());
        done.ok_or_else(|| format!("`{order}`: it has no such control"))
    }
}

/// The kernel's devices that a simulated one is.
#[derive(Default)]
struct Nodes {
    all: Vec<Node>,
    arrival: u32,
    event: Vec<u8>,
}

impl Nodes {
    /// Makes and destroys them as the device comes onto the bus and leaves it. True when it has come.
    fn follow(&mut self, device: &mut dyn UsbDevice, now_us: u64) -> io::Result<bool> {
        let arrival = device.arrival(now_us);
        if arrival == self.arrival {
            return Ok(false);
        }
        // Closing a node destroys its device.
        self.all.clear();
        self.arrival = arrival;
        if arrival == 0 {
            return Ok(false);
        }
        self.event.resize(EVENT_BYTES, 0);
        self.all = create(Path::new(NODE), device.facts())?;
        Ok(true)
    }

    fn exchange(&mut self, device: &mut dyn UsbDevice, now_us: u64) -> io::Result<()> {
        for node in &mut self.all {
            node.hear(device, now_us, &mut self.event)?;
        }
        while let Some(report) = device.report(now_us) {
            if let Some(node) = self
                .all
                .iter_mut()
                .find(|node| node.interface == report.interface)
            {
                node.say(&report.bytes)?;
            }
        }
        Ok(())
    }
}

fn put(event: &mut [u8], at: usize, bytes: &[u8]) {
    event[at..at + bytes.len()].copy_from_slice(bytes);
}

/// The record that makes an interface a device of the kernel's.
fn creation(facts: &UsbFacts, number: u8, interface: &HidInterface) -> Vec<u8> {
    let mut event = vec![0; EVENT_BYTES];
    let name = format!("{} {}", facts.manufacturer, facts.name);
    let place = format!("dialrig/{}/{number}", std::process::id());
    let descriptor = &interface.descriptor[..interface.descriptor.len().min(DATA_MAX)];
    put(&mut event, 0, &CREATE.to_le_bytes());
    put(&mut event, 4, &name.as_bytes()[..name.len().min(127)]);
    put(&mut event, 132, &place.as_bytes()[..place.len().min(63)]);
    let serial = facts.serial.unwrap_or_default();
    put(&mut event, 196, &serial.as_bytes()[..serial.len().min(63)]);
    put(&mut event, 260, &(descriptor.len() as u16).to_le_bytes());
    put(&mut event, 262, &BUS_USB.to_le_bytes());
    put(&mut event, 264, &u32::from(facts.vendor).to_le_bytes());
    put(&mut event, 268, &u32::from(facts.product).to_le_bytes());
    put(&mut event, 272, &u32::from(facts.release_bcd).to_le_bytes());
    put(&mut event, 280, descriptor);
    event
}

fn create(node: &Path, facts: &UsbFacts) -> io::Result<Vec<Node>> {
    let mut nodes = Vec::new();
    for (number, interface) in (0..).zip(&facts.interfaces) {
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .custom_flags(rustix::fs::OFlags::NONBLOCK.bits().cast_signed())
            .open(node)?;
        file.write_all(&creation(facts, number, interface))?;
        nodes.push(Node {
            file,
            interface: number,
            numbered: interface.numbered,
        });
    }
    Ok(nodes)
}

impl Node {
    /// A report as the kernel puts it: behind a 0 where reports are not numbered.
    fn wire<'a>(&self, bytes: &'a [u8]) -> &'a [u8] {
        if self.numbered {
            bytes
        } else {
            bytes.strip_prefix(&[0]).unwrap_or(bytes)
        }
    }

    fn say(&mut self, report: &[u8]) -> io::Result<()> {
        let mut event = Vec::with_capacity(6 + report.len());
        event.extend(INPUT.to_le_bytes());
        event.extend((report.len() as u16).to_le_bytes());
        event.extend_from_slice(report);
        self.file.write_all(&event)
    }

    /// Everything the kernel has said.
    fn hear(&mut self, device: &mut dyn UsbDevice, now_us: u64, event: &mut [u8]) -> io::Result<()> {
        loop {
            match self.file.read(event) {
                Ok(_) => self.obey(device, now_us, event)?,
                Err(error) if error.kind() == ErrorKind::WouldBlock => return Ok(()),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
    }

    fn obey(&mut self, device: &mut dyn UsbDevice, now_us: u64, event: &[u8]) -> io::Result<()> {
        let half = |at: usize| u16::from_le_bytes([event[at], event[at + 1]]);
        let kind = u32::from_le_bytes([event[0], event[1], event[2], event[3]]);
        let (request, id) = (&event[4..8], event[8]);
        match kind {
            OPEN => device.listen(now_us, self.interface, true),
            CLOSE => device.listen(now_us, self.interface, false),
            OUTPUT => {
                let length = usize::from(half(4100)).min(DATA_MAX);
                // The kernel does not wait for an answer, and a device that refuses says nothing.
                let _ = device.output(now_us, self.interface, self.wire(&event[4..4 + length]));
            }
            SET_REPORT => {
                let length = usize::from(half(10)).min(DATA_MAX);
                let bytes = self.wire(&event[12..12 + length]);
                let done = if event[9] == FEATURE_REPORT {
                    device.set_feature(now_us, self.interface, bytes)
                } else {
                    device.output(now_us, self.interface, bytes)
                };
                let status = if done.is_ok() { 0 } else { REFUSED };
                self.reply(SET_REPORT_REPLY, request, status, &[])?;
            }
            GET_REPORT => match device.feature(now_us, self.interface, id) {
                Ok(mut bytes) => {
                    if !self.numbered {
                        bytes.insert(0, 0);
                    }
                    self.reply(GET_REPORT_REPLY, request, 0, &bytes)?;
                }
                Err(_) => self.reply(GET_REPORT_REPLY, request, REFUSED, &[])?,
            },
            // Started and stopped: nobody listens yet or any more, which OPEN and CLOSE say as well.
            _ => {}
        }
        Ok(())
    }

    fn reply(&mut self, kind: u32, request: &[u8], status: u16, bytes: &[u8]) -> io::Result<()> {
        let mut event = vec![0; EVENT_BYTES];
        put(&mut event, 0, &kind.to_le_bytes());
        put(&mut event, 4, request);
        put(&mut event, 8, &status.to_le_bytes());
        if kind == GET_REPORT_REPLY {
            put(&mut event, 10, &(bytes.len() as u16).to_le_bytes());
            put(&mut event, 12, bytes);
        }
        self.file.write_all(&event)
    }
}

impl Drop for Node {
    fn drop(&mut self) {
        // Closing the file would do the same; a device that cannot be destroyed is gone already.
        let _ = self.file.write_all(&DESTROY.to_le_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_record_of_creation_has_its_fields_where_the_kernel_reads_them() {
        let device = firmware_sim::usb_kind("ctl-472").expect("there is one");
        let device = (device.make)();
        let facts = device.facts();
        let event = creation(facts, 0, &facts.interfaces[0]);
        assert_eq!(event.len(), EVENT_BYTES);
        assert_eq!(event[..4], [11, 0, 0, 0]);
        assert_eq!(&event[4..12], b"Wacom Co");
        let length = facts.interfaces[0].descriptor.len();
        assert_eq!(event[260..264], [length as u8, 0, 3, 0]);
        assert_eq!(event[264..272], [0x6A, 0x05, 0, 0, 0x7A, 0x03, 0, 0]);
        assert_eq!(event[280..280 + length], facts.interfaces[0].descriptor);
    }
}
