//! One half-duplex line: what was asked on it, who has answered, and until when to listen.
//!
//! Deadlines are worked out from the time the bytes need on the wire, the servos' return delay and what the line has
//! shown of its punctuality, so that a servo that is not there costs little. An answer counts only if it is from a
//! servo that was asked, has the length that was asked for, and no older answer of that length is owed: so it is the
//! answer to this question and to no other.

use super::framing::{Decoder, Heard, Status, status_overhead_bytes};
use super::owed::Owed;
use super::tempo::Tempo;
use super::turns::Turns;
use crate::clock::{Clock, Instant};
use crate::transport::{Awaited, Transport, TransportError, wait_any};
use device_profiles::ServoProtocol;
use std::time::Duration;

/// Bits on the wire for a byte: start, eight, stop.
const BITS_PER_BYTE: u64 = 10;
/// Return delay of a servo nobody has configured yet: the register's highest value, 254 x 2 us.
pub(super) const RETURN_DELAY_MAX: Duration = Duration::from_micros(508);
/// Time a servo needs to begin its answer at return delay 0; about 50 us were measured on MX-64 (users'
/// reports), doubled here.
pub(super) const TURNAROUND: Duration = Duration::from_micros(100);
/// After the time that all answers need on the wire, at most this much later it is surely free again.
const GUARD: Duration = Duration::from_millis(2);
/// How late a servo itself may answer; see [`Owed`].
const LATE_MAX: Duration = Duration::from_millis(100);
/// So long before the last answer is due bytes may wake a thread; those before it are not worth it. A busy machine
/// wakes a sleeper a millisecond late.
const AHEAD: Duration = Duration::from_millis(2);
/// Servos that one line can have, for the room kept for them.
const SERVOS_MAX: usize = 254;

/// What went by on the line.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct LineCounters {
    pub(super) sent_bytes: u64,
    pub(super) received_bytes: u64,
    /// Late answers: to a question that had been given up.
    pub(super) late_answers: u64,
    /// Other answers that nobody waits for, or of another length than asked for.
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
    /// One for each protocol spoken so far; `speaking` is in use.
    decoders: Vec<Decoder>,
    speaking: usize,
    baud: u32,
    alert: Duration,
    tempo: Tempo,
    return_delay: Duration,
    out: Vec<u8>,
    /// Where in `out` the packets begin that are in the protocol being spoken.
    own_from: usize,
    asked: Vec<Asked>,
    owed: Owed,
    open: bool,
    /// Somebody waits for this exchange and looks as soon as bytes come.
    awaited: bool,
    /// And has looked since answers may be there, in vain.
    looked: bool,
    sent: Instant,
    /// When the last packet has left, however many were handed over at once.
    busy_until: Instant,
    /// When the wire alone is done with all answers.
    done: Instant,
    wire_free: Instant,
    deadline: Instant,
    heard: Instant,
    counters: LineCounters,
}

#[derive(Debug, Clone, Copy)]
struct Asked {
    id: u8,
    bytes: u16,
    answered: bool,
    /// When this answer should be measured if all go before it in turn.
    expected: Duration,
}

