//! Sums, products and their inverses of two messages.
//!
//! Trailing C: input 2 is constant; leading C: input 1. An integer with a real gives a real.

use glam::{DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};

use super::function::{Fault, Inputs, Outputs, domain};
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kind, Kinds, Value};

const LIKE: Kinds =
    Kinds::NUMBER
        .or(Kinds::VECTOR)
        .or(Kinds::of(&[Kind::Matrix2, Kind::Matrix3, Kind::Matrix4]));
const SCALED: Kinds = Kinds::NUMBER.or(Kinds::VECTOR);

const BOTH: &[InputSpec] = &[InputSpec::active(LIKE), InputSpec::active(LIKE)];
const SECOND: &[InputSpec] = &[
    InputSpec::active(LIKE),
    InputSpec::constant(LIKE, Preset::Required),
];
const FIRST: &[InputSpec] = &[
    InputSpec::constant(LIKE, Preset::Required),
    InputSpec::active(LIKE),
];
const OUT: &[OutputSpec] = &[OutputSpec::of(LIKE)];

const DIV_BOTH: &[InputSpec] = &[InputSpec::active(SCALED), InputSpec::active(Kinds::NUMBER)];
const DIV_SECOND: &[InputSpec] = &[
    InputSpec::active(SCALED),
    InputSpec::constant(Kinds::NUMBER, Preset::Required),
];
const DIV_FIRST: &[InputSpec] = &[
    InputSpec::constant(SCALED, Preset::Required),
    InputSpec::active(Kinds::NUMBER),
];

pub(super) const TABLE: &[Spec] = &[
    Spec::pure("ADD", BOTH, OUT, add)
        .scalar(|a, b| a + b)
        .says("<1> + <2>: numbers, or vectors or matrices of one kind.")
        .known(Confidence::High, "recollected")
        .example("<1> 1 | <1> 2 | <2> 10 | <2> 20 -> <1> 11 | <1> 22"),
    Spec::pure("ADDC", SECOND, OUT, add)
        .scalar(|a, b| a + b)
        .says("As ADD, <2> constant.")
        .known(Confidence::Used, "D0 tablet networks, with integers")
        .example("<2> 1 | <1> 1 | <2> 2 | <1> 1 -> <1> 2 | <1> 3"),
    Spec::pure("SUB", BOTH, OUT, sub)
        .scalar(|a, b| a - b)
        .says("<1> - <2>: numbers, or vectors or matrices of one kind.")
        .known(Confidence::High, "recollected")
        .example("<1> 5 | <2> 3 -> <1> 2"),
    Spec::pure("SUBC", SECOND, OUT, sub)
        .scalar(|a, b| a - b)
        .says("As SUB, <2> constant.")
        .known(Confidence::Used, "D0 tablet networks")
        .example("<2> FIX(1) | <1> FIX(5) -> <1> FIX(4)"),
    Spec::pure("CSUB", FIRST, OUT, sub)
        .scalar(|a, b| a - b)
        .says("As SUB, <1> constant.")
        .known(Confidence::High, "recollected")
        .example("<1> 10 | <2> 3 -> <1> 7"),
    Spec::pure("MUL", BOTH, OUT, mul)
        .scalar(|a, b| a * b)
        .says(
            "<1> times <2>: numbers; a number and a vector or matrix; two matrices of one kind, <1> \
             on the left; a matrix and a vector of as many components, which the matrix acts on as a \
             column in either order.",
        )
        .known(Confidence::Medium, "recollected; the side of the vector ours")
        .example("<1> 2 | <2> V3D(1,2,3) -> <1> V3D(2,4,6)"),
    Spec::pure("MULC", SECOND, OUT, mul)
        .scalar(|a, b| a * b)
        .says("As MUL, <2> constant.")
        .known(Confidence::Used, "D0 dial networks, with reals")
        .example("<2> 0.2 | <1> 10 -> <1> 2"),
    Spec::pure("CMUL", FIRST, OUT, mul)
        .scalar(|a, b| a * b)
        .says("As MUL, <1> constant.")
        .known(Confidence::High, "recollected")
        .example("<1> M3D(1,0,0, 0,0,-1, 0,1,0) | <2> V3D(0,1,0) -> <1> V3D(0,0,1)"),
    Spec::pure("DIV", DIV_BOTH, &[OutputSpec::of(SCALED)], div)
        .says(
            "<1> divided by <2>: numbers, or a vector by a number. Two integers give an integer, cut \
             off towards zero. Division by zero is reported and gives nothing.",
        )
        .known(Confidence::Medium, "recollected; integers ours")
        .example("<1> FIX(7) | <2> FIX(-2) -> <1> FIX(-3)"),
    Spec::pure("DIVC", DIV_SECOND, &[OutputSpec::of(SCALED)], div)
        .says("As DIV, <2> constant.")
        .known(Confidence::Medium, "recollected")
        .example("<2> 4 | <1> 1 -> <1> 0.25"),
    Spec::pure("CDIV", DIV_FIRST, &[OutputSpec::of(SCALED)], div)
        .says("As DIV, <1> constant.")
        .known(Confidence::Medium, "recollected")
        .example("<1> 1 | <2> 4 -> <1> 0.25"),
    Spec::pure(
        "MOD",
        &[
            InputSpec::active(Kinds::INTEGER),
            InputSpec::active(Kinds::INTEGER),
        ],
        &[OutputSpec::of(Kinds::INTEGER)],
        modulo,
    )
    .says(
        "The remainder of <1> divided by <2>, of the sign of <1>. Division by zero is reported \
             and gives nothing.",
    )
    .known(Confidence::Medium, "recollected; sign ours")
    .example("<1> FIX(-7) | <2> FIX(3) -> <1> FIX(-1)"),
    Spec::pure(
        "MODC",
        &[
            InputSpec::active(Kinds::INTEGER),
            InputSpec::constant(Kinds::INTEGER, Preset::Required),
        ],
        &[OutputSpec::of(Kinds::INTEGER)],
        modulo,
    )
    .says("As MOD, <2> constant.")
    .known(Confidence::Medium, "recollected")
    .example("<2> FIX(4) | <1> FIX(7) -> <1> FIX(3)"),
];

