//! What a host writes to servos, read from the bytes alone.
//!
//! Written from the maker's protocol page and from nothing of the driver's, so that a goal is seen here as a servo
//! would see it. Source: e-manual, "DYNAMIXEL Protocol 2.0", Instruction Packet.

const HEADER: [u8; 4] = [0xFF, 0xFF, 0xFD, 0x00];
const WRITE: u8 = 0x03;
const REG_WRITE: u8 = 0x04;
const SYNC_WRITE: u8 = 0x83;
const BULK_WRITE: u8 = 0x93;

/// Some bytes that a host puts into one servo's control table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Written {
    pub(crate) id: u8,
    pub(crate) address: u16,
    pub(crate) data: Vec<u8>,
}

impl Written {
    /// The four bytes at `address` as the signed number they are; none if others were written.
    pub(crate) fn value_at(&self, address: u16) -> Option<i32> {
        let bytes: [u8; 4] = self.data.as_slice().try_into().ok()?;
        (self.address == address).then(|| i32::from_le_bytes(bytes))
    }

    /// Whether any byte from `first` to `last` is written.
    pub(crate) fn touches(&self, first: u16, last: u16) -> bool {
        let end = self.address + self.data.len() as u16;
        self.address <= last && first < end
    }
}

/// Every write in whole packets, one a servo. Bytes that are no packet are skipped.
pub(crate) fn writes(mut bytes: &[u8]) -> Vec<Written> {
    let mut found = Vec::new();
    while let Some(at) = bytes.windows(4).position(|four| four == HEADER) {
        bytes = &bytes[at..];
        let Some((id, instruction, params, rest)) = packet(bytes) else {
            bytes = &bytes[1..];
            continue;
        };
        read(id, instruction, &params, &mut found);
        bytes = rest;
    }
    found
}

/// Id, instruction, parameters without stuffing, and what follows.
fn packet(bytes: &[u8]) -> Option<(u8, u8, Vec<u8>, &[u8])> {
    let length = usize::from(u16::from_le_bytes([*bytes.get(5)?, *bytes.get(6)?]));
    let body = bytes.get(7..7 + length)?;
    let (inner, _checksum) = body.split_at_checked(length.checked_sub(2)?)?;
    let mut plain: Vec<u8> = Vec::with_capacity(inner.len());
    let mut stuffed = false;
    for &byte in inner {
        if stuffed && byte == 0xFD {
            stuffed = false;
            continue;
        }
        plain.push(byte);
        stuffed = plain.ends_with(&[0xFF, 0xFF, 0xFD]);
    }
    let (&instruction, params) = plain.split_first()?;
    Some((bytes[4], instruction, params.to_vec(), &bytes[7 + length..]))
}

fn read(id: u8, instruction: u8, params: &[u8], found: &mut Vec<Written>) {
    let word = |at: usize| Some(u16::from_le_bytes([*params.get(at)?, *params.get(at + 1)?]));
    let mut take = |id: u8, address: u16, data: &[u8]| {
        let data = data.to_vec();
        found.push(Written { id, address, data });
    };
    match (instruction, word(0), word(2)) {
        (WRITE | REG_WRITE, Some(address), _) => take(id, address, &params[2..]),
        (SYNC_WRITE, Some(address), Some(width)) => {
            for item in params[4..].chunks_exact(usize::from(width) + 1) {
                take(item[0], address, &item[1..]);
            }
        }
        (BULK_WRITE, ..) => {
            let mut at = 0;
            while let (Some(address), Some(width)) = (word(at + 1), word(at + 3)) {
                let end = at + 5 + usize::from(width);
                let Some(data) = params.get(at + 5..end) else {
                    return;
                };
                take(params[at], address, data);
                at = end;
            }
        }
        _ => {}
    }
}

#[test]
fn the_maker_s_examples_are_read() {
    // Write 512 to Goal Position (116) of servo 1; sync write 150 and 170 to servos 1 and 2; stuffed goal.
    // Source: e-manual, "Instruction Details"; the stuffed packet is worked out by hand.
    let write = [
        0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x09, 0x00, 0x03, 0x74, 0x00, 0x00, 0x02, 0x00, 0x00, 0xCA, 0x89,
    ];
    let sync = [
        0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x11, 0x00, 0x83, 0x74, 0x00, 0x04, 0x00, 0x01, 0x96, 0x00, 0x00, 0x00,
        0x02, 0xAA, 0x00, 0x00, 0x00, 0x82, 0x87,
    ];
    let stuffed = [
        0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x0A, 0x00, 0x03, 0x74, 0x00, 0xFF, 0xFF, 0xFD, 0xFD, 0x00, 0x21, 0xE7,
    ];
    let all = [&[1, 2, 0xFF][..], &write, &sync, &stuffed].concat();
    let goals: Vec<_> = writes(&all).iter().map(|w| (w.id, w.value_at(116))).collect();
    let want = [(1, 512), (1, 150), (2, 170), (1, 0x00FD_FFFF)];
    assert_eq!(goals, want.map(|(id, goal)| (id, Some(goal))));
}
