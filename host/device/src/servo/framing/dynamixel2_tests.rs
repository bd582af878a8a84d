//! The documented packets, byte for byte, and stuffing over the four bytes that matter.

use super::super::decoder::Decoder;
use super::*;
use proptest::prelude::*;

/// `what | id | instruction | parameters | bytes on the wire`, in hex.
/// Sources: e-manual (one page per instruction), a third party's manual (JA40), rustypot's tests.
/// Two packets are printed with a wrong CRC in the e-manual: Control Table Backup's restore with `92 F5`, and
/// Fast Bulk Read's instruction with `20 F2`, which belongs to Fast Sync Read.
const DOCUMENTED: &str = "
ping id 1                     | 01 | 01 | | FF FF FD 00 01 03 00 01 19 4E
ping answer 1                 | 01 | 55 | 00 06 04 26 | FF FF FD 00 01 07 00 55 00 06 04 26 65 5D
ping broadcast                | FE | 01 | | FF FF FD 00 FE 03 00 01 31 42
ping answer 2                 | 02 | 55 | 00 06 04 26 | FF FF FD 00 02 07 00 55 00 06 04 26 6F 6D
read 132 4                    | 01 | 02 | 84 00 04 00 | FF FF FD 00 01 07 00 02 84 00 04 00 1D 15
answer 166                    | 01 | 55 | 00 A6 00 00 00 | FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0
write 116 = 512               | 01 | 03 | 74 00 00 02 00 00 | FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89
answer without data           | 01 | 55 | 00 | FF FF FD 00 01 04 00 55 00 A1 0C
reg write 104 = 200           | 01 | 04 | 68 00 C8 00 00 00 | FF FF FD 00 01 09 00 04 68 00 C8 00 00 00 AE 8E
action                        | 01 | 05 | | FF FF FD 00 01 03 00 05 02 CE
factory reset 1               | 01 | 06 | 01 | FF FF FD 00 01 04 00 06 01 A1 E6
reboot 1                      | 01 | 08 | | FF FF FD 00 01 03 00 08 2F 4E
clear multi-turn              | 01 | 10 | 01 44 58 4C 22 | FF FF FD 00 01 08 00 10 01 44 58 4C 22 B1 DC
backup                        | 01 | 20 | 01 43 54 52 4C | FF FF FD 00 01 08 00 20 01 43 54 52 4C 16 F5
restore, CRC put right        | 01 | 20 | 02 43 54 52 4C | FF FF FD 00 01 08 00 20 02 43 54 52 4C 9E F5
sync read 132 4: 1 2          | FE | 82 | 84 00 04 00 01 02 | FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA
answer 2079                   | 02 | 55 | 00 1F 08 00 00 | FF FF FD 00 02 08 00 55 00 1F 08 00 00 BA BE
sync write 116 4              | FE | 83 | 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 | FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87
fast sync read 132 4: 3 7 4   | FE | 8A | 84 00 04 00 03 07 04 | FF FF FD 00 FE 0A 00 8A 84 00 04 00 03 07 04 20 F2
bulk read                     | FE | 92 | 01 90 00 02 00 02 92 00 01 00 | FF FF FD 00 FE 0D 00 92 01 90 00 02 00 02 92 00 01 00 1A 05
bulk answer 119               | 01 | 55 | 00 77 00 | FF FF FD 00 01 06 00 55 00 77 00 C3 69
bulk answer 36                | 02 | 55 | 00 24 | FF FF FD 00 02 05 00 55 00 24 8B A9
bulk write                    | FE | 93 | 01 20 00 02 00 A0 00 02 1F 00 01 00 50 | FF FF FD 00 FE 10 00 93 01 20 00 02 00 A0 00 02 1F 00 01 00 50 B7 68
fast bulk read, CRC put right | FE | 9A | 03 84 00 04 00 07 7C 00 02 00 04 92 00 01 00 | FF FF FD 00 FE 12 00 9A 03 84 00 04 00 07 7C 00 02 00 04 92 00 01 00 DA 2D
fast sync read 580 (JA40)     | FE | 8A | 44 02 04 00 01 02 | FF FF FD 00 FE 09 00 8A 44 02 04 00 01 02 72 F2
ping id 2 (rustypot)          | 02 | 01 | | FF FF FD 00 02 03 00 01 19 72
reboot id 2 (rustypot)        | 02 | 08 | | FF FF FD 00 02 03 00 08 2F 72
read 43 2 (rustypot)          | 01 | 02 | 2B 00 02 00 | FF FF FD 00 01 07 00 02 2B 00 02 00 2E CD
ping id 42 (rustypot)         | 2A | 01 | | FF FF FD 00 2A 03 00 01 16 D2
stuffed goal                  | 01 | 03 | 74 00 FF FF FD 00 | FF FF FD 00 01 0A 00 03 74 00 FF FF FD FD 00 21 E7
stuffed behind three FF       | 01 | 03 | 74 00 FF FF FF FD | FF FF FD 00 01 0A 00 03 74 00 FF FF FF FD FD 07 E5
stuffed answer                | 01 | 55 | 00 FF FF FD FD | FF FF FD 00 01 09 00 55 00 FF FF FD FD FD D5 1E
current -1, position -3       | 01 | 55 | 00 FF FF FD FF FF FF | FF FF FD 00 01 0B 00 55 00 FF FF FD FD FF FF FF 58 6C
current, velocity -1, pos. -3 | 01 | 55 | 00 FF FF FF FF FF FF FD FF FF FF | FF FF FD 00 01 0F 00 55 00 FF FF FF FF FF FF FD FD FF FF FF FC 74
";

