//! The two ends of a wire: inputs with their queues, outputs with their destinations.
//!
//! Source: `docs/protocols/ps300.md`, "Tokens, queues, firing".

use std::collections::VecDeque;

use super::connection::Inlet;
use crate::intrinsic::{InputSpec, OutputSpec, Preset};
use crate::value::{Kinds, Value};

/// One input of an instance. Active: a queue, of which a firing consumes the first message.
/// Constant: the latest message, which firings leave in place.
pub struct InputPort {
    pub(crate) kinds: Kinds,
    pub(crate) constant: bool,
    /// Whether `constant` is what the function's table row says.
    pub(super) as_built: bool,
    /// Whether the constant held was sent rather than preset.
    set: bool,
    preset: Preset,
    /// The constant, or the oldest message. Kept apart from the others because there are hardly ever
    /// others, and a message is as large as a matrix.
    front: Option<Value>,
    behind: VecDeque<Value>,
}

impl InputPort {
    pub(crate) fn new(spec: InputSpec) -> Self {
        Self {
            kinds: spec.kinds,
            constant: spec.constant,
            as_built: true,
            set: false,
            preset: spec.preset,
            front: if spec.constant { spec.preset.value() } else { None },
            behind: VecDeque::new(),
        }
    }

    /// What the next firing would see here.
    pub(crate) fn front(&self) -> Option<&Value> {
        self.front.as_ref()
    }

    /// Whether somebody sent the constant that is held.
    pub(crate) fn is_set(&self) -> bool {
        self.set
    }

    /// Whether this input lets a firing happen.
    pub(super) fn satisfied(&self) -> bool {
        self.front.is_some() || (self.constant && matches!(self.preset, Preset::Rule(_)))
    }

    /// Replaces the constant.
    pub(super) fn hold(&mut self, value: &Value) {
        copy(value, &mut self.front);
        self.set = true;
    }

    pub(super) fn push(&mut self, value: &Value) {
        if self.front.is_none() {
            copy(value, &mut self.front);
        } else {
            self.behind.push_back(value.clone());
        }
    }

    /// Takes the oldest message of an active input. Returns how many (0 or 1) moved up from behind it.
    pub(super) fn pop(&mut self) -> usize {
        self.front = self.behind.pop_front();
        usize::from(self.front.is_some())
    }

    /// How many messages wait behind the oldest.
    pub(super) fn behind(&self) -> usize {
        self.behind.len()
    }

    /// How many messages wait; a constant does not wait.
    pub(crate) fn waiting(&self) -> usize {
        if self.constant {
            0
        } else {
            usize::from(self.front.is_some()) + self.behind.len()
        }
    }

    pub(super) fn queued(&self) -> impl Iterator<Item = &Value> {
        self.front.iter().filter(|_| !self.constant).chain(&self.behind)
    }

    pub(super) fn held_if_set(&self) -> Option<&Value> {
        self.front.as_ref().filter(|_| self.constant && self.set)
    }

    /// SETUP CNESS. An input made constant keeps its newest message; one made active starts empty.
    /// Returns how many went that waited behind another.
    pub(super) fn make_constant(&mut self, constant: bool) -> usize {
        if constant == self.constant {
            return 0;
        }
        let gone = self.behind.len();
        let newest = self.behind.pop_back().or(self.front.take());
        self.constant = constant;
        self.as_built = !self.as_built;
        self.set = constant && newest.is_some();
        self.front = if constant {
            newest.or(self.preset.value())
        } else {
            None
        };
        self.behind.clear();
        gone
    }
}

/// Clones into a place. The small kinds are named so that they are not moved as if they were matrices.
#[inline]
pub(super) fn copy(value: &Value, into: &mut Option<Value>) {
    match value {
        Value::Real(x) => *into = Some(Value::Real(*x)),
        Value::Integer(n) => *into = Some(Value::Integer(*n)),
        Value::Boolean(b) => *into = Some(Value::Boolean(*b)),
        Value::Vector3(v) => *into = Some(Value::Vector3(*v)),
        large => *into = Some(large.clone()),
    }
}

/// One output of an instance or a device.
pub(crate) struct OutputPort {
    pub(crate) kinds: Kinds,
    /// In the order of CONNECT, which is the order of delivery.
    pub(super) to: Vec<Inlet>,
    pub(super) watched: bool,
    pub(crate) last: Option<Value>,
    /// Messages sent so far.
    pub(crate) sent: u64,
    /// Whether what it would send is withheld.
    pub(crate) frozen: bool,
    /// Messages withheld so far.
    pub(crate) withheld: u64,
}

impl OutputPort {
    pub(super) fn new(spec: OutputSpec) -> Self {
        Self {
            kinds: spec.kinds,
            to: Vec::new(),
            watched: false,
            last: None,
            sent: 0,
            frozen: false,
            withheld: 0,
        }
    }
}
