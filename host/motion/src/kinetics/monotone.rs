//! Limiting the slopes of a natural cubic so that it never overshoots.
//!
//! A slope whose neighbouring chords disagree in sign becomes zero, any other is held between zero and
//! three times the flatter chord, which is enough for each cubic to be monotone.
//! Source: F. N. Fritsch and R. E. Carlson, Monotone piecewise cubic interpolation, SIAM J. Numer. Anal.
//! 17 (1980); J. M. Hyman, SIAM J. Sci. Stat. Comput. 4 (1983). Applied to natural slopes it leaves a tame
//! spline as it is, which methods that make slopes from scratch do not.

use crate::curve::{Natural, Piecewise};

/// The factor of Fritsch and Carlson's sufficient condition.
const STEEPEST: f64 = 3.0;

/// One slope, limited by the chord slopes on both sides.
pub(crate) fn limit(slope: f64, before: f64, after: f64) -> f64 {
    if before * after <= 0.0 {
        return 0.0;
    }
    let steepest = STEEPEST * before.abs().min(after.abs());
    (slope * before.signum()).clamp(0.0, steepest) * before.signum()
}

/// The natural cubic with limited slopes, through the same values.
pub(super) fn limited(natural: &Natural<f64>, values: &[f64]) -> Piecewise<f64> {
    let a = natural.abscissae();
    let chord = |j: usize| (values[j + 1] - values[j]) / (a[j + 1] - a[j]);
    let n = a.len() - 1;
    let slopes: Vec<f64> = natural
        .slopes()
        .iter()
        .enumerate()
        .map(|(j, &slope)| match (j, n) {
            (_, 0) => 0.0,
            (0, _) => limit(slope, chord(0), chord(0)),
            (j, n) if j == n => limit(slope, chord(n - 1), chord(n - 1)),
            (j, _) => limit(slope, chord(j - 1), chord(j)),
        })
        .collect();
    Piecewise::hermite(a, values, &slopes)
}
