//! The one tool a tablet sees: what was last known of it, and letting it go.

use super::{InputEvent, PenSample};
use crate::clock::Instant;
use std::time::Duration;

/// A tool in range, if one is.
#[derive(Clone, Debug, Default)]
pub(super) struct Held {
    sample: Option<PenSample>,
    /// A tablet that never says that a tool has left: silence for so long says it.
    leave_after: Option<Duration>,
    /// Whether a sample has come since time was last looked at.
    heard: bool,
    heard_at: Option<Instant>,
}

impl Held {
    pub(super) fn new(leave_after: Option<Duration>) -> Self {
        Self {
            leave_after,
            ..Self::default()
        }
    }

    pub(super) fn sample(&self) -> Option<PenSample> {
        self.sample
    }

    /// Tells a sample. A tool of another kind or number leaves first.
    pub(super) fn see(&mut self, sample: PenSample, emit: &mut dyn FnMut(InputEvent)) {
        let other = |held: PenSample| held.tool != sample.tool || held.tool_serial != sample.tool_serial;
        if self.sample.is_some_and(other) {
            self.leave(emit);
        }
        self.sample = Some(sample);
        self.heard = true;
        emit(InputEvent::Pen(sample));
    }

    /// The tool is gone, from where it was last.
    pub(super) fn leave(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        if let Some(sample) = self.sample.take() {
            emit(InputEvent::Pen(sample.leaving()));
        }
        self.heard_at = None;
    }

    /// Time goes on; silence may have become long enough.
    pub(super) fn advance(&mut self, now: Instant, emit: &mut dyn FnMut(InputEvent)) {
        if std::mem::take(&mut self.heard) {
            self.heard_at = Some(now);
        }
        let silent = self.heard_at.map(|at| now.since(at));
        if let (Some(limit), Some(silent)) = (self.leave_after, silent)
            && silent >= limit
        {
            self.leave(emit);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::Tool;

    #[test]
    fn another_tool_and_silence_let_go() {
        let mut held = Held::new(Some(Duration::from_millis(50)));
        let mut told = Vec::new();
        let at = |ms| Instant::ZERO.after(Duration::from_millis(ms));
        let pen = PenSample::hovering(Tool::Pen, 1, 2);
        let puck = PenSample::hovering(Tool::Puck, 3, 4);
        held.see(pen, &mut |e| told.push(e));
        held.see(puck, &mut |e| told.push(e));
        held.advance(at(10), &mut |e| told.push(e));
        held.advance(at(59), &mut |e| told.push(e));
        assert_eq!(
            told,
            [pen, pen.leaving(), puck].map(InputEvent::Pen),
            "still within the time"
        );
        told.clear();
        held.advance(at(60), &mut |e| told.push(e));
        held.advance(at(300), &mut |e| told.push(e));
        assert_eq!(told, [InputEvent::Pen(puck.leaving())]);
        assert_eq!(held.sample(), None);
    }
}
