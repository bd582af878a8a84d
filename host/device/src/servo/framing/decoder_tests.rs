//! Garbage, damage, cut packets, echoes and fast reads: nothing is invented, nothing whole is lost, and nobody is
//! blamed for another's damage.

use super::super::dynamixel2::{STATUS_OVERHEAD_BYTES, crc, encode};
use super::super::{dynamixel1, fast_bulk_read, fast_sync_read, ping, read, sync_write};
use super::*;
use ServoProtocol::{Dynamixel1, Dynamixel2, Sts};
use proptest::prelude::*;

fn answer(id: u8, data: &[u8]) -> Vec<u8> {
    let mut params = vec![0];
    params.extend_from_slice(data);
    let mut wire = Vec::new();
    encode(&mut wire, id, STATUS, &params).unwrap();
    wire
}

/// What was heard, as words.
fn say(heard: Heard<'_>) -> String {
    match heard {
        Heard::Status(status) => format!("{}:{:?}", status.id, status.data),
        Heard::Echo => "echo".to_owned(),
        Heard::Instruction(packet) => format!("{} asked {:02x}", packet.id, packet.instruction),
        Heard::Damaged { id } => format!("{id} damaged"),
    }
}

fn hear(decoder: &mut Decoder, bytes: &[u8]) -> Vec<String> {
    let mut all = Vec::new();
    decoder.push(bytes, &mut |heard| all.push(say(heard)));
    all
}

fn hear_to_the_end(decoder: &mut Decoder, bytes: &[u8]) -> Vec<String> {
    let mut all = hear(decoder, bytes);
    decoder.give_up(&mut |heard| all.push(say(heard)));
    all
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
        ("length 0", vec![0xff, 0xff, 0xfd, 0, 1, 0, 0]),
        ("length 1", vec![0xff, 0xff, 0xfd, 0, 1, 1, 0]),
        ("length 65535", vec![0xff, 0xff, 0xfd, 0, 1, 0xff, 0xff]),
        ("id 255", vec![0xff, 0xff, 0xfd, 0, 0xff, 4, 0, 0x55]),
    ] {
        let mut bytes = front;
        bytes.extend(answer(2, &[5, 6]));
        bytes.extend(answer(3, &[7, 8]));
        let got = hear_to_the_end(&mut Decoder::new(Dynamixel2), &bytes);
        assert_eq!(got, ["2:[5, 6]", "3:[7, 8]"], "behind {what}");
    }
}

#[test]
fn a_length_that_no_answer_can_have_holds_nothing_up() {
    let mut sent = Vec::new();
    read(Dynamixel2, &mut sent, 4, 132, 4).unwrap();
    let mut decoder = Decoder::new(Dynamixel2);
    decoder.sent(&sent);
    let mut bytes = vec![0xff, 0xff, 0xfd, 0, 1, 200, 0, STATUS];
    bytes.extend(answer(4, &[1, 2, 3, 4]));
    assert_eq!(hear(&mut decoder, &bytes), ["4:[1, 2, 3, 4]"], "without waiting");
    let mut sent = Vec::new();
    read(Sts, &mut sent, 4, 56, 2).unwrap();
    let mut decoder = Decoder::new(Sts);
    decoder.sent(&sent);
    let mut bytes = vec![0xff, 0xff, 4, 200];
    dynamixel1::encode(&mut bytes, 4, 0, &[1, 2]).unwrap();
    assert_eq!(hear(&mut decoder, &bytes), ["4:[1, 2]"], "without waiting");
}

#[test]
fn a_header_that_promises_too_much_is_given_up_on_demand() {
    let mut decoder = Decoder::new(Dynamixel2);
    let mut bytes = vec![0xff, 0xff, 0xfd, 0, 1, 200, 0, STATUS];
    bytes.extend(answer(4, &[1]));
    assert!(hear(&mut decoder, &bytes).is_empty());
    assert_eq!(hear_to_the_end(&mut decoder, &[]), ["4:[1]"]);
    assert_eq!(decoder.counters().rejected, 1);
}

