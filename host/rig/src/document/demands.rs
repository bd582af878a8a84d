//! What a show demands of its puppet: tighter limits of joints, and another policy for trouble.
//!
//! A show can only tighten: what a puppet may do at most is said in its profile, by whoever built it.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use device_profiles::{PuppetProfile, Reaction};

use super::fault::Findings;
use super::fields::{self, Fields, Placed};

/// Tighter limits of one joint; what is not said stays the profile's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointDemand {
    /// Smallest angle.
    pub min_rad: Option<f64>,
    /// Largest angle.
    pub max_rad: Option<f64>,
    /// Never faster than this.
    pub speed_max_rad_per_s: Option<f64>,
    /// Never gains or loses speed faster than this.
    pub accel_max_rad_per_s2: Option<f64>,
}

/// See the module.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Demands {
    /// By the joint's name.
    pub limits: BTreeMap<String, JointDemand>,
    /// A servo is hot.
    pub on_heat: Option<Reaction>,
    /// A servo works at the edge of what it can.
    pub on_overload: Option<Reaction>,
    /// A supply falls.
    pub on_brownout: Option<Reaction>,
    /// The host is gone: hold or release.
    pub on_lost_host: Option<Reaction>,
    /// Degrees Celsius that count as hot; lower than the profile's.
    pub hot_c: Option<f64>,
}

/// A demand that cannot be met.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DemandError {
    /// No such joint.
    #[error("the show limits joint \"{joint}\", which puppet {puppet} does not have; it has: {known}")]
    UnknownJoint {
        /// As in the show.
        joint: String,
        /// The puppet.
        puppet: String,
        /// Its joints.
        known: String,
    },
    /// A show may only tighten.
    #[error(
        "the show asks for {what} {wanted} where puppet {puppet} has {limit}: a show can only tighten a puppet's limits"
    )]
    Looser {
        /// Which limit of what.
        what: String,
        /// As in the show.
        wanted: f64,
        /// The profile's.
        limit: f64,
        /// The puppet.
        puppet: String,
    },
    /// Nothing is left of a range.
    #[error("the show leaves joint \"{joint}\" of puppet {puppet} no range: {min_rad} to {max_rad} rad")]
    NoRange {
        /// The joint.
        joint: String,
        /// The puppet.
        puppet: String,
        /// Lower end.
        min_rad: f64,
        /// Upper end.
        max_rad: f64,
    },
}

const REACTIONS: [(&str, Reaction); 3] = [
    ("back-off", Reaction::BackOff),
    ("hold", Reaction::Hold),
    ("release", Reaction::Release),
];
/// Without a host nobody moves.
const LOST_HOST: [(&str, Reaction); 2] = [("hold", Reaction::Hold), ("release", Reaction::Release)];

impl Demands {
    /// The puppet as the show wants it.
    pub fn of(&self, profile: &PuppetProfile) -> Result<PuppetProfile, DemandError> {
        let mut wanted = profile.clone();
        for (name, demand) in &self.limits {
            let mut joints = wanted.groups.iter_mut().flat_map(|group| &mut group.joints);
            let Some(joint) = joints.find(|joint| joint.name == *name) else {
                let known: Vec<&str> = profile.joints().map(|joint| joint.name.as_str()).collect();
                return Err(DemandError::UnknownJoint {
                    joint: name.clone(),
                    puppet: profile.name.clone(),
                    known: known.join(", "),
                });
            };
            let tighten = |what: &str, limit: &mut f64, wanted: Option<f64>, sign: f64| match wanted {
                Some(wanted) if (wanted - *limit) * sign > 0.0 => Err(DemandError::Looser {
                    what: format!("{what} of joint \"{name}\""),
                    wanted,
                    limit: *limit,
                    puppet: profile.name.clone(),
                }),
                Some(wanted) => {
                    *limit = wanted;
                    Ok(())
                }
                None => Ok(()),
            };
            tighten("min_rad", &mut joint.min_rad, demand.min_rad, -1.0)?;
            tighten("max_rad", &mut joint.max_rad, demand.max_rad, 1.0)?;
            let speed = demand.speed_max_rad_per_s;
            tighten("speed_max_rad_per_s", &mut joint.speed_max_rad_per_s, speed, 1.0)?;
            let accel = demand.accel_max_rad_per_s2;
            tighten(
                "accel_max_rad_per_s2",
                &mut joint.accel_max_rad_per_s2,
                accel,
                1.0,
            )?;
            if joint.min_rad >= joint.max_rad {
                return Err(DemandError::NoRange {
                    joint: name.clone(),
                    puppet: profile.name.clone(),
                    min_rad: joint.min_rad,
                    max_rad: joint.max_rad,
                });
            }
        }
        self.choose(&mut wanted)?;
        Ok(wanted)
    }

