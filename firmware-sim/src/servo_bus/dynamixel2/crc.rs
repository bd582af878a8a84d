//! The checksum of protocol 2.0, one bit at a time from its polynomial.
//!
//! Source: the maker's protocol 2.0 page; polynomial x^16 + x^15 + x^2 + 1, start 0, no reflection, no
//! final inversion.

/// Without the leading x^16.
const POLYNOMIAL: u16 = 0x8005;

/// Continues checksum `crc` over `bytes`; begin with 0.
pub(in crate::servo_bus) fn extend(crc: u16, bytes: &[u8]) -> u16 {
    bytes.iter().fold(crc, |crc, &byte| {
        (0..8).fold(crc ^ u16::from(byte) << 8, |crc, _| {
            if crc & 0x8000 == 0 {
                crc << 1
            } else {
                crc << 1 ^ POLYNOMIAL
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::extend;

    #[test]
    fn agrees_with_the_published_values() {
        // Check value of CRC-16/UMTS, then spot values of the maker's printed table.
        assert_eq!(extend(0, b"123456789"), 0xFEE8);
        for (byte, crc) in [
            (0, 0),
            (1, 0x8005),
            (2, 0x800F),
            (3, 0x000A),
            (4, 0x801B),
            (127, 0x8101),
            (128, 0x8303),
            (255, 0x0202),
        ] {
            assert_eq!(extend(0, &[byte]), crc, "{byte}");
        }
        assert_eq!(
            extend(0, &[0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x03, 0x00, 0x01]),
            0x4E19
        );
    }
}
