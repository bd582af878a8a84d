//! Teaching: the puppet itself is the mannequin. Its torque is off, hands pose it, what is measured is what is seen, and
//! a word stores it as a key.

use std::collections::BTreeMap;

use super::Rig;
use crate::command::{Command, EditCommand, PuppetCommand, PuppetPose, TeachCommand, TransportCommand};
use crate::snapshot::{JointView, NoteLevel, PuppetState, PuppetView};

/// A measurement older than this says nothing of where a hand has put the joint: some ten of a slow bus's rounds.
const FRESH_SECS: f64 = 0.5;
/// A joint that yields gives way when a hand has it this far from where it stands: two degrees, so that its own weight
/// does not creep away with it.
const YIELDS_AT_RAD: f64 = 0.035;

/// Joints that stand while others are taught.
#[derive(Debug, Default)]
pub(super) struct Held {
    /// Where each of them stands, radians.
    joints: BTreeMap<String, f64>,
    /// Where the others were last asked to be.
    yielding: BTreeMap<String, f64>,
    /// Torque was asked for, for their sake.
    asked_for_torque: bool,
}

impl Held {
    /// Where a joint is to be: where it is held, or behind the hand that moves it.
    fn goal_rad(&mut self, joint: &JointView) -> f64 {
        let measured_rad = joint.measured_rad.unwrap_or(0.0);
        if let Some(held_rad) = self.joints.get(&joint.name) {
            return *held_rad;
        }
        let goal_rad = self.yielding.entry(joint.name.clone()).or_insert(measured_rad);
        let off_rad = measured_rad - *goal_rad;
        *goal_rad += off_rad - off_rad.clamp(-YIELDS_AT_RAD, YIELDS_AT_RAD);
        *goal_rad
    }
}

impl Rig {
    pub(super) fn teach(&mut self, teach: &TeachCommand) -> Result<(), String> {
        match teach {
            TeachCommand::Begin => {
                self.order_puppet(&PuppetCommand::Release)?;
                self.teaching = true;
                self.note(
                    NoteLevel::Info,
                    "teaching: torque is off; pose the puppet by hand, and store each pose",
                );
                Ok(())
            }
            TeachCommand::Store { step_secs } => self.store_taught(*step_secs),
            TeachCommand::Hold { joint, on } => self.hold_joint(joint, *on),
            TeachCommand::End => {
                self.teaching = false;
                self.let_all_yield()
            }
        }
    }

    /// Whether hands pose the puppet.
    pub(super) fn is_teaching(&self) -> bool {
        self.teaching
    }

    /// Orders that make it move end the teaching.
    pub(super) fn end_teaching_by(&mut self, order: &PuppetCommand) {
        let moves = matches!(
            order,
            PuppetCommand::Arm | PuppetCommand::Play | PuppetCommand::Follow
        );
        self.teaching &= !moves;
        // Whoever orders anything else of the puppet has it for himself.
        self.held = Held::default();
    }

    fn hold_joint(&mut self, joint: &str, on: bool) -> Result<(), String> {
        if !self.teaching {
            return Err("nobody is teaching; begin first".into());
        }
        let seen = self.measured()?;
        let Some(view) = seen.joints.iter().find(|view| view.name == joint) else {
            let known: Vec<&str> = seen.joints.iter().map(|view| view.name.as_str()).collect();
            return Err(format!(
                "puppet {} has no joint {joint}; it has: {}",
                seen.name,
                known.join(", ")
            ));
        };
        if let (true, Some(angle_rad)) = (on, view.measured_rad) {
            self.held.joints.insert(joint.to_owned(), angle_rad);
            return Ok(());
        }
        self.held.joints.remove(joint);
        self.held.yielding.remove(joint);
        if self.held.joints.is_empty() {
            return self.let_all_yield();
        }
        Ok(())
    }

    /// No joint is held any more: torque goes off.
    fn let_all_yield(&mut self) -> Result<(), String> {
        let had_torque = self.held.asked_for_torque;
        self.held = Held::default();
        if had_torque {
            self.order_puppet(&PuppetCommand::Release)?;
        }
        Ok(())
    }

    /// While joints are held: asks for torque, then lets those joints stand and all others go where the hand has them.
    fn hold_on(&mut self, seen: &PuppetView) -> Result<(), String> {
        if self.held.joints.is_empty() {
            return Ok(());
        }
        match seen.state {
            PuppetState::Released if !self.held.asked_for_torque => {
                self.held.asked_for_torque = true;
                self.order_puppet(&PuppetCommand::Arm)
            }
            PuppetState::Holding | PuppetState::Playing => {
                let angles: Vec<f64> = seen
                    .joints
                    .iter()
                    .map(|joint| self.held.goal_rad(joint))
                    .collect();
                if let Some(puppet) = &mut self.puppet {
                    puppet.lead(&angles);
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Shows the puppet's own pose, as far as it is known, on what the clip is of: the figure or the joints.
    pub(super) fn show_taught(&mut self) {
        // What is not known yet is shown as it was, and moves nothing.
        if self.teaching
            && let Ok(seen) = self.take_measured()
            && let Err(why) = self.hold_on(&seen)
        {
            self.note(NoteLevel::Warning, why);
        }
    }

    fn store_taught(&mut self, step_secs: f64) -> Result<(), String> {
        if !self.teaching {
            return Err("nobody is teaching; begin first, so that torque is off".into());
        }
        if !(step_secs.is_finite() && step_secs >= 0.0) {
            return Err("the time from one key to the next must be a number from 0".into());
        }
        self.take_measured()?;
        let secs = self.timeline.store_secs();
        let before = self.history.present().clone();
        self.apply(&Command::Edit(EditCommand::StoreKey { secs }));
        let stored = !std::sync::Arc::ptr_eq(&before, self.history.present());
        if stored && step_secs > 0.0 {
            self.apply(&Command::Transport(TransportCommand::Seek {
                secs: secs + step_secs,
            }));
        }
        Ok(())
    }

    /// The puppet as it was just measured, every joint of it.
    fn measured(&mut self) -> Result<PuppetView, String> {
        let seen = match &mut self.puppet {
            Some(puppet) => puppet.view(self.now),
            None => return Err("this show has no puppet; name one in show.toml or with --puppet".into()),
        };
        if seen.state == PuppetState::Faulted {
            return Err(format!(
                "puppet {} stands faulted ({}); reset it first",
                seen.name,
                seen.fault.unwrap_or_default()
            ));
        }
        let lost = |joint: &&JointView| joint.measured_rad.is_none() || joint.age_secs > FRESH_SECS;
        if let Some(joint) = seen.joints.iter().find(lost) {
            return Err(format!(
                "joint {} of puppet {} has not said where it is for {:.1} s; look at its cable",
                joint.name, seen.name, joint.age_secs
            ));
        }
        Ok(seen)
    }

    /// Takes the measured angles over as the pose on screen.
    fn take_measured(&mut self) -> Result<PuppetView, String> {
        let seen = self.measured()?;
        let measured: Vec<f64> = seen
            .joints
            .iter()
            .filter_map(|joint| joint.measured_rad)
            .collect();
        let of_figure = self.history.present().current_joint_clip().is_none();
        let body = self.puppet.as_ref().and_then(|puppet| puppet.body());
        match (&mut self.stage, body) {
            (Some(stage), Some(body)) if of_figure => {
                stage.take_over(|figure, pose| body.pose_from(&measured, figure, pose));
            }
            _ => self.pose_puppet(&PuppetPose::FromMeasured)?,
        }
        Ok(seen)
    }
}
