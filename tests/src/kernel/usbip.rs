//! The part of the USB/IP protocol that a device at the end of a socket needs: import, submit, unlink.
//!
//! All numbers are big-endian. Source: Linux, `Documentation/usb/usbip_protocol.rst`.

use std::io::{self, Read, Write};

/// Length of every message's head after the import.
const HEAD_BYTES: usize = 48;
const SUBMIT: u32 = 1;
const UNLINK: u32 = 2;
const RET_SUBMIT: u32 = 3;
const RET_UNLINK: u32 = 4;
/// Protocol version 1.1.1 and the two import messages.
const VERSION: u16 = 0x0111;
const REQUEST_IMPORT: u16 = 0x8003;
const REPLY_IMPORT: u16 = 0x0003;
const BUS_ID_BYTES: usize = 32;
const PATH_BYTES: usize = 256;
/// What `EPIPE` (a stall) and `ECONNRESET` (unlinked) are in a status.
pub const STALLED: i32 = -32;
const UNLINKED: i32 = -104;
/// Full speed, as `enum usb_device_speed` counts.
pub const FULL_SPEED: u32 = 2;
/// Longest transfer taken from the kernel; `cdc-acm` and `usbhid` stay far below.
const TRANSFER_MAX: usize = 1 << 20;

/// Who is on the line, for the import.
#[derive(Clone, Copy, Debug)]
pub struct Imported {
    /// `idVendor`.
    pub vendor: u16,
    /// `idProduct`.
    pub product: u16,
    /// Number on the bus 1 that we pretend to be.
    pub device: u32,
    /// `bNumInterfaces`.
    pub interfaces: u8,
}

/// One transfer the kernel wants.
#[derive(Clone, Debug)]
pub struct Submit {
    /// Its number, by which it is answered or called back.
    pub sequence: u32,
    /// Endpoint number without its direction.
    pub endpoint: u8,
    /// The device sends.
    pub inward: bool,
    /// Room for an answer, or the length of `data`.
    pub length: usize,
    /// The eight bytes of a control transfer.
    pub setup: [u8; 8],
    /// What goes out.
    pub data: Vec<u8>,
}

/// What the kernel says.
#[derive(Clone, Debug)]
pub enum Message {
    /// A transfer.
    Submit(Submit),
    /// Transfer `victim` is no longer wanted.
    Unlink {
        /// Number of this message.
        sequence: u32,
        /// Number of the transfer.
        victim: u32,
    },
}

/// Bytes from the kernel, cut into messages.
#[derive(Debug, Default)]
pub struct Inbox {
    bytes: Vec<u8>,
}

fn word(bytes: &[u8], at: usize) -> u32 {
    let four = bytes.get(at..at + 4).and_then(|four| four.try_into().ok());
    u32::from_be_bytes(four.unwrap_or_default())
}

