//! Where a network reaches the host: labels, lamps, and parameters the host declares.
//!
//! A sink keeps the last message of each input, so that a host can look at any time, and queues every
//! message until the host drains it, so that none is missed.

use super::Network;
use super::connection::SinkId;
use crate::language::Name;
use crate::value::{Kinds, Value};

/// A host parameter.
pub(crate) struct Sink {
    pub(crate) name: Name,
    pub(crate) inputs: Vec<SinkInput>,
}

/// One input of a host parameter.
pub(crate) struct SinkInput {
    pub(crate) kinds: Kinds,
    pub(super) last: Option<Value>,
}

impl Network {
    pub(crate) fn add_sink(&mut self, name: Name, inputs: &[Kinds]) -> SinkId {
        let inputs = inputs
            .iter()
            .map(|&kinds| SinkInput { kinds, last: None })
            .collect();
        self.sinks.push(Sink { name, inputs });
        SinkId(self.sinks.len() as u32 - 1)
    }

    pub(crate) fn sink(&self, id: SinkId) -> Option<&Sink> {
        self.sinks.get(id.0 as usize)
    }

    pub(crate) fn sink_count(&self) -> usize {
        self.sinks.len()
    }

    pub(super) fn sink_input_mut(&mut self, id: SinkId, input: u8) -> Option<&mut SinkInput> {
        let sink = self.sinks.get_mut(id.0 as usize)?;
        sink.inputs.get_mut(usize::from(input).checked_sub(1)?)
    }

    pub(crate) fn sink_last(&self, id: SinkId, input: u8) -> Option<&Value> {
        self.sink(id)?
            .inputs
            .get(usize::from(input).checked_sub(1)?)?
            .last
            .as_ref()
    }

    /// Hands over every message for the host, in the order of arrival.
    pub(crate) fn drain_sinks(&mut self, mut take: impl FnMut(SinkId, &str, u8, Value)) {
        while let Some((id, input, value)) = self.arrived.pop_front() {
            let name = self
                .sinks
                .get(id.0 as usize)
                .map_or("", |sink| sink.name.as_str());
            take(id, name, input, value);
        }
    }

    pub(crate) fn drain_watched(&mut self) -> impl Iterator<Item = super::Watched> + '_ {
        self.watched.drain(..)
    }
}
