//! What is shown of a picture: its boxes, with folded structures as one box each and guests that are not wired yet.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::Vec2;
use ps300::Kinds;
use ps300::language::{Input, Name};

use super::look::{BoxPicture, Picture, PortPicture, Role, Wire};
use super::size;

/// All that can be seen.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Boxes, in the picture's order; then guests.
    pub boxes: Vec<Shown>,
    /// Wires between them; those inside a folded structure are not shown.
    pub wires: Vec<ShownWire>,
    /// Unfolded structures.
    pub frames: Vec<Frame>,
    by_name: BTreeMap<Name, usize>,
}

/// One box as shown.
#[derive(Clone, Debug)]
pub struct Shown {
    /// Of the instance, or of the folded structure.
    pub name: Name,
    /// What it stands for.
    pub role: Role,
    /// Its type.
    pub what: Arc<str>,
    /// What the picture calls it.
    pub part: Part,
    /// In order.
    pub inputs: Vec<Port>,
    /// In order.
    pub outputs: Vec<Port>,
    /// At zoom 1.
    pub size: Vec2,
    /// The structure around it, where that is unfolded.
    pub structure: Option<Name>,
}

/// Where a shown box comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// A box of the picture.
    Box(usize),
    /// A folded structure with these boxes.
    Folded(Vec<usize>),
    /// Put on the table by hand, not wired yet.
    Guest,
}

/// One port as shown.
#[derive(Clone, Debug)]
pub struct Port {
    /// Whose it is; differs from the box's name on folded structures.
    pub of: Name,
    /// Its number or name.
    pub input: Input,
    /// What it takes or sends.
    pub kinds: Kinds,
    /// Whether it keeps its message.
    pub constant: bool,
    /// As written beside it.
    pub label: Arc<str>,
    /// Its place in the activity; guests have none.
    pub activity: Option<usize>,
}

/// One wire as shown: boxes and ports by their places in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShownWire {
    /// Box and output.
    pub from: (usize, usize),
    /// Box and input.
    pub to: (usize, usize),
}

/// An unfolded structure.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Its name.
    pub name: Name,
    /// Its boxes.
    pub members: Vec<usize>,
}

impl Scene {
    /// What is shown of `picture` when the structures `folded` are folded and the boxes `guests` lie ready.
    pub fn new(picture: &Picture, folded: &BTreeSet<Name>, guests: &BTreeSet<Name>) -> Scene {
        let mut scene = Scene::default();
        let places = scene.take_boxes(picture, folded);
        for wire in &picture.wires {
            scene.take_wire(picture, &places, wire);
        }
        for shown in &mut scene.boxes {
            shown.size = shown.measured();
        }
        for guest in picture
            .unwired
            .iter()
            .filter(|other| guests.contains(&other.name))
        {
            let shown = Shown::of(guest, Part::Guest, None);
            scene.add(shown);
        }
        let mut frames: BTreeMap<Name, Vec<usize>> = BTreeMap::new();
        for (index, shown) in scene.boxes.iter().enumerate() {
            if let Some(structure) = &shown.structure {
                frames.entry(structure.clone()).or_default().push(index);
            }
        }
        scene.frames = frames
            .into_iter()
            .map(|(name, members)| Frame { name, members })
            .collect();
        scene
    }

    fn add(&mut self, shown: Shown) -> usize {
        let index = self.boxes.len();
        self.by_name.insert(shown.name.clone(), index);
        self.boxes.push(shown);
        index
    }

    /// Where each box of the picture is shown.
    fn take_boxes(&mut self, picture: &Picture, folded: &BTreeSet<Name>) -> Vec<usize> {
        let mut places = Vec::with_capacity(picture.boxes.len());
        for (index, seen) in picture.boxes.iter().enumerate() {
            let around = seen.structure.as_ref().filter(|around| folded.contains(*around));
            let place = if let Some(around) = around {
                let known = self.by_name.get(around).copied();
                let place = known.unwrap_or_else(|| self.add(Shown::folded(around)));
                if let Part::Folded(members) = &mut self.boxes[place].part {
                    members.push(index);
                }
                place
            } else {
                self.add(Shown::of(
                    seen,
                    Part::Box(index),
                    Some((seen.first_input, seen.first_output)),
                ))
            };
            places.push(place);
        }
        places
    }

    fn take_wire(&mut self, picture: &Picture, places: &[usize], wire: &Wire) {
        let (Some(&from), Some(&to)) = (places.get(wire.from_box), places.get(wire.to_box)) else {
            return;
        };
        let folded = |part: &Part| matches!(part, Part::Folded(_));
        if from == to && folded(&self.boxes[from].part) {
            return;
        }
        let output = self.output(picture, from, wire);
        let input = self.input(picture, to, wire);
        if let (Some(output), Some(input)) = (output, input) {
            self.wires.push(ShownWire {
                from: (from, output),
                to: (to, input),
            });
        }
    }

