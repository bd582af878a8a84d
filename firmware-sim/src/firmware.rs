//! The seam every simulated device is used through: a serial cable seen from the host's end.
//!
//! Apart from the devices so that whoever holds the other end (a test, a pseudo terminal, a socket) needs
//! to know nothing else.

use crate::uart::Parity;

/// A device as the host's port sees it: bytes go in, bytes come out when the wire would have carried them.
///
/// Times are microseconds of the host's clock since the simulation began and must not run backwards; an
/// earlier time counts as the latest one seen. What comes out depends on what went in and when, never on
/// how often `transmit` was called between.
pub trait Firmware {
    /// The host puts `bytes` on the line at `now_us`; each arrives when the wire has carried it.
    fn receive(&mut self, now_us: u64, bytes: &[u8]);

    /// Appends to `out` every byte that has reached the host by `now_us`.
    fn transmit(&mut self, now_us: u64, out: &mut Vec<u8>);

    /// The host sets its port to `baud`, in bits per second. At the wrong speed both sides read garbage.
    fn set_line_baud(&mut self, now_us: u64, baud: u32);

    /// The host sets its port's parity. A device whose simulation knows no parity takes any.
    fn set_line_parity(&mut self, _now_us: u64, _parity: Parity) {}

    /// The host opens its port, which raises DTR: boards that restart with it do.
    fn port_opened(&mut self, _now_us: u64) {}

    /// When the next byte already on its way reaches the host; nothing if none is under way yet.
    /// A hint for sleeping: later calls may bring an earlier byte.
    fn next_byte_us(&self) -> Option<u64>;
}
