//! From where the figure is looked at, changed by hand.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DMat3, DMat4, DVec3};
use motion::figure::Placed;
use motion::figure::posing::View;

use crate::command::ViewCommand;
use crate::snapshot::ViewState;

/// Share of the picture's half-height that a whole figure takes up in the front view. A tablet's shorter side
/// reaches about 0.7, and limbs must have room to stretch.
const FIGURE_SHARE: f64 = 0.55;
/// Azimuth and elevation from which a puppet without a figure is looked at first.
const BESIDE_RAD: [f64; 2] = [1.2, 0.25];
/// Smallest and largest scale, picture half-heights per metre: from a mountain to a grain of sand.
const SCALE: std::ops::RangeInclusive<f64> = 1e-4..=1e4;

impl ViewState {
    /// Rotation into view axes: x right, y up, z towards the viewer.
    pub fn view_from_world(&self) -> DMat3 {
        DMat3::from_rotation_x(self.elevation_rad) * DMat3::from_rotation_y(self.azimuth_rad)
    }

    /// The same as posing takes it.
    pub fn posing_view(&self) -> View {
        View {
            view_from_world: self.view_from_world(),
            centre: self.centre,
            scale: self.scale,
        }
    }

    /// From the world to where a tablet points, -1 to 1 each way: what networks pick by.
    pub fn tablet_from_world(&self) -> DMat4 {
        DMat4::from_scale(DVec3::splat(self.scale))
            * DMat4::from_mat3(self.view_from_world())
            * DMat4::from_translation(-self.centre)
    }

    /// The front view that holds a placed figure.
    pub fn holding(placed: &[Placed]) -> Self {
        let ends: Vec<DVec3> = placed.iter().flat_map(|p| [p.start, p.end]).collect();
        Self::default().around(&ends)
    }

    /// A view of a puppet without a figure that holds its lines: from aside and above, since arms reach forward.
    pub fn beside(lines: &[[DVec3; 2]]) -> Self {
        let [azimuth_rad, elevation_rad] = BESIDE_RAD;
        let aside = Self {
            azimuth_rad,
            elevation_rad,
            ..Self::default()
        };
        aside.around(lines.as_flattened())
    }

    /// The same turn of the view, moved and scaled to hold all points, metres.
    fn around(self, points: &[DVec3]) -> Self {
        let view_from_world = self.view_from_world();
        let seen = points
            .iter()
            .filter(|p| p.is_finite())
            .map(|p| view_from_world * *p);
        let points = || seen.clone();
        let (Some(low), Some(high)) = (points().reduce(DVec3::min), points().reduce(DVec3::max)) else {
            return self;
        };
        let half = ((high - low).truncate().max_element() / 2.0).max(1e-3);
        Self {
            scale: FIGURE_SHARE / half,
            centre: view_from_world.transpose() * ((low + high) / 2.0),
            ..self
        }
    }

    /// Does what was asked, except [`ViewCommand::Reset`], which needs the figure.
    pub(crate) fn apply(&mut self, command: &ViewCommand) -> Result<(), String> {
        match *command {
            ViewCommand::Turn {
                azimuth_by_rad,
                elevation_by_rad,
            } => {
                if !(azimuth_by_rad.is_finite() && elevation_by_rad.is_finite()) {
                    return Err("a turn of the view must be a number".into());
                }
                self.azimuth_rad = (self.azimuth_rad + azimuth_by_rad + PI).rem_euclid(TAU) - PI;
                self.elevation_rad = (self.elevation_rad + elevation_by_rad).clamp(-FRAC_PI_2, FRAC_PI_2);
            }
            ViewCommand::Zoom { by } => {
                if !(by.is_finite() && by > 0.0) {
                    return Err(format!("a zoom is a number above 0, found {by}"));
                }
                self.scale = (self.scale * by).clamp(*SCALE.start(), *SCALE.end());
            }
            ViewCommand::Reset => {}
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_view_looks_along_minus_z() {
        let seen = ViewState::default().view_from_world() * DVec3::new(1.0, 2.0, 3.0);
        assert_eq!(seen, DVec3::new(1.0, 2.0, 3.0));
    }

    #[test]
    fn turning_stays_in_one_turn_and_tilting_stops_at_the_poles() {
        let mut view = ViewState::default();
        for _ in 0..10 {
            view.apply(&ViewCommand::Turn {
                azimuth_by_rad: 3.0,
                elevation_by_rad: 1.0,
            })
            .expect("turns");
        }
        assert!(view.azimuth_rad.abs() <= PI && view.elevation_rad == FRAC_PI_2);
        assert!(view.apply(&ViewCommand::Zoom { by: 0.0 }).is_err());
        assert!(
            view.apply(&ViewCommand::Turn {
                azimuth_by_rad: f64::NAN,
                elevation_by_rad: 0.0
            })
            .is_err()
        );
    }
}
