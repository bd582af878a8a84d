//! Words for calibrating: `calibrate begin|zero|end` of a puppet, others of a control; and what came of it.

use rig::Command;
use rig::calibration::{Proposal, Reading, Zero};

use super::controls;
use super::doing::Doing;
use super::words::{Parsed, Words};
use crate::stand::HandError;
use crate::world::World;

/// One step of a calibration.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Calibrate {
    Begin { joint: Option<String> },
    Zero,
    End(Reading),
}

impl Calibrate {
    /// Reads what stands behind `calibrate`.
    pub(super) fn parse(words: &mut Words<'_>) -> Parsed<Doing> {
        let steps: Vec<&str> = ["begin", "zero", "end"]
            .into_iter()
            .chain(controls::STEPS)
            .collect();
        let step = match words.one_of(&steps)? {
            0 => Self::Begin {
                joint: if words.take("joint") {
                    Some(words.text("a joint")?)
                } else {
                    None
                },
            },
            1 => Self::Zero,
            of_control @ 3.. => {
                let asked = controls::calibrate(steps[of_control], words)?;
                return Ok(Doing::Ask(Command::CalibrateControl(asked)));
            }
            _ => {
                let mut reading = Reading::default();
                if words.take("in") {
                    words.expect("the")?;
                    words.expect("middle")?;
                    reading.zero = Zero::Middle;
                }
                if words.take("keeping") {
                    words.expect("signs")?;
                    reading.keep_signs = true;
                }
                Self::End(reading)
            }
        };
        Ok(Doing::Calibrate(step))
    }

    pub(super) fn act(&self, world: &mut World) -> Result<(), HandError> {
        match self {
            Self::Begin { joint } => world.begin_calibration(joint.as_deref()),
            Self::Zero => world.mark_zero(),
            Self::End(reading) => world.end_calibration(*reading),
        }
    }
}

/// What a calibration is expected to have come to.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Calibrated {
    joint: String,
    /// Words of the refusal; none: it is possible.
    refused: Option<String>,
}

impl Calibrated {
    /// Reads what stands behind `calibration`.
    pub(super) fn parse(words: &mut Words<'_>) -> Parsed<Self> {
        words.expect("of")?;
        let joint = words.text("a joint")?;
        words.expect("is")?;
        let refused = match words.one_of(&["possible", "refused"])? {
            0 => None,
            _ => Some(words.quoted("words of the refusal")?),
        };
        Ok(Self { joint, refused })
    }

    pub(super) fn judge(&self, proposals: &[Proposal]) -> Result<(), String> {
        let joint = &self.joint;
        let of = proposals.iter().find(|proposal| proposal.joint == *joint);
        match (of.map(|proposal| &proposal.plan), &self.refused) {
            (None, _) => Err(format!("{joint} was not calibrated")),
            (Some(Ok(_)), None) => Ok(()),
            (Some(Err(refusal)), Some(words)) if refusal.to_string().contains(words) => Ok(()),
            (Some(Ok(plan)), Some(_)) => Err(format!("calibration of {joint} is possible: {plan:?}")),
            (Some(Err(refusal)), _) => Err(format!("calibration of {joint} is refused: {refusal}")),
        }
    }
}
