//! Editing data by message: vector lists, curves, characters, labels.

use super::curve::Curve;
use super::inlet::point;
use crate::intrinsic::TEXT_MAX_BYTES;
use crate::language::{Characters, Dimension, Input, Label, Labels, Text, Vector, VectorClass, VectorList};
use crate::network::Refusal;
use crate::value::Value;

/// Ink beyond this is refused: at 60 vectors a second it is eighteen minutes of drawing.
const VECTORS_MAX: usize = 65_536;

pub(super) fn vectors(list: &mut VectorList, input: Input, value: &Value) -> Result<(), Refusal> {
    match input {
        Input::Append => match value {
            Value::Vectors(more) => more
                .vectors
                .iter()
                .try_for_each(|vector| add_at(list, vector.at, vector.draw)),
            value => add(list, value, true),
        },
        Input::Position => {
            if list.class != VectorClass::Dots {
                list.class = VectorClass::Itemized; // A move in the middle; the others keep what they were.
            }
            add(list, value, false)
        }
        Input::Last => replace(list.vectors.last_mut(), value, "the vector list is empty"),
        Input::Number(number) => {
            let vector = usize::from(number)
                .checked_sub(1)
                .and_then(|index| list.vectors.get_mut(index));
            replace(vector, value, "the vector list has no vector of that number")
        }
        Input::Delete => {
            let kept = list.vectors.len().saturating_sub(count(value)?);
            list.vectors.truncate(kept);
            Ok(())
        }
        Input::Clear => {
            list.vectors.clear();
            Ok(())
        }
        Input::Step | Input::Substitute => Ok(()),
    }
}

fn add(list: &mut VectorList, value: &Value, line: bool) -> Result<(), Refusal> {
    if matches!(value, Value::Vector3(_)) {
        list.dimension = Dimension::Three;
    }
    add_at(list, point(value)?, line)
}

fn add_at(list: &mut VectorList, at: glam::DVec3, line: bool) -> Result<(), Refusal> {
    if list.vectors.len() >= VECTORS_MAX {
        return Err(Refusal::Domain("the vector list is full at 65536 vectors"));
    }
    let draw = list
        .class
        .draws(list.vectors.len())
        .unwrap_or(line && !list.vectors.is_empty());
    list.vectors.push(Vector {
        at,
        draw,
        intensity: None,
    });
    Ok(())
}

fn replace(vector: Option<&mut Vector>, value: &Value, missing: &'static str) -> Result<(), Refusal> {
    vector.ok_or(Refusal::Domain(missing))?.at = point(value)?;
    Ok(())
}

fn count(value: &Value) -> Result<usize, Refusal> {
    match value {
        Value::Integer(n) => {
            usize::try_from(*n).map_err(|_| Refusal::Domain("a count of deletions is not negative"))
        }
        _ => Err(Refusal::Domain("a count of deletions is an integer")),
    }
}

pub(super) fn characters(characters: &mut Characters, input: Input, value: &Value) -> Result<(), Refusal> {
    match (input, value) {
        (Input::Position, value) => characters.at = point(value)?,
        (Input::Step, Value::Vector2(step)) => characters.step = *step,
        (Input::Clear, _) => characters.text = "".into(),
        (Input::Delete, value) => {
            let kept = characters.text.chars().count().saturating_sub(count(value)?);
            characters.text = characters.text.chars().take(kept).collect::<String>().into();
        }
        (Input::Append, Value::String(text)) => {
            if characters.text.len() + text.len() > TEXT_MAX_BYTES {
                return Err(Refusal::Domain("the text would be longer than 4096 bytes"));
            }
            characters.text = format!("{}{text}", characters.text).into();
        }
        (Input::Last, Value::String(text)) => {
            let last = characters.text.chars().count();
            substitute(characters, last, text)?;
        }
        (Input::Number(number), Value::String(text)) => substitute(characters, number.into(), text)?,
        _ => {}
    }
    Ok(())
}

/// Replaces the character `number`, from 1, by a text.
fn substitute(characters: &mut Characters, number: usize, text: &str) -> Result<(), Refusal> {
    let index = number
        .checked_sub(1)
        .filter(|&index| index < characters.text.chars().count());
    let index = index.ok_or(Refusal::Domain("the text has no character of that number"))?;
    if characters.text.len() + text.len() > TEXT_MAX_BYTES {
        return Err(Refusal::Domain("the text would be longer than 4096 bytes"));
    }
    let before = characters.text.chars().take(index);
    let after = characters.text.chars().skip(index + 1);
    characters.text = before.chain(text.chars()).chain(after).collect::<String>().into();
    Ok(())
}

/// Controls of a curve; more weigh down every picture.
const CONTROLS_MAX: usize = 4096;

/// Adds, moves and removes the vertices or coefficients of a curve. A new one has the weight 1.
pub(super) fn curve(curve: &mut Curve, input: Input, value: &Value) -> Result<(), Refusal> {
    let (controls, weights) = curve.controls();
    let before = controls.len();
    match input {
        Input::Append if before >= CONTROLS_MAX => {
            return Err(Refusal::Domain("the curve is full at 4096 vertices"));
        }
        Input::Append => controls.push(point(value)?),
        Input::Last => *controls.last_mut().ok_or(Refusal::Domain("the curve is empty"))? = point(value)?,
        Input::Number(number) => {
            let control = usize::from(number)
                .checked_sub(1)
                .and_then(|index| controls.get_mut(index));
            *control.ok_or(Refusal::Domain("the curve has no vertex of that number"))? = point(value)?;
        }
        Input::Delete => controls.truncate(before.saturating_sub(count(value)?)),
        Input::Clear => controls.clear(),
        Input::Position | Input::Step | Input::Substitute => {}
    }
    let now = controls.len();
    if let Some(weights) = weights {
        weights.resize(now, 1.0);
    }
    if now != before {
        curve.recount();
    }
    Ok(())
}

/// Labels of one node; more than a screen has room for.
const LABELS_MAX: usize = 4096;

/// Adds, rewrites, moves and removes labels. A new one stands where the last one does, until `<position>`.
pub(super) fn labels(list: &mut Labels, input: Input, value: &Value) -> Result<(), Refusal> {
    let labels = &mut list.labels;
    let none = Refusal::Domain("there is no label of that number");
    match (input, value) {
        (Input::Append, Value::String(text)) => {
            if labels.len() >= LABELS_MAX {
                return Err(Refusal::Domain("there are 4096 labels already"));
            }
            let at = labels.last().map_or(glam::DVec3::ZERO, |label| label.at);
            labels.push(Label {
                at,
                text: fitting(text)?,
            });
        }
        (Input::Position, value) => labels.last_mut().ok_or(none)?.at = point(value)?,
        (Input::Last, Value::String(text)) => labels.last_mut().ok_or(none)?.text = fitting(text)?,
        (Input::Number(number), Value::String(text)) => {
            let label = usize::from(number)
                .checked_sub(1)
                .and_then(|index| labels.get_mut(index));
            label.ok_or(none)?.text = fitting(text)?;
        }
        (Input::Delete, value) => labels.truncate(labels.len().saturating_sub(count(value)?)),
        (Input::Clear, _) => labels.clear(),
        _ => {}
    }
    Ok(())
}

fn fitting(text: &Text) -> Result<Text, Refusal> {
    if text.len() > TEXT_MAX_BYTES {
        return Err(Refusal::Domain("the text would be longer than 4096 bytes"));
    }
    Ok(text.clone())
}
