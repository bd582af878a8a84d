//! What the host put on the line: to know its own words when it hears them, and what the answers may look like.
//!
//! Many adapters hear what they send. In protocol 2.0 an instruction cannot be mistaken for an answer; in protocol
//! 1.0 and Feetech the two have the same frame, so what was sent must be remembered. The one case in which bytes do
//! not tell is a packet without parameters, such as a ping, against an answer without data whose error byte
//! happens to equal the instruction: then the line's habit decides, as proven by packets that do tell.

use super::front::{CRC_BYTES, LENGTH_MAX};
use super::{dynamixel2, summed};
use device_profiles::ServoProtocol;

/// Room for what is sent at once; more makes the buffer grow once.
const SENT_BYTES: usize = 4096;
/// Longest block of a fast read that is understood, in bytes.
const FAST_BLOCK_MAX: u16 = 1000;

/// Whether the line gives back what is sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Echo {
    Unknown,
    Always,
    Never,
}

/// Where a whole packet came from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// It is what was sent.
    Own,
    /// A servo.
    Servo,
    /// Another host, or a copy of something sent before.
    Foreign,
}

#[derive(Debug, Clone)]
pub(super) struct Asked {
    protocol: ServoProtocol,
    sent: Vec<u8>,
    /// How far echoes have been heard.
    heard: usize,
    /// Most data of one answer to what was sent last, and before that, whose answers may be late.
    longest: Option<[usize; 2]>,
    /// Id and data bytes of each servo in the answer to a fast read.
    fast: Vec<(u8, u16)>,
    echo: Echo,
}

impl Asked {
    pub(super) fn new(protocol: ServoProtocol) -> Self {
        Self {
            protocol,
            sent: Vec::with_capacity(SENT_BYTES),
            heard: 0,
            longest: None,
            fast: Vec::with_capacity(256),
            echo: Echo::Unknown,
        }
    }

    /// Takes note of whole packets that are put on the line now.
    pub(super) fn note(&mut self, bytes: &[u8]) {
        self.sent.clear();
        self.sent.extend_from_slice(bytes);
        self.heard = 0;
        self.fast.clear();
        let mut longest = 0;
        let mut rest = bytes;
        while let Some((packet, behind)) = split_packet(self.protocol, rest) {
            longest = longest.max(self.understand(packet));
            rest = behind;
        }
        let before = self.longest.map_or(longest, |[now, _]| now);
        self.longest = Some([longest, before]);
    }

    /// Largest length field of an answer.
    pub(super) fn answer_length_max(&self) -> usize {
        let Some([now, before]) = self.longest else {
            return LENGTH_MAX;
        };
        let data = now.max(before);
        match self.protocol {
            // Instruction, error, data with an FD behind each third byte at worst, CRC.
            ServoProtocol::Dynamixel2 => (2 + data + data.div_ceil(3) + CRC_BYTES).min(LENGTH_MAX),
            ServoProtocol::Dynamixel1 | ServoProtocol::Sts | ServoProtocol::Scs => 2 + data,
        }
    }

    /// Whether these bytes begin like a packet whose echo has not been heard yet.
    pub(super) fn begins_echo(&self, bytes: &[u8]) -> bool {
        let mut rest = self.sent.get(self.heard..).unwrap_or_default();
        while let Some((packet, behind)) = split_packet(self.protocol, rest) {
            let common = bytes.len().min(packet.len());
            if common > 0 && bytes.get(..common) == packet.get(..common) {
                return true;
            }
            rest = behind;
        }
        false
    }

    /// Blocks in the answer to the fast read that was sent, in order.
    pub(super) fn fast(&self) -> &[(u8, u16)] {
        &self.fast
    }

    /// The length field that an answer to the fast read must have.
    pub(super) fn fast_length(&self) -> Option<usize> {
        let blocks = self
            .fast
            .iter()
            .map(|&(_, data)| usize::from(data) + super::fast::BLOCK_OVERHEAD_BYTES);
        (!self.fast.is_empty()).then(|| 1 + blocks.sum::<usize>())
    }

