//! One servo of a bus: which joint it turns, how counts become the joint's angle, and what was read from it.
//!
//! Source of the sign rule: puppet profile, "counts are zero_counts + sign · q · counts_per_turn / 2π".

use super::limit::{Limits, LimitsError};
use super::register::{Field, RegisterError};
use super::settings::Readings;
use super::table::Table;
use crate::clock::Instant;
use device_profiles::{PuppetJoint, ServoProfile};
use std::time::Duration;

/// Why a servo cannot be a member.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MemberError {
    /// The limits are no limits.
    #[error("joint \"{joint}\": {source}")]
    Limits {
        /// The joint's name.
        joint: String,
        /// What is wrong.
        source: LimitsError,
    },
    /// The control table lacks what driving needs.
    #[error("joint \"{joint}\": {source}")]
    Register {
        /// The joint's name.
        joint: String,
        /// What is wrong.
        source: RegisterError,
    },
    /// The joint's range would leave the servo's own, beyond which it stops or its counts wrap.
    #[error(
        "joint \"{joint}\": its range of {min_counts} to {max_counts} counts leaves the servo's range of {first_counts} to \
         {last_counts}: mount the horn so that the range lies inside, and set zero_counts accordingly"
    )]
    Turn {
        /// The joint's name.
        joint: String,
        /// Counts at the range's lower end.
        min_counts: i64,
        /// Counts at the range's upper end.
        max_counts: i64,
        /// Lowest count the servo can go to.
        first_counts: i64,
        /// Highest count the servo can go to.
        last_counts: i64,
    },
    /// Anything but one or minus one.
    #[error("joint \"{joint}\": sign {sign}, expected 1 or -1")]
    Sign {
        /// The joint's name.
        joint: String,
        /// As given.
        sign: i8,
    },
    /// Not a servo's id.
    #[error("joint \"{joint}\": id {id}, expected 0 to 252")]
    Id {
        /// The joint's name.
        joint: String,
        /// As given.
        id: u8,
    },
}

/// One servo and the joint it turns. Valid by construction.
#[derive(Debug, Clone)]
pub struct Member {
    joint: String,
    id: u8,
    servo: ServoProfile,
    sign: f64,
    zero_counts: i32,
    limits: Limits,
}

impl Member {
    /// Checks everything that can be checked without the servo.
    /// The speed limit is lowered to the next whole count of Profile Velocity, so that the servo can keep up
    /// with every goal it is given while its own profile never exceeds the limit.
    pub fn new(
        joint: &str,
        id: u8,
        servo: ServoProfile,
        sign: i8,
        zero_counts: i32,
        limits: Limits,
    ) -> Result<Self, MemberError> {
        let joint = joint.to_owned();
        if sign != 1 && sign != -1 {
            return Err(MemberError::Sign { joint, sign });
        }
        if id > super::framing::dynamixel2::ID_MAX {
            return Err(MemberError::Id { joint, id });
        }
        if let Err(source) = Table::of(&servo, Readings::Motion) {
            return Err(MemberError::Register { joint, source });
        }
        let limits = match servo
            .move_velocity()
            .map(|row| Field::of(&servo, row).unit_per_count)
        {
            Some(unit) => limits.slower((limits.velocity_max_rad_per_s() / unit).floor().max(1.0) * unit),
            None => limits,
        };
        let member = Self {
            joint,
            id,
            servo,
            sign: f64::from(sign),
            zero_counts,
            limits,
        };
        let [min_counts, max_counts] = member.range_counts();
        let [first_counts, last_counts] = member.servo.position_counts;
        if min_counts < first_counts || max_counts > last_counts {
            return Err(MemberError::Turn {
                joint: member.joint,
                min_counts,
                max_counts,
                first_counts,
                last_counts,
            });
        }
        Ok(member)
    }

    /// The member that a puppet's joint describes.
    pub fn of_joint(joint: &PuppetJoint, servo: &ServoProfile) -> Result<Self, MemberError> {
        let limits = Limits::new(
            [joint.min_rad, joint.max_rad],
            joint.speed_max_rad_per_s,
            joint.accel_max_rad_per_s2,
        )
        .and_then(|limits| match joint.jerk_max_rad_per_s3 {
            Some(jerk_max) => limits.with_jerk(jerk_max),
            None => Ok(limits),
        })
        .map_err(|source| MemberError::Limits {
            joint: joint.name.clone(),
            source,
        })?;
        Self::new(
            &joint.name,
            joint.id,
            servo.clone(),
            joint.sign,
            joint.zero_counts,
            limits,
        )
    }

    /// The joint's name.
    pub fn joint(&self) -> &str {
        &self.joint
    }

    /// The servo's id.
    pub fn id(&self) -> u8 {
        self.id
    }

    /// The servo's model.
    pub fn servo(&self) -> &ServoProfile {
        &self.servo
    }

    /// The limits its goals keep.
    pub fn limits(&self) -> Limits {
        self.limits
    }

