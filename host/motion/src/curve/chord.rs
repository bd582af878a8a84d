//! Interpolation over chord length: the curve through points that were clicked anywhere, at any scale.
//!
//! Everything is computed on points shifted to the first one and divided by a power of two, and scaled
//! back exactly, so curves of 1e200 and of 1e-200 are the same curve. Points too close to tell apart get
//! one parameter (our choice; the thesis's system is singular there).
//! Source: the thesis, section 2.3; parameters are accumulated chord lengths.

use super::blend::power_of_two_near;
use super::natural::four_fold_knots;
use super::{Blend, Curve, Interval, Natural, Smooth, SplineError};

/// A point nearer to the last kept one than this share of the whole polygon is merged with it (our choice).
const MERGE_SHARE: f64 = 1e-12;

/// The natural cubic through points, over accumulated chord length.
#[derive(Clone, Debug, PartialEq)]
pub struct ChordLength<P> {
    /// Through the kept points, less `origin`, over `scale`; so is its parameter.
    scaled: Natural<P>,
    origin: P,
    scale: f64,
    kept: Vec<usize>,
    params: Vec<f64>,
}

impl<P: Blend> Natural<P> {
    /// The curve through these points over chord length; near-equal neighbours are merged.
    ///
    /// Refuses no points and points that are not finite, by index.
    pub fn chord_length(points: &[P]) -> Result<ChordLength<P>, SplineError> {
        if let Some(at) = points.iter().position(|p| !p.is_finite()) {
            return Err(SplineError::NotFinite { at });
        }
        let origin = *points.first().ok_or(SplineError::Empty)?;
        let largest = points.iter().map(|p| p.largest()).fold(0.0, f64::max);
        let scale = power_of_two_near(largest);
        let shrink = 1.0 / scale;
        let local: Vec<P> = points.iter().map(|&p| p * shrink - origin * shrink).collect();
        let (kept, params) = accumulate(&local);
        let abscissae: Vec<f64> = kept.iter().map(|&i| params[i]).collect();
        let through: Vec<P> = kept.iter().map(|&i| local[i]).collect();
        let scaled = Natural::new(&abscissae, &through)?;
        let params = params.into_iter().map(|u| u * scale).collect();
        Ok(ChordLength {
            scaled,
            origin,
            scale,
            kept,
            params,
        })
    }
}

/// Which points are kept, and the accumulated chord length at every point.
fn accumulate<P: Blend>(points: &[P]) -> (Vec<usize>, Vec<f64>) {
    let total: f64 = points.windows(2).map(|pair| (pair[1] - pair[0]).length()).sum();
    let (mut kept, mut params) = (vec![0], vec![0.0]);
    let (mut last, mut u) = (points[0], 0.0);
    for (index, &point) in points.iter().enumerate().skip(1) {
        let chord = (point - last).length();
        if chord > MERGE_SHARE * total {
            kept.push(index);
            last = point;
            u += chord;
        }
        params.push(u);
    }
    (kept, params)
}

impl<P: Blend> ChordLength<P> {
    /// Indices of the given points that the curve was laid through; the others were merged with the kept
    /// one before them.
    pub fn kept(&self) -> &[usize] {
        &self.kept
    }

    /// The parameter of every given point.
    pub fn params(&self) -> &[f64] {
        &self.params
    }

    /// The knots as a B-spline, ends four-fold; empty where all points are one.
    pub fn knots(&self) -> Vec<f64> {
        let abscissae: Vec<f64> = self.kept.iter().map(|&i| self.params[i]).collect();
        four_fold_knots(&abscissae)
    }

    /// The B-spline coefficients, as [`Natural::coefficients`].
    pub fn coefficients(&self) -> Vec<P> {
        self.scaled
            .coefficients()
            .into_iter()
            .map(|q| self.restore(q))
            .collect()
    }

    fn restore(&self, scaled: P) -> P {
        scaled * self.scale + self.origin
    }
}

impl<P: Blend> Curve for ChordLength<P> {
    type Point = P;

    fn domain(&self) -> Interval {
        Interval::new(0.0, self.scaled.domain().end * self.scale)
    }

    fn eval(&self, u: f64) -> P {
        self.restore(self.scaled.eval(u / self.scale))
    }
}

impl<P: Blend> Smooth for ChordLength<P> {
    fn derivative(&self, u: f64, order: u8) -> P {
        match order {
            0 => self.eval(u),
            // Point and parameter shrink together, so the first derivative has no scale.
            _ => (1..order).fold(self.scaled.derivative(u / self.scale, order), |d, _| {
                d * (1.0 / self.scale)
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn points(scale: f64) -> Vec<DVec3> {
        [[1., 0., 0.], [2., 1., 0.], [4., -1., 1.]]
            .map(|p| DVec3::from_array(p) * scale)
            .to_vec()
    }

    #[test]
    fn scale_changes_nothing_but_scale() {
        let plain = Natural::chord_length(&points(1.0)).expect("valid");
        for scale in [1e-290, 1e-200, 1e150, 1e200, 1e300] {
            let scaled = Natural::chord_length(&points(scale)).expect("valid");
            let u = plain.domain().end * 0.37;
            let (got, want) = (scaled.eval(u * scale) * (1.0 / scale), plain.eval(u));
            assert!(got.abs_diff_eq(want, 1e-13), "scale {scale}: {got} wanted {want}");
            assert!(
                scaled
                    .derivative(u * scale, 1)
                    .abs_diff_eq(plain.derivative(u, 1), 1e-13)
            );
        }
    }

    #[test]
    fn repeated_neighbours_share_a_parameter() {
        let p = [[0., 0., 0.], [1., 0., 0.], [1., 0., 0.], [2., 1., 0.]].map(DVec3::from_array);
        let curve = Natural::chord_length(&p).expect("valid");
        assert_eq!(curve.kept(), [0, 1, 3]);
        assert_eq!(curve.params()[2], curve.params()[1]);
        let one = Natural::chord_length(&[p[1]; 4]).expect("valid");
        assert_eq!((one.kept(), one.eval(3.0)), (&[0][..], p[1]));
    }
}
