//! Getting a number out of a report's bits, without allocating: the pieces are worked out beforehand.

/// Pieces that a number may have: the Intuos's serial number has five.
const PIECES_MAX: usize = 6;

/// Where the bits of a number stand, lowest piece first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bits {
    pieces: [Piece; PIECES_MAX],
    used: u8,
    width: u8,
}

/// A run of bits, lowest first, or of whole bytes, highest first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Piece {
    /// First bit of the report; with `big` a multiple of 8.
    pub(super) first: u32,
    pub(super) width: u8,
    pub(super) big: bool,
}

impl Bits {
    /// One run. At most 64 bits.
    pub(super) fn one(first: u32, width: u8) -> Self {
        let piece = Piece {
            first,
            width: width.min(64),
            big: false,
        };
        let mut pieces = [Piece::default(); PIECES_MAX];
        pieces[0] = piece;
        Self {
            pieces,
            used: 1,
            width: piece.width,
        }
    }

    /// Several runs; `None` where there are too many, or more than 64 bits.
    pub(super) fn several(given: &[Piece]) -> Option<Self> {
        let mut pieces = [Piece::default(); PIECES_MAX];
        pieces.get_mut(..given.len())?.copy_from_slice(given);
        let width = given.iter().map(|piece| u32::from(piece.width)).sum::<u32>();
        Some(Self {
            pieces,
            used: given.len() as u8,
            width: u8::try_from(width)
                .ok()
                .filter(|&width| (1..=64).contains(&width))?,
        })
    }

    /// The same bits `bits` further on.
    #[must_use]
    pub(super) fn moved(mut self, bits: u32) -> Self {
        for piece in &mut self.pieces {
            piece.first += bits;
        }
        self
    }

    /// These bits with others above them; `None` where that is too much.
    pub(super) fn with(&self, upper: Self) -> Option<Self> {
        let pieces = self.pieces.iter().take(self.used.into());
        let all: Vec<Piece> = pieces
            .chain(upper.pieces.iter().take(upper.used.into()))
            .copied()
            .collect();
        Self::several(&all)
    }

    pub(super) fn width(&self) -> u8 {
        self.width
    }

    /// The number without sign; `None` where the report is too short.
    pub(super) fn read(&self, report: &[u8]) -> Option<u64> {
        let mut value = 0;
        let mut at = 0;
        for piece in self.pieces.iter().take(self.used.into()) {
            value |= piece.read(report)? << at;
            at += u32::from(piece.width);
        }
        Some(value)
    }
}

impl Piece {
    fn read(self, report: &[u8]) -> Option<u64> {
        let (start, shift) = ((self.first / 8) as usize, self.first % 8);
        let span = (shift + u32::from(self.width)).div_ceil(8) as usize;
        let bytes = report.get(start..start + span)?;
        if self.big {
            return Some(bytes.iter().fold(0, |sum, &byte| sum << 8 | u64::from(byte)));
        }
        // Nine bytes are touched where 64 bits begin inside a byte.
        let wide = bytes
            .iter()
            .rev()
            .fold(0_u128, |sum, &byte| sum << 8 | u128::from(byte));
        Some((wide >> shift) as u64 & mask(self.width))
    }
}

/// The lowest `width` bits.
pub(super) fn mask(width: u8) -> u64 {
    u64::MAX.checked_shr(64 - u32::from(width.min(64))).unwrap_or(0)
}

/// Two's complement of `width` bits.
pub(super) fn signed(value: u64, width: u8) -> i64 {
    let unused = 64 - u32::from(width.clamp(1, 64));
    (value << unused) as i64 >> unused
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Bit by bit, as HID 1.11 section 8.4 tells it.
    fn slowly(report: &[u8], first: u32, width: u8) -> u64 {
        (0..u32::from(width)).fold(0, |sum, n| {
            let bit = first + n;
            sum | u64::from(report[(bit / 8) as usize] >> (bit % 8) & 1) << n
        })
    }

    proptest! {
        #[test]
        fn any_run_is_read(report in prop::collection::vec(any::<u8>(), 20), first in 0_u32..90, width in 1_u8..=64) {
            let got = Bits::one(first, width).read(&report);
            prop_assert_eq!(got, Some(slowly(&report, first, width)));
            prop_assert_eq!(Bits::one(0, width).moved(first).read(&report), got);
        }
    }

    #[test]
    fn pieces_and_byte_orders() {
        let piece = |first, width, big| Piece { first, width, big };
        // The axes of the Intuos: sixteen bits highest first, and one more below them.
        let x = Bits::several(&[piece(73, 1, false), piece(16, 16, true)]).expect("17 bits");
        assert_eq!(x.read(&[2, 0xE2, 0x0F, 0x1D, 0, 0, 0, 0, 0, 0x65]), Some(7738));
        assert_eq!(x.read(&[2, 0xE2, 0x0F]), None);
        assert_eq!(Bits::several(&[piece(0, 64, false), piece(64, 1, false)]), None);
        assert_eq!((signed(0xFF, 8), signed(0x7F, 8), signed(1, 1)), (-1, 127, -1));
        assert_eq!(mask(0), 0);
    }
}
