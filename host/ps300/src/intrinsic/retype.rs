//! Turning a message into one of another kind.

use glam::{DVec2, DVec3, DVec4};

use super::function::{Fault, Inputs, Outputs, domain};
use super::numbers::integer;
use super::spec::{Confidence, InputSpec, OutputSpec, Spec};
use super::text::printed;
use crate::value::{Kind, Kinds, Value};

pub(super) const TABLE: &[Spec] = &[Spec::pure(
    "CHANGEQTYPE",
    &[InputSpec::active(Kinds::ANY), InputSpec::required(Kinds::STRING)],
    &[OutputSpec::of(Kinds::ANY)],
    change,
)
.says(
    "<1> as a message of the kind named <2>: 'boolean', 'integer', 'real', 'string', \
             'vector2', 'vector3', 'vector4'. A number is TRUE unless it is 0, and loses its fraction \
             as an integer; a string is read; a vector gains zeros or loses its last components, a \
             number becomes its first. What has no such form is reported and gives nothing.",
)
.known(
    Confidence::Low,
    "recollected: gives a message another type; which, and how, ours",
)
.example("<2> 'integer' | <1> 2.9 | <1> '7' | <1> TRUE -> <1> FIX(2) | <1> FIX(7) | <1> FIX(1)")];

fn change(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (value, named) = (inputs.get(1), inputs.text(2)?);
    let Some(kind) = Kind::ALL
        .into_iter()
        .find(|kind| kind.name().eq_ignore_ascii_case(named))
    else {
        return domain("there is no kind of that name");
    };
    if kind == value.kind() {
        outputs.send(1, value.clone());
        return Ok(());
    }
    match kind {
        Kind::Boolean => outputs.send(1, number(value)? != 0.0),
        Kind::Integer => outputs.send(1, integer(number(value)?.trunc())?),
        Kind::Real => outputs.send(1, number(value)?),
        Kind::String => outputs.send_text(1, &printed(value))?,
        Kind::Vector2 => outputs.send(1, components(value)?.truncate().truncate()),
        Kind::Vector3 => outputs.send(1, components(value)?.truncate()),
        Kind::Vector4 => outputs.send(1, components(value)?),
        _ => return NO_FORM,
    }
    Ok(())
}

const NO_FORM: Result<(), Fault> = Err(Fault::Domain { why: WHY });
const WHY: &str = "the message has no form of that kind";

fn number(value: &Value) -> Result<f64, Fault> {
    match value {
        Value::Boolean(b) => Ok(f64::from(u8::from(*b))),
        Value::String(text) if text.eq_ignore_ascii_case("TRUE") => Ok(1.0),
        Value::String(text) if text.eq_ignore_ascii_case("FALSE") => Ok(0.0),
        Value::String(text) => match text.trim().parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            _ => domain(WHY),
        },
        other => other.as_number().map_or_else(|| domain(WHY), Ok),
    }
}

fn components(value: &Value) -> Result<DVec4, Fault> {
    Ok(match value {
        Value::Vector2(DVec2 { x, y }) => DVec4::new(*x, *y, 0.0, 0.0),
        Value::Vector3(DVec3 { x, y, z }) => DVec4::new(*x, *y, *z, 0.0),
        Value::Vector4(v) => **v,
        other => DVec4::new(number(other)?, 0.0, 0.0, 0.0),
    })
}
