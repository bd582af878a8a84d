//! A codec and virtual time, for the tests of codecs on serial lines.

use super::{Codec, Counters, InputEvent, Outgoing, PenSample, Step};
use crate::clock::Instant;
use std::time::Duration;

/// The host's side of one device, from time zero.
pub(super) struct Trial<C> {
    pub(super) codec: C,
    pub(super) now: Instant,
    pub(super) events: Vec<InputEvent>,
}

impl<C: Codec> Trial<C> {
    pub(super) fn new(codec: C) -> Self {
        Self {
            codec,
            now: Instant::ZERO,
            events: Vec::new(),
        }
    }

    pub(super) fn start(&mut self) -> Vec<Step> {
        let mut out = Outgoing::new();
        self.codec.start(self.now, &mut out);
        out.drain().collect()
    }

    /// Lets so many milliseconds pass, in one step; gives what the codec wants done then.
    pub(super) fn after_ms(&mut self, ms: u64) -> Vec<Step> {
        self.now = self.now.after(Duration::from_millis(ms));
        let mut out = Outgoing::new();
        let events = &mut self.events;
        self.codec.advance(self.now, &mut out, &mut |e| events.push(e));
        out.drain().collect()
    }

    /// Brings bytes and lets the codec answer.
    pub(super) fn hear(&mut self, bytes: &[u8]) -> Vec<Step> {
        let events = &mut self.events;
        self.codec.decode(bytes, &mut |e| events.push(e));
        self.after_ms(0)
    }

    /// Takes the events so far.
    pub(super) fn told(&mut self) -> Vec<InputEvent> {
        std::mem::take(&mut self.events)
    }

    /// What bytes make of it, and nothing else.
    pub(super) fn said(&mut self, bytes: &[u8]) -> Vec<InputEvent> {
        self.events.clear();
        self.hear(bytes);
        self.told()
    }

    /// The same, tools only.
    pub(super) fn samples(&mut self, bytes: &[u8]) -> Vec<PenSample> {
        let pen = |event| match event {
            InputEvent::Pen(sample) => sample,
            other => panic!("{other:?}"),
        };
        self.said(bytes).into_iter().map(pen).collect()
    }
}

/// A step that sends text.
pub(super) fn text(text: &str) -> Step {
    Step::Bytes(text.as_bytes().to_vec())
}

/// A step that sends bytes.
pub(super) fn bytes(bytes: &[u8]) -> Step {
    Step::Bytes(bytes.to_vec())
}

/// All bytes of some steps.
pub(super) fn all_bytes(steps: &[Step]) -> Vec<u8> {
    let bytes = |step: &Step| {
        let Step::Bytes(bytes) = step else {
            panic!("{step:?} sends no bytes");
        };
        bytes.clone()
    };
    steps.iter().flat_map(bytes).collect()
}

/// Counters in one line.
pub(super) fn counted(reports: u64, unknown: u64, rejected: u64) -> Counters {
    Counters {
        reports,
        unknown,
        rejected,
    }
}

/// Fails if the events or the counts depend on how `stream` is cut: whole, in two at `cut`, or byte by byte.
pub(super) fn assert_cut_invariant<C: Codec>(make: impl Fn() -> C, stream: &[u8], cut: usize) {
    let run = |pieces: &mut dyn Iterator<Item = &[u8]>| {
        let mut codec = make();
        let mut events = Vec::new();
        for piece in pieces {
            codec.decode(piece, &mut |e| events.push(e));
        }
        (events, codec.counters())
    };
    let whole = run(&mut std::iter::once(stream));
    let (head, tail) = stream.split_at(cut.min(stream.len()));
    assert_eq!(run(&mut [head, tail].into_iter()), whole, "cut in two");
    assert_eq!(run(&mut stream.chunks(1)), whole, "byte by byte");
}

/// Fails if a sample that left presses anything, or if `let_go` leaves something held.
pub(super) fn assert_lets_go<C: Codec>(mut codec: C, stream: &[u8]) {
    let mut events = Vec::new();
    codec.decode(stream, &mut |e| events.push(e));
    codec.let_go(&mut |e| events.push(e));
    let mut down = std::collections::BTreeSet::new();
    let mut tools = std::collections::BTreeMap::new();
    for event in events {
        match event {
            InputEvent::Button { control, down: true } => {
                let fresh = down.insert(control);
                assert!(fresh, "button {control} went down twice");
            }
            InputEvent::Button { control, down: false } => {
                let held = down.remove(&control);
                assert!(held, "button {control} went up twice");
            }
            InputEvent::Pen(sample) => {
                tools.insert((sample.tool, sample.tool_serial), sample.in_range);
                assert!(
                    sample.in_range || (!sample.tip && sample.buttons == 0 && sample.pressure_counts == 0),
                    "{sample:?}"
                );
            }
            _ => {}
        }
    }
    assert!(down.is_empty(), "{down:?} are still down");
    assert!(
        !tools.values().any(|in_range| *in_range),
        "{tools:?} are still there"
    );
}
