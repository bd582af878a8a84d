//! How endless dials write their steps into control changes: seven ways with one controller, and the two of the
//! standard with controllers of their own.
//!
//! Source: `docs/protocols/midi.md` (tttapa/Control-Surface `RelativeCCSender`; the manuals of Ardour, Arturia, Faderfox
//! and Behringer).

use device_profiles::Encoding;

/// Steps that `value` (0 to 127) means, up positive; `None` for a value the encoding does not know. The two encodings
/// that need more than one message mean nothing here.
pub(super) fn steps(encoding: Encoding, value: u8) -> Option<i32> {
    let value = i32::from(value & 0x7F);
    match encoding {
        Encoding::TwosComplement => match value {
            0..=63 => Some(value),
            // Neither table nor maker gives 64 a meaning.
            64 => None,
            _ => Some(value - 128),
        },
        Encoding::BinaryOffset => Some(value - 64),
        Encoding::SignMagnitude => Some(signed(value)),
        Encoding::ReversedSignMagnitude => Some(-signed(value)),
        // 13 to 19 are what manuals show; faster turns are farther away.
        Encoding::Centre16 => (value <= 32).then_some(value - 16),
        Encoding::IncDec => match value {
            65 => Some(1),
            1 => Some(-1),
            _ => None,
        },
        Encoding::DataIncDec | Encoding::Absolute14 => None,
    }
}

/// Bit 6 is the sign of the six below.
fn signed(value: i32) -> i32 {
    if value & 0x40 == 0 { value } else { -(value & 0x3F) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_values() {
        use Encoding::{
            BinaryOffset, Centre16, IncDec, ReversedSignMagnitude, SignMagnitude, TwosComplement,
        };
        let table = [
            (TwosComplement, 1, Some(1)),
            (TwosComplement, 63, Some(63)),
            (TwosComplement, 127, Some(-1)),
            (TwosComplement, 65, Some(-63)),
            (TwosComplement, 64, None),
            (TwosComplement, 0, Some(0)),
            (BinaryOffset, 65, Some(1)),
            (BinaryOffset, 67, Some(3)),
            (BinaryOffset, 127, Some(63)),
            (BinaryOffset, 63, Some(-1)),
            (BinaryOffset, 61, Some(-3)),
            (BinaryOffset, 0, Some(-64)),
            (BinaryOffset, 64, Some(0)),
            (SignMagnitude, 1, Some(1)),
            (SignMagnitude, 63, Some(63)),
            (SignMagnitude, 65, Some(-1)),
            (SignMagnitude, 127, Some(-63)),
            (SignMagnitude, 64, Some(0)),
            (ReversedSignMagnitude, 65, Some(1)),
            (ReversedSignMagnitude, 127, Some(63)),
            (ReversedSignMagnitude, 1, Some(-1)),
            (ReversedSignMagnitude, 63, Some(-63)),
            (Centre16, 17, Some(1)),
            (Centre16, 19, Some(3)),
            (Centre16, 15, Some(-1)),
            (Centre16, 13, Some(-3)),
            (Centre16, 16, Some(0)),
            (Centre16, 33, None),
            (IncDec, 65, Some(1)),
            (IncDec, 1, Some(-1)),
            (IncDec, 64, None),
        ];
        for (encoding, value, wanted) in table {
            assert_eq!(steps(encoding, value), wanted, "{encoding:?} {value}");
        }
    }

    #[test]
    fn no_value_means_more_than_64_steps_and_up_and_down_mirror_each_other() {
        for encoding in [
            Encoding::TwosComplement,
            Encoding::SignMagnitude,
            Encoding::ReversedSignMagnitude,
        ] {
            let all: Vec<i32> = (0..128).filter_map(|value| steps(encoding, value)).collect();
            for step in 1..=63 {
                assert_eq!(
                    all.iter().filter(|&&s| s == step).count(),
                    1,
                    "{encoding:?} {step}"
                );
                assert_eq!(
                    all.iter().filter(|&&s| s == -step).count(),
                    1,
                    "{encoding:?} {step}"
                );
            }
            assert!(all.iter().all(|step| step.abs() <= 63));
        }
    }
}
