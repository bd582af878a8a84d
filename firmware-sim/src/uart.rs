//! What a receiver at one speed makes of a byte sent at another: sampling at the middle of its own bits.
//!
//! Source: how a UART works (start bit, eight data bits low first, stop bit; 8N1). Speeds within about
//! five per cent of each other read true, which is where the vendors' "under 3 % is harmless" comes from.

/// Bits in a frame: start, eight data, stop.
pub(crate) const FRAME_BITS: u64 = 10;

/// One frame as the receiver understood it; `framed` is false when its stop bit was not there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Heard {
    pub(crate) byte: u8,
    pub(crate) framed: bool,
}

/// Hears `byte`, sent at `sent_baud` on an otherwise quiet line, with a receiver at `read_baud`.
/// A faster receiver may hear several frames in one, a slower one sees the quiet line behind it.
pub(crate) fn hear(byte: u8, sent_baud: u32, read_baud: u32, mut heard: impl FnMut(Heard)) {
    if sent_baud == read_baud {
        heard(Heard { byte, framed: true });
        return;
    }
    let (sent, read) = (f64::from(sent_baud.max(1)), f64::from(read_baud.max(1)));
    let read_bits_to_sent = sent / read;
    // The line as the sender drives it: low start bit, data, then high for ever.
    let level = |sent_bit: f64| -> bool {
        let bit = sent_bit.floor();
        if bit < 1.0 {
            return false;
        }
        bit >= 9.0 || byte >> (bit as u32 - 1) & 1 == 1
    };
    let mut start = 0.0;
    // A frame lasts at least one sent bit here, so ten rounds cover the whole byte.
    for _ in 0..FRAME_BITS {
        let sample = |bit: f64| level(start + (bit + 0.5) * read_bits_to_sent);
        let value = (0..8u8).fold(0, |value, bit| {
            value | u8::from(sample(f64::from(bit) + 1.0)) << bit
        });
        let stop = sample(9.0);
        heard(Heard {
            byte: value,
            framed: stop,
        });
        let searched_from = start + 9.5 * read_bits_to_sent;
        let Some(next) = next_falling_edge(searched_from, level) else {
            return;
        };
        start = next;
    }
}

/// The next change from high to low at a bit boundary after `from`, in the sender's bits.
fn next_falling_edge(from: f64, level: impl Fn(f64) -> bool) -> Option<f64> {
    let first = from.floor().max(0.0) as u32;
    (first..9)
        .map(f64::from)
        .find(|&bit| level(bit.max(from)) && !level(bit + 1.0))
        .map(|bit| bit + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(byte: u8, sent: u32, read: u32) -> Vec<Heard> {
        let mut out = Vec::new();
        hear(byte, sent, read, |heard| out.push(heard));
        out
    }

    #[test]
    fn reads_true_within_three_per_cent_and_not_at_another_speed() {
        for byte in 0..=255u8 {
            for read in [9600, 9320, 9880] {
                assert_eq!(
                    all(byte, 9600, read),
                    [Heard { byte, framed: true }],
                    "{byte:02x} at {read}"
                );
            }
        }
        // A carriage return from a port at 38400 must not look like one at 9600.
        assert!(all(b'\r', 38400, 9600).iter().all(|heard| heard.byte != b'\r'));
        // And a slow byte read fast falls apart.
        assert!(all(0x20, 9600, 38400).len() > 1);
    }
}
