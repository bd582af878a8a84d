//! What can be seen of the rig after one step: immutable, cheap to pass around.
//!
//! Windows, films, scenarios and tests read snapshots and nothing else.

use player::Tracking;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use motion::clip::Clip;
use motion::figure::{Figure, FigurePose, Placed};
use ps300::Diagnostic;
use ps300::display::{DisplayList, Stroke};
use ps300::machine::Activity;
use ps300::machine::picture::Picture;

use crate::controls::view::{DeviceView, LearningView};
use crate::controls_calibration::CalibrationView;
use crate::feasibility::FeasibilityView;
use crate::journal::Digest;
use crate::puppet::PuppetPoseView;

/// The rig as it stood at the end of one step.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// Machine time since the rig began, seconds.
    pub at_secs: f64,
    /// Number of steps taken so far.
    pub step: u64,
    /// The show's name.
    pub show: String,
    /// Whether there are changes that are not on disk.
    pub unsaved: bool,
    /// The figure on screen, if the show has one.
    pub figure: Option<FigureView>,
    /// The clip being edited in its playable form; `None` while it has no key, and for a clip of joints.
    pub clip: Option<Arc<Clip>>,
    /// The clip's name.
    pub clip_name: String,
    /// Keys of the clip, earliest first.
    pub keys: Vec<KeyView>,
    /// The kinetic curve of the clip.
    pub kinetics: KineticsView,
    /// Where in time the figure is.
    pub transport: TransportView,
    /// From where the figure is looked at.
    pub view: ViewState,
    /// Vectors of the network's own display structures, world axes.
    pub display: Arc<DisplayList>,
    /// The desk: dials and keys with their labels.
    pub desk: DeskView,
    /// The servo puppet, if the show has one.
    pub puppet: Option<PuppetView>,
    /// The puppet as it is posed on screen, if the show has one; it need not be where the servos are.
    pub puppet_pose: Option<PuppetPoseView>,
    /// Hands are posing the puppet itself, and its pose is the one on screen ([`crate::TeachCommand`]).
    pub teaching: bool,
    /// Whether the puppet can do the clip; `None` without a puppet.
    pub feasibility: Option<FeasibilityView>,
    /// Input devices, in order of their names.
    pub devices: Vec<DeviceView>,
    /// What is being learnt, while something is ([`crate::LearnCommand`]).
    pub learning: Option<LearningView>,
    /// The control that is being calibrated, while one is ([`crate::CalibrateControl`]).
    pub calibration: Option<CalibrationView>,
    /// The take that is being made or becoming keys.
    pub take: Option<TakeView>,
    /// Takes of the show, in order of their names.
    pub takes: Vec<String>,
    /// What [`crate::Command::Undo`] would take back, in words.
    pub undo: Option<String>,
    /// What [`crate::Command::Redo`] would make again, in words.
    pub redo: Option<String>,
    /// The latest remarks, oldest first, a bounded number.
    pub notes: Vec<Note>,
    /// The function network, while somebody looks at it ([`crate::Command::LookAtNetwork`]).
    pub network: Option<NetworkLook>,
}

/// The function network as a patch panel shows it. Parts that did not change are the same `Arc` as before.
#[derive(Clone, Debug)]
pub struct NetworkLook {
    /// Boxes and wires.
    pub picture: Arc<Picture>,
    /// What moves through them, in the picture's order.
    pub activity: Arc<Activity>,
    /// The program: the show's network files and the commands given since, each under a comment that names
    /// its file where there are several. [`crate::NetworkEdit::Program`] takes it back, edited.
    pub text: Arc<str>,
    /// Whether there is a step to take back.
    pub can_undo: bool,
    /// Whether there is a step to make again.
    pub can_redo: bool,
    /// What was wrong with the last edit, with lines and columns of its text; empty when nothing was.
    pub diagnostics: Arc<[Diagnostic]>,
}

/// The posed figure.
#[derive(Clone, Debug)]
pub struct FigureView {
    /// Links, names, tree.
    pub figure: Arc<Figure>,
    /// What each link looks like, in link axes (z along the link), one entry per link in the figure's order.
    pub shapes: Arc<Vec<Vec<Stroke>>>,
    /// The pose on screen.
    pub pose: FigurePose,
    /// The same, placed in the world.
    pub placed: Vec<Placed>,
    /// The link the cursor moves, by its place in the figure's order.
    pub selected: Option<u16>,
    /// The cursor in the front view, −1…1, y up, if a tablet is in use.
    pub cursor: Option<DVec2>,
    /// Both ends the cursor offers for the selected link (near, far), world axes; empty outside posing.
    pub candidates: Vec<DVec3>,
    /// Whether the pose has been changed by hand since it was last a pose of the clip.
    pub posing: bool,
}

/// A key of the clip.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyView {
    /// Animation time.
    pub secs: f64,
    /// Whether it is the selected one.
    pub selected: bool,
}

