//! The servo puppet: what it does, how it stands, where its joints are against where they should be, and the
//! large STOP.

use egui::accesskit::Role;
use egui::{Align2, Rect, Sense, Ui, pos2, vec2};
use rig::{Command, JointView, PuppetCommand, PuppetPoseView, PuppetState, PuppetView, Snapshot};

use super::button::{self, Button, Tone};
use super::hold::Hold;
use super::puppet_state::{self, SWITCH};
use super::{Commands, Panel, canvas, joints, layout, style, vitals};
use crate::render::puppet as measured;
use crate::render::theme;

/// The servo puppet.
#[derive(Default)]
pub struct Puppet {
    hold: Hold,
}

/// Heights of STOP, points: the largest button there is.
const STOP: [f32; 2] = [44.0, 72.0];
/// Heights of what a fault or the player has to say, points: two lines or four, kept free so that nothing jumps.
const REMARK: [f32; 2] = [2.0 * puppet_state::LINE, 4.0 * puppet_state::LINE];
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
    vitals: Rect,
    remark: Rect,
    joints: Rect,
}

impl Parts {
    /// Divides what the title leaves; `joints` is how high their table would like to be.
    fn of(rest: Rect, joints: f32) -> Parts {
        let below = REMARK[0] + vitals::HEIGHT + 2.0 * theme::GAP + joints;
        let tallest = (rest.width() * PICTURE[0] / PICTURE[1]).max(BLOCK);
        let block = (rest.height() - below).clamp(BLOCK, tallest).floor();
        let width = (block * PICTURE[1]).round();
        let spare = rest.height() - block - vitals::HEIGHT - 2.0 * theme::GAP - joints;
        let said = ((spare / puppet_state::LINE).floor() * puppet_state::LINE).clamp(REMARK[0], REMARK[1]);
        let bottom = rest.top() + block;
        let split = rest.right() - width;
        let rect = |x0: f32, y0: f32, x1: f32, y1: f32| Rect::from_min_max(pos2(x0, y0), pos2(x1, y1));
        let (left, right) = (rest.left(), split - theme::MARGIN);
        let orders = bottom - ORDERS;
        let stop_bottom = orders - theme::GAP;
        let stop = (stop_bottom - STOP[1]).max(rest.top() + STATE);
        let vitals = bottom + theme::STEP;
        let remark = vitals + vitals::HEIGHT + theme::STEP;
        Parts {
            state: rect(left, rest.top(), right, rest.top() + STATE),
            stop: rect(left, stop, right, stop_bottom),
            orders: rect(left, orders, right, bottom),
            picture: rect(split, rest.top(), rest.right(), bottom),
            vitals: rect(left, vitals, rest.right(), vitals + vitals::HEIGHT),
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
        let driven = seen.puppet.as_ref();
        let stand_in = seen
            .puppet_pose
            .as_ref()
            .filter(|_| driven.is_none())
            .map(on_screen);
        let puppet = driven.or(stand_in.as_ref());
        let rest = style::title(ui.painter(), area, self.title());
        let joints = puppet.map_or(0.0, |p| joints::height_wanted(&p.joints));
        let parts = Parts::of(rest, joints);
        stop_button(ui, parts.stop, driven, commands);
        orders(ui, parts.orders, driven, can_play(seen), commands);
        puppet_state::switches(ui, parts.state, seen, commands);
        self.picture(ui, parts.picture, seen, commands);
        let Some(puppet) = puppet else {
            let text = ("No puppet", style::words(theme::SIZE_BODY));
            let at = parts.state.left_top();
            let width = parts.state.width() - SWITCH[0];
            style::line(ui.painter(), at, Align2::LEFT_TOP, text, theme::DIM, width);
            return;
        };
        let name = (puppet.name.as_str(), style::words(theme::SIZE_SMALL));
        let (at, width) = (area.right_top(), area.width() - 64.0);
        style::line(ui.painter(), at, Align2::RIGHT_TOP, name, theme::DIM, width);
        puppet_state::show(ui, parts.state, puppet, seen);
        vitals::show(ui, parts.vitals, puppet);
        puppet_state::remark(ui, parts.remark, puppet, seen);
        joints::show(ui, parts.joints, puppet, seen, commands);
    }
}

/// A puppet that nobody drives, as it is posed on screen.
fn on_screen(pose: &PuppetPoseView) -> PuppetView {
    let joint = |(name, range_rad): (&String, &[f64; 2])| JointView {
        name: name.clone(),
        range_rad: *range_rad,
        age_secs: f64::INFINITY,
        ..JointView::default()
    };
    PuppetView {
        name: pose.puppet.clone(),
        joints: pose.names.iter().zip(&pose.ranges_rad).map(joint).collect(),
        ..PuppetView::default()
    }
}

/// Whether there is something to play: a figure's clip, or one of joints.
fn can_play(seen: &Snapshot) -> bool {
    seen.clip.is_some() || (seen.figure.is_none() && !seen.keys.is_empty())
}

impl Puppet {
    /// The puppet where it was measured; ends of links can be dragged to pose it on screen.
    fn picture(&mut self, ui: &Ui, area: Rect, seen: &Snapshot, commands: &mut Commands<'_>) {
        let id = ui.scope_id().with("picture");
        let pose = seen.puppet_pose.as_ref();
        let sense = if pose.is_some() {
            Sense::drag()
        } else {
            Sense::hover()
        };
        let response = button::spot(ui, area, id, sense, (Role::Canvas, "puppet picture"));
        let near = response.hovered() || response.dragged();
        let driven = seen.puppet.is_some();
        let posing = pose.filter(|pose| near || pose.by_hand || !driven);
        let aspect = f64::from(area.width() / area.height().max(1.0));
        let scene = measured::scene(seen.puppet.as_ref(), posing, aspect);
        canvas::show(ui, area, "puppet", &scene);
        let edge = style::hair(theme::EDGE);
        ui.painter()
            .rect_stroke(area, 0.0, edge, egui::StrokeKind::Inside);
        let text = if driven { "measured" } else { "on screen" };
        let text = (text, style::words(theme::SIZE_SMALL));
        let at = area.left_top() + vec2(6.0, 4.0);
        let width = area.width() - 8.0;
        style::line(ui.painter(), at, Align2::LEFT_TOP, text, theme::FAINT, width);
        if let Some(pose) = posing {
            self.hold
                .drag(ui, (area, &scene.camera), &response, pose, commands);
            self.hold.mark(ui, (area, &scene.camera), &response, pose);
        }
        let tip = "The puppet as its servos say it stands, and faintly where it was asked to be. Drag an end to pose \
                   it on screen; K stores the pose where the clip is one of joints.";
        button::tooltip_at_pointer(response, tip, "B, Shift-B");
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
