//! The servo puppet: what it does, where its joints are against where they should be, and the large STOP.

use egui::{Align2, Rect, Ui, pos2, vec2};
use rig::{Command, PuppetCommand, PuppetState, PuppetView, Snapshot};

use super::button::{Button, Tone};
use super::style::ink;
use super::{Commands, Panel, joints, layout, style};
use crate::render::theme::{self, Rgb};
use crate::render::timeline::clock_text;

/// The servo puppet.
#[derive(Default)]
pub struct Puppet;

/// Height of STOP, points: the largest button there is.
const STOP: f32 = 38.0;
/// Height of what a fault or the player has to say, points; kept free so that nothing jumps.
const REMARK: f32 = 30.0;

impl Panel for Puppet {
    fn title(&self) -> &'static str {
        "puppet"
    }

    fn ui(&mut self, ui: &mut Ui, seen: &Snapshot, commands: &mut Commands<'_>) {
        let area = layout::inside(ui.max_rect());
        if let Some(puppet) = &seen.puppet {
            let corner = area.right_top();
            let text = (puppet.name.as_str(), style::words(theme::SIZE_SMALL));
            style::line(
                ui.painter(),
                corner,
                Align2::RIGHT_TOP,
                text,
                theme::DIM,
                area.width() - 64.0,
            );
        }
        let mut rest = style::title(ui.painter(), area, self.title());
        let mut take = |height: f32, gap: f32| {
            let row = Rect::from_min_size(rest.min, vec2(rest.width(), height));
            rest.min.y += height + gap;
            row
        };
        let status = take(18.0, 2.0);
        let remark = take(REMARK, theme::STEP);
        let stop = take(STOP, theme::GAP);
        let first = take(theme::ROW, theme::STEP);
        let second = take(theme::ROW, theme::GAP);
        stop_button(ui, stop, seen.puppet.as_ref(), commands);
        orders(
            ui,
            [first, second],
            seen.puppet.as_ref(),
            seen.clip.is_some(),
            commands,
        );
        let Some(puppet) = &seen.puppet else {
            let text = ("This show has no puppet", style::words(theme::SIZE_BODY));
            style::line(
                ui.painter(),
                status.left_top(),
                Align2::LEFT_TOP,
                text,
                theme::DIM,
                status.width(),
            );
            return;
        };
        state_line(ui, status, puppet);
        remark_lines(ui, remark, puppet);
        joints::show(ui, rest, &puppet.joints);
    }
}

/// A state in words and in its colour.
fn state_word(state: PuppetState) -> (&'static str, Rgb) {
    match state {
        PuppetState::Released => ("released", theme::DIM),
        PuppetState::Arming => ("arming", theme::LIVE),
        PuppetState::Holding => ("holding", theme::LIVE),
        PuppetState::Playing => ("playing", theme::LIVE),
        PuppetState::Faulted => ("faulted", theme::FAULTED),
    }
}

fn state_line(ui: &Ui, area: Rect, puppet: &PuppetView) {
    let (word, colour) = state_word(puppet.state);
    let lamp = pos2(area.left() + 5.0, area.center().y);
    if puppet.state == PuppetState::Released {
        ui.painter()
            .circle_stroke(lamp, 4.0, egui::Stroke::new(1.5, ink(colour)));
    } else {
        ui.painter().circle_filled(lamp, 4.5, ink(colour));
    }
    let at = pos2(area.left() + 18.0, area.center().y);
    let painter = ui.painter();
    let said = painter.text(
        at,
        Align2::LEFT_CENTER,
        word,
        style::words(theme::SIZE_TITLE),
        ink(colour),
    );
    let torque = if puppet.torque { "torque on" } else { "no torque" };
    let at = pos2(said.right() + theme::MARGIN, area.center().y + 1.0);
    painter.text(
        at,
        Align2::LEFT_CENTER,
        torque,
        style::words(theme::SIZE_SMALL),
        ink(theme::DIM),
    );
    if let Some(secs) = puppet.clip_secs {
        let text = format!("{} s", clock_text(secs));
        let font = style::digits(theme::SIZE_BODY);
        let at = pos2(area.right(), area.center().y);
        ui.painter()
            .text(at, Align2::RIGHT_CENTER, text, font, ink(theme::LIVE));
    }
}

