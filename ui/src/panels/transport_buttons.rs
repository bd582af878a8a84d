//! The row above the strip of time: play and step, the time itself, speed, and how keys become timing.

use egui::{Align2, Rect, Ui, pos2, vec2};
use rig::{Command, EditCommand, KineticsMode, Snapshot, TransportCommand};

use super::Commands;
use super::button::{Button, Icon, Tone};
use super::style::{self, ink};
use crate::render::theme;
use crate::render::timeline::clock_text;

/// Icon, name, what it does, its key, how it looks, width, and what it asks for.
type Order = (
    Icon,
    &'static str,
    &'static str,
    &'static str,
    Tone,
    f32,
    TransportCommand,
);

fn orders(seen: &Snapshot) -> [Order; 6] {
    let transport = &seen.transport;
    let seek = |secs| TransportCommand::Seek { secs };
    let (icon, tone) = if transport.playing {
        (Icon::Pause, Tone::Live)
    } else {
        (Icon::Play, Tone::Plain)
    };
    let again = if transport.looped { Tone::On } else { Tone::Off };
    let to_start = seek(transport.start_secs);
    let to_end = seek(transport.end_secs);
    let back = TransportCommand::Key(-1);
    [
        (
            Icon::Start,
            "start",
            "Goes to the first key.",
            "Home",
            Tone::Plain,
            32.0,
            to_start,
        ),
        (
            Icon::Previous,
            "previous key",
            "Goes to the key before.",
            "Up",
            Tone::Plain,
            32.0,
            back,
        ),
        (
            icon,
            "play",
            "Plays on screen, or pauses.",
            "Space",
            tone,
            56.0,
            TransportCommand::Toggle,
        ),
        (
            Icon::Next,
            "next key",
            "Goes to the next key.",
            "Down",
            Tone::Plain,
            32.0,
            TransportCommand::Key(1),
        ),
        (
            Icon::End,
            "end",
            "Goes to the last key.",
            "End",
            Tone::Plain,
            32.0,
            to_end,
        ),
        (
            Icon::Loop,
            "loop",
            "Starts over at the end.",
            "L",
            again,
            32.0,
            TransportCommand::ToggleLoop,
        ),
    ]
}

/// Shows the row.
pub fn show(ui: &mut Ui, row: Rect, seen: &Snapshot, commands: &mut Commands<'_>) {
    let mut left = row.left();
    for (icon, name, tip, keys, tone, width, order) in orders(seen) {
        let rect = Rect::from_min_size(pos2(left, row.top()), vec2(width, row.height()));
        if Button::icon(icon, name, tip, keys)
            .tone(tone)
            .show(ui, rect)
            .clicked()
        {
            commands.push(Command::Transport(order));
        }
        left += width + theme::STEP;
    }
    let read = readout(ui, pos2(left + theme::MARGIN, row.center().y), seen);
    slow_to_fit(ui, row, read + theme::MARGIN, seen, commands);
    right_side(ui, row, seen, commands);
}

/// There only while the puppet cannot do the clip as fast as it is.
fn slow_to_fit(ui: &mut Ui, row: Rect, left: f32, seen: &Snapshot, commands: &mut Commands<'_>) {
    let Some(view) = &seen.feasibility else {
        return;
    };
    let text = if view.slowing {
        "Slowing"
    } else if view.stretches.iter().any(|stretch| stretch.slowable) {
        "Slow to fit"
    } else {
        return;
    };
    let tip = "Gives the keys the time the puppet needs; the path stays. One step of undo.";
    let button = Button::new(text, tip, "Shift-F").named("slow to fit");
    let button = button.tone(Tone::TooMuch).enabled(!view.slowing);
    let rect = Rect::from_min_size(pos2(left, row.top()), vec2(88.0, row.height()));
    if button.show(ui, rect).clicked() {
        commands.push(Command::SlowToFit);
    }
}

