//! A network at the other end of the patch panel: a machine of its own, so that the panel can be tried by itself.

use std::collections::BTreeMap;
use std::sync::Arc;

use ps300::language::{self, Command, Definition, Input, Name, Node, Operation};
use ps300::machine::devices::READOUTS;
use ps300::network::Role as InstanceRole;
use ps300::{Kind, Kinds, Machine, Value};
use ui::patch::look::{
    Activity, Ask, BoxPicture, InputActivity, Look, OutputActivity, Picture, PortPicture, Role, Wire,
};

/// Firings a tick may take: more than any network here needs.
const FIRINGS: u32 = 100_000;

/// The machine, and what a panel is told of it.
pub(crate) struct Link {
    machine: Machine,
    sinks: Vec<(String, Vec<Kinds>)>,
    sent: BTreeMap<(Name, u8), (u64, Option<Value>)>,
    frozen: BTreeMap<(Name, u8), u64>,
    reports: Vec<(Name, String)>,
    past: Vec<String>,
    future: Vec<String>,
    picture: Arc<Picture>,
    shape: String,
    ticks: u64,
}

impl Link {
    /// A machine with this program and the given parameters.
    pub(crate) fn new(program: &str, sinks: &[(&str, &[Kinds])]) -> Link {
        let mut link = Link {
            machine: Machine::new(),
            sinks: sinks
                .iter()
                .map(|(name, kinds)| ((*name).to_owned(), kinds.to_vec()))
                .collect(),
            sent: BTreeMap::new(),
            frozen: BTreeMap::new(),
            reports: Vec::new(),
            past: Vec::new(),
            future: Vec::new(),
            picture: Arc::default(),
            shape: String::new(),
            ticks: 0,
        };
        link.load(program);
        link
    }

    fn load(&mut self, program: &str) {
        let mut machine = Machine::new();
        for (name, kinds) in &self.sinks {
            machine.declare_sink(name, kinds).expect("the names are new");
        }
        let wrong = machine.load(program);
        assert!(wrong.is_empty(), "{wrong:?}");
        self.machine = machine;
    }

    pub(crate) fn text(&self) -> String {
        self.machine.network_text()
    }

    /// Does what a hand wanted. Commands that are refused are left out.
    pub(crate) fn ask(&mut self, ask: Ask) {
        let before = self.text();
        match ask {
            Ask::Commands(text) => {
                self.machine.load(&text);
            }
            Ask::Program(text) => self.load(&text),
            Ask::Undo => {
                if let Some(text) = self.past.pop() {
                    self.future.push(before);
                    self.load(&text);
                }
                return;
            }
            Ask::Redo => {
                if let Some(text) = self.future.pop() {
                    self.past.push(before);
                    self.load(&text);
                }
                return;
            }
            Ask::Freeze { name, output, on } => {
                if on {
                    self.frozen.insert((name, output), 0);
                } else {
                    self.frozen.remove(&(name, output));
                }
                return;
            }
        }
        self.past.push(before);
        self.future.clear();
    }

    pub(crate) fn emit(&mut self, device: &str, output: u8, value: impl Into<Value>) {
        assert!(self.machine.emit(device, output, value), "{device}<{output}>");
    }

    pub(crate) fn tick(&mut self) {
        self.ticks += 1;
        self.machine.tick(self.ticks as f64 / 60.0, self.ticks, FIRINGS);
        let heard: Vec<_> = self.machine.drain_watched().collect();
        for watched in heard {
            let seen = self
                .sent
                .entry((watched.name.clone(), watched.output))
                .or_default();
            *seen = (seen.0 + 1, Some(watched.value.clone()));
        }
        for report in self.machine.reports() {
            self.reports.push((report.name.clone(), report.to_string()));
        }
    }

    /// What the panel is told now.
    pub(crate) fn look(&mut self) -> Look {
        let text = self.text();
        if text != self.shape {
            self.picture = Arc::new(self.painted());
            self.shape.clone_from(&text);
        }
        let picture = self.picture.clone();
        let place = |name: &Name| picture.boxes.iter().position(|seen| seen.name == *name);
        let reports = self
            .reports
            .iter()
            .filter_map(|(name, words)| Some((place(name)?, words.clone())));
        Look {
            activity: Arc::new(self.activity()),
            text: text.into(),
            can_undo: !self.past.is_empty(),
            can_redo: !self.future.is_empty(),
            reports: reports.collect(),
            picture: self.picture.clone(),
        }
    }

    fn activity(&self) -> Activity {
        let mut activity = Activity::default();
        let instances = self.machine.instances();
        for seen in &self.picture.boxes {
            let instance = instances.iter().find(|instance| *instance.name == seen.name);
            for (index, _) in seen.inputs.iter().enumerate() {
                let input = instance.and_then(|instance| instance.inputs.get(index));
                activity.inputs.push(InputActivity {
                    waiting: input.map_or(0, |input| input.waiting as u32),
                    front: input.and_then(|input| input.front.cloned()),
                });
            }
            for (index, _) in seen.outputs.iter().enumerate() {
                let key = (seen.name.clone(), index as u8 + 1);
                let (sent, last) = self.sent.get(&key).cloned().unwrap_or_default();
                activity.outputs.push(OutputActivity {
                    sent,
                    last,
                    frozen: self.frozen.contains_key(&key),
                    withheld: self.frozen.get(&key).copied().unwrap_or(0),
                });
            }
            let count = self.reports.iter().filter(|(name, _)| *name == seen.name).count();
            activity.reports.push(count as u64);
        }
        activity
    }

