//! Values as bytes: which byte comes first, and how a value below zero is told.
//!
//! Source: the makers' control tables, through the profile; four bytes of a servo with the high byte first
//! have the low word first (LeRobot's tests: 0x12345678 is sent as 56 78 12 34).

use device_profiles::{Register, WordOrder};

/// The value in `bytes`, which are those of one value of `row`.
pub(super) fn load(order: WordOrder, row: &Register, bytes: &[u8]) -> i64 {
    let raw = bytes.iter().enumerate().fold(0i64, |raw, (at, &byte)| {
        raw | i64::from(byte) << (8 * place(order, at, bytes.len()))
    });
    if let Some(bit) = row.sign_bit {
        let magnitude = raw & ((1 << bit) - 1);
        return if raw >> bit & 1 == 1 {
            -magnitude
        } else {
            magnitude
        };
    }
    let bits = 8 * bytes.len() as u32;
    if row.signed && bits > 0 && raw >> (bits - 1) & 1 == 1 {
        raw - (1 << bits)
    } else {
        raw
    }
}

/// Writes `value` into `bytes`, cut to what they can hold.
pub(super) fn store(order: WordOrder, row: &Register, value: i64, bytes: &mut [u8]) {
    let raw = match row.sign_bit {
        Some(bit) => {
            let magnitude = value.abs().min((1 << bit) - 1);
            magnitude | i64::from(value < 0) << bit
        }
        None => value,
    };
    let count = bytes.len();
    for (at, byte) in bytes.iter_mut().enumerate() {
        *byte = (raw >> (8 * place(order, at, count))) as u8;
    }
}

/// Which byte of a value, counted from its low end, stands at `at` among `count`.
fn place(order: WordOrder, at: usize, count: usize) -> usize {
    match order {
        WordOrder::Big if count > 1 => at ^ 1,
        _ => at,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use device_profiles::Profiles;
    use proptest::prelude::*;

    fn row(size: u8, signed: bool, sign_bit: Option<u8>) -> Register {
        let profiles = Profiles::builtin();
        let any = &profiles.servo("xl430-w250").expect("shipped").registers[0];
        Register {
            size,
            signed,
            sign_bit,
            ..any.clone()
        }
    }

    #[test]
    fn values_have_the_documented_bytes() {
        use WordOrder::{Big, Little};
        let table: [(WordOrder, Register, i64, &[u8]); 9] = [
            (Little, row(2, false, None), 1060, &[0x24, 0x04]),
            (Little, row(4, true, None), -3, &[0xFD, 0xFF, 0xFF, 0xFF]),
            (Little, row(2, true, None), -1, &[0xFF, 0xFF]),
            // STS: bit 15 of a position, bit 11 of an offset, bit 10 of a load.
            (Little, row(2, false, Some(15)), -1, &[0x01, 0x80]),
            (Little, row(2, false, Some(11)), -2047, &[0xFF, 0x0F]),
            (Little, row(2, false, Some(10)), 1000, &[0xE8, 0x03]),
            // SCS: the high byte first.
            (Big, row(2, false, None), 1284, &[0x05, 0x04]),
            (Big, row(4, false, None), 0x1234_5678, &[0x56, 0x78, 0x12, 0x34]),
            (Big, row(1, false, None), 7, &[7]),
        ];
        for (order, row, value, bytes) in table {
            let mut stored = vec![0; bytes.len()];
            store(order, &row, value, &mut stored);
            assert_eq!(stored, bytes, "{value}");
            assert_eq!(load(order, &row, bytes), value);
        }
    }

    proptest! {
        #[test]
        fn what_was_stored_is_loaded(value in -30_000i64..30_000, big: bool, sign: bool) {
            let order = if big { WordOrder::Big } else { WordOrder::Little };
            for size in [2u8, 4] {
                let row = row(size, !sign, sign.then_some(15));
                let mut bytes = vec![0; usize::from(size)];
                store(order, &row, value, &mut bytes);
                prop_assert_eq!(load(order, &row, &bytes), value);
            }
        }
    }
}
