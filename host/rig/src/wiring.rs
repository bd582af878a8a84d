//! The function network inside the rig: loaded from the show, fed by the desk, drained into requests.
//!
//! A figure's shapes are commands of the same language, so they are drawn by a machine too: its own, because a
//! shape called `line` must not meet a function called `line`.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DMat4;
use motion::figure::Figure;
use ps300::Diagnostic;
use ps300::display::{DisplayList, Stroke};
use ps300::language::{self, Command, Disconnection, Name, Position, Severity};
use ps300::machine::{Machine, Panel};
use ps300::network::{Outlet, SinkId};
use ps300::value::{Kinds, Value};

use crate::controls::inlets::{self, Inlet, PAGES};
use crate::controls::instance::Instance;
use crate::document::{FigureDoc, Show};
use crate::parameters::{self, JOINT, LINK, PARAMETERS, Request};

/// Firings that the messages of one step may set off, and again its clocks; what is left goes on in the next one.
const FIRINGS_PER_STEP: u32 = 20_000;

/// The network and what it is connected to.
pub(crate) struct Wiring {
    machine: Machine,
    /// Upper-case names of the figure's link parameters, in the figure's order.
    links: Vec<String>,
    /// The puppet's joints.
    joints: Vec<String>,
    /// Inlets of devices: whose, and what for.
    device_inlets: BTreeMap<SinkId, (usize, Inlet)>,
    /// What arrived there since it was last asked for.
    device_messages: Vec<DeviceMessage>,
    frame: u64,
    secs: f64,
    /// Of [`FIRINGS_PER_STEP`].
    firings_left: u32,
    picture: (u64, Arc<DisplayList>),
}

/// A machine that has what the rig can be asked for, and the upper-case names of the figure's link parameters, in the
/// figure's order.
pub(crate) fn machine_for(show: &Show) -> (Machine, Vec<String>) {
    let mut machine = Machine::new();
    for parameter in PARAMETERS {
        let kinds: Vec<Kinds> = parameter.inlets.iter().map(|inlet| inlet.kinds).collect();
        // Names of the table's own, which a test keeps apart from the machine's.
        let _ = machine.declare_sink(parameter.name, &kinds);
    }
    let mut links = Vec::new();
    let kinds: Vec<Kinds> = LINK.iter().map(|(kinds, _)| *kinds).collect();
    for link in show.figure.iter().flat_map(|f| f.figure.links()) {
        let name = format!("FIGURE.{}", link.name);
        // Motion capture may name links in ways the language cannot spell; they have no inlet then.
        if let Err(error) = machine.declare_sink(&name, &kinds) {
            tracing::debug!("{error}");
        }
        links.push(name.to_ascii_uppercase());
    }
    (machine, links)
}

/// A message at an inlet of a device.
pub(crate) struct DeviceMessage {
    /// Which device, in the order in which they came to be known.
    pub(crate) device: usize,
    pub(crate) inlet: Inlet,
    /// From 1.
    pub(crate) number: u8,
    pub(crate) value: Value,
}

/// What became of commands given while the rig runs.
pub(crate) struct Done {
    /// What was wrong, with places in their text.
    pub(crate) found: Vec<Diagnostic>,
    /// Those that were not refused, as they were written, or canonically where some were.
    pub(crate) accepted: String,
    /// What continues if the same is done again at once.
    pub(crate) gesture: Option<String>,
}

impl Wiring {
    /// Loads the show's networks, with the puppet's joints and the devices they may speak of. What could not be read
    /// or done is told in words, with its place; the rest runs.
    pub(crate) fn load(show: &Show, joints: &[String], devices: &mut [Instance]) -> (Self, Vec<String>) {
        let (machine, links) = machine_for(show);
        let mut remarks = Vec::new();
        let mut wiring = Self {
            machine,
            links,
            joints: Vec::new(),
            device_inlets: BTreeMap::new(),
            device_messages: Vec::new(),
            frame: 0,
            secs: 0.0,
            firings_left: FIRINGS_PER_STEP,
            picture: (0, Arc::default()),
        };
        wiring.declare_joints(joints);
        for (at, device) in devices.iter_mut().enumerate() {
            remarks.extend(wiring.declare_device(at, device).err());
        }
        for file in &show.networks {
            let called = format!("{}.ps300", file.name);
            let found = wiring.machine.load_named(&called, &file.text);
            remarks.extend(found.iter().map(|d| format!("{called}:{d}")));
        }
        let found = wiring.machine.load_named("patches", &show.patches);
        remarks.extend(found.iter().map(|d| format!("patches:{d}")));
        (wiring, remarks)
    }

