//! A servo line on which anything may happen: requests go out, echoes and answers come back whole, damaged, cut or
//! invented, in pieces of any size. The laws:
//!
//! - Nothing panics, and every byte is accounted for: given out or counted as skipped.
//! - What is given out was on the line: an answer's bytes stand there with a right checksum behind them, and in the
//!   answer to a fast read at least its error, id and data do.
//! - The size of the pieces makes no difference.
//! - Once what is unfinished is given up, the next answer is heard, whatever went before.

use device::servo::framing::{self, Decoder, Heard, dynamixel1, dynamixel2};
use device_profiles::ServoProtocol;

/// Things done at most in one run.
const STEPS_MAX: usize = 64;

/// Something heard, kept.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Kept {
    Status { id: u8, error: u8, data: Vec<u8> },
    Instruction(u8, u8, Vec<u8>),
    Echo,
    Damaged(u8),
}

fn keep(heard: Heard<'_>) -> Kept {
    match heard {
        Heard::Status(status) => Kept::Status {
            id: status.id,
            error: status.error.raw(),
            data: status.data.to_vec(),
        },
        Heard::Instruction(packet) => {
            Kept::Instruction(packet.id, packet.instruction, packet.params.to_vec())
        }
        Heard::Echo => Kept::Echo,
        Heard::Damaged { id } => Kept::Damaged(id),
    }
}

/// The fuzzer's bytes, taken one after another; zeros when they are used up.
struct Dice<'a>(&'a [u8]);

impl<'a> Dice<'a> {
    fn byte(&mut self) -> u8 {
        match self.0.split_first() {
            Some((&byte, rest)) => {
                self.0 = rest;
                byte
            }
            None => 0,
        }
    }

    fn bytes(&mut self, count: usize) -> &'a [u8] {
        let (now, rest) = self.0.split_at(count.min(self.0.len()));
        self.0 = rest;
        now
    }
}

/// The two decoders that must agree, and what was on the line.
struct Line {
    protocol: ServoProtocol,
    in_pieces: Decoder,
    byte_by_byte: Decoder,
    history: Vec<u8>,
    sent: Vec<u8>,
    /// Ids and data bytes of the fast read that was sent.
    fast: Vec<(u8, u8)>,
}

/// Runs what `bytes` stand for, and checks the laws.
pub fn run(protocol: ServoProtocol, bytes: &[u8]) {
    let mut line = Line {
        protocol,
        in_pieces: Decoder::new(protocol),
        byte_by_byte: Decoder::new(protocol),
        history: Vec::new(),
        sent: Vec::new(),
        fast: Vec::new(),
    };
    let mut dice = Dice(bytes);
    for _ in 0..STEPS_MAX {
        if dice.0.is_empty() {
            break;
        }
        match dice.byte() % 8 {
            0 => line.ask(&mut dice),
            1 => line.echo(&mut dice),
            2 | 3 => line.answer(&mut dice),
            4 => line.answer_fast(&mut dice),
            5 => line.give_up(),
            _ => {
                let count = usize::from(dice.byte() % 24);
                let bytes = dice.bytes(count).to_vec();
                line.hear(&bytes);
            }
        }
    }
    line.recovers();
}

impl Line {
    fn hear(&mut self, bytes: &[u8]) {
        self.history.extend_from_slice(bytes);
        let (mut one, mut other) = (Vec::new(), Vec::new());
        self.in_pieces.push(bytes, &mut |heard| one.push(keep(heard)));
        for byte in bytes {
            self.byte_by_byte
                .push(&[*byte], &mut |heard| other.push(keep(heard)));
        }
        assert_eq!(one, other, "pieces make a difference");
        assert_eq!(self.in_pieces.counters(), self.byte_by_byte.counters());
        one.iter().for_each(|kept| self.was_there(kept));
    }

    fn give_up(&mut self) {
        let (mut one, mut other) = (Vec::new(), Vec::new());
        self.in_pieces.give_up(&mut |heard| one.push(keep(heard)));
        self.byte_by_byte.give_up(&mut |heard| other.push(keep(heard)));
        assert_eq!(one, other);
        one.iter().for_each(|kept| self.was_there(kept));
        let skipped = self.in_pieces.counters().skipped_bytes;
        assert!(skipped <= self.history.len() as u64, "more was skipped than came");
    }

    /// What was given out stands on the line.
    fn was_there(&self, kept: &Kept) {
        let mut wire = Vec::new();
        match kept {
            Kept::Status { id, error, data } => {
                let body = [&[*error][..], data].concat();
                match self.protocol {
                    ServoProtocol::Dynamixel2 => {
                        dynamixel2::encode(&mut wire, *id, dynamixel2::STATUS, &body)
                            .expect("it fitted before");
                        if !contains(&self.history, &wire) {
                            assert!(
                                self.fast.iter().any(|(known, _)| known == id),
                                "{id} was not asked"
                            );
                            wire = [&[*error, *id][..], data].concat();
                        }
                    }
                    _ => dynamixel1::encode(&mut wire, *id, *error, data).expect("it fitted before"),
                }
            }
            Kept::Instruction(id, instruction, params) => match self.protocol {
                ServoProtocol::Dynamixel2 => {
                    dynamixel2::encode(&mut wire, *id, *instruction, params).expect("it fitted before");
                }
                _ => dynamixel1::encode(&mut wire, *id, *instruction, params).expect("it fitted before"),
            },
            Kept::Damaged(id) => assert!(
                self.fast.iter().any(|(known, _)| known == id),
                "{id} was not asked"
            ),
            Kept::Echo => {}
        }
        assert!(contains(&self.history, &wire), "{kept:?} was not on the line");
    }