const OVERFLOW: &str = "the result does not fit an integer of 32 bits";

fn whole(result: Option<i32>) -> Result<Value, Fault> {
    result.map_or_else(|| domain(OVERFLOW), |n| Ok(Value::Integer(n)))
}

/// What <2> would have to be to go with <1>.
fn like(first: &Value) -> Kinds {
    if first.as_number().is_some() {
        Kinds::NUMBER
    } else {
        first.kind().into()
    }
}

fn add(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (a, b) = (inputs.get(1), inputs.get(2));
    let sum = match (a, b) {
        (Value::Integer(a), Value::Integer(b)) => whole(a.checked_add(*b))?,
        (Value::Vector2(a), Value::Vector2(b)) => (*a + *b).into(),
        (Value::Vector3(a), Value::Vector3(b)) => (*a + *b).into(),
        (Value::Vector4(a), Value::Vector4(b)) => (**a + **b).into(),
        (Value::Matrix2(a), Value::Matrix2(b)) => (**a + **b).into(),
        (Value::Matrix3(a), Value::Matrix3(b)) => (**a + **b).into(),
        (Value::Matrix4(a), Value::Matrix4(b)) => (**a + **b).into(),
        _ => (number(a)? + number_like(a, b)?).into(),
    };
    outputs.send(1, sum);
    Ok(())
}

fn sub(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (a, b) = (inputs.get(1), inputs.get(2));
    let difference = match (a, b) {
        (Value::Integer(a), Value::Integer(b)) => whole(a.checked_sub(*b))?,
        (Value::Vector2(a), Value::Vector2(b)) => (*a - *b).into(),
        (Value::Vector3(a), Value::Vector3(b)) => (*a - *b).into(),
        (Value::Vector4(a), Value::Vector4(b)) => (**a - **b).into(),
        (Value::Matrix2(a), Value::Matrix2(b)) => (**a - **b).into(),
        (Value::Matrix3(a), Value::Matrix3(b)) => (**a - **b).into(),
        (Value::Matrix4(a), Value::Matrix4(b)) => (**a - **b).into(),
        _ => (number(a)? - number_like(a, b)?).into(),
    };
    outputs.send(1, difference);
    Ok(())
}

