//! The network as a patch panel draws it: boxes with their ports, and the wires between them.
//!
//! Apart from `view`, which describes one instance for a listing, because a picture is kept, compared by its
//! revision and drawn many times. What moves through the wires is in `activity`, which is filled anew every
//! frame.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::Machine;
use super::rendered::MESSAGE;
use crate::language::{Input, Name};
use crate::names::{Owner, Thing};
use crate::network::{Inlet, Instance, InstanceId, Numbered, Outlet, Role, SinkId};
use crate::structure::NodeId;
use crate::value::Kinds;

/// Everything that is wired or could be, as it stood at one [`Machine::topology_revision`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// [`Machine::topology_revision`] when it was made.
    pub revision: u64,
    /// Every function and variable; devices, display nodes and host parameters that are wired; all labelled
    /// members of structures that hold functions. Devices first, then in the order they were made.
    pub boxes: Vec<BoxPicture>,
    /// By sender, then in the order of delivery.
    pub wires: Vec<Wire>,
    /// Devices, named display nodes and host parameters that no wire reaches: what else could be connected.
    pub unwired: Vec<BoxPicture>,
    /// What each of `boxes` is to the machine.
    pub(super) things: Vec<Thing>,
}

/// One box.
#[derive(Clone, Debug, PartialEq)]
pub struct BoxPicture {
    /// As commands name it.
    pub name: Name,
    /// What it is to the user.
    pub role: BoxRole,
    /// `F:ADDC`, `F:ROUTE(4)`, `variable`, `device`, `ROTATE`, `parameter`.
    pub what: Arc<str>,
    /// The structure it is a labelled member of.
    pub structure: Option<Name>,
    /// From <1>; of vector lists and texts the named inputs, then the numbered ones that are wired.
    pub inputs: Vec<PortPicture>,
    /// From <1>.
    pub outputs: Vec<PortPicture>,
    /// Where its inputs begin in [`super::Activity::inputs`].
    pub first_input: usize,
    /// Where its outputs begin in [`super::Activity::outputs`].
    pub first_output: usize,
}

/// What a box is to the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxRole {
    /// Made by `name := F:TYPE`.
    Function,
    /// Made by `VARIABLE name`.
    Variable,
    /// There from the start: dials, labels, lamps.
    Device,
    /// Part of the display tree.
    Node,
    /// Declared by the host.
    Parameter,
}

/// One input or output of a box.
#[derive(Clone, Debug, PartialEq)]
pub struct PortPicture {
    /// Which one; outputs are numbered.
    pub input: Input,
    /// What it takes or sends.
    pub kinds: Kinds,
    /// Whether firings leave its message in place. Never of outputs.
    pub constant: bool,
}

/// One wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wire {
    /// Index into [`Picture::boxes`].
    pub from_box: usize,
    /// From 1.
    pub output: u8,
    /// Index into [`Picture::boxes`].
    pub to_box: usize,
    /// Which input, as commands write it.
    pub input: Input,
}

impl Picture {
    /// The box of a name.
    pub fn find(&self, name: &Name) -> Option<usize> {
        self.boxes.iter().position(|shown| shown.name == *name)
    }
}

impl BoxPicture {
    /// The place of an input among [`BoxPicture::inputs`].
    pub fn input(&self, input: Input) -> Option<usize> {
        self.inputs.iter().position(|port| port.input == input)
    }
}

/// What is joined to what, gathered once.
#[derive(Default)]
struct Joined {
    things: BTreeSet<Thing>,
    /// Numbered inputs of data nodes that are fed.
    numbers: BTreeMap<NodeId, BTreeSet<Input>>,
}

impl Machine {
    /// The network as a patch panel draws it. Make it anew only when [`Machine::topology_revision`] is not its
    /// own any more.
    pub fn picture(&self) -> Picture {
        let joined = self.joined();
        let holders = self.structures_with_functions();
        let mut picture = Picture {
            revision: self.topology,
            ..Picture::default()
        };
        for (thing, shown) in self.all_boxes(&joined) {
            let always = matches!(shown.role, BoxRole::Function | BoxRole::Variable);
            let housed = shown
                .structure
                .as_ref()
                .is_some_and(|name| holders.contains(name));
            if always || housed || joined.things.contains(&thing) {
                picture.add(thing, shown);
            } else {
                picture.unwired.push(shown);
            }
        }
        self.add_wires(&mut picture);
        picture
    }

    fn joined(&self) -> Joined {
        let mut joined = Joined::default();
        for Numbered { id, instance } in self.network.instances() {
            for output in 1..=instance.output_count() as u8 {
                for &inlet in self.network.destinations(Outlet { from: id, output }) {
                    joined.things.insert(self.sends_for(id));
                    let (thing, input) = thing_at(inlet);
                    joined.things.insert(thing);
                    if let Thing::Node(node) = thing {
                        joined.numbers.entry(node).or_default().insert(input);
                    }
                }
            }
        }
        joined
    }

    /// The structures that have functions among their labelled members.
    fn structures_with_functions(&self) -> BTreeSet<Name> {
        let labels = self.names.defined().into_iter().filter(|&entry| {
            let entry = self.names.entry(entry);
            entry.owner == Owner::Structure && matches!(entry.thing, Some(Thing::Instance(_)))
        });
        labels
            .filter_map(|entry| around(&self.names.entry(entry).name))
            .collect()
    }