/// The time, large, with the clip's length beside it in the same digits. Returns where it ends.
fn readout(ui: &Ui, at: egui::Pos2, seen: &Snapshot) -> f32 {
    let now = clock_text(seen.transport.secs);
    // Time runs by itself, or the puppet takes it along.
    let taken_along = seen.puppet.as_ref().is_some_and(|p| p.clip_secs.is_some());
    let colour = if seen.transport.playing || taken_along {
        theme::LIVE
    } else {
        theme::TEXT
    };
    // As many places as the clip's length needs: the number grows to the left and its neighbours stay.
    let font = style::digits(theme::SIZE_READOUT);
    let places = clock_text(seen.transport.end_secs).len().max(now.len()) as f32;
    let right = at + vec2((places * theme::SIZE_READOUT * 0.61).ceil(), 0.0);
    ui.painter()
        .text(right, Align2::RIGHT_CENTER, now, font, ink(colour));
    let length = format!("/ {} s", clock_text(seen.transport.end_secs));
    let font = style::digits(theme::SIZE_BODY);
    let drawn = ui.painter().text(
        right + vec2(theme::GAP, 2.0),
        Align2::LEFT_CENTER,
        length,
        font,
        ink(theme::DIM),
    );
    drawn.right()
}

/// Speeds that the buttons step through.
const SPEEDS: [f64; 7] = [0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 4.0];

/// The next speed upwards or downwards.
pub fn stepped_speed(now: f64, up: bool) -> f64 {
    let found = if up {
        SPEEDS.into_iter().find(|s| *s > now + 1e-9)
    } else {
        SPEEDS.into_iter().rev().find(|s| *s < now - 1e-9)
    };
    found.unwrap_or(now)
}

/// From the right edge: how keys become timing; then the speed.
fn right_side(ui: &mut Ui, row: Rect, seen: &Snapshot, commands: &mut Commands<'_>) {
    let mut right = row.right();
    let mut cell = |width: f32, gap: f32| {
        let rect = Rect::from_min_size(pos2(right - width, row.top()), vec2(width, row.height()));
        right -= width + gap;
        rect
    };
    let edited = Button::new(
        "Reset",
        "Takes back all adjustments of the kinetic curve.",
        "Shift-M",
    )
    .named("reset kinetics");
    if edited.show(ui, cell(52.0, theme::GAP)).clicked() {
        commands.push(Command::Edit(EditCommand::ResetKinetics));
    }
    let modes = [
        (
            "Linear",
            "linear",
            "Straight from key to key.",
            KineticsMode::Linear,
        ),
        (
            "Monotone",
            "monotone",
            "Smooth, and never runs backwards.",
            KineticsMode::Monotone,
        ),
        (
            "Natural",
            "natural",
            "The smoothest; may swing back between keys.",
            KineticsMode::Natural,
        ),
    ];
    for (text, name, tip, mode) in modes {
        let button = Button::new(text, tip, "M: the next one").switch(seen.kinetics.mode == name);
        if button.show(ui, cell(72.0, theme::STEP)).clicked() {
            commands.push(Command::Edit(EditCommand::KineticsMode(mode)));
        }
    }
    let _ = cell(theme::MARGIN, 0.0);
    let up = Button::new("+", "Plays faster.", "=").named("faster");
    if up.show(ui, cell(24.0, 0.0)).clicked() {
        let speed = stepped_speed(seen.transport.speed, true);
        commands.push(Command::Transport(TransportCommand::Speed(speed)));
    }
    let speed = cell(56.0, 0.0);
    let text = format!("{:.2}×", seen.transport.speed);
    let font = style::digits(theme::SIZE_BODY);
    ui.painter()
        .text(speed.center(), Align2::CENTER_CENTER, text, font, ink(theme::DIM));
    let down = Button::new("-", "Plays slower.", "-").named("slower");
    if down.show(ui, cell(24.0, 0.0)).clicked() {
        let speed = stepped_speed(seen.transport.speed, false);
        commands.push(Command::Transport(TransportCommand::Speed(speed)));
    }
}
