//! Packets of Dynamixel 1.0 and Feetech: `FF FF id length instruction parameters sum`.
//!
//! Source: ROBOTIS e-manual, "DYNAMIXEL Protocol 1.0"; Feetech's notes describe the same frame.

use super::error::FramingError;
use device_profiles::ServoProtocol;

/// First bytes of every packet.
pub(super) const HEADER: [u8; 2] = [0xff, 0xff];
/// Header, id and length field.
pub(super) const PREFIX_BYTES: usize = 4;
/// Where the length field stands.
const LENGTH_AT: usize = 3;
/// Bytes counted by the length field beside the parameters: instruction and sum.
const LENGTH_OVERHEAD_BYTES: usize = 2;

/// The low byte of the sum of everything between header and checksum, inverted.
pub fn checksum(bytes: &[u8]) -> u8 {
    !bytes.iter().fold(0_u8, |sum, &byte| sum.wrapping_add(byte))
}

/// A packet under construction at the end of a buffer.
pub(super) struct Frame<'a> {
    out: &'a mut Vec<u8>,
    start: usize,
}

impl<'a> Frame<'a> {
    pub(super) fn begin(out: &'a mut Vec<u8>, id: u8, instruction: u8) -> Self {
        let start = out.len();
        out.extend_from_slice(&HEADER);
        out.extend_from_slice(&[id, 0, instruction]);
        Self { out, start }
    }

    pub(super) fn extend(self, bytes: &[u8]) -> Self {
        self.out.extend_from_slice(bytes);
        self
    }

    /// Takes back what was begun.
    pub(super) fn fail(self, error: FramingError) -> Result<(), FramingError> {
        self.out.truncate(self.start);
        Err(error)
    }

    pub(super) fn finish(self) -> Result<(), FramingError> {
        let params = self.out.len().saturating_sub(self.start + PREFIX_BYTES + 1);
        let Ok(length) = u8::try_from(params + LENGTH_OVERHEAD_BYTES) else {
            return self.fail(FramingError::TooLong { bytes: params });
        };
        if let Some(field) = self.out.get_mut(self.start + LENGTH_AT) {
            *field = length;
        }
        let sum = self.out.get(self.start + HEADER.len()..).map_or(0, checksum);
        self.out.push(sum);
        Ok(())
    }
}

/// An address or length in the 8 bits there are for it.
pub(super) fn narrow(protocol: ServoProtocol, what: &'static str, value: u16) -> Result<u8, FramingError> {
    u8::try_from(value).map_err(|_| FramingError::TooWide {
        what,
        value,
        protocol,
    })
}

/// Appends one packet with any instruction byte; in an answer that byte is the error.
pub(super) fn encode(out: &mut Vec<u8>, id: u8, instruction: u8, params: &[u8]) -> Result<(), FramingError> {
    Frame::begin(out, id, instruction).extend(params).finish()
}

/// Appends an instruction whose parameters are an address and bytes.
pub(super) fn at_address(
    out: &mut Vec<u8>,
    id: u8,
    instruction: u8,
    address: u8,
    bytes: &[u8],
) -> Result<(), FramingError> {
    Frame::begin(out, id, instruction)
        .extend(&[address])
        .extend(bytes)
        .finish()
}

/// Appends a sync read of `length` bytes from `address`, answered in the order of `ids`.
pub(super) fn sync_read(
    out: &mut Vec<u8>,
    address: u8,
    length: u8,
    ids: impl IntoIterator<Item = u8>,
) -> Result<(), FramingError> {
    let mut frame = Frame::begin(out, super::BROADCAST_ID, 0x82).extend(&[address, length]);
    for id in ids {
        frame = frame.extend(&[id]);
    }
    frame.finish()
}

/// Appends a sync write; the first servo's bytes give the width for all.
pub(super) fn sync_write<Bytes: AsRef<[u8]>>(
    out: &mut Vec<u8>,
    address: u8,
    items: impl IntoIterator<Item = (u8, Bytes)>,
) -> Result<(), FramingError> {
    let mut items = items.into_iter().peekable();
    let want = items.peek().map_or(0, |(_, bytes)| bytes.as_ref().len());
    let frame = Frame::begin(out, super::BROADCAST_ID, 0x83);
    let Ok(width) = u8::try_from(want) else {
        return frame.fail(FramingError::TooLong { bytes: want });
    };
    let mut frame = frame.extend(&[address, width]);
    for (id, bytes) in items {
        let bytes = bytes.as_ref();
        let got = bytes.len();
        if got != want {
            return frame.fail(FramingError::Width { id, want, got });
        }
        frame = frame.extend(&[id]).extend(bytes);
    }
    frame.finish()
}
