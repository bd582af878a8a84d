//! Hands on horns: a person who turns, holds, pulls and lets go of a puppet's joints.
//!
//! Not a rig's doing and not a device's: what the servos make of it (yield, measure, pull back, switch off) is theirs.

use super::words::{Parsed, Words};
use crate::stand::{HandError, Stand};

/// What a hand does with a joint.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct HornHand {
    joint: String,
    what: Grasp,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Grasp {
    /// To this angle of the joint.
    To {
        rad: f64,
        over_secs: f64,
    },
    /// So far from where it is.
    By {
        rad: f64,
        over_secs: f64,
    },
    Pull {
        nm: f64,
    },
    LetGo,
}

impl HornHand {
    /// Reads what stands behind `hand`.
    pub(super) fn parse(words: &mut Words<'_>) -> Parsed<Self> {
        let verb = words.one_of(&["turns", "holds", "pulls", "lets"])?;
        if verb == 3 {
            words.expect("go")?;
            words.expect("of")?;
        }
        let joint = words.text("a joint")?;
        let what = match verb {
            0 => {
                let by = words.one_of(&["to", "by"])? == 1;
                let rad = words.angle("an angle")?;
                let over_secs = if words.take("over") {
                    words.secs("a duration in seconds")?
                } else {
                    0.0
                };
                if by {
                    Grasp::By { rad, over_secs }
                } else {
                    Grasp::To { rad, over_secs }
                }
            }
            1 => Grasp::By {
                rad: 0.0,
                over_secs: 0.0,
            },
            2 => {
                words.expect("with")?;
                let nm = words.number("newton metres", -100.0..=100.0)?;
                words.take("Nm");
                Grasp::Pull { nm }
            }
            _ => Grasp::LetGo,
        };
        Ok(Self { joint, what })
    }

    /// Lays the hand on the joint.
    pub(super) fn act(&self, stand: &Stand) -> Result<(), HandError> {
        let joint = &self.joint;
        match self.what {
            Grasp::To { rad, over_secs } => stand.guide(joint, rad, over_secs),
            Grasp::By { rad, over_secs } => {
                let from_rad = stand.joint(joint)?.position_rad;
                stand.guide(joint, from_rad + rad, over_secs)
            }
            Grasp::Pull { nm } => stand.pull(joint, nm),
            Grasp::LetGo => stand.let_go(joint),
        }
    }
}