    /// Says where a whole packet came from. `undisturbed`: nothing else was heard since the last [`Asked::note`].
    pub(super) fn source(&mut self, packet: &[u8], undisturbed: bool) -> Source {
        if self.protocol == ServoProtocol::Dynamixel2 {
            let status = packet.get(dynamixel2::BODY_AT) == Some(&dynamixel2::STATUS);
            return match (status, self.take_echo(packet)) {
                (true, _) => Source::Servo,
                (false, true) => Source::Own,
                (false, false) => Source::Foreign,
            };
        }
        let ambiguous = packet.len() == summed::PREFIX_BYTES + 2;
        if ambiguous && self.echo == Echo::Never {
            return Source::Servo;
        }
        if self.take_echo(packet) {
            if !ambiguous {
                self.echo = Echo::Always;
            }
            return Source::Own;
        }
        if packet.get(2) == Some(&super::BROADCAST_ID) {
            return Source::Foreign;
        }
        if undisturbed && self.heard == 0 && self.echo == Echo::Unknown && !self.sent.is_empty() {
            self.echo = Echo::Never;
        }
        Source::Servo
    }

    /// Whether `packet` is one of those sent and not heard yet; those before it are given up.
    fn take_echo(&mut self, packet: &[u8]) -> bool {
        let mut rest = self.sent.get(self.heard..).unwrap_or_default();
        while let Some((sent, behind)) = split_packet(self.protocol, rest) {
            if sent == packet {
                self.heard = self.sent.len() - behind.len();
                return true;
            }
            rest = behind;
        }
        false
    }

    /// Most data of one answer to this packet. Addresses and lengths of reads cannot need stuffing.
    fn understand(&mut self, packet: &[u8]) -> usize {
        match self.protocol {
            ServoProtocol::Dynamixel2 => self.understand_stuffed(packet),
            ServoProtocol::Dynamixel1 | ServoProtocol::Sts | ServoProtocol::Scs => understand_summed(packet),
        }
    }

    fn understand_stuffed(&mut self, packet: &[u8]) -> usize {
        let end = packet.len().saturating_sub(CRC_BYTES);
        let Some((&code, params)) = packet.get(dynamixel2::BODY_AT..end).and_then(<[u8]>::split_first) else {
            return 0;
        };
        let word = |at: usize| match params.get(at..at + 2) {
            Some(&[low, high]) => u16::from_le_bytes([low, high]),
            _ => 0,
        };
        match code {
            0x01 => 3,
            0x02 | 0x82 => usize::from(word(2)),
            0x92 => (0..params.len() / 5)
                .map(|item| usize::from(word(item * 5 + 3)))
                .max()
                .unwrap_or(0),
            0x8a => {
                let ids = params.get(4..).unwrap_or_default();
                self.expect_fast(ids.iter().map(|&id| (id, word(2))))
            }
            0x9a => self.expect_fast(params.chunks_exact(5).filter_map(|item| match item {
                &[id, _, _, low, high] => Some((id, u16::from_le_bytes([low, high]))),
                _ => None,
            })),
            _ => 0,
        }
    }

    /// Most data of one block.
    fn expect_fast(&mut self, blocks: impl Iterator<Item = (u8, u16)>) -> usize {
        self.fast.clear();
        self.fast.extend(blocks);
        let longest = self.fast.iter().map(|&(_, data)| data).max().unwrap_or(0);
        if longest > FAST_BLOCK_MAX {
            self.fast.clear();
        }
        usize::from(longest)
    }
}

fn understand_summed(packet: &[u8]) -> usize {
    let end = packet.len().saturating_sub(1);
    let Some((&code, params)) = packet
        .get(summed::PREFIX_BYTES..end)
        .and_then(<[u8]>::split_first)
    else {
        return 0;
    };
    let byte = |at: usize| params.get(at).copied().map_or(0, usize::from);
    match code {
        0x02 | 0x82 => byte(1),
        0x92 => {
            let items = params.get(1..).unwrap_or_default().chunks_exact(3);
            items
                .filter_map(|item| item.first())
                .copied()
                .max()
                .map_or(0, usize::from)
        }
        _ => 0,
    }
}

/// The first packet of what was sent, and what is behind it.
fn split_packet(protocol: ServoProtocol, bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let whole = match protocol {
        ServoProtocol::Dynamixel2 => {
            let &[_, _, _, _, _, low, high, ..] = bytes else {
                return None;
            };
            dynamixel2::BODY_AT + usize::from(u16::from_le_bytes([low, high]))
        }
        ServoProtocol::Dynamixel1 | ServoProtocol::Sts | ServoProtocol::Scs => {
            summed::PREFIX_BYTES + usize::from(*bytes.get(3)?)
        }
    };
    bytes.split_at_checked(whole)
}
