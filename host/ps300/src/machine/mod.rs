//! The machine: names, network, display tree and front panel, driven by commands and by the host.
//!
//! Everything a host does goes through [`Machine`]. Commands take effect one at a time, and the network
//! runs until it is quiet (or out of budget) before the next. Messages of the host (`emit`, `send`) make a
//! batch, which the next tick or command ends; what a batch sets off is over before the next is let in, so
//! how many firings a host allows in one tick never changes what happens, only when.

mod activity;
mod arrangement;
mod copy;
mod define;
pub mod devices;
mod difference;
mod dot;
mod error;
mod execute;
mod group;
mod load;
mod look;
mod panel;
mod patch;
pub mod picture;
mod program;
mod program_state;
mod removal;
mod rendered;
mod sources;
mod state;
mod terminal;
mod tree;
mod view;
mod wires;

pub use activity::{Activity, InputActivity, OutputActivity};
pub use error::{DeclareError, ExecuteError};
pub use panel::{LABEL_CHARACTERS, Panel};
pub use patch::Refused;
pub(crate) use sources::DECLARED;
pub use sources::SourceId;
pub use terminal::{TERMINAL_COLUMNS, TERMINAL_LINES, Terminal};
pub use view::{ConnectionView, InputView, InstanceView, OutputView};

use std::sync::Arc;

use glam::{DMat4, DVec2};

use crate::intrinsic::Now;
use crate::language::{Input, Name};
use crate::names::{NameId, Names, Thing};
use crate::network::{
    About, Arrival, Cause, Inlet, InstanceId, Limits, Network, Outlet, Ran, Refusal, Report, Role, SinkId,
    Surroundings, Watched,
};
use crate::pick::Pick;
use crate::structure::{NodeId, Structure};
use crate::value::{Kinds, Value};
use group::Open;
use panel::Readouts;

/// A PS 300 without its hardware.
pub struct Machine {
    names: Names,
    network: Network,
    structure: Structure,
    panel: Panel,
    readouts: Readouts,
    /// In the order of DISPLAY.
    displayed: Vec<NameId>,
    senders: rendered::Senders,
    /// The host's own: from the world to the screen.
    camera: DMat4,
    /// Where the tablet was when the cursor was last drawn.
    cursor: DVec2,
    /// Network time of the last tick; the network gets there when the batches before it are over.
    ticked: Now,
    /// Counts commands that may have changed what there is and how it is joined.
    topology: u64,
    open: Open,
}

impl Default for Machine {
    fn default() -> Self {
        Self::with_limits(Limits::default())
    }
}

/// The rest of the machine, as the network reaches it.
struct Around<'a> {
    names: &'a Names,
    structure: &'a mut Structure,
    panel: &'a mut Panel,
    readouts: &'a Readouts,
    displayed: &'a [NameId],
    senders: &'a rendered::Senders,
    camera: &'a DMat4,
    frame: u64,
}

impl Surroundings for Around<'_> {
    fn feed(&mut self, to: NodeId, input: Input, value: &Value) -> Result<Option<InstanceId>, Refusal> {
        self.structure.feed(to, input, value)?;
        if self.senders.is_empty() || input != Input::Number(1) {
            return Ok(None);
        }
        Ok(self.senders.get(&to).copied())
    }

    fn node(&self, to: NodeId) -> (Name, About) {
        let name = self
            .structure
            .slot(to)
            .map_or_else(|| Name::new("?"), |slot| slot.name.clone());
        let entry = self.names.find(&name).map(|id| self.names.entry(id));
        let about = About {
            what: format!("{} node", self.structure.what(to)),
            made: entry.and_then(|entry| entry.made.clone()),
            message: None,
        };
        (name, about)
    }

    fn sink_arrived(&mut self, sink: SinkId, value: &Value) {
        self.readouts.show(self.panel, sink, value);
    }

    fn inlet(&self, name: &str, input: Input) -> Option<Inlet> {
        match (self.names.named(name)?, input) {
            (Thing::Instance(to), Input::Number(number)) => Some(Inlet::Function {
                to,
                input: u8::try_from(number).ok()?,
            }),
            (Thing::Sink(to), Input::Number(number)) => Some(Inlet::Sink {
                to,
                input: u8::try_from(number).ok()?,
            }),
            (Thing::Node(to), input) => Some(Inlet::Node { to, input }),
            _ => None,
        }
    }

    fn picks(&self, window: [DVec2; 2], detailed: bool) -> Arc<[Pick]> {
        self.look(window, detailed)
    }

    fn transform(&self, name: &str, part: [usize; 2]) -> Result<Value, &'static str> {
        self.marked(name, part)
    }

    fn device(&self, name: &str) -> Option<InstanceId> {
        self.variable(name)
    }

    fn variable(&self, name: &str) -> Option<InstanceId> {
        match self.names.named(name)? {
            Thing::Instance(id) => Some(id),
            _ => None,
        }
    }
}