fn remark_lines(ui: &Ui, area: Rect, puppet: &PuppetView) {
    let (text, colour) = match (&puppet.fault, puppet.state) {
        (Some(fault), _) => (fault.clone(), theme::TEXT),
        (None, PuppetState::Faulted) => ("Stopped. Reset, then arm.".to_owned(), theme::TEXT),
        (None, _) => (doings(puppet), theme::DIM),
    };
    let mut job = egui::text::LayoutJob::single_section(
        text.clone(),
        egui::TextFormat::simple(style::words(theme::SIZE_SMALL + 1.0), ink(colour)),
    );
    job.wrap = egui::text::TextWrapping {
        max_width: area.width(),
        max_rows: 2,
        ..Default::default()
    };
    let galley = ui.painter().layout_job(job);
    let cut = galley.elided;
    ui.painter().galley(area.min, galley, ink(colour));
    let response = ui.interact(area, ui.scope_id().with("remark"), egui::Sense::hover());
    if cut {
        response.on_hover_text(text);
    }
}

/// What the servo loop noticed, in one line.
fn doings(puppet: &PuppetView) -> String {
    let counts = [
        (puppet.interventions, "limited"),
        (puppet.stale_discarded, "stale"),
        (puppet.late_cycles, "late"),
    ];
    let said: Vec<String> = counts
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect();
    if said.is_empty() {
        "nothing limited, nothing late".to_owned()
    } else {
        said.join(", ")
    }
}

fn stop_button(ui: &mut Ui, area: Rect, puppet: Option<&PuppetView>, commands: &mut Commands<'_>) {
    let faulted = puppet.is_some_and(|p| p.state == PuppetState::Faulted);
    let (text, tone) = if faulted {
        ("STOPPED", Tone::Faulted)
    } else {
        ("STOP", Tone::Loud)
    };
    let tip = "Stops the puppet at once, whatever it does, until it is reset.";
    let button = Button::new(text, tip, "Esc")
        .named("STOP")
        .tone(tone)
        .size(theme::SIZE_READOUT);
    if button.show(ui, area).clicked() {
        commands.push(Command::Puppet(PuppetCommand::Stop));
    }
}

fn orders(
    ui: &mut Ui,
    rows: [Rect; 2],
    puppet: Option<&PuppetView>,
    clip: bool,
    commands: &mut Commands<'_>,
) {
    let state = puppet.map(|p| p.state);
    let armed = matches!(state, Some(PuppetState::Holding | PuppetState::Playing));
    let playing = state == Some(PuppetState::Playing);
    let cells: Vec<Rect> = rows
        .into_iter()
        .flat_map(|row| layout::columns(row, 3, theme::STEP))
        .collect();
    let buttons = [
        (
            "Arm",
            "Reads where every servo is, pins the goals there, turns torque on.",
            "A",
            PuppetCommand::Arm,
            state == Some(PuppetState::Released),
        ),
        ("Hold", "Stays where it is.", "H", PuppetCommand::Hold, playing),
        (
            "Release",
            "Slows down and lets go.",
            "R",
            PuppetCommand::Release,
            armed,
        ),
        (
            "Play",
            "Approaches the clip's pose softly, then plays it.",
            "P",
            PuppetCommand::Play,
            armed && clip,
        ),
        (
            "Follow",
            "Follows the figure on screen, live.",
            "F",
            PuppetCommand::Follow,
            armed,
        ),
        (
            "Reset",
            "Leaves the faulted state; torque stays off.",
            "Ctrl-R",
            PuppetCommand::Reset,
            state == Some(PuppetState::Faulted),
        ),
    ];
    for ((name, tip, keys, order, enabled), cell) in buttons.into_iter().zip(cells) {
        let live = playing && order == PuppetCommand::Play;
        let tone = if live { Tone::Live } else { Tone::Plain };
        // "Play" alone is the transport's.
        let called = format!("puppet {}", name.to_lowercase());
        let button = Button::new(name, tip, keys)
            .named(&called)
            .enabled(enabled)
            .tone(tone);
        if button.show(ui, cell).clicked() {
            commands.push(Command::Puppet(order));
        }
    }
}