    fn all_boxes(&self, joined: &Joined) -> Vec<(Thing, BoxPicture)> {
        let mut all: Vec<(Thing, BoxPicture)> = self
            .network
            .instances()
            .into_iter()
            .filter(|numbered| numbered.instance.role != Role::Node)
            .map(|Numbered { id, instance }| (Thing::Instance(id), self.instance_box(id, instance)))
            .collect();
        all.sort_by_key(|(_, shown)| shown.role != BoxRole::Device);
        for entry in self.names.defined() {
            if let Some(Thing::Node(id)) = self.names.denoted(entry) {
                let is_label = self.names.entry(entry).owner == Owner::Structure;
                let shown = self.node_box(id, self.names.spelling(entry), is_label, joined);
                all.push((Thing::Node(id), shown));
            }
        }
        for id in (0..self.network.sink_count() as u32).map(SinkId) {
            if let Some(shown) = self.sink_box(id) {
                all.push((Thing::Sink(id), shown));
            }
        }
        all
    }

    fn instance_box(&self, id: InstanceId, instance: Instance<'_>) -> BoxPicture {
        let name = self.spelt(Thing::Instance(id), instance.name);
        let is_label = self
            .names
            .find(&name)
            .is_some_and(|entry| self.names.entry(entry).owner == Owner::Structure);
        let numbered = (1_u16..).map(Input::Number);
        let inputs = numbered
            .clone()
            .zip(instance.input_ports())
            .map(|(input, port)| PortPicture {
                input,
                kinds: port.kinds,
                constant: port.constant,
            });
        let outputs = numbered
            .zip(instance.output_ports())
            .map(|(input, port)| PortPicture {
                input,
                kinds: port.kinds,
                constant: false,
            });
        BoxPicture {
            role: match instance.role {
                Role::Function => BoxRole::Function,
                Role::Variable => BoxRole::Variable,
                Role::Device => BoxRole::Device,
                Role::Node => BoxRole::Node,
            },
            what: instance.what().into(),
            structure: is_label.then(|| around(&name)).flatten(),
            inputs: inputs.collect(),
            outputs: outputs.collect(),
            ..BoxPicture::bare(name)
        }
    }

    fn node_box(&self, id: NodeId, name: Name, is_label: bool, joined: &Joined) -> BoxPicture {
        let named = Input::NAMED.iter().map(|&(_, input)| input);
        let fed = joined.numbers.get(&id).into_iter().flatten().copied();
        let mut inputs: Vec<Input> = named
            .filter(|&input| self.structure.accepts(id, input).is_some())
            .collect();
        if inputs.is_empty() {
            let numbered = (1..=NODE_INPUTS_MAX).map(Input::Number);
            inputs.extend(numbered.take_while(|&input| self.structure.accepts(id, input).is_some()));
        } else {
            inputs.extend(fed.filter(|input| matches!(input, Input::Number(_))));
        }
        let ports = inputs.into_iter().map(|input| PortPicture {
            input,
            kinds: self.structure.accepts(id, input).unwrap_or(Kinds::NONE),
            constant: false,
        });
        let rendered = self.structure.renders(id).then_some(PortPicture {
            input: Input::Number(1),
            kinds: MESSAGE,
            constant: false,
        });
        BoxPicture {
            role: BoxRole::Node,
            what: self.structure.what(id).into(),
            structure: is_label.then(|| around(&name)).flatten(),
            inputs: ports.collect(),
            outputs: rendered.into_iter().collect(),
            ..BoxPicture::bare(name)
        }
    }

    fn sink_box(&self, id: SinkId) -> Option<BoxPicture> {
        let sink = self.network.sink(id)?;
        let is_device = self.readouts.has(id);
        let inputs = (1_u16..).zip(&sink.inputs).map(|(number, port)| PortPicture {
            input: Input::Number(number),
            kinds: port.kinds,
            constant: false,
        });
        Some(BoxPicture {
            role: if is_device {
                BoxRole::Device
            } else {
                BoxRole::Parameter
            },
            what: if is_device { "device" } else { "parameter" }.into(),
            inputs: inputs.collect(),
            ..BoxPicture::bare(sink.name.clone())
        })
    }

    fn add_wires(&self, picture: &mut Picture) {
        let places: BTreeMap<Thing, usize> = picture.things.iter().copied().zip(0..).collect();
        for (from_box, &thing) in picture.things.iter().enumerate() {
            let Some(from) = self.sender(thing) else { continue };
            for output in 1..=picture.boxes[from_box].outputs.len() as u8 {
                for &inlet in self.network.destinations(Outlet { from, output }) {
                    let (to, input) = thing_at(inlet);
                    if let Some(&to_box) = places.get(&to) {
                        picture.wires.push(Wire {
                            from_box,
                            output,
                            to_box,
                            input,
                        });
                    }
                }
            }
        }
    }
}

/// No display node has more numbered inputs than this, apart from those whose inputs are its vectors.
const NODE_INPUTS_MAX: u16 = 64;

impl BoxPicture {
    fn bare(name: Name) -> Self {
        Self {
            name,
            role: BoxRole::Node,
            what: "".into(),
            structure: None,
            inputs: Vec::new(),
            outputs: Vec::new(),
            first_input: 0,
            first_output: 0,
        }
    }
}

impl Picture {
    fn add(&mut self, thing: Thing, mut shown: BoxPicture) {
        if let Some(last) = self.boxes.last() {
            shown.first_input = last.first_input + last.inputs.len();
            shown.first_output = last.first_output + last.outputs.len();
        }
        self.boxes.push(shown);
        self.things.push(thing);
    }
}

/// The structure a label lies in.
fn around(label: &Name) -> Option<Name> {
    label
        .as_str()
        .rsplit_once('.')
        .map(|(structure, _)| Name::new(structure))
}

fn thing_at(inlet: Inlet) -> (Thing, Input) {
    match inlet {
        Inlet::Function { to, input } => (Thing::Instance(to), Input::Number(input.into())),
        Inlet::Sink { to, input } => (Thing::Sink(to), Input::Number(input.into())),
        Inlet::Node { to, input } => (Thing::Node(to), input),
    }
}
