//! The window's panels: each reads the snapshot, draws, and pushes commands.
//!
//! [`layout`] says where each panel is, [`style`] how things look, [`shortcuts`] what keys mean; then one
//! file a panel. What a panel keeps for itself is what a restart may lose.

pub mod button;
pub mod canvas;
pub mod choices;
pub mod controls;
pub mod desk;
pub mod devices;
pub mod dial;
pub mod header;
pub mod help;
pub mod hold;
pub mod joint_words;
pub mod joints;
pub mod keyboard;
pub mod keys;
pub mod kinetics;
pub mod layout;
pub mod patch;
pub mod puppet;
pub mod puppet_state;
pub mod shortcuts;
pub mod strain;
pub mod style;
pub mod transport;
pub mod transport_buttons;
pub mod view;
pub mod vitals;

pub use choices::{Board, Choices};

/// Where panels put what a hand wants done; and what the window itself remembers.
pub struct Commands<'a> {
    queue: &'a mut Vec<rig::Command>,
    /// The window's own choices, shared by its panels.
    pub choices: &'a mut Choices,
}

impl<'a> Commands<'a> {
    /// Commands go to the end of `queue`.
    pub fn new(queue: &'a mut Vec<rig::Command>, choices: &'a mut Choices) -> Commands<'a> {
        Commands { queue, choices }
    }

    /// Asks for something.
    pub fn push(&mut self, command: rig::Command) {
        self.queue.push(command);
    }
}

/// One panel. Reads the snapshot, draws, pushes commands.
pub trait Panel {
    /// What it is called, in capitals above it.
    fn title(&self) -> &'static str;
    /// Draws into all of `ui`'s rectangle.
    fn ui(&mut self, ui: &mut egui::Ui, seen: &rig::Snapshot, commands: &mut Commands<'_>);
}
