//! The half-duplex wire and the adapter at its end: when each byte is where, and what collides.
//!
//! Two senders at once spoil each other's bytes: the line is low where either is low. Source: 8N1 framing,
//! ten bits a byte; the 62 bytes and the latency timer are FTDI's (data sheet "Latency Timer").

use std::collections::VecDeque;

/// Whether bytes take time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WireTime {
    /// Ten bits a byte, return delays, gaps: as on a real bus.
    #[default]
    Real,
    /// Everything is there at once, for programs that only want the bytes.
    None,
}

/// A USB adapter that hands bytes over in pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Adapter {
    /// Longest wait for a piece to fill, from its first byte.
    pub latency_us: u32,
    /// Bytes in a full piece.
    pub chunk: u16,
}

impl Default for Adapter {
    /// An FTDI chip as the kernel sets it up: 62 bytes or 16 ms.
    fn default() -> Self {
        Self {
            latency_us: 16_000,
            chunk: 62,
        }
    }
}

/// A byte with the time it takes on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Byte {
    pub(super) start_ns: u64,
    pub(super) end_ns: u64,
    pub(super) value: u8,
}

impl Byte {
    fn overlaps(&self, other: &Self) -> bool {
        self.start_ns < other.end_ns && other.start_ns < self.end_ns
    }
}

/// Bytes under way in both directions.
#[derive(Clone, Debug)]
pub(super) struct Wire {
    pub(super) byte_ns: u64,
    pub(super) adapter: Option<Adapter>,
    to_servos: VecDeque<Byte>,
    to_host: VecDeque<Byte>,
    host_free_ns: u64,
    host_held_ns: u64,
    servos_free_ns: u64,
    /// Bytes spoilt by a second sender.
    pub(super) collisions: u64,
}

impl Wire {
    pub(super) fn new(byte_ns: u64, adapter: Option<Adapter>) -> Self {
        Self {
            byte_ns,
            adapter,
            to_servos: VecDeque::new(),
            to_host: VecDeque::new(),
            host_free_ns: 0,
            host_held_ns: 0,
            servos_free_ns: 0,
            collisions: 0,
        }
    }

    /// The host says nothing before `until_ns`, whatever its program writes. What a longer hold has kept so far leaves
    /// then; of that, an echo is not heard.
    pub(super) fn hold_host_until(&mut self, until_ns: u64) {
        let held_ns = std::mem::replace(&mut self.host_held_ns, until_ns);
        if until_ns >= held_ns {
            return;
        }
        self.to_host.retain(|byte| byte.start_ns < held_ns);
        let sent = self.to_servos.iter().filter(|byte| byte.start_ns < held_ns);
        self.host_free_ns = sent.map(|byte| byte.end_ns).max().unwrap_or(0).max(until_ns);
        for byte in self.to_servos.iter_mut().filter(|byte| byte.start_ns >= held_ns) {
            byte.start_ns = self.host_free_ns;
            self.host_free_ns += self.byte_ns;
            byte.end_ns = self.host_free_ns;
        }
    }

    /// The host writes one byte at `now_ns` or as soon as its last is out; `heard_back` is an echo.
    pub(super) fn host_sends(&mut self, now_ns: u64, byte: u8, heard_back: bool) {
        let start_ns = self.host_free_ns.max(now_ns).max(self.host_held_ns);
        self.host_free_ns = start_ns.saturating_add(self.byte_ns);
        let mut sent = Byte {
            start_ns,
            end_ns: self.host_free_ns,
            value: byte,
        };
        if start_ns < self.servos_free_ns {
            self.collisions += collide(&mut self.to_host, &mut sent);
        }
        self.to_servos.push_back(sent);
        if heard_back {
            insert(&mut self.to_host, sent);
        }
    }

    /// Servos write `bytes` from `start_ns` on; gives the time after the last.
    pub(super) fn servos_send(&mut self, start_ns: u64, bytes: &[u8]) -> u64 {
        let mut at_ns = start_ns;
        for &byte in bytes {
            let mut sent = Byte {
                start_ns: at_ns,
                end_ns: at_ns + self.byte_ns,
                value: byte,
            };
            at_ns = sent.end_ns;
            if sent.start_ns < self.host_free_ns {
                self.collisions += collide(&mut self.to_servos, &mut sent);
            }
            if sent.start_ns < self.servos_free_ns {
                self.collisions += collide(&mut self.to_host, &mut sent);
            }
            insert(&mut self.to_host, sent);
        }
        self.servos_free_ns = self.servos_free_ns.max(at_ns);
        at_ns
    }

    /// The host listens at another speed from `now_ns` on: bytes still under way become others.
    pub(super) fn spoil(&mut self, now_ns: u64) {
        for byte in self.to_host.iter_mut().filter(|byte| byte.end_ns > now_ns) {
            byte.value = byte.value.rotate_left(3) ^ 0x55;
        }
    }

    /// When the next byte of the host has reached the servos.
    pub(super) fn next_arrival_ns(&self) -> Option<u64> {
        self.to_servos.front().map(|byte| byte.end_ns)
    }

    /// Takes the host's next byte if it has reached the servos by `until_ns`.
    pub(super) fn arrival(&mut self, until_ns: u64) -> Option<Byte> {
        self.to_servos.pop_front_if(|byte| byte.end_ns <= until_ns)
    }

    /// Appends what the adapter has handed to the host by `now_ns`.
    pub(super) fn deliver(&mut self, now_ns: u64, out: &mut Vec<u8>) {
        while let Some(handed_ns) = self.next_delivery_ns().filter(|&at| at <= now_ns) {
            while let Some(byte) = self.to_host.pop_front_if(|byte| byte.end_ns <= handed_ns) {
                out.push(byte.value);
            }
        }
    }

    /// When the adapter next hands something over.
    pub(super) fn next_delivery_ns(&self) -> Option<u64> {
        let first_ns = self.to_host.front()?.end_ns;
        let Some(adapter) = self.adapter else {
            return Some(first_ns);
        };
        let timer_ns = first_ns.saturating_add(u64::from(adapter.latency_us) * 1000);
        let full = self.to_host.get(usize::from(adapter.chunk.max(1)) - 1);
        Some(full.map_or(timer_ns, |last| last.end_ns.min(timer_ns)))
    }
}

/// Spoils `sent` and every waiting byte on the line at the same time; gives how many pairs met.
fn collide(waiting: &mut VecDeque<Byte>, sent: &mut Byte) -> u64 {
    let mut met = 0;
    for other in waiting
        .iter_mut()
        .rev()
        .take_while(|other| other.end_ns > sent.start_ns)
    {
        if other.overlaps(sent) {
            // Bits do not line up unless both began together.
            let shift = u32::from(other.start_ns != sent.start_ns);
            let low = other.value & sent.value.rotate_left(shift);
            other.value = low;
            sent.value = low;
            met += 1;
        }
    }
    met
}

/// Keeps the queue in the order in which bytes end.
fn insert(queue: &mut VecDeque<Byte>, byte: Byte) {
    let later = queue
        .iter()
        .rev()
        .take_while(|other| other.end_ns > byte.end_ns)
        .count();
    queue.insert(queue.len() - later, byte);
}
