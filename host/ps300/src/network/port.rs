//! An input of an instance, with its queue.
//!
//! Source: `docs/protocols/ps300.md`, "Tokens, queues, firing". Why it is laid out so:
//! `docs/decisions/0014-memory-of-the-network.md`.

use std::collections::VecDeque;

use super::token::Token;
use crate::intrinsic::{InputSpec, Preset};
use crate::value::{Kinds, Value};

/// One input of an instance. Active: a queue, of which a firing consumes the first message.
/// Constant: the latest message, which firings leave in place.
#[allow(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
#[allow(
    clippy::box_collection,
    reason = "an input is half as large again with the queue in it, and hardly any has one"
)]
pub struct InputPort {
    /// The constant, or the oldest message.
    front: Option<Value>,
    /// The messages behind the oldest. Apart because there are hardly ever any.
    behind: Option<Box<VecDeque<Value>>>,
    pub(crate) kinds: Kinds,
    pub(crate) constant: bool,
    /// Whether `constant` is what the function's table row says.
    pub(super) as_built: bool,
    /// Whether the constant held was sent rather than preset.
    set: bool,
    /// Whether the function knows what to do without this constant.
    optional: bool,
}

impl InputPort {
    pub(super) fn new(spec: InputSpec) -> Self {
        Self {
            front: if spec.constant { spec.preset.value() } else { None },
            behind: None,
            kinds: spec.kinds,
            constant: spec.constant,
            as_built: true,
            set: false,
            optional: matches!(spec.preset, Preset::Rule(_)),
        }
    }

    /// What is left of a port whose instance is gone.
    pub(super) fn vacant() -> Self {
        Self {
            front: None,
            behind: None,
            kinds: Kinds::NONE,
            constant: true,
            as_built: true,
            set: false,
            optional: false,
        }
    }

    /// What the next firing would see here.
    #[inline]
    pub(crate) fn front(&self) -> Option<&Value> {
        self.front.as_ref()
    }

    /// The real number that the next firing would see here, if it is one.
    #[inline]
    pub(super) fn real(&self) -> Option<f64> {
        match self.front {
            Some(Value::Real(x)) => Some(x),
            _ => None,
        }
    }

    /// Whether somebody sent the constant that is held.
    pub(crate) fn is_set(&self) -> bool {
        self.set
    }

    /// Whether this input lets a firing happen.
    pub(super) fn satisfied(&self) -> bool {
        self.front.is_some() || (self.constant && self.optional)
    }

    /// Replaces the constant.
    pub(super) fn hold(&mut self, value: Value) {
        self.front = Some(value);
        self.set = true;
    }

    /// Takes a message if none waits here.
    #[inline]
    pub(super) fn take_first(&mut self, token: &impl Token) -> bool {
        let free = !self.constant && self.front.is_none();
        if free {
            token.copy_to(&mut self.front);
        }
        free
    }

    /// Takes a message that has to wait behind others.
    pub(super) fn push_behind(&mut self, value: Value) {
        self.behind.get_or_insert_default().push_back(value);
    }

    /// Takes the oldest message of an active input. Returns whether another moved up from behind it.
    #[inline]
    pub(super) fn pop(&mut self) -> bool {
        if self.behind.is_none() {
            match &self.front {
                // Nothing to drop, which is worth saying: it is what nearly every message is.
                Some(Value::Real(_)) => std::mem::forget(self.front.take()),
                _ => self.front = None,
            }
            return false;
        }
        self.move_up()
    }

    /// The same where a real number is known to be the oldest.
    #[inline]
    pub(super) fn pop_real(&mut self) -> bool {
        if self.behind.is_none() {
            std::mem::forget(self.front.take()); // There is nothing to drop.
            return false;
        }
        self.move_up()
    }

    #[cold]
    fn move_up(&mut self) -> bool {
        self.front = self.behind.as_mut().and_then(|behind| behind.pop_front());
        self.front.is_some()
    }

    /// How many messages wait behind the oldest.
    pub(super) fn behind(&self) -> usize {
        self.behind.as_ref().map_or(0, |behind| behind.len())
    }

    /// How many messages wait; a constant does not wait.
    pub(crate) fn waiting(&self) -> usize {
        if self.constant {
            0
        } else {
            usize::from(self.front.is_some()) + self.behind()
        }
    }

    pub(super) fn queued(&self) -> impl Iterator<Item = &Value> {
        let behind = self.behind.iter().flat_map(|behind| behind.iter());
        self.front.iter().filter(|_| !self.constant).chain(behind)
    }

    pub(super) fn held_if_set(&self) -> Option<&Value> {
        self.front.as_ref().filter(|_| self.constant && self.set)
    }

    /// SETUP CNESS. An input made constant keeps its newest message, or has the `preset`; one made active starts
    /// empty. Returns how many went that waited behind another.
    pub(super) fn make_constant(&mut self, constant: bool, preset: Preset) -> usize {
        if constant == self.constant {
            return 0;
        }
        let gone = self.behind();
        let newest = self.behind.take().and_then(|mut behind| behind.pop_back());
        let newest = newest.or(self.front.take());
        self.constant = constant;
        self.as_built = !self.as_built;
        self.set = constant && newest.is_some();
        if constant {
            self.front = newest.or(preset.value());
        }
        gone
    }
}
