//! Moving bytes. A transport knows an address and whether the far end is still there, and no format.

pub mod adapter;
pub mod address;
mod closed;
mod descriptor;
mod errands;
mod error;
pub mod hid;
mod intake;
pub mod memory;
pub mod merged;
#[cfg(feature = "midir")]
pub mod midi_ports;
pub mod midi_raw;
pub mod osc;
pub mod ports;
pub mod pty;
pub mod serial;
pub mod stamped;
pub mod stamped_serial;
pub mod tcp;
mod usb;
mod waiting;

pub use address::{Address, open};
pub(crate) use closed::Closed;
pub use error::TransportError;
pub use usb::read_usb_string;
pub use waiting::{Awaited, LINES_MAX, wait_any};

use crate::clock::{Clock, Instant};
use rustix::fd::BorrowedFd;
use std::time::Duration;

/// What one [`Transport::read`] returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// Any piece of a stream (serial, TCP).
    Stream,
    /// Exactly one report (HID), as the device sent it: its id first only where the device numbers its reports.
    Reports,
}

/// How long the default [`Transport::wait`] sleeps between looks: well below a byte's time at 9600 baud
/// (1 ms) and near the shortest sleep an ordinary kernel keeps.
pub const WAIT_STEP: Duration = Duration::from_micros(100);

/// One end of a line.
pub trait Transport: Send {
    /// Whether one `read` is one report or any piece of a stream.
    fn boundary(&self) -> Boundary;

    /// Whatever has arrived; 0 means nothing yet. Never blocks.
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError>;

    /// Sends all of `bytes`.
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError>;

    /// Changes the line speed; a transport without one agrees and does nothing.
    fn set_baud(&mut self, _baud: u32) -> Result<(), TransportError> {
        Ok(())
    }

    /// Returns at `until`, or earlier when bytes are known to be there (or the far end to be gone).
    /// The default only sleeps, in steps, asking [`Transport::ready`] between them.
    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        while clock.now() < until && !self.ready() {
            clock.sleep_until(until.min(clock.now().after(WAIT_STEP)));
        }
    }

    /// Whether bytes are known to be waiting; false also means "cannot tell".
    fn ready(&mut self) -> bool {
        false
    }

    /// Sets a feature report, its id first (0 where the device numbers none). `None`: begun, and not done yet; the
    /// same call later tells. A device that refuses is no reason to think it gone.
    fn write_feature(&mut self, _bytes: &[u8]) -> Result<Option<()>, TransportError> {
        Err(TransportError::Unsupported {
            what: "feature reports",
        })
    }

    /// Reads the feature report `id` into `buffer`, id first, and returns its length. `None`: asked, and not answered
    /// yet; the same call later fetches the answer.
    fn read_feature(&mut self, _id: u8, _buffer: &mut [u8]) -> Result<Option<usize>, TransportError> {
        Err(TransportError::Unsupported {
            what: "feature reports",
        })
    }

    /// Reads a USB string descriptor with its head of two bytes. `None`: not answered yet, as above.
    fn read_string(&mut self, _index: u8) -> Result<Option<Vec<u8>>, TransportError> {
        Err(TransportError::Unsupported { what: "USB strings" })
    }

    /// The HID report descriptor, which the system read when the device was plugged in.
    fn report_descriptor(&mut self) -> Result<Vec<u8>, TransportError> {
        Err(TransportError::Unsupported {
            what: "a report descriptor",
        })
    }

    /// When the last byte of what the latest [`Transport::read`] returned arrived, where that was noted; never later
    /// than the read.
    fn arrived(&self) -> Option<Instant> {
        None
    }

    /// Reports thrown away so far because they came faster than they were read.
    fn dropped(&self) -> u64 {
        0
    }

    /// What the system can wait for together with others ([`wait_any`]); none where bytes come from inside the
    /// program.
    fn descriptor(&self) -> Option<BorrowedFd<'_>> {
        None
    }
}

impl Transport for Box<dyn Transport> {
    fn boundary(&self) -> Boundary {
        (**self).boundary()
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        (**self).read(buffer)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        (**self).write(bytes)
    }

    fn set_baud(&mut self, baud: u32) -> Result<(), TransportError> {
        (**self).set_baud(baud)
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        (**self).wait(clock, until);
    }

    fn ready(&mut self) -> bool {
        (**self).ready()
    }

    fn write_feature(&mut self, bytes: &[u8]) -> Result<Option<()>, TransportError> {
        (**self).write_feature(bytes)
    }

    fn read_feature(&mut self, id: u8, buffer: &mut [u8]) -> Result<Option<usize>, TransportError> {
        (**self).read_feature(id, buffer)
    }

    fn read_string(&mut self, index: u8) -> Result<Option<Vec<u8>>, TransportError> {
        (**self).read_string(index)
    }

    fn report_descriptor(&mut self) -> Result<Vec<u8>, TransportError> {
        (**self).report_descriptor()
    }

    fn arrived(&self) -> Option<Instant> {
        (**self).arrived()
    }

    fn dropped(&self) -> u64 {
        (**self).dropped()
    }

    fn descriptor(&self) -> Option<BorrowedFd<'_>> {
        (**self).descriptor()
    }
}
