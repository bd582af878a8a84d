//! Solids of revolution are closed and outward for any profile, and weigh what the formula says.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use solid::{Axis, Fill, Mesh, ProfileEnds, Revolution, RevolutionError, Turn};

/// An open profile turned fully about z into a solid; the cases below change what they are about.
fn open(profile: &[DVec2]) -> Revolution<'_> {
    Revolution {
        profile,
        ends: ProfileEnds::Open,
        axis: Axis::Z,
        turn: Turn::Full,
        segments: 8,
        fill: Fill::Solid,
    }
}

fn points(points: &[(f64, f64)]) -> Vec<DVec2> {
    points.iter().map(|&point| point.into()).collect()
}

/// Profiles that climb: no two of their edges meet.
fn climbing() -> impl Strategy<Value = Vec<DVec2>> {
    let steps = prop::collection::vec((0.05..3.0_f64, 0.01..2.0_f64), 2..9);
    (steps, any::<bool>(), any::<bool>(), any::<bool>()).prop_map(|(steps, low, high, down)| {
        let mut height = -3.0;
        let mut profile = Vec::new();
        for (distance, rise) in steps {
            height += rise;
            profile.push(DVec2::new(distance, height));
        }
        if low {
            profile[0].x = 0.0;
        }
        if high && profile.len() > 2 {
            profile.last_mut().unwrap().x = 0.0;
        }
        if down {
            profile.reverse();
        }
        profile
    })
}

/// Twice the signed area, and the volume swept per radian of a fine turn, of the profile closed over the axis.
fn frustums(profile: &[DVec2]) -> f64 {
    let of_pair = |pair: &[DVec2]| {
        let (a, b) = (pair[0], pair[1]);
        (b.y - a.y) / 3.0 * (a.x * a.x + a.x * b.x + b.x * b.x)
    };
    profile.windows(2).map(of_pair).sum::<f64>().abs()
}

