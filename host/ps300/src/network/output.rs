//! An output of an instance, with what it feeds.

use super::connection::Inlet;
use crate::intrinsic::OutputSpec;
use crate::value::{Kinds, Value};

/// One output of an instance or a device.
pub(crate) struct OutputPort {
    pub(crate) last: Option<Value>,
    to: Fed,
    /// Messages sent so far.
    pub(crate) sent: u64,
    /// Messages withheld so far.
    pub(crate) withheld: u32,
    pub(crate) kinds: Kinds,
    pub(super) watched: bool,
    flow: Flow,
}

/// What becomes of the messages of an output.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Flow {
    /// They are sent.
    Free,
    /// The last is on its way: computed and not yet delivered.
    Leaving,
    /// They are withheld.
    Frozen,
}

/// What an output feeds, in the order of CONNECT, which is the order of delivery. Most feed one input, which is
/// found without going elsewhere.
#[allow(
    clippy::box_collection,
    reason = "an output is half as large again with the list in it, and hardly any has one"
)]
#[derive(Default)]
enum Fed {
    #[default]
    Nothing,
    One(Inlet),
    Many(Box<Vec<Inlet>>),
}

impl OutputPort {
    pub(super) fn new(spec: OutputSpec) -> Self {
        Self {
            last: None,
            to: Fed::Nothing,
            sent: 0,
            withheld: 0,
            kinds: spec.kinds,
            watched: false,
            flow: Flow::Free,
        }
    }

    /// The place for its next message; nothing where that has to be looked at first, or another is on its way.
    #[inline]
    pub(crate) fn next(&mut self) -> Option<&mut Option<Value>> {
        if !self.is_plain() {
            return None;
        }
        self.flow = Flow::Leaving;
        Some(&mut self.last)
    }

    /// Whether a message can simply go.
    #[inline]
    pub(super) fn is_plain(&self) -> bool {
        !self.watched && self.flow == Flow::Free
    }

    #[inline]
    pub(super) fn has_left(&mut self) {
        self.flow = Flow::Free;
    }

    /// Whether what it would send is withheld.
    pub(crate) fn is_frozen(&self) -> bool {
        self.flow == Flow::Frozen
    }

    pub(crate) fn freeze(&mut self, on: bool) {
        self.flow = if on { Flow::Frozen } else { Flow::Free };
    }

    /// What is left of a port whose instance is gone.
    pub(super) fn vacant() -> Self {
        Self::new(OutputSpec::of(Kinds::NONE))
    }

    /// Whether it feeds nothing.
    #[inline]
    pub(super) fn is_alone(&self) -> bool {
        matches!(self.to, Fed::Nothing)
    }

    #[inline]
    pub(super) fn to(&self) -> &[Inlet] {
        match &self.to {
            Fed::Nothing => &[],
            Fed::One(inlet) => std::slice::from_ref(inlet),
            Fed::Many(inlets) => inlets,
        }
    }

    pub(super) fn add(&mut self, inlet: Inlet) {
        match &mut self.to {
            Fed::Nothing => self.to = Fed::One(inlet),
            Fed::One(first) => self.to = Fed::Many(Box::new(vec![*first, inlet])),
            Fed::Many(inlets) => inlets.push(inlet),
        }
    }

    pub(super) fn retain(&mut self, mut keep: impl FnMut(Inlet) -> bool) {
        match &mut self.to {
            Fed::Nothing => {}
            Fed::One(inlet) => {
                if !keep(*inlet) {
                    self.to = Fed::Nothing;
                }
            }
            Fed::Many(inlets) => {
                inlets.retain(|&inlet| keep(inlet));
                if inlets.len() < 2 {
                    self.to = inlets.first().map_or(Fed::Nothing, |&inlet| Fed::One(inlet));
                }
            }
        }
    }
}
