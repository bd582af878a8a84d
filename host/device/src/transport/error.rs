//! What can go wrong with a line, and what a person can do about it.

use std::io::{self, ErrorKind};

/// Every variant that has one names the address.
#[derive(Debug, thiserror::Error)]
pub enum TransportError {
    /// The far end was there and is not any more.
    #[error(
        "{address}: the device is gone (unplugged, switched off, or its program ended); plug it in again"
    )]
    Gone {
        /// As it was asked for.
        address: String,
    },
    /// The system refuses to open it.
    #[error("{address}: permission denied; {hint}")]
    Forbidden {
        /// As it was asked for.
        address: String,
        /// What grants it.
        hint: &'static str,
    },
    /// Another program holds it.
    #[error("{address}: in use by another program; close that one first (`fuser {address}` names it)")]
    Busy {
        /// As it was asked for.
        address: String,
    },
    /// There is no such thing.
    #[error("{address}: not found; check the plug, or list what there is with `dialrig devices`")]
    NotFound {
        /// As it was asked for.
        address: String,
    },
    /// The address means nothing.
    #[error(
        "\"{address}\" is not an address; expected /dev/NAME, tcp:HOST:PORT, usb:SERIAL, osc:PORT or sim:NAME"
    )]
    Address {
        /// As it was asked for.
        address: String,
    },
    /// Lines of this kind have no such thing.
    #[error("a line of this kind has no {what}")]
    Unsupported {
        /// What was asked for.
        what: &'static str,
    },
    /// Anything else, in the system's words.
    #[error("{address}: {source}")]
    Io {
        /// As it was asked for.
        address: String,
        /// The system's words.
        source: io::Error,
    },
}

/// Debian, Fedora and their kin give serial ports to `dialout`; Arch to `uucp`.
pub(crate) const SERIAL_HINT: &str = "add yourself to the group of the port (`sudo usermod -aG dialout $USER`, on Arch `uucp`) and log in again, \
or install a udev rule with TAG+=\"uaccess\" in a file that sorts before 73-seat-late.rules";

impl TransportError {
    /// The far end is gone, as far as this error tells.
    pub fn is_gone(&self) -> bool {
        matches!(self, Self::Gone { .. })
    }

    /// Sorts the system's error by what a person can do about it.
    // Two ways of being gone, a terminal's and a socket's, are told apart by their lines.
    #[allow(clippy::match_same_arms)]
    pub(crate) fn from_io(address: &str, hint: &'static str, source: io::Error) -> Self {
        // From errno(3); EIO is what a terminal whose master or cable has gone says.
        const ENOENT: i32 = 2;
        const EIO: i32 = 5;
        const ENXIO: i32 = 6;
        const EACCES: i32 = 13;
        const EPERM: i32 = 1;
        const EBUSY: i32 = 16;
        const ENODEV: i32 = 19;
        let address = address.to_owned();
        match (source.raw_os_error(), source.kind()) {
            (Some(ENOENT), _) | (None, ErrorKind::NotFound) => Self::NotFound { address },
            (Some(EACCES | EPERM), _) | (None, ErrorKind::PermissionDenied) => {
                Self::Forbidden { address, hint }
            }
            (Some(EBUSY), _) => Self::Busy { address },
            (Some(EIO | ENXIO | ENODEV), _) | (_, ErrorKind::BrokenPipe | ErrorKind::UnexpectedEof) => {
                Self::Gone { address }
            }
            (_, ErrorKind::ConnectionReset | ErrorKind::ConnectionAborted | ErrorKind::NotConnected) => {
                Self::Gone { address }
            }
            _ => Self::Io { address, source },
        }
    }
}
