//! Polynomials over 0 to 1, and where they leave a band: nothing between two samples can be missed.
//!
//! A polynomial stays within the hull of its Bernstein coefficients, so halving it tightens a bound that holds
//! everywhere, not only where somebody looked.
//! Source: G. Farin, Curves and Surfaces for CAGD, 5th ed., sections 4.2 (subdivision) and 6.3 (convex hull).

/// A cubic of a cubic: ten coefficients.
pub(super) const TERMS: usize = 10;
/// A maximum is found to this share of itself (our choice).
const CLOSENESS: f64 = 1e-6;
/// Most halvings on the way to a maximum; each gains a bit and more of the hull.
const HALVINGS_MAX: u32 = 30;

/// Power coefficients over 0 to 1, constant first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Polynomial {
    pub(super) c: [f64; TERMS],
}

/// A stretch of 0 to 1, with the largest magnitude on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Beyond {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) most: f64,
}

impl Polynomial {
    /// `outer(inner(s))`, both cubics.
    pub(super) fn composed(outer: &[f64; 4], inner: &[f64; 4]) -> Self {
        let mut c = [0.0; TERMS];
        // Horner's rule, in polynomials.
        let mut degree = 0;
        c[0] = outer[3];
        for constant in [outer[2], outer[1], outer[0]] {
            let mut next = [0.0; TERMS];
            for (i, a) in c.iter().enumerate().take(degree + 1) {
                for (j, b) in inner.iter().enumerate() {
                    next[i + j] += a * b;
                }
            }
            next[0] += constant;
            (c, degree) = (next, degree + 3);
        }
        Self { c }
    }

    pub(super) fn at(&self, s: f64) -> f64 {
        self.c.iter().rev().fold(0.0, |sum, c| sum * s + c)
    }

    /// The derivative with respect to a time that runs `span` while s runs from 0 to 1.
    pub(super) fn rate(&self, span: f64) -> Self {
        let mut c = [0.0; TERMS];
        for (power, into) in c.iter_mut().enumerate().take(TERMS - 1) {
            *into = self.c[power + 1] * (power + 1) as f64 / span;
        }
        Self { c }
    }

    /// The same less a constant.
    pub(super) fn less(mut self, constant: f64) -> Self {
        self.c[0] -= constant;
        self
    }

    /// Where its magnitude is above `limit`, to within `grain` of 0 to 1, in order, touching ones joined.
    pub(super) fn beyond(&self, limit: f64, grain: f64) -> Vec<Beyond> {
        let mut found = Vec::new();
        // What is at its limit to all but rounding keeps it.
        let limit = limit * (1.0 + CLOSENESS);
        search(&self.bernstein(), 0.0, 1.0, limit, grain, &mut found);
        found
    }

    fn bernstein(&self) -> [f64; TERMS] {
        // b[i] = sum over j <= i of C(i,j) / C(n,j) c[j].
        let n = TERMS - 1;
        let mut b = [0.0; TERMS];
        for (i, into) in b.iter_mut().enumerate() {
            let (mut share, mut sum) = (1.0, 0.0);
            for (j, c) in self.c.iter().enumerate().take(i + 1) {
                sum += share * c;
                share *= (i - j) as f64 / (n - j).max(1) as f64;
            }
            *into = sum;
        }
        b
    }
}

fn hull(b: &[f64; TERMS]) -> (f64, f64) {
    b.iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| {
            (low.min(x), high.max(x))
        })
}

/// De Casteljau's halving.
fn halves(b: &[f64; TERMS]) -> ([f64; TERMS], [f64; TERMS]) {
    let (mut left, mut right) = (*b, *b);
    for (round, into) in left.iter_mut().enumerate().skip(1) {
        for i in 0..TERMS - round {
            right[i] = f64::midpoint(right[i], right[i + 1]);
        }
        *into = right[0];
    }
    (left, right)
}

fn search(b: &[f64; TERMS], from: f64, to: f64, limit: f64, grain: f64, found: &mut Vec<Beyond>) {
    let (low, high) = hull(b);
    if high <= limit && low >= -limit {
        return;
    }
    if low > limit || high < -limit {
        add(found, from, to, most(b, limit));
    } else if to - from <= grain {
        let most = most(b, limit);
        if most > limit {
            add(found, from, to, most);
        }
    } else {
        let (left, right) = halves(b);
        let middle = f64::midpoint(from, to);
        search(&left, from, middle, limit, grain, found);
        search(&right, middle, to, limit, grain, found);
    }
}

fn add(found: &mut Vec<Beyond>, from: f64, to: f64, most: f64) {
    match found.last_mut() {
        Some(open) if open.to == from => {
            open.to = to;
            open.most = open.most.max(most);
        }
        _ => found.push(Beyond { from, to, most }),
    }
}

/// The largest magnitude, by halving what may still hold it; `least` or less is not told apart.
fn most(b: &[f64; TERMS], least: f64) -> f64 {
    let mut best = least.max(b[0].abs()).max(b[TERMS - 1].abs());
    climb(b, HALVINGS_MAX, &mut best);
    best
}

fn climb(b: &[f64; TERMS], halvings: u32, best: &mut f64) {
    let (low, high) = hull(b);
    if high.max(-low) <= *best * (1.0 + CLOSENESS) {
        return;
    }
    let (left, right) = halves(b);
    *best = best.max(right[0].abs());
    if halvings > 0 {
        climb(&left, halvings - 1, best);
        climb(&right, halvings - 1, best);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_of_a_cubic_is_what_it_says() {
        let (outer, inner) = ([1.0, -2.0, 0.5, 3.0], [0.25, 1.5, -0.75, 0.1]);
        let cubic = |c: &[f64; 4], x: f64| c[0] + (c[1] + (c[2] + c[3] * x) * x) * x;
        let both = Polynomial::composed(&outer, &inner);
        for i in 0..=10 {
            let s = f64::from(i) / 10.0;
            assert!((both.at(s) - cubic(&outer, cubic(&inner, s))).abs() < 1e-12);
            let slope = (both.at(s + 1e-6) - both.at(s - 1e-6)) / 2e-6;
            assert!((both.rate(2.0).at(s) * 2.0 - slope).abs() < 1e-6);
        }
    }

    #[test]
    fn a_needle_between_samples_is_found() {
        // ((2s-1)^3 scaled) has its steepest slope at the ends; a bump of s^9 (1-s)^0 only at one.
        let mut needle = Polynomial::default();
        needle.c[9] = 1.0;
        let found = needle.beyond(0.99, 1e-3);
        assert_eq!(found.len(), 1);
        assert!((found[0].from - 0.99_f64.powf(1.0 / 9.0)).abs() < 2e-3 && found[0].to == 1.0);
        assert!((found[0].most - 1.0).abs() < 1e-9);
        assert!(needle.beyond(1.0, 1e-3).is_empty());
    }

    #[test]
    fn an_inner_maximum_is_exact_however_narrow_its_excess() {
        // 4 s (1-s) reaches 1 at one half only.
        let mut hill = Polynomial::default();
        (hill.c[1], hill.c[2]) = (4.0, -4.0);
        let found = hill.beyond(1.0 - 1e-5, 1e-2);
        assert_eq!(found.len(), 1);
        assert!((found[0].most - 1.0).abs() < 1e-5, "{found:?}");
        assert!(found[0].from < 0.5 && found[0].to > 0.5 && found[0].to - found[0].from < 0.05);
        assert!(hill.beyond(1.0, 1e-2).is_empty());
    }
}
