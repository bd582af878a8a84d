//! The steps of a calibration: where it is, what the hand is to do, what was wrong, and the three answers.

use egui::{Align2, Painter, Rect, Stroke, Ui, pos2, vec2};
use rig::{CalibrateControl, CalibrationView, Command};

use super::super::super::Commands;
use super::super::super::button::{Button, Tone};
use super::super::super::style::{self, ink};
use crate::render::theme;

/// Width of a button, points.
const WIDTH: f32 = 76.0;
/// Between two steps' marks, points.
const APART: f32 = 34.0;
/// Radius of a step's mark, points.
const RADIUS: f32 = 10.0;

/// Shows steps, instruction and answers.
pub(super) fn show(ui: &mut Ui, area: Rect, view: &CalibrationView, commands: &mut Commands<'_>) {
    let painter = ui.painter();
    let y = area.top() + theme::ROW / 2.0;
    marks(painter, pos2(area.left() + RADIUS, y), view);
    let left = area.left() + 2.0 * RADIUS + APART * f32::from(view.steps.saturating_sub(1)) + theme::MARGIN;
    let right = area.right() - 3.0 * (WIDTH + theme::STEP);
    let text = (view.what.as_str(), style::words(theme::SIZE_TITLE));
    style::line(
        painter,
        pos2(left, y),
        Align2::LEFT_CENTER,
        text,
        theme::TEXT,
        right - left - theme::GAP,
    );
    let y = area.top() + theme::ROW + theme::MARGIN + theme::GAP;
    let colour = if view.result.is_some() {
        theme::TEXT
    } else {
        theme::SELECTED
    };
    let text = (view.instruction.as_str(), style::words(theme::SIZE_TITLE));
    style::line(
        painter,
        pos2(area.left(), y),
        Align2::LEFT_CENTER,
        text,
        colour,
        area.width(),
    );
    let y = y + theme::SIZE_TITLE + theme::GAP;
    let (said, colour) = match &view.fault {
        Some(fault) => (fault.as_str(), theme::FAULTED),
        None => (view.seen.as_str(), theme::DIM),
    };
    let text = (said, style::words(theme::SIZE_BODY));
    style::line(
        painter,
        pos2(area.left(), y),
        Align2::LEFT_CENTER,
        text,
        colour,
        area.width(),
    );
    answers(ui, area, view, commands);
}

/// A circle for each step: done ones filled, the present one in the accent of what comes next.
fn marks(painter: &Painter, first: egui::Pos2, view: &CalibrationView) {
    for step in 1..=view.steps {
        let at = first + vec2(f32::from(step - 1) * APART, 0.0);
        if step > 1 {
            let from = at.x - APART + RADIUS;
            painter.hline(from..=at.x - RADIUS, at.y, style::hair(theme::FAINT));
        }
        let (fill, edge, digit) = match step.cmp(&view.step) {
            std::cmp::Ordering::Less => (theme::FAINT, theme::FAINT, theme::GROUND),
            std::cmp::Ordering::Equal => (theme::SELECTED, theme::SELECTED, theme::GROUND),
            std::cmp::Ordering::Greater => (theme::PANEL, theme::FAINT, theme::DIM),
        };
        painter.circle(at, RADIUS, ink(fill), Stroke::new(1.0, ink(edge)));
        let number = step.to_string();
        let text = (number.as_str(), style::digits(theme::SIZE_SMALL));
        style::line(painter, at, Align2::CENTER_CENTER, text, digit, 2.0 * RADIUS);
    }
}

fn answers(ui: &mut Ui, area: Rect, view: &CalibrationView, commands: &mut Commands<'_>) {
    let mut right = area.right();
    let mut next = || {
        let rect = Rect::from_min_size(pos2(right - WIDTH, area.top()), vec2(WIDTH, theme::ROW));
        right -= WIDTH + theme::STEP;
        rect
    };
    let mut ask = |command| commands.push(Command::CalibrateControl(command));
    let tip = "Leaves everything as it was before.";
    let cancel = Button::new("Cancel", tip, "").named("cancel the calibration");
    if cancel.show(ui, next()).clicked() {
        ask(CalibrateControl::Cancel);
    }
    let done = view.result.is_some();
    let tip = "From now on, and whenever this device is plugged in. No parameter moves: the control is picked up again.";
    let tone = if done { Tone::Loud } else { Tone::Plain };
    let keep = Button::new("Keep", tip, "")
        .named("keep the calibration")
        .tone(tone)
        .enabled(done);
    if keep.show(ui, next()).clicked() {
        ask(CalibrateControl::Take);
    }
    let tone = if done { Tone::Plain } else { Tone::Loud };
    let on = Button::new("Next", "This step is done.", "")
        .named("next step of the calibration")
        .tone(tone)
        .enabled(!done);
    if on.show(ui, next()).clicked() {
        ask(CalibrateControl::Next);
    }
}

/// What holds, and what would.
pub(super) fn words(painter: &Painter, area: Rect, view: &CalibrationView) {
    let result = view.result.as_deref().unwrap_or("\u{2013}");
    let colour = if view.result.is_some() {
        theme::SELECTED
    } else {
        theme::DIM
    };
    let rows = [
        ("HOLDS", view.replaces.as_str(), theme::TEXT),
        ("MEASURED", result, colour),
    ];
    for (index, (head, said, colour)) in rows.into_iter().enumerate() {
        let y = area.top() + theme::GAP + index as f32 * (theme::SIZE_BODY + theme::GAP);
        let text = (head, style::words(theme::SIZE_SMALL));
        style::line(
            painter,
            pos2(area.left(), y),
            Align2::LEFT_CENTER,
            text,
            theme::DIM,
            72.0,
        );
        let text = (said, style::digits(theme::SIZE_BODY));
        let left = area.left() + 76.0;
        style::line(
            painter,
            pos2(left, y),
            Align2::LEFT_CENTER,
            text,
            colour,
            area.right() - left,
        );
    }
}
