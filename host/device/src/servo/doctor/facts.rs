//! What was seen on one line, and what was expected there: all that findings are judged from.
//!
//! Plain data, so that a judgement can be tested without a wire.

use device_profiles::{ProfileError, Profiles, PuppetProfile, Role, ServoProfile};

/// What was seen on one line.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// The bus, as messages call it.
    pub bus: String,
    /// The port, for commands in remedies.
    pub port: String,
    /// The line's speed.
    pub baud: u32,
    /// Everybody who answered at that speed, by id.
    pub patients: Vec<Patient>,
    /// Who answered at other speeds.
    pub strays: Vec<Stray>,
    /// Ids whose answers came damaged every time.
    pub garbled_ids: Vec<u8>,
    /// Own packets were heard back.
    pub echo: bool,
    /// Pings that were sent one by one, and those without an answer.
    pub asked: u32,
    /// See `asked`.
    pub lost: u32,
    /// Damaged packets among their answers.
    pub damaged: u32,
    /// How much longer than wire and servo need three in four answers took, or longer, seconds; none: nobody answered.
    /// An adapter keeps every answer back, a busy host some.
    pub held_back_secs: Option<f64>,
    /// The adapter's latency timer, milliseconds, where there is one.
    pub timer_ms: Option<u8>,
}

/// A servo that answered, and what its registers said.
#[derive(Debug, Clone, PartialEq)]
pub struct Patient {
    /// Its id.
    pub id: u8,
    /// What it calls itself.
    pub model_number: u16,
    /// Its firmware.
    pub firmware: u8,
    /// Its table, if anybody has described it, as its firmware has it.
    pub profile: Option<ServoProfile>,
    /// What was read, in counts.
    pub registers: Vec<(Role, i64)>,
    /// Its supply at several moments, volts.
    pub volts: Vec<f64>,
    /// Pings it was sent, and those without an answer.
    pub asked: u32,
    /// See `asked`.
    pub lost: u32,
}

/// A servo that answered at another speed than the line's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stray {
    /// Where it answered.
    pub baud: u32,
    /// Its id.
    pub id: u8,
    /// What it calls itself.
    pub model_number: u16,
}

/// What a puppet's profile says of one bus.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Expected {
    /// The joints on it, in the order in which the profile lists them: that of the chain.
    pub joints: Vec<Joint>,
    /// All models of the builder's, to recognise servos at other speeds.
    pub models: Vec<ServoProfile>,
}

/// A joint with its servo, as the profile has it.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// The servo's id.
    pub id: u8,
    /// The servo's model.
    pub model: ServoProfile,
    /// 1 or -1: whether counts grow with the angle.
    pub sign: f64,
    /// The count at angle 0.
    pub zero_counts: f64,
    /// Its range.
    pub range_rad: [f64; 2],
}

impl Expected {
    /// Nothing in particular: a bus without a puppet.
    pub fn nobody(profiles: &Profiles) -> Self {
        Self {
            joints: Vec::new(),
            models: profiles.servos().cloned().collect(),
        }
    }

    /// What `puppet` has on `bus`. Fails when a servo's model has no profile.
    pub fn of(puppet: &PuppetProfile, bus: &str, profiles: &Profiles) -> Result<Self, ProfileError> {
        let joints = puppet
            .joints_on(bus)
            .map(|joint| {
                Ok(Joint {
                    name: joint.name.clone(),
                    id: joint.id,
                    model: profiles.servo(&joint.model)?.clone(),
                    sign: f64::from(joint.sign),
                    zero_counts: f64::from(joint.zero_counts),
                    range_rad: [joint.min_rad, joint.max_rad],
                })
            })
            .collect::<Result<_, ProfileError>>()?;
        Ok(Self {
            joints,
            models: profiles.servos().cloned().collect(),
        })
    }

    /// The joint whose servo has that id.
    pub fn joint(&self, id: u8) -> Option<&Joint> {
        self.joints.iter().find(|joint| joint.id == id)
    }

    /// The model with that number.
    pub fn model(&self, number: u16) -> Option<&ServoProfile> {
        self.models.iter().find(|model| model.model_number == number)
    }
}

impl Joint {
    /// The counts at both ends of the range, lower first.
    pub fn travel_counts(&self) -> [f64; 2] {
        let at = |rad: f64| self.zero_counts + self.sign * rad / self.model.rad_per_count();
        let [one, other] = self.range_rad.map(at);
        [one.min(other), one.max(other)]
    }

    /// The joint's angle at a count, radians.
    pub fn rad_at(&self, counts: f64) -> f64 {
        self.sign * (counts - self.zero_counts) * self.model.rad_per_count()
    }
}

impl Patient {
    /// What a register said, in counts.
    pub fn get(&self, role: Role) -> Option<i64> {
        self.registers
            .iter()
            .find(|(known, _)| *known == role)
            .map(|(_, value)| *value)
    }

    /// The same in the register's unit.
    pub fn get_si(&self, role: Role) -> Option<f64> {
        let per_count = self.profile.as_ref()?.role(role)?.unit_per_count?;
        Some(self.get(role)? as f64 * per_count)
    }

    /// The median of its supply, volts.
    pub fn voltage(&self) -> Option<f64> {
        median(self.volts.clone())
    }

    /// The model's name, or its number.
    pub fn model_name(&self) -> String {
        match &self.profile {
            Some(profile) => profile.name.clone(),
            None => format!("model number {}", self.model_number),
        }
    }
}

impl Seen {
    /// The servo with that id.
    pub fn patient(&self, id: u8) -> Option<&Patient> {
        self.patients.iter().find(|patient| patient.id == id)
    }
}

/// The value that a quarter lies below; none of nothing.
pub(super) fn lower_quartile(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 4).copied()
}

/// The value in the middle; none of nothing.
pub(super) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
