//! Messages to display nodes: which inputs a node has, and what a message does.
//!
//! The named inputs of data make rubber bands and ink ordinary vector lists.
//! Source: `docs/protocols/ps300.md`, "Display-tree nodes as sinks and sources". That `<position>` of a
//! vector list adds a move is this project's rule, as is replacing by number.

use glam::DVec3;

use super::edit;
use super::{Body, NodeId, Slot, Structure};
use crate::language::Input;
use crate::network::Refusal;
use crate::value::{Kind, Kinds, Value};

const POINT: Kinds = Kinds::of(&[Kind::Vector2, Kind::Vector3]);
const POINTS: Kinds = POINT.or(Kinds::of(&[Kind::Vectors]));

impl Structure {
    /// What an input takes; nothing if the node has no such input.
    pub(crate) fn accepts(&self, id: NodeId, input: Input) -> Option<Kinds> {
        match (&self.slot(id)?.body, input) {
            (Body::Operation { change, .. }, input) => change.accepts(input),
            (Body::Vectors { .. }, Input::Append) => Some(POINTS),
            (Body::Curve { .. }, Input::Append)
            | (Body::Vectors { .. } | Body::Curve { .. }, Input::Last | Input::Number(1..))
            | (Body::Vectors { .. } | Body::Characters(_) | Body::Labels(_), Input::Position) => Some(POINT),
            (data, Input::Delete) if is_edited(data) => Some(Kinds::INTEGER),
            (data, Input::Clear) if is_edited(data) => Some(Kinds::ANY),
            (Body::Characters(_) | Body::Labels(_), Input::Append | Input::Last | Input::Number(1..)) => {
                Some(Kinds::STRING)
            }
            (Body::Characters(_), Input::Step) => Some(Kind::Vector2.into()),
            _ => None,
        }
    }

    /// The inputs a node has, in words.
    pub(crate) fn inputs_text(&self, id: NodeId) -> String {
        match self.slot(id).map(|slot| &slot.body) {
            Some(Body::Operation { change, .. }) => match change.inputs.len() {
                0 => "none".to_owned(),
                1 => "<1>".to_owned(),
                count => format!("<1> to <{count}>"),
            },
            Some(Body::Curve { .. }) => "<append>, <clear>, <delete>, <last>, <n>".to_owned(),
            Some(Body::Vectors { .. } | Body::Labels(_)) => {
                "<append>, <clear>, <delete>, <last>, <position>, <n>".to_owned()
            }
            Some(Body::Characters(_)) => {
                "<append>, <clear>, <delete>, <last>, <position>, <step>, <n>".to_owned()
            }
            _ => "none".to_owned(),
        }
    }

    /// Takes a message.
    pub(crate) fn feed(&mut self, id: NodeId, input: Input, value: &Value) -> Result<(), Refusal> {
        if let Some(Some(Slot { body, told, .. })) = self.slots.get_mut(id.0 as usize)
            && let Body::Operation { change, .. } = body
        {
            let accepted = change.accepts(input).unwrap_or(Kinds::NONE);
            if !accepted.has(value.kind()) {
                return Err(Refusal::Kind(accepted));
            }
            self.revision += 1;
            change.effect.feed(&change.operation, input, value)?;
            match change.effect.outcome(input, value) {
                Some(outcome) => told.note(input, &outcome),
                None => told.note(input, value),
            }
            return Ok(());
        }
        self.edit(id, input, value)
    }

    /// Changes data.
    fn edit(&mut self, id: NodeId, input: Input, value: &Value) -> Result<(), Refusal> {
        let accepted = self.accepts(id, input).unwrap_or(Kinds::NONE);
        if !accepted.has(value.kind()) {
            return Err(Refusal::Kind(accepted));
        }
        let Some(slot) = self.slot_mut(id) else {
            return Ok(());
        };
        match &mut slot.body {
            Body::Vectors { list, .. } => edit::vectors(list.now_mut(), input, value),
            Body::Curve { curve, .. } => edit::curve(curve.now_mut(), input, value),
            Body::Characters(characters) => edit::characters(characters.now_mut(), input, value),
            Body::Labels(labels) => edit::labels(labels.now_mut(), input, value),
            _ => Ok(()),
        }
    }
}

fn is_edited(body: &Body) -> bool {
    matches!(
        body,
        Body::Vectors { .. } | Body::Curve { .. } | Body::Characters(_) | Body::Labels(_)
    )
}

/// A point in a node's own space; z is 0 where it is not said.
pub(super) fn point(value: &Value) -> Result<DVec3, Refusal> {
    match value {
        Value::Vector2(v) => Ok(v.extend(0.0)),
        Value::Vector3(v) => Ok(*v),
        _ => Err(Refusal::Kind(POINT)),
    }
}
