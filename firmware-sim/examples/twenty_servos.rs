//! How much of a processor do twenty servos take? Run it under `time`, in release.
//!
//! A minute of a hundred cycles a second, each one sync read from tick to position.
//! `time cargo run --release -p firmware-sim --example twenty_servos`

use device_profiles::Profiles;
use firmware_sim::servo_bus::{BusOptions, Unit};
use firmware_sim::{Firmware, ServoBus};

/// Sync read of 16 bytes at Realtime Tick for ids 1 to 20.
fn sync_read() -> Vec<u8> {
    let mut packet = vec![0xFF, 0xFF, 0xFD, 0x00, 0xFE, 27, 0, 0x82, 120, 0, 16, 0];
    packet.extend(1..=20);
    let checksum = packet.iter().fold(0u16, |crc, &byte| {
        (0..8).fold(crc ^ u16::from(byte) << 8, |crc, _| {
            if crc >> 15 == 1 {
                crc << 1 ^ 0x8005
            } else {
                crc << 1
            }
        })
    });
    packet.extend_from_slice(&checksum.to_le_bytes());
    packet
}

fn main() {
    let profiles = Profiles::builtin();
    let Ok(profile) = profiles.servo("xl430-w250") else {
        return;
    };
    let mut bus = ServoBus::new(BusOptions::default());
    for id in 1..=20 {
        let unit = Unit {
            return_delay_us: Some(0),
            ..Unit::new(id)
        };
        if let Err(error) = bus.add(profile, unit) {
            println!("{error}");
        }
    }
    let ask = sync_read();
    let mut heard = Vec::new();
    let mut bytes = 0;
    for cycle in 0..6000u64 {
        bus.receive(cycle * 10_000, &ask);
        for millis in 0..10 {
            bus.transmit(cycle * 10_000 + millis * 1000, &mut heard);
        }
        bytes += heard.len();
        heard.clear();
    }
    println!("60 s of bus time, {bytes} bytes heard");
}