    fn choose(&self, wanted: &mut PuppetProfile) -> Result<(), DemandError> {
        let policy = &mut wanted.policy;
        policy.on_heat = self.on_heat.unwrap_or(policy.on_heat);
        policy.on_overload = self.on_overload.unwrap_or(policy.on_overload);
        policy.on_brownout = self.on_brownout.unwrap_or(policy.on_brownout);
        policy.on_lost_host = self.on_lost_host.unwrap_or(policy.on_lost_host);
        if let Some(hot_c) = self.hot_c {
            if hot_c > policy.hot_c {
                return Err(DemandError::Looser {
                    what: "hot_c".to_owned(),
                    wanted: hot_c,
                    limit: policy.hot_c,
                    puppet: wanted.name.clone(),
                });
            }
            policy.hot_c = hot_c;
        }
        Ok(())
    }

    /// Reads `[limits.JOINT]` and `[policy]`.
    pub(super) fn read(file: &mut Fields<'_>, found: &mut Findings) -> Self {
        let mut demands = Self::default();
        let limits = file.optional("limits").and_then(|value| value.entries(found));
        for (joint, _, value) in limits.unwrap_or_default() {
            if let Some(demand) = read_joint(value, found) {
                demands.limits.insert(joint.to_owned(), demand);
            }
        }
        if let Some(mut policy) = file.optional("policy").and_then(|value| value.fields(found)) {
            let mut reaction = |key, words: &[(&str, Reaction)]| {
                let value = policy.optional(key)?;
                value.choice(words, found)
            };
            demands.on_heat = reaction("on_heat", &REACTIONS);
            demands.on_overload = reaction("on_overload", &REACTIONS);
            demands.on_brownout = reaction("on_brownout", &REACTIONS);
            demands.on_lost_host = reaction("on_lost_host", &LOST_HOST);
            demands.hot_c = policy.optional("hot_c").and_then(|value| value.number(found));
            policy.finish(found);
        }
        demands
    }

    /// The same as text; empty when nothing is demanded.
    pub(super) fn write(&self, out: &mut String) {
        // Writing to a string cannot fail.
        for (joint, demand) in &self.limits {
            let _ = write!(out, "\n[limits.{}]\n", fields::key(joint));
            for (key, value) in [
                ("min_rad", demand.min_rad),
                ("max_rad", demand.max_rad),
                ("speed_max_rad_per_s", demand.speed_max_rad_per_s),
                ("accel_max_rad_per_s2", demand.accel_max_rad_per_s2),
            ] {
                let _ = value.map_or(Ok(()), |value| writeln!(out, "{key} = {value:?}"));
            }
        }
        let chosen = [
            ("on_heat", self.on_heat),
            ("on_overload", self.on_overload),
            ("on_brownout", self.on_brownout),
            ("on_lost_host", self.on_lost_host),
        ];
        if chosen.iter().all(|(_, reaction)| reaction.is_none()) && self.hot_c.is_none() {
            return;
        }
        out.push_str("\n[policy]\n");
        for (key, reaction) in chosen {
            let word = REACTIONS.iter().find(|(_, known)| Some(*known) == reaction);
            let _ = word.map_or(Ok(()), |(word, _)| writeln!(out, "{key} = \"{word}\""));
        }
        let _ = self
            .hot_c
            .map_or(Ok(()), |hot_c| writeln!(out, "hot_c = {hot_c:?}"));
    }
}

