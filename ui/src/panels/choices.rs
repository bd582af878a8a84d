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
    /// Whether the patch panel is shown instead of the figure.
    pub patch: bool,
}