    /// The joint's angle at a count of Present Position.
    pub fn position_rad(&self, counts: i64) -> f64 {
        self.sign * (counts - i64::from(self.zero_counts)) as f64 * self.servo.rad_per_count()
    }

    /// The nearest count inside the servo's turn; the joint's angle must be finite.
    pub fn position_counts(&self, rad: f64) -> i64 {
        let counts = f64::from(self.zero_counts) + self.sign * rad / self.servo.rad_per_count();
        let [first, last] = self.servo.position_counts;
        (counts.round() as i64).clamp(first, last)
    }

    /// Counts at the ends of the joint's range, the lower first.
    pub fn range_counts(&self) -> [i64; 2] {
        let at = |rad: f64| {
            (f64::from(self.zero_counts) + self.sign * rad / self.servo.rad_per_count()).round() as i64
        };
        let ends = [at(self.limits.min_rad()), at(self.limits.max_rad())];
        if self.sign > 0.0 { ends } else { [ends[1], ends[0]] }
    }

    /// What the register for the speed of moves holds at the speed limit; at least 1, for 0 means unlimited.
    pub(super) fn speed_counts(&self, speed: Field) -> i64 {
        let counts = self.limits.velocity_max_rad_per_s() / speed.unit_per_count;
        // The limit is a whole number of counts already; the division may fall just short of it.
        speed.raw((counts + 1e-6).floor().max(1.0) * speed.unit_per_count)
    }

    /// What a block that starts at `start` and holds the rows of the status block says, or the raw position that
    /// cannot be one. Where the servo does not tell its speed it follows from the reading `before`.
    pub(super) fn reading(
        &self,
        table: &Table,
        block: &[u8],
        start: u16,
        at: Instant,
        before: Option<Reading>,
    ) -> Result<Reading, i64> {
        let raw = table.position.get(block, start).ok_or(i64::MIN)?;
        // A joint turned by hand may leave the turn a little; further than a turn is not a reading.
        let turn = self.servo.counts_per_turn.ceil() as i64;
        if raw <= -turn || raw >= 2 * turn {
            return Err(raw);
        }
        let position_rad = self.position_rad(raw);
        let si = |row: Option<Field>| table.in_status(row).and_then(|row| row.get_si(block, start));
        let velocity_rad_per_s = match (si(table.velocity), before) {
            (Some(velocity), _) => self.sign * velocity,
            (None, Some(before)) if at > before.at => {
                (position_rad - before.position_rad) / at.since(before.at).as_secs_f64()
            }
            (None, _) => 0.0,
        };
        let load = si(table.load).map(|load| {
            if table.load_is_current {
                Load::Amperes(self.sign * load)
            } else {
                Load::Share(self.sign * load)
            }
        });
        let tick = table.in_status(table.tick).and_then(|row| row.get(block, start));
        Ok(Reading {
            position_counts: raw,
            position_rad,
            velocity_rad_per_s,
            load,
            tick: tick.map(|tick| tick as u16),
            at,
        })
    }
}

/// How hard a servo works, as far as its model can tell; positive drives the joint's angle up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Load {
    /// Measured current.
    Amperes(f64),
    /// Inferred share of the greatest torque, -1 to 1.
    Share(f64),
}

/// One fresh answer of a servo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Present Position as sent.
    pub position_counts: i64,
    /// The joint's angle.
    pub position_rad: f64,
    /// The joint's speed; where the servo does not tell it, by the last two positions.
    pub velocity_rad_per_s: f64,
    /// Current or load, if it is read.
    pub load: Option<Load>,
    /// The servo's own clock, milliseconds, wraps after 32767; none where it has none.
    pub tick: Option<u16>,
    /// When the servo measured, as well as the wire allows to tell.
    pub at: Instant,
}

impl Reading {
    /// How old it is.
    pub fn age(&self, now: Instant) -> Duration {
        now.since(self.at)
    }
}

/// What is read in turn, more slowly than positions.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Supply {
    /// Volts at the servo; none until read.
    pub voltage_v: Option<f64>,
    /// Degrees Celsius in the servo; none until read.
    pub temperature_c: Option<f64>,
    /// What is wrong with the servo, whatever its family's own bits: bit 0 voltage, 2 overheating, 3 encoder,
    /// 4 electrical shock, 5 overload, 6 current.
    pub error_bits: u8,
    /// Torque Enable as last read.
    pub torque: Option<bool>,
}

/// The names of the bits of [`Supply::error_bits`], for messages.
pub fn error_names(bits: u8) -> String {
    let names = [
        (0, "input voltage"),
        (2, "overheating"),
        (3, "encoder"),
        (4, "electrical shock"),
        (5, "overload"),
        (6, "current"),
    ];
    let found: Vec<&str> = names
        .iter()
        .filter(|(bit, _)| bits >> bit & 1 == 1)
        .map(|(_, name)| *name)
        .collect();
    if found.is_empty() {
        format!("bits {bits:#04x}")
    } else {
        found.join(", ")
    }
}
