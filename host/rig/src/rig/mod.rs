//! The rig: one value that steps.
//!
//! A step has one fixed order, so that the same inputs give the same step: what devices said, by its time and
//! then by their names, into the network; commands; network time; what reached the rig's parameters; animation time; the puppet; feedback
//! to the devices; the snapshot.

mod apply;
mod calibrate;
mod captures;
mod controls;
mod learn;
mod look;
mod network;
mod rehearse;
mod takes;
mod teach;
use teach::Held;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use device::clock::{Clock, Instant};
use device_profiles::Profiles;
use motion::clip::Clip;

use crate::capture::Captures;
use crate::command::Command;
use crate::controls::Controls;
use crate::controls_calibration::{ControlsCalibration, Store};
use crate::desk::Desk;
use crate::document::Show;
use crate::history::History;
use crate::inputs::{Heard, InputError, InputSpec, Inputs};
use crate::journal::Recorder;
use crate::network_look::Looking;
use crate::network_steps::NetworkSteps;
use crate::notes::Notes;
use crate::parameters::Request;
use crate::ports::Ports;
use crate::puppet::{PuppetSetupError, PuppetSpec, Seat};
use crate::snapshot::{NoteLevel, Snapshot, ViewState};
use crate::stage::Stage;
use crate::timeline::Timeline;
use crate::wiring::{DeviceMessage, Wiring, shapes};
use calibrate::Calibrations;
use rehearse::Rehearsing;
use takes::Takes;

/// Longest time one step may cover; a host that slept longer plays on from where it was.
const ELAPSED_SECS_MAX: f64 = 0.25;

/// What a rig begins with.
pub struct RigOptions {
    /// The show.
    pub show: Show,
    /// Where it is saved; `None` for a show without a folder yet.
    pub folder: Option<PathBuf>,
    /// Hardware knowledge.
    pub profiles: Arc<Profiles>,
    /// Input devices to use.
    pub inputs: Vec<InputSpec>,
    /// What was calibrated on input devices, and where that is kept.
    pub calibrations: Store,
    /// The servo puppet to drive.
    pub puppet: Option<PuppetSpec>,
    /// Where to journal; its ports must be the rig's, see [`crate::journal::RecordingPorts`].
    pub recorder: Option<Recorder>,
}

/// A rig cannot begin.
#[derive(Debug, thiserror::Error)]
pub enum RigError {
    /// An input device cannot be used as described.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The puppet cannot be used as described.
    #[error(transparent)]
    Puppet(#[from] PuppetSetupError),
}

/// The rig.
pub struct Rig {
    clock: Arc<dyn Clock>,
    ports: Box<dyn Ports>,
    recorder: Option<Recorder>,
    folder: Option<PathBuf>,
    history: History<Show>,
    /// The show as it is on disk.
    saved: Arc<Show>,
    wiring: Wiring,
    /// What a patch panel was shown last, while there is one.
    looking: Option<Looking>,
    network_steps: NetworkSteps,
    stage: Option<Stage>,
    clip: Option<Arc<Clip>>,
    kinetics_view: crate::snapshot::KineticsView,
    timeline: Timeline,
    view: ViewState,
    desk: Desk,
    controls: Controls,
    calibrations: Calibrations,
    /// The joint that was posed last, while no link was.
    joint_in_hand: Option<String>,
    inputs: Inputs,
    /// What devices said in one step; kept, so that listening does not allocate.
    heard: Vec<Heard>,
    /// What the network asked for in one step, and told devices; kept likewise.
    requests: Vec<Request>,
    device_messages: Vec<DeviceMessage>,
    puppet: Option<Seat>,
    rehearsing: Option<Rehearsing>,
    /// The pose on screen is the puppet's own.
    teaching: bool,
    /// Joints held while teaching, and where.
    held: Held,
    takes: Takes,
    captures: Captures,
    captures_folder: Option<PathBuf>,
    profiles: Arc<Profiles>,
    coefficient: usize,
    notes: Notes,
    began: Instant,
    now: Instant,
    edited_at_secs: f64,
    autosaved_at_secs: f64,
    steps: u64,
}

impl Rig {
    /// Sets everything up; ports are opened by the first step.
    pub fn new(clock: Arc<dyn Clock>, ports: Box<dyn Ports>, options: RigOptions) -> Result<Self, RigError> {
        let RigOptions {
            show,
            folder,
            profiles,
            inputs,
            calibrations,
            puppet,
            recorder,
        } = options;
        if let Some(recorder) = &recorder {
            recorder.calibrations(calibrations.devices());
        }
        let inputs = Inputs::new(inputs, &profiles)?;
        let puppet = puppet
            .map(|spec| Seat::new(spec, &show.demands, &profiles, Arc::clone(&clock)))
            .transpose()?;
        let rehearsing = Rehearsing::of(puppet.as_ref(), &show, &profiles);
        let mut controls = Controls::default();
        for (name, profile) in inputs.devices() {
            controls.add(name, profile);
        }
        let joints = rehearsing.as_ref().map_or(&[][..], |it| it.mannequin().joints());
        let (wiring, remarks) = Wiring::load(&show, joints, &mut controls.instances);
        let began = clock.now();
        let history = History::new(show);
        let mut rig = Self {
            clock,
            ports,
            recorder,
            folder,
            saved: Arc::clone(history.present()),
            history,
            wiring,
            looking: None,
            network_steps: NetworkSteps::default(),
            stage: None,
            clip: None,
            kinetics_view: crate::snapshot::KineticsView::default(),
            timeline: Timeline::default(),
            view: ViewState::default(),
            desk: Desk::default(),
            controls,
            calibrations: Calibrations::new(calibrations),
            joint_in_hand: None,
            inputs,
            heard: Vec::new(),
            requests: Vec::new(),
            device_messages: Vec::new(),
            puppet,
            rehearsing,
            teaching: false,
            held: Held::default(),
            takes: Takes::default(),
            captures: Captures::default(),
            captures_folder: None,
            profiles,
            coefficient: 1,
            notes: Notes::default(),
            began,
            now: began,
            edited_at_secs: 0.0,
            autosaved_at_secs: 0.0,
            steps: 0,
        };
        rig.tell_beginning(remarks);
        rig.set_stage();
        rig.set_clip();
        rig.reset_view();
        Ok(rig)
    }