fn assert_solid(mesh: &Mesh) {
    let topology = mesh.topology();
    assert!(topology.is_closed(), "{:?}", topology.open_edge);
    assert!(mesh.is_outward());
    for face in mesh.faces() {
        assert!(
            mesh.area_vector(face).length() > 0.0,
            "a degenerate face {face:?}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn full_turns_are_closed_outward_and_exact(profile in climbing(), segments in 3..20_u32) {
        let mesh = Revolution { segments, ..open(&profile) }.mesh().unwrap();
        assert_solid(&mesh);
        prop_assert_eq!(mesh.topology().euler(), 2);
        let exact = f64::from(segments) / 2.0 * (TAU / f64::from(segments)).sin() * frustums(&profile);
        prop_assert!((mesh.signed_volume() - exact).abs() <= 1e-12 * exact.max(1.0));
    }

    #[test]
    fn part_turns_are_closed_outward_and_exact(profile in climbing(), segments in 2..20_u32, angle_rad in 0.01..6.2_f64) {
        let turn = Turn::Part { angle_rad };
        let mesh = Revolution { segments, turn, axis: Axis::Y, ..open(&profile) }.mesh().unwrap();
        assert_solid(&mesh);
        prop_assert_eq!(mesh.topology().euler(), 2);
        let exact = f64::from(segments) / 2.0 * (angle_rad / f64::from(segments)).sin() * frustums(&profile);
        prop_assert!((mesh.signed_volume() - exact).abs() <= 1e-12 * exact.max(1.0));
    }

    #[test]
    fn rings_have_a_hole_and_their_parts_have_not(
        middle in 2.0..9.0_f64, tube in 0.1..1.9_f64, corners in 3..9_u32, segments in 3..20_u32,
        angle_rad in 0.01..6.2_f64,
    ) {
        let corner = |index: u32| DVec2::new(middle, 0.0) + tube * DVec2::from_angle(TAU * f64::from(index) / f64::from(corners));
        let profile: Vec<DVec2> = (0..corners).map(corner).collect();
        let ring = Revolution { ends: ProfileEnds::Closed, segments, axis: Axis::X, ..open(&profile) };
        let full = ring.mesh().unwrap();
        assert_solid(&full);
        prop_assert_eq!(full.topology().euler(), 0);
        let part = Revolution { turn: Turn::Part { angle_rad }, ..ring }.mesh().unwrap();
        assert_solid(&part);
        prop_assert_eq!(part.topology().euler(), 2);
    }

    #[test]
    fn any_numbers_give_a_mesh_or_a_reason(
        profile in prop::collection::vec((any::<f64>(), any::<f64>()), 0..6), angle_rad in any::<f64>(),
        segments in 0..40_u32, closed in any::<bool>(), solid in any::<bool>(), full in any::<bool>(),
    ) {
        let profile = points(&profile);
        let made = Revolution {
            profile: &profile,
            ends: if closed { ProfileEnds::Closed } else { ProfileEnds::Open },
            axis: Axis::Z,
            turn: if full { Turn::Full } else { Turn::Part { angle_rad } },
            segments,
            fill: if solid { Fill::Solid } else { Fill::Surface },
        }
        .mesh();
        if let (Ok(mesh), true) = (made, solid) {
            prop_assert!(mesh.topology().is_closed());
        }
    }
}

#[test]
fn points_on_the_axis_become_one_vertex() {
    let spindle = points(&[(0.0, -1.0), (1.0, 0.0), (1e-12, 1.0)]);
    let topology = open(&spindle).mesh().unwrap().topology();
    assert_eq!((topology.vertices, topology.edges, topology.faces), (10, 24, 16));
}

#[test]
fn neighbours_at_one_place_are_merged() {
    let doubled = points(&[(1.0, 0.0), (1.0, 0.0), (1.0, 1.0), (1.0 + 1e-13, 1.0)]);
    assert_eq!(open(&doubled).mesh().unwrap().topology().faces, 10);
    let ring = points(&[(1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 0.0)]);
    let ring = Revolution {
        ends: ProfileEnds::Closed,
        ..open(&ring)
    }
    .mesh()
    .unwrap();
    assert_eq!(ring.topology().faces, 24);
}

#[test]
fn feet_at_one_height_meet_on_the_axis() {
    let roof = points(&[(1.0, 0.0), (2.0, 1.0), (3.0, 0.0)]);
    let mesh = Revolution {
        turn: Turn::Part { angle_rad: 1.0 },
        ..open(&roof)
    }
    .mesh()
    .unwrap();
    assert!(mesh.topology().is_closed(), "{:?}", mesh.topology().open_edge);
}

#[test]
fn a_surface_keeps_the_direction_of_its_profile() {
    let wall = points(&[(1.0, 0.0), (1.0, 1.0)]);
    let down: Vec<DVec2> = wall.iter().rev().copied().collect();
    for (profile, outward) in [(&wall, 1.0), (&down, -1.0)] {
        let mesh = Revolution {
            fill: Fill::Surface,
            ..open(profile)
        }
        .mesh()
        .unwrap();
        assert!(!mesh.topology().is_closed());
        for face in mesh.faces() {
            let middle = mesh.corners(face).sum::<DVec3>() * DVec3::new(1.0, 1.0, 0.0);
            assert!(mesh.area_vector(face).dot(middle) * outward > 0.0);
        }
    }
}

#[test]
fn each_axis_begins_at_the_next() {
    let wall = points(&[(1.0, 0.0), (1.0, 5.0)]);
    for (axis, begin, along) in [
        (Axis::X, DVec3::Y, DVec3::X),
        (Axis::Y, DVec3::Z, DVec3::Y),
        (Axis::Z, DVec3::X, DVec3::Z),
    ] {
        let mesh = Revolution { axis, ..open(&wall) }.mesh().unwrap();
        assert_eq!(mesh.vertices()[0], begin);
        assert_eq!(mesh.vertices()[8], begin + 5.0 * along);
        assert!(
            along.dot(begin.cross(mesh.vertices()[1])) > 0.0,
            "right-handed about {axis:?}"
        );
    }
}

#[test]
fn what_cannot_be_turned_is_refused_in_words() {
    let wall = points(&[(1.0, 0.0), (1.0, 1.0)]);
    let across = points(&[(1.0, 0.0), (-0.5, 1.0)]);
    let axis_only = points(&[(0.0, 0.0), (0.0, 1.0)]);
    let disc = points(&[(0.0, 0.0), (1.0, 0.0)]);
    let infinite = points(&[(1.0, 0.0), (f64::INFINITY, 1.0)]);
    let part = |angle_rad| Turn::Part { angle_rad };
    let refused = [
        (
            open(&across),
            "profile point 1 is at distance -0.5 from the axis, expected 0 or more: the profile crosses the axis",
        ),
        (
            open(&axis_only),
            "the profile has 2 different points, 0 of them off the axis: it sweeps no surface",
        ),
        (
            open(&[]),
            "the profile has 0 different points, 0 of them off the axis: it sweeps no surface",
        ),
        (
            open(&disc),
            "the solid has no volume: profile and axis enclose nothing",
        ),
        (
            open(&infinite),
            "profile point 1 is ([inf, 1]), expected finite coordinates",
        ),
        (
            Revolution {
                turn: part(7.0),
                ..open(&wall)
            },
            "a part turn of 7 rad, expected more than 0 and less than a full turn (6.283)",
        ),
        (
            Revolution {
                segments: 2,
                ..open(&wall)
            },
            "2 segments, expected at least 3 for this turn",
        ),
        (
            Revolution {
                segments: 1,
                turn: part(3.5),
                ..open(&wall)
            },
            "1 segments, expected at least 2 for this turn",
        ),
    ];
    for (revolution, words) in refused {
        assert_eq!(revolution.mesh().unwrap_err().to_string(), words);
    }
    let endless = Revolution {
        segments: u32::MAX,
        ..open(&wall)
    };
    assert!(matches!(endless.mesh(), Err(RevolutionError::TooFine { .. })));
}
