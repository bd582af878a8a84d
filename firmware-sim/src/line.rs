//! A serial line between host and one device: both directions at once, each byte at its own time.
//!
//! Used by the RS-232 devices; the servo bus has its own half-duplex wire.

use crate::uart::{Format, Parity, hear};
use std::collections::VecDeque;

/// Nanoseconds in a second.
const SECOND_NS: u64 = 1_000_000_000;

/// Bytes under way with the moment each has wholly arrived, in nanoseconds of host time.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    device: Format,
    host: Format,
    drift_ppm: i32,
    host_free_ns: u64,
    device_free_ns: u64,
    to_device: VecDeque<(u64, u8)>,
    to_host: VecDeque<(u64, u8)>,
}

impl Line {
    /// A quiet line whose device runs at `baud` by a clock that is `drift_ppm` fast. The host's end begins as the
    /// device's.
    pub(crate) fn with_parity(baud: u32, parity: Parity, drift_ppm: i32) -> Self {
        let format = Format {
            baud: baud.max(1),
            parity,
        };
        Self {
            device: format,
            host: format,
            drift_ppm,
            host_free_ns: 0,
            device_free_ns: 0,
            to_device: VecDeque::new(),
            to_host: VecDeque::new(),
        }
    }

    pub(crate) fn set_host_baud(&mut self, baud: u32) {
        self.host.baud = baud.max(1);
    }

    pub(crate) fn set_host_parity(&mut self, parity: Parity) {
        self.host.parity = parity;
    }

    /// The device changes its own speed; what it has handed to the line goes at the old one.
    pub(crate) fn set_device_baud(&mut self, baud: u32) {
        self.device.baud = baud.max(1);
    }

    pub(crate) fn device_baud(&self) -> u32 {
        self.device.baud
    }

    /// How fast the device's clock is, millionths.
    pub(crate) fn drift_ppm(&self) -> i32 {
        self.drift_ppm
    }

    /// The device sets its speed by what the host sends.
    pub(crate) fn find_speed(&mut self) {
        self.device.baud = self.host.baud;
    }

    /// How long a byte of the device's takes.
    pub(crate) fn device_byte_ns(&self) -> u64 {
        let byte_ns = self.device.frame_bits() * SECOND_NS / u64::from(self.device.baud);
        shortened(byte_ns, self.drift_ppm)
    }

    /// The host writes `bytes`, one behind the other after whatever it wrote before.
    pub(crate) fn host_sends(&mut self, now_ns: u64, bytes: &[u8]) {
        let byte_ns = self.host.frame_bits() * SECOND_NS / u64::from(self.host.baud);
        for &byte in bytes {
            self.host_free_ns = self.host_free_ns.max(now_ns) + byte_ns;
            let (at, to_device) = (self.host_free_ns, &mut self.to_device);
            hear(byte, self.host, self.device, |heard| {
                // A device's UART drops a frame without a stop bit or of the wrong parity.
                if heard.framed && heard.parity_right {
                    to_device.push_back((at, heard.byte));
                }
            });
        }
    }

    /// When the next byte reaches the device.
    pub(crate) fn next_arrival_ns(&self) -> Option<u64> {
        self.to_device.front().map(|&(at, _)| at)
    }

    /// Takes the next byte that has reached the device by `until_ns`.
    pub(crate) fn arrival(&mut self, until_ns: u64) -> Option<(u64, u8)> {
        self.to_device.pop_front_if(|&mut (at, _)| at <= until_ns)
    }

    /// The device writes `bytes` at `at_ns` or when its line is free.
    pub(crate) fn device_sends(&mut self, at_ns: u64, bytes: &[u8]) {
        let byte_ns = self.device_byte_ns();
        for &byte in bytes {
            self.device_free_ns = self.device_free_ns.max(at_ns) + byte_ns;
            let (at, to_host) = (self.device_free_ns, &mut self.to_host);
            hear(byte, self.device, self.host, |heard| {
                // A tty without IGNPAR, PARMRK and INPCK reads a frame without a stop bit as zero and looks at no
                // parity (termios(3)).
                to_host.push_back((at, if heard.framed { heard.byte } else { 0 }));
            });
        }
    }

    /// The device writes so many bytes that are lost on the way: the line is as busy as with any.
    pub(crate) fn device_loses(&mut self, at_ns: u64, bytes: usize) {
        self.device_free_ns = self.device_free_ns.max(at_ns) + self.device_byte_ns() * bytes as u64;
    }

    /// From when on the device's side of the line is idle.
    pub(crate) fn device_free_ns(&self) -> u64 {
        self.device_free_ns
    }

    /// The device loses power at `at_ns`: what it had not sent by then is never sent.
    pub(crate) fn device_stops(&mut self, at_ns: u64) {
        self.to_host.retain(|&(at, _)| at <= at_ns);
        self.device_free_ns = self.device_free_ns.min(at_ns);
    }

    /// Appends what has reached the host by `now_ns`.
    pub(crate) fn deliver(&mut self, now_ns: u64, out: &mut Vec<u8>) {
        while let Some((_, byte)) = self.to_host.pop_front_if(|&mut (at, _)| at <= now_ns) {
            out.push(byte);
        }
    }

    /// When the next byte under way reaches the host.
    pub(crate) fn next_delivery_ns(&self) -> Option<u64> {
        self.to_host.front().map(|&(at, _)| at)
    }
}

/// `span_ns` of a clock that is `drift_ppm` fast, in true nanoseconds.
pub(crate) fn shortened(span_ns: u64, drift_ppm: i32) -> u64 {
    (span_ns as f64 / (1.0 + f64::from(drift_ppm) * 1e-6)).round() as u64
}
