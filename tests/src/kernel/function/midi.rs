//! A MIDI device behind a MIDIStreaming interface: bytes of MIDI on one side, packets of four on the other.
//!
//! Source: USB Device Class Definition for MIDI Devices 1.0, chapters 4 and 6.

use std::collections::VecDeque;

use firmware_sim::Firmware;

use super::descriptor::{BULK, configuration, device, endpoint, interface, usual_string};
use super::{Function, Refused, Setup};

/// A MIDI device on USB, one cable each way.
pub struct Midi<F> {
    firmware: F,
    ids: [u16; 2],
    texts: [&'static str; 3],
    packer: Packer,
    ready: VecDeque<u8>,
    scratch: Vec<u8>,
    taken: Vec<[u8; 4]>,
}

impl<F: Firmware + Send> Midi<F> {
    /// `texts`: maker, product, serial number.
    pub fn new(firmware: F, ids: [u16; 2], texts: [&'static str; 3]) -> Self {
        Self {
            firmware,
            ids,
            texts,
            packer: Packer::default(),
            ready: VecDeque::new(),
            scratch: Vec::new(),
            taken: Vec::new(),
        }
    }

    /// Every packet the kernel has taken since the last call, in order.
    pub fn taken(&mut self) -> Vec<[u8; 4]> {
        std::mem::take(&mut self.taken)
    }

    /// The device behind it.
    pub fn firmware(&mut self) -> &mut F {
        &mut self.firmware
    }
}

/// A class-specific interface descriptor.
fn class_specific(kind: u8, body: &[u8]) -> Vec<u8> {
    let mut bytes = vec![2 + body.len() as u8, kind];
    bytes.extend_from_slice(body);
    bytes
}

impl<F: Firmware + Send> Function for Midi<F> {
    fn ids(&self) -> [u16; 2] {
        self.ids
    }

    fn device_descriptor(&self) -> Vec<u8> {
        device([0; 3], self.ids, 0x0100, true)
    }

    fn configuration(&self) -> Vec<u8> {
        const INTERFACE: u8 = 0x24;
        const ENDPOINT: u8 = 0x25;
        let mut inside = interface(0, 0, [1, 1, 0]);
        // Audio control 1.0, nine bytes in all, one streaming interface: number 1.
        inside.extend(class_specific(INTERFACE, &[1, 0x00, 0x01, 9, 0, 1, 1]));
        inside.extend(interface(1, 2, [1, 3, 0]));
        // Jacks: embedded in 1, external in 2, embedded out 3 fed by 2, external out 4 fed by 1.
        let jacks = [
            class_specific(INTERFACE, &[2, 1, 1, 0]),
            class_specific(INTERFACE, &[2, 2, 2, 0]),
            class_specific(INTERFACE, &[3, 1, 3, 1, 2, 1, 0]),
            class_specific(INTERFACE, &[3, 2, 4, 1, 1, 1, 0]),
        ]
        .concat();
        let mut ends = Vec::new();
        for (address, jack) in [(0x01, 1), (0x81, 3)] {
            // Audio's endpoint descriptors are two bytes longer.
            let mut descriptor = endpoint(address, BULK, 64, 0);
            descriptor[0] = 9;
            descriptor.extend([0, 0]);
            ends.extend(descriptor);
            ends.extend(class_specific(ENDPOINT, &[1, 1, jack]));
        }
        let [low, high] = ((7 + jacks.len() + ends.len()) as u16).to_le_bytes();
        inside.extend(class_specific(INTERFACE, &[1, 0x00, 0x01, low, high]));
        inside.extend(jacks);
        inside.extend(ends);
        configuration(2, &inside)
    }

    fn string(&mut self, _now_us: u64, index: u8) -> Result<Vec<u8>, Refused> {
        usual_string(index, self.texts).ok_or(Refused)
    }

    fn control(&mut self, _now_us: u64, _setup: Setup, _data: &[u8]) -> Result<Vec<u8>, Refused> {
        Err(Refused)
    }

    fn send(&mut self, now_us: u64, _endpoint: u8, data: &[u8]) -> Result<(), Refused> {
        for packet in data.chunks_exact(4) {
            let count = payload(packet[0] & 0x0F);
            self.firmware.receive(now_us, &packet[1..=count]);
        }
        Ok(())
    }

