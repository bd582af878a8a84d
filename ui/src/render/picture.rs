//! A finished picture in memory, and its hash.

/// Opaque pixels, row by row from the upper left, four bytes each: red, green, blue, 255.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height * 4` bytes.
    pub rgba: Vec<u8>,
}

impl Picture {
    /// A fingerprint that is equal exactly where size and bytes are (FNV-1a, 64 bits).
    /// Source: Fowler, Noll, Vo; offset basis and prime as published.
    pub fn hash(&self) -> u64 {
        let size = self
            .width
            .to_le_bytes()
            .into_iter()
            .chain(self.height.to_le_bytes());
        size.chain(self.rgba.iter().copied())
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
            })
    }

    /// Red, green, blue at a place; `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        if x >= self.width {
            return None;
        }
        let at = (y as usize * self.width as usize + x as usize) * 4;
        let bytes = self.rgba.get(at..at + 3)?;
        Some([bytes[0], bytes[1], bytes[2]])
    }

    /// Puts `part` over this picture with its upper left corner at `x`, `y`; what sticks out is cut off.
    pub fn paste(&mut self, part: &Picture, x: u32, y: u32) {
        let columns = part.width.min(self.width.saturating_sub(x)) as usize * 4;
        let rows = part.height.min(self.height.saturating_sub(y)) as usize;
        for row in 0..rows {
            let from = row * part.width as usize * 4;
            let to = ((y as usize + row) * self.width as usize + x as usize) * 4;
            self.rgba[to..to + columns].copy_from_slice(&part.rgba[from..from + columns]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: u32, height: u32, value: u8) -> Picture {
        Picture {
            width,
            height,
            rgba: vec![value; (width * height * 4) as usize],
        }
    }

    #[test]
    fn shape_counts_in_the_hash() {
        assert_ne!(grey(2, 3, 7).hash(), grey(3, 2, 7).hash());
        assert_eq!(grey(2, 3, 7).hash(), grey(2, 3, 7).hash());
    }

    #[test]
    fn pasting_cuts_at_the_edge() {
        let mut ground = grey(4, 4, 0);
        ground.paste(&grey(3, 3, 9), 2, 3);
        assert_eq!(ground.pixel(2, 3), Some([9, 9, 9]));
        assert_eq!(ground.pixel(1, 3), Some([0, 0, 0]));
        assert_eq!(ground.pixel(2, 2), Some([0, 0, 0]));
        assert_eq!(ground.pixel(4, 3), None);
        ground.paste(&grey(3, 3, 9), 40, 40);
    }
}