    fn painted(&mut self) -> Picture {
        let wires = self.machine.connections();
        let wired = |name: &Name| {
            wires
                .iter()
                .any(|wire| wire.from == *name || wire.to.name == *name)
        };
        let mut boxes: Vec<BoxPicture> = self
            .instances()
            .chain(nodes(&self.machine))
            .chain(self.sink_boxes())
            .collect();
        let kept =
            |seen: &BoxPicture| matches!(seen.role, Role::Function | Role::Variable) || wired(&seen.name);
        let others = boxes.iter().filter(|seen| !kept(seen)).cloned().collect();
        boxes.retain(kept);
        let place = |name: &Name| boxes.iter().position(|seen| seen.name == *name);
        let wires = wires
            .iter()
            .filter_map(|wire| {
                Some(Wire {
                    from_box: place(&wire.from)?,
                    output: wire.output,
                    to_box: place(&wire.to.name)?,
                    input: wire.to.input,
                })
            })
            .collect();
        for seen in &boxes {
            for output in 1..=seen.outputs.len() as u8 {
                self.machine.watch(seen.name.as_str(), output);
            }
        }
        Picture {
            revision: self.picture.revision + 1,
            boxes,
            wires,
            others,
        }
    }

    fn instances(&self) -> impl Iterator<Item = BoxPicture> {
        let picture = |instance: ps300::machine::InstanceView<'_>| {
            let size = instance.size.map_or_else(String::new, |size| format!("({size})"));
            let (role, what) = match instance.role {
                InstanceRole::Device => (Role::Device, String::from("device")),
                InstanceRole::Variable => (Role::Variable, String::from("variable")),
                InstanceRole::Function => (Role::Function, format!("F:{}{size}", instance.spec.name)),
            };
            let inputs = instance.inputs.iter().enumerate();
            let outputs = instance.outputs.iter().enumerate();
            BoxPicture {
                name: instance.name.clone(),
                role,
                what: what.into(),
                structure: None,
                labels: Vec::new(),
                inputs: inputs
                    .map(|(index, input)| port(index, input.kinds, input.constant))
                    .collect(),
                outputs: outputs
                    .map(|(index, output)| port(index, output.kinds, false))
                    .collect(),
            }
        };
        self.machine
            .instances()
            .into_iter()
            .map(picture)
            .collect::<Vec<_>>()
            .into_iter()
    }

    fn sink_boxes(&self) -> impl Iterator<Item = BoxPicture> + '_ {
        let own = self.sinks.iter().map(|(name, kinds)| sink(name, kinds));
        let desk = READOUTS.iter().flat_map(|readout| {
            let numbers = readout.numbers.map_or(0..=0, |(first, last)| first..=last);
            numbers.map(move |number| match readout.numbers {
                Some(_) => sink(&format!("{}{number}", readout.name), &[readout.kinds]),
                None => sink(readout.name, &[readout.kinds]),
            })
        });
        own.chain(desk)
    }
}

fn port(index: usize, kinds: Kinds, constant: bool) -> PortPicture {
    PortPicture {
        input: Input::Number(index as u16 + 1),
        kinds,
        constant,
    }
}

fn sink(name: &str, kinds: &[Kinds]) -> BoxPicture {
    BoxPicture {
        name: Name::new(name),
        role: Role::Parameter,
        what: "parameter".into(),
        structure: None,
        labels: Vec::new(),
        inputs: kinds
            .iter()
            .enumerate()
            .map(|(index, &kinds)| port(index, kinds, false))
            .collect(),
        outputs: Vec::new(),
    }
}

/// Labelled operations of structures.
fn nodes(machine: &Machine) -> impl Iterator<Item = BoxPicture> {
    let mut found = Vec::new();
    for command in machine.program() {
        let Command::Define {
            name,
            definition: Definition::Node(Node::Structure(members)),
        } = command
        else {
            continue;
        };
        for member in members {
            let (Some(label), Node::Operation { operation, .. }) = (member.label, member.node) else {
                continue;
            };
            let (what, kinds) = operation_port(&operation);
            found.push(BoxPicture {
                name: Name::new(&format!("{name}.{label}")),
                role: Role::Node,
                what: what.into(),
                structure: Some(name.clone()),
                labels: Vec::new(),
                inputs: vec![port(0, kinds, false)],
                outputs: Vec::new(),
            });
        }
    }
    found.into_iter()
}

fn operation_port(operation: &Operation) -> (&'static str, Kinds) {
    match operation {
        Operation::Rotate { .. } => ("ROTATE", Kinds::of(&[Kind::Matrix3])),
        Operation::Translate(_) => ("TRANSLATE", Kinds::of(&[Kind::Vector2, Kind::Vector3])),
        Operation::Scale(_) => (
            "SCALE",
            Kinds::NUMBER | Kinds::of(&[Kind::Matrix3, Kind::Vector3]),
        ),
        _ => ("operation", Kinds::ANY),
    }
}

/// A text that says the same as another, whatever the order of its commands.
pub(crate) fn sorted(text: &str) -> Vec<String> {
    let (commands, wrong) = language::parse(text);
    assert!(wrong.is_empty(), "{wrong:?}");
    let mut lines: Vec<String> = commands
        .iter()
        .map(|command| language::print(&command.what))
        .collect();
    lines.sort();
    lines
}
