//! Who carries out a packet that has just been heard, and who answers.

use super::bus::ServoBus;
use super::execute::{After, Done};
use super::heard::{BROADCAST, Framing, Heard, Order, Refusal};
use super::reg::Reg;
use super::servo::Servo;
use super::{BadCrc, dynamixel2, summed};
use device_profiles::ServoProtocol;

impl ServoBus {
    /// A packet was complete at `at_ns`; its parameters are `params`.
    pub(super) fn dispatch(&mut self, at_ns: u64, heard: Heard, params: &[u8]) {
        // A new header ends whatever was still being answered.
        self.chain.stop();
        match heard.instruction {
            None if self.options.bad_crc == BadCrc::Silent => {}
            Some(code) if heard.id == BROADCAST => self.for_all(at_ns, heard, code, params),
            _ => self.alone(at_ns, heard, params),
        }
    }

    /// For the servo with that number, or for its shadow, which obeys without a word.
    fn alone(&mut self, at_ns: u64, heard: Heard, params: &[u8]) {
        self.begin_answer();
        self.reboots.clear();
        for place in 0..self.servos.len() {
            let servo = &mut self.servos[place];
            let is_shadow = servo.table.get(Reg::ShadowId) == i64::from(heard.id) && servo.id() != heard.id;
            if servo.id() != heard.id && !is_shadow || !servo.is_addressed(heard, self.options.baud) {
                continue;
            }
            servo.advance(at_ns);
            servo.last_heard_ns = at_ns;
            servo.counters.instructions += 1;
            self.answer_params.clear();
            let order = heard
                .instruction
                .map_or(Order::Unknown, |code| servo.asked(code, params));
            // The answer to a change of its own level or speed is still sent in the old manner.
            let answers = servo.answers(&order) && !servo.silent && !is_shadow;
            let delay_ns = servo.delay_ns();
            let done = match heard.instruction {
                Some(_) => servo.execute(at_ns, order, false, &mut self.answer_params),
                None => Done::from(Refusal::Checksum),
            };
            if done.after == After::Reboot {
                self.reboots.push(place);
            }
            if answers {
                if done.refusal.is_some() {
                    self.answer_params.clear();
                }
                let error = servo.error_byte(done.refusal);
                self.one_answer.clear();
                write_status(
                    heard.framing,
                    heard.id,
                    error,
                    &self.answer_params,
                    &mut self.one_answer,
                );
                self.add_answer(delay_ns);
            }
        }
        let end_ns = self.finish_answer(heard.id, at_ns).unwrap_or(at_ns);
        for servo in &mut self.servos {
            servo.finish_instruction(end_ns);
        }
        for &place in &self.reboots {
            self.servos[place].reboot(end_ns);
        }
    }

    fn for_all(&mut self, at_ns: u64, heard: Heard, code: u8, params: &[u8]) {
        let baud = self.options.baud;
        for servo in self
            .servos
            .iter_mut()
            .filter(|servo| servo.is_addressed(heard, baud))
        {
            servo.advance(at_ns);
            servo.last_heard_ns = at_ns;
        }
        match heard.framing {
            Framing::Dynamixel2 => self.for_all_dynamixel2(at_ns, heard, code, params),
            Framing::Summed => self.for_all_summed(at_ns, heard, code, params),
        }
        for servo in &mut self.servos {
            servo.finish_instruction(at_ns);
        }
    }