#[test]
fn a_sender_that_does_not_stuff_is_not_believed() {
    let mut wire = vec![0xff, 0xff, 0xfd, 0, 1, 8, 0, STATUS, 0, 0xff, 0xff, 0xfd, 0x00];
    wire.extend(crc(&wire).to_le_bytes());
    let mut decoder = Decoder::new(Dynamixel2);
    assert!(hear(&mut decoder, &wire).is_empty());
    assert_eq!(decoder.counters().rejected, 1);
}

#[test]
fn echoes_are_told_from_answers_and_from_other_hosts() {
    let mut sent = Vec::new();
    read(Dynamixel2, &mut sent, 1, 116, 1).unwrap();
    let mut wire = sent.clone();
    encode(&mut wire, 1, STATUS, &[0x80, 42]).unwrap();
    encode(&mut wire, 1, STATUS, &[]).unwrap();
    ping(Dynamixel2, &mut wire, 9).unwrap();
    let mut decoder = Decoder::new(Dynamixel2);
    decoder.sent(&sent);
    assert_eq!(hear(&mut decoder, &wire), ["echo", "1:[42]", "9 asked 01"]);
}

/// A ping's echo and an answer without data but with error bit 0 are the same bytes in protocol 1.0.
#[test]
fn where_bytes_do_not_tell_the_lines_habit_does() {
    let packet = |build: &dyn Fn(&mut Vec<u8>)| {
        let mut out = Vec::new();
        build(&mut out);
        out
    };
    let pinged = packet(&|out| ping(Dynamixel1, out, 1).unwrap());
    let asked = packet(&|out| read(Dynamixel1, out, 1, 36, 2).unwrap());
    let answered = packet(&|out| dynamixel1::encode(out, 1, 0, &[7, 8]).unwrap());
    let low_voltage = packet(&|out| dynamixel1::encode(out, 1, 1, &[]).unwrap());
    assert_eq!(pinged, low_voltage);

    let mut unknown = Decoder::new(Dynamixel1);
    unknown.sent(&pinged);
    assert_eq!(
        hear(&mut unknown, &pinged),
        ["echo"],
        "not proven: nobody is invented"
    );

    let mut silent = Decoder::new(Dynamixel1);
    silent.sent(&asked);
    assert_eq!(hear(&mut silent, &answered), ["1:[7, 8]"]);
    silent.sent(&pinged);
    assert_eq!(hear(&mut silent, &low_voltage), ["1:[]"]);

    let mut echoing = Decoder::new(Dynamixel1);
    echoing.sent(&asked);
    let both = [asked.clone(), answered].concat();
    assert_eq!(hear(&mut echoing, &both), ["echo", "1:[7, 8]"]);
    echoing.sent(&pinged);
    let both = [pinged, low_voltage].concat();
    assert_eq!(hear(&mut echoing, &both), ["echo", "1:[]"]);
}

/// An echo is longer than any answer: it is known whatever comes behind it, or came before it.
#[test]
fn a_long_echo_is_known_beside_a_damaged_one() {
    let mut first = Vec::new();
    sync_write(Sts, &mut first, 42, (1..=8).map(|id| (id, [id; 6]))).unwrap();
    let mut second = Vec::new();
    sync_write(Sts, &mut second, 41, (1..=9).map(|id| (id, [id; 1]))).unwrap();
    let sent = [first.clone(), second.clone()].concat();
    for (hit, lost) in [(first.len() + 5, "the second"), (5, "the first")] {
        let mut wire = sent.clone();
        wire[hit] ^= 0x40;
        let mut whole = Decoder::new(Sts);
        whole.sent(&sent);
        assert_eq!(hear_to_the_end(&mut whole, &wire), ["echo"], "{lost} is damaged");
        let mut pieces = Decoder::new(Sts);
        pieces.sent(&sent);
        let heard: Vec<String> = wire.iter().flat_map(|byte| hear(&mut pieces, &[*byte])).collect();
        assert_eq!(heard, ["echo"], "{lost} is damaged, and bytes come one by one");
    }
}

const LIST: [(u8, u16); 4] = [(3, 4), (7, 2), (4, 1), (9, 4)];

/// The data that servo `id` would put into its block.
fn block_data(id: u8, data: u16) -> Vec<u8> {
    (0..data)
        .map(|at| id.wrapping_mul(31).wrapping_add(at as u8))
        .collect()
}