fn number(value: &Value) -> Result<f64, Fault> {
    value.as_number().ok_or(Fault::Kind {
        input: 2,
        expected: value.kind().into(),
    })
}

fn number_like(a: &Value, b: &Value) -> Result<f64, Fault> {
    b.as_number().ok_or_else(|| Fault::Kind {
        input: 2,
        expected: like(a),
    })
}

fn mul(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (a, b) = (inputs.get(1), inputs.get(2));
    let product = match (a, b) {
        (Value::Integer(a), Value::Integer(b)) => whole(a.checked_mul(*b))?,
        (Value::Matrix2(a), Value::Matrix2(b)) => (**a * **b).into(),
        (Value::Matrix3(a), Value::Matrix3(b)) => (**a * **b).into(),
        (Value::Matrix4(a), Value::Matrix4(b)) => (**a * **b).into(),
        (Value::Matrix2(m), Value::Vector2(v)) | (Value::Vector2(v), Value::Matrix2(m)) => (**m * *v).into(),
        (Value::Matrix3(m), Value::Vector3(v)) | (Value::Vector3(v), Value::Matrix3(m)) => (**m * *v).into(),
        (Value::Matrix4(m), Value::Vector4(v)) | (Value::Vector4(v), Value::Matrix4(m)) => (**m * **v).into(),
        _ => match (a.as_number(), b.as_number()) {
            (Some(a), Some(b)) => (a * b).into(),
            (Some(a), None) => scaled(b, a).ok_or(Fault::Kind {
                input: 2,
                expected: LIKE,
            })?,
            (None, Some(b)) => scaled(a, b).ok_or(Fault::Kind {
                input: 1,
                expected: LIKE,
            })?,
            (None, None) => {
                return Err(Fault::Kind {
                    input: 2,
                    expected: factors(a),
                });
            }
        },
    };
    outputs.send(1, product);
    Ok(())
}

fn scaled(value: &Value, by: f64) -> Option<Value> {
    Some(match value {
        Value::Vector2(v) => DVec2::new(v.x * by, v.y * by).into(),
        Value::Vector3(v) => DVec3::new(v.x * by, v.y * by, v.z * by).into(),
        Value::Vector4(v) => DVec4::new(v.x * by, v.y * by, v.z * by, v.w * by).into(),
        Value::Matrix2(m) => DMat2::from_cols_array(&m.to_cols_array().map(|x| x * by)).into(),
        Value::Matrix3(m) => DMat3::from_cols_array(&m.to_cols_array().map(|x| x * by)).into(),
        Value::Matrix4(m) => DMat4::from_cols_array(&m.to_cols_array().map(|x| x * by)).into(),
        _ => return None,
    })
}

/// What goes with <1> in a product.
fn factors(first: &Value) -> Kinds {
    match first.kind() {
        Kind::Vector2 | Kind::Matrix2 => Kinds::NUMBER | Kinds::of(&[Kind::Vector2, Kind::Matrix2]),
        Kind::Vector3 | Kind::Matrix3 => Kinds::NUMBER | Kinds::of(&[Kind::Vector3, Kind::Matrix3]),
        _ => Kinds::NUMBER | Kinds::of(&[Kind::Vector4, Kind::Matrix4]),
    }
}

fn div(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (a, b) = (inputs.get(1), inputs.get(2));
    let by = inputs.number(2)?;
    if by == 0.0 {
        return domain("division by zero");
    }
    let quotient = match (a, b) {
        (Value::Integer(a), Value::Integer(b)) => whole(a.checked_div(*b))?,
        _ => match a {
            Value::Vector2(v) => (*v / by).into(),
            Value::Vector3(v) => (*v / by).into(),
            Value::Vector4(v) => (**v / by).into(),
            _ => (inputs.number(1)? / by).into(),
        },
    };
    outputs.send(1, quotient);
    Ok(())
}

fn modulo(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    match inputs.integer(2)? {
        0 => domain("division by zero"),
        by => {
            outputs.send(1, inputs.integer(1)?.checked_rem(by).unwrap_or(0));
            Ok(())
        }
    }
}
