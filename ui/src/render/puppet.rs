//! The servo puppet: where it was measured, where it was asked to be, and as it is posed on screen.
//!
//! A picture of its own is upright and always at the same scale; [`add`] draws the posed puppet into a view that
//! a person can turn.

use glam::DVec3;
use rig::{JointView, PuppetPoseView, PuppetView};

use super::camera::Camera;
use super::scene::{Ink, Layer, Mark, Scene};
use super::theme::{self, Rgb};

/// From where a kind of puppet is looked at, in shares of its longest way from the base.
struct Stand {
    azimuth_rad: f64,
    elevation_rad: f64,
    middle: DVec3,
    half_height: f64,
    half_width: f64,
}

/// A standing human with an arm up, the base between the shoulders and the longest way down a leg; turned a
/// little, so that an arm held forward is seen as one.
const HANGS: Stand = Stand {
    azimuth_rad: 0.3,
    elevation_rad: 0.08,
    middle: DVec3::new(0.0, -0.2, 0.0),
    half_height: 0.8,
    half_width: 0.57,
};
/// An arm on a table, from a little below its base to its hand above; it reaches forward, so from aside.
const STANDS: Stand = Stand {
    azimuth_rad: 0.9,
    elevation_rad: 0.25,
    middle: DVec3::new(0.0, 0.42, 0.25),
    half_height: 0.66,
    half_width: 0.5,
};
/// Ends nearer than this are one point, metres.
const JOINED_M: f64 = 1e-3;
/// Two poses that differ by less than this share of the longest way are one to the eye.
const SEEN_APART: f64 = 0.012;
/// How strong the lines are that say where it should be.
const GHOST: f32 = 0.5;

/// The puppet in a picture `aspect` times as wide as high; an empty picture for no puppet. `posing` shows the pose
/// on screen, too.
pub fn scene(puppet: Option<&PuppetView>, posing: Option<&PuppetPoseView>, aspect: f64) -> Scene {
    let bones = puppet.map(|p| p.bones.as_slice()).unwrap_or_default();
    let posed = posing.map(|p| p.bones.as_slice()).unwrap_or_default();
    let reach_m = reach_m(if bones.is_empty() { posed } else { bones });
    let stands = puppet.map_or_else(|| stands(posed), |p| p.on_its_base);
    let mut scene = Scene::new(camera(stands, reach_m.max(0.1), aspect));
    if let Some(puppet) = puppet {
        if apart(&puppet.goal_bones, bones, reach_m) {
            ghost(&mut scene, &puppet.goal_bones, theme::TEXT);
        }
        measured(&mut scene, puppet);
    }
    if apart(posed, bones, reach_m) {
        let ink = Ink::new(theme::SELECTED, Layer::Overlay).flat();
        for &[from, to] in posed {
            scene.stroke(from, to, theme::WIDTH_GHOST, ink);
        }
    }
    scene
}

/// Whether a pose stands on its base: that of whoever follows a figure is a trunk, which hangs from the neck.
fn stands(posed: &[[DVec3; 2]]) -> bool {
    posed.first().is_some_and(|[from, to]| to.y > from.y - JOINED_M)
}

fn camera(stands: bool, reach_m: f64, aspect: f64) -> Camera {
    let stand = if stands { &STANDS } else { &HANGS };
    let half_height = reach_m * stand.half_height.max(stand.half_width / aspect.max(0.1));
    Camera::turned(
        stand.azimuth_rad,
        stand.elevation_rad,
        stand.middle * reach_m,
        half_height,
    )
}

/// Adds a puppet that is posed on screen, and faintly where its servos are.
pub fn add(scene: &mut Scene, pose: &PuppetPoseView, puppet: Option<&PuppetView>) {
    let reach_m = reach_m(&pose.bones);
    if let Some(puppet) = puppet.filter(|p| apart(&p.bones, &pose.bones, reach_m)) {
        ghost(scene, &puppet.bones, puppet_colour(puppet));
    }
    let ink = Ink::new(theme::LINE, Layer::Figure);
    for &[from, to] in &pose.bones {
        scene.stroke(from, to, theme::WIDTH_LINK, ink);
    }
    for joint in &pose.joints {
        scene.dot(joint.at, 3.0, Mark::Disc, ink);
    }
}

/// The height of what it stands on or over, metres: an arm's base is on a table.
pub fn floor(pose: &PuppetPoseView) -> f64 {
    let heights = pose.bones.as_flattened().iter().map(|point| point.y);
    heights.fold(0.0, f64::min)
}

fn puppet_colour(puppet: &PuppetView) -> Rgb {
    if puppet.torque { theme::LIVE } else { theme::DIM }
}

/// What a joint has to say by its colour, where that is not what all of the puppet says.
pub fn joint_colour(joint: &JointView) -> Option<Rgb> {
    if joint.error.is_some() {
        Some(theme::FAULTED)
    } else if joint.trouble.is_some() {
        Some(theme::TOO_MUCH)
    } else {
        None
    }
}

