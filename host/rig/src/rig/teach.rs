//! Teaching: the puppet itself is the mannequin. Its torque is off, hands pose it, what is measured is what is seen, and
//! a word stores it as a key.

use super::Rig;
use crate::command::{Command, EditCommand, PuppetCommand, PuppetPose, TeachCommand, TransportCommand};
use crate::snapshot::{JointView, NoteLevel, PuppetState};

/// A measurement older than this says nothing of where a hand has put the joint: some ten of a slow bus's rounds.
const FRESH_SECS: f64 = 0.5;

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
            TeachCommand::End => {
                self.teaching = false;
                Ok(())
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
    }

    /// Shows the puppet's own pose, as far as it is known, on what the clip is of: the figure or the joints.
    pub(super) fn show_taught(&mut self) {
        // What is not known yet is shown as it was.
        if self.teaching {
            let _ = self.take_measured();
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

    /// Takes the measured angles over as the pose on screen.
    fn take_measured(&mut self) -> Result<(), String> {
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
                Ok(())
            }
            _ => self.pose_puppet(&PuppetPose::FromMeasured),
        }
    }
}
