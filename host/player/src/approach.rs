//! The way from where the joints stand to where playing begins.
//!
//! All joints leave and arrive together on the curve of least jerk, s = 10τ³ − 15τ⁴ + 6τ⁵, whose greatest
//! slope is 1.875 and greatest second derivative 10/√3 (source: Flash and Hogan 1985, "The coordination of arm
//! movements", with the extrema worked out). The wishes it makes pass the limiter like all others.

use device::servo::Limits;

const SLOPE_MAX: f64 = 1.875;
const BEND_MAX: f64 = 5.773_502_691_896_258;

/// One way under way.
#[derive(Debug, Clone, Default)]
pub(crate) struct Approach {
    from: Vec<f64>,
    duration_secs: f64,
    elapsed_secs: f64,
}

impl Approach {
    /// Starts at `from`; takes as long as the slowest joint needs with `share` of its limits.
    pub(crate) fn begin(&mut self, from: &[f64], to: &[f64], limits: &[Limits], share: f64) {
        self.from.clear();
        self.from.extend_from_slice(from);
        self.elapsed_secs = 0.0;
        // Below a hundredth an approach would seem to have stopped.
        let share = if share.is_finite() {
            share.clamp(0.01, 1.0)
        } else {
            0.01
        };
        let needs = from.iter().zip(to).zip(limits).map(|((from, to), limits)| {
            let way = (to.clamp(limits.min_rad(), limits.max_rad()) - from).abs();
            let by_speed = SLOPE_MAX * way / (share * limits.velocity_max_rad_per_s());
            let by_force = (BEND_MAX * way / (share * limits.acceleration_max_rad_per_s2())).sqrt();
            by_speed.max(by_force)
        });
        self.duration_secs = needs.filter(|secs| secs.is_finite()).fold(0.0, f64::max);
    }

    pub(crate) fn advance(&mut self, dt_secs: f64) {
        self.elapsed_secs += dt_secs;
    }

    /// Whether the wishes have reached their end.
    pub(crate) fn is_over(&self) -> bool {
        self.elapsed_secs >= self.duration_secs
    }

    /// Turns the poses to go to (which may move meanwhile) into the wishes of this moment.
    pub(crate) fn blend(&self, pose: &mut [f64]) {
        if self.is_over() {
            return;
        }
        let t = self.elapsed_secs / self.duration_secs;
        let s = t * t * t * (10.0 + t * (6.0 * t - 15.0));
        for (wanted, from) in pose.iter_mut().zip(&self.from) {
            *wanted = from + (*wanted - from) * s;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_starts_and_ends_where_it_should_and_keeps_its_share() {
        let limits = [
            Limits::new([-3.0, 3.0], 2.0, 8.0).unwrap(),
            Limits::new([-1.0, 1.0], 5.0, 20.0).unwrap(),
        ];
        let (from, to) = ([0.5, -0.5], [-2.0, 0.75]);
        let mut approach = Approach::default();
        approach.begin(&from, &to, &limits, 0.5);
        let dt = 0.001;
        let mut before = from;
        let mut velocity_before = [0.0; 2];
        while !approach.is_over() {
            approach.advance(dt);
            let mut pose = to;
            approach.blend(&mut pose);
            for joint in 0..2 {
                let velocity = (pose[joint] - before[joint]) / dt;
                assert!(velocity.abs() <= 0.5 * limits[joint].velocity_max_rad_per_s() + 1e-9);
                let acceleration = (velocity - velocity_before[joint]) / dt;
                assert!(acceleration.abs() <= 0.5 * limits[joint].acceleration_max_rad_per_s2() * 1.02);
                velocity_before[joint] = velocity;
            }
            before = pose;
        }
        assert_eq!(before, to);
    }

    #[test]
    fn no_way_takes_no_time() {
        let limits = [Limits::new([-1.0, 1.0], 1.0, 1.0).unwrap()];
        let mut approach = Approach::default();
        approach.begin(&[0.25], &[0.25], &limits, 0.5);
        assert!(approach.is_over());
        approach.begin(&[0.25], &[f64::NAN], &limits, 0.5);
        assert!(
            approach.is_over(),
            "a wish that is no number is the limiter's to refuse"
        );
    }
}
