//! Viewing matrices: from world to eye, and from eye to picture. They act on column vectors.
//!
//! Shared by the viewing nodes and by F:LOOKAT, F:FOV and F:WINDOW, so that a node and the function
//! that drives it agree. Space is left-handed: x right, y up, z into the screen.
//! Source: `docs/protocols/ps300.md`, "What dialrig decides", 8 and 14.

use glam::{DAffine3, DMat3, DMat4, DVec3, DVec4};

/// Why there is no such view, as a clause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NoView(pub(crate) &'static str);

/// Eye to the origin, `at` to the positive z axis, `up` (a point; straight above the eye if absent) into
/// the half plane of positive y.
pub(crate) fn look(at: DVec3, from: DVec3, up: Option<DVec3>) -> Result<DAffine3, NoView> {
    let forward = (at - from)
        .try_normalize()
        .ok_or(NoView("the eye is at the point it looks at"))?;
    let upward = up.map_or(DVec3::Y, |up| up - from);
    let right = upward
        .try_normalize()
        .and_then(|upward| {
            let right = upward.cross(forward);
            // Closer to the line of sight than a millionth of a radian says nothing of what is up.
            if right.length_squared() > 1e-12 {
                right.try_normalize()
            } else {
                None
            }
        })
        .ok_or(NoView(
            "the point UP lies in line with the eye and the point it looks at",
        ))?;
    let eye_from_world = DMat3::from_cols(right, forward.cross(right), forward).transpose();
    Ok(DAffine3::from_mat3_translation(
        eye_from_world,
        -(eye_from_world * from),
    ))
}

/// The full angle `degrees` to -1..1 both ways, depth `front`..`back` to 0..1.
pub(crate) fn perspective(degrees: f64, front: f64, back: f64) -> Result<DMat4, NoView> {
    if !(degrees > 0.0 && degrees < 180.0) {
        return Err(NoView("a field of view lies between 0 and 180 degrees"));
    }
    if !(front > 0.0 && back > front) {
        return Err(NoView(
            "the clipping planes of a perspective lie in front of the eye, front before back",
        ));
    }
    let stretch = 1.0 / (degrees.to_radians() / 2.0).tan();
    let depth = back / (back - front);
    Ok(DMat4::from_cols(
        DVec4::new(stretch, 0.0, 0.0, 0.0),
        DVec4::new(0.0, stretch, 0.0, 0.0),
        DVec4::new(0.0, 0.0, depth, 1.0),
        DVec4::new(0.0, 0.0, -front * depth, 0.0),
    ))
}

/// Perspective of an eye `back` behind the middle of a screen `width` wide and high, moved right and up of it.
/// The eye is the origin; the screen becomes -1..1, depth `front`..`back_plane` 0..1.
pub(crate) fn eye(
    back: f64,
    [right, up]: [f64; 2],
    width: f64,
    [front, back_plane]: [f64; 2],
) -> Result<DMat4, NoView> {
    if back <= 0.0 || back.is_nan() {
        return Err(NoView("an eye stands behind its screen, at a distance above 0"));
    }
    if width <= 0.0 || width.is_nan() {
        return Err(NoView("a screen has a width"));
    }
    let straight = perspective(90.0, front, back_plane)?;
    let stretch = 2.0 * back / width;
    let scale = DMat4::from_scale(DVec3::new(stretch, stretch, 1.0));
    // Seen from the right, the screen lies to the left: what was in the middle of sight moves right on it.
    let shift = DMat4::from_translation(DVec3::new(2.0 * right / width, 2.0 * up / width, 0.0));
    Ok(shift * scale * straight)
}

/// `x` and `y` to -1..1, depth (front, back) to 0..1; depth stays as it is where no planes are given.
pub(crate) fn parallel(x: [f64; 2], y: [f64; 2], depth: Option<[f64; 2]>) -> Result<DMat4, NoView> {
    let (sx, tx) = onto(x, -1.0).ok_or(NoView("a window has a width"))?;
    let (sy, ty) = onto(y, -1.0).ok_or(NoView("a window has a height"))?;
    let (sz, tz) = match depth {
        None => (1.0, 0.0),
        Some(planes) => onto(planes, 0.0).ok_or(NoView("a window has a depth"))?,
    };
    let scale = DVec3::new(sx, sy, sz);
    Ok(DMat4::from_translation(DVec3::new(tx, ty, tz)) * DMat4::from_scale(scale))
}

