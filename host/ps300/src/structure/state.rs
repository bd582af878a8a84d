//! What messages have made of a node, so that it can be written down and taken up again.
//!
//! Operations are told again what they were told last; data that was edited is kept as it now is.

use super::curve::Curve;
use super::{Body, NodeId, Structure};
use crate::language::{Characters, Input, Label, Labels};
use crate::value::Value;

/// The last message of each kind at each input of an operation, in the order in which they came: told again,
/// they have the same effect.
#[derive(Default)]
pub(crate) struct Told(Vec<(Input, Value)>);

impl Told {
    pub(super) fn note(&mut self, input: Input, value: &Value) {
        let same = |(at, known): &(Input, Value)| *at == input && known.kind() == value.kind();
        if let Some(last) = self.0.last_mut().filter(|last| same(last)) {
            return last.1.take_over(value);
        }
        match self.0.iter().position(same) {
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
            Some(Body::Vectors { list, .. }) => {
                let now = list.changed.as_ref();
                now.map_or_else(Vec::new, |now| vec![Value::Vectors(now.clone().into())])
            }
            Some(Body::Curve { curve, .. }) => {
                curve.changed.as_ref().map_or_else(Vec::new, Curve::remembered)
            }
            Some(Body::Characters(characters)) => characters.changed.as_ref().map_or_else(Vec::new, |now| {
                vec![now.at.into(), now.step.into(), Value::String(now.text.clone())]
            }),
            Some(Body::Labels(labels)) => {
                let value = |label: &Label| [label.at.into(), Value::String(label.text.clone())];
                match &labels.changed {
                    None => Vec::new(),
                    // Something must be said even of no labels.
                    Some(now) if now.labels.is_empty() => vec![Value::Boolean(false)],
                    Some(now) => now.labels.iter().flat_map(value).collect(),
                }
            }
            _ => Vec::new(),
        }
    }

    /// Takes up what [`Structure::remembered`] gave; false, and no change, where it does not fit.
    pub(crate) fn recall(&mut self, id: NodeId, state: &[Value]) -> bool {
        let Some(slot) = self.slot_mut(id) else {
            return false;
        };
        match (&mut slot.body, state) {
            (Body::Vectors { list, .. }, []) => list.changed = None,
            (Body::Characters(characters), []) => characters.changed = None,
            (Body::Labels(labels), []) => labels.changed = None,
            (Body::Curve { curve, .. }, []) => curve.changed = None,
            (Body::Vectors { list, .. }, [Value::Vectors(now)]) => list.changed = Some((**now).clone()),
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
            (Body::Labels(labels), [Value::Boolean(_)]) => {
                labels.changed = Some(Labels { labels: Vec::new() });
            }
            (Body::Labels(labels), state) => match recalled_labels(state) {
                Some(now) => labels.changed = Some(now),
                None => return false,
            },
            (Body::Curve { curve, .. }, state) => match curve.written.recalled(state) {
                Some(now) => curve.changed = Some(now),
                None => return false,
            },
            _ => return false,
        }
        true
    }
}

fn recalled_labels(state: &[Value]) -> Option<Labels> {
    let label = |pair: &[Value]| match pair {
        [Value::Vector3(at), Value::String(text)] => Some(Label {
            at: *at,
            text: text.clone(),
        }),
        _ => None,
    };
    let labels = state.chunks(2).map(label).collect::<Option<_>>()?;
    Some(Labels { labels })
}
