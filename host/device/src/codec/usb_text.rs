//! USB string descriptors as text. Source: USB 2.0, 9.6.7.

/// Descriptor type "string".
const STRING: u8 = 3;

/// A string descriptor that is none.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoText {
    /// The type is another: firmware that was asked for a string it does not have sent what was in its memory.
    #[error(
        "expected a string descriptor (type 3), found type {found}: the device has no such string and sent whatever was in its memory"
    )]
    Type {
        /// The second byte.
        found: u8,
    },
    /// It says another length than came.
    #[error("expected {said} bytes as its head says, found {came}")]
    Length {
        /// The first byte.
        said: u8,
        /// What came.
        came: usize,
    },
}

/// The descriptor without anything behind its end, head included.
pub fn descriptor(raw: &[u8]) -> Result<&[u8], NoText> {
    match raw {
        [_, kind, ..] if *kind != STRING => Err(NoText::Type { found: *kind }),
        [length, _, ..] if *length >= 2 && usize::from(*length) <= raw.len() => {
            Ok(raw.get(..usize::from(*length)).unwrap_or_default())
        }
        _ => Err(NoText::Length {
            said: raw.first().copied().unwrap_or(0),
            came: raw.len(),
        }),
    }
}

/// The text, UTF-16; what is no character becomes `\u{FFFD}`.
pub fn text(raw: &[u8]) -> Result<String, NoText> {
    let body = descriptor(raw)?.get(2..).unwrap_or_default();
    let units: Vec<u16> = body
        .chunks_exact(2)
        .map(|pair| u16::from_le_bytes([pair[0], pair[1]]))
        .collect();
    Ok(String::from_utf16_lossy(&units).trim_end_matches('\0').to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_read_and_uninitialised_memory_is_not() {
        // A real answer of an H640P at index 123, and the beginning of an HS610's at an index it does not have.
        let on = [0x0C, 3, 0x48, 0, 0x4B, 0, 0x20, 0, 0x4F, 0, 0x6E, 0];
        assert_eq!(text(&on).unwrap(), "HK On");
        let memory = [0xC8, 0x0E, 0x00, 0x20, 0x65, 0x01, 0x00, 0x08];
        assert_eq!(text(&memory), Err(NoText::Type { found: 0x0E }));
        assert_eq!(text(&[4, 3, 65]), Err(NoText::Length { said: 4, came: 3 }));
        assert_eq!(text(&[2, 3]).unwrap(), "");
        for nothing in [&[][..], &[3], &[0, 3], &[1, 3]] {
            assert!(text(nothing).is_err(), "{nothing:?}");
        }
        assert_eq!(
            text(&[4, 3, 65, 0, 9, 9]).unwrap(),
            "A",
            "what stands behind the end is not its"
        );
    }
}
