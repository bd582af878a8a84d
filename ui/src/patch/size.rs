//! How large a box is and where its ports are, from its names and its number of ports alone: the layout and the
//! painter agree because both ask here.

use glam::Vec2;

/// Height of the line with name and type, points at zoom 1.
pub const HEAD: f32 = 26.0;
/// Height of a port's row.
pub const ROW: f32 = 18.0;
/// Below the last row, and above the first.
pub const PAD: f32 = 4.0;
/// Advance of one character of the names, which are set in digits' type at the body size.
const NAME_CHARACTER: f32 = 7.9;
/// The same of the type and of values, at the small size.
pub const SMALL_CHARACTER: f32 = 6.7;
/// The narrowest and the widest box.
const WIDTHS: [f32; 2] = [160.0, 296.0];

/// Width and height of a box.
pub fn of(name: &str, what: &str, inputs: usize, outputs: usize) -> Vec2 {
    let head = name.chars().count() as f32 * NAME_CHARACTER + what.chars().count() as f32 * SMALL_CHARACTER;
    let width = ((head + 44.0) / 8.0).ceil() * 8.0;
    let rows = inputs.max(outputs) as f32;
    let under = if rows > 0.0 { rows * ROW + 2.0 * PAD } else { 0.0 };
    Vec2::new(width.clamp(WIDTHS[0], WIDTHS[1]), HEAD + under)
}

/// Height of a port's middle below the top of its box; ports count from 0.
pub fn port(index: usize) -> f32 {
    HEAD + PAD + (index as f32 + 0.5) * ROW
}