    /// The output a wire leaves by; on a folded structure it is made when the first wire needs it.
    fn output(&mut self, picture: &Picture, place: usize, wire: &Wire) -> Option<usize> {
        let number = Input::Number(wire.output.into());
        let seen = picture.boxes.get(wire.from_box)?;
        let port = seen.outputs.get(usize::from(wire.output).checked_sub(1)?)?;
        let shown = &mut self.boxes[place];
        let found = shown
            .outputs
            .iter()
            .position(|p| p.of == seen.name && p.input == number);
        if found.is_some() || !matches!(shown.part, Part::Folded(_)) {
            return found;
        }
        let mut made = Port::of(
            &seen.name,
            port,
            Some(seen.first_output + usize::from(wire.output) - 1),
        );
        made.input = number;
        made.label = member_label(&seen.name, number);
        shown.outputs.push(made);
        Some(shown.outputs.len() - 1)
    }

    fn input(&mut self, picture: &Picture, place: usize, wire: &Wire) -> Option<usize> {
        let seen = picture.boxes.get(wire.to_box)?;
        let at = seen.inputs.iter().position(|port| port.input == wire.input)?;
        let shown = &mut self.boxes[place];
        let found = shown
            .inputs
            .iter()
            .position(|p| p.of == seen.name && p.input == wire.input);
        if found.is_some() || !matches!(shown.part, Part::Folded(_)) {
            return found;
        }
        let mut made = Port::of(&seen.name, &seen.inputs[at], Some(seen.first_input + at));
        made.label = member_label(&seen.name, wire.input);
        shown.inputs.push(made);
        Some(shown.inputs.len() - 1)
    }

    /// The box of a name.
    pub fn find(&self, name: &Name) -> Option<usize> {
        self.by_name.get(name).copied()
    }
}

impl Shown {
    fn of(seen: &BoxPicture, part: Part, activity: Option<(usize, usize)>) -> Shown {
        let ports = |ports: &[PortPicture], base: Option<usize>| {
            let one = |(index, port)| Port::of(&seen.name, port, base.map(|base| base + index));
            ports.iter().enumerate().map(one).collect::<Vec<_>>()
        };
        let mut shown = Shown {
            name: seen.name.clone(),
            role: seen.role,
            what: seen.what.clone(),
            part,
            inputs: ports(&seen.inputs, activity.map(|a| a.0)),
            outputs: ports(&seen.outputs, activity.map(|a| a.1)),
            size: Vec2::ZERO,
            structure: seen.structure.clone(),
        };
        shown.size = shown.measured();
        shown
    }

    fn folded(name: &Name) -> Shown {
        Shown {
            name: name.clone(),
            role: Role::Node,
            what: "structure".into(),
            part: Part::Folded(Vec::new()),
            inputs: Vec::new(),
            outputs: Vec::new(),
            size: Vec2::ZERO,
            structure: None,
        }
    }

    fn measured(&self) -> Vec2 {
        size::of(
            self.title(),
            self.kind_word(),
            self.inputs.len(),
            self.outputs.len(),
        )
    }

    /// Height of a port's middle below the box's top.
    pub fn port_y(&self, index: usize) -> f32 {
        size::port(index)
    }

    /// The name as shown: inside the frame of its structure without the structure's name.
    pub fn title(&self) -> &str {
        let name = self.name.as_str();
        match &self.structure {
            Some(around) => name.get(around.as_str().len() + 1..).unwrap_or(name),
            None => name,
        }
    }

    /// The type without `F:`, which the shape of the box says.
    pub fn kind_word(&self) -> &str {
        self.what.strip_prefix("F:").unwrap_or(&self.what)
    }
}

impl Port {
    fn of(name: &Name, port: &PortPicture, activity: Option<usize>) -> Port {
        Port {
            of: name.clone(),
            input: port.input,
            kinds: port.kinds,
            constant: port.constant,
            label: input_word(port.input),
            activity,
        }
    }
}

/// A port's number or name, as written between angle brackets.
pub fn input_word(input: Input) -> Arc<str> {
    match input {
        Input::Number(number) => number.to_string().into(),
        named => {
            let known = Input::NAMED.into_iter().find(|(_, input)| *input == named);
            known.map_or("?", |(name, _)| name).into()
        }
    }
}

fn member_label(name: &Name, input: Input) -> Arc<str> {
    let member = name
        .as_str()
        .split_once('.')
        .map_or(name.as_str(), |(_, member)| member);
    format!("{member} {}", input_word(input)).into()
}
