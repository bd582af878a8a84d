//! What the window remembers for itself: nothing that belongs to the show, nothing a restart may not lose.

use crate::render::stage::Look;

/// The window's own state.
#[derive(Clone, Debug, Default)]
pub struct Choices {
    /// What the views show beside the figure.
    pub look: Look,
    /// The dial the keyboard turns, 0…7.
    pub dial: Option<usize>,
    /// The kinetic coefficient the keyboard moves.
    pub coefficient: Option<usize>,
    /// Whether the page of keyboard shortcuts is shown.
    pub help: bool,
    /// What is shown where the figure and its time are.
    pub board: Board,
    /// The device whose controls are shown, by its name.
    pub device: Option<String>,
}

/// What is shown in the largest part of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Board {
    /// The figure and its time.
    #[default]
    Figure,
    /// The function network.
    Patch,
    /// Input devices with all their controls.
    Controls,
}

impl Board {
    /// Shows this, or the figure again if it is shown.
    pub fn toggle(&mut self, board: Board) {
        *self = if *self == board { Board::Figure } else { board };
    }
}
