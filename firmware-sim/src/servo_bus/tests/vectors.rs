//! Packets printed in the makers' manuals and in other projects' tests, both ways. The packets are in
//! `vectors.txt`, whatever their source; two checksums that a manual misprints are there as printed and corrected.

use super::*;
use crate::servo_bus::heard::{Framing, Heard};
use crate::servo_bus::{dynamixel2, summed};

/// A line of the file.
struct Vector {
    is_misprint: bool,
    framing: Framing,
    /// Data lengths of a fast read's blocks.
    blocks: Vec<usize>,
    what: &'static str,
    bytes: Vec<u8>,
}

fn vectors() -> Vec<Vector> {
    let lines = include_str!("vectors.txt").lines();
    lines
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let is_misprint = line.starts_with("! ");
            let mut columns = line.trim_start_matches("! ").split(" | ");
            let mut column = || columns.next().expect("four columns");
            let (framing, _, what, bytes) = (column(), column(), column(), column());
            let (framing, lengths) = framing.split_once(':').unwrap_or((framing, ""));
            Vector {
                is_misprint,
                framing: if framing == "p1" {
                    Framing::Summed
                } else {
                    Framing::Dynamixel2
                },
                blocks: lengths
                    .split(',')
                    .filter_map(|length| length.parse().ok())
                    .collect(),
                what,
                bytes: hex(bytes),
            }
        })
        .collect()
}

fn hex(text: &str) -> Vec<u8> {
    text.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).expect("hexadecimal"))
        .collect()
}

/// What the receivers make of `bytes`, with parameters.
fn heard(framing: Framing, bytes: &[u8]) -> Vec<(Heard, Vec<u8>)> {
    let mut two = dynamixel2::receiver::Receiver::default();
    let mut one = summed::receiver::Receiver::default();
    let push = |byte: &u8| match framing {
        Framing::Dynamixel2 => Some((two.push(0, 0, *byte)?, two.params().to_vec())),
        Framing::Summed => Some((one.push(0, 0, *byte)?, one.params().to_vec())),
    };
    bytes.iter().filter_map(push).collect()
}

#[test]
fn the_file_has_every_documented_packet() {
    let all = vectors();
    assert_eq!(all.len(), 57 + 2 + 5);
    assert_eq!(all.iter().filter(|vector| vector.is_misprint).count(), 2);
    assert_eq!(all.iter().filter(|vector| !vector.blocks.is_empty()).count(), 3);
}

#[test]
fn every_documented_packet_is_heard() {
    for vector in vectors().iter().filter(|vector| vector.blocks.is_empty()) {
        let packets = heard(vector.framing, &vector.bytes);
        let [(packet, params)] = &packets[..] else {
            panic!("{}: {packets:?}", vector.what);
        };
        if vector.is_misprint {
            assert_eq!(packet.instruction, None, "{}", vector.what);
            continue;
        }
        let (id_at, code_at, tail) = match vector.framing {
            Framing::Dynamixel2 => (4, 7, 2),
            Framing::Summed => (2, 4, 1),
        };
        assert_eq!(packet.id, vector.bytes[id_at], "{}", vector.what);
        assert_eq!(packet.instruction, Some(vector.bytes[code_at]), "{}", vector.what);
        // Built again here, bit by bit, it is the same: so the parameters are right, stuffing and all.
        let again = match vector.framing {
            Framing::Dynamixel2 => super::packet(packet.id, vector.bytes[code_at], params),
            Framing::Summed => summed_packet(packet.id, vector.bytes[code_at], params),
        };
        assert_eq!(again, vector.bytes, "{}", vector.what);
        assert!(
            params.len() <= vector.bytes.len() - code_at - 1 - tail,
            "{}",
            vector.what
        );
    }
}

#[test]
fn every_documented_status_is_what_we_would_send() {
    let mut count = 0;
    for vector in vectors() {
        let is_status = match vector.framing {
            Framing::Dynamixel2 => vector.blocks.is_empty() && vector.bytes[7] == 0x55,
            // An instruction has no error bits, a status no parameters like these: the words tell them apart.
            Framing::Summed => vector.what.starts_with("status"),
        };
        if !is_status {
            continue;
        }
        count += 1;
        let (_, params) = heard(vector.framing, &vector.bytes).remove(0);
        let mut out = Vec::new();
        match vector.framing {
            Framing::Dynamixel2 => {
                dynamixel2::packet::status(vector.bytes[4], params[0], &params[1..], &mut out);
            }
            Framing::Summed => summed::packet::status(vector.bytes[2], vector.bytes[4], &params, &mut out),
        }
        assert_eq!(out, vector.bytes, "{}", vector.what);
    }
    assert_eq!(count, 10 + 7, "statuses of both framings");
}

/// Puts the values of the manuals' answers into servos and asks for them.
#[test]
fn fast_reads_answer_as_printed() {
    for vector in vectors().iter().filter(|vector| !vector.blocks.is_empty()) {
        let mut at = 8;
        let mut blocks = Vec::new();
        for &length in &vector.blocks {
            blocks.push((
                vector.bytes[at + 1],
                vector.bytes[at + 2..at + 2 + length].to_vec(),
            ));
            at += length + 4;
        }
        let ids: Vec<u8> = blocks.iter().map(|&(id, _)| id).collect();
        let mut host = Host::new(bus(BusOptions::default(), &ids));
        for (id, data) in &blocks {
            assert_eq!(host.error_of(&write(*id, 224, data)), Some(0));
        }
        let same = vector.blocks.iter().all(|&length| length == vector.blocks[0]);
        let ask = if same {
            packet(
                0xFE,
                0x8A,
                &[&[224, 0, vector.blocks[0] as u8, 0], &ids[..]].concat(),
            )
        } else {
            let one = |(id, data): &(u8, Vec<u8>)| vec![*id, 224, 0, data.len() as u8, 0];
            packet(0xFE, 0x9A, &blocks.iter().flat_map(one).collect::<Vec<u8>>())
        };
        assert_eq!(host.ask(&ask), vector.bytes, "{}", vector.what);
    }
}