/// The kinetic spline as drawn above the transport.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KineticsView {
    /// `natural`, `monotone` or `linear`.
    pub mode: String,
    /// Samples (animation time, key coordinate), evenly spaced in time.
    pub curve: Vec<[f64; 2]>,
    /// Control coefficients as (Greville time, key coordinate); empty for modes without.
    pub coefficients: Vec<[f64; 2]>,
    /// The selected coefficient.
    pub selected: Option<usize>,
    /// Stretches of time in which the motion runs backwards.
    pub reversals: Vec<[f64; 2]>,
}

/// Where in time the figure is.
#[derive(Clone, Debug, PartialEq)]
pub struct TransportView {
    /// Animation time shown.
    pub secs: f64,
    /// First key.
    pub start_secs: f64,
    /// Last key.
    pub end_secs: f64,
    /// Whether time runs.
    pub playing: bool,
    /// Whether playing starts over at the end.
    pub looped: bool,
    /// Playing speed; 1 is real time.
    pub speed: f64,
}

/// A take that is being made, or that is becoming keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TakeView {
    /// What it is called.
    pub name: String,
    /// Whether it is still being recorded; its keys are worked out otherwise.
    pub recording: bool,
    /// How long it is so far, seconds.
    pub secs: f64,
    /// The devices in it.
    pub devices: Vec<String>,
}

impl Snapshot {
    /// Takes everything that was produced into `digest`, bit for bit; what people merely read (notes) too.
    pub fn digest(&self, digest: &mut Digest) {
        digest.real(self.at_secs);
        digest.bytes(&self.step.to_le_bytes());
        digest.text(&self.show);
        digest.text(&self.clip_name);
        if let Some(figure) = &self.figure {
            figure.digest(digest);
        }
        for key in &self.keys {
            digest.real(key.secs);
            digest.bytes(&[u8::from(key.selected)]);
        }
        for [secs, u] in self.kinetics.curve.iter().chain(&self.kinetics.coefficients) {
            digest.real(*secs);
            digest.real(*u);
        }
        digest.real(self.transport.secs);
        digest.bytes(&[u8::from(self.transport.playing), u8::from(self.transport.looped)]);
        for value in [self.view.azimuth_rad, self.view.elevation_rad, self.view.scale] {
            digest.real(value);
        }
        for stroke in &self.display.strokes {
            stroke
                .from
                .to_array()
                .into_iter()
                .chain(stroke.to.to_array())
                .for_each(|v| digest.real(v));
        }
        self.desk.digest(digest);
        if let Some(puppet) = &self.puppet {
            puppet.digest(digest);
        }
        if self.teaching {
            // Nothing where nobody teaches, so that older journals still digest alike.
            digest.text("teaching");
        }
        if let Some(pose) = &self.puppet_pose {
            pose.angles_rad.iter().for_each(|angle| digest.real(*angle));
        }
        for stretch in self.feasibility.iter().flat_map(|f| f.stretches.iter()) {
            digest.real(stretch.from_secs);
            digest.real(stretch.factor);
        }
        if let Some(calibration) = &self.calibration {
            // Nothing where nothing is calibrated, so that older journals still digest alike.
            digest.text(&calibration.instruction);
            digest.text(&calibration.seen);
            digest.text(calibration.result.as_deref().unwrap_or_default());
            digest.text(calibration.fault.as_deref().unwrap_or_default());
        }
        for note in &self.notes {
            digest.real(note.at_secs);
            digest.text(&note.text);
        }
        if let Some(network) = &self.network {
            network.digest(digest);
        }
    }
}

impl NetworkLook {
    fn digest(&self, digest: &mut Digest) {
        digest.text(&self.text);
        digest.bytes(&self.picture.revision.to_le_bytes());
        for output in &self.activity.outputs {
            digest.bytes(&output.sent.to_le_bytes());
        }
        for diagnostic in &*self.diagnostics {
            digest.text(&diagnostic.to_string());
        }
    }
}

impl FigureView {
    fn digest(&self, digest: &mut Digest) {
        for placed in &self.placed {
            let numbers = placed.start.to_array().into_iter().chain(placed.end.to_array());
            numbers
                .chain(placed.world_from_link.to_cols_array())
                .for_each(|v| digest.real(v));
        }
        digest.bytes(&self.selected.unwrap_or(u16::MAX).to_le_bytes());
    }
}

impl DeskView {
    fn digest(&self, digest: &mut Digest) {
        for dial in &self.dials {
            digest.text(&dial.label);
            digest.real(dial.turns);
        }
        for key in &self.keys {
            digest.text(&key.label);
            digest.bytes(&[u8::from(key.lit), u8::from(key.down)]);
        }
    }
}

impl PuppetView {
    fn digest(&self, digest: &mut Digest) {
        digest.bytes(&[self.state as u8]);
        digest.text(self.fault.as_deref().unwrap_or_default());
        for joint in &self.joints {
            digest.text(&joint.name);
            digest.real(joint.goal_rad.unwrap_or(f64::NAN));
            digest.real(joint.measured_rad.unwrap_or(f64::NAN));
        }
    }
}

impl Default for TransportView {
    fn default() -> Self {
        Self {
            secs: 0.0,
            start_secs: 0.0,
            end_secs: 0.0,
            playing: false,
            looped: false,
            speed: 1.0,
        }
    }
}