macro_rules! with_network {
    ($machine:ident, |$network:ident, $around:ident| $do:expr) => {{
        let $around = &mut crate::machine::Around {
            names: &$machine.names,
            structure: &mut $machine.structure,
            panel: &mut $machine.panel,
            readouts: &$machine.readouts,
            displayed: &$machine.displayed,
            senders: &$machine.senders,
            camera: &$machine.camera,
            frame: $machine.network.now.frame,
        };
        let $network = &mut $machine.network;
        $do
    }};
}
use with_network;

impl Machine {
    /// A machine with its devices and nothing else.
    pub fn new() -> Self {
        Self::default()
    }

    /// The same with other bounds.
    pub fn with_limits(limits: Limits) -> Self {
        let mut names = Names::default();
        let mut network = Network::new(limits);
        let readouts = Readouts::install(&mut network, &mut names);
        for source in &devices::SOURCES {
            let name = Name::new(source.name);
            if let Some(id) = network.add(name.clone(), source, None, Role::Device) {
                names.fix(&name, Thing::Instance(id));
            }
        }
        let structure = Structure::default();
        Self {
            names,
            network,
            structure,
            panel: Panel::default(),
            readouts,
            displayed: Vec::new(),
            senders: rendered::Senders::new(),
            camera: DMat4::IDENTITY,
            cursor: DVec2::ZERO,
            ticked: Now::default(),
            topology: 0,
            open: Open::default(),
        }
    }

    /// An output of a device or function, for [`Machine::emit_from`]. Ask again after commands that may
    /// have deleted or redefined `name`; devices stay.
    pub fn outlet(&self, name: &str, output: u8) -> Option<Outlet> {
        // Devices were made first, in this order, and are what hosts ask for.
        if let Some(at) = devices::SOURCES.iter().position(|source| source.name == name) {
            return self.network.outlet(InstanceId(at as u32), output);
        }
        let sender = self.sender(self.names.named(name)?)?;
        self.network.outlet(sender, output)
    }

    /// How many inputs an output feeds. A host need not compute what nobody listens to.
    pub fn listeners(&self, from: Outlet) -> usize {
        self.network.destinations(from).len()
    }

    /// Sends on an output as if the device had: `emit("DIALS", 3, 0.25)`. The next tick or command lets it
    /// act. False if there is no such output.
    pub fn emit(&mut self, name: &str, output: u8, value: impl Into<Value>) -> bool {
        match self.outlet(name, output) {
            Some(from) => {
                self.emit_from(from, value);
                true
            }
            None => false,
        }
    }

    /// The same without looking up a name.
    pub fn emit_from(&mut self, from: Outlet, value: impl Into<Value>) {
        self.arrive(Arrival::Output(from), value.into());
    }

    /// Sends to an input, as the command SEND would, without running the network.
    pub fn send(&mut self, name: &str, input: Input, value: impl Into<Value>) -> Result<(), ExecuteError> {
        let value = value.into();
        let inlet = self.inlet_for(&Name::new(name), input, &value)?;
        self.arrive(Arrival::Input(inlet), value);
        Ok(())
    }

    fn arrive(&mut self, to: Arrival, value: Value) {
        with_network!(self, |network, around| network.arrive(to, value, around));
    }

    /// Ends the batch of messages sent since the last tick, moves network time, lets the clocks send, and fires
    /// at most `firings_max` instances. What is left goes on, in the same order, at the next tick: the sequence
    /// of all firings is the same however they are portioned. Time that runs backwards, or is not finite, stands still.
    pub fn tick(&mut self, secs: f64, frame: u64, firings_max: u32) -> Ran {
        let before = self.ticked;
        self.ticked = Now {
            secs: if secs.is_finite() {
                secs.max(before.secs)
            } else {
                before.secs
            },
            frame: frame.max(before.frame),
            ticks: before.ticks + 1,
        };
        let now = self.ticked;
        let ran = with_network!(self, |network, around| {
            network.close_batch(Some(now));
            network.run(firings_max, around)
        });
        self.structure.pass_frames(before.frame, now.frame);
        self.follow_tablet();
        ran
    }

    /// The same without moving time: what a host does between two messages that must not meet on the way.
    pub fn go_on(&mut self, firings_max: u32) -> Ran {
        let ran = with_network!(self, |network, around| {
            network.close_batch(None);
            network.run(firings_max, around)
        });
        self.follow_tablet();
        ran
    }

    /// Ends the batch and runs until everything sent so far is over, each batch with its own share of firings
    /// ([`Limits::firings_per_batch`]), without moving time.
    pub fn settle(&mut self) -> Ran {
        with_network!(self, |network, around| network.catch_up(around))
    }