/// One answer that was asked for.
pub(super) struct Answer<'a> {
    pub(super) status: Status<'a>,
    /// The data have the length that was asked for; otherwise it is a refusal.
    pub(super) whole: bool,
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
            decoders: vec![Decoder::new(ServoProtocol::Dynamixel2)],
            speaking: 0,
            baud: baud.max(1),
            alert: Duration::ZERO,
            tempo: Tempo::new(slack),
            return_delay: RETURN_DELAY_MAX,
            out: Vec::with_capacity(4096),
            own_from: 0,
            asked: Vec::with_capacity(SERVOS_MAX),
            owed: Owed::new(LATE_MAX),
            open: false,
            awaited: false,
            looked: false,
            sent: Instant::ZERO,
            busy_until: Instant::ZERO,
            done: Instant::ZERO,
            wire_free: Instant::ZERO,
            deadline: Instant::ZERO,
            heard: Instant::ZERO,
            counters: LineCounters::default(),
        }
    }

    pub(super) fn counters(&self) -> LineCounters {
        let heard = || self.decoders.iter().map(Decoder::counters);
        LineCounters {
            rejected: heard().map(|heard| heard.rejected).sum(),
            skipped_bytes: heard().map(|heard| heard.skipped_bytes).sum(),
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

    /// How long around the time at which answers are due a thread that waits stays awake.
    pub(super) fn set_alert(&mut self, alert: Duration) {
        self.alert = alert;
    }

    pub(super) fn replace(&mut self, transport: Box<dyn Transport>) {
        self.transport = transport;
        self.return_delay = RETURN_DELAY_MAX;
        self.abandon();
        self.owed.clear();
        self.decoders.iter_mut().for_each(Decoder::clear);
    }

    /// The protocol of the packets that follow, and of their answers.
    pub(super) fn speak(&mut self, protocol: ServoProtocol) {
        let known = self
            .decoders
            .iter()
            .position(|decoder| decoder.protocol() == protocol);
        let wanted = known.unwrap_or_else(|| {
            self.decoders.push(Decoder::new(protocol));
            self.decoders.len() - 1
        });
        if wanted != self.speaking {
            self.speaking = wanted;
            self.own_from = self.out.len();
        }
    }

    /// The protocol being spoken.
    pub(super) fn protocol(&self) -> ServoProtocol {
        self.decoders
            .get(self.speaking)
            .map_or(ServoProtocol::Dynamixel2, Decoder::protocol)
    }

    /// The packets that follow in the buffer are those in the protocol being spoken.
    pub(super) fn begin_own(&mut self) {
        self.own_from = self.out.len();
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

    /// The longest that one answer may take in its turn.
    fn answer_time(&self, data_bytes: usize) -> Duration {
        let overhead = status_overhead_bytes(self.protocol());
        // Stuffing adds at most a third to the data.
        let bytes = overhead + data_bytes + data_bytes / 3;
        self.return_delay + TURNAROUND + self.wire_time(bytes)
    }

    /// The buffer for the next packets, empty.
    pub(super) fn packet(&mut self) -> &mut Vec<u8> {
        self.out.clear();
        self.own_from = 0;
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

    /// How much later than the wire's own time it is surely free again.
    pub(super) fn guard(&self) -> Duration {
        GUARD.min(self.tempo.slack())
    }

    /// An answer to what was asked at `asked` proves that older answers have come or never will.
    pub(super) fn heard_of(&mut self, asked: Instant) {
        self.owed.heard_of(asked);
    }

    /// What may still come although it is not waited for any more.
    pub(super) fn owed(&self) -> &Owed {
        &self.owed
    }

    /// Stops listening for what is outstanding; it is owed from now on.
    pub(super) fn abandon(&mut self) {
        if self.open {
            for asked in self.asked.iter().filter(|asked| !asked.answered) {
                self.owed.note(asked.id, asked.bytes, self.sent);
            }
        }
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
        let bytes = u16::try_from(data_bytes).unwrap_or(u16::MAX);
        let turns = Turns::each(self.protocol());
        self.send_for(now, turns, ids.into_iter().map(|id| (id, bytes)))
    }

    /// The same, for answers of a length of its own from each servo.
    pub(super) fn send_for(
        &mut self,
        now: Instant,
        turns: Turns,
        wanted: impl IntoIterator<Item = (u8, u16)>,
    ) -> Result<(), TransportError> {
        self.drain(now)?;
        let left = now.max(self.busy_until).after(self.wire_time(self.out.len()));
        self.busy_until = left;
        let request = left.since(now);
        let wire = |bytes: usize| {
            Duration::from_nanos(bytes as u64 * BITS_PER_BYTE * 1_000_000_000 / u64::from(self.baud))
        };
        let mut clock = turns.begin(request, self.return_delay + TURNAROUND);
        let mut alone = turns.begin(request, self.return_delay);
        for (id, bytes) in wanted {
            let expected = clock.next(bytes, true, wire);
            alone.next(bytes, false, wire);
            self.asked.push(Asked {
                id,
                bytes,
                answered: false,
                expected,
            });
        }
        let total = clock.end();
        self.open = !self.asked.is_empty();
        self.awaited = false;
        self.looked = false;
        self.sent = now;
        self.done = now.after(alone.end());
        let slack = self.tempo.slack();
        self.wire_free = now.after(total + self.guard());
        self.deadline = now.after(total + slack);
        self.counters.sent_bytes += self.out.len() as u64;
        let own = self.out.get(self.own_from..).unwrap_or_default();
        if let Some(decoder) = self.decoders.get_mut(self.speaking) {
            decoder.sent(own);
        }
        self.transport.write(&self.out)
    }

    /// Sends what is in the packet buffer and goes on overhearing: answers to what was sent before may still come.
    pub(super) fn send_on(&mut self, now: Instant) -> Result<(), TransportError> {
        self.sent = now;
        self.counters.sent_bytes += self.out.len() as u64;
        if let Some(decoder) = self.decoders.get_mut(self.speaking) {
            decoder.sent(&self.out);
        }
        self.transport.write(&self.out)
    }

    /// Throws away what has arrived, and any request that is open.
    pub(super) fn drain(&mut self, now: Instant) -> Result<(), TransportError> {
        self.abandon();
        self.poll(now, &mut |_| {})?;
        if let Some(decoder) = self.decoders.get_mut(self.speaking) {
            decoder.clear();
        }
        Ok(())
    }

    /// Reads what has arrived and hands out the answers that were asked for.
    pub(super) fn poll(
        &mut self,
        now: Instant,
        take: &mut dyn FnMut(Answer<'_>),
    ) -> Result<Progress, TransportError> {
        let mut chunk = [0_u8; 2048];
        loop {
            let count = self.transport.read(&mut chunk)?;
            if count == 0 {
                break;
            }
            self.heard = now;
            self.counters.received_bytes += count as u64;
            self.listen(now, chunk.get(..count), take);
            // What was asked for is there: looking for more would only cost time.
            if self.open && self.all_answered() && count < chunk.len() {
                break;
            }
        }
        if !self.open {
            return Ok(Progress::Idle);
        }
        if now >= self.deadline && !self.all_answered() {
            self.listen(now, None, take);
            self.counters.timeouts += self.missing().count() as u64;
            self.give_up();
        } else if self.all_answered() {
            self.open = false;
            if self.awaited {
                self.tempo.learn(self.done, now, self.looked);
            }
        }
        Ok(if self.open {
            Progress::Waiting
        } else {
            Progress::Done
        })
    }

    /// As [`Line::abandon`], but who is missing stays known.
    fn give_up(&mut self) {
        for asked in self.asked.iter().filter(|asked| !asked.answered) {
            self.owed.note(asked.id, asked.bytes, self.sent);
        }
        self.open = false;
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
            let Some(decoder) = self.decoders.get_mut(self.speaking) else {
                return Ok(());
            };
            decoder.push(bytes, &mut |heard| {
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

    /// Waits until it is worth polling: all answers are there, or overdue; at the latest until `until`.
    pub(super) fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        let until = self.deadline().map_or(until, |deadline| deadline.min(until));
        wait_any(&mut [Some(self.awaited())], clock, until);
    }

    /// The line with the time from which on bytes may be worth waking up for.
    pub(super) fn awaited(&mut self) -> Awaited<'_> {
        self.awaited = true;
        let mut from = Instant::ZERO;
        if self.open {
            let due = self.done.after(self.tempo.usual()).as_nanos();
            // Whoever does not stay awake lies down to be woken in good time, so that waking up late costs nothing.
            let before = if self.alert.is_zero() { AHEAD } else { self.alert };
            from = Instant::from_nanos(due.saturating_sub(before.as_nanos() as u64));
        }
        Awaited {
            transport: self.transport.as_mut(),
            from,
            alert_until: from.after(self.alert * 2),
            looked: &mut self.looked,
        }
    }

    /// Decodes more bytes, or with none gives up what is unfinished.
    fn listen(&mut self, now: Instant, bytes: Option<&[u8]>, take: &mut dyn FnMut(Answer<'_>)) {
        let Self {
            decoders,
            speaking,
            asked,
            counters,
            open,
            owed,
            tempo,
            sent,
            done,
            ..
        } = self;
        let Some(decoder) = decoders.get_mut(*speaking) else {
            return;
        };
        let before = asked_and_answered(asked);
        let mut fresh = 0_u16;
        let mut sort = |heard: Heard<'_>| {
            let status = match heard {
                Heard::Status(status) => status,
                Heard::Echo => {
                    counters.echoes += 1;
                    return;
                }
                Heard::Instruction(_) | Heard::Damaged { .. } => return,
            };
            let length = u16::try_from(status.data.len()).unwrap_or(u16::MAX);
            let waited_for = asked.iter_mut().find(|asked| {
                *open && asked.id == status.id && !asked.answered && answers(&status, length, asked.bytes)
            });
            if let Some(asked) = waited_for {
                asked.answered = true;
                fresh = fresh.max(asked.bytes);
                take(Answer {
                    status,
                    whole: length == asked.bytes,
                    sent: *sent,
                    turn: asked.expected,
                    measured: now.min(sent.after(asked.expected)),
                });
            } else if let Some(at) = owed.settle(status.id, length) {
                counters.late_answers += 1;
                // What the wire itself takes for it is like now.
                tempo.learn_of_late(now.since(at).saturating_sub(done.since(*sent)));
            } else {
                counters.stray_answers += 1;
            }
        };
        match bytes {
            Some(bytes) => decoder.push(bytes, &mut sort),
            None => decoder.give_up(&mut sort),
        }
        if asked_and_answered(&self.asked) > before {
            self.owed.heard_of(self.sent);
            // Servos behind an absent one may wait for it before they answer: listen on while any do.
            let next = now.after(self.tempo.slack() + self.answer_time(fresh.into()));
            self.deadline = self.deadline.max(next);
        }
    }
}

/// Whether a status may be what was asked for: it has the length, or it refuses and has no data.
fn answers(status: &Status<'_>, length: u16, wanted: u16) -> bool {
    length == wanted || (length == 0 && status.error.is_refusal())
}

fn asked_and_answered(asked: &[Asked]) -> usize {
    asked.iter().filter(|asked| asked.answered).count()
}
