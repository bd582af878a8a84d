//! Heat, overload and brown-out of one joint: when each begins, when it is over, and how far the joint backs off.
//!
//! Numbers only. Each trouble begins and ends at different values and after different times, so that it does not
//! come and go at its edge. Backing off is the same for every servo, whatever registers it has: the goal retreats
//! towards where the joint is, and with the distance goes the effort; the clip runs slower meanwhile.

use device::servo::Load;
use device_profiles::{Role, ServoProfile};

/// Degrees below `hot_c` at which a hot servo counts as cooled down.
const COOLED_BY_C: f64 = 5.0;
/// Degrees above `hot_c` at which backing off has not helped.
const STILL_HEATING_BY_C: f64 = 8.0;
/// Degrees below the servo's own limit at which it is about to let go by itself.
const BEFORE_SHUTDOWN_C: f64 = 2.0;
/// Share of the servo's lowest voltage, above it, at which the supply counts as failing, and as well again.
const VOLTS_LOW: f64 = 1.05;
const VOLTS_WELL: f64 = 1.12;
/// Share of what a servo can pull that is too much for long, and that is little.
const EFFORT_HIGH: f64 = 0.85;
const EFFORT_LOW: f64 = 0.5;
/// How long too much must last. The servos' own overload protections wait 0.8 to 2 s: they must not come first.
const EFFORT_SECS: f64 = 0.5;
/// How long trouble must be over before it counts as over.
const OVER_SECS: f64 = 1.0;
/// A trouble that comes so often within `AGAIN_SECS` is not helped by backing off.
const AGAIN_MAX: u32 = 3;
const AGAIN_SECS: f64 = 30.0;
/// How fast a goal retreats, and returns: shares of the distance a second.
const RETREAT_PER_SEC: f64 = 2.0;
const RETURN_PER_SEC: f64 = 0.5;
/// How far it retreats: overload all the way, heat half of it, a failing supply not at all.
const RETREAT_OF_OVERLOAD: f64 = 1.0;
const RETREAT_OF_HEAT: f64 = 0.5;

/// What is wrong with a joint that can still be helped by doing less.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Trouble {
    /// The servo is hot.
    Heat,
    /// It pulls nearly all it can, or is held far from its goal.
    Overload,
    /// Its supply falls below what it needs.
    BrownOut,
}

impl Trouble {
    /// In the order in which they are reported.
    pub const ALL: [Self; 3] = [Self::Heat, Self::Overload, Self::BrownOut];

    /// A word for messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Heat => "heat",
            Self::Overload => "overload",
            Self::BrownOut => "brown-out",
        }
    }
}

/// From which values on a joint is in trouble. What is not known of a servo is not watched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) hot_c: f64,
    /// The servo's own limit.
    pub(crate) limit_c: Option<f64>,
    pub(crate) volts_min: Option<f64>,
    pub(crate) amperes_max: Option<f64>,
    pub(crate) strain_rad: f64,
    pub(crate) strain_secs: f64,
}

impl Bounds {
    /// What a servo's table and motor say. A register's start value is the factory's limit; arming reads none.
    pub(crate) fn of(servo: &ServoProfile, hot_c: f64, strain_rad: f64, strain_secs: f64) -> Self {
        let start = |role| {
            let row = servo.role(role)?;
            Some(row.init? as f64 * row.unit_per_count?)
        };
        Self {
            hot_c,
            limit_c: start(Role::TemperatureLimit).filter(|limit| *limit > 0.0),
            volts_min: start(Role::MinVoltage).filter(|volts| *volts > 0.0),
            amperes_max: servo.motor.as_ref().map(|motor| motor.stall_current_a),
            strain_rad,
            strain_secs,
        }
    }

    /// So hot that less effort has not helped, or the servo is about to let go.
    fn too_hot_c(&self) -> f64 {
        let limit = self
            .limit_c
            .map_or(f64::INFINITY, |limit| limit - BEFORE_SHUTDOWN_C);
        (self.hot_c + STILL_HEATING_BY_C).min(limit).max(self.hot_c)
    }
}

/// What was measured of a joint.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Signs {
    pub(crate) temperature_c: Option<f64>,
    pub(crate) voltage_v: Option<f64>,
    pub(crate) load: Option<Load>,
    /// Distance between measured angle and goal.
    pub(crate) strain_rad: f64,
}

/// What a step of watching led to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Turn {
    /// It begins.
    Begins(Trouble),
    /// Backing off does not help.
    Persists(Trouble),
    /// It is over.
    Ends(Trouble),
}

