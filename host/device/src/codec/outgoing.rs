//! What a codec wants done on the line, in order.

/// One thing to do on the line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// Send these bytes.
    Bytes(Vec<u8>),
    /// Change the line speed, after everything before has been sent.
    Baud(u32),
}

/// Steps in the order they are to be done.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outgoing {
    steps: Vec<Step>,
}

impl Outgoing {
    /// Nothing to do.
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        if let Some(Step::Bytes(last)) = self.steps.last_mut() {
            last.extend_from_slice(bytes);
        } else {
            self.steps.push(Step::Bytes(bytes.to_vec()));
        }
    }

    /// Appends a change of speed.
    pub fn baud(&mut self, baud: u32) {
        self.steps.push(Step::Baud(baud));
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

    /// All bytes, speeds left out; what a recording of the line would hold.
    pub fn all_bytes(&self) -> Vec<u8> {
        let bytes = |step: &Step| match step {
            Step::Bytes(bytes) => bytes.clone(),
            Step::Baud(_) => Vec::new(),
        };
        self.steps.iter().flat_map(bytes).collect()
    }
}
