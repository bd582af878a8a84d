//! A codec played through an exchange, on the exchange's own time.

use super::{Exchange, What, event_words};
use crate::clock::Instant;
use crate::codec::{Codec, InputEvent, Outgoing, Stamped, Step};
use std::collections::VecDeque;
use std::time::Duration;

/// How long something without a time is waited for: longer than any codec waits for an answer.
const PATIENCE: Duration = Duration::from_secs(3);
/// Longer than any time limit of a codec.
const LIMITS: Duration = Duration::from_secs(10);
/// How often the codec is looked at meanwhile; devices are polled as often or oftener.
const LOOK: Duration = Duration::from_millis(1);

/// What a codec made of an exchange.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Played {
    /// Everything it said, with the exchange's times.
    pub events: Vec<Stamped<InputEvent>>,
    /// Everything the host said, likewise; waits are no saying.
    pub said: Vec<(Instant, Step)>,
    /// Where it did otherwise than the exchange has it. Events, and what the host sends, are only compared where
    /// the exchange tells any.
    pub differences: Vec<Difference>,
}

/// One thing that came otherwise.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: expected {expected}, found {found}")]
pub struct Difference {
    /// The line, from 1; the one behind the last at the end.
    pub line: u32,
    /// What the exchange has.
    pub expected: String,
    /// What came.
    pub found: String,
}

/// Plays it. The codec is new: it is started first, unless the device reports already when the exchange begins.
pub fn play(exchange: &Exchange, codec: &mut dyn Codec) -> Played {
    let has = |is: fn(&What) -> bool| exchange.records.iter().any(|record| is(&record.what));
    let mut playing = Playing {
        codec,
        now: Instant::ZERO,
        out: Outgoing::new(),
        said: VecDeque::new(),
        heard: VecDeque::new(),
        played: Played::default(),
        line: 0,
    };
    if !exchange.head.reporting {
        playing.start();
    }
    for record in &exchange.records {
        playing.line = record.line;
        if let Some(at) = record.at {
            playing.pass_to(Instant::ZERO.after(at));
        }
        playing.record(&record.what, record.at.is_some());
    }
    playing.line += 1;
    playing.end(
        has(|what| matches!(what, What::Host(_))),
        has(|what| matches!(what, What::Event(_))),
    );
    playing.played
}

struct Playing<'c> {
    codec: &'c mut dyn Codec,
    now: Instant,
    out: Outgoing,
    /// What the host said and no line has told yet.
    said: VecDeque<Step>,
    /// Events that no line has told yet.
    heard: VecDeque<InputEvent>,
    played: Played,
    line: u32,
}

