//! Poses given joint by joint: each joint goes smoothly through the keys that name it.

use std::collections::BTreeMap;

use super::JointPath;
use crate::curve::{Curve, Natural, Smooth};
use thiserror::Error;

/// Angles of some joints at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointKey {
    /// When it is meant to be met, seconds.
    pub secs: f64,
    /// Angles by the joint's name, radians. A joint that is not named passes by on its way to the next key
    /// that names it.
    pub angles_rad: BTreeMap<String, f64>,
}

/// Why keys make no path.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum KeyedJointsError {
    /// There is nothing to go through.
    #[error("there is no key; store one")]
    NoKeys,
    /// A key names a joint that the puppet does not have.
    #[error("key {key} names joint {joint}, which the puppet does not have; it has {known}")]
    NoSuchJoint {
        /// The key, from 0.
        key: usize,
        /// The name it gives.
        joint: String,
        /// The joints there are.
        known: String,
    },
    /// An angle is NaN or infinite.
    #[error("key {key}: the angle of joint {joint} is not finite")]
    NotFinite {
        /// The key, from 0.
        key: usize,
        /// The joint.
        joint: String,
    },
}

/// The path through keys over key coordinate 0 to n: for every joint the natural cubic through the keys that
/// name it, held before the first and after the last of them; `rest_rad` for a joint that no key names.
/// Couplings are the caller's: a joint that follows another is best left out of `joints`.
pub fn keyed<'k>(
    joints: &[String],
    rest_rad: &[f64],
    keys: &(impl ExactSizeIterator<Item = &'k JointKey> + Clone),
) -> Result<JointPath, KeyedJointsError> {
    let count = keys.len();
    if count == 0 {
        return Err(KeyedJointsError::NoKeys);
    }
    check(joints, keys.clone())?;
    let mut cubics = vec![[0.0; 4]; (count - 1) * joints.len()];
    let mut last_rad = Vec::with_capacity(joints.len());
    for (place, joint) in joints.iter().enumerate() {
        let named = keys.clone().enumerate();
        let named = named.filter_map(|(key, at)| Some((key as f64, *at.angles_rad.get(joint)?)));
        let (at, values): (Vec<f64>, Vec<f64>) = named.unzip();
        let rest = rest_rad.get(place).copied().unwrap_or(0.0);
        // The abscissae are key numbers, increasing, and the values were checked.
        let Ok(curve) = Natural::new(&at, &values) else {
            cubics
                .iter_mut()
                .skip(place)
                .step_by(joints.len())
                .for_each(|c| c[0] = rest);
            last_rad.push(rest);
            continue;
        };
        let domain = curve.domain();
        for (key, into) in cubics.iter_mut().skip(place).step_by(joints.len()).enumerate() {
            let u = key as f64;
            *into = if (domain.start..domain.end).contains(&u) {
                let d = |order| curve.derivative(u, order);
                [d(0), d(1), d(2) / 2.0, d(3) / 6.0]
            } else {
                [curve.eval(u), 0.0, 0.0, 0.0]
            };
        }
        last_rad.push(curve.eval((count - 1) as f64));
    }
    Ok(JointPath {
        joints: joints.to_vec(),
        knots: (0..count).map(|key| key as f64).collect(),
        cubics,
        last_rad,
        strains: Vec::new(),
    })
}

fn check<'k>(joints: &[String], keys: impl Iterator<Item = &'k JointKey>) -> Result<(), KeyedJointsError> {
    for (key, at) in keys.enumerate() {
        for (joint, angle) in &at.angles_rad {
            if !joints.contains(joint) {
                return Err(KeyedJointsError::NoSuchJoint {
                    key,
                    joint: joint.clone(),
                    known: joints.join(", "),
                });
            }
            if !angle.is_finite() {
                return Err(KeyedJointsError::NotFinite {
                    key,
                    joint: joint.clone(),
                });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(secs: f64, angles: &[(&str, f64)]) -> JointKey {
        JointKey {
            secs,
            angles_rad: angles.iter().map(|(j, a)| ((*j).to_owned(), *a)).collect(),
        }
    }

    #[test]
    fn a_joint_passes_keys_that_do_not_name_it() {
        let joints = ["a", "b", "c"].map(str::to_owned);
        let keys = [
            key(0.0, &[("a", 0.0), ("b", 1.0)]),
            key(1.0, &[("a", 0.5)]),
            key(2.0, &[("a", 0.0), ("b", 3.0)]),
            key(3.0, &[("a", -0.5)]),
        ];
        let path = keyed(&joints, &[0.0, 0.0, 0.7], &keys.iter()).expect("a path");
        let at = |u| {
            let mut angles = [0.0; 3];
            path.angles(u, &mut angles);
            angles
        };
        // Two keys make a straight line, held after the last; the third joint rests.
        assert_eq!((at(1.0)[1], at(2.5)[1], at(3.0)[1]), (2.0, 3.0, 3.0));
        assert_eq!((at(0.3)[2], at(9.0)[2]), (0.7, 0.7));
        for (u, want) in [(0.0, 0.0), (1.0, 0.5), (2.0, 0.0), (3.0, -0.5)] {
            assert!((at(u)[0] - want).abs() < 1e-12, "at {u}");
        }
    }

    #[test]
    fn keys_that_cannot_be_passed() {
        let joints = ["a".to_owned()];
        let refused = |keys: &[JointKey]| keyed(&joints, &[0.0], &keys.iter()).err();
        assert_eq!(refused(&[]), Some(KeyedJointsError::NoKeys));
        assert!(matches!(
            refused(&[key(0.0, &[("z", 0.0)])]),
            Some(KeyedJointsError::NoSuchJoint { key: 0, .. })
        ));
        assert!(matches!(
            refused(&[key(0.0, &[]), key(1.0, &[("a", f64::NAN)])]),
            Some(KeyedJointsError::NotFinite { key: 1, .. })
        ));
    }
}