    /// What is wrong before anything has happened.
    fn tell_beginning(&mut self, remarks: Vec<String>) {
        for remark in remarks {
            self.note(NoteLevel::Warning, remark);
        }
        if let Some(fault) = self.calibrations.fault() {
            self.note(NoteLevel::Error, fault);
        }
    }

    /// One step. Commands are done in the order given.
    pub fn step(&mut self, commands: &mut dyn Iterator<Item = Command>) -> Arc<Snapshot> {
        let commands: Vec<Command> = commands.collect();
        self.go(&commands);
        let snapshot = Arc::new(self.look());
        if let Some(recorder) = &self.recorder {
            recorder.snapshot(&snapshot);
        }
        snapshot
    }

    /// A step that nobody looks at.
    pub(crate) fn go(&mut self, commands: &[Command]) {
        let now = self.clock.now();
        let elapsed_secs = now.since(self.now).as_secs_f64().min(ELAPSED_SECS_MAX);
        self.now = now;
        if let Some(recorder) = &self.recorder {
            recorder.step(now, commands);
        }
        self.hear_devices();
        for command in commands {
            self.apply(command);
            self.learn_parameter(command);
        }
        self.learn_if_touched();
        self.wiring.see_from(&self.view);
        for remark in self.wiring.tick(self.secs()) {
            self.note(NoteLevel::Warning, remark);
        }
        self.take_requests();
        self.advance_time(elapsed_secs);
        self.drive_puppet();
        self.show_taught();
        self.show_on_devices();
        self.go_on_with_takes(commands);
        self.write_captures();
        self.autosave_if_due();
        self.steps += 1;
    }

    /// Machine time since the rig began, seconds.
    fn secs(&self) -> f64 {
        self.now.since(self.began).as_secs_f64()
    }

    fn note(&mut self, level: NoteLevel, text: impl Into<String>) {
        self.notes.add(self.secs(), level, text);
    }

    /// Does what messages at the rig's parameters ask for. Their effects may send again; that is for the next
    /// step, so a loop through the rig cannot hold it up.
    fn take_requests(&mut self) {
        let mut requests = std::mem::take(&mut self.requests);
        self.wiring.requests(&mut requests);
        for request in requests.drain(..) {
            self.apply_request(request);
        }
        self.requests = requests;
        self.take_device_messages();
    }

    fn advance_time(&mut self, elapsed_secs: f64) {
        let was_playing = self.timeline.playing();
        self.timeline.advance(elapsed_secs);
        if was_playing {
            self.show_clip();
        }
    }

