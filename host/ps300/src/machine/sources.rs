//! Senders that the host declares: devices that come to be known while the machine runs, and stay.
//!
//! Apart from `devices`, whose senders every machine has. What is declared here is never taken away again: a device
//! that is unplugged falls silent and keeps its wires. It must not know what a device is.

use super::error::DeclareError;
use super::{Machine, with_network};
use crate::intrinsic::{Confidence, Now, Spec};
use crate::language::Name;
use crate::names::Thing;
use crate::network::{InstanceId, Outlet, Ran, Role};
use crate::value::Kinds;

/// What a declared sender is made of; its outputs are those that were declared.
pub(crate) static DECLARED: Spec = Spec::pure("DEVICE", &[], &[], |_, _| Ok(()))
    .says("Sends what the host makes it send.")
    .known(Confidence::Project, "declared by the host");

/// A sender that was declared. Valid as long as the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SourceId(InstanceId);

impl SourceId {
    /// One of its outputs, from 1, for [`Machine::emit_from`]. What an output that is not there sends is lost.
    pub fn outlet(self, output: u8) -> Outlet {
        Outlet { from: self.0, output }
    }
}

impl Machine {
    /// Declares a sender with outputs <1>, <2>… of these kinds, so that networks can be connected to it; at any
    /// time, also while the network runs. It stays for good: commands cannot redefine or delete it. Declared again
    /// with the same outputs, it is the same one.
    pub fn declare_source(&mut self, name: &str, outputs: &[Kinds]) -> Result<SourceId, DeclareError> {
        let name = Name::new(name);
        if !Name::is_valid(name.as_str()) {
            return Err(DeclareError::NotAName { name });
        }
        if outputs.is_empty() || outputs.len() > 127 {
            return Err(DeclareError::Outputs {
                name,
                count: outputs.len(),
            });
        }
        if let Some(thing) = self.names.thing(&name) {
            return match thing {
                Thing::Instance(id) if self.network.sends_as_declared(id, outputs) => Ok(SourceId(id)),
                _ => Err(DeclareError::Taken { name }),
            };
        }
        let Some(id) = self.network.add_source(name.clone(), &DECLARED, outputs) else {
            return Err(DeclareError::Full { name });
        };
        self.names.fix(&name, Thing::Instance(id));
        self.topology += 1;
        Ok(SourceId(id))
    }

    /// The names and outputs of all that was declared, in the order of the names.
    pub fn sources(&self) -> impl Iterator<Item = (&Name, Vec<Kinds>)> {
        let all = self.network.instances().into_iter();
        let declared = all.filter(|it| it.instance.role == Role::Device && it.instance.is_declared());
        declared.map(|it| {
            let outputs = it.instance.output_ports().iter().map(|port| port.kinds);
            (it.instance.name, outputs.collect())
        })
    }

    /// Moves network time alone, without a tick or a frame, and fires at most `firings_max` instances: what a host
    /// does before a message that has a time of its own. Earlier times, and such as are not finite, change nothing.
    pub fn pass_to(&mut self, secs: f64, firings_max: u32) -> Ran {
        if !secs.is_finite() || secs <= self.ticked.secs {
            return Ran::Quiet { firings: 0 };
        }
        self.ticked = Now { secs, ..self.ticked };
        let now = self.ticked;
        with_network!(self, |network, around| {
            network.close_batch(Some(now));
            network.run(firings_max, around)
        })
    }
}
