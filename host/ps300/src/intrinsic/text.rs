//! Strings: printing, joining, measuring, reading.

use std::fmt::Write;

use super::function::{Fault, Inputs, Outputs, domain};
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kinds, Value};

const TEXT: InputSpec = InputSpec::active(Kinds::STRING);
const STORED: InputSpec = InputSpec::constant(Kinds::STRING, Preset::Required);
const OUT: &[OutputSpec] = &[OutputSpec::of(Kinds::STRING)];

pub(super) const TABLE: &[Spec] = &[
    Spec::pure(
        "PRINT",
        &[
            InputSpec::active(Kinds::ANY),
            InputSpec::constant(Kinds::BOOLEAN, Preset::Boolean(false)),
        ],
        OUT,
        print,
    )
    .says(
        "The value as text: an integer as digits, a vector as V and its components with commas \
             between, a matrix as M and its components row by row. The format switch <2> is taken and \
             has no effect.",
    )
    .known(
        Confidence::Used,
        "D0 tablet networks; what the switch did is not known",
    )
    .example(
        "<1> FIX(12) | <1> V2D(0.5,-1) | <1> TRUE | <1> 'x' -> <1> '12' | <1> 'V0.5,-1' | <1> \
             'TRUE' | <1> 'x'",
    ),
    Spec::pure("CONCATENATE", &[TEXT, TEXT], OUT, concatenate)
        .says("<1> followed by <2>; at most 4096 bytes.")
        .known(Confidence::Used, "D0 tablet networks")
        .example("<1> 'a' | <2> 'b' -> <1> 'ab'"),
    Spec::pure("CONCATENATEC", &[TEXT, STORED], OUT, concatenate)
        .says("As CONCATENATE, <2> constant.")
        .known(Confidence::High, "recollected")
        .example("<2> 'b' | <1> 'a' -> <1> 'ab'"),
    Spec::pure("CCONCATENATE", &[STORED, TEXT], OUT, concatenate)
        .says("As CONCATENATE, <1> constant.")
        .known(Confidence::High, "recollected")
        .example("<1> 'a' | <2> 'b' -> <1> 'ab'"),
    Spec::pure(
        "LENGTH_STRING",
        &[TEXT],
        &[OutputSpec::of(Kinds::INTEGER)],
        |i, o| {
            o.send(1, i.text(1)?.chars().count() as i32);
            Ok(())
        },
    )
    .says("The number of characters.")
    .known(Confidence::Low, "name recollected; pins ours")
    .example("<1> 'abc' -> <1> FIX(3)"),
    Spec::pure(
        "STRING_TO_NUM",
        &[TEXT],
        &[OutputSpec::of(Kinds::REAL)],
        string_to_num,
    )
    .says(
        "The number a string spells, as a real; spaces around it do not matter. Anything else is \
             reported and gives nothing.",
    )
    .known(Confidence::Low, "name recollected; pins ours")
    .example("<1> ' 1.5 ' -> <1> 1.5"),
];

fn print(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    match inputs.get(1) {
        text @ Value::String(_) => outputs.send(1, text.clone()),
        value => {
            outputs.send_text(1, &printed(value))?;
        }
    }
    Ok(())
}

/// A value as PRINT writes it.
pub(super) fn printed(value: &Value) -> String {
    let mut text = String::new();
    write_value(&mut text, value);
    text
}

/// The same, added to a text. Numbers in the shortest form that reads back the same.
fn write_value(text: &mut String, value: &Value) {
    // Writing to a string cannot fail.
    let _ = match value {
        Value::Boolean(b) => text.write_str(if *b { "TRUE" } else { "FALSE" }),
        Value::Integer(n) => write!(text, "{n}"),
        Value::Real(x) => write!(text, "{x}"),
        Value::String(s) => text.write_str(s),
        Value::Vector2(v) => components(text, 'V', &v.to_array()),
        Value::Vector3(v) => components(text, 'V', &v.to_array()),
        Value::Vector4(v) => components(text, 'V', &v.to_array()),
        Value::Matrix2(m) => components(text, 'M', &m.transpose().to_cols_array()),
        Value::Matrix3(m) => components(text, 'M', &m.transpose().to_cols_array()),
        Value::Matrix4(m) => components(text, 'M', &m.transpose().to_cols_array()),
        Value::Matrix4x3(m) => {
            let rows = glam::DMat4::from(**m).transpose().to_cols_array();
            components(text, 'M', &rows[..12])
        }
        Value::Vectors(list) => write!(text, "{} vectors", list.vectors.len()),
        Value::Picks(picks) => write!(text, "{} picks", picks.len()),
    };
}

fn components(text: &mut String, letter: char, components: &[f64]) -> std::fmt::Result {
    text.write_char(letter)?;
    for (index, component) in components.iter().enumerate() {
        if index > 0 {
            text.write_char(',')?;
        }
        write!(text, "{component}")?;
    }
    Ok(())
}

fn concatenate(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (first, second) = (inputs.text(1)?, inputs.text(2)?);
    let mut joined = String::with_capacity(first.len() + second.len());
    joined.push_str(first);
    joined.push_str(second);
    outputs.send_text(1, &joined)
}

fn string_to_num(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    match inputs.text(1)?.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => {
            outputs.send(1, number);
            Ok(())
        }
        _ => domain("the text is not a number"),
    }
}
