//! A dial that is turned round: how far that is by what holds, and how many counts it was.

use std::f32::consts::TAU;

use egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2};
use rig::controls_calibration::Measured;

use super::super::super::style::{self, ink};
use crate::render::theme;

/// Width of the way that was gone, points.
const WAY: f32 = 8.0;
/// Points of a whole turn of it.
const SAMPLES: f32 = 120.0;

/// Paints it.
pub(super) fn paint(painter: &Painter, area: Rect, measured: &Measured) {
    let Measured::Turn {
        counts,
        turns,
        holds,
        proposed,
    } = measured
    else {
        return;
    };
    let radius = (area.height().min(area.width() * 0.6) / 2.0 - theme::MARGIN).max(20.0);
    let centre = area.center();
    painter.circle(
        centre,
        radius,
        ink(theme::RAISED),
        Stroke::new(1.0, ink(theme::FAINT)),
    );
    ticks(painter, centre, radius);
    // Measured, the counts are as many turns as the hand made; before that, what they would be by what holds.
    let per_turn = proposed.unwrap_or(*holds);
    let gone = if per_turn == 0.0 {
        0.0
    } else {
        *counts as f64 / per_turn
    };
    let colour = if proposed.is_some() {
        theme::SELECTED
    } else {
        theme::LIVE
    };
    way(painter, (centre, radius - WAY), gone as f32, colour);
    hand(painter, (centre, radius), gone as f32);
    let lines = [
        (counts.to_string(), theme::SIZE_READOUT * 1.5, colour),
        ("counts".to_owned(), theme::SIZE_BODY, theme::DIM),
        (of_turns(gone, *turns), theme::SIZE_BODY, theme::DIM),
    ];
    let mut y = centre.y - theme::SIZE_READOUT;
    for (said, size, colour) in lines {
        let text = (said.as_str(), style::digits(size));
        style::line(
            painter,
            pos2(centre.x, y),
            Align2::CENTER_CENTER,
            text,
            colour,
            radius * 1.4,
        );
        y += size + theme::STEP;
    }
}

fn of_turns(gone: f64, turns: u32) -> String {
    let word = if turns == 1 { "turn" } else { "turns" };
    format!("{gone:+.2} of {turns} {word}")
}

fn ticks(painter: &Painter, centre: Pos2, radius: f32) {
    for tick in 0..24_u8 {
        let out = Vec2::angled(TAU * (f32::from(tick) / 24.0 - 0.25));
        let inner = if tick % 6 == 0 { 10.0 } else { 5.0 };
        let line = [
            centre + out * (radius + 3.0),
            centre + out * (radius + 3.0 + inner),
        ];
        let colour = if tick == 0 { theme::TEXT } else { theme::FAINT };
        painter.line_segment(line, Stroke::new(if tick == 0 { 2.5 } else { 1.0 }, ink(colour)));
    }
}

/// The way that was gone from the mark at twelve; each further turn is drawn inside the one before.
fn way(painter: &Painter, (centre, radius): (Pos2, f32), turns: f32, colour: theme::Rgb) {
    let (mut left, sense) = (turns.abs().min(20.0), turns.signum());
    let mut radius = radius;
    while left > 0.0 && radius > 4.0 * WAY {
        let part = left.min(1.0);
        let count = (part * SAMPLES).ceil().max(1.0);
        let points: Vec<Pos2> = (0..=count as u32)
            .map(|step| {
                let share = step as f32 / count * part * sense;
                centre + Vec2::angled(TAU * (share - 0.25)) * radius
            })
            .collect();
        painter.add(Shape::line(points, Stroke::new(WAY, ink(colour))));
        left -= part;
        radius -= WAY + 3.0;
    }
}

fn hand(painter: &Painter, (centre, radius): (Pos2, f32), turns: f32) {
    let out = Vec2::angled(TAU * (turns - 0.25));
    let line = [centre + out * (radius * 0.62), centre + out * (radius - 2.0)];
    painter.line_segment(line, Stroke::new(3.0, ink(theme::TEXT)));
}