    fn fetch(&mut self, now_us: u64, _endpoint: u8, room: usize) -> Option<Vec<u8>> {
        self.scratch.clear();
        self.firmware.transmit(now_us, &mut self.scratch);
        for &byte in &self.scratch {
            if let Some(packet) = self.packer.push(byte) {
                self.ready.extend(packet);
            }
        }
        let count = self.ready.len().min(room / 4 * 4).min(64);
        let bytes: Vec<u8> = self.ready.drain(..count).collect();
        self.taken.extend(bytes.as_chunks::<4>().0);
        (count > 0).then_some(bytes)
    }

    fn plugged(&mut self, _now_us: u64, _in: bool) {
        // What nobody fetched stays in a box without power.
        self.packer = Packer::default();
        self.ready.clear();
    }
}

/// Bytes of MIDI in a packet of this code index (table 4-1).
fn payload(code: u8) -> usize {
    match code {
        0x5 | 0xF => 1,
        0x2 | 0x6 | 0xC | 0xD => 2,
        0x0 | 0x1 => 0,
        _ => 3,
    }
}

/// MIDI bytes to packets; running status is undone.
#[derive(Debug, Default)]
struct Packer {
    status: u8,
    held: Vec<u8>,
}

impl Packer {
    fn push(&mut self, byte: u8) -> Option<[u8; 4]> {
        match byte {
            // Real-time messages stand alone, even inside others.
            0xF8.. => return Some([0x0F, byte, 0, 0]),
            0x80..=0xF6 => {
                self.status = byte;
                self.held = vec![byte];
                // Common messages of one byte.
                return (byte == 0xF6).then(|| self.packet(0x5));
            }
            _ => {
                if self.held.is_empty() && byte != 0xF7 {
                    match self.status {
                        0x80..0xF0 => self.held.push(self.status),
                        0xF0 => {}
                        // Data that belongs to nothing.
                        _ => return None,
                    }
                }
                self.held.push(byte);
            }
        }
        match self.status {
            0xF0 if byte == 0xF7 => Some(self.packet(4 + self.held.len() as u8)),
            0xF0 => (self.held.len() == 3).then(|| self.packet(0x4)),
            0xC0..0xE0 => (self.held.len() == 2).then(|| self.packet(self.status >> 4)),
            0xF1 | 0xF3 => (self.held.len() == 2).then(|| self.packet(0x2)),
            0xF2 => (self.held.len() == 3).then(|| self.packet(0x3)),
            _ => (self.held.len() == 3).then(|| self.packet(self.status >> 4)),
        }
    }

    fn packet(&mut self, code: u8) -> [u8; 4] {
        let mut packet = [code, 0, 0, 0];
        for (place, byte) in packet[1..].iter_mut().zip(&self.held) {
            *place = *byte;
        }
        self.held.clear();
        packet
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_become_packets_and_bytes_again() {
        let rows: [(&[u8], &[[u8; 4]]); 4] = [
            (&[0xB0, 16, 1, 17, 2], &[[0x0B, 0xB0, 16, 1], [0x0B, 0xB0, 17, 2]]),
            (
                &[0xC0, 5, 0xF8, 0x90, 1, 127],
                &[[0x0C, 0xC0, 5, 0], [0x0F, 0xF8, 0, 0], [0x09, 0x90, 1, 127]],
            ),
            (
                &[0xF0, 1, 2, 3, 4, 0xF7],
                &[[0x04, 0xF0, 1, 2], [0x07, 3, 4, 0xF7]],
            ),
            (&[0xF0, 1, 2, 3, 0xF7], &[[0x04, 0xF0, 1, 2], [0x06, 3, 0xF7, 0]]),
        ];
        for (bytes, want) in rows {
            let mut packer = Packer::default();
            let got: Vec<_> = bytes.iter().filter_map(|&byte| packer.push(byte)).collect();
            assert_eq!(got, want, "{bytes:02x?}");
            let back = |packet: &[u8; 4]| packet[1..=payload(packet[0] & 15)].to_vec();
            let length: usize = got.iter().map(|packet| back(packet).len()).sum();
            assert!(length >= bytes.len(), "{bytes:02x?}");
        }
    }
}
