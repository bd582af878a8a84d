//! The plate under everything that opens over the table.

use egui::{Frame, Margin, Shadow};

use crate::panels::style::{self, ink};
use crate::render::theme;

/// A raised plate.
pub(super) fn frame() -> Frame {
    Frame {
        inner_margin: Margin::same(8),
        fill: ink(theme::RAISED),
        stroke: style::hair(theme::FAINT),
        corner_radius: style::round(),
        shadow: Shadow {
            offset: [0, 6],
            blur: 18,
            spread: 0,
            color: egui::Color32::from_black_alpha(140),
        },
        ..Frame::default()
    }
}
