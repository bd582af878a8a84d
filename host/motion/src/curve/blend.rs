//! What a curve can be made of: numbers and small vectors that blend linearly.

use glam::{DVec2, DVec3};
use std::ops::{Add, Mul, Sub};

/// A point that can be blended linearly. `Default` is the origin.
pub trait Blend:
    Copy + Default + PartialEq + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
    /// Whether every coordinate is finite.
    fn is_finite(self) -> bool;

    /// The largest absolute coordinate.
    fn largest(self) -> f64;

    /// The plain Euclidean length; may overflow where [`Blend::length`] does not.
    fn plain_length(self) -> f64;

    /// The Euclidean length, without overflow or underflow on the way.
    fn length(self) -> f64 {
        let largest = self.largest();
        // Halfway to the exponents where squares leave the range of f64.
        if (1e-140..1e140).contains(&largest) {
            self.plain_length()
        } else if largest == 0.0 || !largest.is_finite() {
            largest
        } else {
            let scale = power_of_two_near(largest);
            (self * (1.0 / scale)).plain_length() * scale
        }
    }
}

/// The power of two at or below `x`'s magnitude, kept where its reciprocal is finite:
/// multiplying by it or by its reciprocal loses no digits.
pub(super) fn power_of_two_near(x: f64) -> f64 {
    // Exponent field of IEEE 754 binary64; 1..=2045 have normal reciprocals.
    let exponent = ((x.abs().to_bits() >> 52) & 0x7ff).clamp(1, 2045);
    f64::from_bits(exponent << 52)
}

impl Blend for f64 {
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
    fn largest(self) -> f64 {
        self.abs()
    }
    fn plain_length(self) -> f64 {
        self.abs()
    }
}

impl Blend for DVec2 {
    fn is_finite(self) -> bool {
        DVec2::is_finite(self)
    }
    fn largest(self) -> f64 {
        self.abs().max_element()
    }
    fn plain_length(self) -> f64 {
        DVec2::length(self)
    }
}

impl Blend for DVec3 {
    fn is_finite(self) -> bool {
        DVec3::is_finite(self)
    }
    fn largest(self) -> f64 {
        self.abs().max_element()
    }
    fn plain_length(self) -> f64 {
        DVec3::length(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn length_survives_the_ends_of_the_range() {
        for scale in [1e-308, 1e-200, 1e-150, 1.0, 1e150, 1e200, 1e307] {
            let length = Blend::length(DVec3::new(3.0, 4.0, 0.0) * scale);
            assert!((length / scale - 5.0).abs() < 1e-12, "scale {scale}: {length}");
        }
        assert_eq!(Blend::length(DVec3::ZERO), 0.0);
    }
}
