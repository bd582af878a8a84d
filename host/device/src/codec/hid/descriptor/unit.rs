//! Units: four bits for the system and each quantity's power, a power of ten beside them. Source: HID 1.11, 6.2.2.7.

/// A unit with its power of ten.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unit {
    /// As the descriptor has it.
    pub code: u32,
    /// Power of ten.
    pub exponent: i8,
}

/// What a unit measures, as far as controls need it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitKind {
    /// A length.
    Length,
    /// An angle.
    Angle,
    /// Nothing, or something else.
    Other,
}

impl Unit {
    /// From the two items. An exponent is four bits with a sign, but firmware writes whole numbers too (as Linux
    /// reads it).
    pub(super) fn new(code: u32, exponent: i32) -> Self {
        let exponent = if (0..16).contains(&exponent) {
            (exponent as i8) << 4 >> 4
        } else {
            exponent.clamp(-100, 100) as i8
        };
        Self { code, exponent }
    }

    /// What it measures.
    pub fn kind(self) -> UnitKind {
        // System 1 and 3 have lengths (centimetre, inch), 2 and 4 angles (radian, degree), in the first quantity.
        match self.code {
            0x11 | 0x13 => UnitKind::Length,
            0x12 | 0x14 => UnitKind::Angle,
            _ => UnitKind::Other,
        }
    }

    /// How many millimetres (lengths) or radians (angles) one physical unit is; of others the power of ten alone.
    pub fn factor(self) -> f64 {
        let base = match self.code {
            0x11 => 10.0,
            0x13 => 25.4,
            0x14 => std::f64::consts::PI / 180.0,
            _ => 1.0,
        };
        base * 10_f64.powi(self.exponent.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_are_nibbles_or_whole_numbers() {
        for (written, want) in [
            (0, 0),
            (7, 7),
            (8, -8),
            (0x0F, -1),
            (0x0D, -3),
            (-3, -3),
            (200, 100),
        ] {
            assert_eq!(Unit::new(0x11, written).exponent, want, "{written}");
        }
    }

    #[test]
    fn units_become_millimetres_and_radians() {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(near(Unit::new(0x11, 0x0E).factor(), 0.1));
        assert!(near(Unit::new(0x13, -3).factor(), 0.0254));
        assert!(near(Unit::new(0x14, 0).factor(), 1_f64.to_radians()));
        assert_eq!(Unit::new(0x1001, 0).kind(), UnitKind::Other);
    }
}
