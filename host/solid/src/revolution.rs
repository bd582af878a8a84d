//! Solids and surfaces of revolution.
//!
//! A profile in the half plane (distance from the axis, height along it) is turned about the axis in equal
//! steps. A profile point on the axis becomes one vertex with triangles around it, and a full turn ends on
//! the vertices it began with, so the result has no seams and no degenerate polygons. All faces are planar.
//! Source: `docs/math.md`, section "Solids", revolution.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::Mesh;

/// Points nearer to the axis, or to their neighbour, than this part of the profile's size are on it.
/// Source: `docs/math.md`, section "Solids", revolution.
const NEAR: f64 = 1e-9;

/// A mesh larger than this is a typing error, not a wish. Our choice.
const VERTICES_MAX: usize = 4_000_000;

/// What is turned, about what, how far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Revolution<'a> {
    /// Points (distance from the axis, height along it), distance not negative.
    pub profile: &'a [DVec2],
    /// Whether the profile's last point is joined to its first.
    pub ends: ProfileEnds,
    /// What the profile is turned about.
    pub axis: Axis,
    /// How far.
    pub turn: Turn,
    /// Steps of the turn. Each is less than half a turn, so a full turn has three or more.
    pub segments: u32,
    /// Whether the result encloses a volume.
    pub fill: Fill,
}

/// Whether a profile is a line or a ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProfileEnds {
    /// From the first point to the last.
    Open,
    /// And back to the first.
    Closed,
}

/// The axis of a revolution. The turn begins at the next axis in the order x, y, z, x and goes on to the
/// one after it: a profile turned about z begins on x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it all")]
pub enum Axis {
    X,
    Y,
    Z,
}

/// How far a profile is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// Back to where it began.
    Full,
    /// More than 0 and less than a full turn, right-handed about the axis.
    Part {
        /// The angle between the first and the last copy of the profile.
        angle_rad: f64,
    },
}

/// What becomes of the places where the swept surface ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// Nothing: a surface with the profile's direction, from bottom to top being outward.
    Surface,
    /// Ends off the axis are joined to it, and a part turn gets a polygon at each end; always outward.
    Solid,
}

/// Why a profile cannot be turned. Points count from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RevolutionError {
    /// A coordinate that is infinite or not a number.
    #[error("profile point {index} is ({at}), expected finite coordinates")]
    NotFinite {
        /// Which point.
        index: usize,
        /// Where it is.
        at: DVec2,
    },
    /// A point on the far side of the axis.
    #[error(
        "profile point {index} is at distance {distance} from the axis, expected 0 or more: \
         the profile crosses the axis"
    )]
    CrossesAxis {
        /// Which point.
        index: usize,
        /// Its distance, negative.
        distance: f64,
    },
    /// Too few different points, or all of them on the axis.
    #[error(
        "the profile has {distinct} different points, {off_axis} of them off the axis: it sweeps no surface"
    )]
    NoSurface {
        /// Neighbours that coincide count once.
        distinct: usize,
        /// Those that are not on the axis.
        off_axis: usize,
    },
    /// A solid without inside.
    #[error("the solid has no volume: profile and axis enclose nothing")]
    NoVolume,
    /// A part turn outside its range.
    #[error("a part turn of {angle_rad} rad, expected more than 0 and less than a full turn (6.283)")]
    Angle {
        /// What was asked for.
        angle_rad: f64,
    },
    /// A step of half a turn or more.
    #[error("{found} segments, expected at least {least} for this turn")]
    TooFewSegments {
        /// What was asked for.
        found: u32,
        /// What is needed.
        least: u32,
    },
    /// More vertices than anybody can want.
    #[error("{vertices} vertices, expected at most {VERTICES_MAX}: use fewer segments or profile points")]
    TooFine {
        /// What it would have.
        vertices: usize,
    },
}