fn hex(text: &str) -> Vec<u8> {
    text.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).expect("two hex digits"))
        .collect()
}

/// What, id, instruction, parameters, bytes on the wire.
type Row = (String, u8, u8, Vec<u8>, Vec<u8>);

fn documented() -> Vec<Row> {
    let rows = DOCUMENTED.lines().filter(|line| !line.is_empty());
    rows.map(|line| {
        let [what, id, instruction, params, wire] =
            line.split('|').collect::<Vec<_>>().try_into().expect("5 columns");
        (
            what.trim().to_owned(),
            hex(id)[0],
            hex(instruction)[0],
            hex(params),
            hex(wire),
        )
    })
    .collect()
}

fn decode(bytes: &[u8]) -> Vec<(u8, u8, Vec<u8>)> {
    let mut packets = Vec::new();
    Decoder::new().push(bytes, &mut |packet| {
        packets.push((packet.id, packet.instruction, packet.params.to_vec()));
    });
    packets
}

#[test]
fn documented_packets_are_built_and_read_byte_for_byte() {
    for (what, id, instruction, params, wire) in documented() {
        let mut out = Vec::new();
        encode(&mut out, id, instruction, &params).unwrap();
        assert_eq!(out, wire, "{what}");
        assert_eq!(decode(&wire), [(id, instruction, params)], "{what}");
    }
}

#[test]
fn the_two_misprints_are_refused() {
    for wire in [
        "FF FF FD 00 01 08 00 20 02 43 54 52 4C 92 F5",
        "FF FF FD 00 FE 12 00 9A 03 84 00 04 00 07 7C 00 02 00 04 92 00 01 00 20 F2",
    ] {
        assert_eq!(decode(&hex(wire)), []);
    }
}

#[test]
fn builders_build_the_documented_packets() {
    let build = |build: &dyn Fn(&mut Vec<u8>)| {
        let mut out = Vec::new();
        build(&mut out);
        out
    };
    for (built, wire) in [
        (
            build(&|out| ping(out, 1).unwrap()),
            "FF FF FD 00 01 03 00 01 19 4E",
        ),
        (
            build(&|out| read(out, 1, 132, 4).unwrap()),
            "FF FF FD 00 01 07 00 02 84 00 04 00 1D 15",
        ),
        (
            build(&|out| write(out, 1, 116, &512_u32.to_le_bytes()).unwrap()),
            "FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89",
        ),
        (
            build(&|out| reboot(out, 1).unwrap()),
            "FF FF FD 00 01 03 00 08 2F 4E",
        ),
        (
            build(&|out| sync_read(out, 132, 4, [1, 2]).unwrap()),
            "FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA",
        ),
        (
            build(&|out| {
                sync_write(out, 116, [(1, 150_u32.to_le_bytes()), (2, 170_u32.to_le_bytes())]).unwrap();
            }),
            "FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87",
        ),
    ] {
        assert_eq!(built, hex(wire));
    }
}

#[test]
fn the_crc_agrees_with_its_catalogue_and_the_manuals_table() {
    assert_eq!(crc(b"123456789"), 0xfee8);
    assert_eq!(crc(&hex("FF FF FD 00 01 03 00 01")), 0x4e19);
    for (byte, sum) in [
        (0, 0x0000),
        (1, 0x8005),
        (2, 0x800f),
        (3, 0x000a),
        (4, 0x801b),
        (127, 0x8101),
        (128, 0x8303),
        (254, 0x8207),
        (255, 0x0202),
    ] {
        assert_eq!(crc(&[byte]), sum, "table entry {byte}");
    }
}

#[test]
fn what_does_not_fit_is_refused_and_leaves_no_trace() {
    let mut out = vec![1, 2, 3];
    assert_eq!(
        encode(&mut out, 1, 3, &vec![0; 70_000]),
        Err(FramingError::TooLong { bytes: 70_000 })
    );
    assert_eq!(read(&mut out, 253, 0, 1), Err(FramingError::NotAnId { id: 253 }));
    assert_eq!(
        reboot(&mut out, BROADCAST_ID),
        Err(FramingError::NotAnId { id: 254 })
    );
    assert_eq!(out, [1, 2, 3]);
}

proptest! {
    #[test]
    fn decoding_is_the_inverse_of_encoding(
        params in proptest::collection::vec(prop_oneof![Just(0xff), Just(0xfd), Just(0x00), Just(0x01), Just(0xfe)], 0..64),
        id in 0_u8..=0xfe,
        pieces in proptest::collection::vec(1_usize..20, 1..8),
    ) {
        let mut wire = Vec::new();
        encode(&mut wire, id, STATUS, &params).unwrap();
        encode(&mut wire, id, 0x03, &params).unwrap();
        let mut decoder = Decoder::new();
        let mut got = Vec::new();
        let mut rest = wire.as_slice();
        for piece in pieces.into_iter().chain([usize::MAX]) {
            let (now, later) = rest.split_at(piece.min(rest.len()));
            decoder.push(now, &mut |packet| got.push((packet.instruction, packet.params.to_vec())));
            rest = later;
        }
        prop_assert_eq!(got, [(STATUS, params.clone()), (0x03, params)]);
        prop_assert_eq!(decoder.counters().skipped_bytes, 0);
    }

    #[test]
    fn a_stuffed_body_never_holds_a_header(
        params in proptest::collection::vec(prop_oneof![Just(0xff), Just(0xfd), Just(0x00), Just(0x01)], 0..64),
    ) {
        let mut wire = Vec::new();
        encode(&mut wire, 7, 0x03, &params).unwrap();
        let body = &wire[4..wire.len() - 2];
        prop_assert!(!body.windows(4).any(|bytes| bytes == HEADER));
    }
}