/// The answer to a fast read of `list` by those of its servos that are there, and where each block begins.
fn fast_answer(list: &[(u8, u16)], there: &dyn Fn(u8) -> bool) -> (Vec<u8>, Vec<usize>) {
    let length = 1 + list.iter().map(|&(_, data)| usize::from(data) + 4).sum::<usize>();
    let mut wire = vec![0xff, 0xff, 0xfd, 0, 0xfe];
    wire.extend((length as u16).to_le_bytes());
    wire.push(STATUS);
    let mut starts = Vec::new();
    for &(id, data) in list.iter().filter(|&&(id, _)| there(id)) {
        starts.push(wire.len());
        wire.extend([0, id]);
        wire.extend(block_data(id, data));
        wire.extend(crc(&wire).to_le_bytes());
    }
    (wire, starts)
}

fn fast_decoder(list: &[(u8, u16)]) -> Decoder {
    let mut sent = Vec::new();
    fast_bulk_read(
        Dynamixel2,
        &mut sent,
        list.iter().map(|&(id, data)| (id, 100, data)),
    )
    .unwrap();
    let mut decoder = Decoder::new(Dynamixel2);
    decoder.sent(&sent);
    decoder
}

fn good(id: u8) -> String {
    let (_, data) = LIST
        .into_iter()
        .find(|&(known, _)| known == id)
        .expect("in the list");
    format!("{id}:{:?}", block_data(id, data))
}

#[test]
fn a_fast_answer_becomes_one_status_for_each_servo_as_it_comes() {
    let (wire, starts) = fast_answer(&LIST, &|_| true);
    let mut decoder = fast_decoder(&LIST);
    assert!(hear(&mut decoder, &wire[..starts[1] - 1]).is_empty());
    assert_eq!(hear(&mut decoder, &wire[starts[1] - 1..starts[1]]), [good(3)]);
    assert_eq!(
        hear(&mut decoder, &wire[starts[1]..]),
        [good(7), good(4), good(9)]
    );
    assert_eq!(decoder.counters().skipped_bytes, 0);
    assert_eq!(
        hear(&mut decoder, &answer(5, &[1])),
        ["5:[1]"],
        "and then as ever"
    );
}

#[test]
fn damage_in_a_fast_answer_is_blamed_on_its_servo_alone() {
    let (wire, starts) = fast_answer(&LIST, &|_| true);
    for at in starts[1]..starts[2] {
        // A changed byte: of the data, of the id, or of the CRC that the next block goes on from.
        let mut hit = wire.clone();
        hit[at] ^= 0x04;
        let got = hear(&mut fast_decoder(&LIST), &hit);
        assert_eq!(
            got,
            [good(3), "7 damaged".to_owned(), good(4), good(9)],
            "byte {at} changed"
        );
        // A lost byte.
        let mut hit = wire.clone();
        hit.remove(at);
        let got = hear_to_the_end(&mut fast_decoder(&LIST), &hit);
        assert_eq!(
            got,
            [good(3), "7 damaged".to_owned(), good(4), good(9)],
            "byte {at} lost"
        );
    }
    // A byte put in before the block: the block itself is whole.
    let mut hit = wire.clone();
    hit.insert(starts[1], 0x55);
    let got = hear_to_the_end(&mut fast_decoder(&LIST), &hit);
    assert_eq!(got[..2], [good(3), good(7)]);
}

#[test]
fn whoever_is_missing_from_a_fast_answer_costs_the_others_nothing() {
    for missing in [3, 7, 4, 9] {
        let (wire, _) = fast_answer(&LIST, &|id| id != missing);
        let want: Vec<String> = [3, 7, 4, 9]
            .into_iter()
            .filter(|&id| id != missing)
            .map(good)
            .collect();
        let mut got = hear_to_the_end(&mut fast_decoder(&LIST), &wire);
        got.retain(|heard| !heard.ends_with("damaged"));
        assert_eq!(got, want, "without {missing}");
    }
    for cut in 8..fast_answer(&LIST, &|_| true).0.len() {
        let (wire, starts) = fast_answer(&LIST, &|_| true);
        let whole = starts.iter().skip(1).filter(|&&start| start <= cut).count();
        let mut got = hear_to_the_end(&mut fast_decoder(&LIST), &wire[..cut]);
        got.retain(|heard| !heard.ends_with("damaged"));
        let want: Vec<String> = [3, 7, 4].into_iter().take(whole).map(good).collect();
        assert_eq!(got, want, "cut behind {cut} bytes");
    }
}

