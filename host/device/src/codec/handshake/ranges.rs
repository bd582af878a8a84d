//! Ranges that a tablet tells in a string descriptor. Offsets count from the descriptor's start.
//! Source: DIGImend digimend-kernel-drivers `hid-uclogic-params.c` at f3c7c7f1; real answers in DIGImend/tablets.

use crate::codec::{Surface, usb_text};
use device_profiles::RangeFrom;

/// The area a tablet tells; an error in words.
pub(super) fn surface(from: RangeFrom, raw: &[u8]) -> Result<Surface, String> {
    let bytes = usb_text::descriptor(raw).map_err(|error| error.to_string())?;
    let least = match from {
        RangeFrom::UclogicV1 | RangeFrom::UgeeV2 => 12,
        RangeFrom::UclogicV2 => 18,
    };
    if bytes.len() < least {
        return Err(format!(
            "expected ranges in {least} bytes at least, found {}",
            bytes.len()
        ));
    }
    let number = |at: usize, length: usize| {
        let piece = bytes.get(at..at + length).unwrap_or_default();
        piece
            .iter()
            .rev()
            .fold(0, |sum, &byte| sum << 8 | u32::from(byte))
    };
    let max_counts = match from {
        RangeFrom::UclogicV1 | RangeFrom::UgeeV2 => [number(2, 2), number(4, 2)],
        RangeFrom::UclogicV2 => [number(2, 3), number(5, 3)],
    };
    let (pressure_max, per_inch) = (number(8, 2), number(10, 2));
    if max_counts.contains(&0) || pressure_max == 0 || per_inch == 0 {
        return Err(format!(
            "expected ranges above 0, found {} x {}, pressure {pressure_max}, {per_inch} counts per inch",
            max_counts[0], max_counts[1]
        ));
    }
    Ok(Surface::flat(max_counts, [f64::from(per_inch); 2], pressure_max))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_answers_of_real_tablets_are_read() {
        // Source: DIGImend/tablets at 358a1481, `probe.txt` of each.
        type Row<'a> = (&'a str, RangeFrom, &'a [u8], [u32; 2], f64);
        let rows: [Row<'_>; 4] = [
            (
                "HS610",
                RangeFrom::UclogicV2,
                &[
                    0x13, 3, 0x70, 0xC6, 0, 0x06, 0x7C, 0, 0xFF, 0x1F, 0xD8, 0x13, 3, 0x0D, 0x10, 1, 4, 0x3C,
                    0x3E,
                ],
                [50_800, 31_750],
                5080.0,
            ),
            (
                "H640P",
                RangeFrom::UclogicV2,
                &[
                    0x13, 3, 0, 0x7D, 0, 0x20, 0x4E, 0, 0xFF, 0x1F, 0xD8, 0x13, 3, 6, 0, 0, 4, 0, 0x40,
                ],
                [32_000, 20_000],
                5080.0,
            ),
            (
                "Deco 01 V2",
                RangeFrom::UgeeV2,
                &[0x0C, 3, 0x38, 0x63, 3, 0x3E, 8, 0, 0xFF, 0x1F, 0xEC, 9],
                [25_400, 15_875],
                2540.0,
            ),
            (
                "G640S",
                RangeFrom::UclogicV1,
                &[0x0C, 3, 0xE7, 0x80, 0x77, 0x50, 6, 0, 0xFF, 0x1F, 0xD8, 0x13],
                [32_999, 20_599],
                5080.0,
            ),
        ];
        for (name, from, raw, max_counts, per_inch) in rows {
            let told = surface(from, raw).expect(name);
            assert_eq!(told.max_counts, max_counts, "{name}");
            assert_eq!(told.counts_per_inch, [per_inch; 2], "{name}");
            assert_eq!(told.pressure_max, 8191, "{name}");
            for end in 0..raw.len() {
                assert!(surface(from, &raw[..end]).is_err(), "{name} cut at {end}");
            }
        }
    }

    #[test]
    fn memory_zeros_and_short_answers_are_refused() {
        let memory: Vec<u8> = [0xC8, 0x0E].into_iter().chain([7; 198]).collect();
        assert!(
            surface(RangeFrom::UclogicV2, &memory)
                .unwrap_err()
                .contains("type 14")
        );
        let zeros: Vec<u8> = [18, 3].into_iter().chain([0; 16]).collect();
        assert!(
            surface(RangeFrom::UclogicV2, &zeros)
                .unwrap_err()
                .contains("above 0")
        );
    }
}
