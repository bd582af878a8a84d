//! The servo puppet: what it does, how it stands, where its joints are against where they should be, and the
//! large STOP.

use egui::{Align2, Rect, Ui, pos2, vec2};
use rig::{Command, PuppetCommand, PuppetState, PuppetView, Snapshot};

use super::button::{Button, Tone};
use super::style::ink;
use super::{Commands, Panel, canvas, joints, layout, style};
use crate::render::puppet as measured;
use crate::render::theme::{self, Rgb};
use crate::render::timeline::clock_text;

/// The servo puppet.
#[derive(Default)]
pub struct Puppet;

/// Heights of STOP, points: the largest button there is.
const STOP: [f32; 2] = [44.0, 72.0];
/// Heights of what a fault or the player has to say, points: two lines or four, kept free so that nothing jumps.
const REMARK: [f32; 2] = [2.0 * LINE, 4.0 * LINE];
/// Height of a line of it, points.
const LINE: f32 = 15.0;
/// Least height of the block with STOP and the puppet's picture, points.
const BLOCK: f32 = STATE + STOP[0] + ORDERS + theme::GAP;
/// The picture's part of the width, and how wide it is for its height: as a standing figure with an arm out.
const PICTURE: [f32; 2] = [0.45, 0.66];
/// Height of the state and what belongs to it, points.
const STATE: f32 = 40.0;
/// Height of the orders: three rows, points.
const ORDERS: f32 = 3.0 * theme::ROW + 2.0 * theme::STEP;

/// The panel's rectangles.
struct Parts {
    state: Rect,
    stop: Rect,
    orders: Rect,
    picture: Rect,
    remark: Rect,
    joints: Rect,
}

impl Parts {
    /// Divides what the title leaves; `joints` is how high their table would like to be.
    fn of(rest: Rect, joints: f32) -> Parts {
        let below = REMARK[0] + 2.0 * theme::GAP + joints;
        let tallest = (rest.width() * PICTURE[0] / PICTURE[1]).max(BLOCK);
        let block = (rest.height() - below).clamp(BLOCK, tallest).floor();
        let width = (block * PICTURE[1]).round();
        let spare = rest.height() - block - 2.0 * theme::GAP - joints;
        let said = ((spare / LINE).floor() * LINE).clamp(REMARK[0], REMARK[1]);
        let bottom = rest.top() + block;
        let split = rest.right() - width;
        let rect = |x0: f32, y0: f32, x1: f32, y1: f32| Rect::from_min_max(pos2(x0, y0), pos2(x1, y1));
        let (left, right) = (rest.left(), split - theme::MARGIN);
        let orders = bottom - ORDERS;
        let stop_bottom = orders - theme::GAP;
        let stop = (stop_bottom - STOP[1]).max(rest.top() + STATE);
        let remark = bottom + theme::GAP;
        Parts {
            state: rect(left, rest.top(), right, rest.top() + STATE),
            stop: rect(left, stop, right, stop_bottom),
            orders: rect(left, orders, right, bottom),
            picture: rect(split, rest.top(), rest.right(), bottom),
            remark: rect(left, remark, rest.right(), remark + said),
            joints: rect(left, remark + said + theme::GAP, rest.right(), rest.bottom()),
        }
    }
}

impl Panel for Puppet {
    fn title(&self) -> &'static str {
        "puppet"
    }

    fn ui(&mut self, ui: &mut Ui, seen: &Snapshot, commands: &mut Commands<'_>) {
        let area = layout::inside(ui.max_rect());
        let puppet = seen.puppet.as_ref();
        let rest = style::title(ui.painter(), area, self.title());
        let joints = puppet.map_or(0.0, |p| joints::height_wanted(&p.joints));
        let parts = Parts::of(rest, joints);
        stop_button(ui, parts.stop, puppet, commands);
        orders(ui, parts.orders, puppet, seen.clip.is_some(), commands);
        picture(ui, parts.picture, puppet);
        let Some(puppet) = puppet else {
            let text = ("This show has no puppet", style::words(theme::SIZE_BODY));
            let at = parts.state.left_top();
            style::line(
                ui.painter(),
                at,
                Align2::LEFT_TOP,
                text,
                theme::DIM,
                parts.state.width(),
            );
            return;
        };
        let name = (puppet.name.as_str(), style::words(theme::SIZE_SMALL));
        let width = area.width() - 64.0;
        style::line(
            ui.painter(),
            area.right_top(),
            Align2::RIGHT_TOP,
            name,
            theme::DIM,
            width,
        );
        state_lines(ui, parts.state, puppet);
        remark_lines(ui, parts.remark, puppet);
        joints::show(ui, parts.joints, puppet);
    }
}

