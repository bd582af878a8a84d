//! How many servo cycles a second of processor time plays, torque on, for twenty servos: one after the other as fast as
//! the wire allows, and a hundred a second as a puppet is played.
//!
//! `cargo run --release -p firmware-sim --example cycles [CYCLES]`

use device_profiles::Profiles;
use firmware_sim::servo_bus::{BusOptions, Fault, PlantKind, Unit};
use firmware_sim::{Firmware, ServoBus};
use std::time::Instant;

const SERVOS: u8 = 20;

/// An instruction to all with its checksum; nothing in it needs stuffing.
fn packet(code: u8, params: &[u8]) -> Vec<u8> {
    let mut packet = vec![0xFF, 0xFF, 0xFD, 0x00, 0xFE];
    packet.extend_from_slice(&(params.len() as u16 + 3).to_le_bytes());
    packet.push(code);
    packet.extend_from_slice(params);
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

fn bus(
    profiles: &Profiles,
    plant: PlantKind,
    baud: u32,
    fault: Option<&str>,
) -> Result<ServoBus, Box<dyn std::error::Error>> {
    let mut bus = ServoBus::new(BusOptions {
        baud,
        ..BusOptions::default()
    });
    for id in 1..=SERVOS {
        let unit = Unit {
            return_delay_us: Some(0),
            plant,
            ..Unit::new(id)
        };
        bus.add(profiles.servo("xl430-w250")?, unit)?;
    }
    if let Some(text) = fault {
        bus.inject(0, &Fault::parse(text)?);
    }
    Ok(bus)
}

/// Sync writes of goals and sync reads of positions, each cycle when its time has come and the last is over.
fn play(bus: &mut ServoBus, cycles: u64, period_us: u64) -> (u64, u64) {
    let torque = packet(3, &[64, 0, 1]);
    let read = packet(
        0x82,
        &[&[132, 0, 4, 0][..], &(1..=SERVOS).collect::<Vec<_>>()].concat(),
    );
    bus.receive(0, &torque);
    let mut now_us = 10_000;
    let mut heard = Vec::new();
    let mut bytes = 0;
    for cycle in 0..cycles {
        let swing = (cycle % 400).abs_diff(200) as u16;
        let mut goals = vec![116, 0, 4, 0];
        for id in 1..=SERVOS {
            goals.push(id);
            goals.extend_from_slice(&u32::from(1900 + swing + u16::from(id)).to_le_bytes());
        }
        let begun_us = now_us;
        bus.receive(now_us, &packet(0x83, &goals));
        bus.receive(now_us, &read);
        let expected = usize::from(SERVOS) * 15;
        while heard.len() < expected && now_us < begun_us + 100_000 {
            now_us = bus.next_byte_us().unwrap_or(now_us + 50).max(now_us + 50);
            bus.transmit(now_us, &mut heard);
        }
        bytes += heard.len() as u64;
        heard.clear();
        now_us = now_us.max(begun_us + period_us);
    }
    (now_us, bytes)
}

#[expect(clippy::disallowed_methods, reason = "measures this machine, not a device")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cycles = std::env::args()
        .nth(1)
        .map_or(Ok(20_000), |count| count.parse())?;
    let profiles = Profiles::builtin();
    println!("{SERVOS} servos, sync write 4 + sync read 4, {cycles} cycles each");
    for (plant, baud, period_us, fault) in [
        (PlantKind::Ideal, 1_000_000, 0, None),
        (PlantKind::Real, 1_000_000, 0, None),
        (PlantKind::Ideal, 4_000_000, 0, None),
        (PlantKind::Real, 4_000_000, 0, None),
        (PlantKind::Ideal, 1_000_000, 10_000, None),
        (PlantKind::Real, 1_000_000, 10_000, None),
        (PlantKind::Real, 1_000_000, 10_000, Some("cable 0.05ohm")),
        (PlantKind::Real, 1_000_000, 10_000, Some("noise 0.01%")),
    ] {
        let mut bus = bus(&profiles, plant, baud, fault)?;
        let begun = Instant::now();
        let (virtual_us, bytes) = play(&mut bus, cycles, period_us);
        let secs = begun.elapsed().as_secs_f64();
        let pace = if period_us == 0 {
            "as fast as the wire"
        } else {
            "100 a second"
        };
        println!(
            "{plant:?} {baud:>7} baud {pace:<19} {:<16} {:>8.0} cycles/s, {:>6.1} times real time, {bytes} bytes",
            fault.unwrap_or(""),
            cycles as f64 / secs,
            virtual_us as f64 * 1e-6 / secs,
        );
    }
    Ok(())
}