impl Playing<'_> {
    fn start(&mut self) {
        self.codec.start(self.now, &mut self.out);
        self.advance();
    }

    fn hear(&mut self, hear: impl FnOnce(&mut dyn Codec, &mut Outgoing, &mut dyn FnMut(InputEvent))) {
        let (now, heard, events) = (self.now, &mut self.heard, &mut self.played.events);
        hear(self.codec, &mut self.out, &mut |what| {
            heard.push_back(what);
            events.push(Stamped { at: now, what });
        });
        for step in self.out.drain() {
            if !matches!(step, Step::Wait(_)) {
                self.played.said.push((now, step.clone()));
            }
            self.said.push_back(step);
        }
    }

    fn advance(&mut self) {
        let now = self.now;
        self.hear(|codec, out, emit| codec.advance(now, out, emit));
    }

    /// Lets time pass in the steps of a poll, so that time limits end when they do in life. Nobody waits longer than
    /// [`LIMITS`]; what is left of the time is jumped over.
    fn pass_to(&mut self, at: Instant) {
        let limits = self.now.after(LIMITS);
        while self.now < at {
            self.now = if self.now < limits {
                at.min(self.now.after(LOOK))
            } else {
                at
            };
            self.advance();
        }
    }

    fn record(&mut self, what: &What, timed: bool) {
        match what {
            What::Host(step) => self.expect_step(step, timed),
            What::Event(event) => self.expect_event(event, timed),
            What::Device(bytes) => {
                self.hear(|codec, _, emit| codec.decode(bytes, emit));
                self.advance();
            }
            What::Answer(answer) => {
                let (now, answer) = (self.now, answer.clone());
                self.hear(|codec, out, _| codec.answer(answer, now, out));
                self.advance();
            }
            What::Gone => self.hear(|codec, _, emit| codec.let_go(emit)),
            What::Back => {
                // What had not been sent when the line went never will be.
                self.said.clear();
                self.start();
            }
            What::Show(feedback) => self.hear(|codec, out, _| codec.encode(feedback, out)),
            &What::Surface {
                max_counts,
                pressure_max,
            } => {
                let known = self.codec.surface().map(|it| (it.max_counts, it.pressure_max));
                let words = |([x, y], p): ([u32; 2], u32)| format!("a surface of {x} × {y}, pressure {p}");
                if known != Some((max_counts, pressure_max)) {
                    let found = known.map_or_else(|| "none".to_owned(), words);
                    self.differ(words((max_counts, pressure_max)), found);
                }
            }
            What::Hand(_) | What::Pause => {}
        }
    }

    fn expect_step(&mut self, expected: &Step, timed: bool) {
        let mut wanted = expected.clone();
        loop {
            if self.said.is_empty() && !timed {
                self.wait_for(|playing| !playing.said.is_empty());
            }
            match (&mut wanted, self.said.front_mut()) {
                // A stream may be cut differently.
                (Step::Bytes(wanted), Some(Step::Bytes(said))) => {
                    let same = wanted.iter().zip(said.iter()).take_while(|(a, b)| a == b).count();
                    if same < wanted.len().min(said.len()) {
                        break;
                    }
                    wanted.drain(..same);
                    said.drain(..same);
                    let done = wanted.is_empty();
                    if said.is_empty() {
                        self.said.pop_front();
                    }
                    if done {
                        return;
                    }
                }
                // Waits show in the times; an exchange need not tell them.
                (wanted, Some(Step::Wait(span))) if !matches!(wanted, Step::Wait(_)) => {
                    let until = self.now.after(*span);
                    self.said.pop_front();
                    if !timed {
                        self.pass_to(until);
                    }
                }
                (wanted, Some(said)) if said == wanted => {
                    self.said.pop_front();
                    if let (Step::Wait(span), false) = (wanted, timed) {
                        let until = self.now.after(*span);
                        self.pass_to(until);
                    }
                    return;
                }
                _ => break,
            }
        }
        let found = self.said.pop_front();
        self.differ(
            format!("the host to say {expected:02x?}"),
            found.map_or_else(|| "nothing".to_owned(), |step| format!("{step:02x?}")),
        );
    }

    fn expect_event(&mut self, expected: &InputEvent, timed: bool) {
        if self.heard.is_empty() && !timed {
            self.wait_for(|playing| !playing.heard.is_empty());
        }
        match self.heard.pop_front() {
            Some(event) if agrees(expected, &event) => {}
            found => {
                let found = found.map_or_else(|| "nothing".to_owned(), |event| event_words(&event));
                self.differ(format!("the event {}", event_words(expected)), found);
            }
        }
    }

    fn wait_for(&mut self, done: impl Fn(&Self) -> bool) {
        let until = self.now.after(PATIENCE);
        while self.now < until && !done(self) {
            self.pass_to(self.now.after(LOOK));
        }
    }

    fn end(&mut self, told_host: bool, told_events: bool) {
        self.said.retain(|step| !matches!(step, Step::Wait(_)));
        if let Some(step) = self.said.pop_front().filter(|_| told_host) {
            self.differ("the host to say nothing more".into(), format!("{step:02x?}"));
        }
        if let Some(event) = self.heard.pop_front().filter(|_| told_events) {
            self.differ("no more events".into(), event_words(&event));
        }
    }

    fn differ(&mut self, expected: String, found: String) {
        let line = self.line;
        self.played.differences.push(Difference {
            line,
            expected,
            found,
        });
    }
}

/// Whether an event is the one expected. Where a tool was when it left is not told in an exchange.
pub fn agrees(expected: &InputEvent, event: &InputEvent) -> bool {
    match (expected, event) {
        (InputEvent::Pen(expected), InputEvent::Pen(sample)) if !expected.in_range => {
            !sample.in_range && expected.tool == sample.tool
        }
        _ => expected == event,
    }
}
