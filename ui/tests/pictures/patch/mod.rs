//! The patch panel on a machine of its own: what hands on it do to the network, and what it looks like.

mod hands;
mod machine;
mod networks;
mod pictures;
mod table;

use egui::Rect;
use egui_kittest::Harness;
use ps300::language::Name;
use ui::panels::layout::Areas;

use crate::studio::{Bench, harness};
use crate::walker;
use machine::Link;

/// The studio with its patch panel open, and the network at the other end.
pub(crate) struct Room {
    pub(crate) harness: Harness<'static, Bench>,
    pub(crate) link: Link,
    /// What hands wanted of anything but the network.
    pub(crate) said: Vec<rig::Command>,
    area: Rect,
}

impl Room {
    pub(crate) fn new(link: Link, size: [f32; 2], card: bool) -> Room {
        let mut harness = harness(walker::playing(), size, card);
        harness.state_mut().studio.choices().board = ui::panels::Board::Patch;
        let window = Rect::from_min_size(egui::Pos2::ZERO, size.into());
        let mut room = Room {
            harness,
            link,
            said: Vec::new(),
            area: Areas::of(window).board(),
        };
        room.step();
        room.step();
        room
    }

    /// One picture: the network is seen, then what hands wanted is done.
    pub(crate) fn step(&mut self) {
        let (look, notes) = self.link.look();
        let bench = self.harness.state_mut();
        bench.seen.network = Some(look);
        bench.seen.notes = notes;
        self.harness.step();
        for command in std::mem::take(&mut self.harness.state_mut().said) {
            match command {
                rig::Command::Network(edit) => self.link.edit(&edit),
                other => self.said.push(other),
            }
        }
    }

    /// The dials turn and the network runs.
    pub(crate) fn turn(&mut self, dials: &[(u8, f64)]) {
        for &(dial, turns) in dials {
            self.link.emit("DIALS", dial, turns);
        }
        self.link.tick();
        self.step();
    }

    pub(crate) fn place(&mut self, name: &str) -> Rect {
        let area = self.area;
        let found = self
            .harness
            .state_mut()
            .studio
            .patch()
            .place_of(area, &Name::new(name));
        found.unwrap_or_else(|| panic!("{name} is not shown"))
    }

    pub(crate) fn output(&mut self, name: &str, port: usize) -> egui::Pos2 {
        let area = self.area;
        let found = self
            .harness
            .state_mut()
            .studio
            .patch()
            .port_of(area, &Name::new(name), true, port);
        found.unwrap_or_else(|| panic!("{name} is not shown"))
    }

    pub(crate) fn input(&mut self, name: &str, port: usize) -> egui::Pos2 {
        let area = self.area;
        let found = self
            .harness
            .state_mut()
            .studio
            .patch()
            .port_of(area, &Name::new(name), false, port);
        found.unwrap_or_else(|| panic!("{name} is not shown"))
    }

    /// Presses, moves and lets go.
    pub(crate) fn drag(&mut self, from: egui::Pos2, to: egui::Pos2) {
        self.hold(from, to);
        self.harness.drop_at(to);
        self.step();
        self.step();
    }

    /// Presses and moves; the button stays down.
    pub(crate) fn hold(&mut self, from: egui::Pos2, to: egui::Pos2) {
        self.harness.hover_at(from);
        self.step();
        self.harness.drag_at(from);
        self.step();
        for part in 1..=6 {
            self.harness.hover_at(from + (to - from) * (part as f32 / 6.0));
            self.step();
        }
    }

    pub(crate) fn click(&mut self, at: egui::Pos2) {
        self.harness.hover_at(at);
        self.step();
        self.harness.drag_at(at);
        self.harness.drop_at(at);
        self.step();
    }

    pub(crate) fn click_twice(&mut self, at: egui::Pos2) {
        // Long enough after the last click to be no third one.
        for _ in 0..30 {
            self.step();
        }
        self.click(at);
        self.click(at);
    }

    pub(crate) fn press(&mut self, modifiers: egui::Modifiers, key: egui::Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.step();
        self.step();
    }

    /// Types into whatever has the keyboard.
    pub(crate) fn write(&mut self, text: &str) {
        self.harness.event(egui::Event::Text(text.to_owned()));
        self.step();
    }

    pub(crate) fn area(&self) -> Rect {
        self.area
    }
}
