//! Packets whose first byte, and no other, has bit 7: how tablets on serial lines mark a beginning.

/// The longest packet of any of them (Wacom V).
pub(super) const BYTES_MAX: usize = 9;

/// What one byte brought about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Pushed {
    /// The packet it completes; bytes beyond its length are 0.
    pub(super) packet: Option<[u8; BYTES_MAX]>,
    /// It belongs to none.
    pub(super) unknown: bool,
    /// It cut one short.
    pub(super) rejected: bool,
}

/// Puts packets of one length together.
#[derive(Clone, Debug)]
pub(super) struct Phased {
    bytes: [u8; BYTES_MAX],
    have: usize,
    want: usize,
}

impl Phased {
    /// For packets of `want` bytes, at most [`BYTES_MAX`].
    pub(super) fn new(want: usize) -> Self {
        Self {
            bytes: [0; BYTES_MAX],
            have: 0,
            want: want.clamp(1, BYTES_MAX),
        }
    }

    pub(super) fn reset(&mut self) {
        self.have = 0;
    }

    /// Whether a packet has begun and not ended.
    pub(super) fn unfinished(&self) -> bool {
        self.have > 0
    }

    pub(super) fn push(&mut self, byte: u8) -> Pushed {
        let mut pushed = Pushed::default();
        if byte & 0x80 != 0 {
            pushed.rejected = self.have != 0;
            self.bytes = [0; BYTES_MAX];
            self.have = 0;
        } else if self.have == 0 {
            pushed.unknown = true;
            return pushed;
        }
        if let Some(place) = self.bytes.get_mut(self.have) {
            *place = byte;
            self.have += 1;
        }
        if self.have >= self.want {
            self.have = 0;
            pushed.packet = Some(self.bytes);
        }
        pushed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beginning_is_a_beginning_wherever_it_comes() {
        let mut phased = Phased::new(3);
        let mut seen = Vec::new();
        for byte in [0x11, 0x80, 1, 0x81, 2, 3, 4, 0xFF, 0x7F, 0x7F] {
            let pushed = phased.push(byte);
            seen.push((
                pushed.unknown,
                pushed.rejected,
                pushed.packet.map(|p| [p[0], p[1], p[2]]),
            ));
        }
        let nothing = (false, false, None);
        let want = [
            (true, false, None),
            nothing,
            nothing,
            (false, true, None),
            nothing,
            (false, false, Some([0x81, 2, 3])),
            (true, false, None),
            nothing,
            nothing,
            (false, false, Some([0xFF, 0x7F, 0x7F])),
        ];
        assert_eq!(seen, want);
        assert!(!phased.unfinished());
    }
}