#[test]
fn a_fast_answer_nobody_asked_for_is_no_answer() {
    let (wire, _) = fast_answer(&LIST, &|_| true);
    assert!(hear_to_the_end(&mut Decoder::new(Dynamixel2), &wire).is_empty());
    let mut sent = Vec::new();
    fast_sync_read(Dynamixel2, &mut sent, 132, 4, [1, 2]).unwrap();
    let mut decoder = Decoder::new(Dynamixel2);
    decoder.sent(&sent);
    assert!(
        hear_to_the_end(&mut decoder, &wire).is_empty(),
        "of another length"
    );
    // Fast data are not stuffed: an answer inside them is theirs.
    let list = [(1, STATUS_OVERHEAD_BYTES as u16 + 1), (2, 1)];
    let mut wire = vec![0xff, 0xff, 0xfd, 0, 0xfe, 22, 0, STATUS, 0, 1];
    let inner = answer(2, &[9]);
    wire.extend_from_slice(&inner);
    wire.extend(crc(&wire).to_le_bytes());
    wire.extend([0, 2, 5]);
    wire.extend(crc(&wire).to_le_bytes());
    let got = hear(&mut fast_decoder(&list), &wire);
    assert_eq!(got, [format!("1:{inner:?}"), "2:[5]".to_owned()]);
}

proptest! {
    /// Bytes changed, lost and put in anywhere: whatever is given out is what that servo sent.
    #[test]
    fn no_damage_puts_data_on_the_wrong_servo(
        hits in proptest::collection::vec((0_usize..40, any::<u8>(), 0_u8..3), 1..4),
        absent in proptest::collection::vec(any::<bool>(), 4),
        piece in 1_usize..12,
    ) {
        let there = |id: u8| LIST.iter().zip(&absent).any(|(&(known, _), &absent)| known == id && !absent);
        let (mut wire, _) = fast_answer(&LIST, &there);
        for (at, value, kind) in hits {
            let at = at % wire.len();
            match kind {
                0 => wire[at] = value,
                1 => { wire.remove(at); }
                _ => wire.insert(at, value),
            }
        }
        let mut decoder = fast_decoder(&LIST);
        let mut got = Vec::new();
        for piece in wire.chunks(piece) {
            got.extend(hear(&mut decoder, piece));
        }
        got.extend(hear_to_the_end(&mut decoder, &[]));
        let named = |id: u8| [good(id), format!("{id} damaged")];
        let allowed: Vec<String> = [3, 7, 4, 9].into_iter().flat_map(named).collect();
        for heard in &got {
            prop_assert!(allowed.contains(heard), "{heard}");
        }
    }

    #[test]
    fn no_bytes_make_it_fail_or_grow(
        which in 0_usize..4,
        bytes in proptest::collection::vec(any::<u8>(), 0..3000),
        sent in proptest::collection::vec(any::<u8>(), 0..60),
    ) {
        let protocol = [Dynamixel2, Dynamixel1, Sts, ServoProtocol::Scs][which];
        let mut decoder = Decoder::new(protocol);
        let room = decoder.waiting.capacity();
        decoder.sent(&sent);
        for piece in bytes.chunks(700) {
            decoder.push(piece, &mut |_| {});
        }
        decoder.give_up(&mut |_| {});
        prop_assert!(decoder.rest().is_empty());
        prop_assert_eq!(decoder.waiting.capacity(), room);
    }

    #[test]
    fn long_sync_writes_are_echoes_too(servos in 1_u8..=35) {
        let mut sent = Vec::new();
        sync_write(Dynamixel1, &mut sent, 30, (1..=servos).map(|id| (id, [id; 6]))).unwrap();
        let mut decoder = Decoder::new(Dynamixel1);
        decoder.sent(&sent);
        prop_assert_eq!(hear(&mut decoder, &sent), ["echo"]);
    }
}