    fn drive_puppet(&mut self) {
        self.rehearse();
        let Some(puppet) = &mut self.puppet else { return };
        let posed = self.rehearsing.as_ref().and_then(Rehearsing::posed);
        puppet.follow(self.stage.as_ref().map(Stage::placed), posed);
        let secs = self.now.since(self.began).as_secs_f64();
        for (level, remark) in puppet.advance(self.now, self.ports.as_mut()) {
            self.notes.add(secs, level, remark);
        }
        // The figure on screen goes along with what the puppet performs, unless a hand is posing it.
        let performed_secs = puppet.performed_secs();
        let by_hand = self.by_hand();
        if let Some(performed_secs) = performed_secs.filter(|_| !by_hand)
            && self.timeline.go_along(performed_secs)
        {
            self.show_clip();
        }
    }

    /// Puts the show's figure on stage, in its rest pose.
    fn set_stage(&mut self) {
        let figure = self.history.present().figure.clone();
        self.stage = figure.map(|doc| {
            let (drawn, remarks) = shapes(&doc);
            for remark in remarks {
                self.note(NoteLevel::Warning, remark);
            }
            Stage::new(Arc::clone(&doc.figure), Arc::new(drawn))
        });
        self.lead_puppet();
    }

    /// Builds the playable form of the clip being edited and shows it.
    fn set_clip(&mut self) {
        let show = Arc::clone(self.history.present());
        let of_joints = self.set_joint_clip(&show);
        let built = match (show.current_clip(), &show.figure) {
            (Some(doc), Some(figure)) => doc.clip(&figure.figure),
            _ => Ok(None),
        };
        match built {
            Ok(clip) => self.clip = clip.map(Arc::new),
            // The document refuses edits that give no clip, so this is a file's doing: say it, show nothing.
            Err(error) => {
                self.clip = None;
                self.note(NoteLevel::Error, format!("clip {}: {error}", show.clip));
            }
        }
        self.rehearse_clip(&show);
        self.timeline.set_keys(show.key_times_secs());
        let kinetics = self
            .clip
            .as_ref()
            .map(|clip| clip.kinetics())
            .or(of_joints.as_ref());
        self.kinetics_view = look::kinetics(kinetics);
        let last = self.kinetics_view.coefficients.len().saturating_sub(2).max(1);
        self.coefficient = self.coefficient.clamp(1, last);
        if !self.by_hand() {
            self.show_clip();
        }
    }

    /// Whether a hand is posing the figure or the puppet.
    fn by_hand(&self) -> bool {
        self.stage.as_ref().is_some_and(Stage::posing)
            || self.rehearsing.as_ref().is_some_and(Rehearsing::by_hand)
    }

    /// Shows the clip's pose at the present time.
    fn show_clip(&mut self) {
        if let (Some(stage), Some(clip)) = (&mut self.stage, &self.clip) {
            stage.show_clip(clip, self.timeline.secs());
        }
        if let Some(rehearsing) = &mut self.rehearsing {
            rehearsing.show(self.timeline.secs());
        }
    }

    fn reset_view(&mut self) {
        self.view = match (&self.history.present().view, &self.stage, &mut self.rehearsing) {
            (Some(view), ..) => view.clone(),
            (None, Some(stage), _) => ViewState::holding(stage.placed()),
            (None, None, Some(rehearsing)) => ViewState::beside(&rehearsing.pose_view().bones),
            (None, None, None) => ViewState::default(),
        };
    }

    /// The network and all that was done to it, as text that loads to the same behaviour.
    pub fn network_text(&self) -> String {
        self.wiring.text()
    }

    /// What was calibrated on input devices, by what they are known by.
    pub fn calibrated(&self) -> &BTreeMap<String, ControlsCalibration> {
        self.calibrations.all()
    }

    /// The show as it is now.
    pub fn show(&self) -> &Arc<Show> {
        self.history.present()
    }

    /// Lets go of the puppet and every port. Returns whether torque is known to be off.
    pub fn close(mut self) -> bool {
        if let Err(error) = self.stop_captures(&self.captures.running()) {
            tracing::debug!("{error}");
        }
        let closed = self
            .puppet
            .as_mut()
            .is_none_or(|puppet| puppet.close(&*self.clock));
        if let Some(recorder) = &self.recorder
            && let Err(error) = recorder.finish()
        {
            tracing::error!("journal: {error}");
        }
        closed
    }
}
