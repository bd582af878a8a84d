//! Everything anybody can ask of the rig.
//!
//! The window, the command line, the scenarios, the function network's parameters and the journal all send
//! these values and nothing else. They are plain data: the journal stores them as JSON, one a line.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use crate::controls::command::{Binding, ControlCommand, LearnCommand};
pub use crate::controls_calibration::CalibrateControl;
use crate::take::TakeTolerance;

/// One request. Requests that cannot be met leave a [`crate::Note`] and change nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Command {
    /// A change of the function network while it runs. Journals of before the patch panel have text alone here.
    Network(#[serde(deserialize_with = "network_edit")] NetworkEdit),
    /// Whether snapshots carry the network ([`crate::Snapshot::network`]); nobody looks at first.
    LookAtNetwork(bool),
    /// A hand on a simulated device: it answers with bytes, as the real one would.
    Touch {
        /// The device's name as in [`crate::DeviceView::name`].
        device: String,
        /// What the hand does.
        touch: Touch,
    },
    /// Posing with the cursor line.
    Pose(PoseCommand),
    /// A change of the show that can be undone.
    Edit(EditCommand),
    /// Takes back the last change.
    Undo,
    /// Makes the last change that was taken back again.
    Redo,
    /// Where in time the figure on screen is.
    Transport(TransportCommand),
    /// From where the figure is looked at.
    View(ViewCommand),
    /// What the servo puppet does.
    Puppet(PuppetCommand),
    /// Poses that hands give the puppet itself.
    Teach(TeachCommand),
    /// Poses the puppet itself, joint by joint or by its ends.
    PuppetPose(PuppetPose),
    /// Gives the clip's keys other times, so that the puppet can do it; the path stays. One step of undo.
    SlowToFit,
    /// Connecting a control by touching it and what it is to drive.
    Learn(LearnCommand),
    /// Connects a control to an inlet of the network, with what scaling that takes. One step of undo.
    BindControl(Binding),
    /// Takes away everything that an output of a device drives. One step of undo.
    UnbindControl {
        /// The device's name as in [`crate::DeviceView::name`].
        device: String,
        /// The control, from 1.
        control: u8,
    },
    /// Gives a control a label, as the network would. One step of undo.
    SetControlLabel {
        /// The device's name as in [`crate::DeviceView::name`].
        device: String,
        /// The control, from 1.
        control: u8,
        /// The label; empty for the name of what it drives.
        text: String,
    },
    /// How controls behave, and their pages.
    Controls(ControlCommand),
    /// Measuring what a control's counts come to, with a hand on it. Kept with the device, no step of undo.
    CalibrateControl(CalibrateControl),
    /// Has a device show what one output of it can, for a moment; then it shows what it is to show again.
    TestOutput {
        /// The device's name as in [`crate::DeviceView::name`].
        device: String,
        /// The output, by [`crate::OutputView::number`].
        output: u16,
    },
    /// Keeps a device's place among equal ones, wherever it is plugged in.
    PinDevice {
        /// The device's name as in [`crate::DeviceView::name`].
        device: String,
        /// Which of several equal ones it is to be, from 1; none lets it be found by itself again.
        slot: Option<u16>,
    },
    /// Writes what devices and the rig say to each other into files, one a device, until it is stopped.
    StartCapture {
        /// The devices, by [`crate::DeviceView::name`]; all when empty.
        devices: Vec<String>,
    },
    /// Ends captures; the files are whole then.
    StopCapture {
        /// The devices; all that are captured when empty.
        devices: Vec<String>,
    },
    /// Performances kept as what the devices said.
    Take(TakeCommand),
    /// Writes the show to its folder.
    Save,
}

impl Command {
    /// Whether it is about captures: nothing of the rig comes of it, only files.
    pub fn is_capture(&self) -> bool {
        matches!(self, Self::StartCapture { .. } | Self::StopCapture { .. })
    }
}

/// Takes: recorded, done again through the network as it is now, thrown away.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TakeCommand {
    /// Records from the next step on what the devices say.
    Start {
        /// What the take, and the clip of its keys, will be called; one of that name is replaced.
        name: String,
        /// The devices, by [`crate::DeviceView::name`]; all when empty.
        #[serde(default)]
        devices: Vec<String>,
        /// How far the keys may be off; half a degree and two millimetres unless said.
        #[serde(default)]
        tolerance: Option<TakeTolerance>,
    },
    /// Ends it with this step. When its keys are ready, take and clip become one step of undo.
    Stop,
    /// Does a take again through the present network; its keys become a clip in one step of undo.
    Rerun {
        /// The take.
        take: String,
        /// The clip; one of the take's name unless said.
        #[serde(default)]
        clip: Option<String>,
        /// How far the keys may be off; half a degree and two millimetres unless said.
        #[serde(default)]
        tolerance: Option<TakeTolerance>,
    },
    /// Throws a take away; clips made of it stay.
    Delete(String),
}