    /// Goes on from how a network stood at a time, in seconds and frames, on another machine that has what `show`, the
    /// puppet's joints and the devices can be asked for.
    pub(crate) fn resume(
        show: &Show,
        joints: &[String],
        devices: &mut [Instance],
        network: &str,
        (secs, frame): (f64, u64),
    ) -> Self {
        let bare = Show {
            networks: Vec::new(),
            patches: Arc::from(""),
            ..show.clone()
        };
        let (mut wiring, _) = Self::load(&bare, joints, devices);
        // Clocks begin where the network's time is.
        wiring.machine.tick(secs, frame, FIRINGS_PER_STEP);
        wiring.machine.load(network);
        wiring.machine.drain_sinks(|_, _, _, _| {});
        (wiring.secs, wiring.frame) = (secs, frame);
        wiring
    }

    fn declare_joints(&mut self, joints: &[String]) {
        let kinds: Vec<Kinds> = JOINT.iter().map(|(kinds, _)| *kinds).collect();
        for joint in joints {
            // Robot files may name joints in ways the language cannot spell; they have no inlet then.
            if let Err(error) = self.machine.declare_sink(&format!("PUPPET.{joint}"), &kinds) {
                tracing::debug!("{error}");
            }
        }
        self.joints = joints.to_vec();
    }

    /// Gives a device its senders and inlets; at any time. Says what name is in the way, if one is.
    pub(crate) fn declare_device(&mut self, at: usize, device: &mut Instance) -> Result<(), String> {
        let refused = |error: ps300::machine::DeclareError| {
            format!(
                "{} cannot be connected: {error}; rename what the network calls so, or the device",
                device.device
            )
        };
        let kinds = device.kinds();
        let mut sources = Vec::new();
        for page in 1..=PAGES {
            let name = inlets::instance(&device.name, page);
            sources.push(self.machine.declare_source(&name, &kinds).map_err(refused)?);
        }
        for (name, inlet, kinds) in inlets::all(&device.name, device.inlet_count()) {
            let sink = self.machine.declare_sink(&name, &kinds).map_err(refused)?;
            self.device_inlets.insert(sink, (at, inlet));
        }
        device.sources = sources;
        Ok(())
    }

    /// Does what a program says of a device that came after it was loaded: its wires, and what is sent to it.
    pub(crate) fn connect_late(&mut self, program: &str, device: &Instance) {
        let mut names: BTreeSet<Name> = (1..=PAGES)
            .map(|page| Name::new(&inlets::instance(&device.name, page)))
            .collect();
        let inlets = inlets::all(&device.name, device.inlet_count());
        names.extend(inlets.iter().map(|(name, ..)| Name::new(name)));
        for located in language::parse(program).0 {
            let speaks_of_it = match &located.what {
                Command::Connect { from, to } | Command::Disconnect(Disconnection::Pair { from, to }) => {
                    names.contains(&from.name) || names.contains(&to.name)
                }
                Command::Disconnect(Disconnection::Output(from)) => names.contains(&from.name),
                Command::Disconnect(Disconnection::All(name)) => names.contains(name),
                Command::Send { to, .. } => names.contains(&to.name),
                _ => false,
            };
            if speaks_of_it {
                // What it cannot do now it could not have done then; a program says so when it is loaded.
                let _ = self.machine.execute(&located.what);
            }
        }
    }

    /// Whether a name is that of an inlet of a device.
    pub(crate) fn device_inlet(&self, name: &Name) -> Option<(usize, Inlet)> {
        let mut all = self.device_inlets.iter();
        all.find(|(sink, _)| self.machine.sink_name(**sink) == Some(name))
            .map(|(_, at)| *at)
    }

    /// What arrived at inlets of devices, in order; goes into an empty `messages`, whose memory is used on.
    pub(crate) fn device_messages(&mut self, messages: &mut Vec<DeviceMessage>) {
        std::mem::swap(&mut self.device_messages, messages);
    }

    /// Executes commands given while the rig runs.
    pub(crate) fn execute(&mut self, text: &str) -> Done {
        let found = self.machine.load(text);
        let (commands, _) = language::parse(text);
        let refused = |at: Position| {
            let errors = found.iter().filter(|it| it.severity == Severity::Error);
            errors
                .into_iter()
                .any(|it| (it.line, it.column) == (at.line, at.column))
        };
        let accepted: Vec<&Command> = commands
            .iter()
            .filter(|command| !refused(command.at))
            .map(|command| &command.what)
            .collect();
        let gesture = match accepted.as_slice() {
            // A value that is dragged sends again and again to one place.
            [Command::Send { to, .. }] => Some(format!("send {:?} {}", to.input, to.name)),
            _ => None,
        };
        let accepted = if found.is_empty() && !accepted.is_empty() {
            text.to_owned()
        } else {
            let lines: Vec<String> = accepted.into_iter().map(language::print).collect();
            lines.join("\n")
        };
        Done {
            found,
            accepted,
            gesture,
        }
    }

    /// Makes the change from one program to another; with new errors none.
    pub(crate) fn edit_program(&mut self, from: &str, to: &str) -> Vec<Diagnostic> {
        self.machine.edit_program(from, to)
    }

    /// Takes a change back, or makes it again; both are texts with state.
    pub(crate) fn restore(&mut self, from: &str, to: &str) {
        self.machine.restore(from, to);
    }

