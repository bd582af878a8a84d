//! What the network was before and after each change of it, so that undo can bring back sums and messages that
//! the change lost, and touch nothing else.
//!
//! Apart from the history of shows because it is the running network that is kept, not the document.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::document::Show;
use crate::history::STEPS_MAX;

/// The changes of the network that can be taken back.
#[derive(Default)]
pub(crate) struct NetworkSteps(VecDeque<Step>);

struct Step {
    /// The show before and after, and the network as it then ran.
    shows: [Arc<Show>; 2],
    texts: [Arc<str>; 2],
}

impl NetworkSteps {
    /// Notes a change from `shows[0]` to `shows[1]`. `merged` where history made one step of it and the one
    /// before: then it begins where that did.
    pub(crate) fn note(&mut self, shows: [Arc<Show>; 2], texts: [Arc<str>; 2], merged: bool) {
        let [before, after] = &shows;
        if let Some(last) = self
            .0
            .back_mut()
            .filter(|last| merged && Arc::ptr_eq(&last.shows[1], before))
        {
            last.shows[1] = Arc::clone(after);
            last.texts[1] = Arc::clone(&texts[1]);
            return;
        }
        if self.0.len() == STEPS_MAX {
            self.0.pop_front();
        }
        self.0.push_back(Step { shows, texts });
    }

    /// The network's texts on the way from one show to another, forth or back, if that is one noted change.
    pub(crate) fn between(&self, from: &Arc<Show>, to: &Arc<Show>) -> Option<[Arc<str>; 2]> {
        let is = |step: &Step, [a, b]: [&Arc<Show>; 2]| {
            Arc::ptr_eq(&step.shows[0], a) && Arc::ptr_eq(&step.shows[1], b)
        };
        self.0.iter().rev().find_map(|step| {
            let [before, after] = &step.texts;
            if is(step, [from, to]) {
                Some([Arc::clone(before), Arc::clone(after)])
            } else if is(step, [to, from]) {
                Some([Arc::clone(after), Arc::clone(before)])
            } else {
                None
            }
        })
    }
}