/// A change of the function network. Each that changes the show is one step of undo; what was not changed
/// keeps its messages and sums.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NetworkEdit {
    /// Text in the network's command language, executed at once and kept in the document.
    Commands(String),
    /// The whole program anew, as [`crate::NetworkLook::text`] shows it: what differs is changed.
    Program(String),
    /// As [`Command::Undo`].
    Undo,
    /// As [`Command::Redo`].
    Redo,
    /// Withholds what an output would send. Not part of the document.
    Freeze {
        /// Whose output.
        name: String,
        /// From 1.
        output: u8,
        /// False lets it send again.
        on: bool,
    },
}

/// An edit, or the text alone that older journals have.
fn network_edit<'de, D: serde::Deserializer<'de>>(from: D) -> Result<NetworkEdit, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Written {
        Edit(NetworkEdit),
        Text(String),
    }
    Ok(match Written::deserialize(from)? {
        Written::Edit(edit) => edit,
        Written::Text(text) => NetworkEdit::Commands(text),
    })
}

/// Hands on a simulated control, in the device's own numbering.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Touch {
    /// Turns dial `control` by `turns` (clockwise positive).
    Dial {
        /// Dial number as the device counts, from 0.
        control: u8,
        /// Turns; 1.0 is a full revolution.
        turns: f64,
    },
    /// Presses or lets go of a key.
    Button {
        /// Key number as the device counts, from 0.
        control: u8,
        /// Whether it is now down.
        down: bool,
    },
    /// Moves pen or puck; `None` lifts it out of the tablet's reach.
    Tablet {
        /// Position, each axis −1…1, y up; `None` when away.
        at: Option<[f64; 2]>,
        /// Buttons held, one bit each, lowest is button 1.
        buttons: u8,
    },
    /// Takes the cable out (`false`) or puts it back (`true`).
    Cable {
        /// Whether the cable is in.
        connected: bool,
    },
}

/// Which of the two points of a link's sphere the cursor line meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Towards the viewer.
    Near,
    /// Away from the viewer.
    Far,
}

/// Posing a figure link by link (thesis S3.4–S3.6).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PoseCommand {
    /// Moves the cursor in the front view; the selected link follows. −1…1, y up, before the view's scale.
    Cursor([f64; 2]),
    /// Chooses between the two solutions inside the circle.
    Side(Side),
    /// Fixes the selected link where it is and selects the next one.
    Place,
    /// Selects a link by its place in the figure's order.
    Select(u16),
    /// Selects the next (`1`) or an earlier (`-1`) link, staying inside the figure.
    Step(i32),
    /// Turns the selected link about its own axis, radians, unlimited.
    Twist {
        /// Added to the twist.
        by_rad: f64,
    },
    /// Sets the selected link's direction outright (world axes; need not be unit).
    Direction([f64; 3]),
    /// Sets a link's direction outright, whichever is selected (world axes; need not be unit).
    LinkDirection {
        /// The link, by its place in the figure's order.
        link: u16,
        /// Where it points.
        direction: [f64; 3],
    },
    /// Sets a link's twist about its own axis.
    LinkTwist {
        /// The link, by its place in the figure's order.
        link: u16,
        /// Radians, unlimited.
        twist_rad: f64,
    },
    /// Puts the figure's root at a place, metres.
    Root([f64; 3]),
    /// Moves the figure's root, metres, added.
    RootBy([f64; 3]),
    /// Takes over the pose the clip shows at the present time.
    FromClip,
}

/// A change of the show. Every variant is one step of undo; repeated ones of one gesture are merged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EditCommand {
    /// Stores the pose on screen as a key at `secs` (replaces a key at the same time).
    StoreKey {
        /// Animation time.
        secs: f64,
    },
    /// Stores angles of the puppet's joints as a key of a clip of joints (replaces a key at the same time);
    /// begins such a clip if there is none.
    StoreJoints {
        /// Animation time.
        secs: f64,
        /// Joint names and radians; joints left out pass by this key.
        angles_rad: BTreeMap<String, f64>,
    },
    /// Begins a clip of the puppet's own joints and chooses it.
    BeginJointClip(String),
    /// Gives all keys other times at once; the path stays.
    Retime {
        /// Animation times, one for each key, in order.
        times_secs: Vec<f64>,
    },
    /// Deletes a key.
    DeleteKey {
        /// Its index, earliest first.
        key: usize,
    },
    /// Gives a key another time; it may not pass its neighbours.
    MoveKey {
        /// Its index, earliest first.
        key: usize,
        /// The new animation time.
        secs: f64,
    },
    /// Copies a key to another time.
    CopyKey {
        /// Index of the key copied.
        key: usize,
        /// Animation time of the copy.
        secs: f64,
    },
    /// Adds to a coefficient of the kinetic spline: changes timing, never the path.
    Kinetics {
        /// Coefficient index; the first and last are pinned.
        coefficient: usize,
        /// Added to it, in keys.
        by: f64,
    },
    /// Chooses how key times become the kinetic spline.
    KineticsMode(KineticsMode),
    /// Removes all kinetic adjustments.
    ResetKinetics,
    /// Chooses the clip being edited.
    ChooseClip(String),
}

