//! Viewing matrices: where the eye is, and what of the world the picture holds.

use glam::DVec3;

use super::function::{Fault, Inputs, Outputs, domain};
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::structure::projection::{self, NoView};
use crate::value::{Kind, Kinds};

const POINT: Kinds = Kinds::of(&[Kind::Vector3]);
const NUMBER: InputSpec = InputSpec::constant(Kinds::NUMBER, Preset::Required);
const ABOVE: InputSpec = InputSpec::constant(POINT, Preset::Rule("straight above the eye: FROM + (0,1,0)"));
const LOOK_OUT: &[OutputSpec] = &[OutputSpec::of(Kinds::of(&[Kind::Matrix4x3]))];
const VIEW_OUT: &[OutputSpec] = &[OutputSpec::of(Kinds::of(&[Kind::Matrix4]))];

pub(super) const TABLE: &[Spec] = &[
    Spec::pure(
        "LOOKAT",
        &[
            InputSpec::active(POINT),
            InputSpec::constant(POINT, Preset::Required),
            ABOVE,
        ],
        LOOK_OUT,
        |i, o| look(i, o, i.vector3(1)?, i.vector3(2)?),
    )
    .says(
        "The viewing matrix, three rows of four, of an eye at <2> that looks at <1> with the \
             point <3> above it: the eye goes to the origin, <1> to the positive z axis. An eye at \
             the point it looks at, or with <3> in line, is reported and gives nothing.",
    )
    .known(
        Confidence::Used,
        "D0 viewing networks for the inputs; the kind of the result recollected; UP as a point \
             ours",
    )
    .example("<2> V3D(0,0,-5) | <1> V3D(0,0,0) -> <1> M4X3 1 0 0 0 0 1 0 0 0 0 1 5"),
    Spec::pure(
        "LOOKFROM",
        &[
            InputSpec::active(POINT),
            InputSpec::constant(POINT, Preset::Required),
            ABOVE,
        ],
        LOOK_OUT,
        |i, o| look(i, o, i.vector3(2)?, i.vector3(1)?),
    )
    .says("As LOOKAT, with the eye at <1> looking at <2>.")
    .known(Confidence::Medium, "recollected")
    .example("<2> V3D(0,0,0) | <1> V3D(-5,0,0) -> <1> M4X3 0 0 -1 0 0 1 0 0 1 0 0 5"),
    Spec::pure(
        "FOV",
        &[InputSpec::active(Kinds::ANY), NUMBER, NUMBER, NUMBER],
        VIEW_OUT,
        fov,
    )
    .says(
        "Every message at <1>, of any kind, sends the perspective of the full angle <2> in \
             degrees with clipping planes <3> in front and <4> behind: the picture spans -1 to 1, \
             depth 0 to 1.",
    )
    .known(
        Confidence::Used,
        "D0 viewing networks for the inputs; angle, range and depth ours",
    )
    .example("<2> 90 | <3> 1 | <4> 2 | <1> TRUE -> <1> M4D(1,0,0,0, 0,1,0,0, 0,0,2,-2, 0,0,1,0)"),
    Spec::pure(
        "WINDOW",
        &[
            InputSpec::active(Kinds::ANY),
            NUMBER,
            NUMBER,
            NUMBER,
            NUMBER,
            NUMBER,
            NUMBER,
        ],
        VIEW_OUT,
        window,
    )
    .says(
        "Every message at <1>, of any kind, sends the parallel projection of x from <2> to <3>, y \
             from <4> to <5>, with clipping planes <6> in front and <7> behind: the picture spans -1 \
             to 1, depth 0 to 1.",
    )
    .known(
        Confidence::Used,
        "D0 viewing networks for the inputs; range and depth ours",
    )
    .example(
        "<2> 0 | <3> 4 | <4> -1 | <5> 1 | <6> 0 | <7> 10 | <1> TRUE -> <1> M4D(0.5,0,0,-1, \
             0,1,0,0, 0,0,0.1,0, 0,0,0,1)",
    ),
];

fn look(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>, at: DVec3, from: DVec3) -> Result<(), Fault> {
    let up = inputs.find(3).map(|_| inputs.vector3(3)).transpose()?;
    match projection::look(at, from, up) {
        Ok(matrix) => outputs.send(1, matrix),
        Err(NoView(why)) => return domain(why),
    }
    Ok(())
}

fn fov(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    match projection::perspective(inputs.number(2)?, inputs.number(3)?, inputs.number(4)?) {
        Ok(matrix) => outputs.send(1, matrix),
        Err(NoView(why)) => return domain(why),
    }
    Ok(())
}

fn window(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let n = |number| inputs.number(number);
    match projection::parallel([n(2)?, n(3)?], [n(4)?, n(5)?], Some([n(6)?, n(7)?])) {
        Ok(matrix) => outputs.send(1, matrix),
        Err(NoView(why)) => return domain(why),
    }
    Ok(())
}
