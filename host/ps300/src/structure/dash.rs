//! Dashes: which parts of a line a pattern leaves.
//!
//! A matched pattern is stretched so that the line begins and ends with its first dash. Source: the command
//! PATTERN in `docs/protocols/ps300.md`; what matching means is ours.

use crate::language::{Operation, Pattern};

/// Lines and gaps in turn.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Dashes {
    /// Relative lengths, line first.
    segments: Vec<f64>,
    pub(super) around_corners: bool,
    matched: bool,
    /// Of one whole pattern.
    length: f64,
}

/// A line has no more dashes than this; what would have is drawn solid.
const PATTERNS_MAX: f64 = 1024.0;

/// How long seven bits of a line texture are, in the list's own space. Our choice.
const TEXTURE_LENGTH: f64 = 0.1;

impl Dashes {
    pub(super) fn of(pattern: &Pattern) -> Self {
        Self {
            segments: pattern.segments.iter().map(|&n| f64::from(n)).collect(),
            around_corners: pattern.around_corners,
            matched: pattern.matched,
            length: pattern.length,
        }
    }

    /// Of SET LINE_TEXTURE; nothing for a solid line. The first segment may be empty.
    pub(super) fn of_mask(mask: u8, around_corners: bool) -> Option<Self> {
        if mask & Operation::LINE_TEXTURE_MAX == Operation::LINE_TEXTURE_MAX {
            return None;
        }
        let mut segments = Vec::new();
        let mut on = true;
        let mut run = 0.0;
        for bit in (0..7).rev() {
            let set = mask >> bit & 1 == 1;
            if set != on {
                segments.push(run);
                (on, run) = (set, 0.0);
            }
            run += 1.0;
        }
        segments.push(run);
        Some(Self {
            segments,
            around_corners,
            matched: false,
            length: TEXTURE_LENGTH,
        })
    }

    /// The dashes between `done` and `done + part` of a run `total` long, as lengths from its beginning.
    pub(super) fn dashes(&self, total: f64, done: f64, part: f64, out: &mut Vec<[f64; 2]>) {
        out.clear();
        let sum: f64 = self.segments.iter().sum();
        let solid = [done, done + part];
        if sum <= 0.0 || self.length <= 0.0 || total / self.length > PATTERNS_MAX {
            return out.push(solid);
        }
        let period = if self.matched {
            let first = self.segments[0] / sum;
            let whole = (total / self.length - first).round().max(0.0);
            total / (whole + first).max(f64::MIN_POSITIVE)
        } else {
            self.length
        };
        if !(period > 0.0 && period.is_finite() && total / period <= PATTERNS_MAX) {
            return out.push(solid);
        }
        let mut at = (done / period).floor() * period;
        let end = done + part;
        // A hair is no dash: it would be the rounding of the pattern's end.
        let hair = period * 1e-9;
        while at < end - hair {
            let mut on = true;
            for segment in &self.segments {
                let next = at + segment / sum * period;
                let dash = [at.max(done), next.min(end)];
                if on && dash[1] - dash[0] > hair {
                    out.push(dash);
                }
                on = !on;
                at = next;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dashes(segments: &[f64], matched: bool, length: f64, total: f64) -> Vec<[f64; 2]> {
        let dashes = Dashes {
            segments: segments.to_vec(),
            around_corners: false,
            matched,
            length,
        };
        let mut out = Vec::new();
        dashes.dashes(total, 0.0, total, &mut out);
        out
    }

    fn near(got: &[[f64; 2]], want: &[[f64; 2]]) -> bool {
        got.len() == want.len()
            && got
                .iter()
                .flatten()
                .zip(want.iter().flatten())
                .all(|(a, b)| (a - b).abs() < 1e-9)
    }

    #[test]
    fn dashes_and_gaps_alternate() {
        let got = dashes(&[2.0, 1.0, 1.0, 1.0], false, 5.0, 7.0);
        assert!(near(&got, &[[0.0, 2.0], [3.0, 4.0], [5.0, 7.0]]), "{got:?}");
    }

    #[test]
    fn matched_lines_end_with_the_dash_they_begin_with() {
        let got = dashes(&[1.0, 1.0], true, 2.0, 5.2);
        let unit = 5.2 / 5.0;
        let want = [[0.0, unit], [2.0 * unit, 3.0 * unit], [4.0 * unit, 5.2]];
        assert!(near(&got, &want), "{got:?}");
        assert!(near(&dashes(&[1.0, 1.0], true, 2.0, 0.5), &[[0.0, 0.5]]));
    }

    #[test]
    fn a_run_goes_on_around_its_corners() {
        let pattern = Dashes {
            segments: vec![1.0, 1.0],
            around_corners: true,
            matched: false,
            length: 2.0,
        };
        let mut out = Vec::new();
        pattern.dashes(3.5, 1.5, 2.0, &mut out);
        assert!(near(&out, &[[2.0, 3.0]]), "{out:?}");
    }

    #[test]
    fn a_texture_is_read_from_its_highest_bit() {
        assert_eq!(Dashes::of_mask(127, false), None);
        let mask = Dashes::of_mask(0b011_0001, true).unwrap();
        assert_eq!(mask.segments, [0.0, 1.0, 2.0, 3.0, 1.0]);
        let none = Dashes::of_mask(0, true).unwrap();
        let mut out = Vec::new();
        none.dashes(1.0, 0.0, 1.0, &mut out);
        assert!(out.is_empty());
    }

    #[test]
    fn patterns_finer_than_a_line_can_show_are_solid() {
        assert_eq!(dashes(&[1.0, 1.0], false, 1e-9, 1.0), [[0.0, 1.0]]);
        assert_eq!(dashes(&[0.0, 0.0], true, 1.0, 1.0), [[0.0, 1.0]]);
    }
}
