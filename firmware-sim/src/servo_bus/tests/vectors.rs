//! Packets printed in the maker's manual and in other projects' tests, both ways.
//! Source: e-manual protocol 2.0 page; two checksums it misprints are corrected here, and so marked.

use super::*;

fn hex(text: &str) -> Vec<u8> {
    text.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).expect("hexadecimal"))
        .collect()
}

#[test]
fn every_documented_instruction_is_heard() {
    let table = [
        ("01", "FF FF FD 00 01 03 00 01 19 4E"),
        ("01", "FF FF FD 00 FE 03 00 01 31 42"),
        ("02", "FF FF FD 00 01 07 00 02 84 00 04 00 1D 15"),
        ("03", "FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89"),
        ("04", "FF FF FD 00 01 09 00 04 68 00 C8 00 00 00 AE 8E"),
        ("05", "FF FF FD 00 01 03 00 05 02 CE"),
        ("06", "FF FF FD 00 01 04 00 06 01 A1 E6"),
        ("08", "FF FF FD 00 01 03 00 08 2F 4E"),
        ("10", "FF FF FD 00 01 08 00 10 01 44 58 4C 22 B1 DC"),
        ("20", "FF FF FD 00 01 08 00 20 01 43 54 52 4C 16 F5"),
        // Printed with 92 F5.
        ("20", "FF FF FD 00 01 08 00 20 02 43 54 52 4C 9E F5"),
        ("82", "FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA"),
        (
            "83",
            "FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87",
        ),
        ("8A", "FF FF FD 00 FE 0A 00 8A 84 00 04 00 03 07 04 20 F2"),
        (
            "92",
            "FF FF FD 00 FE 0D 00 92 01 90 00 02 00 02 92 00 01 00 1A 05",
        ),
        (
            "93",
            "FF FF FD 00 FE 10 00 93 01 20 00 02 00 A0 00 02 1F 00 01 00 50 B7 68",
        ),
        // Printed with 20 F2.
        (
            "9A",
            "FF FF FD 00 FE 12 00 9A 03 84 00 04 00 07 7C 00 02 00 04 92 00 01 00 DA 2D",
        ),
        ("8A", "FF FF FD 00 FE 09 00 8A 44 02 04 00 01 02 72 F2"),
        ("01", "FF FF FD 00 02 03 00 01 19 72"),
        ("08", "FF FF FD 00 02 03 00 08 2F 72"),
        ("02", "FF FF FD 00 01 07 00 02 2B 00 02 00 2E CD"),
        ("01", "FF FF FD 00 2A 03 00 01 16 D2"),
    ];
    for (code, bytes) in table {
        let mut receiver = receiver::Receiver::default();
        let bytes = hex(bytes);
        let heard: Vec<_> = bytes
            .iter()
            .filter_map(|&byte| receiver.push(0, 0, byte))
            .collect();
        let code = u8::from_str_radix(code, 16).expect("hexadecimal");
        assert_eq!(
            heard,
            [receiver::Heard::Instruction {
                id: bytes[4],
                instruction: code
            }]
        );
        assert_eq!(receiver.params(), &bytes[8..bytes.len() - 2]);
        assert_eq!(packet(bytes[4], code, receiver.params()), bytes);
    }
}

#[test]
fn the_manuals_two_misprinted_checksums_are_not() {
    for bytes in [
        "FF FF FD 00 01 08 00 20 02 43 54 52 4C 92 F5",
        "FF FF FD 00 FE 12 00 9A 03 84 00 04 00 07 7C 00 02 00 04 92 00 01 00 20 F2",
    ] {
        let mut receiver = receiver::Receiver::default();
        let heard: Vec<_> = hex(bytes)
            .iter()
            .filter_map(|&byte| receiver.push(0, 0, byte))
            .collect();
        assert!(matches!(heard[..], [receiver::Heard::BadCrc { .. }]), "{bytes}");
    }
}

#[test]
fn every_documented_status_is_what_we_would_send() {
    let table: [(u8, &[u8], &str); 8] = [
        (1, &[6, 4, 0x26], "FF FF FD 00 01 07 00 55 00 06 04 26 65 5D"),
        (2, &[6, 4, 0x26], "FF FF FD 00 02 07 00 55 00 06 04 26 6F 6D"),
        (
            1,
            &[0xA6, 0, 0, 0],
            "FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0",
        ),
        (1, &[], "FF FF FD 00 01 04 00 55 00 A1 0C"),
        (
            2,
            &[0x1F, 8, 0, 0],
            "FF FF FD 00 02 08 00 55 00 1F 08 00 00 BA BE",
        ),
        (1, &[0x77, 0], "FF FF FD 00 01 06 00 55 00 77 00 C3 69"),
        (2, &[0x24], "FF FF FD 00 02 05 00 55 00 24 8B A9"),
        (
            1,
            &[0xFF, 0xFF, 0xFD, 0xFD],
            "FF FF FD 00 01 09 00 55 00 FF FF FD FD FD D5 1E",
        ),
    ];
    for (id, params, bytes) in table {
        let mut out = Vec::new();
        super::super::packet::status(id, 0, params, &mut out);
        assert_eq!(out, hex(bytes));
    }
}

#[test]
fn stuffed_writes_arrive_as_they_were_meant() {
    for (bytes, params) in [
        (
            "FF FF FD 00 01 0A 00 03 74 00 FF FF FD FD 00 21 E7",
            "74 00 FF FF FD 00",
        ),
        (
            "FF FF FD 00 01 0A 00 03 74 00 FF FF FF FD FD 07 E5",
            "74 00 FF FF FF FD",
        ),
    ] {
        let mut receiver = receiver::Receiver::default();
        let heard = hex(bytes)
            .iter()
            .filter_map(|&byte| receiver.push(0, 0, byte))
            .count();
        assert_eq!((heard, receiver.params()), (1, &hex(params)[..]));
    }
}

/// Puts the values of the manual's answer into servos and asks for it.
#[test]
fn fast_reads_answer_as_printed() {
    let table = [
        (
            // Two blocks of four bytes in indirect data would need a model that has them: 636 + 4.
            "FF FF FD 00 FE 19 00 55 00 03 A6 00 00 00 84 08 00 07 1F 08 00 00 16 CA 00 04 FF 03 00 00 D1 9E",
            packet(0xFE, 0x8A, &[224, 0, 4, 0, 3, 7, 4]),
            [(3u8, 0xA6u32, 4usize), (7, 0x81F, 4), (4, 0x3FF, 4)],
        ),
        (
            "FF FF FD 00 FE 14 00 55 00 03 A6 00 00 00 67 A4 00 07 A5 01 24 74 00 04 1F D9 C1",
            packet(0xFE, 0x9A, &[3, 224, 0, 4, 0, 7, 224, 0, 2, 0, 4, 224, 0, 1, 0]),
            [(3, 0xA6, 4), (7, 0x1A5, 2), (4, 0x1F, 1)],
        ),
    ];
    for (expected, ask, values) in table {
        let mut host = Host::new(bus(BusOptions::default(), &[3, 4, 7]));
        for (id, value, len) in values {
            assert_eq!(
                host.error_of(&write(id, 224, &value.to_le_bytes()[..len])),
                Some(0)
            );
        }
        assert_eq!(host.ask(&ask), hex(expected));
    }
}