/// One trouble with its memory.
#[derive(Debug, Clone, Copy, Default)]
struct Sense {
    on: bool,
    bad_secs: f64,
    good_secs: f64,
    times: u32,
    since_secs: f64,
}

impl Sense {
    /// `bad` for `after_secs` begins it, `good` for `OVER_SECS` ends it.
    fn step(
        &mut self,
        trouble: Trouble,
        bad: bool,
        good: bool,
        after_secs: f64,
        dt_secs: f64,
    ) -> Option<Turn> {
        self.since_secs += dt_secs;
        self.bad_secs = if bad { self.bad_secs + dt_secs } else { 0.0 };
        self.good_secs = if good { self.good_secs + dt_secs } else { 0.0 };
        if self.on && self.good_secs >= OVER_SECS {
            self.on = false;
            return Some(Turn::Ends(trouble));
        }
        if self.on || !bad || self.bad_secs < after_secs {
            return None;
        }
        self.on = true;
        if self.since_secs > AGAIN_SECS {
            self.times = 0;
        }
        self.times += 1;
        self.since_secs = 0.0;
        Some(if self.times > AGAIN_MAX {
            Turn::Persists(trouble)
        } else {
            Turn::Begins(trouble)
        })
    }
}

/// The troubles of one joint, and how far it backs off.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Troubled {
    heat: Sense,
    overload: Sense,
    brown_out: Sense,
    strained_secs: f64,
    retreat: f64,
}

impl Troubled {
    /// Looks at what was measured. Of several turns in one step each is told.
    pub(crate) fn step(&mut self, signs: &Signs, bounds: &Bounds, dt_secs: f64, tell: &mut dyn FnMut(Turn)) {
        if let Some(celsius) = signs.temperature_c {
            let bad = celsius >= bounds.hot_c;
            let good = celsius <= bounds.hot_c - COOLED_BY_C;
            let turn = self.heat.step(Trouble::Heat, bad, good, 0.0, dt_secs);
            let worse = self.heat.on && celsius >= bounds.too_hot_c() && celsius > bounds.hot_c;
            turn.into_iter().for_each(&mut *tell);
            if worse {
                tell(Turn::Persists(Trouble::Heat));
            }
        }
        if let (Some(volts), Some(min)) = (signs.voltage_v, bounds.volts_min) {
            let (bad, good) = (volts < min * VOLTS_LOW, volts > min * VOLTS_WELL);
            let turn = self.brown_out.step(Trouble::BrownOut, bad, good, 0.0, dt_secs);
            turn.into_iter().for_each(&mut *tell);
        }
        let strained = signs.strain_rad > bounds.strain_rad;
        self.strained_secs = if strained {
            self.strained_secs + dt_secs
        } else {
            0.0
        };
        let held = self.strained_secs > bounds.strain_secs;
        let share = share(signs.load, bounds);
        let bad = held || share.is_some_and(|share| share >= EFFORT_HIGH);
        let good = !strained && share.is_none_or(|share| share <= EFFORT_LOW);
        let after_secs = if held { 0.0 } else { EFFORT_SECS };
        let turn = self
            .overload
            .step(Trouble::Overload, bad, good, after_secs, dt_secs);
        turn.into_iter().for_each(&mut *tell);
        self.back_off(dt_secs);
    }

    fn back_off(&mut self, dt_secs: f64) {
        let far = if self.overload.on {
            RETREAT_OF_OVERLOAD
        } else if self.heat.on {
            RETREAT_OF_HEAT
        } else {
            0.0
        };
        let step = far - self.retreat;
        self.retreat += step.clamp(-RETURN_PER_SEC * dt_secs, RETREAT_PER_SEC * dt_secs);
    }

    /// The worst that lasts.
    pub(crate) fn worst(&self) -> Option<Trouble> {
        let lasts = [self.brown_out.on, self.overload.on, self.heat.on];
        let named = [Trouble::BrownOut, Trouble::Overload, Trouble::Heat];
        named
            .into_iter()
            .zip(lasts)
            .find(|(_, on)| *on)
            .map(|(trouble, _)| trouble)
    }

    /// Share of the way from goal to joint that the goal retreats, 0 to 1.
    pub(crate) fn retreat(&self) -> f64 {
        self.retreat
    }
}