    /// The network as it runs, and the frames it has counted.
    pub(crate) fn standing(&self) -> (String, u64) {
        (self.text_with_state(), self.frame)
    }

    /// Withholds what an output would send, or lets it send again.
    pub(crate) fn freeze(&mut self, name: &str, output: u8, on: bool) -> Result<(), String> {
        if self.machine.freeze(name, output, on) {
            Ok(())
        } else {
            Err(format!("there is no output {name}<{output}> to freeze"))
        }
    }

    pub(crate) fn machine(&self) -> &Machine {
        &self.machine
    }

    /// A message from a device instance; what it sets off is over before the next one is let in.
    pub(crate) fn hear(&mut self, instance: &str, output: u8, value: Value) {
        self.machine.emit(instance, output, value);
        self.firings_left -= self.machine.go_on(self.firings_left).firings();
    }

    /// The same from a device's sender.
    pub(crate) fn hear_from(&mut self, outlet: Outlet, value: Value) {
        self.machine.emit_from(outlet, value);
        self.firings_left -= self.machine.go_on(self.firings_left).firings();
    }

    /// Moves network time on to that of a message, never beyond the step it belongs to.
    pub(crate) fn pass_to(&mut self, secs: f64) {
        self.firings_left -= self.machine.pass_to(secs, self.firings_left).firings();
    }

    /// Says how the rig's picture shows the world, so that what lies in it can be picked.
    pub(crate) fn see_from(&mut self, view: &crate::snapshot::ViewState) {
        self.machine.set_camera(view.tablet_from_world());
    }

    /// Moves network time and lets clocks send. Returns what went wrong, in words.
    pub(crate) fn tick(&mut self, secs: f64) -> Vec<String> {
        self.secs = secs;
        self.frame += 1;
        self.machine.tick(secs, self.frame, FIRINGS_PER_STEP);
        self.firings_left = FIRINGS_PER_STEP;
        self.machine.reports().iter().map(ToString::to_string).collect()
    }

    /// Appends what arrived at the rig's parameters, in order.
    pub(crate) fn requests(&mut self, requests: &mut Vec<Request>) {
        let Self {
            links,
            joints,
            device_inlets,
            device_messages,
            ..
        } = self;
        self.machine.drain_sinks(|sink, name, port, value| {
            if let Some(&(device, inlet)) = device_inlets.get(&sink) {
                device_messages.push(DeviceMessage {
                    device,
                    inlet,
                    number: port,
                    value,
                });
                return;
            }
            if let Some(joint) = crate::controls::drive::joint(name) {
                let known = joints.iter().find(|it| it.eq_ignore_ascii_case(joint));
                requests.extend(known.and_then(|it| parameters::joint_request(it, port, &value)));
                return;
            }
            let request = match links.iter().position(|link| link.eq_ignore_ascii_case(name)) {
                Some(link) => parameters::link_request(link as u16, port, &value),
                None => parameters::request(name, port, &value),
            };
            requests.extend(request);
        });
    }

    pub(crate) fn panel(&self) -> &Panel {
        self.machine.panel()
    }

    /// What the network's own structures display; drawn again only when they changed.
    pub(crate) fn picture(&mut self) -> Arc<DisplayList> {
        let revision = self.machine.picture_revision();
        if self.picture.0 != revision {
            self.picture = (revision, Arc::new(self.machine.display()));
        }
        Arc::clone(&self.picture.1)
    }

    /// The network and all that was done to it since, as text that loads to the same behaviour.
    pub(crate) fn text(&self) -> String {
        self.machine.network_text()
    }

    /// The same with what messages have done.
    pub(crate) fn text_with_state(&self) -> String {
        self.machine.network_text_with_state()
    }
}

/// What each link looks like, in link axes: the shape file's structure of the link's name, or a plain line.
/// Remarks say what of the files could not be read.
pub(crate) fn shapes(doc: &FigureDoc) -> (Vec<Vec<Stroke>>, Vec<String>) {
    let mut machine = Machine::new();
    let mut remarks = Vec::new();
    for (ending, text) in [("pri", &doc.primitives), ("shp", &doc.shapes)] {
        remarks.extend(
            machine
                .load(text)
                .iter()
                .map(|d| format!("{}.{ending}:{d}", doc.name)),
        );
    }
    let figure: &Figure = &doc.figure;
    let shapes = figure
        .links()
        .iter()
        .map(|link| {
            let drawn = machine.display_of(&link.name, DMat4::IDENTITY).strokes;
            if drawn.is_empty() {
                vec![bone(link.length)]
            } else {
                drawn
            }
        })
        .collect();
    (shapes, remarks)
}

/// A line along the link: the shape of a link without one.
fn bone(length: f64) -> Stroke {
    Stroke {
        from: glam::DVec3::ZERO,
        to: glam::DVec3::Z * length,
        hue_deg: 0.0,
        saturation: 0.0,
        intensity: [1.0; 2],
        view: 0,
    }
}