    /// Declares a host parameter with inputs <1>, <2>…, so that networks can be connected to it.
    /// Declare before loading what connects to it.
    pub fn declare_sink(&mut self, name: &str, inputs: &[Kinds]) -> Result<SinkId, DeclareError> {
        let name = Name::new(name);
        if !Name::is_valid(name.as_str()) {
            return Err(DeclareError::NotAName { name });
        }
        if inputs.is_empty() || inputs.len() > 127 {
            return Err(DeclareError::Inputs {
                name,
                count: inputs.len(),
            });
        }
        if self.names.thing(&name).is_some() {
            return Err(DeclareError::Taken { name });
        }
        let id = self.network.add_sink(name.clone(), inputs);
        self.names.fix(&name, Thing::Sink(id));
        self.topology += 1;
        Ok(id)
    }

    /// Hands over every message that reached a sink, in the order of arrival: sink, its name, the input
    /// from 1, the value.
    pub fn drain_sinks(&mut self, take: impl FnMut(SinkId, &str, u8, Value)) {
        self.network.drain_sinks(take);
    }

    /// The last message at an input of a sink, drained or not.
    pub fn sink_last(&self, sink: SinkId, input: u8) -> Option<&Value> {
        self.network.sink_last(sink, input)
    }

    /// The name a sink was declared with.
    pub fn sink_name(&self, sink: SinkId) -> Option<&Name> {
        self.network.sink(sink).map(|sink| &sink.name)
    }

    /// Labels, lamps and message line.
    pub fn panel(&self) -> &Panel {
        &self.panel
    }

    /// Counts changes of the display tree: a picture drawn at the same number is still right. Between BEGIN and
    /// END it stands still.
    pub fn picture_revision(&self) -> u64 {
        self.open.revision(self.structure.revision)
    }

    /// Counts changes of what there is and how it is joined: a [`picture::Picture`] made at the same number is
    /// still right.
    pub fn topology_revision(&self) -> u64 {
        self.topology
    }

    /// Whether commands, the host or the machine itself have given `name` a meaning.
    pub fn is_defined(&self, name: &str) -> bool {
        self.names.named(name).is_some()
    }

    /// Whether something defined is called nearly so: whether the name may be misspelt.
    pub fn is_nearly_defined(&self, name: &Name) -> bool {
        !self.names.alike(name).is_empty()
    }

    /// Records every message of an output from now on. False if there is no such output.
    pub fn watch(&mut self, name: &str, output: u8) -> bool {
        self.set_watched(name, output, true)
    }

    /// Stops recording.
    pub fn unwatch(&mut self, name: &str, output: u8) -> bool {
        self.set_watched(name, output, false)
    }

    fn set_watched(&mut self, name: &str, output: u8, on: bool) -> bool {
        let from = self.outlet_made(name, output);
        if let Some(from) = from {
            self.network.watch(from, on);
        }
        from.is_some()
    }

    /// Withholds what an output would send, and counts it, until it is thawed; the rest of the network goes
    /// on. False if there is no such output.
    pub fn freeze(&mut self, name: &str, output: u8, on: bool) -> bool {
        let from = self.outlet_made(name, output);
        if let Some(from) = from {
            self.network.freeze(from, on);
        }
        from.is_some()
    }

    /// The watched messages since the last call, in the order they were sent.
    pub fn drain_watched(&mut self) -> impl Iterator<Item = Watched> + '_ {
        self.network.drain_watched()
    }

    /// What went wrong since the last call.
    pub fn reports(&mut self) -> Vec<Report> {
        self.network.reports.drain()
    }

    /// Network time at the last tick.
    pub fn secs(&self) -> f64 {
        self.ticked.secs
    }

    fn note(&mut self, name: &Name, what: &str, cause: Cause) {
        let entry = self.names.find(name).map(|id| self.names.entry(id));
        let about = || About {
            made: entry.and_then(|entry| entry.made.clone()),
            ..About::new(what)
        };
        self.network.reports.note(name, about, cause);
    }

    /// The value a variable or constant holds at its first input.
    pub fn held(&self, name: &str) -> Option<&Value> {
        match self.names.named(name)? {
            Thing::Instance(id) => self.network.held(id),
            _ => None,
        }
    }
}

/// Shown wherever a text needs to say which inputs there are.
fn numbered_inputs(count: usize) -> String {
    match count {
        0 => "none".to_owned(),
        1 => "<1>".to_owned(),
        _ => format!("<1> to <{count}>"),
    }
}

/// Text as a message.
impl From<Arc<str>> for Value {
    fn from(text: Arc<str>) -> Self {
        Self::String(text)
    }
}
