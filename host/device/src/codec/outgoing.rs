//! What a codec wants done on the line, in order, and what comes back when it asks for something.

use std::collections::VecDeque;
use std::time::Duration;

/// One thing to do on the line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// Send these bytes of a stream.
    Bytes(Vec<u8>),
    /// Send one output report: its id first, 0 where the device numbers none. Never joined with another.
    Report(Vec<u8>),
    /// Change the line speed, after everything before has been sent.
    Baud(u32),
    /// Set a feature report: its id first, 0 where the device numbers none. A refusal comes back as
    /// [`Answer::Feature`] with the reason; success says nothing.
    Feature(Vec<u8>),
    /// Ask for a feature report of `bytes` bytes with its id.
    AskFeature {
        /// The report's id, 0 where the device numbers none.
        id: u8,
        /// Its length with the id.
        bytes: u16,
    },
    /// Ask for the USB string descriptor of this index, language 0x0409.
    AskString(u8),
    /// Ask for the HID report descriptor.
    AskDescriptor,
    /// Do nothing for so long; what stands behind waits.
    Wait(Duration),
}

/// What came back for an [`Step::AskFeature`], [`Step::AskString`] or [`Step::AskDescriptor`]. A refusal is in the
/// transport's words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// A feature report, id first.
    Feature {
        /// Which was asked for, or refused when it was set.
        id: u8,
        /// The report.
        bytes: Result<Vec<u8>, String>,
    },
    /// A string descriptor.
    Text {
        /// Which was asked for.
        index: u8,
        /// The whole descriptor with its head, a length and the type 3: some firmware answers with memory that was
        /// never set, and only the head tells.
        raw: Result<Vec<u8>, String>,
    },
    /// The report descriptor.
    Descriptor(Result<Vec<u8>, String>),
}

/// Steps in the order they are to be done.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outgoing {
    steps: VecDeque<Step>,
}

impl Outgoing {
    /// Nothing to do.
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends bytes of a stream.
    pub fn bytes(&mut self, bytes: &[u8]) {
        if let Some(Step::Bytes(last)) = self.steps.back_mut() {
            last.extend_from_slice(bytes);
        } else {
            self.steps.push_back(Step::Bytes(bytes.to_vec()));
        }
    }

    /// Appends one output report, id first.
    pub fn report(&mut self, bytes: &[u8]) {
        self.steps.push_back(Step::Report(bytes.to_vec()));
    }

    /// Appends a change of speed.
    pub fn baud(&mut self, baud: u32) {
        self.steps.push_back(Step::Baud(baud));
    }

    /// Appends any step.
    pub fn step(&mut self, step: Step) {
        self.steps.push_back(step);
    }

    /// Takes the first step out.
    pub fn next_step(&mut self) -> Option<Step> {
        self.steps.pop_front()
    }

    /// Puts a step back that could not be done yet.
    pub fn put_back(&mut self, step: Step) {
        self.steps.push_front(step);
    }

    /// Takes all steps out.
    pub fn drain(&mut self) -> impl Iterator<Item = Step> {
        self.steps.drain(..)
    }

    /// Forgets all steps.
    pub fn clear(&mut self) {
        self.steps.clear();
    }

    /// Whether there is nothing to do.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// All bytes and reports, the rest left out; what a recording of the line would hold.
    pub fn all_bytes(&self) -> Vec<u8> {
        let mut all = Vec::new();
        for step in &self.steps {
            if let Step::Bytes(bytes) | Step::Report(bytes) = step {
                all.extend_from_slice(bytes);
            }
        }
        all
    }
}
