//! The kinetic interpolant: animation time in seconds to key coordinate.
//!
//! Key j lies at coordinate j, so u(T_j) = j. The thesis's is the natural cubic through (T_j, j), which
//! may overshoot and run backwards; the other modes and the ordered coefficients are our answers to that.
//! Changing kinetics never changes a path, changing a path never changes kinetics.
//! Source: the thesis, sections 2.3 and 2.4.

mod monotone;
mod roots;

pub(crate) use monotone::limit as limit_slope;
pub(crate) use roots::monotone_parts;

use crate::curve::{Curve, Interval, Natural, Piecewise, Smooth, SplineError, span_polynomial};
use thiserror::Error;

/// How time becomes key coordinate between the keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KineticsMode {
    /// The thesis's natural cubic: smooth to the second derivative, may run backwards where the spacing
    /// of keys changes abruptly. Its coefficients can be edited.
    #[default]
    Natural,
    /// The natural cubic with its slopes limited where it would overshoot: never runs backwards, and is
    /// the natural cubic itself wherever that is tame.
    Monotone,
    /// Straight from key to key.
    Linear,
}

/// Why kinetics could not be made or edited. Indices count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum KineticsError {
    /// The times are not a finite, strictly increasing sequence.
    #[error("key times: {0}")]
    Times(#[from] SplineError),
    /// The first and the last coefficient hold the ends of time.
    #[error("coefficient {index} holds an end of the animation and cannot move; edit 1 to {last_free}")]
    EndCoefficient {
        /// The coefficient asked for.
        index: usize,
        /// The last one that may move.
        last_free: usize,
    },
    /// There is no such coefficient.
    #[error("there is no kinetic coefficient {index}; there are {count}, counted from 0")]
    NoSuchCoefficient {
        /// The coefficient asked for.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// The edit is NaN or infinite.
    #[error("the change of kinetic coefficient {index} is not a finite number")]
    EditNotFinite {
        /// The coefficient asked for.
        index: usize,
    },
    /// Only natural kinetics have coefficients.
    #[error("only natural kinetics have coefficients to edit; these are {mode:?}; change the mode first")]
    NoCoefficients {
        /// The mode that has none.
        mode: KineticsMode,
    },
}

/// Time in seconds to key coordinate, 0 at the first key and n at the last of n+1.
#[derive(Clone, Debug, PartialEq)]
pub struct Kinetics {
    mode: KineticsMode,
    curve: Piecewise<f64>,
    /// Of the curve as a B-spline; empty in the modes that are none.
    coefficients: Vec<f64>,
}

impl Kinetics {
    /// Kinetics that meet key j at `times_secs[j]`: at least one, finite, strictly increasing.
    pub fn new(times_secs: &[f64], mode: KineticsMode) -> Result<Self, KineticsError> {
        let keys: Vec<f64> = (0..times_secs.len()).map(|j| j as f64).collect();
        let natural = Natural::new(times_secs, &keys)?;
        let (curve, coefficients) = match mode {
            KineticsMode::Natural => (natural.piecewise().clone(), natural.coefficients()),
            KineticsMode::Monotone => (monotone::limited(&natural, &keys), Vec::new()),
            KineticsMode::Linear => (Piecewise::polyline(times_secs, &keys), Vec::new()),
        };
        Ok(Self {
            mode,
            curve,
            coefficients,
        })
    }

    /// These kinetics with amounts added to coefficients, and then, with `keep_forward`, every
    /// coefficient raised to at least the one before it and held within 0 and n, so that time never runs
    /// backwards. Keys are then met at other times: see [`Kinetics::first_reach`].
    ///
    /// Coefficient i changes the curve on four intervals of key times at most; elsewhere it stays
    /// identical to the last bit. Only natural kinetics have coefficients.
    pub fn edited(&self, edits: &[(usize, f64)], ordering: Ordering) -> Result<Self, KineticsError> {
        if self.mode != KineticsMode::Natural {
            return Err(KineticsError::NoCoefficients { mode: self.mode });
        }
        let count = self.coefficients.len();
        let mut wanted = self.coefficients.clone();
        for &(index, change) in edits {
            if index >= count {
                return Err(KineticsError::NoSuchCoefficient { index, count });
            }
            if index == 0 || index + 1 == count {
                return Err(KineticsError::EndCoefficient {
                    index,
                    last_free: count.saturating_sub(2),
                });
            }
            if !change.is_finite() {
                return Err(KineticsError::EditNotFinite { index });
            }
            wanted[index] += change;
        }
        if ordering == Ordering::KeepForward && count > 2 {
            let last = wanted[count - 1];
            for i in 1..count - 1 {
                wanted[i] = wanted[i].clamp(0.0, last).max(wanted[i - 1]);
            }
        }
        Ok(self.with_coefficients(wanted))
    }

    /// Adds the spline of the differences, on the spans where there are any.
    fn with_coefficients(&self, wanted: Vec<f64>) -> Self {
        let mut curve = self.curve.clone();
        let change: Vec<f64> = wanted
            .iter()
            .zip(&self.coefficients)
            .map(|(new, old)| new - old)
            .collect();
        let knots = self.knots();
        for span in 3..change.len() {
            if change[span - 3..=span].iter().any(|&c| c != 0.0) {
                curve.add_to_segment(span - 3, span_polynomial(&knots, &change, span));
            }
        }
        Self {
            mode: self.mode,
            curve,
            coefficients: wanted,
        }
    }

    /// Cubics over seconds, each about the left of two key times.
    pub(crate) fn curve(&self) -> &Piecewise<f64> {
        &self.curve
    }

    /// How time becomes key coordinate.
    pub fn mode(&self) -> KineticsMode {
        self.mode
    }

    /// The key coordinate at a time. Held at 0 before the first key time and at n after the last;
    /// in between natural kinetics may leave 0 to n, and a path must clamp.
    pub fn u(&self, secs: f64) -> f64 {
        self.curve.eval(secs)
    }

    /// The derivative of that order of [`Kinetics::u`], per second; zero outside the domain, at its ends
    /// from inside.
    pub fn derivative(&self, secs: f64, order: u8) -> f64 {
        if order == 0 {
            self.u(secs)
        } else if self.domain().contains(secs) {
            self.curve.derivative(secs, order)
        } else {
            0.0
        }
    }

    /// From the first key time to the last, in seconds.
    pub fn domain(&self) -> Interval {
        self.curve.domain()
    }

    /// The times the keys were given.
    pub fn times_secs(&self) -> &[f64] {
        self.curve.knots()
    }

    /// n: one less than the number of keys.
    pub fn last_key(&self) -> usize {
        self.times_secs().len() - 1
    }

    /// The n+3 coefficients of the kinetic spline; one for a single key; none in modes without.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The knots that go with [`Kinetics::coefficients`]: the key times, both ends four-fold.
    pub fn knots(&self) -> Vec<f64> {
        crate::curve::four_fold_knots(self.times_secs())
    }

    /// Where the motion runs backwards, in seconds, in order; empty for kinetics that never do.
    pub fn reversals(&self) -> Vec<Interval> {
        match self.mode {
            KineticsMode::Natural => roots::reversals(&self.curve),
            KineticsMode::Monotone | KineticsMode::Linear => Vec::new(),
        }
    }

    /// The earliest time at which key `key` is met, in seconds; `None` for a key that does not exist.
    pub fn first_reach(&self, key: usize) -> Option<f64> {
        (key <= self.last_key()).then(|| roots::first_reach(&self.curve, key as f64))
    }
}

/// What is done with coefficients that an edit put out of order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ordering {
    /// Nothing: time may run backwards.
    #[default]
    Free,
    /// Each is raised to the one before it, and none leaves 0 to n: time never runs backwards.
    KeepForward,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Key times of the thesis's figure 2-17.
    const FIG_2_17: [f64; 6] = [0.0, 0.5, 1.2, 2.0, 3.0, 3.5];

    fn natural() -> Kinetics {
        Kinetics::new(&FIG_2_17, KineticsMode::Natural).expect("valid")
    }

    #[test]
    fn figure_2_17_has_its_coefficients() {
        // Maths notes, section 3.
        let want = [
            0.0,
            0.354_398_824,
            1.204_956_002,
            2.015_865_164,
            3.218_381_420,
            3.534_343_729,
            4.633_585_932,
            5.0,
        ];
        for (got, want) in natural().coefficients().iter().zip(want) {
            assert!((got - want).abs() < 1e-9, "{got} wanted {want}");
        }
    }

    #[test]
    fn an_edit_changes_four_spans_and_no_bit_elsewhere() {
        let (plain, edited) = (
            natural(),
            natural().edited(&[(6, -0.3)], Ordering::Free).expect("valid"),
        );
        for i in 0..=350 {
            let t = f64::from(i) / 100.0;
            let same = plain.u(t) == edited.u(t);
            assert_eq!(same, !(t > 2.0 && t < 3.5), "at {t}");
        }
    }

    #[test]
    fn edits_that_cannot_be() {
        let edit = |index, change| natural().edited(&[(index, change)], Ordering::Free).err();
        assert_eq!(
            edit(0, 0.1),
            Some(KineticsError::EndCoefficient {
                index: 0,
                last_free: 6
            })
        );
        assert_eq!(
            edit(7, 0.1),
            Some(KineticsError::EndCoefficient {
                index: 7,
                last_free: 6
            })
        );
        assert_eq!(
            edit(8, 0.1),
            Some(KineticsError::NoSuchCoefficient { index: 8, count: 8 })
        );
        assert_eq!(edit(3, f64::NAN), Some(KineticsError::EditNotFinite { index: 3 }));
        let linear = Kinetics::new(&FIG_2_17, KineticsMode::Linear).expect("valid");
        assert!(linear.edited(&[], Ordering::Free).is_err());
    }

    #[test]
    fn a_single_key_stands_still() {
        let one = Kinetics::new(&[1.0], KineticsMode::Natural).expect("valid");
        assert_eq!((one.u(0.0), one.u(1.0), one.u(9.0)), (0.0, 0.0, 0.0));
        assert_eq!(one.derivative(1.0, 1), 0.0);
        assert_eq!(one.first_reach(0), Some(1.0));
        assert!(one.reversals().is_empty());
    }
}
