//! What a receiver at one speed and parity makes of a byte sent at another: sampling at the middle of its own bits.
//!
//! Source: how a UART works (start bit, eight data bits low first, a parity bit if there is one, stop bit). Speeds
//! within about five per cent of each other read true, which is where the vendors' "under 3 % is harmless" comes
//! from.

/// The bit that follows the data on some lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Parity {
    /// No such bit: ten bits a byte.
    #[default]
    None,
    /// Makes the number of ones odd: eleven bits a byte.
    Odd,
    /// Makes the number of ones even: eleven bits a byte.
    Even,
}

impl Parity {
    /// The bit behind `byte`; none where there is no such bit.
    fn of(self, byte: u8) -> Option<bool> {
        match self {
            Self::None => None,
            Self::Odd => Some(byte.count_ones().is_multiple_of(2)),
            Self::Even => Some(!byte.count_ones().is_multiple_of(2)),
        }
    }
}

/// Speed and parity of one end; eight data bits and one stop bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Format {
    pub(crate) baud: u32,
    pub(crate) parity: Parity,
}

impl Format {
    /// Bits in a frame: start, eight data, parity if there is one, stop.
    pub(crate) fn frame_bits(self) -> u64 {
        if self.parity == Parity::None { 10 } else { 11 }
    }
}

/// One frame as the receiver understood it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Heard {
    pub(crate) byte: u8,
    /// Its stop bit was there.
    pub(crate) framed: bool,
    /// Its parity bit was right, or none was expected.
    pub(crate) parity_right: bool,
}

/// Hears `byte`, sent as `sent` on an otherwise quiet line, with a receiver set to `read`.
/// A faster receiver may hear several frames in one, a slower one sees the quiet line behind it.
pub(crate) fn hear(byte: u8, sent: Format, read: Format, mut heard: impl FnMut(Heard)) {
    if sent == read {
        heard(Heard {
            byte,
            framed: true,
            parity_right: true,
        });
        return;
    }
    let read_bits_to_sent = f64::from(sent.baud.max(1)) / f64::from(read.baud.max(1));
    // The line as the sender drives it: low start bit, data, parity, then high for ever.
    let level = |sent_bit: f64| -> bool {
        match sent_bit.floor() as u32 {
            0 => false,
            bit @ 1..=8 => byte >> (bit - 1) & 1 == 1,
            9 => sent.parity.of(byte).unwrap_or(true),
            _ => true,
        }
    };
    let stop_bit = read.frame_bits() as f64 - 1.0;
    let mut start = 0.0;
    // A frame lasts at least one sent bit here, so as many rounds as there are bits cover the whole byte.
    for _ in 0..sent.frame_bits() {
        let sample = |bit: f64| level(start + (bit + 0.5) * read_bits_to_sent);
        let value = (0..8u8).fold(0, |value, bit| {
            value | u8::from(sample(f64::from(bit) + 1.0)) << bit
        });
        heard(Heard {
            byte: value,
            framed: sample(stop_bit),
            parity_right: read.parity.of(value).is_none_or(|bit| sample(9.0) == bit),
        });
        let searched_from = start + (stop_bit + 0.5) * read_bits_to_sent;
        let Some(next) = next_falling_edge(searched_from, level) else {
            return;
        };
        start = next;
    }
}

/// The next change from high to low at a bit boundary after `from`, in the sender's bits. Behind bit 9 the line is
/// high.
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

    fn at(baud: u32) -> Format {
        Format {
            baud,
            parity: Parity::None,
        }
    }

    fn odd(baud: u32) -> Format {
        Format {
            baud,
            parity: Parity::Odd,
        }
    }

    fn all(byte: u8, sent: Format, read: Format) -> Vec<Heard> {
        let mut out = Vec::new();
        hear(byte, sent, read, |heard| out.push(heard));
        out
    }

    #[test]
    fn reads_true_within_three_per_cent_and_not_at_another_speed() {
        for byte in 0..=255u8 {
            for format in [at as fn(u32) -> Format, odd] {
                for read in [9600, 9320, 9880] {
                    let true_frame = Heard {
                        byte,
                        framed: true,
                        parity_right: true,
                    };
                    assert_eq!(
                        all(byte, format(9600), format(read)),
                        [true_frame],
                        "{byte:02x} at {read}"
                    );
                }
            }
        }
        // A carriage return from a port at 38400 must not look like one at 9600.
        assert!(
            all(b'\r', at(38400), at(9600))
                .iter()
                .all(|heard| heard.byte != b'\r')
        );
        // And a slow byte read fast falls apart.
        assert!(all(0x20, at(9600), at(38400)).len() > 1);
    }

    #[test]
    fn a_missing_or_unexpected_parity_bit_spoils_every_byte_whose_bit_is_not_that_of_a_quiet_line() {
        for byte in 0..=255u8 {
            let quiet = byte.count_ones() % 2 == 0;
            // Without the bit the receiver takes the stop bit for it, which is high.
            let without = all(byte, at(9600), odd(9600));
            assert_eq!(without.len(), 1);
            assert_eq!((without[0].byte, without[0].framed), (byte, true));
            assert_eq!(without[0].parity_right, quiet, "{byte:02x}");
            // With an unexpected bit the receiver takes it for the stop bit.
            let with = all(byte, odd(9600), at(9600));
            assert_eq!(with.len(), 1);
            assert_eq!((with[0].byte, with[0].framed), (byte, quiet), "{byte:02x}");
        }
    }
}