    fn for_all_dynamixel2(&mut self, at_ns: u64, heard: Heard, code: u8, params: &[u8]) {
        use dynamixel2::packet::instruction;
        match code {
            instruction::PING => self.ping_all(at_ns, heard),
            instruction::SYNC_READ => self.chain.sync_read(at_ns, params),
            instruction::FAST_SYNC_READ => self.chain.fast_sync_read(at_ns, params),
            instruction::BULK_READ => self.chain.bulk_read(at_ns, params),
            instruction::FAST_BULK_READ => self.chain.fast_bulk_read(at_ns, params),
            instruction::SYNC_WRITE => {
                let &[a, b, c, d, ref blocks @ ..] = params else {
                    return;
                };
                let (address, length) = (u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d]));
                self.sync_write(at_ns, heard, address, length.into(), blocks);
            }
            instruction::BULK_WRITE => self.bulk_write(at_ns, heard, params),
            // "Broadcast ID is not applied to Read" (protocol page).
            instruction::READ => {}
            _ => self.for_each(at_ns, heard, code, params),
        }
    }

    fn for_all_summed(&mut self, at_ns: u64, heard: Heard, code: u8, params: &[u8]) {
        use summed::packet::instruction;
        match (code, params) {
            (instruction::PING, _) => self.ping_all(at_ns, heard),
            (instruction::SYNC_READ, &[address, length, ref ids @ ..]) => {
                self.chain
                    .summed_sync_read(at_ns, address.into(), length.into(), ids);
            }
            (instruction::BULK_READ, &[_, ref blocks @ ..]) => self.chain.summed_bulk_read(at_ns, blocks),
            (instruction::SYNC_WRITE, &[address, length, ref blocks @ ..]) => {
                self.sync_write(at_ns, heard, address.into(), length.into(), blocks);
            }
            // Too short, or what is not for all.
            (
                instruction::READ | instruction::SYNC_READ | instruction::BULK_READ | instruction::SYNC_WRITE,
                _,
            ) => {}
            _ => self.for_each(at_ns, heard, code, params),
        }
    }

    /// Those that know their turn answer one after the other in the order of their numbers; an AX, an MX or an SCS
    /// answers at once, whoever else does.
    fn ping_all(&mut self, at_ns: u64, heard: Heard) {
        let baud = self.options.baud;
        let hearing = |servo: &&Servo| servo.is_addressed(heard, baud) && !servo.silent;
        let orderly = |servo: &&Servo| hearing(servo) && servo.facts.broadcast_ping;
        let ids = self.servos.iter().filter(orderly).map(Servo::id);
        self.chain.ping(at_ns, heard.framing, ids);
        self.begin_answer();
        for place in 0..self.servos.len() {
            let servo = &self.servos[place];
            if !hearing(&servo) || servo.facts.broadcast_ping {
                continue;
            }
            let (id, error, delay_ns) = (servo.id(), servo.error_byte(None), servo.delay_ns());
            self.one_answer.clear();
            write_status(heard.framing, id, error, &[], &mut self.one_answer);
            self.add_answer(delay_ns);
        }
        self.finish_answer(BROADCAST, at_ns);
    }

    /// Any other instruction to all: obeyed, never answered.
    fn for_each(&mut self, at_ns: u64, heard: Heard, code: u8, params: &[u8]) {
        for servo in &mut self.servos {
            if !servo.is_addressed(heard, self.options.baud) {
                continue;
            }
            servo.counters.instructions += 1;
            self.answer_params.clear();
            let done = servo.execute(at_ns, servo.asked(code, params), true, &mut self.answer_params);
            if done.after == After::Reboot {
                servo.reboot(at_ns);
            }
        }
    }

    fn sync_write(&mut self, at_ns: u64, heard: Heard, address: u16, length: usize, blocks: &[u8]) {
        for block in blocks.chunks_exact(length + 1) {
            self.write_one(at_ns, heard, block[0], address, &block[1..]);
        }
    }

    fn bulk_write(&mut self, at_ns: u64, heard: Heard, params: &[u8]) {
        let mut rest = params;
        while let &[id, a, b, c, d, ref tail @ ..] = rest {
            let (address, length) = (
                u16::from_le_bytes([a, b]),
                usize::from(u16::from_le_bytes([c, d])),
            );
            let Some((bytes, after)) = tail.split_at_checked(length) else {
                return;
            };
            self.write_one(at_ns, heard, id, address, bytes);
            rest = after;
        }
    }

    fn write_one(&mut self, at_ns: u64, heard: Heard, id: u8, address: u16, bytes: &[u8]) {
        for servo in &mut self.servos {
            if servo.id() == id && servo.is_addressed(heard, self.options.baud) {
                servo.counters.instructions += 1;
                servo.write(at_ns, address, bytes);
            }
        }
    }
}

impl Servo {
    /// Whether a packet of this framing that began then reaches it.
    fn is_addressed(&self, heard: Heard, baud: u32) -> bool {
        self.framing() == heard.framing && self.hears(heard.began_ns, baud)
    }

    fn asked<'a>(&self, code: u8, params: &'a [u8]) -> Order<'a> {
        match self.facts.protocol {
            ServoProtocol::Dynamixel2 => dynamixel2::orders::order(code, params),
            protocol => summed::orders::order(protocol, code, params),
        }
    }
}

/// Appends the status packet of `id`.
pub(super) fn write_status(framing: Framing, id: u8, error: u8, params: &[u8], out: &mut Vec<u8>) {
    match framing {
        Framing::Dynamixel2 => dynamixel2::packet::status(id, error, params, out),
        Framing::Summed => summed::packet::status(id, error, params, out),
    }
}
