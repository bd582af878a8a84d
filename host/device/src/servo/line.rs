//! One half-duplex line: what was asked on it, who has answered, and until when to listen.
//!
//! Deadlines are worked out from the time the bytes need on the wire, the servos' return delay and the
//! adapter's slack, so that a servo that is not there costs the slack and no more.

use super::framing::dynamixel2::STATUS_OVERHEAD_BYTES;
use super::framing::{Decoder, Heard, Status};
use crate::clock::Instant;
use crate::transport::{Transport, TransportError};
use device_profiles::ServoProtocol;
use std::time::Duration;

/// Bits on the wire for a byte: start, eight, stop.
const BITS_PER_BYTE: u64 = 10;
/// Return delay of a servo nobody has configured yet: the register's highest value, 254 x 2 us.
pub(super) const RETURN_DELAY_MAX: Duration = Duration::from_micros(508);
/// Time a servo needs to begin its answer at return delay 0; about 50 us were measured on MX-64 (users'
/// reports), doubled here.
const TURNAROUND: Duration = Duration::from_micros(100);
/// After the time that all answers need on the wire, this much later it is surely free again.
const GUARD: Duration = Duration::from_millis(2);

/// What went by on the line.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct LineCounters {
    pub(super) sent_bytes: u64,
    pub(super) received_bytes: u64,
    /// Answers that nobody waits for any more, or of another length than asked for.
    pub(super) stray_answers: u64,
    /// Our own instructions heard back.
    pub(super) echoes: u64,
    /// Servos that did not answer in time.
    pub(super) timeouts: u64,
    /// Damaged packets.
    pub(super) rejected: u64,
    /// Bytes that belonged to no packet.
    pub(super) skipped_bytes: u64,
}

/// Where the current request stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Progress {
    /// Nothing was asked.
    Idle,
    /// Answers are outstanding and may still come.
    Waiting,
    /// All answered, or the deadline is over; [`Line::missing`] tells who did not answer.
    Done,
}

pub(super) struct Line {
    transport: Box<dyn Transport>,
    decoder: Decoder,
    baud: u32,
    slack: Duration,
    return_delay: Duration,
    out: Vec<u8>,
    asked: Vec<Asked>,
    data_bytes: usize,
    open: bool,
    sent: Instant,
    /// When the last packet has left, however many were handed over at once.
    busy_until: Instant,
    wire_free: Instant,
    deadline: Instant,
    heard: Instant,
    counters: LineCounters,
}

#[derive(Debug, Clone, Copy)]
struct Asked {
    id: u8,
    answered: bool,
    /// When this answer should be measured if all go before it in turn.
    expected: Duration,
}

/// One answer that was asked for.
pub(super) struct Answer<'a> {
    pub(super) status: Status<'a>,
    /// When its request was handed to the line.
    pub(super) sent: Instant,
    /// How long after that its turn to measure comes, at the latest.
    pub(super) turn: Duration,
    /// When the servo should have measured: between `sent` and now.
    pub(super) measured: Instant,
}

impl Line {
    pub(super) fn new(transport: Box<dyn Transport>, baud: u32, slack: Duration) -> Self {
        Self {
            transport,
            decoder: Decoder::new(ServoProtocol::Dynamixel2),
            baud: baud.max(1),
            slack,
            return_delay: RETURN_DELAY_MAX,
            out: Vec::with_capacity(1024),
            asked: Vec::with_capacity(256),
            data_bytes: 0,
            open: false,
            sent: Instant::ZERO,
            busy_until: Instant::ZERO,
            wire_free: Instant::ZERO,
            deadline: Instant::ZERO,
            heard: Instant::ZERO,
            counters: LineCounters::default(),
        }
    }

    pub(super) fn counters(&self) -> LineCounters {
        LineCounters {
            rejected: self.decoder.counters().rejected,
            skipped_bytes: self.decoder.counters().skipped_bytes,
            ..self.counters
        }
    }

    pub(super) fn baud(&self) -> u32 {
        self.baud
    }

    pub(super) fn transport_mut(&mut self) -> &mut dyn Transport {
        self.transport.as_mut()
    }

    pub(super) fn set_baud(&mut self, baud: u32) -> Result<(), TransportError> {
        self.transport.set_baud(baud)?;
        self.baud = baud.max(1);
        Ok(())
    }

    pub(super) fn set_return_delay(&mut self, delay: Duration) {
        self.return_delay = delay.min(RETURN_DELAY_MAX);
    }

    pub(super) fn replace(&mut self, transport: Box<dyn Transport>) {
        self.transport = transport;
        self.return_delay = RETURN_DELAY_MAX;
        self.abandon();
    }

    /// Time of so many bytes on the wire.
    pub(super) fn wire_time(&self, bytes: usize) -> Duration {
        Duration::from_nanos(bytes as u64 * BITS_PER_BYTE * 1_000_000_000 / u64::from(self.baud))
    }

    /// How long a request of `request_bytes` to `servos` takes that answer with `data_bytes` each.
    pub(super) fn exchange_time(&self, request_bytes: usize, servos: usize, data_bytes: usize) -> Duration {
        let each = self.answer_time(data_bytes);
        self.wire_time(request_bytes) + each * u32::try_from(servos).unwrap_or(u32::MAX)
    }

    fn answer_time(&self, data_bytes: usize) -> Duration {
        // Stuffing adds at most a third to the data.
        self.return_delay + TURNAROUND + self.wire_time(STATUS_OVERHEAD_BYTES + data_bytes + data_bytes / 3)
    }

    /// The buffer for the next packets, empty.
    pub(super) fn packet(&mut self) -> &mut Vec<u8> {
        self.out.clear();
        &mut self.out
    }

