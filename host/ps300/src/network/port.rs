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
    preset: Preset,
    queue: VecDeque<Value>,
    held: Option<Value>,
    set: bool,
}

impl InputPort {
    pub(crate) fn new(spec: InputSpec) -> Self {
        Self {
            kinds: spec.kinds,
            constant: spec.constant,
            as_built: true,
            preset: spec.preset,
            queue: VecDeque::new(),
            held: if spec.constant { spec.preset.value() } else { None },
            set: false,
        }
    }

    /// What the next firing would see here.
    pub(crate) fn front(&self) -> Option<&Value> {
        if self.constant {
            self.held.as_ref()
        } else {
            self.queue.front()
        }
    }

    /// Whether somebody sent the constant that is held.
    pub(crate) fn is_set(&self) -> bool {
        self.set
    }

    /// Whether this input lets a firing happen.
    pub(super) fn satisfied(&self) -> bool {
        if self.constant {
            self.held.is_some() || matches!(self.preset, Preset::Rule(_))
        } else {
            !self.queue.is_empty()
        }
    }

    /// Replaces the constant.
    pub(super) fn hold(&mut self, value: Value) {
        self.held = Some(value);
        self.set = true;
    }

    pub(super) fn push(&mut self, value: Value) {
        self.queue.push_back(value);
    }

    pub(super) fn pop(&mut self) -> bool {
        self.queue.pop_front().is_some()
    }

    pub(super) fn waiting(&self) -> usize {
        self.queue.len()
    }

    pub(super) fn queued(&self) -> impl Iterator<Item = &Value> {
        self.queue.iter()
    }

    pub(super) fn held_if_set(&self) -> Option<&Value> {
        if self.constant && self.set {
            self.held.as_ref()
        } else {
            None
        }
    }

    /// SETUP CNESS. An input made constant keeps its newest message; one made active starts empty.
    /// Returns how many waiting messages went.
    pub(super) fn make_constant(&mut self, constant: bool) -> usize {
        if constant == self.constant {
            return 0;
        }
        self.constant = constant;
        self.as_built = !self.as_built;
        let gone = self.queue.len();
        self.held = None;
        self.set = false;
        if constant {
            match self.queue.pop_back() {
                Some(newest) => self.hold(newest),
                None => self.held = self.preset.value(),
            }
        }
        self.queue.clear();
        gone
    }
}

/// One output of an instance or a device.
pub(crate) struct OutputPort {
    pub(crate) kinds: Kinds,
    /// In the order of CONNECT, which is the order of delivery.
    pub(super) to: Vec<Inlet>,
    pub(super) watched: bool,
    pub(super) last: Option<Value>,
}

impl OutputPort {
    pub(super) fn new(spec: OutputSpec) -> Self {
        Self {
            kinds: spec.kinds,
            to: Vec::new(),
            watched: false,
            last: None,
        }
    }
}
