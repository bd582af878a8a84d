//! A serial port: a real one, or the pseudo-terminal of a simulated device.
//!
//! Opened by `rustix` rather than by `serialport`, because `poll(2)` needs a descriptor that can be borrowed,
//! which that crate does not lend; its listing of ports is used in [`super::ports`].
//! Modem lines are left as the kernel sets them at opening (DTR and RTS on, which powers old devices); a
//! pseudo-terminal has none. Source: termios(3), `tty_ioctl`(4).

use super::error::SERIAL_HINT;
use super::{Boundary, Transport, TransportError, descriptor};
use crate::clock::{Clock, Instant};
use device_profiles::{Line, Parity};
use rustix::fd::{AsFd, BorrowedFd, OwnedFd};
use rustix::fs::{FlockOperation, Mode, OFlags};
use rustix::io::Errno;
use rustix::termios::{ControlModes, OptionalActions, QueueSelector, Termios};
use std::io;

/// An open port, 8 data bits, no parity, one stop bit, no flow control; ours alone while it exists.
#[derive(Debug)]
pub struct SerialTransport {
    address: String,
    fd: OwnedFd,
}

/// Opens `path` at `baud`. What arrived before is thrown away.
pub fn open(path: &str, baud: u32) -> Result<SerialTransport, TransportError> {
    open_as(path, baud, |_| {})
}

/// Opens `path` with the line's manners. A board that starts anew whenever its port is opened is left powered and
/// running when the port is closed, so that only the first opening after plugging restarts it.
pub fn open_line(path: &str, line: &Line) -> Result<SerialTransport, TransportError> {
    open_as(path, line.baud, |modes| {
        let mut set = |flag, on| modes.set(flag, on);
        set(ControlModes::PARENB, line.parity != Parity::None);
        set(ControlModes::PARODD, line.parity == Parity::Odd);
        set(ControlModes::CSTOPB, line.stop_bits == 2);
        set(ControlModes::CRTSCTS, line.rts_cts);
        set(ControlModes::HUPCL, line.boot_wait_ms == 0);
        modes.remove(ControlModes::CSIZE);
        modes.insert(match line.data_bits {
            7 => ControlModes::CS7,
            _ => ControlModes::CS8,
        });
    })
}

fn open_as(
    path: &str,
    baud: u32,
    manners: impl FnOnce(&mut ControlModes),
) -> Result<SerialTransport, TransportError> {
    let sort = |e: Errno| TransportError::from_io(path, SERIAL_HINT, e.into());
    // Without NONBLOCK an open would wait for a carrier that a three-wire cable never gives.
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
    let fd = rustix::fs::open(path, flags, Mode::empty()).map_err(sort)?;
    claim(&fd).map_err(sort)?;
    let mut settings = rustix::termios::tcgetattr(&fd).map_err(|e| not_a_port(path, e))?;
    settings.make_raw();
    settings
        .control_modes
        .remove(ControlModes::CSTOPB | ControlModes::PARENB | ControlModes::CRTSCTS);
    settings
        .control_modes
        .insert(ControlModes::CREAD | ControlModes::CLOCAL);
    manners(&mut settings.control_modes);
    apply(&fd, settings, baud).map_err(sort)?;
    rustix::termios::tcflush(&fd, QueueSelector::IFlush).map_err(sort)?;
    Ok(SerialTransport {
        address: path.to_owned(),
        fd,
    })
}

/// Two locks, because programs differ in which one they look at: the lock file's successor `flock`, and the
/// terminal's own, which the superuser passes.
fn claim(fd: &OwnedFd) -> Result<(), Errno> {
    match rustix::fs::flock(fd, FlockOperation::NonBlockingLockExclusive) {
        Err(Errno::WOULDBLOCK) => return Err(Errno::BUSY),
        other => other?,
    }
    match rustix::termios::ioctl_tiocexcl(fd) {
        // Some drivers have no such lock; the other one holds.
        Err(Errno::NOTTY) => Ok(()),
        other => other,
    }
}

fn not_a_port(path: &str, error: Errno) -> TransportError {
    if error == Errno::NOTTY {
        let message = "expected a serial port, found a file of another kind";
        return TransportError::Io {
            address: path.to_owned(),
            source: io::Error::new(io::ErrorKind::InvalidInput, message),
        };
    }
    TransportError::from_io(path, SERIAL_HINT, error.into())
}

fn apply(fd: &OwnedFd, mut settings: Termios, baud: u32) -> Result<(), Errno> {
    // Servos want speeds such as 1 000 000 and 4 500 000 that no name in termios.h has; Linux takes any.
    settings.set_speed(baud)?;
    rustix::termios::tcsetattr(fd, OptionalActions::Now, &settings)
}

impl SerialTransport {
    /// The path it was opened by.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Another handle of the same port, to read by.
    pub(super) fn handle(&self) -> Result<OwnedFd, TransportError> {
        self.fd.try_clone().map_err(|e| self.sorted(e))
    }

    fn sorted(&self, error: io::Error) -> TransportError {
        TransportError::from_io(&self.address, SERIAL_HINT, error)
    }
}

impl Transport for SerialTransport {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        descriptor::read(self.fd.as_fd(), buffer).map_err(|e| self.sorted(e))
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        descriptor::write(self.fd.as_fd(), bytes).map_err(|e| self.sorted(e))
    }

    fn set_baud(&mut self, baud: u32) -> Result<(), TransportError> {
        let settings = rustix::termios::tcgetattr(&self.fd).map_err(|e| self.sorted(e.into()))?;
        // What is still in the buffer belongs to the old speed.
        rustix::termios::tcdrain(&self.fd).map_err(|e| self.sorted(e.into()))?;
        apply(&self.fd, settings, baud).map_err(|e| self.sorted(e.into()))
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        descriptor::wait(self.fd.as_fd(), clock, until);
    }

    fn ready(&mut self) -> bool {
        descriptor::ready(self.fd.as_fd())
    }

    fn descriptor(&self) -> Option<BorrowedFd<'_>> {
        Some(self.fd.as_fd())
    }
}

impl Drop for SerialTransport {
    fn drop(&mut self) {
        // The terminal's lock outlives us where somebody else holds the same terminal open, as a simulator does.
        let _ = rustix::termios::ioctl_tiocnxcl(&self.fd);
    }
}
