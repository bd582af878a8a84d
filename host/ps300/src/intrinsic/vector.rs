//! Vectors from numbers and back.

use glam::{DVec2, DVec3, DVec4};

use super::function::{Fault, Inputs, Outputs};
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kind, Kinds, Value};

const AXIS_IN: &[InputSpec] = &[InputSpec::active(Kinds::NUMBER)];
const AXIS_OUT: &[OutputSpec] = &[OutputSpec::of(Kinds::of(&[Kind::Vector3]))];
const EXTENDED: Kinds = Kinds::NUMBER.or(Kinds::of(&[Kind::Vector2, Kind::Vector3]));
const REAL: OutputSpec = OutputSpec::of(Kinds::REAL);

pub(super) const TABLE: &[Spec] = &[
    Spec::pure("XVECTOR", AXIS_IN, AXIS_OUT, |i, o| axis(i, o, DVec3::X))
        .says("The number on the x axis, zeros elsewhere.")
        .known(Confidence::Used, "D0 dial networks")
        .example("<1> 2 -> <1> V3D(2,0,0)"),
    Spec::pure("YVECTOR", AXIS_IN, AXIS_OUT, |i, o| axis(i, o, DVec3::Y))
        .says("The number on the y axis, zeros elsewhere.")
        .known(Confidence::Used, "D0 dial networks")
        .example("<1> 2 -> <1> V3D(0,2,0)"),
    Spec::pure("ZVECTOR", AXIS_IN, AXIS_OUT, |i, o| axis(i, o, DVec3::Z))
        .says("The number on the z axis, zeros elsewhere.")
        .known(Confidence::Used, "D0 dial networks")
        .example("<1> FIX(2) -> <1> V3D(0,0,2)"),
    Spec::pure(
        "VEC",
        &[InputSpec::active(EXTENDED), InputSpec::active(Kinds::NUMBER)],
        &[OutputSpec::of(Kinds::VECTOR)],
        vec,
    )
    .says(
        "<1> extended by the number <2>: two numbers give a 2D vector, a 2D vector a 3D one, a 3D \
             vector a 4D one.",
    )
    .known(Confidence::Medium, "recollected")
    .example("<1> 1 | <2> 2 -> <1> V2D(1,2)"),
    Spec::pure(
        "VECC",
        &[
            InputSpec::active(EXTENDED),
            InputSpec::constant(Kinds::NUMBER, Preset::Required),
        ],
        &[OutputSpec::of(Kinds::VECTOR)],
        vec,
    )
    .says("As VEC, <2> constant.")
    .known(Confidence::Medium, "recollected")
    .example("<2> 4 | <1> V3D(1,2,3) -> <1> V4D(1,2,3,4)"),
    Spec::pure(
        "CVEC",
        &[
            InputSpec::constant(EXTENDED, Preset::Required),
            InputSpec::active(Kinds::NUMBER),
        ],
        &[OutputSpec::of(Kinds::VECTOR)],
        vec,
    )
    .says("As VEC, <1> constant.")
    .known(Confidence::Medium, "recollected")
    .example("<1> 1 | <2> 2 -> <1> V2D(1,2)"),
    Spec::pure(
        "PARTS",
        &[InputSpec::active(Kinds::VECTOR)],
        &[REAL, REAL, REAL, REAL],
        parts,
    )
    .says(
        "The components of a vector, one on each output, in order; outputs beyond its dimension \
             stay silent.",
    )
    .known(Confidence::Medium, "recollected")
    .example("<1> V3D(1,2,3) -> <1> 1 | <2> 2 | <3> 3"),
];

fn axis(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>, along: DVec3) -> Result<(), Fault> {
    outputs.send(1, along * inputs.number(1)?);
    Ok(())
}

fn vec(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let last = inputs.number(2)?;
    match inputs.get(1) {
        Value::Vector2(v) => outputs.send(1, v.extend(last)),
        Value::Vector3(v) => outputs.send(1, v.extend(last)),
        _ => outputs.send(1, DVec2::new(inputs.number(1)?, last)),
    }
    Ok(())
}

fn parts(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (components, count) = match inputs.get(1) {
        Value::Vector2(v) => (DVec4::new(v.x, v.y, 0.0, 0.0), 2),
        Value::Vector3(v) => (v.extend(0.0), 3),
        Value::Vector4(v) => (**v, 4),
        _ => {
            return Err(Fault::Kind {
                input: 1,
                expected: Kinds::VECTOR,
            });
        }
    };
    for (output, component) in (1..).zip(components.to_array().into_iter().take(count)) {
        outputs.send(output, component);
    }
    Ok(())
}
