//! Who carries out a packet that has just been heard, and who answers.

use super::bus::ServoBus;
use super::execute::{After, Done};
use super::packet::{self, ALERT, BROADCAST, error, instruction};
use super::receiver::{BadCrc, Heard};
use super::table::Reg;

impl ServoBus {
    /// A packet was complete at `at_ns`.
    pub(super) fn dispatch(&mut self, at_ns: u64, heard: Heard) {
        // A new header ends whatever was still being answered.
        self.chain.stop();
        match heard {
            Heard::BadCrc { id } => {
                if self.options.bad_crc == BadCrc::Answer {
                    self.alone(at_ns, id, None);
                }
            }
            Heard::Instruction {
                id: BROADCAST,
                instruction,
            } => self.for_all(at_ns, instruction),
            Heard::Instruction { id, instruction } => self.alone(at_ns, id, Some(instruction)),
        }
    }

    /// For the servo with number `id`, or for its shadow, which obeys without a word. Without an
    /// instruction its checksum was wrong.
    fn alone(&mut self, at_ns: u64, id: u8, code: Option<u8>) {
        self.begin_answer();
        self.reboots.clear();
        for place in 0..self.servos.len() {
            let servo = &mut self.servos[place];
            let is_shadow = servo.table.get(Reg::ShadowId) == i64::from(id) && servo.id() != id;
            if servo.id() != id && !is_shadow || !servo.hears(at_ns, self.options.baud) {
                continue;
            }
            servo.advance(at_ns);
            servo.last_heard_ns = at_ns;
            servo.counters.instructions += 1;
            self.answer_params.clear();
            // The answer to a change of its own level or speed is still sent in the old manner.
            let answers = servo.answers(code.unwrap_or(instruction::WRITE)) && !servo.silent && !is_shadow;
            let delay_ns = servo.delay_ns();
            let done = match code {
                Some(code) => servo.execute(
                    at_ns,
                    code,
                    self.receiver.params(),
                    false,
                    &mut self.answer_params,
                ),
                None => Done::from(error::CRC),
            };
            if done.after == After::Reboot {
                self.reboots.push(place);
            }
            if answers {
                let alert = if servo.table.get(Reg::HardwareErrorStatus) != 0 {
                    ALERT
                } else {
                    0
                };
                if done.error != 0 {
                    self.answer_params.clear();
                }
                self.one_answer.clear();
                packet::status(id, done.error | alert, &self.answer_params, &mut self.one_answer);
                self.add_answer(delay_ns);
            }
        }
        let end_ns = self.finish_answer(id, at_ns).unwrap_or(at_ns);
        for &place in &self.reboots {
            self.servos[place].reboot(end_ns);
        }
    }

    fn for_all(&mut self, at_ns: u64, code: u8) {
        let baud = self.options.baud;
        for servo in self.servos.iter_mut().filter(|servo| servo.hears(at_ns, baud)) {
            servo.advance(at_ns);
            servo.last_heard_ns = at_ns;
        }
        let params = self.receiver.params();
        match code {
            instruction::PING => {
                let ids = self
                    .servos
                    .iter()
                    .filter(|servo| servo.hears(at_ns, baud) && !servo.silent);
                self.chain.ping(at_ns, ids.map(super::servo::Servo::id));
            }
            instruction::SYNC_READ | instruction::FAST_SYNC_READ => self.chain.sync(at_ns, code, params),
            instruction::BULK_READ | instruction::FAST_BULK_READ => self.chain.bulk(at_ns, code, params),
            instruction::SYNC_WRITE => self.sync_write(at_ns),
            instruction::BULK_WRITE => self.bulk_write(at_ns),
            // "Broadcast ID is not applied to Read" (protocol page).
            instruction::READ => {}
            _ => self.for_each(at_ns, code),
        }
    }

    /// Any other instruction to all: obeyed, never answered.
    fn for_each(&mut self, at_ns: u64, code: u8) {
        for servo in &mut self.servos {
            if !servo.hears(at_ns, self.options.baud) {
                continue;
            }
            servo.counters.instructions += 1;
            self.answer_params.clear();
            let done = servo.execute(at_ns, code, self.receiver.params(), true, &mut self.answer_params);
            if done.after == After::Reboot {
                servo.reboot(at_ns);
            }
        }
    }

    fn sync_write(&mut self, at_ns: u64) {
        let &[a, b, c, d, ref blocks @ ..] = self.receiver.params() else {
            return;
        };
        let (address, length) = (
            u16::from_le_bytes([a, b]),
            usize::from(u16::from_le_bytes([c, d])),
        );
        for block in blocks.chunks_exact(length + 1) {
            for servo in &mut self.servos {
                if servo.id() == block[0] && servo.hears(at_ns, self.options.baud) {
                    servo.counters.instructions += 1;
                    servo.write(at_ns, address, &block[1..]);
                }
            }
        }
    }

    fn bulk_write(&mut self, at_ns: u64) {
        let mut rest = self.receiver.params();
        while let &[id, a, b, c, d, ref tail @ ..] = rest {
            let (address, length) = (
                u16::from_le_bytes([a, b]),
                usize::from(u16::from_le_bytes([c, d])),
            );
            let Some((bytes, after)) = tail.split_at_checked(length) else {
                return;
            };
            for servo in &mut self.servos {
                if servo.id() == id && servo.hears(at_ns, self.options.baud) {
                    servo.counters.instructions += 1;
                    servo.write(at_ns, address, bytes);
                }
            }
            rest = after;
        }
    }
}