/// The puppet where it was measured.
fn picture(ui: &Ui, area: Rect, puppet: Option<&PuppetView>) {
    let aspect = f64::from(area.width() / area.height().max(1.0));
    canvas::show(ui, area, "puppet", &measured::scene(puppet, aspect));
    let edge = style::hair(theme::EDGE);
    ui.painter()
        .rect_stroke(area, 0.0, edge, egui::StrokeKind::Inside);
    let text = ("measured", style::words(theme::SIZE_SMALL));
    let at = area.left_top() + vec2(6.0, 4.0);
    style::line(
        ui.painter(),
        at,
        Align2::LEFT_TOP,
        text,
        theme::FAINT,
        area.width() - 8.0,
    );
    let id = ui.scope_id().with("picture");
    let response = ui.interact(area, id, egui::Sense::hover());
    response.on_hover_text("The puppet as its servos say it stands, not as it was asked to.");
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

/// The state, large; beneath it the torque, and the clip's time while it plays.
fn state_lines(ui: &Ui, area: Rect, puppet: &PuppetView) {
    let (word, colour) = state_word(puppet.state);
    let painter = ui.painter();
    let upper = area.top() + 8.0;
    let lamp = pos2(area.left() + 5.0, upper);
    if puppet.state == PuppetState::Released {
        painter.circle_stroke(lamp, 4.0, egui::Stroke::new(1.5, ink(colour)));
    } else {
        painter.circle_filled(lamp, 4.5, ink(colour));
    }
    let left = area.left() + 18.0;
    let font = style::words(theme::SIZE_TITLE);
    painter.text(pos2(left, upper), Align2::LEFT_CENTER, word, font, ink(colour));
    let lower = area.top() + 27.0;
    let torque = if puppet.torque { "torque on" } else { "no torque" };
    let font = style::words(theme::SIZE_SMALL);
    painter.text(
        pos2(left, lower),
        Align2::LEFT_CENTER,
        torque,
        font,
        ink(theme::DIM),
    );
    if let Some(secs) = puppet.clip_secs {
        let text = format!("{} s", clock_text(secs));
        let (at, font) = (pos2(area.right(), lower), style::digits(theme::SIZE_BODY));
        painter.text(at, Align2::RIGHT_CENTER, text, font, ink(theme::LIVE));
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
        max_rows: (area.height() / LINE) as usize,
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
        (puppet.interventions, "goal", "limited"),
        (puppet.stale_discarded, "answer", "too late"),
        (puppet.late_cycles, "cycle", "late"),
    ];
    let said: Vec<String> = counts
        .iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, what, how)| format!("{count} {what}{} {how}", if *count == 1 { "" } else { "s" }))
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

/// What the puppet can be asked for: what is done in turn from top to bottom, what ends it on the right.
fn orders(ui: &mut Ui, area: Rect, puppet: Option<&PuppetView>, clip: bool, commands: &mut Commands<'_>) {
    let state = puppet.map(|p| p.state);
    let armed = matches!(state, Some(PuppetState::Holding | PuppetState::Playing));
    let playing = state == Some(PuppetState::Playing);
    // Playing without a clip's time is following.
    let doing = match puppet.and_then(|p| p.clip_secs) {
        Some(_) => PuppetCommand::Play,
        None => PuppetCommand::Follow,
    };
    let row = |row: usize| {
        let top = area.top() + row as f32 * (theme::ROW + theme::STEP);
        let row = Rect::from_min_size(pos2(area.left(), top), vec2(area.width(), theme::ROW));
        layout::columns(row, 2, theme::STEP)
    };
    let cells = (0..3).flat_map(row);
    let buttons = [
        (
            "Arm",
            "Reads where every servo is, pins the goals there, turns torque on.",
            "A",
            PuppetCommand::Arm,
            state == Some(PuppetState::Released),
        ),
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
        ("Hold", "Stays where it is.", "H", PuppetCommand::Hold, playing),
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
        let live = playing && order == doing;
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
