//! Garbage, damage and cut packets: nothing is invented, and nothing whole is lost.

use super::super::dynamixel2::{encode, write};
use super::*;
use proptest::prelude::*;

fn answer(id: u8, data: &[u8]) -> Vec<u8> {
    let mut params = vec![0];
    params.extend_from_slice(data);
    let mut wire = Vec::new();
    encode(&mut wire, id, STATUS, &params).unwrap();
    wire
}

fn ids(decoder: &mut Decoder, bytes: &[u8]) -> Vec<u8> {
    let mut ids = Vec::new();
    decoder.push(bytes, &mut |packet| ids.push(packet.id));
    ids
}

#[test]
fn a_damaged_packet_costs_only_itself() {
    let mut damaged = answer(1, &[1, 2, 3, 4]);
    damaged[9] ^= 0x10;
    for (what, front) in [
        ("nothing", Vec::new()),
        ("noise", vec![0x12, 0xff, 0xff, 0xfd, 0xfd, 0x00]),
        ("half a header", vec![0xff, 0xff]),
        ("damage", damaged),
        ("a cut packet", answer(1, &[9; 4])[..9].to_vec()),
        ("a header with length 0", vec![0xff, 0xff, 0xfd, 0, 1, 0, 0]),
        ("a header with length 1", vec![0xff, 0xff, 0xfd, 0, 1, 1, 0]),
        (
            "a header with length 65535",
            vec![0xff, 0xff, 0xfd, 0, 1, 0xff, 0xff],
        ),
        (
            "a header with id 255",
            vec![0xff, 0xff, 0xfd, 0, 0xff, 4, 0, 0x55],
        ),
    ] {
        let mut bytes = front;
        bytes.extend(answer(2, &[5, 6]));
        bytes.extend(answer(3, &[7, 8]));
        let mut decoder = Decoder::new();
        let mut got = ids(&mut decoder, &bytes);
        decoder.give_up(&mut |packet| got.push(packet.id));
        assert_eq!(got, [2, 3], "behind {what}");
    }
}

#[test]
fn a_header_that_promises_too_much_is_given_up_on_demand() {
    let mut decoder = Decoder::new();
    let mut bytes = vec![0xff, 0xff, 0xfd, 0, 1, 200, 0];
    bytes.extend(answer(4, &[1]));
    assert_eq!(ids(&mut decoder, &bytes), []);
    let mut got = Vec::new();
    decoder.give_up(&mut |packet| got.push(packet.id));
    assert_eq!(got, [4]);
    assert_eq!(decoder.counters().rejected, 1);
}

#[test]
fn a_sender_that_does_not_stuff_is_not_believed() {
    let mut wire = vec![0xff, 0xff, 0xfd, 0, 1, 8, 0, STATUS, 0, 0xff, 0xff, 0xfd, 0x00];
    wire.extend(crc(&wire).to_le_bytes());
    let mut decoder = Decoder::new();
    assert_eq!(ids(&mut decoder, &wire), []);
    assert_eq!(decoder.counters().rejected, 1);
}

#[test]
fn an_echo_is_no_answer_and_an_alert_is_no_error() {
    let mut wire = Vec::new();
    write(&mut wire, 1, 116, &[0; 4]).unwrap();
    encode(&mut wire, 1, STATUS, &[0x80, 42]).unwrap();
    encode(&mut wire, 1, STATUS, &[0x84]).unwrap();
    encode(&mut wire, 1, STATUS, &[]).unwrap();
    let mut seen = Vec::new();
    Decoder::new().push(&wire, &mut |packet| {
        seen.push(
            packet
                .status()
                .map(|status| (status.error.alert(), status.error.number(), status.data.len())),
        );
    });
    assert_eq!(seen, [None, Some((true, 0, 1)), Some((true, 4, 0)), None]);
    assert_eq!(StatusError(4).name(), "data range error");
}

proptest! {
    #[test]
    fn packets_in_noise_are_found_and_noise_is_no_packet(
        noise in proptest::collection::vec(
            proptest::collection::vec(prop_oneof![Just(0xff), Just(0xfd), Just(0x00), Just(0x01)], 0..12), 4),
        data in proptest::collection::vec(prop_oneof![Just(0xff), Just(0xfd), Just(0x00), Just(0x01)], 0..8),
    ) {
        let mut bytes = Vec::new();
        for (at, noise) in noise.iter().enumerate() {
            bytes.extend_from_slice(noise);
            bytes.extend(answer(at as u8 + 10, &data));
        }
        let mut decoder = Decoder::new();
        let mut got = Vec::new();
        decoder.push(&bytes, &mut |packet| got.push((packet.id, packet.params[1..].to_vec())));
        decoder.give_up(&mut |packet| got.push((packet.id, packet.params[1..].to_vec())));
        let want: Vec<_> = (10..14).map(|id| (id, data.clone())).collect();
        prop_assert_eq!(got, want);
    }

    #[test]
    fn no_bytes_make_it_fail_or_grow(bytes in proptest::collection::vec(any::<u8>(), 0..3000)) {
        let mut decoder = Decoder::new();
        for piece in bytes.chunks(37) {
            decoder.push(piece, &mut |_| {});
            prop_assert!(decoder.waiting.len() <= PREFIX_BYTES + LENGTH_MAX_DEFAULT + 37);
        }
        decoder.give_up(&mut |_| {});
        prop_assert!(decoder.waiting.is_empty());
    }
}