    /// The buffer with the packets that wait to be sent.
    pub(super) fn packet_so_far(&mut self) -> &mut Vec<u8> {
        &mut self.out
    }

    /// Whether the wire must be silent by now, even if answers are still outstanding.
    pub(super) fn is_wire_free(&self, now: Instant) -> bool {
        !self.open || now >= self.wire_free
    }

    /// How long nothing was sent or heard.
    pub(super) fn quiet_for(&self, now: Instant) -> Duration {
        now.since(self.heard.max(self.sent))
    }

    /// When the answers outstanding are given up.
    pub(super) fn deadline(&self) -> Option<Instant> {
        self.open.then_some(self.deadline)
    }

    /// Stops listening for what is outstanding; it will be counted as stray.
    pub(super) fn abandon(&mut self) {
        self.open = false;
        self.asked.clear();
    }

    /// Sends what is in the packet buffer and listens for `data_bytes` from each of `ids`, in that order.
    /// Whatever arrived before is thrown away and counted.
    pub(super) fn send(
        &mut self,
        now: Instant,
        ids: impl IntoIterator<Item = u8>,
        data_bytes: usize,
    ) -> Result<(), TransportError> {
        self.drain(now)?;
        let left = now.max(self.busy_until).after(self.wire_time(self.out.len()));
        self.busy_until = left;
        let request = left.since(now);
        let each = self.answer_time(data_bytes);
        let lead = self.return_delay + TURNAROUND;
        for (at, id) in ids.into_iter().enumerate() {
            let expected = request + lead + each * u32::try_from(at).unwrap_or(u32::MAX);
            self.asked.push(Asked {
                id,
                answered: false,
                expected,
            });
        }
        let total = request + each * u32::try_from(self.asked.len()).unwrap_or(u32::MAX);
        self.data_bytes = data_bytes;
        self.open = !self.asked.is_empty();
        self.sent = now;
        self.wire_free = now.after(total + GUARD);
        self.deadline = now.after(total + self.slack);
        self.counters.sent_bytes += self.out.len() as u64;
        self.decoder.sent(&self.out);
        self.transport.write(&self.out)
    }

    /// Throws away what has arrived, and any request that is open.
    pub(super) fn drain(&mut self, now: Instant) -> Result<(), TransportError> {
        self.abandon();
        self.poll(now, &mut |_| {})?;
        self.decoder.clear();
        Ok(())
    }

    /// Reads what has arrived and hands out the answers that were asked for.
    pub(super) fn poll(
        &mut self,
        now: Instant,
        take: &mut dyn FnMut(Answer<'_>),
    ) -> Result<Progress, TransportError> {
        let mut chunk = [0_u8; 512];
        loop {
            let count = self.transport.read(&mut chunk)?;
            if count == 0 {
                break;
            }
            self.heard = now;
            self.counters.received_bytes += count as u64;
            self.listen(now, chunk.get(..count), take);
        }
        if !self.open {
            return Ok(Progress::Idle);
        }
        if now >= self.deadline && !self.all_answered() {
            self.listen(now, None, take);
            self.counters.timeouts += self.missing().count() as u64;
            self.open = false;
        }
        if self.all_answered() {
            self.open = false;
        }
        Ok(if self.open {
            Progress::Waiting
        } else {
            Progress::Done
        })
    }

    /// Reads what has arrived and hands out every answer, whoever it is from: for broadcast pings.
    pub(super) fn overhear(
        &mut self,
        now: Instant,
        take: &mut dyn FnMut(Status<'_>),
    ) -> Result<(), TransportError> {
        let mut chunk = [0_u8; 512];
        loop {
            let count = self.transport.read(&mut chunk)?;
            if count == 0 {
                return Ok(());
            }
            self.heard = now;
            self.counters.received_bytes += count as u64;
            let bytes = chunk.get(..count).unwrap_or_default();
            self.decoder.push(bytes, &mut |heard| {
                if let Heard::Status(status) = heard {
                    take(status);
                }
            });
        }
    }

    /// Who has not answered the last request.
    pub(super) fn missing(&self) -> impl Iterator<Item = u8> + '_ {
        self.asked
            .iter()
            .filter(|asked| !asked.answered)
            .map(|asked| asked.id)
    }

    fn all_answered(&self) -> bool {
        self.asked.iter().all(|asked| asked.answered)
    }

    /// Decodes more bytes, or with none gives up what is unfinished.
    fn listen(&mut self, now: Instant, bytes: Option<&[u8]>, take: &mut dyn FnMut(Answer<'_>)) {
        let before = self.missing().count();
        let Self {
            decoder,
            asked,
            counters,
            open,
            data_bytes,
            sent,
            ..
        } = self;
        let mut sort = |heard: Heard<'_>| {
            let status = match heard {
                Heard::Status(status) => status,
                Heard::Echo => {
                    counters.echoes += 1;
                    return;
                }
                Heard::Instruction(_) | Heard::Damaged { .. } => return,
            };
            let whole = status.data.len() == *data_bytes || status.error.number() != 0;
            match asked
                .iter_mut()
                .find(|asked| *open && whole && asked.id == status.id && !asked.answered)
            {
                Some(asked) => {
                    asked.answered = true;
                    let measured = now.min(sent.after(asked.expected));
                    take(Answer {
                        status,
                        sent: *sent,
                        turn: asked.expected,
                        measured,
                    });
                }
                None => counters.stray_answers += 1,
            }
        };
        match bytes {
            Some(bytes) => decoder.push(bytes, &mut sort),
            None => decoder.give_up(&mut sort),
        }
        if self.missing().count() < before {
            // Servos behind an absent one may wait for it before they answer: listen on while any do.
            let next = now.after(self.slack + self.answer_time(self.data_bytes));
            self.deadline = self.deadline.max(next);
        }
    }
}