/// How much of what the servo can pull it pulls.
fn share(load: Option<Load>, bounds: &Bounds) -> Option<f64> {
    match load? {
        Load::Share(share) => Some(share.abs()),
        Load::Amperes(amperes) => bounds.amperes_max.map(|max| amperes.abs() / max),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 0.02;
    const BOUNDS: Bounds = Bounds {
        hot_c: 60.0,
        limit_c: Some(72.0),
        volts_min: Some(6.0),
        amperes_max: Some(2.0),
        strain_rad: 0.6,
        strain_secs: 1.0,
    };

    fn hot(celsius: f64) -> Signs {
        Signs {
            temperature_c: Some(celsius),
            ..Signs::default()
        }
    }

    fn volts(volts: f64) -> Signs {
        Signs {
            voltage_v: Some(volts),
            ..Signs::default()
        }
    }

    fn amperes(amperes: f64) -> Signs {
        Signs {
            load: Some(Load::Amperes(-amperes)),
            ..Signs::default()
        }
    }

    fn far(strain_rad: f64) -> Signs {
        Signs {
            strain_rad,
            load: Some(Load::Share(0.3)),
            ..Signs::default()
        }
    }

    fn run(course: &[(Signs, f64)]) -> (Troubled, Vec<Turn>) {
        let (mut joint, mut turns) = (Troubled::default(), Vec::new());
        for (signs, secs) in course {
            for _ in 0..(secs / DT).round() as usize {
                joint.step(signs, &BOUNDS, DT, &mut |turn| turns.push(turn));
            }
        }
        turns.dedup();
        (joint, turns)
    }

    #[test]
    fn troubles_begin_and_end_with_hysteresis() {
        use Trouble::{BrownOut, Heat, Overload};
        use Turn::{Begins, Ends, Persists};
        type Case<'a> = (&'a str, &'a [(Signs, f64)], &'a [Turn]);
        let cases: [Case<'_>; 12] = [
            ("warm", &[(hot(59.9), 9.0)], &[]),
            ("hot", &[(hot(60.0), 1.0)], &[Begins(Heat)]),
            (
                "not cool enough",
                &[(hot(61.0), 1.0), (hot(56.0), 9.0)],
                &[Begins(Heat)],
            ),
            (
                "cooled down",
                &[(hot(61.0), 1.0), (hot(54.0), 2.0)],
                &[Begins(Heat), Ends(Heat)],
            ),
            (
                "hotter still",
                &[(hot(61.0), 1.0), (hot(68.5), 1.0)],
                &[Begins(Heat), Persists(Heat)],
            ),
            ("volts for a motor, not for long", &[(volts(6.4), 9.0)], &[]),
            (
                "volts low",
                &[(volts(6.2), 0.1), (volts(6.5), 5.0)],
                &[Begins(BrownOut)],
            ),
            (
                "volts back",
                &[(volts(6.2), 0.1), (volts(7.0), 2.0)],
                &[Begins(BrownOut), Ends(BrownOut)],
            ),
            ("a pull", &[(amperes(1.9), 0.4), (amperes(0.2), 9.0)], &[]),
            ("a long pull", &[(amperes(1.9), 0.7)], &[Begins(Overload)]),
            ("far, but not for long", &[(far(0.7), 0.9), (far(0.1), 1.0)], &[]),
            ("far for long", &[(far(0.7), 1.2)], &[Begins(Overload)]),
        ];
        for (what, course, want) in cases {
            assert_eq!(run(course).1, want, "{what}");
        }
    }

    #[test]
    fn what_comes_again_and_again_is_not_helped() {
        let pushes = [(amperes(2.0), 0.6), (amperes(0.1), 1.5)].repeat(4);
        let turns = run(&pushes).1;
        assert_eq!(turns[6], Turn::Persists(Trouble::Overload), "{turns:?}");
        let seldom = [(amperes(2.0), 0.6), (amperes(0.1), 40.0)].repeat(6);
        let turns = run(&seldom).1;
        assert!(!turns.contains(&Turn::Persists(Trouble::Overload)), "{turns:?}");
    }

    #[test]
    fn goals_retreat_fast_and_return_slowly() {
        let (joint, _) = run(&[(amperes(2.0), 0.5)]);
        assert!(joint.retreat() < 0.05);
        let (joint, _) = run(&[(amperes(2.0), 1.1)]);
        assert!((joint.retreat() - 1.0).abs() < 1e-9);
        assert_eq!(joint.worst(), Some(Trouble::Overload));
        let (joint, _) = run(&[(amperes(2.0), 1.1), (amperes(0.1), 2.0)]);
        assert!((0.4..0.6).contains(&joint.retreat()), "{}", joint.retreat());
        let (joint, _) = run(&[(hot(65.0), 3.0)]);
        assert_eq!((joint.retreat(), joint.worst()), (0.5, Some(Trouble::Heat)));
        let (joint, _) = run(&[(volts(5.0), 3.0)]);
        assert_eq!((joint.retreat(), joint.worst()), (0.0, Some(Trouble::BrownOut)));
    }
}
