//! Primitives and revolutions as meshes.

use super::number::{index, list, number, numbers, point};
use super::{Answered, Refusal};
use glam::DVec2;
use serde_json::{Value, json};
use solid::{
    Axis, Fill, Mesh, PrimitiveError, ProfileEnds, Revolution, RevolutionError, Topology, Turn, primitive,
};

impl From<PrimitiveError> for Refusal {
    fn from(error: PrimitiveError) -> Self {
        match error {
            PrimitiveError::Size { .. } => Self::new("bad_size"),
            PrimitiveError::Count { .. } => Self::new("bad_count"),
            PrimitiveError::SelfIntersecting { .. } => Self::new("self_intersecting"),
            PrimitiveError::Revolution(RevolutionError::CrossesAxis { .. }) => {
                Self::new("profile_crosses_axis")
            }
            PrimitiveError::Revolution(_) => Self::new("bad_profile"),
        }
    }
}

pub(super) fn mesh(input: &Value) -> Answered {
    let mesh = build(&input["mesh"])?;
    let topology = mesh.topology();
    let mut got = described(&mesh, &topology);
    // Only what is closed holds anything.
    if topology.is_closed() {
        got["volume"] = json!(mesh.signed_volume());
    }
    Ok(got)
}

fn described(mesh: &Mesh, topology: &Topology) -> Value {
    let corners = mesh
        .bounds()
        .map(|bounds| [bounds.min.to_array(), bounds.max.to_array()]);
    json!({
        "vertices": topology.vertices, "edges": topology.edges, "faces": topology.faces,
        "euler": topology.euler(), "area": mesh.area(), "watertight": topology.is_closed(), "bbox": corners,
    })
}

fn build(spec: &Value) -> Result<Mesh, Refusal> {
    let real = |key: &str| number(&spec[key]);
    let count = |key: &str| index(&spec[key]) as u32;
    let mesh = match spec["shape"].as_str().unwrap_or_default() {
        "cube" => primitive::cube(real("size")),
        "box" => primitive::cuboid(point(&spec["size"])),
        "cylinder" => primitive::cylinder(real("d"), real("h"), count("segs")),
        "prism" => primitive::prism(count("sides"), real("d"), real("h")),
        "cone" => primitive::cone(real("d"), real("h"), count("segs")),
        "sphere" => primitive::sphere(real("d"), count("slices"), count("stacks")),
        "torus" => primitive::torus(real("D"), real("d"), count("segs"), count("tube_segs")),
        "revolve" => revolve(spec).map_err(PrimitiveError::from),
        _ => return Err(Refusal::new("unknown_shape")),
    };
    Ok(mesh?)
}

fn revolve(spec: &Value) -> Result<Mesh, RevolutionError> {
    let degrees = number(&spec["degrees"]);
    let profile = profile(spec);
    let revolution = Revolution {
        profile: &profile,
        ends: if spec["closed"] == true {
            ProfileEnds::Closed
        } else {
            ProfileEnds::Open
        },
        axis: match spec["axis"].as_str() {
            Some("x") => Axis::X,
            Some("y") => Axis::Y,
            _ => Axis::Z,
        },
        turn: if degrees == 360.0 {
            Turn::Full
        } else {
            Turn::Part {
                angle_rad: degrees.to_radians(),
            }
        },
        segments: index(&spec["segs"]) as u32,
        fill: if spec["solid"] == true {
            Fill::Solid
        } else {
            Fill::Surface
        },
    };
    revolution.mesh()
}

fn profile(spec: &Value) -> Vec<DVec2> {
    let points: Vec<DVec2> = list(&spec["profile"])
        .iter()
        .map(|point| {
            let at = numbers(point);
            DVec2::new(
                at.first().copied().unwrap_or(0.0),
                at.get(1).copied().unwrap_or(0.0),
            )
        })
        .collect();
    match index(&spec["curve_k"]) {
        order if order >= 2 && order <= points.len() => curve(&points, order, index(&spec["curve_steps"])),
        _ => points,
    }
}

/// `steps + 1` points of the uniform B-spline of order `order` that begins and ends on its outer points:
/// knots 0 (order times), 1, 2, …, last (order times). By de Boor's recurrence, in two dimensions, apart from
/// `motion`'s, which keeps its ends otherwise.
fn curve(points: &[DVec2], order: usize, steps: usize) -> Vec<DVec2> {
    let spans = points.len() + 1 - order;
    let knot = |index: usize| (index + 1).saturating_sub(order).min(spans) as f64;
    let at = |step: usize| {
        let u = spans as f64 * step as f64 / steps.max(1) as f64;
        let span = (u as usize).min(spans - 1) + order - 1;
        let mut row: Vec<DVec2> = points[span + 1 - order..=span].to_vec();
        for level in 1..order {
            for index in (level..order).rev() {
                let left = knot(span + 1 - order + index);
                let right = knot(span + 1 + index - level);
                row[index] = row[index - 1].lerp(row[index], (u - left) / (right - left));
            }
        }
        row[order - 1]
    };
    (0..=steps).map(at).collect()
}
