//! Agreement with the golden meshes, which a program independent of this one has computed.
//!
//! The golden files stand beside the repository; where they are missing the test says so and passes.

use std::path::Path;

use glam::{DVec2, DVec3};
use serde_json::Value as Json;
use solid::{Axis, Fill, Mesh, PrimitiveError, ProfileEnds, Revolution, RevolutionError, Turn, primitive};

fn number(json: &Json, key: &str) -> f64 {
    json[key]
        .as_f64()
        .unwrap_or_else(|| panic!("{key} is a number in {json}"))
}

fn count(json: &Json, key: &str) -> u32 {
    json[key]
        .as_u64()
        .unwrap_or_else(|| panic!("{key} is a count in {json}")) as u32
}

fn numbers(json: &Json) -> Vec<f64> {
    json.as_array()
        .expect("an array")
        .iter()
        .map(|number| number.as_f64().expect("a number"))
        .collect()
}

fn profile(json: &Json) -> Vec<DVec2> {
    let points = json["profile"].as_array().expect("a profile");
    let points: Vec<DVec2> = points
        .iter()
        .map(|point| DVec2::from_slice(&numbers(point)))
        .collect();
    match json.get("curve_k") {
        Some(order) => curve(
            &points,
            order.as_u64().expect("an order") as usize,
            count(json, "curve_steps"),
        ),
        None => points,
    }
}

/// `steps + 1` points of the uniform B-spline of order `order` that begins and ends on its outer points:
/// knots 0 (order times), 1, 2, …, last (order times). Computed by de Boor's recurrence.
fn curve(points: &[DVec2], order: usize, steps: u32) -> Vec<DVec2> {
    let spans = points.len() + 1 - order;
    let knot = |index: usize| (index + 1).saturating_sub(order).min(spans) as f64;
    let at = |step: u32| {
        let u = spans as f64 * f64::from(step) / f64::from(steps);
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

fn revolve(json: &Json) -> Result<Mesh, RevolutionError> {
    let degrees = number(json, "degrees");
    let profile = profile(json);
    let revolution = Revolution {
        profile: &profile,
        ends: if json["closed"] == true {
            ProfileEnds::Closed
        } else {
            ProfileEnds::Open
        },
        axis: match json["axis"].as_str() {
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
        segments: count(json, "segs"),
        fill: if json["solid"] == true {
            Fill::Solid
        } else {
            Fill::Surface
        },
    };
    revolution.mesh()
}

fn build(json: &Json) -> Result<Mesh, PrimitiveError> {
    match json["shape"].as_str().expect("a shape") {
        "cube" => primitive::cube(number(json, "size")),
        "box" => primitive::cuboid(DVec3::from_slice(&numbers(&json["size"]))),
        "cylinder" => primitive::cylinder(number(json, "d"), number(json, "h"), count(json, "segs")),
        "prism" => primitive::prism(count(json, "sides"), number(json, "d"), number(json, "h")),
        "cone" => primitive::cone(number(json, "d"), number(json, "h"), count(json, "segs")),
        "sphere" => primitive::sphere(number(json, "d"), count(json, "slices"), count(json, "stacks")),
        "torus" => primitive::torus(
            number(json, "D"),
            number(json, "d"),
            count(json, "segs"),
            count(json, "tube_segs"),
        ),
        "revolve" => Ok(revolve(json)?),
        shape => panic!("no shape is called {shape}"),
    }
}

fn refusal(error: &PrimitiveError) -> &'static str {
    match error {
        PrimitiveError::SelfIntersecting { .. } => "self_intersecting",
        PrimitiveError::Revolution(RevolutionError::CrossesAxis { .. }) => "profile_crosses_axis",
        _ => "another refusal",
    }
}

struct Tolerance {
    absolute: f64,
    relative: f64,
}

impl Tolerance {
    fn agree(&self, found: f64, wanted: f64) -> bool {
        (found - wanted).abs() <= self.absolute + self.relative * found.abs().max(wanted.abs())
    }
}

fn compare(name: &str, mesh: &Mesh, expect: &Json, tolerance: &Tolerance) {
    let topology = mesh.topology();
    for (key, found) in [
        ("vertices", topology.vertices as i64),
        ("edges", topology.edges as i64),
        ("faces", topology.faces as i64),
        ("euler", topology.euler()),
    ] {
        assert_eq!(Some(found), expect[key].as_i64(), "{name}: {key}");
    }
    assert_eq!(
        Some(topology.is_closed()),
        expect["watertight"].as_bool(),
        "{name}: {:?}",
        topology.open_edge
    );
    for (key, found) in [("area", mesh.area()), ("volume", mesh.signed_volume())] {
        if let Some(wanted) = expect[key].as_f64() {
            assert!(
                tolerance.agree(found, wanted),
                "{name}: {key} {found}, expected {wanted}"
            );
        }
    }
    let bounds = mesh.bounds().expect("a mesh with vertices");
    for (corner, wanted) in [(bounds.min, &expect["bbox"][0]), (bounds.max, &expect["bbox"][1])] {
        for (found, wanted) in corner.to_array().into_iter().zip(numbers(wanted)) {
            assert!(
                tolerance.agree(found, wanted),
                "{name}: bounds {corner}, expected {wanted}"
            );
        }
    }
}

#[test]
fn meshes_agree_with_the_golden_ones() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/golden/mesh.json");
    let Ok(text) = std::fs::read_to_string(&path) else {
        eprintln!("SKIPPED: no golden meshes at {}", path.display());
        return;
    };
    let golden: Json = serde_json::from_str(&text).expect("golden meshes are JSON");
    let tolerance = Tolerance {
        absolute: number(&golden["tolerance"], "abs"),
        relative: number(&golden["tolerance"], "rel"),
    };
    let cases = golden["cases"].as_array().expect("cases");
    let mut compared = 0;
    for case in cases.iter().filter(|case| case["op"] == "mesh") {
        let name = case["name"].as_str().expect("a name");
        let expect = &case["expect"];
        match (build(&case["input"]["mesh"]), expect["reject"].as_str()) {
            (Ok(mesh), None) => compare(name, &mesh, expect, &tolerance),
            (Err(error), Some(code)) => assert_eq!(refusal(&error), code, "{name}: {error}"),
            (Ok(_), Some(code)) => panic!("{name}: made, expected {code}"),
            (Err(error), None) => panic!("{name}: {error}"),
        }
        compared += 1;
    }
    assert!(compared > 0, "no case of op mesh in {}", path.display());
}
