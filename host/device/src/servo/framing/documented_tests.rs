//! Every packet that a document prints is built by its call and read back, byte for byte.

use super::*;
use std::str::SplitWhitespace;

const DOCUMENTED: &str = include_str!("documented.txt");

struct Row {
    protocol: ServoProtocol,
    call: &'static str,
    misprint: bool,
    wire: Vec<u8>,
}

fn hex(text: &str) -> Vec<u8> {
    let digits: Vec<char> = text.chars().filter(|c| !c.is_whitespace()).collect();
    let byte =
        |pair: &[char]| u8::from_str_radix(&pair.iter().collect::<String>(), 16).expect("two hex digits");
    digits.chunks(2).map(byte).collect()
}

fn rows() -> Vec<Row> {
    let lines = DOCUMENTED
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines
        .map(|line| {
            let columns: Vec<&'static str> = line.split('|').map(str::trim).collect();
            let [protocol, _, call, bytes] = columns.try_into().expect("four columns");
            let protocol = match protocol {
                "dynamixel2" => ServoProtocol::Dynamixel2,
                "dynamixel1" => ServoProtocol::Dynamixel1,
                "sts" => ServoProtocol::Sts,
                other => panic!("no protocol {other}"),
            };
            let right = bytes.strip_prefix("misprint ");
            Row {
                protocol,
                call,
                misprint: right.is_some(),
                wire: hex(right.unwrap_or(bytes)),
            }
        })
        .collect()
}

fn number<Number: std::str::FromStr>(text: &str) -> Number {
    text.parse().ok().expect("a decimal number")
}

fn next<Number: std::str::FromStr>(words: &mut SplitWhitespace<'_>) -> Number {
    number(words.next().expect("one more word"))
}

/// `ID=DATA`.
fn items(words: SplitWhitespace<'_>) -> Vec<(u8, Vec<u8>)> {
    let item = |word: &str| word.split_once('=').map(|(id, data)| (number(id), hex(data)));
    words.map(|word| item(word).expect("ID=DATA")).collect()
}

/// `ID:ADDRESS+LENGTH` or `ID:ADDRESS=DATA`.
fn blocks(words: SplitWhitespace<'_>) -> Vec<(u8, u16, String)> {
    words
        .map(|word| {
            let (id, rest) = word.split_once(':').expect("ID:");
            let (address, rest) = rest.split_once(['+', '=']).expect("ADDRESS");
            (number(id), number(address), rest.to_owned())
        })
        .collect()
}

fn bulk(words: SplitWhitespace<'_>) -> impl Iterator<Item = (u8, u16, u16)> {
    blocks(words)
        .into_iter()
        .map(|(id, address, length)| (id, address, number(&length)))
}

/// The packet that a call builds; none for answers, which a host does not build.
fn build(protocol: ServoProtocol, call: &str) -> Option<Vec<u8>> {
    let mut words = call.split_whitespace();
    let verb = words.next().expect("a verb");
    let mut out = Vec::new();
    let out = &mut out;
    let w = &mut words;
    let rest = |words: &mut SplitWhitespace<'_>| hex(&words.collect::<String>());
    let built = match verb {
        "status" | "fast" => return None,
        "ping" => ping(protocol, out, next(w)),
        "read" => read(protocol, out, next(w), next(w), next(w)),
        "write" => write(protocol, out, next(w), next(w), &rest(w)),
        "reg-write" => reg_write(protocol, out, next(w), next(w), &rest(w)),
        "action" => action(protocol, out, next(w)),
        "reboot" => reboot(protocol, out, next(w)),
        "clear" => clear(protocol, out, next(w)),
        "factory-reset" => {
            let id = next(w);
            let keep = match w.next() {
                Some("all") => Keep::Nothing,
                Some("keep-id") => Keep::Id,
                other => panic!("{other:?}"),
            };
            factory_reset(protocol, out, id, keep)
        }
        "backup" => {
            let id = next(w);
            let restore = w.next() == Some("restore");
            backup(
                protocol,
                out,
                id,
                if restore { Backup::Restore } else { Backup::Store },
            )
        }
        "sync-read" => sync_read(protocol, out, next(w), next(w), w.map(number::<u8>)),
        "fast-sync-read" => fast_sync_read(protocol, out, next(w), next(w), w.map(number::<u8>)),
        "sync-write" => sync_write(protocol, out, next(w), items(words)),
        "bulk-read" => bulk_read(protocol, out, bulk(words)),
        "fast-bulk-read" => fast_bulk_read(protocol, out, bulk(words)),
        "bulk-write" => {
            let blocks = blocks(words).into_iter();
            bulk_write(
                protocol,
                out,
                blocks.map(|(id, address, data)| (id, address, hex(&data))),
            )
        }
        other => panic!("no call {other}"),
    };
    built.expect("documented packets can be built");
    Some(std::mem::take(out))
}

/// Id, error and data of each answer.
fn answers(decoder: &mut Decoder, wire: &[u8]) -> Vec<(u8, u8, Vec<u8>)> {
    let mut all = Vec::new();
    for byte in wire {
        decoder.push(&[*byte], &mut |heard| {
            let status = heard.status().expect("an answer");
            all.push((status.id, status.error.raw(), status.data.to_vec()));
        });
    }
    all
}

fn expected(call: &str) -> Vec<(u8, u8, Vec<u8>)> {
    let mut words = call.split_whitespace();
    if words.next() == Some("fast") {
        return items(words).into_iter().map(|(id, data)| (id, 0, data)).collect();
    }
    let id = next(&mut words);
    let body = hex(&words.collect::<String>());
    vec![(id, body[0], body[1..].to_vec())]
}

#[test]
fn documented_packets_are_built_and_read_byte_for_byte() {
    let mut sent = Vec::new();
    let (mut built, mut read, mut misprints) = (0, 0, 0);
    for row in rows() {
        let mut decoder = Decoder::new(row.protocol);
        match build(row.protocol, row.call) {
            Some(bytes) if row.misprint => {
                assert_ne!(bytes, row.wire, "{}", row.call);
                decoder.push(&row.wire, &mut |heard| {
                    panic!("{} is misprinted, but {heard:?}", row.call)
                });
                assert_eq!(decoder.counters().rejected, 1);
                misprints += 1;
            }
            Some(bytes) => {
                assert_eq!(bytes, row.wire, "{}", row.call);
                decoder.sent(&bytes);
                let mut echoes = 0;
                decoder.push(&row.wire, &mut |heard| {
                    assert_eq!(heard, Heard::Echo, "{}", row.call);
                    echoes += 1;
                });
                assert_eq!(echoes, 1, "{}", row.call);
                sent = bytes;
                built += 1;
            }
            None => {
                if row.call.starts_with("fast") {
                    decoder.sent(&sent);
                }
                assert_eq!(
                    answers(&mut decoder, &row.wire),
                    expected(row.call),
                    "{}",
                    row.call
                );
                assert_eq!(
                    (decoder.counters().rejected, decoder.counters().skipped_bytes),
                    (0, 0)
                );
                read += 1;
            }
        }
    }
    assert_eq!((built, read, misprints), (42, 20, 2), "every row was tried");
}
