//! A HID device by its node: reports in and out, feature reports, report descriptor, USB strings.
//!
//! Two threads a device: one reads and notes arrivals, one does what may block. Each has the node open for itself;
//! the kernel gives every reader all reports. Reading is done here, since the HID library gives up as soon as a device is
//! gone, with the reports untaken that came before. Source: Linux `Documentation/hid/hidraw.rst`, `drivers/hid/hidraw.c`
//! (`hidraw_read` hands out what waits before it says that there is no device).

use super::errands::{Errands, Question, Talking};
use super::intake::{Intake, Reading, gone};
use super::usb::UsbStrings;
use super::{Boundary, Transport, TransportError, descriptor};
use crate::clock::{Clock, Instant};
use crate::transport::adapter::UsbPlace;
use hidapi::{HidApi, HidDevice, HidError};
use rustix::fd::{AsFd, OwnedFd};
use rustix::fs::{Mode, OFlags};
use std::ffi::CString;
use std::io;
use std::sync::Arc;
use std::time::Duration;

/// What grants the right to open a HID device.
pub const HID_HINT: &str = "install the rule that grants it (`sudo dialrig devices --install-rules` writes it), then plug the device out and in";

/// A report descriptor is at most so long: `HID_MAX_DESCRIPTOR_SIZE` of Linux `hid.h`.
const DESCRIPTOR_BYTES_MAX: usize = 4096;

/// An open device.
pub struct HidTransport {
    address: String,
    intake: Intake,
    errands: Errands,
    descriptor: Vec<u8>,
}

/// Opens the node at `path`, such as `/dev/hidraw0`. `usb` is where the device hangs, for its strings; without it they
/// cannot be asked for. Arrivals are noted by `clock`.
pub fn open(
    path: &str,
    usb: Option<UsbPlace>,
    clock: Arc<dyn Clock>,
) -> Result<HidTransport, TransportError> {
    // The library says in words why it could not open something; the system says it by a number that can be sorted.
    let flags = OFlags::RDWR | OFlags::NONBLOCK | OFlags::CLOEXEC;
    let reader = rustix::fs::open(path, flags, Mode::empty())
        .map_err(|e| TransportError::from_io(path, HID_HINT, e.into()))?;
    let name = path.rsplit('/').next().unwrap_or(path);
    let threads = |source| TransportError::Io {
        address: path.to_owned(),
        source,
    };
    // At once: the kernel holds 64 reports for a reader, and what follows may take a while.
    let intake = Intake::spawn(name, clock, Box::new(Listening(reader))).map_err(threads)?;
    let api = HidApi::new().map_err(|e| refusal(path, "the HID library did not start", &e))?;
    let talker = open_node(&api, path)?;
    let mut descriptor = vec![0; DESCRIPTOR_BYTES_MAX];
    let length = talker
        .get_report_descriptor(&mut descriptor)
        .map_err(|e| refusal(path, "its report descriptor cannot be read", &e))?;
    descriptor.truncate(length);
    let talking = Node {
        address: path.to_owned(),
        device: talker,
        usb,
        strings: None,
    };
    Ok(HidTransport {
        address: path.to_owned(),
        intake,
        errands: Errands::spawn(path, name, Box::new(talking)).map_err(threads)?,
        descriptor,
    })
}

fn open_node(api: &HidApi, path: &str) -> Result<HidDevice, TransportError> {
    let node = CString::new(path).map_err(|_| TransportError::Address {
        address: path.to_owned(),
    })?;
    api.open_path(&node)
        .map_err(|e| refusal(path, "expected a HID device, found something else", &e))
}

/// The library's error as ours. None of its refusals means that the device is gone: the reading thread finds that out.
fn refusal(address: &str, what: &str, error: &HidError) -> TransportError {
    TransportError::Io {
        address: address.to_owned(),
        source: io::Error::other(format!("{what}: {error}")),
    }
}

struct Listening(OwnedFd);

impl Reading for Listening {
    fn read(&mut self, buffer: &mut [u8], limit: Duration) -> io::Result<usize> {
        descriptor::read_within(self.0.as_fd(), buffer, limit)
    }
}

struct Node {
    address: String,
    device: HidDevice,
    usb: Option<UsbPlace>,
    strings: Option<UsbStrings>,
}

impl Talking for Node {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let sent = self
            .device
            .write(bytes)
            .map_err(|e| refusal(&self.address, "output report refused", &e))?;
        // Drivers count the id of a device without ids or not.
        if sent + 1 < bytes.len() {
            return Err(TransportError::Io {
                address: self.address.clone(),
                source: io::Error::other(format!(
                    "output report of {} bytes: the device took {sent}",
                    bytes.len()
                )),
            });
        }
        Ok(())
    }

    fn write_feature(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.device
            .send_feature_report(bytes)
            .map_err(|e| refusal(&self.address, "feature report refused", &e))
    }

    fn read_feature(&mut self, id: u8, bytes: usize) -> Result<Vec<u8>, TransportError> {
        let mut report = vec![0; bytes.max(1)];
        report[0] = id;
        let count = self
            .device
            .get_feature_report(&mut report)
            .map_err(|e| refusal(&self.address, "feature report not given", &e))?;
        report.truncate(count);
        Ok(report)
    }

    fn read_string(&mut self, index: u8) -> Result<Vec<u8>, TransportError> {
        let place = self.usb.ok_or(TransportError::Unsupported {
            what: "USB strings, as it does not hang on USB",
        })?;
        let strings = match self.strings.take() {
            Some(strings) => strings,
            None => UsbStrings::open(&self.address, place)?,
        };
        let answer = strings.read(&self.address, index);
        self.strings = Some(strings);
        answer
    }
}

impl Transport for HidTransport {
    fn boundary(&self) -> Boundary {
        Boundary::Reports
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        self.intake.read(buffer).ok_or_else(|| gone(&self.address))
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.errands.write(bytes)
    }

    fn write_feature(&mut self, bytes: &[u8]) -> Result<Option<()>, TransportError> {
        Ok(self.errands.ask(Question::SetFeature(bytes.to_vec()))?.map(drop))
    }

    fn read_feature(&mut self, id: u8, buffer: &mut [u8]) -> Result<Option<usize>, TransportError> {
        let bytes = buffer.len();
        let answer = self.errands.ask(Question::Feature { id, bytes })?;
        Ok(answer.map(|report| {
            for (place, byte) in buffer.iter_mut().zip(&report) {
                *place = *byte;
            }
            report.len().min(bytes)
        }))
    }

    fn read_string(&mut self, index: u8) -> Result<Option<Vec<u8>>, TransportError> {
        self.errands.ask(Question::Text(index))
    }

    fn report_descriptor(&mut self) -> Result<Vec<u8>, TransportError> {
        Ok(self.descriptor.clone())
    }

    fn arrived(&self) -> Option<Instant> {
        self.intake.arrived()
    }

    fn dropped(&self) -> u64 {
        self.intake.dropped()
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        self.intake.wait(clock, until);
    }

    fn ready(&mut self) -> bool {
        self.intake.ready()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::VirtualClock;

    #[test]
    fn what_is_no_hid_device_is_refused_in_words() {
        let open = |path: &str| {
            open(path, None, Arc::new(VirtualClock::new()))
                .err()
                .expect("there is no such device")
        };
        assert!(matches!(open("/dev/hidraw99"), TransportError::NotFound { .. }));
        let other = open("/dev/null").to_string();
        assert!(other.starts_with("/dev/null: expected a HID device"), "{other}");
    }
}
