//! The path a servo's own profile generator makes: at most three phases, then rest or a steady speed.
//!
//! Source: the maker's control table pages, "Profile Acceleration", "Profile Velocity", "What is the
//! profile". Positions are encoder counts, times seconds since the plan was made.

/// Longest plan: speeding up, cruising, slowing down.
const PHASES: usize = 3;

/// Kinds as Moving Status tells them in bits 5..4.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Kind {
    #[default]
    Step = 0,
    Rectangular = 1,
    Triangular = 2,
    Trapezoidal = 3,
}

/// What the profile registers ask for, in counts and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    /// Goal at once.
    Step,
    /// At most this fast; an acceleration of 0 means unbounded.
    Speed { velocity: f64, acceleration: f64 },
    /// In this time, of which the first and last `acceleration` seconds speed up and slow down.
    Time { total: f64, acceleration: f64 },
}

/// Position and speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct State {
    pub(super) position: f64,
    pub(super) velocity: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Phase {
    secs: f64,
    velocity: f64,
    acceleration: f64,
}

/// A path from one state to rest at a goal, or to a steady speed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plan {
    start: f64,
    phases: [Phase; PHASES],
    goal: Option<f64>,
    cruise: f64,
    pub(super) kind: Kind,
}

impl Plan {
    /// Rests at `position`.
    pub(super) fn rest(position: f64) -> Self {
        Self {
            start: position,
            goal: Some(position),
            ..Self::default()
        }
    }

    /// From `from` to rest at `goal`.
    pub(super) fn to(goal: f64, from: State, shape: Shape) -> Self {
        let distance = goal - from.position;
        let (phases, kind) = match shape {
            Shape::Step => ([Phase::default(); PHASES], Kind::Step),
            Shape::Speed {
                velocity,
                acceleration,
            } if acceleration <= 0.0 => (steady(distance, velocity), Kind::Rectangular),
            Shape::Speed {
                velocity,
                acceleration,
            } => bounded(distance, from.velocity, velocity, acceleration),
            Shape::Time { total, acceleration } => timed(distance, from.velocity, total, acceleration),
        };
        Self {
            start: from.position,
            phases,
            goal: Some(goal),
            cruise: 0.0,
            kind,
        }
    }

    /// From `from` to the steady speed `velocity`; an acceleration of 0 means at once.
    pub(super) fn at_speed(velocity: f64, from: State, acceleration: f64) -> Self {
        let mut phases = [Phase::default(); PHASES];
        if acceleration > 0.0 {
            let change = velocity - from.velocity;
            phases[0] = Phase {
                secs: change.abs() / acceleration,
                velocity: from.velocity,
                acceleration: acceleration.copysign(change),
            };
        }
        Self {
            start: from.position,
            phases,
            goal: None,
            cruise: velocity,
            kind: Kind::Step,
        }
    }

    /// Whether it leads to smaller counts.
    pub(super) fn goes_down(&self) -> bool {
        self.goal.is_some_and(|goal| goal < self.start)
    }

    /// Where the path is after `secs`, and whether it still has phases to go.
    pub(super) fn at(&self, secs: f64) -> (State, bool) {
        let mut left = secs.max(0.0);
        let mut position = self.start;
        for phase in &self.phases {
            if left < phase.secs {
                let velocity = phase.velocity + phase.acceleration * left;
                position += f64::midpoint(phase.velocity, velocity) * left;
                return (State { position, velocity }, true);
            }
            position += (phase.velocity + phase.acceleration * phase.secs / 2.0) * phase.secs;
            left -= phase.secs;
        }
        match self.goal {
            Some(goal) => (
                State {
                    position: goal,
                    velocity: 0.0,
                },
                false,
            ),
            None => (
                State {
                    position: position + self.cruise * left,
                    velocity: self.cruise,
                },
                false,
            ),
        }
    }
}

/// One speed all the way.
fn steady(distance: f64, velocity: f64) -> [Phase; PHASES] {
    let mut phases = [Phase::default(); PHASES];
    phases[0] = Phase {
        secs: distance.abs() / velocity,
        velocity: velocity.copysign(distance),
        acceleration: 0.0,
    };
    phases
}

