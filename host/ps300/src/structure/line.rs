//! Editing vector lists and characters by message.

use super::inlet::point;
use crate::intrinsic::TEXT_MAX_BYTES;
use crate::language::{Characters, Input, Vector, VectorClass, VectorList};
use crate::network::Refusal;
use crate::value::Value;

/// Ink beyond this is refused: at 60 vectors a second it is eighteen minutes of drawing.
const VECTORS_MAX: usize = 65_536;

pub(super) fn edit_vectors(list: &mut VectorList, input: Input, value: &Value) -> Result<(), Refusal> {
    match input {
        Input::Append => add(list, value, true),
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
    let at = point(value)?;
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

pub(super) fn edit_characters(
    characters: &mut Characters,
    input: Input,
    value: &Value,
) -> Result<(), Refusal> {
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
