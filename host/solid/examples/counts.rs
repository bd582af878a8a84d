//! What is each primitive made of, and how far is its volume from the round shape's?

use std::f64::consts::PI;

use solid::{Mesh, PrimitiveError, primitive};

fn main() -> Result<(), PrimitiveError> {
    let shapes: [(&str, Mesh, f64); 5] = [
        ("cube 1", primitive::cube(1.0)?, 1.0),
        (
            "cylinder 1 by 1, 24 segments",
            primitive::cylinder(1.0, 1.0, 24)?,
            PI / 4.0,
        ),
        (
            "cone 1 by 1, 24 segments",
            primitive::cone(1.0, 1.0, 24)?,
            PI / 12.0,
        ),
        (
            "sphere 1, 24 slices, 12 stacks",
            primitive::sphere(1.0, 24, 12)?,
            PI / 6.0,
        ),
        (
            "torus 2 and 1, 24 by 12",
            primitive::torus(2.0, 1.0, 24, 12)?,
            PI * PI / 2.0,
        ),
    ];
    for (name, mesh, round) in shapes {
        let topology = mesh.topology();
        println!(
            "{name}: {} vertices, {} edges, {} faces, volume {:.4} ({:.1} % of the round shape)",
            topology.vertices,
            topology.edges,
            topology.faces,
            mesh.signed_volume(),
            100.0 * mesh.signed_volume() / round
        );
    }
    Ok(())
}