impl Revolution<'_> {
    /// The mesh swept. A profile that meets itself gives a mesh that meets itself; that is not checked.
    pub fn mesh(&self) -> Result<Mesh, RevolutionError> {
        let angle_rad = self.checked_angle_rad()?;
        let profile = self.checked_profile()?;
        let rings = match self.turn {
            Turn::Full => self.segments as usize,
            Turn::Part { .. } => self.segments as usize + 1,
        };
        let vertices = rings.saturating_mul(profile.len());
        limited(vertices)?;
        let directions = (0..rings).map(|ring| angle_rad * ring as f64 / f64::from(self.segments));
        let directions: Vec<DVec2> = directions
            .map(|angle| DVec2::new(angle.cos(), angle.sin()))
            .collect();

        let mut sweep = Sweep {
            vertices: Vec::with_capacity(vertices),
            rows: Vec::new(),
            faces: Vec::new(),
        };
        for &point in &profile {
            sweep.add_row(point, self.axis, &directions);
        }
        sweep.add_sides(self);
        if self.fill == Fill::Surface {
            return Ok(Mesh::from_parts(sweep.vertices, sweep.faces));
        }
        sweep.add_caps(self);
        solid(Mesh::from_parts(sweep.vertices, sweep.faces), size(&profile))
    }

    fn checked_angle_rad(&self) -> Result<f64, RevolutionError> {
        let angle_rad = match self.turn {
            Turn::Full => TAU,
            Turn::Part { angle_rad } if angle_rad > 0.0 && angle_rad < TAU => angle_rad,
            Turn::Part { angle_rad } => return Err(RevolutionError::Angle { angle_rad }),
        };
        // The least count whose steps stay under half a turn.
        let least = (angle_rad / (TAU / 2.0)).floor() as u32 + 1;
        if self.segments < least {
            return Err(RevolutionError::TooFewSegments {
                found: self.segments,
                least,
            });
        }
        Ok(angle_rad)
    }

    /// Whether the ends of the profile are joined to the axis.
    fn is_footed(&self) -> bool {
        self.fill == Fill::Solid && self.ends == ProfileEnds::Open && self.turn != Turn::Full
    }

    /// Whether the rows run in a ring: the profile is closed by itself or by way of the axis.
    fn is_ring(&self) -> bool {
        self.ends == ProfileEnds::Closed || self.is_footed()
    }

    /// The points that become rows of vertices: points near the axis moved onto it, coinciding neighbours
    /// merged, and for a solid part turn the feet of the ends on the axis added.
    fn checked_profile(&self) -> Result<Vec<DVec2>, RevolutionError> {
        for (index, &at) in self.profile.iter().enumerate() {
            if !at.is_finite() {
                return Err(RevolutionError::NotFinite { index, at });
            }
        }
        let near = NEAR * size(self.profile);
        let mut points = Vec::with_capacity(self.profile.len() + 2);
        for (index, &point) in self.profile.iter().enumerate() {
            if point.x < -near {
                return Err(RevolutionError::CrossesAxis {
                    index,
                    distance: point.x,
                });
            }
            points.push(if point.x <= near {
                DVec2::new(0.0, point.y)
            } else {
                point
            });
        }
        if self.is_footed()
            && let (Some(&first), Some(&last)) = (points.first(), points.last())
        {
            points.insert(0, DVec2::new(0.0, first.y));
            points.push(DVec2::new(0.0, last.y));
        }
        points.dedup_by(|later, earlier| later.distance(*earlier) <= near);
        let ring = self.is_ring();
        while ring && points.len() > 1 && points[0].distance(points[points.len() - 1]) <= near {
            points.pop();
        }
        let off_axis = points.iter().filter(|point| point.x > 0.0).count();
        let least = if ring { 3 } else { 2 };
        if points.len() < least || off_axis == 0 {
            return Err(RevolutionError::NoSurface {
                distinct: points.len(),
                off_axis,
            });
        }
        Ok(points)
    }
}

/// Refuses a mesh that is too large, before anything is allocated for it.
pub(crate) fn limited(vertices: usize) -> Result<(), RevolutionError> {
    if vertices > VERTICES_MAX {
        Err(RevolutionError::TooFine { vertices })
    } else {
        Ok(())
    }
}

/// The larger of the profile's greatest distance from the axis and its height.
fn size(profile: &[DVec2]) -> f64 {
    let mut bounds = (f64::INFINITY, f64::NEG_INFINITY);
    let mut distance: f64 = 0.0;
    for point in profile {
        bounds = (bounds.0.min(point.y), bounds.1.max(point.y));
        distance = distance.max(point.x.abs());
    }
    distance.max(bounds.1 - bounds.0)
}

