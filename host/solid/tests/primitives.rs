//! Counts, measures and refusals of the primitives.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use solid::{Mesh, MeshError, OpenEdge, PrimitiveError, RevolutionError, primitive};

/// Vertices, edges, faces, Euler's number.
type Counts = (usize, usize, usize, i64);

fn counts(mesh: &Mesh) -> Counts {
    let topology = mesh.topology();
    assert!(topology.is_closed(), "{:?}", topology.open_edge);
    assert!(mesh.is_outward());
    (
        topology.vertices,
        topology.edges,
        topology.faces,
        topology.euler(),
    )
}

#[test]
fn counts_follow_the_formulas() {
    for n in 3..20_u32 {
        let size = n as usize;
        assert_eq!(
            counts(&primitive::prism(n, 1.0, 2.0).unwrap()),
            (2 * size, 3 * size, size + 2, 2)
        );
        assert_eq!(
            counts(&primitive::cylinder(1.0, 2.0, n).unwrap()),
            (2 * size, 3 * size, size + 2, 2)
        );
        assert_eq!(
            counts(&primitive::cone(1.0, 2.0, n).unwrap()),
            (size + 1, 2 * size, size + 1, 2)
        );
        for s in 2..10_u32 {
            let stacks = s as usize;
            assert_eq!(
                counts(&primitive::sphere(1.0, n, s).unwrap()),
                (size * (stacks - 1) + 2, size * (2 * stacks - 1), size * stacks, 2)
            );
            let tube = stacks + 1;
            assert_eq!(
                counts(&primitive::torus(2.0, 1.0, n, s + 1).unwrap()),
                (size * tube, 2 * size * tube, size * tube, 0)
            );
        }
    }
    assert_eq!(counts(&primitive::cube(2.0).unwrap()), (8, 12, 6, 2));
}

#[test]
fn measures_approach_those_of_the_round_shapes() {
    let near =
        |found: f64, wanted: f64| assert!((found / wanted - 1.0).abs() < 1e-3, "{found}, expected {wanted}");
    let sphere = primitive::sphere(2.0, 200, 100).unwrap();
    near(sphere.signed_volume(), 4.0 / 3.0 * PI);
    near(sphere.area(), 4.0 * PI);
    near(
        primitive::cylinder(2.0, 3.0, 200).unwrap().signed_volume(),
        3.0 * PI,
    );
    near(primitive::cone(2.0, 3.0, 200).unwrap().signed_volume(), PI);
    let torus = primitive::torus(4.0, 1.0, 200, 200).unwrap();
    near(torus.signed_volume(), 2.0 * PI * PI * 2.0 * 0.25);
    near(torus.area(), 4.0 * PI * PI * 2.0 * 0.5);
    // A prism is exact: n/2 r² sin(2π/n) h.
    let prism = primitive::prism(7, 2.0, 3.0).unwrap().signed_volume();
    assert!((prism - 3.5 * (TAU / 7.0).sin() * 3.0).abs() < 1e-12);
    let cuboid = primitive::cuboid(DVec3::new(1.0, 2.0, 3.0)).unwrap();
    assert_eq!((cuboid.signed_volume(), cuboid.area()), (6.0, 22.0));
}

#[test]
fn a_small_solid_far_away_keeps_its_volume() {
    let cube = primitive::cube(1.0).unwrap();
    let moved = cube.vertices().iter().map(|&at| at + DVec3::splat(1e6)).collect();
    let moved = Mesh::new(moved, cube.faces().to_vec()).unwrap();
    assert!((moved.signed_volume() - 1.0).abs() < 1e-9);
}

#[test]
fn senseless_sizes_are_refused_in_words() {
    let refused: [(Result<Mesh, PrimitiveError>, &str); 8] = [
        (
            primitive::cube(0.0),
            "the edge is 0, expected a finite number greater than 0",
        ),
        (
            primitive::cube(f64::NAN),
            "the edge is NaN, expected a finite number greater than 0",
        ),
        (
            primitive::cuboid(DVec3::new(1.0, -2.0, 3.0)),
            "the extent along y is -2, expected a finite number greater than 0",
        ),
        (primitive::prism(2, 1.0, 1.0), "2 sides, expected at least 3"),
        (
            primitive::cylinder(1.0, f64::INFINITY, 8),
            "the height is inf, expected a finite number greater than 0",
        ),
        (primitive::sphere(1.0, 8, 1), "1 stacks, expected at least 2"),
        (
            primitive::torus(1.0, 1.0, 8, 8),
            "a torus whose tube has diameter 1 on a ring of diameter 1 runs into itself; \
             expected a larger ring or a thinner tube",
        ),
        (
            primitive::sphere(1.0, 3000, 3000),
            "9000000 vertices, expected at most 4000000: use fewer segments or profile points",
        ),
    ];
    for (found, words) in refused {
        assert_eq!(found.unwrap_err().to_string(), words);
    }
    for huge in [
        primitive::sphere(1.0, u32::MAX, u32::MAX),
        primitive::torus(2.0, 1.0, u32::MAX, u32::MAX),
    ] {
        assert!(matches!(
            huge,
            Err(PrimitiveError::Revolution(RevolutionError::TooFine { .. }))
        ));
    }
}

#[test]
fn an_open_edge_is_named() {
    let cube = primitive::cube(1.0).unwrap();
    let mut faces = cube.faces().to_vec();
    let lid = faces.pop().unwrap();
    let open = Mesh::new(cube.vertices().to_vec(), faces.clone())
        .unwrap()
        .topology();
    assert!(!open.is_closed());
    assert_eq!(open.euler(), 1);
    let edge = open.open_edge.unwrap();
    assert_eq!(
        edge,
        OpenEdge {
            from: 4,
            to: 5,
            forward: 0,
            backward: 1
        }
    );
    assert_eq!(
        edge.to_string(),
        "the edge between vertices 4 and 5 is in 0 faces one way and in 1 the other, expected one each way"
    );

    // A lid put on inside out touches every edge twice, and is still not closed.
    faces.push(lid.into_iter().rev().collect());
    assert!(
        !Mesh::new(cube.vertices().to_vec(), faces)
            .unwrap()
            .topology()
            .is_closed()
    );
    assert!(!Mesh::default().topology().is_closed());
}

#[test]
fn flipping_turns_a_solid_inside_out() {
    let cube = primitive::cube(2.0).unwrap().flipped();
    assert!(cube.topology().is_closed());
    assert!(!cube.is_outward());
    assert_eq!(cube.signed_volume(), -8.0);
}

#[test]
fn parts_that_are_no_mesh_are_refused() {
    let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let new = |face: Vec<u32>| Mesh::new(corners.clone(), vec![face]);
    assert!(new(vec![0, 1, 2]).is_ok());
    assert_eq!(
        new(vec![0, 1]),
        Err(MeshError::TooFewCorners { face: 0, corners: 2 })
    );
    assert_eq!(
        new(vec![0, 1, 3]),
        Err(MeshError::NoSuchVertex {
            face: 0,
            vertex: 3,
            vertices: 3
        })
    );
    assert_eq!(
        new(vec![0, 1, 0, 2]),
        Err(MeshError::RepeatedVertex { face: 0, vertex: 0 })
    );
    let infinite = vec![DVec3::ZERO, DVec3::INFINITY];
    assert!(matches!(
        Mesh::new(infinite, vec![]),
        Err(MeshError::NotFinite { vertex: 1, .. })
    ));
}
