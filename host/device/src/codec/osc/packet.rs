//! Writing one message as a packet, and when one that is read is due.
//!
//! Source: OSC 1.0, "Temporal Semantics and OSC Time Tags".

use crate::codec::Outgoing;
use rosc::{OscMessage, OscPacket, OscType};
use std::time::Duration;

/// How a bundle begins.
const BUNDLE: &[u8; 8] = b"#bundle\0";
/// Time tags count from the beginning of 1900, 70 years with 17 leap days before the time of day's beginning.
const SECONDS_TO_1970: u64 = (70 * 365 + 17) * 86_400;
/// "Immediately".
const NOW: u64 = 1;

/// When a packet is due, as the time of day since the beginning of 1970; none: at once, as of messages, and of bundles
/// that say so. Bundles inside are never due before the one around them, and come with it.
pub fn due(packet: &[u8]) -> Option<Duration> {
    let (begin, rest) = packet.split_first_chunk::<8>()?;
    let (tag, _) = rest.split_first_chunk::<8>()?;
    let tag = u64::from_be_bytes(*tag);
    if begin != BUNDLE || tag <= NOW {
        return None;
    }
    // 32 bits of seconds, 32 of their fractions.
    let seconds = (tag >> 32).checked_sub(SECONDS_TO_1970)?;
    let nanos = ((tag & 0xFFFF_FFFF) * 1_000_000_000) >> 32;
    Some(Duration::new(seconds, nanos as u32))
}

/// Appends a packet with this one message.
pub(super) fn send(address: &str, args: Vec<OscType>, out: &mut Outgoing) {
    let message = OscPacket::Message(OscMessage {
        addr: address.to_owned(),
        args,
    });
    // A packet is a report of its own: two of them must not be joined.
    match rosc::encoder::encode(&message) {
        Ok(bytes) => out.report(&bytes),
        Err(error) => tracing::debug!(address, ?error, "an OSC message cannot be written"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bundle(tag: u64) -> Vec<u8> {
        [&BUNDLE[..], &tag.to_be_bytes(), b"\0\0\0\x04/a\0\0"].concat()
    }

    #[test]
    fn time_tags_are_times_of_day() {
        // The first of January 2000, and a quarter of a second more: 3155673600 seconds of NTP (RFC 5905).
        assert_eq!(
            due(&bundle(3_155_673_600 << 32)),
            Some(Duration::from_hours(262_968))
        );
        let quarter = due(&bundle(3_155_673_600 << 32 | 1 << 30));
        assert_eq!(quarter, Some(Duration::from_millis(946_684_800_250)));
        for now in [
            &bundle(1),
            &bundle(0),
            &bundle(5 << 32),
            &b"/a\0\0,f\0\0\0\0\0\0".to_vec(),
            &vec![],
            &BUNDLE.to_vec(),
        ] {
            assert_eq!(due(now), None, "{now:?}");
        }
    }
}
