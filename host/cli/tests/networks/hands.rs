//! Hands on a machine: keys, dials and a pen as the rig reports them, and a number generator to move them by.

use glam::DVec2;
use ps300::Machine;
use ps300::value::Kinds;
use rig::parameters::{LINK, PARAMETERS};

use crate::session::root;

/// A shipped network with hands on it.
pub(crate) struct Hands {
    pub(crate) machine: Machine,
    frame: u64,
    is_down: bool,
    is_near: bool,
}

impl Hands {
    /// Loads files of `networks`, which must be in order, where they find what the rig can be asked for.
    pub(crate) fn on(names: &[&str]) -> Self {
        let mut machine = asked();
        for name in names {
            let path = root().join("networks").join(name);
            let text = std::fs::read_to_string(path).expect("readable");
            assert_eq!(machine.load(&text), [], "{name}");
        }
        Self {
            machine,
            frame: 0,
            is_down: false,
            is_near: false,
        }
    }

    /// The same hands on another machine, loaded from a text.
    pub(crate) fn moved_to(&self, text: &str) -> Self {
        let mut machine = asked();
        machine.tick(self.machine.secs(), self.frame, 0);
        assert_eq!(machine.load(text), []);
        Self { machine, ..*self }
    }

    pub(crate) fn press(&mut self, key: i32) {
        self.emit("FKEYS", 1, key);
    }

    pub(crate) fn turn(&mut self, dial: u8, turns: f64) {
        self.emit("DIALS", dial, turns);
    }

    /// The pen at a place, on the paper or above it.
    pub(crate) fn pen(&mut self, at: DVec2, down: bool) {
        if !std::mem::replace(&mut self.is_near, true) {
            self.emit("TABLETIN", 5, true);
        }
        self.emit("TABLETIN", 1, at);
        if std::mem::replace(&mut self.is_down, down) != down {
            self.emit("TABLETIN", 2, down);
            self.emit("TABLETIN", 3, i32::from(down));
            if down {
                self.emit("TABLETIN", 6, at);
            }
        }
    }

    /// The pen taken away.
    pub(crate) fn away(&mut self) {
        self.is_near = false;
        self.emit("TABLETIN", 5, false);
    }

    /// A message from a device, and a frame of time for the network.
    pub(crate) fn emit(&mut self, device: &str, output: u8, value: impl Into<ps300::Value>) {
        assert!(self.machine.emit(device, output, value), "{device}<{output}>");
        self.rest();
    }

    /// A fiftieth of a second in which nothing is done.
    pub(crate) fn rest(&mut self) {
        self.frame += 1;
        self.machine.tick(self.frame as f64 / 50.0, self.frame, 10_000);
    }
}

/// A machine that has what the rig can be asked for, with two links of a figure.
fn asked() -> Machine {
    let mut machine = Machine::new();
    let declared = PARAMETERS.iter().map(|parameter| {
        let kinds: Vec<Kinds> = parameter.inlets.iter().map(|inlet| inlet.kinds).collect();
        (parameter.name, kinds)
    });
    let links =
        ["FIGURE.rua", "FIGURE.rfa"].map(|link| (link, LINK.iter().map(|(kinds, _)| *kinds).collect()));
    for (name, kinds) in declared.chain(links) {
        machine.declare_sink(name, &kinds).expect("a name of its own");
    }
    machine
}

/// Numbers that look like chance and are the same in every run.
pub(crate) struct Draws(pub(crate) u64);

impl Draws {
    /// From 0 to below `end`.
    pub(crate) fn below(&mut self, end: u64) -> u64 {
        // Knuth's linear congruence; its upper bits are the better ones.
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % end
    }

    /// From −1 to 1, a multiple of 1/64.
    pub(crate) fn unit(&mut self) -> f64 {
        self.below(129) as f64 / 64.0 - 1.0
    }
}
