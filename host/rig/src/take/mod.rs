//! Takes: performances kept as what the devices said, not as what became of it.
//!
//! A take is the bytes of every device with the times they arrived, the commands people gave meanwhile, and how
//! network, figure and time stood when it began. From these a rig without devices does the performance again, in a
//! time of its own, through the same network or a changed one; the poses it goes through are thinned to keys. Keys
//! always come from such a re-run, also when a take has just been made: so the same take through the same network
//! gives the same keys, to the last bit.
//!
//! *Knows* what a device said since it was opened (`tape`), and how a rig is put into a former state (`rerun`).
//! *Must not know* formats: what the bytes mean is the codecs' business.
//! *Start reading* at [`Take`], then `rerun`.

mod file;
mod keys;
mod reel;
mod rerun;
mod tape;

pub use keys::TakeTolerance;
pub(crate) use keys::{Keyed, Keying, Posed};
pub(crate) use reel::Mark;
pub use reel::Reel;
pub(crate) use rerun::Rerun;
pub(crate) use tape::{Conversation, Tapes};

pub(crate) use file::{read, write};

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use motion::FigurePose;

use crate::command::{Command, Side};
use crate::controls::standing::DeviceStanding;
use crate::controls_calibration::ControlsCalibration;
use crate::snapshot::{TransportView, ViewState};

/// Steps one take may have: an hour and more at 200 a second.
pub(crate) const STEPS_MAX: usize = 1_000_000;

/// One performance.
#[derive(Clone, Debug, PartialEq)]
pub struct Take {
    /// How everything stood when it began.
    pub start: Arc<Start>,
    /// When the rig stepped, since the rig began; the first step after the beginning comes first.
    pub steps: Vec<Duration>,
    /// What people asked for meanwhile, and in which of the steps.
    pub commands: Vec<(usize, Command)>,
    /// What the devices said, by the name the rig gave them.
    pub devices: BTreeMap<String, Heard>,
}

/// How everything stood.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// When, since the rig began. All times of a take are told so.
    pub at: Duration,
    /// Frames the network had counted.
    pub frame: u64,
    /// The network's program.
    pub program: String,
    /// The network as it ran, sums and waiting messages included.
    pub network: String,
    /// The clip being edited, which the figure was shown in.
    pub clip: String,
    /// The figure on stage; `None` for a show without.
    pub stage: Option<StageStart>,
    /// The puppet's joints posed on screen, radians, and whether a hand had posed them.
    pub joints_rad: BTreeMap<String, f64>,
    /// A hand had posed the joints.
    pub joints_by_hand: bool,
    /// Where in time the figure was.
    pub transport: TransportView,
    /// From where it was looked at.
    pub view: ViewState,
    /// The kinetic coefficient selected.
    pub coefficient: usize,
    /// The number of the rig's first step in it.
    pub step: u64,
    /// Fine gear for all controls.
    pub fine: bool,
    /// The link or joint that pages of controls went by.
    pub focus: String,
    /// The joint that was posed last, while no link was.
    pub joint_in_hand: Option<String>,
    /// How the controls of each device stood, by the name the rig gave it.
    pub controls: BTreeMap<String, DeviceStanding>,
}

/// How the figure stood, and the hands on it.
#[derive(Clone, Debug, PartialEq)]
pub struct StageStart {
    /// Its pose.
    pub pose: FigurePose,
    /// The link in hand.
    pub selected: u16,
    /// The side chosen of the link's sphere.
    pub side: Side,
    /// Where the cursor was last.
    pub cursor: Option<[f64; 2]>,
    /// The pose is a hand's, not the clip's.
    pub posing: bool,
}

/// What one device said.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heard {
    /// Its profile.
    pub profile: String,
    /// Where it was.
    pub address: String,
    /// Whether its line keeps reports apart.
    pub reports: bool,
    /// What was calibrated on it when the take began.
    pub calibration: ControlsCalibration,
    /// When its line was opened.
    pub opened: Duration,
    /// What it had said before, as far as the meaning of the rest needs it.
    pub before: Reel,
    /// What it said during the take.
    pub during: Reel,
}

impl Take {
    /// From its beginning to its last step, seconds.
    pub fn duration_secs(&self) -> f64 {
        let end = self.steps.last().copied().unwrap_or(self.start.at);
        end.saturating_sub(self.start.at).as_secs_f64()
    }

    /// Bytes and answers in it.
    pub fn records(&self) -> usize {
        self.devices.values().map(|heard| heard.during.len()).sum()
    }
}