fn measured(scene: &mut Scene, puppet: &PuppetView) {
    let all = Ink::new(puppet_colour(puppet), Layer::Figure);
    for (bone, &[from, to]) in puppet.bones.iter().enumerate() {
        let joints = || puppet.joints.iter().filter(|joint| joint.bone == bone);
        let colours = || joints().filter_map(joint_colour);
        let worst = colours().find(|colour| *colour == theme::FAULTED);
        let ink = match worst.or_else(|| colours().next()) {
            Some(colour) => Ink::new(colour, Layer::Figure).flat(),
            None if joints().any(|joint| !joint.present) => Ink::new(theme::FAINT, Layer::Figure),
            None => all,
        };
        scene.stroke(from, to, theme::WIDTH_LINK, ink);
        scene.dot(from, 2.5, Mark::Disc, ink);
    }
}

fn ghost(scene: &mut Scene, bones: &[[DVec3; 2]], colour: Rgb) {
    let ink = Ink::new(colour, Layer::Ghost).faded(GHOST);
    for &[from, to] in bones {
        scene.stroke(from, to, theme::WIDTH_GHOST, ink);
    }
}

/// Whether there is a first pose, and an eye could tell it from a second.
fn apart(first: &[[DVec3; 2]], second: &[[DVec3; 2]], reach_m: f64) -> bool {
    let far = |(a, b): (&DVec3, &DVec3)| a.distance(*b) > SEEN_APART * reach_m;
    !first.is_empty()
        && (first.len() != second.len() || first.as_flattened().iter().zip(second.as_flattened()).any(far))
}

/// The longest way from the base along the lines, metres: the same in every pose, so that the scale never moves.
fn reach_m(bones: &[[DVec3; 2]]) -> f64 {
    let mut ends: Vec<(DVec3, f64)> = vec![(DVec3::ZERO, 0.0)];
    let mut left: Vec<[DVec3; 2]> = bones.to_vec();
    let at = |ends: &[(DVec3, f64)], point: DVec3| {
        let found = ends.iter().find(|(end, _)| end.distance(point) < JOINED_M);
        found.map(|(_, way_m)| *way_m)
    };
    loop {
        let before = left.len();
        left.retain(|&[from, to]| {
            let way_m = at(&ends, from).map(|way_m| (to, way_m));
            let Some((end, way_m)) = way_m.or_else(|| at(&ends, to).map(|way_m| (from, way_m))) else {
                return true;
            };
            ends.push((end, way_m + from.distance(to)));
            false
        });
        if left.len() == before {
            // What hangs on nothing is measured from the base as it is.
            let loose = left.iter().flatten().map(|point| point.length());
            return loose
                .chain(ends.iter().map(|(_, way_m)| *way_m))
                .fold(0.0, f64::max);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reach_is_the_same_in_every_pose() {
        let elbow = |bend_rad: f64| {
            let upper = DVec3::new(0.1, -0.2, 0.0);
            let hand = upper + 0.15 * DVec3::new(bend_rad.sin(), -bend_rad.cos(), 0.0);
            // Parents after children, and one line the other way round.
            [
                [upper, hand],
                [upper, DVec3::new(0.1, 0.0, 0.0)],
                [DVec3::ZERO, DVec3::new(0.1, 0.0, 0.0)],
            ]
        };
        for bend_rad in [0.0, 0.7, 2.4] {
            assert!((reach_m(&elbow(bend_rad)) - 0.45).abs() < 1e-9, "{bend_rad}");
        }
        assert_eq!(reach_m(&[]), 0.0);
        assert_eq!(reach_m(&[[DVec3::X, DVec3::X * 2.0]]), 2.0, "hanging on nothing");
    }

    fn leg() -> PuppetView {
        PuppetView {
            bones: vec![[DVec3::ZERO, DVec3::NEG_Y]],
            joints: vec![JointView {
                present: true,
                ..JointView::default()
            }],
            ..PuppetView::default()
        }
    }

    #[test]
    fn torque_makes_it_live_and_trouble_colours_the_line_that_has_it() {
        let colour = |puppet: &PuppetView| scene(Some(puppet), None, 0.6).strokes[0].ink.colour;
        let mut puppet = leg();
        assert_eq!(colour(&puppet), theme::DIM);
        puppet.torque = true;
        assert_eq!(colour(&puppet), theme::LIVE);
        puppet.joints[0].trouble = Some("heat");
        assert_eq!(colour(&puppet), theme::TOO_MUCH);
        puppet.joints[0].error = Some("overload".into());
        assert_eq!(colour(&puppet), theme::FAULTED);
        assert!(scene(None, None, 1.0).strokes.is_empty());
    }

    #[test]
    fn where_it_should_be_is_seen_when_it_is_not_there() {
        let strokes = |goal: DVec3| {
            let puppet = PuppetView {
                goal_bones: vec![[DVec3::ZERO, goal]],
                ..leg()
            };
            scene(Some(&puppet), None, 0.6).strokes
        };
        assert_eq!(strokes(DVec3::new(0.005, -1.0, 0.0)).len(), 1);
        let apart = strokes(DVec3::new(0.2, -0.98, 0.0));
        assert_eq!(apart.len(), 2);
        assert!(apart[0].ink.strength < apart[1].ink.strength);
    }
}