    fn ask(&mut self, dice: &mut Dice<'_>) {
        let protocol = self.protocol;
        let mut out = Vec::new();
        let o = &mut out;
        let count = dice.byte() % 5;
        let ids: Vec<u8> = (0..count).map(|_| dice.byte()).collect();
        let (id, length) = (dice.byte(), dice.byte() % 24);
        self.fast.clear();
        let built = match dice.byte() % 9 {
            0 => framing::ping(protocol, o, id),
            1 => framing::read(protocol, o, id, 36, length.into()),
            2 => framing::write(protocol, o, id, 30, dice.bytes(length.into())),
            3 => framing::sync_write(protocol, o, 30, ids.iter().map(|&id| (id, [length; 4]))),
            4 => framing::sync_read(protocol, o, 36, length.into(), ids.iter().copied()),
            5 => framing::bulk_read(protocol, o, ids.iter().map(|&id| (id, 36, u16::from(id % 9)))),
            6 => {
                let built = framing::fast_sync_read(protocol, o, 36, length.into(), ids.iter().copied());
                self.fast.extend(ids.iter().map(|&id| (id, length)));
                built
            }
            7 => {
                let blocks = ids.iter().map(|&id| (id, id % 9));
                self.fast.extend(blocks.clone());
                framing::fast_bulk_read(protocol, o, blocks.map(|(id, length)| (id, 36, length.into())))
            }
            _ => {
                // What no call builds, and no fast read either, whose servos would have to be known here.
                out = dice.bytes(length.into()).to_vec();
                out.retain(|byte| !matches!(byte, 0x8a | 0x9a));
                Ok(())
            }
        };
        if built.is_err() {
            assert!(out.is_empty(), "a refusal leaves no trace");
            self.fast.clear();
        }
        self.in_pieces.sent(&out);
        self.byte_by_byte.sent(&out);
        self.sent = out;
    }

    /// The adapter gives back what was sent, perhaps damaged.
    fn echo(&mut self, dice: &mut Dice<'_>) {
        let wire = self.sent.clone();
        self.hear_damaged(wire, dice);
    }

    fn answer(&mut self, dice: &mut Dice<'_>) {
        let (id, error) = (dice.byte(), dice.byte());
        let length = usize::from(dice.byte() % 24);
        let data = dice.bytes(length).to_vec();
        let wire = self.status(id, error, &data);
        self.hear_damaged(wire, dice);
    }

    fn status(&self, id: u8, error: u8, data: &[u8]) -> Vec<u8> {
        let mut wire = Vec::new();
        let built = match self.protocol {
            ServoProtocol::Dynamixel2 => {
                dynamixel2::encode(&mut wire, id, dynamixel2::STATUS, &[&[error], data].concat())
            }
            _ => dynamixel1::encode(&mut wire, id, error, data),
        };
        built.expect("short enough");
        wire
    }

    fn answer_fast(&mut self, dice: &mut Dice<'_>) {
        let length: usize = 1 + self
            .fast
            .iter()
            .map(|&(_, data)| usize::from(data) + 4)
            .sum::<usize>();
        let mut wire = vec![0xff, 0xff, 0xfd, 0, 0xfe];
        wire.extend((length as u16).to_le_bytes());
        wire.push(dynamixel2::STATUS);
        let absent = dice.byte();
        for (at, &(id, data)) in self.fast.iter().enumerate() {
            if absent >> (at % 8) & 1 == 1 {
                continue;
            }
            wire.extend([0, id]);
            wire.extend((0..data).map(|_| dice.byte()));
            wire.extend(dynamixel2::crc(&wire).to_le_bytes());
        }
        self.hear_damaged(wire, dice);
    }

    fn hear_damaged(&mut self, mut wire: Vec<u8>, dice: &mut Dice<'_>) {
        for _ in 0..dice.byte() % 3 {
            if wire.is_empty() {
                break;
            }
            let at = usize::from(dice.byte()) % wire.len();
            match dice.byte() % 4 {
                0 => wire[at] = dice.byte(),
                1 => drop(wire.remove(at)),
                2 => wire.insert(at, dice.byte()),
                _ => wire.truncate(at),
            }
        }
        self.hear(&wire);
    }

    fn recovers(&mut self) {
        self.give_up();
        let mut out = Vec::new();
        framing::read(self.protocol, &mut out, 7, 36, 3).expect("a small packet");
        self.fast.clear();
        self.sent.clone_from(&out);
        self.in_pieces.sent(&out);
        self.byte_by_byte.sent(&out);
        let wire = self.status(7, 0, &[0xff, 0xfd, 0x01]);
        let mut heard = Vec::new();
        self.in_pieces.push(&wire, &mut |what| heard.push(keep(what)));
        let (id, error, data) = (7, 0, vec![0xff, 0xfd, 0x01]);
        assert_eq!(heard, [Kept::Status { id, error, data }], "does not recover");
    }
}

fn contains(all: &[u8], part: &[u8]) -> bool {
    part.is_empty() || all.windows(part.len()).any(|window| window == part)
}
