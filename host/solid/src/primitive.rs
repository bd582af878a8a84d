//! The solids one can ask for by name, centred on the origin, axis z.
//!
//! All but the box are solids of revolution. Counts of vertices, edges and faces, with n-gons for the flat
//! ends: prism and cylinder (2n, 3n, n+2), cone (n+1, 2n, n+1), sphere of m slices and s stacks
//! (m(s-1)+2, m(2s-1), ms), torus m by n (mn, 2mn, mn).
//! Source: `docs/math.md`, section "Solids"; diameters and heights as the options `-d` and `-z` of the
//! thesis give them.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::revolution::limited;
use crate::{Axis, Fill, Mesh, ProfileEnds, Revolution, RevolutionError, Turn};

/// Why a primitive cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PrimitiveError {
    /// A length that is no length.
    #[error("{what} is {found}, expected a finite number greater than 0")]
    Size {
        /// Which length.
        what: &'static str,
        /// What it was.
        found: f64,
    },
    /// A count too small for the shape.
    #[error("{found} {what}, expected at least {least}")]
    Count {
        /// What is counted.
        what: &'static str,
        /// What is needed.
        least: u32,
        /// What was asked for.
        found: u32,
    },
    /// A torus whose tube reaches the axis.
    #[error(
        "a torus whose tube has diameter {tube_diameter} on a ring of diameter {ring_diameter} runs into itself; \
         expected a larger ring or a thinner tube"
    )]
    SelfIntersecting {
        /// Of the circle in the middle of the tube.
        ring_diameter: f64,
        /// Of the tube.
        tube_diameter: f64,
    },
    /// Numbers so extreme that the shape collapses, or too many polygons.
    #[error(transparent)]
    Revolution(#[from] RevolutionError),
}

/// A box with the given extents along x, y, z.
pub fn cuboid(size: DVec3) -> Result<Mesh, PrimitiveError> {
    length("the extent along x", size.x)?;
    length("the extent along y", size.y)?;
    length("the extent along z", size.z)?;
    // Bit 0 of a vertex number chooses the side in x, bit 1 in y, bit 2 in z.
    let corner = |number: u32| {
        let side = |bit: u32| if number >> bit & 1 == 1 { 0.5 } else { -0.5 };
        size * DVec3::new(side(0), side(1), side(2))
    };
    let faces = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    Ok(Mesh::from_parts(
        (0..8).map(corner).collect(),
        faces.map(Vec::from).to_vec(),
    ))
}

/// A box with equal edges.
pub fn cube(edge: f64) -> Result<Mesh, PrimitiveError> {
    length("the edge", edge)?;
    cuboid(DVec3::splat(edge))
}

/// A prism over a regular polygon with `sides` corners on a circle of `diameter`, the first on +x.
pub fn prism(sides: u32, diameter: f64, height: f64) -> Result<Mesh, PrimitiveError> {
    count("sides", 3, sides)?;
    length("the diameter", diameter)?;
    length("the height", height)?;
    let profile = [
        DVec2::new(diameter / 2.0, -height / 2.0),
        DVec2::new(diameter / 2.0, height / 2.0),
    ];
    turned(&profile, ProfileEnds::Open, sides)
}

/// A cylinder as a prism with `segments` sides.
pub fn cylinder(diameter: f64, height: f64, segments: u32) -> Result<Mesh, PrimitiveError> {
    count("segments", 3, segments)?;
    prism(segments, diameter, height)
}

/// A cone with its point at the top.
pub fn cone(diameter: f64, height: f64, segments: u32) -> Result<Mesh, PrimitiveError> {
    count("segments", 3, segments)?;
    length("the diameter", diameter)?;
    length("the height", height)?;
    let profile = [
        DVec2::new(diameter / 2.0, -height / 2.0),
        DVec2::new(0.0, height / 2.0),
    ];
    turned(&profile, ProfileEnds::Open, segments)
}

/// A sphere of `slices` around the axis and `stacks` from pole to pole, corners on the true sphere.
pub fn sphere(diameter: f64, slices: u32, stacks: u32) -> Result<Mesh, PrimitiveError> {
    length("the diameter", diameter)?;
    count("slices", 3, slices)?;
    count("stacks", 2, stacks)?;
    limited((slices as usize).saturating_mul(stacks as usize))?;
    let point = |stack: u32| {
        let polar_rad = PI * f64::from(stack) / f64::from(stacks);
        let distance = if stack == 0 || stack == stacks {
            0.0
        } else {
            polar_rad.sin()
        };
        DVec2::new(distance, -polar_rad.cos()) * (diameter / 2.0)
    };
    let profile: Vec<DVec2> = (0..=stacks).map(point).collect();
    turned(&profile, ProfileEnds::Open, slices)
}

/// A ring: the middle of the tube runs on a circle of `ring_diameter`, which must exceed `tube_diameter`.
pub fn torus(
    ring_diameter: f64,
    tube_diameter: f64,
    segments: u32,
    tube_segments: u32,
) -> Result<Mesh, PrimitiveError> {
    length("the ring's diameter", ring_diameter)?;
    length("the tube's diameter", tube_diameter)?;
    count("segments", 3, segments)?;
    count("tube segments", 3, tube_segments)?;
    if ring_diameter <= tube_diameter {
        return Err(PrimitiveError::SelfIntersecting {
            ring_diameter,
            tube_diameter,
        });
    }
    limited((segments as usize).saturating_mul(tube_segments as usize))?;
    let point = |segment: u32| {
        let angle_rad = TAU * f64::from(segment) / f64::from(tube_segments);
        let from_middle = DVec2::new(angle_rad.cos(), angle_rad.sin()) * (tube_diameter / 2.0);
        DVec2::new(ring_diameter / 2.0, 0.0) + from_middle
    };
    let profile: Vec<DVec2> = (0..tube_segments).map(point).collect();
    turned(&profile, ProfileEnds::Closed, segments)
}

fn turned(profile: &[DVec2], ends: ProfileEnds, segments: u32) -> Result<Mesh, PrimitiveError> {
    let revolution = Revolution {
        profile,
        ends,
        axis: Axis::Z,
        turn: Turn::Full,
        segments,
        fill: Fill::Solid,
    };
    Ok(revolution.mesh()?)
}

fn length(what: &'static str, found: f64) -> Result<(), PrimitiveError> {
    if found.is_finite() && found > 0.0 {
        Ok(())
    } else {
        Err(PrimitiveError::Size { what, found })
    }
}

fn count(what: &'static str, least: u32, found: u32) -> Result<(), PrimitiveError> {
    if found >= least {
        Ok(())
    } else {
        Err(PrimitiveError::Count { what, least, found })
    }
}
