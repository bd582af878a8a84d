//! Joining outputs to inputs and parting them.

use super::connection::{ConnectError, Inlet, InstanceId, Outlet, input_text};
use super::output::OutputPort;
use super::{Instance, Network};
use crate::language::{Input, Name};
use crate::structure::NodeId;
use crate::value::Kinds;

const FIRST_OUTLET: Outlet = Outlet {
    from: InstanceId(0),
    output: 0,
};

impl Network {
    /// Joins two ends; false if they were joined already.
    pub(crate) fn connect(&mut self, from: Outlet, to: Inlet, accepted: Kinds) -> Result<bool, ConnectError> {
        let max = self.limits.fan_out_max;
        let output = self.output_mut(from)?;
        let offered = output.kinds;
        let full = output.to().len() >= max;
        if !offered.meets(accepted) {
            let to = self.inlet_text(to);
            return Err(ConnectError::Kinds {
                from: self.outlet_text(from),
                to,
                offered,
                accepted,
            });
        }
        let joined = self.wires.contains(&(to, from));
        if full && !joined {
            return Err(ConnectError::FanOut {
                from: self.outlet_text(from),
                max,
            });
        }
        if !joined {
            self.output_mut(from)?.add(to);
            self.wires.insert((to, from));
        }
        Ok(!joined)
    }

    /// Parts two ends; false if they were not joined. Messages already queued stay.
    pub(crate) fn disconnect(&mut self, from: Outlet, to: Inlet) -> Result<bool, ConnectError> {
        let output = self.output_mut(from)?;
        output.retain(|inlet| inlet != to);
        Ok(self.wires.remove(&(to, from)))
    }

    /// Parts an output from everything.
    pub(crate) fn disconnect_output(&mut self, from: Outlet) -> Result<(), ConnectError> {
        let gone = self.output_mut(from)?.to().to_vec();
        for inlet in gone {
            self.wires.remove(&(inlet, from));
        }
        self.output_mut(from)?.retain(|_| false);
        Ok(())
    }

    /// Parts every output of an instance.
    pub(crate) fn disconnect_all(&mut self, id: InstanceId) {
        let outputs = self.instance(id).map_or(0, Instance::output_count) as u8;
        for output in 1..=outputs {
            // Every one of them is there.
            let _ = self.disconnect_output(Outlet { from: id, output });
        }
    }

    /// Removes every connection.
    pub(crate) fn disconnect_everything(&mut self) {
        for output in &mut self.outputs {
            output.retain(|_| false);
        }
        self.wires.clear();
    }

    /// Every wire that leads to an instance.
    pub(super) fn feeding_instance(&self, to: InstanceId) -> impl Iterator<Item = (Inlet, Outlet)> + '_ {
        let first = (Inlet::Function { to, input: 0 }, FIRST_OUTLET);
        self.wires
            .range(first..)
            .copied()
            .take_while(move |(inlet, _)| matches!(inlet, Inlet::Function { to: fed, .. } if *fed == to))
    }

    /// Every wire that leads to a node.
    pub(super) fn feeding_node(&self, to: NodeId) -> impl Iterator<Item = (Inlet, Outlet)> + '_ {
        let input = Input::Number(0); // Comes before all others.
        let first = (Inlet::Node { to, input }, FIRST_OUTLET);
        self.wires
            .range(first..)
            .copied()
            .take_while(move |(inlet, _)| matches!(inlet, Inlet::Node { to: fed, .. } if *fed == to))
    }

    /// Whether any output leads to `to`.
    pub(crate) fn is_fed(&self, to: InstanceId) -> bool {
        self.feeding_instance(to).next().is_some()
    }

    pub(crate) fn outlet(&self, from: InstanceId, output: u8) -> Option<Outlet> {
        let port = usize::from(output).checked_sub(1)?;
        self.instance(from)?.outputs.get(port)?;
        Some(Outlet { from, output })
    }

    pub(crate) fn destinations(&self, from: Outlet) -> &[Inlet] {
        let port = usize::from(from.output).wrapping_sub(1);
        self.instance(from.from)
            .and_then(|instance| instance.outputs.get(port))
            .map_or(&[], OutputPort::to)
    }

    pub(crate) fn watch(&mut self, from: Outlet, on: bool) {
        if let Ok(output) = self.output_mut(from) {
            output.watched = on;
        }
    }

    /// Withholds what an output would send, or lets it send again.
    pub(crate) fn freeze(&mut self, from: Outlet, on: bool) {
        if let Ok(output) = self.output_mut(from) {
            output.freeze(on);
        }
    }

    /// Where an output lies among all.
    pub(super) fn output_at(&self, from: Outlet) -> Option<usize> {
        let number = from.output.wrapping_sub(1);
        let head = self.queues.head(from.from)?;
        (number < head.output_count).then(|| head.first_output as usize + usize::from(number))
    }

    pub(super) fn output_mut(&mut self, from: Outlet) -> Result<&mut OutputPort, ConnectError> {
        let at = self.output_at(from);
        let name = self
            .descriptions
            .get(from.from.0 as usize)
            .and_then(Option::as_ref);
        let name = name.map_or_else(|| Name::new("(removed)"), |description| description.name.clone());
        let has = self.queues.head(from.from).map_or(0, |head| head.outputs().len());
        let missing = ConnectError::NoOutput {
            name,
            output: from.output,
            has,
        };
        at.and_then(|at| self.outputs.get_mut(at)).ok_or(missing)
    }

    pub(crate) fn outlet_text(&self, from: Outlet) -> String {
        let name = self
            .instance(from.from)
            .map_or("?", |instance| instance.name.as_str());
        format!("{name}<{}>", from.output)
    }

    fn inlet_text(&self, to: Inlet) -> String {
        match to {
            Inlet::Function { to, input } => {
                let name = self.instance(to).map_or("?", |instance| instance.name.as_str());
                format!("<{input}>{name}")
            }
            Inlet::Sink { to, input } => {
                let name = self.sink(to).map_or("?", |sink| sink.name.as_str());
                format!("<{input}>{name}")
            }
            Inlet::Node { input, .. } => format!("input {} of the node", input_text(input)),
        }
    }
}
