//! Ports: a disc takes and consumes, a square keeps; beside it what waits, what is held, what was sent last.

use egui::{Align2, Painter, Pos2, Rect, Stroke, pos2, vec2};

use super::boxes::{Looks, font};
use super::colour;
use super::view::View;
use crate::panels::style::{self, ink};
use crate::patch::fit::{self, Fit};
use crate::patch::look::{InputActivity, OutputActivity};
use crate::patch::scene::{Port, Scene};
use crate::patch::table::Table;
use crate::patch::token;
use crate::render::theme::{self, Rgb};

/// Half the width of a port's mark at zoom 1.
const MARK: f32 = 4.5;
/// Messages at which the bar of a queue is as long as it gets.
const BAR_FULL: f32 = 32.0;

/// Which ports a wire that is being drawn fits, by box and port.
pub(super) struct Offer {
    inputs: bool,
    fits: Vec<Vec<bool>>,
}

impl Offer {
    /// For a wire from an output.
    pub(super) fn to_inputs(scene: &Scene, from: (usize, usize)) -> Offer {
        let fits = |to: (usize, usize)| !matches!(fit::judge(scene, from, to), Fit::Refused(_));
        let row = |index: usize| {
            (0..scene.boxes[index].inputs.len())
                .map(|port| fits((index, port)))
                .collect()
        };
        Offer {
            inputs: true,
            fits: (0..scene.boxes.len()).map(row).collect(),
        }
    }

    /// For a wire to an input.
    pub(super) fn to_outputs(scene: &Scene, to: (usize, usize)) -> Offer {
        let fits = |from: (usize, usize)| !matches!(fit::judge(scene, from, to), Fit::Refused(_));
        let row = |index: usize| {
            (0..scene.boxes[index].outputs.len())
                .map(|port| fits((index, port)))
                .collect()
        };
        Offer {
            inputs: false,
            fits: (0..scene.boxes.len()).map(row).collect(),
        }
    }

    /// Whether any port of a box fits.
    pub(super) fn any(&self, node: usize) -> bool {
        self.first(node).is_some()
    }

    /// The first port of a box that fits.
    pub(super) fn first(&self, node: usize) -> Option<usize> {
        self.fits.get(node)?.iter().position(|fits| *fits)
    }

    fn fits(&self, inputs: bool, node: usize, port: usize) -> bool {
        inputs == self.inputs
            && self
                .fits
                .get(node)
                .and_then(|row| row.get(port))
                .copied()
                .unwrap_or(false)
    }
}

/// Marks only, for boxes too small for rows.
pub(super) fn marks(painter: &Painter, view: &View, table: &Table, node: usize, looks: &Looks<'_>) {
    let shown = &table.scene.boxes[node];
    let radius = view.length(MARK).max(1.5);
    for (port, input) in shown.inputs.iter().enumerate() {
        let at = view.screen(table.seating.input(&table.scene, node, port));
        let colour = offered(looks, true, node, port, colour::of_port(input.kinds));
        painter.circle_filled(at, radius, ink(colour));
    }
    for (port, output) in shown.outputs.iter().enumerate() {
        let at = view.screen(table.seating.output(&table.scene, node, port));
        let colour = offered(looks, false, node, port, colour::of_port(output.kinds));
        painter.circle_filled(at, radius, ink(colour));
    }
}

/// The colour of a mark: while a wire is drawn, only what it fits is lit.
fn offered(looks: &Looks<'_>, inputs: bool, node: usize, port: usize, colour: Rgb) -> Rgb {
    match looks.offer {
        Some(offer) if offer.fits(inputs, node, port) => colour.mix(theme::LINE, 0.25),
        Some(_) => colour.mix(theme::PANEL, 0.82),
        None => colour,
    }
}

/// A row for each port.
pub(super) fn rows(painter: &Painter, view: &View, table: &Table, node: usize, looks: &Looks<'_>) {
    let shown = &table.scene.boxes[node];
    let rect = view.rect(table.seating.areas[node]);
    let dimmed = looks.offer.is_some_and(|offer| !offer.any(node));
    // What an input says is short or may be cut at two thirds; the output beside it has the rest.
    let whole = rect.width() - view.length(28.0);
    let mut used = Vec::with_capacity(shown.inputs.len());
    for (port, input) in shown.inputs.iter().enumerate() {
        let at = view.screen(table.seating.input(&table.scene, node, port));
        let activity = input.activity.and_then(|at| looks.look.activity.inputs.get(at));
        let colour = offered(looks, true, node, port, colour::of_port(input.kinds));
        let lit = looks.offer.is_some_and(|offer| offer.fits(true, node, port));
        mark(painter, view, at, colour, input.constant, lit);
        let room = if shown.outputs.len() > port {
            whole * 0.66
        } else {
            whole
        };
        used.push(input_row(painter, view, at, room, input, activity, dimmed));
    }
    for (port, output) in shown.outputs.iter().enumerate() {
        let at = view.screen(table.seating.output(&table.scene, node, port));
        let activity = output.activity.and_then(|at| looks.look.activity.outputs.get(at));
        let colour = offered(looks, false, node, port, colour::of_port(output.kinds));
        let lit = looks.offer.is_some_and(|offer| offer.fits(false, node, port));
        mark(painter, view, at, colour, false, lit);
        let room = whole - used.get(port).copied().unwrap_or(0.0);
        output_row(painter, view, at, room, output, activity, dimmed);
    }
}

