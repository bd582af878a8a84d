//! A serial device behind a CDC-ACM interface, as on a microcontroller with USB of its own.

use firmware_sim::Firmware;

use super::descriptor::{BULK, INTERRUPT, configuration, device, endpoint, interface, usual_string};
use super::{Function, Refused, Setup};

const SET_LINE_CODING: u8 = 0x20;
const GET_LINE_CODING: u8 = 0x21;
const SET_CONTROL_LINES: u8 = 0x22;
const DATA: u8 = 2;

/// A serial device on USB: whatever the host sets its port to reaches the device's line.
pub struct Acm<F> {
    firmware: F,
    texts: [&'static str; 3],
    coding: [u8; 7],
    open: bool,
}

impl<F: Firmware + Send> Acm<F> {
    /// `texts`: maker, product, serial number.
    pub fn new(firmware: F, texts: [&'static str; 3]) -> Self {
        Self {
            firmware,
            texts,
            coding: [0x80, 0x25, 0, 0, 0, 0, 8],
            open: false,
        }
    }

    /// The device behind the port.
    pub fn firmware(&mut self) -> &mut F {
        &mut self.firmware
    }
}

impl<F: Firmware + Send> Function for Acm<F> {
    fn ids(&self) -> [u16; 2] {
        // Of the open-source register pid.codes, for tests.
        [0x1209, 0x0001]
    }

    fn device_descriptor(&self) -> Vec<u8> {
        device([2, 0, 0], self.ids(), 0x0100, true)
    }

    fn configuration(&self) -> Vec<u8> {
        let mut inside = interface(0, 1, [2, 2, 1]);
        // CDC 1.1: header, no call management, line coding and control lines, interfaces 0 and 1 belong together.
        inside.extend([
            5, 0x24, 0, 0x10, 1, 5, 0x24, 1, 0, 1, 4, 0x24, 2, 2, 5, 0x24, 6, 0, 1,
        ]);
        inside.extend(endpoint(0x81, INTERRUPT, 8, 16));
        inside.extend(interface(1, 2, [0x0A, 0, 0]));
        inside.extend(endpoint(0x80 | DATA, BULK, 64, 0));
        inside.extend(endpoint(DATA, BULK, 64, 0));
        configuration(2, &inside)
    }

    fn string(&mut self, _now_us: u64, index: u8) -> Result<Vec<u8>, Refused> {
        usual_string(index, self.texts).ok_or(Refused)
    }

    fn control(&mut self, now_us: u64, setup: Setup, data: &[u8]) -> Result<Vec<u8>, Refused> {
        match (setup.kind, setup.request) {
            (0x21, SET_LINE_CODING) => {
                self.coding = data.try_into().map_err(|_| Refused)?;
                let [a, b, c, d, ..] = self.coding;
                self.firmware
                    .set_line_baud(now_us, u32::from_le_bytes([a, b, c, d]));
                Ok(Vec::new())
            }
            (0xA1, GET_LINE_CODING) => Ok(self.coding.to_vec()),
            (0x21, SET_CONTROL_LINES) => {
                let open = setup.value & 1 == 1;
                if open && !self.open {
                    self.firmware.port_opened(now_us);
                }
                self.open = open;
                Ok(Vec::new())
            }
            _ => Err(Refused),
        }
    }

    fn send(&mut self, now_us: u64, endpoint: u8, data: &[u8]) -> Result<(), Refused> {
        if endpoint != DATA {
            return Err(Refused);
        }
        self.firmware.receive(now_us, data);
        Ok(())
    }

    fn fetch(&mut self, now_us: u64, endpoint: u8, _room: usize) -> Option<Vec<u8>> {
        if endpoint != DATA {
            return None;
        }
        let mut bytes = Vec::new();
        self.firmware.transmit(now_us, &mut bytes);
        // A driver's transfers are a multiple of the packet's 64 bytes and these lines are slow: it always fits.
        (!bytes.is_empty()).then_some(bytes)
    }
}
