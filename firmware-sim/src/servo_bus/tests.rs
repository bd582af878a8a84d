//! The bus as a host hears it: documented packets, every instruction, time, motion, faults.

mod families;
mod faults;
mod feetech;
mod instructions;
mod motion;
mod page;
mod physics;
mod protocol1;
mod spoken;
mod switches;
mod timing;
mod troubles;
mod vectors;

use super::*;
use crate::Firmware;
use device_profiles::Profiles;

/// A bus of perfect XL430s with these numbers and no return delay.
fn bus(options: BusOptions, ids: &[u8]) -> ServoBus {
    bus_of("xl430-w250", options, ids)
}

fn bus_of(model: &str, options: BusOptions, ids: &[u8]) -> ServoBus {
    let profiles = Profiles::builtin();
    let profile = profiles.servo(model).expect("shipped");
    let mut bus = ServoBus::new(options);
    for &id in ids {
        bus.add(
            profile,
            Unit {
                return_delay_us: Some(0),
                ..Unit::new(id)
            },
        )
        .expect("fits");
    }
    bus
}

/// An instruction packet, built here bit by bit and not by the code under test.
fn packet(id: u8, instruction: u8, params: &[u8]) -> Vec<u8> {
    let mut body = vec![instruction];
    for &byte in params {
        body.push(byte);
        if body.ends_with(&[0xFF, 0xFF, 0xFD]) {
            body.push(0xFD);
        }
    }
    let mut packet = vec![0xFF, 0xFF, 0xFD, 0, id];
    packet.extend_from_slice(&((body.len() + 2) as u16).to_le_bytes());
    packet.extend(body);
    let mut crc = 0u32;
    for &byte in &packet {
        crc ^= u32::from(byte) << 8;
        for _ in 0..8 {
            crc <<= 1;
            if crc & 0x1_0000 != 0 {
                crc ^= 0x1_8005;
            }
        }
    }
    packet.extend_from_slice(&(crc as u16).to_le_bytes());
    packet
}

/// An instruction of protocol 1.0 or Feetech, built here and not by the code under test.
fn summed_packet(id: u8, instruction: u8, params: &[u8]) -> Vec<u8> {
    let mut packet = vec![0xFF, 0xFF, id, params.len() as u8 + 2, instruction];
    packet.extend_from_slice(params);
    let sum = packet[2..].iter().map(|&byte| u32::from(byte)).sum::<u32>();
    packet.push(!(sum as u8));
    packet
}

fn write(id: u8, address: u16, bytes: &[u8]) -> Vec<u8> {
    packet(id, 3, &[&address.to_le_bytes()[..], bytes].concat())
}

fn read(id: u8, address: u16, length: u16) -> Vec<u8> {
    packet(id, 2, &[address.to_le_bytes(), length.to_le_bytes()].concat())
}

/// The bus with a host's patience: `ask` waits 20 ms.
struct Host {
    bus: ServoBus,
    now_us: u64,
}

impl Host {
    fn new(bus: ServoBus) -> Self {
        Self { bus, now_us: 0 }
    }

    fn ask(&mut self, bytes: &[u8]) -> Vec<u8> {
        self.bus.receive(self.now_us, bytes);
        self.wait(20)
    }

    fn wait(&mut self, millis: u64) -> Vec<u8> {
        self.now_us += millis * 1000;
        let mut out = Vec::new();
        self.bus.transmit(self.now_us, &mut out);
        out
    }

    /// The error byte of the one answer to `bytes`.
    fn error_of(&mut self, bytes: &[u8]) -> Option<u8> {
        self.ask(bytes).get(8).copied()
    }

    fn register(&self, id: u8, name: &str) -> i64 {
        self.bus
            .servo(id)
            .and_then(|servo| servo.register(name))
            .expect("is there")
    }

    /// Torque on, then a goal.
    fn drive(&mut self, id: u8, goal: i32) {
        assert_eq!(self.error_of(&write(id, 64, &[1])), Some(0));
        assert_eq!(self.error_of(&write(id, 116, &goal.to_le_bytes())), Some(0));
    }
}
