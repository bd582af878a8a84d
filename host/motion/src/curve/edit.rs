//! Changing a B-spline, and carrying stored parameters over the change.
//!
//! The parameter range changes whenever a point comes or goes or the order changes, so whatever sits on
//! the curve by its parameter has to be moved. The thesis is silent here. Our choice: Greville abscissae
//! of the surviving points correspond, and between them the map is linear; it keeps order, sends ends
//! to ends, and leaves what is far from the edit nearly where it was.

use super::{BSpline, Blend, Interval, SplineError};

/// A piecewise-linear, never decreasing map of stored parameters from the old curve to the new one.
#[derive(Clone, Debug, PartialEq)]
pub struct Remap {
    from: Vec<f64>,
    to: Vec<f64>,
}

impl Remap {
    /// Where the parameter `u` of the old curve lies on the new one; clamped at both ends.
    pub fn map(&self, u: f64) -> f64 {
        let after = self.from.partition_point(|&knot| knot <= u);
        match (after.checked_sub(1), self.from.get(after)) {
            (None, _) => self.to.first().copied().unwrap_or(0.0),
            (Some(last), None) => self.to[last],
            (Some(left), Some(&right)) => {
                let share = (u - self.from[left]) / (right - self.from[left]);
                self.to[left] + (self.to[after] - self.to[left]) * share
            }
        }
    }

    /// `survivors` pairs an old index with its new one, both increasing.
    fn between<P: Blend>(
        old: &BSpline<P>,
        new: &BSpline<P>,
        survivors: impl Iterator<Item = (usize, usize)>,
    ) -> Self {
        let (old, new) = (old.greville(), new.greville());
        let (from, to) = survivors.map(|(i, j)| (old[i], new[j])).unzip();
        Self { from, to }
    }
}

impl<P: Blend> BSpline<P> {
    /// The curve with one control point moved, and the interval outside which nothing changed.
    pub fn move_point(&self, index: usize, to: P) -> Result<(Self, Interval), SplineError> {
        let changed = self.influence(index)?;
        let mut points = self.points().to_vec();
        points[index] = to;
        let moved = Self::new(points, self.requested_order()).map_err(|e| match e {
            // Only the moved point can be at fault.
            SplineError::NotFinite { .. } => SplineError::NotFinite { at: index },
            other => other,
        })?;
        Ok((moved, changed))
    }

    /// The curve with a control point put into the polygon after point `index`. The shape changes, as the
    /// thesis's "Add Pt" does; keeping the shape would leave the family of uniform knots.
    pub fn insert_after(&self, index: usize, point: P) -> Result<(Self, Remap), SplineError> {
        self.check_index(index)?;
        self.insert_at(index + 1, point)
    }

    /// As [`BSpline::insert_after`], but the new point gets the index `index`, from 0 to the number of
    /// points.
    pub fn insert_at(&self, index: usize, point: P) -> Result<(Self, Remap), SplineError> {
        if index > self.points().len() {
            return Err(SplineError::NoSuchPoint {
                index,
                count: self.points().len(),
            });
        }
        let mut points = self.points().to_vec();
        points.insert(index, point);
        let new = Self::new(points, self.requested_order())?;
        let survivors = (0..self.points().len()).map(|i| (i, i + usize::from(i >= index)));
        let remap = Remap::between(self, &new, survivors);
        Ok((new, remap))
    }

    /// The curve without control point `index`. The last one left cannot be deleted.
    pub fn delete(&self, index: usize) -> Result<(Self, Remap), SplineError> {
        self.check_index(index)?;
        let mut points = self.points().to_vec();
        points.remove(index);
        let new = Self::new(points, self.requested_order())?;
        let survivors = (0..self.points().len())
            .filter(|&i| i != index)
            .map(|i| (i, i - usize::from(i > index)));
        let remap = Remap::between(self, &new, survivors);
        Ok((new, remap))
    }

    /// The same control points under another order.
    pub fn set_order(&self, order: usize) -> Result<(Self, Remap), SplineError> {
        let new = Self::new(self.points().to_vec(), order)?;
        let remap = Remap::between(self, &new, (0..self.points().len()).map(|i| (i, i)));
        Ok((new, remap))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Curve;

    fn curve(count: usize) -> BSpline<f64> {
        BSpline::new((0..count).map(|i| (i * i % 7) as f64).collect(), 4).expect("valid")
    }

    #[test]
    fn ends_go_to_ends() {
        let old = curve(7);
        let (longer, remap) = old.insert_after(2, 9.0).expect("valid");
        assert_eq!(remap.map(0.0), 0.0);
        assert_eq!(remap.map(4.0), longer.domain().end);
        assert_eq!(remap.map(-1.0), 0.0);
        assert_eq!(remap.map(9.0), longer.domain().end);
    }

    #[test]
    fn a_parameter_order_survives_every_edit() {
        let old = curve(6);
        let edits = [
            old.insert_at(0, 1.0),
            old.insert_after(5, 1.0),
            old.delete(0),
            old.delete(3),
            old.set_order(2),
        ];
        for (case, edit) in edits.into_iter().enumerate() {
            let (_, remap) = edit.expect("valid");
            let mapped: Vec<f64> = (0..=30).map(|i| remap.map(f64::from(i) / 10.0)).collect();
            assert!(mapped.is_sorted(), "edit {case}: {mapped:?}");
        }
    }

    #[test]
    fn impossible_edits_are_refused() {
        let one = BSpline::new(vec![1.0], 4).expect("valid");
        assert_eq!(one.delete(0).err(), Some(SplineError::Empty));
        assert_eq!(
            one.delete(1).err(),
            Some(SplineError::NoSuchPoint { index: 1, count: 1 })
        );
        assert_eq!(
            one.insert_after(1, 0.0).err(),
            Some(SplineError::NoSuchPoint { index: 1, count: 1 })
        );
        assert_eq!(
            curve(4).move_point(2, f64::NAN).err(),
            Some(SplineError::NotFinite { at: 2 })
        );
    }
}