/// From where the figure is looked at (parallel projection).
#[derive(Clone, Debug, PartialEq)]
pub struct ViewState {
    /// Turn about the vertical axis, radians; 0 looks along −z.
    pub azimuth_rad: f64,
    /// Turn about the screen's horizontal axis, radians.
    pub elevation_rad: f64,
    /// Picture half-heights per metre: a point 1/scale above the centre is at y = 1.
    pub scale: f64,
    /// World point in the middle of the picture.
    pub centre: DVec3,
}

impl Default for ViewState {
    fn default() -> Self {
        Self {
            azimuth_rad: 0.0,
            elevation_rad: 0.0,
            scale: 1.0,
            centre: DVec3::ZERO,
        }
    }
}

/// Eight dials and twelve keys with their label displays, as the network drives them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeskView {
    /// Dials 1–8.
    pub dials: [DialView; 8],
    /// Keys F1–F12.
    pub keys: [DeskKeyView; 12],
    /// The device a hand on the desk touches, if one is simulated.
    pub simulated_device: Option<String>,
}

/// One dial of the desk.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DialView {
    /// Its label, at most eight characters.
    pub label: String,
    /// How far it has been turned since the rig began, turns.
    pub turns: f64,
    /// Whether it moved within the last half second.
    pub live: bool,
}

/// One key of the desk.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeskKeyView {
    /// Its label, at most eight characters.
    pub label: String,
    /// Whether its lamp is lit.
    pub lit: bool,
    /// Whether it is held down.
    pub down: bool,
}

/// The servo puppet.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub struct PuppetView {
    /// The profile's name.
    pub name: String,
    /// What the player is doing.
    pub state: PuppetState,
    /// Why it is faulted and what to do, when it is.
    pub fault: Option<String>,
    /// Joints in the profile's order.
    pub joints: Vec<JointView>,
    /// Clip time being played, if it is playing.
    pub clip_secs: Option<f64>,
    /// Answers that came too late and were thrown away.
    pub stale_discarded: u64,
    /// Goals that the limiter changed or refused.
    pub interventions: u64,
    /// Control cycles that started late.
    pub late_cycles: u64,
    /// The puppet as measured, standing upright: the ends of its lines, metres, the base at the origin.
    pub bones: Vec<[DVec3; 2]>,
    /// Whether it stands on its base instead of hanging from a figure's root.
    pub on_its_base: bool,
    /// The same where its goals are; empty before every joint has one.
    pub goal_bones: Vec<[DVec3; 2]>,
    /// Whether any servo may have torque.
    pub torque: bool,
    /// What it backs off for, and which joint has it, in words.
    pub backing_off: Option<String>,
    /// How fast time runs for what is played, as a share of what was asked for.
    pub pace: f64,
    /// Whether this step sent goals on every bus.
    pub goals_sent: bool,
    /// Whether servos that had torque can no longer be asked, or have not answered that it is off.
    pub torque_unknown: bool,
    /// Whether goals are taken ahead of time by as much as each joint lags.
    pub compensates_lag: bool,
}

/// What the player is doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PuppetState {
    /// No torque.
    #[default]
    Released,
    /// Reading, pinning goals, turning torque on.
    Arming,
    /// Torque on, standing still.
    Holding,
    /// Moving to a pose or along a clip.
    Playing,
    /// Stopped for a reason; waits for a reset.
    Faulted,
}

/// One servo joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointView {
    /// The joint's name in the puppet profile.
    pub name: String,
    /// The line of [`PuppetView::bones`] that it moves.
    pub bone: usize,
    /// What was last asked of it, radians; `None` before the first goal.
    pub goal_rad: Option<f64>,
    /// Where it last said it was, radians; `None` before the first answer.
    pub measured_rad: Option<f64>,
    /// Age of `measured_rad`, seconds.
    pub age_secs: f64,
    /// Range allowed by the profile, radians.
    pub range_rad: [f64; 2],
    /// Temperature in °C, when read.
    pub temperature_c: Option<f64>,
    /// Supply voltage, when read.
    pub voltage_v: Option<f64>,
    /// Whether it answers.
    pub present: bool,
    /// A hardware error it reports, in words.
    pub error: Option<String>,
    /// How long after its goals the joint is where they were, seconds; none until it has moved enough.
    pub lag_secs: Option<f64>,
    /// How well it follows.
    pub tracking: Tracking,
    /// What is wrong with it that can still be helped by doing less, in a word.
    pub trouble: Option<&'static str>,
    /// Share of the way from wish to joint that its goal has retreated, 0 to 1.
    pub retreat: f64,
}

/// A remark for the person at the rig.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// Machine time, seconds.
    pub at_secs: f64,
    /// How much it matters.
    pub level: NoteLevel,
    /// The remark: what happened and what to do.
    pub text: String,
}

/// How much a remark matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NoteLevel {
    /// Good to know.
    Info,
    /// Something was refused or adjusted.
    Warning,
    /// Something failed.
    Error,
}