/// Scale and offset that take `a`..`b` to `low`..1.
fn onto([a, b]: [f64; 2], low: f64) -> Option<(f64, f64)> {
    let scale = (1.0 - low) / (b - a);
    scale.is_finite().then_some((scale, low - a * scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_eye_goes_to_the_origin_and_at_to_positive_z() {
        let (at, from) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(-4.0, 0.5, 1.0));
        let view = look(at, from, None).unwrap();
        assert!(view.transform_point3(from).length() < 1e-12);
        let seen = view.transform_point3(at);
        assert!((seen - DVec3::new(0.0, 0.0, (at - from).length())).length() < 1e-12);
        assert!(view.transform_vector3(DVec3::Y).y > 0.0);
        assert!((view.matrix3.determinant() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn looking_along_z_from_behind_changes_nothing_but_depth() {
        let view = look(DVec3::ZERO, DVec3::new(0.0, 0.0, -5.0), None).unwrap();
        let p = view.transform_point3(DVec3::new(1.0, 2.0, 3.0));
        assert!((p - DVec3::new(1.0, 2.0, 8.0)).length() < 1e-12);
    }

    #[test]
    fn degenerate_views_are_refused() {
        let y = DVec3::Y;
        assert!(look(y, y, None).is_err());
        assert!(look(y, DVec3::ZERO, None).is_err());
        assert!(look(DVec3::X, DVec3::ZERO, Some(DVec3::ZERO)).is_err());
        assert!(perspective(0.0, 1.0, 2.0).is_err());
        assert!(perspective(180.0, 1.0, 2.0).is_err());
        assert!(perspective(30.0, 0.0, 2.0).is_err());
        assert!(perspective(30.0, 2.0, 2.0).is_err());
        assert!(perspective(f64::NAN, 1.0, 2.0).is_err());
        assert!(parallel([1.0, 1.0], [0.0, 1.0], None).is_err());
        assert!(eye(0.0, [0.0; 2], 1.0, [1.0, 2.0]).is_err());
        assert!(eye(1.0, [0.0; 2], 0.0, [1.0, 2.0]).is_err());
    }

    #[test]
    fn an_eye_beside_its_screen_sees_the_same_screen() {
        // The eye is 5 behind, 1 right of and 2 above the middle of a screen 4 wide.
        let m = eye(5.0, [1.0, 2.0], 4.0, [1.0, 10.0]).unwrap();
        let seen = |x: f64, y: f64| m.project_point3(DVec3::new(x - 1.0, y - 2.0, 5.0)).truncate();
        for (x, y) in [(0.0, 0.0), (2.0, 2.0), (-2.0, 2.0)] {
            assert!(
                (seen(x, y) - glam::DVec2::new(x, y) / 2.0).length() < 1e-12,
                "{x} {y}"
            );
        }
        let straight = eye(1.0, [0.0; 2], 2.0, [1.0, 10.0]).unwrap();
        assert!(straight.abs_diff_eq(perspective(90.0, 1.0, 10.0).unwrap(), 1e-12));
    }

    #[test]
    fn the_corners_of_what_is_seen_become_those_of_the_picture() {
        let m = perspective(90.0, 1.0, 10.0).unwrap();
        let corner = |x, y, z| m.project_point3(DVec3::new(x, y, z));
        assert!((corner(1.0, -1.0, 1.0) - DVec3::new(1.0, -1.0, 0.0)).length() < 1e-12);
        assert!((corner(10.0, 10.0, 10.0) - DVec3::new(1.0, 1.0, 1.0)).length() < 1e-12);
        let m = parallel([0.0, 4.0], [-1.0, 1.0], Some([2.0, 6.0])).unwrap();
        assert!(
            (m.transform_point3(DVec3::new(4.0, -1.0, 2.0)) - DVec3::new(1.0, -1.0, 0.0)).length() < 1e-12
        );
        assert!(
            (m.transform_point3(DVec3::new(0.0, 1.0, 6.0)) - DVec3::new(-1.0, 1.0, 1.0)).length() < 1e-12
        );
    }
}
