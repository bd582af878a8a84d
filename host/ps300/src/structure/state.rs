//! What messages have made of a node, so that it can be written down and taken up again.
//!
//! Operations are told again what they were told last; data that was edited is kept as it now is.

use super::{Body, Drawn, NodeId, Structure};
use crate::language::{Characters, Input};
use crate::value::Value;

/// The last message of each kind at each input of an operation, in the order in which they came: told again,
/// they have the same effect.
#[derive(Default)]
pub(crate) struct Told(Vec<(Input, Value)>);

impl Told {
    pub(super) fn note(&mut self, input: Input, value: &Value) {
        let same = |(at, known): &(Input, Value)| *at == input && known.kind() == value.kind();
        match self.0.iter().position(same) {
            Some(at) if at + 1 == self.0.len() => self.0[at].1.clone_from(value),
            Some(at) => {
                self.0.remove(at);
                self.0.push((input, value.clone()));
            }
            None => self.0.push((input, value.clone())),
        }
    }
}

impl Structure {
    /// The messages that make a new operation what this one is.
    pub(crate) fn told(&self, id: NodeId) -> &[(Input, Value)] {
        self.slot(id).map_or(&[], |slot| &slot.told.0)
    }

    /// Data as messages have left it; empty where they have not changed it.
    pub(crate) fn remembered(&self, id: NodeId) -> Vec<Value> {
        match self.slot(id).map(|slot| &slot.body) {
            Some(Body::Vectors(Drawn {
                changed: Some(list), ..
            })) => vec![Value::Vectors(list.clone().into())],
            Some(Body::Characters(Drawn {
                changed: Some(now), ..
            })) => vec![now.at.into(), now.step.into(), Value::String(now.text.clone())],
            _ => Vec::new(),
        }
    }

    /// Takes up what [`Structure::remembered`] gave; false, and no change, where it does not fit.
    pub(crate) fn recall(&mut self, id: NodeId, state: &[Value]) -> bool {
        let Some(slot) = self.slot_mut(id) else {
            return false;
        };
        match (&mut slot.body, state) {
            (Body::Vectors(list), []) => list.changed = None,
            (Body::Characters(characters), []) => characters.changed = None,
            (Body::Vectors(list), [Value::Vectors(now)]) => list.changed = Some((**now).clone()),
            (
                Body::Characters(characters),
                [Value::Vector3(at), Value::Vector2(step), Value::String(text)],
            ) => {
                characters.changed = Some(Characters {
                    at: *at,
                    step: *step,
                    text: text.clone(),
                });
            }
            _ => return false,
        }
        true
    }
}
