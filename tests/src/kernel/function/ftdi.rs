//! A serial device behind an FTDI FT232R, with its baud divisor and its latency timer.
//!
//! Every packet to the host begins with two bytes of modem and line status. The chip sends one when 62 bytes wait, or
//! when its latency timer runs out, whether anything waits or not.
//! Sources: FTDI's data sheet of the FT232R and application note AN232B-04; Linux `ftdi_sio.c`.

use std::collections::VecDeque;

use firmware_sim::Firmware;

use super::descriptor::{BULK, configuration, device, endpoint, interface, usual_string};
use super::{Function, Refused, Setup};

const STATUS: [u8; 2] = [0x01, 0x60];
const PACKET_DATA: usize = 62;
/// The chip's own setting of its latency timer, milliseconds.
const LATENCY_MS: u8 = 16;
/// Clock of the divisor: 48 MHz / 16.
const BASE_BAUD: u32 = 3_000_000;

/// A serial device behind an FT232R.
pub struct Ftdi<F> {
    firmware: F,
    texts: [&'static str; 3],
    latency_ms: u8,
    latency_set: u32,
    waiting: VecDeque<u8>,
    timer_from_us: u64,
    baud: u32,
    scratch: Vec<u8>,
}

/// The speed a divisor of request 3 asks for, baud: eighths of 3 MHz, their code scattered over value and index.
pub fn baud_of_divisor(value: u16, index: u16) -> u32 {
    /// Eighths by code, in the order of the chip.
    const EIGHTHS: [u32; 8] = [0, 4, 2, 1, 3, 5, 6, 7];
    let code = usize::from(value >> 14) | usize::from(index & 1) << 2;
    let whole = u32::from(value & 0x3FFF);
    match (whole, code) {
        (0, 0) => BASE_BAUD,
        (1, 0) => BASE_BAUD * 2 / 3,
        _ => BASE_BAUD * 8 / (whole * 8 + EIGHTHS[code]).max(1),
    }
}

impl<F: Firmware + Send> Ftdi<F> {
    /// `texts`: maker, product, serial number.
    pub fn new(firmware: F, texts: [&'static str; 3]) -> Self {
        Self {
            firmware,
            texts,
            latency_ms: LATENCY_MS,
            latency_set: 0,
            waiting: VecDeque::new(),
            timer_from_us: 0,
            baud: 9600,
            scratch: Vec::new(),
        }
    }

    /// The device behind the chip.
    pub fn firmware(&mut self) -> &mut F {
        &mut self.firmware
    }

    /// The latency timer as the host has set it, milliseconds.
    pub fn latency_ms(&self) -> u8 {
        self.latency_ms
    }

    /// The line's speed as the host has set it, baud.
    pub fn baud(&self) -> u32 {
        self.baud
    }
}

impl<F: Firmware + Send> Function for Ftdi<F> {
    fn ids(&self) -> [u16; 2] {
        [0x0403, 0x6001]
    }

    fn device_descriptor(&self) -> Vec<u8> {
        // The release tells drivers which chip it is: 6.00 is an FT232R.
        device([0; 3], self.ids(), 0x0600, true)
    }

    fn configuration(&self) -> Vec<u8> {
        let mut inside = interface(0, 2, [0xFF, 0xFF, 0xFF]);
        inside.extend(endpoint(0x81, BULK, 64, 0));
        inside.extend(endpoint(0x02, BULK, 64, 0));
        configuration(1, &inside)
    }

    fn string(&mut self, _now_us: u64, index: u8) -> Result<Vec<u8>, Refused> {
        usual_string(index, self.texts).ok_or(Refused)
    }

    fn control(&mut self, now_us: u64, setup: Setup, _data: &[u8]) -> Result<Vec<u8>, Refused> {
        match (setup.kind, setup.request) {
            // Reset, or throw away one direction's bytes.
            (0x40, 0) => {
                if setup.value != 2 {
                    self.waiting.clear();
                }
            }
            (0x40, 3) => {
                self.baud = baud_of_divisor(setup.value, setup.index);
                self.firmware.set_line_baud(now_us, self.baud);
            }
            // Modem lines, flow control, data format, special characters: nothing here depends on them.
            (0x40, 1 | 2 | 4 | 6 | 7) => {}
            (0x40, 9) => {
                self.latency_ms = (setup.value as u8).max(1);
                self.latency_set += 1;
                self.timer_from_us = now_us;
            }
            (0xC0, 5) => return Ok(STATUS.to_vec()),
            (0xC0, 10) => return Ok(vec![self.latency_ms]),
            // An empty memory of settings.
            (0xC0, 0x90) => return Ok(vec![0xFF, 0xFF]),
            _ => return Err(Refused),
        }
        Ok(Vec::new())
    }

    fn send(&mut self, now_us: u64, _endpoint: u8, data: &[u8]) -> Result<(), Refused> {
        self.firmware.receive(now_us, data);
        Ok(())
    }

    fn fetch(&mut self, now_us: u64, _endpoint: u8, room: usize) -> Option<Vec<u8>> {
        self.scratch.clear();
        self.firmware.transmit(now_us, &mut self.scratch);
        self.waiting.extend(&self.scratch);
        let timer_us = self.timer_from_us + u64::from(self.latency_ms) * 1000;
        if self.waiting.len() < PACKET_DATA && now_us < timer_us {
            return None;
        }
        // A transfer holds whole packets; one that is not full ends it.
        let mut bytes = Vec::new();
        loop {
            let count = self.waiting.len().min(PACKET_DATA);
            bytes.extend(STATUS);
            bytes.extend(self.waiting.drain(..count));
            let more = count == PACKET_DATA && self.waiting.len() >= PACKET_DATA;
            if !more || bytes.len() + STATUS.len() + PACKET_DATA > room {
                break;
            }
        }
        self.timer_from_us = now_us;
        Some(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn divisors_are_those_that_linux_writes() {
        // From `ftdi_232bm_baud_base_to_divisor` worked by hand: 3 MHz / baud in eighths.
        let rows = [
            (0x4138, 0, 9600),
            (0x0034, 0, 57_692),
            (0x001A, 0, 115_384),
            (0x0003, 0, 1_000_000),
            (0x0001, 0, 2_000_000),
            (0x0000, 0, 3_000_000),
        ];
        for (value, index, baud) in rows {
            assert_eq!(baud_of_divisor(value, index), baud, "{value:04x}");
        }
    }
}
