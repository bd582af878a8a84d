//! One servo of a bus: which joint it turns, how counts become the joint's angle, and what was read from it.
//!
//! Source of the sign rule: puppet profile, "counts are zero_counts + sign · q · counts_per_turn / 2π".

use super::limit::{Limits, LimitsError};
use super::register::{Field, RegisterError};
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
    fields: Fields,
}

/// The rows that the cycle needs, resolved once.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fields {
    pub(super) tick: Field,
    pub(super) load: Field,
    pub(super) load_is_current: bool,
    pub(super) velocity: Field,
    pub(super) position: Field,
    pub(super) profile_velocity: Field,
    pub(super) voltage: Field,
    pub(super) temperature: Field,
}

impl Fields {
    fn of(servo: &ServoProfile) -> Result<Self, RegisterError> {
        // The same address holds "Present Load" on models that cannot measure current.
        let current = Field::named(servo, "Present Current");
        let load_is_current = current.is_ok();
        Ok(Self {
            tick: Field::named(servo, "Realtime Tick")?,
            load: current.or_else(|_| Field::named(servo, "Present Load"))?,
            load_is_current,
            velocity: Field::named(servo, "Present Velocity")?,
            position: Field::named(servo, "Present Position")?,
            profile_velocity: Field::named(servo, "Profile Velocity")?,
            voltage: Field::named(servo, "Present Input Voltage")?,
            temperature: Field::named(servo, "Present Temperature")?,
        })
    }
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
        let fields = match Fields::of(&servo) {
            Ok(fields) => fields,
            Err(source) => return Err(MemberError::Register { joint, source }),
        };
        let unit = fields.profile_velocity.unit_per_count;
        let limits = limits.slower((limits.velocity_max_rad_per_s() / unit).floor().max(1.0) * unit);
        let member = Self {
            joint,
            id,
            servo,
            sign: f64::from(sign),
            zero_counts,
            limits,
            fields,
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

    pub(super) fn fields(&self) -> &Fields {
        &self.fields
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

    /// Profile Velocity for the speed limit, in counts; at least 1, for 0 means unlimited.
    pub(super) fn profile_velocity_counts(&self) -> u32 {
        let counts = self.limits.velocity_max_rad_per_s() / self.fields.profile_velocity.unit_per_count;
        // The limit is a whole number of counts already; the division may fall just short of it.
        (counts + 1e-6).floor().clamp(1.0, 32_767.0) as u32
    }

    /// What a block that starts at `address` says, or the raw position that cannot be one.
    pub(super) fn reading(&self, block: &[u8], address: u16, at: Instant) -> Result<Reading, i64> {
        let missing = i64::MIN;
        let raw = self.fields.position.get(block, address).ok_or(missing)?;
        // A joint turned by hand may leave the turn a little; further than a turn is not a reading.
        let turn = self.servo.counts_per_turn.ceil() as i64;
        if raw <= -turn || raw >= 2 * turn {
            return Err(raw);
        }
        let load = self.fields.load.get_si(block, address).ok_or(missing)?;
        Ok(Reading {
            position_counts: raw,
            position_rad: self.position_rad(raw),
            velocity_rad_per_s: self.sign * self.fields.velocity.get_si(block, address).ok_or(missing)?,
            load: if self.fields.load_is_current {
                Load::Amperes(self.sign * load)
            } else {
                Load::Share(self.sign * load)
            },
            tick: self.fields.tick.get(block, address).ok_or(missing)? as u16,
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
    /// The joint's speed.
    pub velocity_rad_per_s: f64,
    /// Current or load.
    pub load: Load,
    /// The servo's own clock, milliseconds, wraps after 32767.
    pub tick: u16,
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
    /// Hardware Error Status: bit 0 voltage, 2 overheating, 3 encoder, 4 electrical shock, 5 overload.
    pub error_bits: u8,
    /// Torque Enable as last read.
    pub torque: Option<bool>,
}

/// The names of the bits of Hardware Error Status, for messages.
pub fn error_names(bits: u8) -> String {
    let names = [
        (0, "input voltage"),
        (2, "overheating"),
        (3, "encoder"),
        (4, "electrical shock"),
        (5, "overload"),
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
