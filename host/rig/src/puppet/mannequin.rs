//! A puppet posed by hand on screen: joint by joint, or by the end of a link. It knows no servo; whoever follows
//! it does so through the player like anybody else.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use motion::JointTrack;
use motion::chain::{JointIndex, reach};

use super::bones::Bones;
use super::model::Model;
use super::pose_view::PuppetPoseView;
use crate::command::PuppetPose;
use crate::snapshot::PuppetView;

/// The puppet on screen.
#[derive(Clone, Debug)]
pub(crate) struct Mannequin {
    model: Arc<Model>,
    bones: Bones,
    rest_rad: Vec<f64>,
    angles_rad: Vec<f64>,
    by_hand: bool,
    drag_error_m: f64,
}

impl Mannequin {
    pub(crate) fn new(model: Arc<Model>) -> Self {
        let rest_rad = model.chain.rest_angles();
        Self {
            bones: Bones::new(Arc::clone(&model)),
            angles_rad: rest_rad.clone(),
            rest_rad,
            model,
            by_hand: false,
            drag_error_m: 0.0,
        }
    }

    /// Does what the hand asks; says what was wrong with it otherwise and leaves the pose alone.
    pub(crate) fn apply(&mut self, pose: &PuppetPose, measured: Option<&PuppetView>) -> Result<(), String> {
        match pose {
            PuppetPose::Joint { joint, angle_rad } => self.turn(joint, *angle_rad)?,
            PuppetPose::JointBy { joint, by_rad } => {
                let now_rad = self.angles_rad[self.leading(joint)?];
                self.turn(joint, now_rad + by_rad)?;
            }
            PuppetPose::Drag { link, to } => self.drag(link, DVec3::from_array(*to))?,
            PuppetPose::Rest => self.angles_rad.clone_from(&self.rest_rad),
            PuppetPose::FromMeasured => self.take_over(measured.ok_or("there is no puppet to look at")?)?,
            // The rig shows the clip itself: it knows the time.
            PuppetPose::FromClip => return Ok(()),
        }
        self.by_hand = true;
        Ok(())
    }

    /// A joint that can be posed.
    fn leading(&self, name: &str) -> Result<usize, String> {
        let Some(joint) = self.model.joint(name) else {
            let (puppet, known) = (&self.model.name, self.model.joints.join(", "));
            return Err(format!("puppet {puppet} has no joint {name}; it has {known}"));
        };
        match self.model.chain.led(JointIndex(joint as u16)) {
            Some(coupling) => {
                let leader = &self.model.joints[coupling.follows.index()];
                Err(format!("joint {name} follows {leader}; pose that one"))
            }
            None => Ok(joint),
        }
    }

    fn turn(&mut self, name: &str, angle_rad: f64) -> Result<(), String> {
        let joint = self.leading(name)?;
        if !angle_rad.is_finite() {
            return Err(format!("the angle of joint {name} must be a number"));
        }
        let range = self.model.chain.joints()[joint].range_rad;
        self.angles_rad[joint] = range.clamp(angle_rad);
        self.model.chain.lead(&mut self.angles_rad);
        Ok(())
    }

    fn drag(&mut self, link: &str, to: DVec3) -> Result<(), String> {
        let Some(end) = self.model.end(link) else {
            let movable = self.model.links.iter().filter(|link| link.joint.is_some());
            let known: Vec<&str> = movable.map(|link| link.name.as_str()).collect();
            let puppet = &self.model.name;
            return Err(format!(
                "puppet {puppet} has no link {link} that moves; it has {}",
                known.join(", ")
            ));
        };
        if !to.is_finite() {
            return Err(format!("the place to drag {link} to must be finite"));
        }
        let model = &self.model;
        let (base, rest) = (&model.world_from_base, &self.rest_rad);
        let reached = reach(&model.chain, base, end, to, rest, &mut self.angles_rad);
        self.drag_error_m = reached.error_m;
        Ok(())
    }

    fn take_over(&mut self, seen: &PuppetView) -> Result<(), String> {
        let measured: Option<Vec<f64>> = seen.joints.iter().map(|joint| joint.measured_rad).collect();
        match measured.filter(|measured| measured.len() == self.angles_rad.len()) {
            Some(measured) => {
                self.angles_rad = measured;
                Ok(())
            }
            None => Err(format!(
                "not every servo of puppet {} has said where it is",
                seen.name
            )),
        }
    }

    /// Shows the pose of a clip; what was posed by hand and not stored is gone.
    pub(crate) fn show(&mut self, track: &JointTrack, secs: f64) {
        track.angles(secs, &mut self.angles_rad);
        self.by_hand = false;
    }

    /// What was posed has been stored.
    pub(crate) fn stored(&mut self) {
        self.by_hand = false;
    }

    pub(crate) fn by_hand(&self) -> bool {
        self.by_hand
    }

    /// A joint's name as the profile has it, where it stands and how far it may go, radians; none of joints that
    /// follow others.
    pub(crate) fn joint(&self, name: &str) -> Option<(&str, f64, [f64; 2])> {
        let place = self
            .model
            .joints
            .iter()
            .position(|it| it.eq_ignore_ascii_case(name))?;
        let leads = self.model.chain.led(JointIndex(place as u16)).is_none();
        let range = self.model.chain.joints().get(place).filter(|_| leads)?.range_rad;
        Some((
            &self.model.joints[place],
            self.angles_rad[place],
            [range.start, range.end],
        ))
    }

    /// The names of all joints.
    pub(crate) fn joints(&self) -> &[String] {
        &self.model.joints
    }

    pub(crate) fn angles_rad(&self) -> &[f64] {
        &self.angles_rad
    }

    /// Angles to be stored: of all joints that follow none.
    pub(crate) fn key(&self) -> BTreeMap<String, f64> {
        let joints = self.model.joints.iter().zip(&self.angles_rad).enumerate();
        joints
            .filter(|(joint, _)| self.model.chain.led(JointIndex(*joint as u16)).is_none())
            .map(|(_, (name, angle))| (name.clone(), *angle))
            .collect()
    }

    pub(crate) fn view(&mut self) -> PuppetPoseView {
        let (joints, ends) = self.bones.handles(&self.angles_rad);
        let chain = &self.model.chain;
        let range = |joint: &motion::Joint| [joint.range_rad.start, joint.range_rad.end];
        PuppetPoseView {
            puppet: self.model.name.clone(),
            names: self.model.joints.clone(),
            angles_rad: self.angles_rad.clone(),
            ranges_rad: chain.joints().iter().map(range).collect(),
            led: (0..chain.len())
                .map(|joint| chain.led(JointIndex(joint as u16)).is_some())
                .collect(),
            bones: self.bones.at(&self.angles_rad),
            joints,
            ends,
            by_hand: self.by_hand,
            drag_error_m: self.drag_error_m,
        }
    }
}