/// Less volume than this part of area times size is rounding. Our choice: a wire as thin as `NEAR` lets it
/// be still has hundreds of times more.
const NO_VOLUME: f64 = 1e-12;

/// Turned outward, or refused where there is no inside.
fn solid(mesh: Mesh, size: f64) -> Result<Mesh, RevolutionError> {
    let volume = mesh.signed_volume();
    if volume.abs() <= NO_VOLUME * mesh.area() * size {
        return Err(RevolutionError::NoVolume);
    }
    Ok(if volume > 0.0 { mesh } else { mesh.flipped() })
}

/// The vertices one profile point becomes.
enum Row {
    /// One, on the axis.
    Pole(u32),
    /// One a ring, from this index on.
    Ring(u32),
}

impl Row {
    fn vertex(&self, ring: usize) -> u32 {
        match *self {
            Self::Pole(vertex) => vertex,
            Self::Ring(first) => first + ring as u32,
        }
    }
}

struct Sweep {
    vertices: Vec<DVec3>,
    rows: Vec<Row>,
    faces: Vec<Vec<u32>>,
}

impl Sweep {
    fn add_row(&mut self, point: DVec2, axis: Axis, directions: &[DVec2]) {
        let first = self.vertices.len() as u32;
        let place = |direction: DVec2| {
            let [along, across] = (point.x * direction).to_array();
            match axis {
                Axis::X => DVec3::new(point.y, along, across),
                Axis::Y => DVec3::new(across, point.y, along),
                Axis::Z => DVec3::new(along, across, point.y),
            }
        };
        if point.x == 0.0 {
            self.rows.push(Row::Pole(first));
            self.vertices.push(place(DVec2::ZERO));
        } else {
            self.rows.push(Row::Ring(first));
            self.vertices
                .extend(directions.iter().map(|&direction| place(direction)));
        }
    }

    /// Quadrilaterals, and triangles at the axis, between neighbouring rows.
    fn add_sides(&mut self, revolution: &Revolution<'_>) {
        let segments = revolution.segments as usize;
        let rows = self.rows.len();
        let pairs = if revolution.is_ring() { rows } else { rows - 1 };
        for pair in 0..pairs {
            let (from, to) = (&self.rows[pair], &self.rows[(pair + 1) % rows]);
            for segment in 0..segments {
                let next = match revolution.turn {
                    Turn::Full => (segment + 1) % segments,
                    Turn::Part { .. } => segment + 1,
                };
                let face = match (from, to) {
                    (Row::Pole(_), Row::Pole(_)) => break,
                    (Row::Pole(pole), _) => vec![*pole, to.vertex(next), to.vertex(segment)],
                    (_, Row::Pole(pole)) => vec![from.vertex(segment), from.vertex(next), *pole],
                    _ => vec![
                        from.vertex(segment),
                        from.vertex(next),
                        to.vertex(next),
                        to.vertex(segment),
                    ],
                };
                self.faces.push(face);
            }
        }
    }

    /// What closes a solid: discs at the ends of an open profile, or the profile itself at the ends of a
    /// part turn.
    fn add_caps(&mut self, revolution: &Revolution<'_>) {
        let segments = revolution.segments;
        match (revolution.turn, revolution.ends) {
            (Turn::Full, ProfileEnds::Closed) => {}
            (Turn::Full, ProfileEnds::Open) => {
                if let Some(&Row::Ring(first)) = self.rows.first() {
                    self.faces.push((first..first + segments).rev().collect());
                }
                if let Some(&Row::Ring(first)) = self.rows.last() {
                    self.faces.push((first..first + segments).collect());
                }
            }
            (Turn::Part { .. }, _) => {
                let end = |ring: usize| self.rows.iter().map(move |row| row.vertex(ring));
                let first: Vec<u32> = end(0).collect();
                let last: Vec<u32> = end(segments as usize).rev().collect();
                self.faces.extend([first, last]);
            }
        }
    }
}