fn mark(painter: &Painter, view: &View, at: Pos2, colour: Rgb, constant: bool, lit: bool) {
    let radius = view.length(if lit { MARK * 1.3 } else { MARK });
    let ring = Stroke::new(view.length(1.5).max(1.0), ink(theme::GROUND));
    if lit {
        painter.circle_filled(at, radius * 2.1, ink(colour).gamma_multiply(0.22));
    }
    if constant {
        let square = Rect::from_center_size(at, vec2(radius, radius) * 1.75);
        painter.rect(square, 0.0, ink(colour), ring, egui::StrokeKind::Outside);
    } else {
        painter.circle(at, radius, ink(colour), ring);
    }
}

/// Returns the width it took.
fn input_row(
    painter: &Painter,
    view: &View,
    at: Pos2,
    room: f32,
    port: &Port,
    activity: Option<&InputActivity>,
    dimmed: bool,
) -> f32 {
    let small = font(view, theme::SIZE_SMALL);
    let left = at.x + view.length(12.0);
    let label = style::layout(painter, (&port.label, small.clone()), theme::FAINT, room);
    let value_at = left + label.size().x + view.length(7.0);
    let rest = (room - label.size().x - view.length(7.0)).max(0.0);
    painter.galley(pos2(left, at.y - label.size().y / 2.0), label, ink(theme::FAINT));
    let mut used = value_at - left;
    let Some(activity) = activity else {
        return used;
    };
    if let Some(value) = &activity.front {
        let colour = match (dimmed, port.constant) {
            (true, _) => theme::FAINT,
            // What stays is as firm as a name, what passes is not.
            (false, true) => theme::TEXT,
            (false, false) => theme::DIM,
        };
        let galley = style::layout(painter, (&token::short(value), small), colour, rest);
        used += galley.size().x + view.length(6.0);
        painter.galley(pos2(value_at, at.y - galley.size().y / 2.0), galley, ink(colour));
    }
    if activity.waiting > 0 && !port.constant {
        queue(painter, view, at, activity.waiting);
    }
    used
}

/// How many messages wait: a number before the port, over a bar that grows with it.
fn queue(painter: &Painter, view: &View, at: Pos2, waiting: u32) {
    let share = (waiting as f32 / BAR_FULL).min(1.0);
    let text = waiting.to_string();
    let right = at.x - view.length(MARK + 5.0);
    let galley = painter.layout_no_wrap(text, font(view, 10.0), ink(theme::GROUND));
    let width = galley.size().x + view.length(6.0) + view.length(18.0) * share;
    let plate = Rect::from_min_max(
        pos2(right - width, at.y - galley.size().y / 2.0),
        pos2(right, at.y + galley.size().y / 2.0),
    );
    painter.rect_filled(plate, style::round(), ink(theme::DIM.mix(theme::TEXT, share)));
    painter.galley(
        pos2(right - galley.size().x - view.length(3.0), plate.top()),
        galley,
        ink(theme::GROUND),
    );
}

fn output_row(
    painter: &Painter,
    view: &View,
    at: Pos2,
    room: f32,
    port: &Port,
    activity: Option<&OutputActivity>,
    dimmed: bool,
) {
    let small = font(view, theme::SIZE_SMALL);
    let right = at.x - view.length(12.0);
    let label = style::layout(painter, (&port.label, small.clone()), theme::FAINT, room);
    let value_right = right - label.size().x - view.length(7.0);
    let rest = (room - label.size().x - view.length(7.0)).max(0.0);
    painter.galley(
        pos2(right - label.size().x, at.y - label.size().y / 2.0),
        label,
        ink(theme::FAINT),
    );
    let Some(activity) = activity else {
        return;
    };
    if activity.frozen {
        pause(painter, view, at);
        let text = format!("held {}", activity.withheld);
        style::line(
            painter,
            pos2(value_right, at.y),
            Align2::RIGHT_CENTER,
            (&text, small),
            theme::TEXT,
            rest,
        );
    } else if let Some(value) = &activity.last {
        let colour = if dimmed { theme::FAINT } else { theme::DIM };
        let text = token::short(value);
        style::line(
            painter,
            pos2(value_right, at.y),
            Align2::RIGHT_CENTER,
            (&text, small),
            colour,
            rest,
        );
    }
}

/// Two bars over an output that is held back.
fn pause(painter: &Painter, view: &View, at: Pos2) {
    let (half, high) = (view.length(3.0), view.length(8.0));
    painter.circle_filled(at, view.length(8.0), ink(theme::GROUND));
    painter.circle_stroke(at, view.length(8.0), Stroke::new(1.0, ink(theme::TEXT)));
    for x in [-half, half] {
        let bar = Rect::from_center_size(at + vec2(x, 0.0), vec2(view.length(2.4), high));
        painter.rect_filled(bar, 0.0, ink(theme::TEXT));
    }
}
