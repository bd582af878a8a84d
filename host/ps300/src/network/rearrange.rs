//! What a patch changes in a network that runs, apart from what commands can say: the order of wires and of
//! instances, and a constant back to its preset.

use super::{Inlet, InstanceId, Network, Outlet};

impl Network {
    /// Makes an output feed these inputs, in this order.
    pub(crate) fn set_destinations(&mut self, from: Outlet, to: &[Inlet]) {
        if self.disconnect_output(from).is_err() {
            return;
        }
        for &inlet in to {
            if let Ok(output) = self.output_mut(from) {
                output.add(inlet);
            }
            self.wires.insert((inlet, from));
        }
    }

    /// Makes a constant what it was before anybody sent one.
    pub(crate) fn unset(&mut self, id: InstanceId, input: u8) {
        // An input made active starts empty, and one made constant without a message has its preset.
        self.set_constant(id, input, false);
        self.set_constant(id, input, true);
    }

    /// Gives instances their places in listings, and clocks their turn, as if they had just been made in this
    /// order.
    pub(crate) fn renumber(&mut self, order: &[InstanceId]) {
        for &id in order {
            if let Some(Some(description)) = self.descriptions.get_mut(id.0 as usize) {
                description.serial = self.made;
                self.made += 1;
            }
        }
        let descriptions = &self.descriptions;
        let serial = |id: &InstanceId| descriptions.get(id.0 as usize)?.as_ref().map(|it| it.serial);
        self.clocks.sort_by_key(serial);
    }

    /// Whether a wire leads to an input of a function.
    pub(crate) fn is_input_fed(&self, to: InstanceId, input: u8) -> bool {
        let at = Inlet::Function { to, input };
        self.feeding_instance(to).any(|(inlet, _)| inlet == at)
    }
}
