//! What is at the end of a cable: a USB device as its descriptors and transfers, whatever is inside.

mod acm;
pub mod descriptor;
mod ftdi;
mod hid;
mod midi;

pub use acm::Acm;
pub use ftdi::{Ftdi, baud_of_divisor};
pub use hid::Hid;
pub use midi::Midi;

/// The eight bytes that begin a control transfer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setup {
    /// Direction, kind, recipient.
    pub kind: u8,
    /// Which request.
    pub request: u8,
    /// `wValue`.
    pub value: u16,
    /// `wIndex`.
    pub index: u16,
    /// `wLength`.
    pub length: u16,
}

impl Setup {
    /// Reads the eight bytes.
    pub fn read(bytes: [u8; 8]) -> Self {
        let word = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
        Self {
            kind: bytes[0],
            request: bytes[1],
            value: word(2),
            index: word(4),
            length: word(6),
        }
    }
}

/// The device refuses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refused;

/// A USB device. Times are microseconds since the simulation began.
pub trait Function: Send {
    /// How often it has come onto the bus, 0 while it is off it.
    fn arrival(&mut self, _now_us: u64) -> u32 {
        1
    }

    /// `idVendor` and `idProduct`.
    fn ids(&self) -> [u16; 2];

    /// The device descriptor, 18 bytes.
    fn device_descriptor(&self) -> Vec<u8>;

    /// The configuration descriptor with everything in it.
    fn configuration(&self) -> Vec<u8>;

    /// A string descriptor.
    fn string(&mut self, now_us: u64, index: u8) -> Result<Vec<u8>, Refused>;

    /// A request that is not one of those every device answers alike.
    fn control(&mut self, now_us: u64, setup: Setup, data: &[u8]) -> Result<Vec<u8>, Refused>;

    /// Bytes for an endpoint.
    fn send(&mut self, now_us: u64, endpoint: u8, data: &[u8]) -> Result<(), Refused>;

    /// What an endpoint has to say, at most `room` bytes; nothing: the transfer waits.
    fn fetch(&mut self, now_us: u64, endpoint: u8, room: usize) -> Option<Vec<u8>>;

    /// The host begins or ends asking an endpoint.
    fn listened(&mut self, _now_us: u64, _endpoint: u8, _on: bool) {}

    /// The cable is put in or pulled out.
    fn plugged(&mut self, _now_us: u64, _in: bool) {}
}