/// How key times become a kinetic spline; see `motion::kinetics`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum KineticsMode {
    /// Natural cubic: smoothest, may run backwards.
    Natural,
    /// The same, filtered so that time never runs backwards.
    Monotone,
    /// Straight from key to key.
    Linear,
}

/// Playing on screen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TransportCommand {
    /// Runs time.
    Play,
    /// Stops time where it is.
    Pause,
    /// Play if paused, else pause.
    Toggle,
    /// Goes to a time, clamped to the clip.
    Seek {
        /// Animation time.
        secs: f64,
    },
    /// Moves time.
    Nudge {
        /// Added to the animation time.
        by_secs: f64,
    },
    /// Whether playing starts over at the end.
    Loop(bool),
    /// Loop on if off, off if on.
    ToggleLoop,
    /// To the next (`1`) or previous (`-1`) key.
    Key(i32),
    /// Playing speed; 1 is real time.
    Speed(f64),
}

/// Changes the view of the figure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ViewCommand {
    /// Turns the view.
    Turn {
        /// About the vertical axis, radians.
        azimuth_by_rad: f64,
        /// About the screen's horizontal axis, radians.
        elevation_by_rad: f64,
    },
    /// Enlarges (`> 1`) or shrinks the picture.
    Zoom {
        /// Factor on the scale.
        by: f64,
    },
    /// Back to the front view that holds the whole figure.
    Reset,
}

/// Posing a puppet without a figure. It moves live where the puppet follows ([`PuppetCommand::Follow`]), and is
/// stored by [`EditCommand::StoreKey`] where the clip is one of joints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PuppetPose {
    /// Puts a joint at an angle; it stops at its range.
    Joint {
        /// Its name in the puppet profile.
        joint: String,
        /// Radians.
        angle_rad: f64,
    },
    /// Turns a joint; it stops at its range.
    JointBy {
        /// Its name in the puppet profile.
        joint: String,
        /// Radians, added.
        by_rad: f64,
    },
    /// Drags the end of a link somewhere; the joints before it come along as far as they can.
    Drag {
        /// The link's name in the puppet profile.
        link: String,
        /// World axes, metres, as [`crate::PuppetPoseView::ends`].
        to: [f64; 3],
    },
    /// All joints to rest.
    Rest,
    /// Takes over where the servos are.
    FromMeasured,
    /// Takes over the pose that the clip shows at the present time, and goes along with it again.
    FromClip,
}

/// Teaching: torque is off, hands pose the puppet, and what its servos measure is stored.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TeachCommand {
    /// Lets go of the puppet; from now on its own pose is the one on screen.
    Begin,
    /// Stores the measured pose at the present animation time: as a pose of the figure where the puppet follows one,
    /// else of its joints.
    Store {
        /// The animation time then goes on by so much, seconds; 0 stays.
        step_secs: f64,
    },
    /// Lets one joint stand where it is while the others yield to the hand, or lets it yield again. While any joint
    /// is held the servos have torque: the others then follow the hand that moves them. With none held torque is off.
    Hold {
        /// Its name in the puppet profile.
        joint: String,
        /// Whether it is held.
        on: bool,
    },
    /// The pose on screen is no longer the puppet's, and torque is off.
    End,
}

/// Orders to the puppet's player.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PuppetCommand {
    /// Reads where every servo is, pins the goals there, and turns torque on.
    Arm,
    /// Plays the clip from the present animation time, after approaching its pose softly.
    Play,
    /// Follows the figure on screen, live.
    Follow,
    /// Stays where it is.
    Hold,
    /// Slows down and lets go.
    Release,
    /// Stops at once and latches until [`PuppetCommand::Reset`]. Always works.
    Stop,
    /// Leaves the faulted state; torque stays off. Only people do: the network cannot.
    Reset,
    /// A sign of life from outside, for puppets that need one.
    Heartbeat,
    /// Whether goals are taken ahead of time by as much as each joint lags.
    CompensateLag(bool),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn old_journals_have_network_commands_as_text() {
        let text = NetworkEdit::Commands("SEND 1 TO <1>a;".into());
        for (json, edit) in [
            (r#"{"network":"SEND 1 TO <1>a;"}"#, text.clone()),
            (r#"{"network":{"commands":"SEND 1 TO <1>a;"}}"#, text),
            (r#"{"network":"undo"}"#, NetworkEdit::Undo),
        ] {
            let read: Command = serde_json::from_str(json).expect("a command");
            assert_eq!(read, Command::Network(edit), "{json}");
        }
    }
}