impl Inbox {
    /// Takes what has arrived; false when the far end is closed.
    pub fn fill(&mut self, from: &mut impl Read) -> io::Result<bool> {
        let mut buffer = [0; 4096];
        loop {
            match from.read(&mut buffer) {
                Ok(0) => return Ok(false),
                Ok(count) => self.bytes.extend_from_slice(&buffer[..count]),
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return Ok(true),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
    }

    /// The next whole message.
    pub fn take(&mut self) -> io::Result<Option<Message>> {
        let Some(head) = self.bytes.get(..HEAD_BYTES) else {
            return Ok(None);
        };
        let (command, sequence, inward) = (word(head, 0), word(head, 4), word(head, 12) == 1);
        match command {
            SUBMIT => {
                let length = word(head, 24) as usize;
                if length > TRANSFER_MAX {
                    return Err(io::Error::other(format!("a transfer of {length} bytes")));
                }
                let whole = HEAD_BYTES + if inward { 0 } else { length };
                if self.bytes.len() < whole {
                    return Ok(None);
                }
                let submit = Submit {
                    sequence,
                    endpoint: word(head, 16) as u8,
                    inward,
                    length,
                    setup: head[40..48].try_into().unwrap_or_default(),
                    data: self.bytes[HEAD_BYTES..whole].to_vec(),
                };
                self.bytes.drain(..whole);
                Ok(Some(Message::Submit(submit)))
            }
            UNLINK => {
                let victim = word(head, 20);
                self.bytes.drain(..HEAD_BYTES);
                Ok(Some(Message::Unlink { sequence, victim }))
            }
            other => Err(io::Error::other(format!("an unknown USB/IP command {other}"))),
        }
    }
}

fn head(command: u32, sequence: u32, status: i32, actual: usize) -> [u8; HEAD_BYTES] {
    let mut bytes = [0; HEAD_BYTES];
    bytes[..4].copy_from_slice(&command.to_be_bytes());
    bytes[4..8].copy_from_slice(&sequence.to_be_bytes());
    bytes[20..24].copy_from_slice(&status.to_be_bytes());
    bytes[24..28].copy_from_slice(&(actual as u32).to_be_bytes());
    bytes
}

/// The answer to a transfer: what came in, how much went out, or a stall.
pub fn completed(submit: &Submit, result: Option<&[u8]>) -> Vec<u8> {
    let Some(data) = result else {
        return head(RET_SUBMIT, submit.sequence, STALLED, 0).to_vec();
    };
    if !submit.inward {
        return head(RET_SUBMIT, submit.sequence, 0, submit.length).to_vec();
    }
    let data = &data[..data.len().min(submit.length)];
    let mut bytes = head(RET_SUBMIT, submit.sequence, 0, data.len()).to_vec();
    bytes.extend_from_slice(data);
    bytes
}

/// The answer to an unlink: whether the transfer was still waiting.
pub fn unlinked(sequence: u32, was_waiting: bool) -> Vec<u8> {
    let status = if was_waiting { UNLINKED } else { 0 };
    head(RET_UNLINK, sequence, status, 0).to_vec()
}

/// The bus id that stands for `device`.
fn bus_id(device: u32) -> [u8; BUS_ID_BYTES] {
    let mut bytes = [0; BUS_ID_BYTES];
    for (place, byte) in bytes.iter_mut().zip(format!("1-{device}").bytes()) {
        *place = byte;
    }
    bytes
}

/// The client's half of an import: asks for `device`, and returns its number for the kernel and its speed.
pub fn import(line: &mut (impl Read + Write), device: u32) -> io::Result<(u32, u32)> {
    let mut request = Vec::with_capacity(8 + BUS_ID_BYTES);
    request.extend(VERSION.to_be_bytes());
    request.extend(REQUEST_IMPORT.to_be_bytes());
    request.extend([0; 4]);
    request.extend(bus_id(device));
    line.write_all(&request)?;
    let mut reply = [0; 8 + PATH_BYTES + BUS_ID_BYTES + 24];
    line.read_exact(&mut reply[..8])?;
    if word(&reply, 4) != 0 {
        return Err(io::Error::other("the import was refused"));
    }
    line.read_exact(&mut reply[8..])?;
    let numbers = 8 + PATH_BYTES + BUS_ID_BYTES;
    let id = word(&reply, numbers) << 16 | word(&reply, numbers + 4);
    Ok((id, word(&reply, numbers + 8)))
}

/// The server's half of an import: answers one request for `who`, and refuses any other.
pub fn export(line: &mut (impl Read + Write), who: Imported) -> io::Result<()> {
    let mut request = [0; 8 + BUS_ID_BYTES];
    line.read_exact(&mut request)?;
    let asked =
        u16::from_be_bytes([request[2], request[3]]) == REQUEST_IMPORT && request[8..] == bus_id(who.device);
    let mut reply = Vec::new();
    reply.extend(VERSION.to_be_bytes());
    reply.extend(REPLY_IMPORT.to_be_bytes());
    reply.extend(u32::from(!asked).to_be_bytes());
    if !asked {
        line.write_all(&reply)?;
        return Err(io::Error::other("another device was asked for"));
    }
    reply.resize(8 + PATH_BYTES, 0);
    reply.extend(bus_id(who.device));
    for number in [1, who.device, FULL_SPEED] {
        reply.extend(number.to_be_bytes());
    }
    for number in [who.vendor, who.product, 0x0100] {
        reply.extend(number.to_be_bytes());
    }
    // Class, subclass and protocol are the interfaces'; one configuration, and it is on.
    reply.extend([0, 0, 0, 1, 1, who.interfaces]);
    line.write_all(&reply)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::net::UnixStream;

    const WHO: Imported = Imported {
        vendor: 0x046D,
        product: 0xC626,
        device: 7,
        interfaces: 1,
    };

    #[test]
    fn an_import_is_answered_and_another_device_refused() {
        for (asked, works) in [(7, true), (8, false)] {
            let (mut near, mut far) = UnixStream::pair().expect("a pair");
            let server = std::thread::spawn(move || export(&mut far, WHO).is_ok());
            let imported = import(&mut near, asked);
            assert_eq!(server.join().expect("no panic"), works);
            assert_eq!(imported.ok(), works.then_some((1 << 16 | 7, FULL_SPEED)));
        }
    }

    #[test]
    fn messages_are_found_however_they_are_cut() {
        let mut bytes = vec![0; HEAD_BYTES];
        bytes[3] = 1;
        bytes[7] = 9;
        bytes[19] = 2;
        bytes[27] = 3;
        bytes.extend([0xA, 0xB, 0xC]);
        let mut unlink = vec![0; HEAD_BYTES];
        unlink[3] = 2;
        unlink[7] = 10;
        unlink[23] = 9;
        bytes.extend(&unlink);
        let mut inbox = Inbox::default();
        let mut found = Vec::new();
        for byte in bytes {
            inbox.bytes.push(byte);
            found.extend(inbox.take().expect("well formed"));
        }
        let [
            Message::Submit(submit),
            Message::Unlink {
                sequence: 10,
                victim: 9,
            },
        ] = &found[..]
        else {
            panic!("{found:?}");
        };
        assert_eq!((submit.sequence, submit.endpoint, submit.inward), (9, 2, false));
        assert_eq!(submit.data, [0xA, 0xB, 0xC]);
        assert_eq!(completed(submit, Some(&[]))[24..28], [0, 0, 0, 3]);
        assert_eq!(unlinked(10, true)[20..24], (-104i32).to_be_bytes());
        let stall = completed(submit, None);
        assert_eq!(stall[20..24], STALLED.to_be_bytes());
    }
}
