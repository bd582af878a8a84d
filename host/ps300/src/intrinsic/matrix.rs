//! Matrices from rows and from scales. Rows, because literals are rows; they act on column vectors.

use glam::{DMat2, DMat3, DMat4, DVec3};

use super::function::{Fault, Inputs, Outputs};
use super::spec::{Confidence, Does, InputSpec, OutputSpec, Spec};
use crate::value::{Kind, Kinds, Value};

const V2: InputSpec = InputSpec::active(Kinds::of(&[Kind::Vector2]));
const V3: InputSpec = InputSpec::active(Kinds::of(&[Kind::Vector3]));
const V4: InputSpec = InputSpec::active(Kinds::of(&[Kind::Vector4]));

macro_rules! row {
    ($name:literal, $inputs:expr, $out:ident, $does:expr, $behaviour:literal, $source:literal, $confidence:ident) => {
        Spec {
            name: $name,
            sizes: None,
            inputs: $inputs,
            outputs: &[OutputSpec::of(Kinds::of(&[Kind::$out]))],
            does: Does::Pure($does),
            behaviour: $behaviour,
            source: $source,
            confidence: Confidence::$confidence,
        }
    };
}

pub(super) const TABLE: &[Spec] = &[
    row!(
        "MATRIX2",
        &[V2, V2],
        Matrix2,
        matrix2,
        "The 2x2 matrix with <1>, <2> as its rows.",
        "recollected",
        High
    ),
    row!(
        "MATRIX3",
        &[V3, V3, V3],
        Matrix3,
        matrix3,
        "The 3x3 matrix with <1>, <2>, <3> as its rows.",
        "D0 viewing networks",
        Used
    ),
    row!(
        "MATRIX4",
        &[V4, V4, V4, V4],
        Matrix4,
        matrix4,
        "The 4x4 matrix with <1> to <4> as its rows.",
        "recollected",
        High
    ),
    row!(
        "SCALE",
        &[InputSpec::active(Kinds::NUMBER.or(Kinds::of(&[Kind::Vector3])))],
        Matrix3,
        scale,
        "The scaling by a number, or by a factor for each axis.",
        "D0 dial networks, with a vector",
        Used
    ),
    row!(
        "CROTATE",
        &[InputSpec::active(Kinds::NUMBER)],
        Matrix2,
        crotate,
        "The 2x2 rotation of characters by an angle in degrees.",
        "recollected",
        Medium
    ),
    row!(
        "CSCALE",
        &[InputSpec::active(Kinds::NUMBER.or(Kinds::of(&[Kind::Vector2])))],
        Matrix2,
        cscale,
        "The 2x2 scaling of characters by a number, or by a factor for each axis.",
        "recollected",
        Medium
    ),
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
