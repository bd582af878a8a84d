//! States waiting to be reported: positions merge, edges never do.

use std::collections::VecDeque;

/// How many edges a device remembers while nobody takes its reports; then the oldest are lost, as in any firmware.
const HELD_MAX: usize = 64;

/// A queue of states of one control surface.
#[derive(Clone, Debug)]
pub(crate) struct Waiting<S> {
    states: VecDeque<S>,
}

impl<S> Default for Waiting<S> {
    fn default() -> Self {
        Self {
            states: VecDeque::new(),
        }
    }
}

impl<S> Waiting<S> {
    /// Adds a state; it takes the place of the last waiting one when `merge` joins the two.
    pub(crate) fn push(&mut self, state: S, merge: impl FnOnce(&mut S, &S) -> bool) {
        if let Some(last) = self.states.back_mut()
            && merge(last, &state)
        {
            return;
        }
        if self.states.len() >= HELD_MAX {
            self.states.pop_front();
        }
        self.states.push_back(state);
    }

    pub(crate) fn pop(&mut self) -> Option<S> {
        self.states.pop_front()
    }

    /// Puts back what of the last taken state is still to be told.
    pub(crate) fn put_back(&mut self, rest: S) {
        self.states.push_front(rest);
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    pub(crate) fn clear(&mut self) {
        self.states.clear();
    }
}