/// Shortest way under a speed and an acceleration, from any starting speed.
fn bounded(distance: f64, v0: f64, v_max: f64, a: f64) -> ([Phase; PHASES], Kind) {
    // Which way to push first: where braking at once would stop short of the goal.
    let sign = if distance - v0 * v0.abs() / (2.0 * a) < 0.0 {
        -1.0
    } else {
        1.0
    };
    let (distance, v0) = (sign * distance, sign * v0);
    let peak_squared = a * distance + v0 * v0 / 2.0;
    let peak = peak_squared.max(0.0).sqrt().min(v_max);
    let first = Phase {
        secs: (peak - v0).abs() / a,
        velocity: v0,
        acceleration: a.copysign(peak - v0),
    };
    let slow = peak / a;
    let cruise = (distance - f64::midpoint(v0, peak) * first.secs - peak / 2.0 * slow).max(0.0);
    let kind = if peak < v_max {
        Kind::Triangular
    } else {
        Kind::Trapezoidal
    };
    let middle = Phase {
        secs: if peak > 0.0 { cruise / peak } else { 0.0 },
        velocity: peak,
        acceleration: 0.0,
    };
    let last = Phase {
        secs: slow,
        velocity: peak,
        acceleration: -a,
    };
    ([first, middle, last].map(|phase| phase.times(sign)), kind)
}

/// In a given time, of which equal parts at both ends change speed.
fn timed(distance: f64, v0: f64, total: f64, a_secs: f64) -> ([Phase; PHASES], Kind) {
    if a_secs <= 0.0 {
        let middle = Phase {
            secs: total,
            velocity: distance / total,
            acceleration: 0.0,
        };
        return ([middle, Phase::default(), Phase::default()], Kind::Rectangular);
    }
    let cruise = (distance - v0 * a_secs / 2.0) / (total - a_secs);
    let first = Phase {
        secs: a_secs,
        velocity: v0,
        acceleration: (cruise - v0) / a_secs,
    };
    let middle = Phase {
        secs: total - 2.0 * a_secs,
        velocity: cruise,
        acceleration: 0.0,
    };
    let last = Phase {
        secs: a_secs,
        velocity: cruise,
        acceleration: -cruise / a_secs,
    };
    let kind = if middle.secs > 0.0 {
        Kind::Trapezoidal
    } else {
        Kind::Triangular
    };
    ([first, middle, last], kind)
}

impl Phase {
    fn times(self, sign: f64) -> Self {
        Self {
            velocity: sign * self.velocity,
            acceleration: sign * self.acceleration,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_trapezoid_takes_the_times_of_the_manual() {
        // V 100, A 10: t1 = 64 V / A = 640 ms; here in their own units, so 100 / 10 and a distance of 2000.
        let shape = Shape::Speed {
            velocity: 100.0,
            acceleration: 10.0,
        };
        let plan = Plan::to(2000.0, State::default(), shape);
        assert_eq!(plan.kind, Kind::Trapezoidal);
        assert_eq!(
            plan.at(10.0).0,
            State {
                position: 500.0,
                velocity: 100.0
            }
        );
        assert_eq!(plan.at(20.0).0.position, 1500.0);
        assert_eq!(
            plan.at(30.0),
            (
                State {
                    position: 2000.0,
                    velocity: 0.0
                },
                false
            )
        );
        let plan = Plan::to(-10.0, State::default(), shape);
        assert_eq!(plan.kind, Kind::Triangular);
        assert_eq!(
            plan.at(1.0).0,
            State {
                position: -5.0,
                velocity: -10.0
            }
        );
    }

    #[test]
    fn a_time_based_profile_takes_its_time() {
        let plan = Plan::to(
            800.0,
            State::default(),
            Shape::Time {
                total: 1.0,
                acceleration: 0.2,
            },
        );
        assert!(plan.at(0.999_9).1);
        assert_eq!(
            plan.at(0.5).0,
            State {
                position: 400.0,
                velocity: 1000.0
            }
        );
        assert_eq!(
            plan.at(1.0).0,
            State {
                position: 800.0,
                velocity: 0.0
            }
        );
    }

    proptest! {
        #[test]
        fn a_bounded_path_is_continuous_and_within_its_bounds(
            goal in -5000.0f64..5000.0, v0 in -300.0f64..300.0, v in 40.0f64..400.0, a in 10.0f64..2000.0,
        ) {
            let plan = Plan::to(goal, State { position: 0.0, velocity: v0 }, Shape::Speed { velocity: v, acceleration: a });
            let dt = 0.001;
            let mut before = plan.at(0.0).0;
            let mut speed_max = v0.abs().max(v);
            for step in 1..200_000u32 {
                let (now, going) = plan.at(f64::from(step) * dt);
                prop_assert!((now.position - before.position).abs() <= speed_max * dt + 1e-6);
                prop_assert!((now.velocity - before.velocity).abs() <= a * dt + 1e-6);
                // Once slowed to the profile's speed it is never exceeded again.
                if now.velocity.abs() <= v { speed_max = v; }
                prop_assert!(now.velocity.abs() <= speed_max + 1e-9);
                before = now;
                if !going { break; }
            }
            prop_assert!((before.position - goal).abs() < 1e-6);
        }
    }
}