fn read_joint(value: Placed<'_>, found: &mut Findings) -> Option<JointDemand> {
    let mut fields = value.fields(found)?;
    let demand = JointDemand {
        min_rad: fields.optional("min_rad").and_then(|v| v.number(found)),
        max_rad: fields.optional("max_rad").and_then(|v| v.number(found)),
        speed_max_rad_per_s: fields
            .optional("speed_max_rad_per_s")
            .and_then(|v| v.above_zero(found)),
        accel_max_rad_per_s2: fields
            .optional("accel_max_rad_per_s2")
            .and_then(|v| v.above_zero(found)),
    };
    fields.finish(found);
    Some(demand)
}

#[cfg(test)]
mod tests {
    use super::*;
    use device_profiles::Profiles;

    fn demand(change: fn(&mut JointDemand)) -> Demands {
        let mut one = JointDemand::default();
        change(&mut one);
        Demands {
            limits: BTreeMap::from([("pan".to_owned(), one)]),
            ..Demands::default()
        }
    }

    #[test]
    fn a_show_tightens_and_never_loosens() {
        let profiles = Profiles::builtin();
        let starter = profiles.puppet("starter").expect("it is built in");
        let tight = demand(|it| (it.max_rad, it.speed_max_rad_per_s) = (Some(0.5), Some(1.0)));
        let wanted = tight.of(starter).expect("it is tighter");
        let pan = wanted.joint("pan").expect("there");
        assert_eq!(
            (pan.min_rad, pan.max_rad, pan.speed_max_rad_per_s),
            (-1.57, 0.5, 1.0)
        );
        assert_eq!(wanted.joint("tilt"), starter.joint("tilt"));
        for (demands, text) in [
            (
                demand(|it| it.max_rad = Some(2.0)),
                "max_rad of joint \"pan\" 2 where",
            ),
            (
                demand(|it| it.min_rad = Some(-2.0)),
                "min_rad of joint \"pan\" -2 where",
            ),
            (
                demand(|it| it.speed_max_rad_per_s = Some(7.0)),
                "can only tighten",
            ),
            (
                demand(|it| it.accel_max_rad_per_s2 = Some(41.0)),
                "can only tighten",
            ),
            (
                demand(|it| (it.min_rad, it.max_rad) = (Some(0.5), Some(0.4))),
                "no range: 0.5 to 0.4 rad",
            ),
            (
                Demands {
                    limits: BTreeMap::from([("nose".to_owned(), JointDemand::default())]),
                    ..Demands::default()
                },
                "\"nose\", which puppet Two-servo starter does not have; it has: pan, tilt",
            ),
            (
                Demands {
                    hot_c: Some(70.0),
                    ..Demands::default()
                },
                "hot_c 70 where",
            ),
        ] {
            let error = demands.of(starter).expect_err(text).to_string();
            assert!(error.contains(text), "{error}");
        }
    }

    #[test]
    fn a_show_chooses_the_policy() {
        let profiles = Profiles::builtin();
        let starter = profiles.puppet("starter").expect("it is built in");
        let demands = Demands {
            on_heat: Some(Reaction::Release),
            on_lost_host: Some(Reaction::Release),
            hot_c: Some(50.0),
            ..Demands::default()
        };
        let policy = demands.of(starter).expect("it is a choice").policy;
        assert_eq!(
            (policy.on_heat, policy.on_lost_host),
            (Reaction::Release, Reaction::Release)
        );
        assert_eq!(
            (policy.on_overload, policy.hot_c),
            (starter.policy.on_overload, 50.0)
        );
    }
}
