//! Undo and redo over immutable values.
//!
//! Every state is kept whole behind an [`Arc`]; states share what they have in common, so a step costs
//! what it changed. Going back and forth hands out the very same values, which makes undo exact.

use std::collections::VecDeque;
use std::sync::Arc;

/// Steps kept before the oldest is forgotten.
pub const STEPS_MAX: usize = 200;

/// A present value with the ones before it and the ones taken back.
#[derive(Clone, Debug)]
pub struct History<T> {
    past: VecDeque<Step<T>>,
    present: Arc<T>,
    future: Vec<Step<T>>,
    gesture: Option<String>,
    steps_max: usize,
}

/// A state on the other side of a change, and the change in words.
#[derive(Clone, Debug)]
struct Step<T> {
    state: Arc<T>,
    words: String,
}

impl<T> History<T> {
    /// A history that begins with `present` and keeps [`STEPS_MAX`] steps.
    pub fn new(present: T) -> Self {
        Self::with_steps_max(present, STEPS_MAX)
    }

    /// The same with another bound; at least one step is kept.
    pub fn with_steps_max(present: T, steps_max: usize) -> Self {
        Self {
            past: VecDeque::new(),
            present: Arc::new(present),
            future: Vec::new(),
            gesture: None,
            steps_max: steps_max.max(1),
        }
    }

    /// The value as it is now.
    pub fn present(&self) -> &Arc<T> {
        &self.present
    }

    /// The value that [`History::undo`] would bring back.
    pub fn previous(&self) -> Option<&Arc<T>> {
        self.past.back().map(|step| &step.state)
    }

    /// Makes `next` the present. `words` describe the change for the undo menu. A change of the same
    /// `gesture` as the one before replaces it: one drag is one step.
    pub fn push(&mut self, next: T, words: impl Into<String>, gesture: Option<String>) {
        let merges = gesture.is_some() && gesture == self.gesture;
        let before = std::mem::replace(&mut self.present, Arc::new(next));
        self.future.clear();
        self.gesture = gesture;
        match self.past.back_mut() {
            Some(step) if merges => step.words = words.into(),
            _ => self.past.push_back(Step {
                state: before,
                words: words.into(),
            }),
        }
        if self.past.len() > self.steps_max {
            self.past.pop_front();
        }
    }

    /// Ends the gesture under way: the next change is a step of its own.
    pub fn end_gesture(&mut self) {
        self.gesture = None;
    }

    /// Takes the last change back and returns it in words; `None` when there is none.
    pub fn undo(&mut self) -> Option<String> {
        self.gesture = None;
        let step = self.past.pop_back()?;
        let state = std::mem::replace(&mut self.present, step.state);
        self.future.push(Step {
            state,
            words: step.words.clone(),
        });
        Some(step.words)
    }

    /// Makes the last change taken back again and returns it in words; `None` when there is none.
    pub fn redo(&mut self) -> Option<String> {
        self.gesture = None;
        let step = self.future.pop()?;
        let state = std::mem::replace(&mut self.present, step.state);
        self.past.push_back(Step {
            state,
            words: step.words.clone(),
        });
        Some(step.words)
    }

    /// What [`History::undo`] would take back.
    pub fn undo_words(&self) -> Option<&str> {
        self.past.back().map(|step| step.words.as_str())
    }

    /// What [`History::redo`] would make again.
    pub fn redo_words(&self) -> Option<&str> {
        self.future.last().map(|step| step.words.as_str())
    }

    /// Forgets all steps and begins anew with `present`.
    pub fn reset(&mut self, present: T) {
        *self = Self::with_steps_max(present, self.steps_max);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn one_drag_is_one_step() {
        let mut history = History::new(0);
        for value in 1..=5 {
            history.push(value, format!("to {value}"), Some("drag".into()));
        }
        assert_eq!(history.undo_words(), Some("to 5"));
        assert_eq!(history.undo().as_deref(), Some("to 5"));
        assert_eq!(**history.present(), 0);
        assert_eq!(history.undo(), None);
    }

    #[test]
    fn a_gesture_ends_when_something_else_happens() {
        let mut history = History::new(0);
        history.push(1, "a", Some("drag".into()));
        history.end_gesture();
        history.push(2, "b", Some("drag".into()));
        history.undo();
        assert_eq!(**history.present(), 1);
        history.push(3, "c", Some("drag".into()));
        assert_eq!(
            history.redo_words(),
            None,
            "a new change ends what could be redone"
        );
        history.undo();
        assert_eq!(**history.present(), 1);
    }

    #[test]
    fn the_oldest_steps_are_forgotten() {
        let mut history = History::with_steps_max(0, 3);
        for value in 1..=10 {
            history.push(value, "step", None);
        }
        while history.undo().is_some() {}
        assert_eq!(**history.present(), 7);
    }

    proptest! {
        #[test]
        fn undo_all_is_the_beginning_and_redo_all_is_the_end(changes in prop::collection::vec((any::<i32>(), 0..4_u8), 0..60)) {
            let mut history = History::new(-1);
            for &(value, gesture) in &changes {
                history.push(value, "change", (gesture > 0).then(|| gesture.to_string()));
            }
            let last = Arc::clone(history.present());
            let mut steps = 0;
            while history.undo().is_some() { steps += 1; }
            prop_assert_eq!(**history.present(), -1);
            while history.redo().is_some() { steps -= 1; }
            prop_assert_eq!(steps, 0);
            prop_assert!(Arc::ptr_eq(history.present(), &last));
        }
    }
}
