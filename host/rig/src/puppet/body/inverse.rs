//! The way back: from the angles of a puppet's joints to the pose of the figure it follows, for a puppet that is posed
//! by hand and read.
//!
//! A servo knows nothing of where its puppet stands, so the figure's root stays as it is; so do links that no joint
//! follows, and the twist of links that two joints follow by their direction alone.

use std::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec3};
use motion::figure::frame_of;
use motion::retarget::GROUP_JOINTS_MAX;
use motion::{Figure, FigurePose, Rigid};

use super::Body;

impl Body {
    /// Puts the links of `pose` where the joints at `angles_rad` have them.
    pub(crate) fn pose_from(&self, angles_rad: &[f64], figure: &Figure, pose: &mut FigurePose) {
        let (mut placed, mut led) = (Vec::new(), Vec::new());
        figure.place(pose, &mut placed);
        self.led(&placed, &mut led);
        let base = led.first().map_or(DMat3::IDENTITY, |root| {
            root.world_from_link * DMat3::from_quat(self.base_from_root).transpose()
        });
        let world_from_base = Rigid {
            rotation: DQuat::from_mat3(&base),
            translation: DVec3::ZERO,
        };
        let mut joints = Vec::new();
        self.model.chain.place(&world_from_base, angles_rad, &mut joints);
        for following in &self.followers {
            let last = following
                .joints
                .last()
                .and_then(|joint| joints.get(joint.index()));
            let leader = self.leaders.get(following.link.index());
            let (Some(last), Some((link, turn))) = (last, leader) else {
                continue;
            };
            let Some(stands) = pose.links.get_mut(link.index()) else {
                continue;
            };
            let world_from_led = DMat3::from_quat(last.rotation * following.joint_from_link);
            let world_from_link = world_from_led * turn.transpose();
            stands.direction = world_from_link.z_axis.normalize_or(stands.direction);
            if following.joints.len() == GROUP_JOINTS_MAX {
                let turned = frame_of(stands.direction).transpose() * world_from_link;
                let twist_rad = turned.x_axis.y.atan2(turned.x_axis.x);
                // Twists may have gone around: the nearest one is meant.
                let turns = ((stands.twist_rad - twist_rad) / TAU).round();
                stands.twist_rad = twist_rad + turns * TAU;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document;
    use crate::puppet::Follower;
    use device_profiles::Profiles;

    /// A pose that was read from the joints is followed by these very joints' links.
    #[test]
    fn what_is_read_is_what_would_be_followed() {
        let show = document::from_texts(&crate::shipped::salute()).expect("shipped");
        let figure = &show.figure.as_ref().expect("a figure").figure;
        let body = Body::of_show(&show, Some("marionette"), &Profiles::builtin()).expect("follows");
        let rest = body.model.chain.rest_angles();
        for seed in 0..20_u32 {
            let angles: Vec<f64> = (0_u32..)
                .zip(body.model.chain.joints())
                .map(|(joint, of)| {
                    let share = f64::from((seed * 31 + joint * 17) % 23) / 22.0;
                    // Away from the limits, where several answers meet.
                    of.range_rad.start + of.range_rad.length() * (0.2 + 0.6 * share)
                })
                .collect();
            let mut pose = figure.rest_pose();
            body.pose_from(&angles, figure, &mut pose);
            let mut placed = Vec::new();
            figure.place(&pose, &mut placed);
            let mut follower = Follower::new(&body);
            let mut found = angles.clone();
            follower.follow_from(&placed, &mut found);
            let error = follower.report().direction_error_rad();
            assert!(error < 1e-6, "seed {seed}: {error}");
            for ((joint, found), wanted) in body.joints().iter().zip(&found).zip(&angles) {
                assert!(
                    (found - wanted).abs() < 1e-4,
                    "seed {seed}, {joint}: {found} for {wanted}"
                );
            }
        }
        assert_eq!(rest.len(), body.joints().len());
    }
}
