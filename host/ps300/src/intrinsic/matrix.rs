//! Matrices from rows and from scales. Rows, because literals are rows; they act on column vectors.

use glam::{DMat2, DMat3, DMat4, DVec3};

use super::function::{Fault, Inputs, Outputs};
use super::spec::{Confidence, InputSpec, OutputSpec, Spec};
use crate::value::{Kind, Kinds, Value};

const V2: InputSpec = InputSpec::active(Kinds::of(&[Kind::Vector2]));
const V3: InputSpec = InputSpec::active(Kinds::of(&[Kind::Vector3]));
const V4: InputSpec = InputSpec::active(Kinds::of(&[Kind::Vector4]));

pub(super) const TABLE: &[Spec] = &[
    Spec::pure(
        "MATRIX2",
        &[V2, V2],
        &[OutputSpec::of(Kinds::of(&[Kind::Matrix2]))],
        matrix2,
    )
    .says("The 2x2 matrix with <1>, <2> as its rows.")
    .known(Confidence::High, "recollected")
    .example("<1> V2D(1,2) | <2> V2D(3,4) -> <1> M2D(1,2,3,4)"),
    Spec::pure(
        "MATRIX3",
        &[V3, V3, V3],
        &[OutputSpec::of(Kinds::of(&[Kind::Matrix3]))],
        matrix3,
    )
    .says("The 3x3 matrix with <1>, <2>, <3> as its rows.")
    .known(Confidence::Used, "D0 viewing networks")
    .example("<1> V3D(1,2,3) | <2> V3D(4,5,6) | <3> V3D(7,8,9) -> <1> M3D(1,2,3,4,5,6,7,8,9)"),
    Spec::pure(
        "MATRIX4",
        &[V4, V4, V4, V4],
        &[OutputSpec::of(Kinds::of(&[Kind::Matrix4]))],
        matrix4,
    )
    .says("The 4x4 matrix with <1> to <4> as its rows.")
    .known(Confidence::High, "recollected")
    .example(
        "<1> V4D(1,2,3,4) | <2> V4D(5,6,7,8) | <3> V4D(9,1,2,3) | <4> V4D(4,5,6,7) -> <1> \
             M4D(1,2,3,4,5,6,7,8,9,1,2,3,4,5,6,7)",
    ),
    Spec::pure(
        "SCALE",
        &[InputSpec::active(Kinds::NUMBER.or(Kinds::of(&[Kind::Vector3])))],
        &[OutputSpec::of(Kinds::of(&[Kind::Matrix3]))],
        scale,
    )
    .says("The scaling by a number, or by a factor for each axis.")
    .known(Confidence::Used, "D0 dial networks, with a vector")
    .example("<1> 2 | <1> V3D(1,2,3) -> <1> M3D(2,0,0, 0,2,0, 0,0,2) | <1> M3D(1,0,0, 0,2,0, 0,0,3)"),
    Spec::pure(
        "CROTATE",
        &[InputSpec::active(Kinds::NUMBER)],
        &[OutputSpec::of(Kinds::of(&[Kind::Matrix2]))],
        crotate,
    )
    .says("The 2x2 rotation of characters by an angle in degrees.")
    .known(Confidence::Medium, "recollected")
    .example("<1> 90 -> <1> M2D(0,-1,1,0)"),
    Spec::pure(
        "CSCALE",
        &[InputSpec::active(Kinds::NUMBER.or(Kinds::of(&[Kind::Vector2])))],
        &[OutputSpec::of(Kinds::of(&[Kind::Matrix2]))],
        cscale,
    )
    .says("The 2x2 scaling of characters by a number, or by a factor for each axis.")
    .known(Confidence::Medium, "recollected")
    .example("<1> 2 | <1> V2D(1,3) -> <1> M2D(2,0,0,2) | <1> M2D(1,0,0,3)"),
];

fn matrix2(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let row = |number| match inputs.get(number) {
        Value::Vector2(v) => Ok(*v),
        _ => Err(Fault::Kind {
            input: number,
            expected: Kind::Vector2.into(),
        }),
    };
    outputs.send(1, DMat2::from_cols(row(1)?, row(2)?).transpose());
    Ok(())
}

fn matrix3(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let rows = DMat3::from_cols(inputs.vector3(1)?, inputs.vector3(2)?, inputs.vector3(3)?);
    outputs.send(1, rows.transpose());
    Ok(())
}

fn matrix4(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let row = |number| match inputs.get(number) {
        Value::Vector4(v) => Ok(**v),
        _ => Err(Fault::Kind {
            input: number,
            expected: Kind::Vector4.into(),
        }),
    };
    outputs.send(
        1,
        DMat4::from_cols(row(1)?, row(2)?, row(3)?, row(4)?).transpose(),
    );
    Ok(())
}

fn scale(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let factors = match inputs.get(1) {
        Value::Vector3(factors) => *factors,
        _ => DVec3::splat(inputs.number(1)?),
    };
    outputs.send(1, DMat3::from_diagonal(factors));
    Ok(())
}

fn crotate(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    outputs.send(1, DMat2::from_angle(inputs.number(1)?.to_radians()));
    Ok(())
}

fn cscale(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let factors = match inputs.get(1) {
        Value::Vector2(factors) => *factors,
        _ => glam::DVec2::splat(inputs.number(1)?),
    };
    outputs.send(1, DMat2::from_diagonal(factors));
    Ok(())
}
