//! The servo puppet where it was measured: its lines upright, always at the same scale.

use glam::DVec3;
use rig::PuppetView;

use super::camera::Camera;
use super::scene::{Ink, Layer, Mark, Scene};
use super::theme;

/// Turned a little, so that an arm held forward is seen as one.
const AZIMUTH_RAD: f64 = 0.3;
const ELEVATION_RAD: f64 = 0.08;
/// What of its longest way from the base the picture holds: a standing human with an arm up, the base between
/// the shoulders and the longest way down a leg.
const MIDDLE: f64 = -0.2;
/// The same of a puppet that stands on its base: from a little below it to its hand above.
const MIDDLE_ON_BASE: f64 = 0.45;
const HALF_HEIGHT: f64 = 0.8;
const HALF_WIDTH: f64 = 0.57;
/// Ends nearer than this are one point, metres.
const JOINED_M: f64 = 1e-3;

/// The puppet in a picture `aspect` times as wide as high; an empty picture for no puppet.
pub fn scene(puppet: Option<&PuppetView>, aspect: f64) -> Scene {
    let bones = puppet.map(|p| p.bones.as_slice()).unwrap_or_default();
    let reach_m = reach_m(bones).max(0.1);
    let half_height = reach_m * HALF_HEIGHT.max(HALF_WIDTH / aspect.max(0.1));
    let on_its_base = puppet.is_some_and(|p| p.on_its_base);
    let middle = if on_its_base { MIDDLE_ON_BASE } else { MIDDLE };
    let centre = DVec3::new(0.0, reach_m * middle, 0.0);
    let mut scene = Scene::new(Camera::turned(AZIMUTH_RAD, ELEVATION_RAD, centre, half_height));
    let colour = if puppet.is_some_and(|p| p.torque) {
        theme::LIVE
    } else {
        theme::DIM
    };
    let ink = Ink::new(colour, Layer::Figure);
    for &[from, to] in bones {
        scene.stroke(from, to, theme::WIDTH_LINK, ink);
        scene.dot(from, 2.5, Mark::Disc, ink);
    }
    scene
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

    #[test]
    fn torque_is_what_makes_it_live() {
        let colour = |torque: bool| {
            let bones = vec![[DVec3::ZERO, DVec3::NEG_Y]];
            let puppet = PuppetView {
                bones,
                torque,
                ..PuppetView::default()
            };
            scene(Some(&puppet), 0.6).strokes[0].ink.colour
        };
        assert_eq!(colour(true), theme::LIVE);
        assert_eq!(colour(false), theme::DIM);
        assert!(scene(None, 1.0).strokes.is_empty());
    }
}
