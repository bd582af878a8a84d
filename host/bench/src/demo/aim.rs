//! Where the puck must go so that a link points somewhere: the posing of the thesis (section 5.2), backwards.
//!
//! The view is a parallel projection. The cursor that poses a link is the projection of where its end shall be;
//! whether that end lies towards the viewer or away from them chooses the button. Near the silhouette a count of
//! the tablet is several degrees, so the neighbouring counts are tried as well, as a person would.

use glam::DVec3;
use rig::{Side, ViewState};

use crate::stand::Surface;

/// How far around the nearest count others are tried.
const NEIGHBOURS: i32 = 2;

/// A place for the puck, and the button that fixes the link there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Aim {
    /// Script coordinates.
    pub(crate) place: [f64; 2],
    /// Which of the two answers is meant.
    pub(crate) side: Side,
    /// Angle between what is meant and what comes of it, radians.
    pub(crate) error_rad: f64,
}

/// The best place for a link that starts at `start`, is `length` long, and shall point in `direction`.
pub(crate) fn aim(view: &ViewState, surface: &Surface, start: DVec3, length: f64, direction: DVec3) -> Aim {
    let view_from_world = view.view_from_world();
    let from = view_from_world * (start - view.centre);
    let wanted = view_from_world * direction.normalize_or_zero();
    let side = if wanted.z < 0.0 { Side::Far } else { Side::Near };
    let end = (from + length * wanted) * view.scale;
    let nearest = surface.script_from_cursor([end.x, end.y]);
    let mut best = Aim {
        place: nearest,
        side,
        error_rad: f64::INFINITY,
    };
    for dx in -NEIGHBOURS..=NEIGHBOURS {
        for dy in -NEIGHBOURS..=NEIGHBOURS {
            let place = surface.on_the_grid(nearest, [dx, dy]);
            let [x, y] = surface
                .cursor_from_script(place)
                .map(|cursor| cursor / view.scale);
            let got = pointed((x - from.x) / length, (y - from.y) / length, side);
            let error_rad = got.angle_between(wanted);
            if error_rad < best.error_rad {
                best = Aim {
                    place,
                    error_rad,
                    ..best
                };
            }
        }
    }
    best
}

/// The unit vector over a point of the unit disc; outside it, on its edge.
fn pointed(x: f64, y: f64, side: Side) -> DVec3 {
    let off = x.hypot(y);
    if off >= 1.0 {
        return DVec3::new(x / off, y / off, 0.0);
    }
    let depth = (1.0 - off * off).sqrt();
    DVec3::new(x, y, if side == Side::Near { depth } else { -depth })
}

#[cfg(test)]
mod tests {
    use super::*;
    use device_profiles::Profiles;

    #[test]
    fn every_direction_can_be_pointed_at_within_a_few_degrees() {
        let profiles = Profiles::builtin();
        let surface = Surface::from(profiles.input("graphire-serial").expect("built in"));
        let view = ViewState {
            azimuth_rad: 0.4,
            elevation_rad: -0.2,
            scale: 0.8,
            centre: DVec3::Y,
        };
        for i in 0..500 {
            // Points spread over the sphere by the golden angle.
            let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / 500.0;
            let (turn, off) = (f64::from(i) * 2.399_963, (1.0 - z * z).sqrt());
            let direction = DVec3::new(off * turn.cos(), off * turn.sin(), z);
            let found = aim(&view, &surface, DVec3::new(0.1, 1.1, 0.0), 0.2, direction);
            assert!(found.error_rad.to_degrees() < 3.0, "{direction}: {found:?}");
        }
    }
}
