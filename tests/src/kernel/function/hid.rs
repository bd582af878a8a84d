//! A USB input device as its HID interfaces.

use firmware_sim::UsbDevice;
use firmware_sim::usb_device::Request;

use super::descriptor::{INTERRUPT, configuration, device, endpoint, interface};
use super::{Function, Refused, Setup};

/// Requests of the HID class (HID 1.11, 7.2).
const GET_REPORT: u8 = 0x01;
const SET_REPORT: u8 = 0x09;
const SET_IDLE: u8 = 0x0A;
const SET_PROTOCOL: u8 = 0x0B;
const GET_DESCRIPTOR: u8 = 6;
const OUTPUT: u8 = 2;
const FEATURE: u8 = 3;

/// A simulated HID device on USB. Interface n has endpoint n + 1.
pub struct Hid {
    device: Box<dyn UsbDevice>,
    waiting: Vec<firmware_sim::usb_device::Report>,
    taken: Vec<Vec<u8>>,
    /// Endpoints that are asked, bit n for endpoint n.
    asked: u16,
    /// Vendor and product instead of its own.
    called: Option<[u16; 2]>,
}

impl Hid {
    /// The device, with its cable in.
    pub fn new(device: Box<dyn UsbDevice>) -> Self {
        Self {
            device,
            waiting: Vec::new(),
            taken: Vec::new(),
            asked: 0,
            called: None,
        }
    }

    /// The same device under other numbers: one that nobody knows.
    #[must_use]
    pub fn called(mut self, ids: [u16; 2]) -> Self {
        self.called = Some(ids);
        self
    }

    /// The device itself, for hands and faults.
    pub fn device(&mut self) -> &mut dyn UsbDevice {
        &mut *self.device
    }

    /// Whether somebody has it open.
    pub fn is_open(&self) -> bool {
        self.asked != 0
    }

    /// Every report the kernel has taken since the last call, in order.
    pub fn taken(&mut self) -> Vec<Vec<u8>> {
        std::mem::take(&mut self.taken)
    }

    fn hid_descriptor(length: usize) -> Vec<u8> {
        let [low, high] = (length as u16).to_le_bytes();
        vec![9, 0x21, 0x11, 0x01, 0, 1, 0x22, low, high]
    }
}

impl Function for Hid {
    fn arrival(&mut self, now_us: u64) -> u32 {
        self.device.arrival(now_us)
    }

    fn ids(&self) -> [u16; 2] {
        let facts = self.device.facts();
        self.called.unwrap_or([facts.vendor, facts.product])
    }

    fn device_descriptor(&self) -> Vec<u8> {
        let facts = self.device.facts();
        device([0; 3], self.ids(), facts.release_bcd, facts.serial.is_some())
    }

    fn configuration(&self) -> Vec<u8> {
        let mut inside = Vec::new();
        let facts = self.device.facts();
        for (number, hid) in (0..).zip(&facts.interfaces) {
            let outward = hid.output_bytes > 0;
            inside.extend(interface(number, 1 + u8::from(outward), [3, 0, 0]));
            inside.extend(Self::hid_descriptor(hid.descriptor.len()));
            inside.extend(endpoint(0x81 + number, INTERRUPT, 64, hid.poll_ms));
            if outward {
                inside.extend(endpoint(1 + number, INTERRUPT, 64, hid.poll_ms));
            }
        }
        configuration(facts.interfaces.len() as u8, &inside)
    }

    fn string(&mut self, now_us: u64, index: u8) -> Result<Vec<u8>, Refused> {
        self.device.string(now_us, index).map_err(|_| Refused)
    }

    fn control(&mut self, now_us: u64, setup: Setup, data: &[u8]) -> Result<Vec<u8>, Refused> {
        let [id, what] = setup.value.to_le_bytes();
        let interface = setup.index as u8;
        match (setup.kind, setup.request) {
            (0x81, GET_DESCRIPTOR) => {
                let hid = self.device.facts().interface(interface).ok_or(Refused)?;
                match what {
                    0x21 => Ok(Self::hid_descriptor(hid.descriptor.len())),
                    0x22 => Ok(hid.descriptor.clone()),
                    _ => Err(Refused),
                }
            }
            (0xA1, GET_REPORT) if what == FEATURE => {
                self.device.feature(now_us, interface, id).map_err(|_| Refused)
            }
            (0x21, SET_REPORT) => {
                let done = match what {
                    FEATURE => self.device.set_feature(now_us, interface, data),
                    OUTPUT => self.device.output(now_us, interface, data),
                    _ => return Err(Refused),
                };
                done.map(|()| Vec::new()).map_err(|_| Refused)
            }
            (0x21, SET_IDLE | SET_PROTOCOL) => Ok(Vec::new()),
            (kind, request) if kind & 0x60 == 0x40 => {
                let request = Request {
                    kind,
                    request,
                    value: setup.value,
                    index: setup.index,
                };
                self.device.request(now_us, request, data).map_err(|_| Refused)
            }
            _ => Err(Refused),
        }
    }

    fn send(&mut self, now_us: u64, endpoint: u8, data: &[u8]) -> Result<(), Refused> {
        let interface = endpoint.checked_sub(1).ok_or(Refused)?;
        self.device.output(now_us, interface, data).map_err(|_| Refused)
    }

    fn fetch(&mut self, now_us: u64, endpoint: u8, _room: usize) -> Option<Vec<u8>> {
        let interface = endpoint.checked_sub(1)?;
        while let Some(report) = self.device.report(now_us) {
            self.waiting.push(report);
        }
        let at = self
            .waiting
            .iter()
            .position(|report| report.interface == interface)?;
        let bytes = self.waiting.remove(at).bytes;
        self.taken.push(bytes.clone());
        Some(bytes)
    }

    fn listened(&mut self, now_us: u64, endpoint: u8, on: bool) {
        if let Some(interface) = endpoint.checked_sub(1) {
            let bit = 1 << endpoint.min(15);
            self.asked = if on { self.asked | bit } else { self.asked & !bit };
            self.device.listen(now_us, interface, on);
        }
    }

    fn plugged(&mut self, now_us: u64, is_in: bool) {
        self.waiting.clear();
        self.asked = 0;
        self.device.plug(now_us, is_in);
    }
}
