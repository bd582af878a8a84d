//! Takes on the running rig: recorded, done again, and kept in the show as a step of undo.
//!
//! Nothing of it holds up a step: a re-run goes on a few steps at a time beside the rig's own, and so does thinning.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use super::{Rehearsing, Rig};
use crate::command::{Command, ControlCommand, TakeCommand};
use crate::controls::instance::Instance;
use crate::controls_calibration::ControlsCalibration;
use crate::document::{Show, is_file_name};
use crate::snapshot::{NoteLevel, TakeView};
use crate::stage::Stage;
use crate::take::{Heard, Keyed, Keying, Mark, Posed, Rerun, STEPS_MAX, Start, Take, TakeTolerance, Tapes};
use crate::wiring::Wiring;

/// Steps that a re-run takes in one step of the rig: a minute is done again in three seconds.
const RERUN_STEPS: usize = 20;
/// Poses looked at for thinning in one step of the rig, about a millisecond's work.
const THIN_POSES: usize = 1000;

/// Everything about takes that a rig keeps besides the show.
#[derive(Default)]
pub(super) struct Takes {
    pub(super) tapes: Tapes,
    recording: Option<Box<Recording>>,
    working: Option<Box<Working>>,
    /// Asked for in this step; done at its end, so that a take has whole steps.
    asked: Vec<TakeCommand>,
}

/// A take that is being made.
struct Recording {
    name: String,
    tolerance: TakeTolerance,
    start: Arc<Start>,
    steps: Vec<Duration>,
    commands: Vec<(usize, Command)>,
    /// The devices: where each is and from where on its tape belongs to the take.
    marks: BTreeMap<String, Marked>,
    /// A digest of the pose after each step, as people saw it.
    seen: Vec<u64>,
}

struct Marked {
    profile: String,
    calibration: ControlsCalibration,
    address: String,
    from: Mark,
}

/// A take that becomes keys.
struct Working {
    take: Arc<Take>,
    name: String,
    clip: String,
    tolerance: TakeTolerance,
    /// What was seen when it was made; none when an older take is done again.
    seen: Option<Vec<u64>>,
    phase: Phase,
}

enum Phase {
    Again(Box<Rerun>),
    Thinning(Keying),
}

impl Rig {
    pub(super) fn ask_for_take(&mut self, command: &TakeCommand) -> Result<(), String> {
        let takes = &self.takes;
        match command {
            TakeCommand::Start { name, .. } => {
                if !is_file_name(name) {
                    return Err(format!(
                        "`{name}` cannot be the name of a take; letters, digits, spaces, - and _ can"
                    ));
                }
                if takes.recording.is_some() || takes.working.is_some() {
                    return Err("a take is being made already; stop it first, or wait for its keys".into());
                }
                if self.calibrations.view().is_some() {
                    return Err(
                        "a control is being calibrated, which no take keeps; keep what came of it, or cancel it"
                            .into(),
                    );
                }
                if self.teaching {
                    return Err(
                        "while teaching, poses come from the puppet, which no take keeps; end it first"
                            .into(),
                    );
                }
                if self.posed().is_none() {
                    return Err("this show has neither a figure nor a puppet to pose".into());
                }
            }
            TakeCommand::Stop if takes.recording.is_none() => return Err("no take is being made".into()),
            TakeCommand::Rerun { take, .. } => {
                self.known_take(take)?;
                if takes.recording.is_some() || takes.working.is_some() {
                    return Err("a take is being made already; stop it first, or wait for its keys".into());
                }
            }
            TakeCommand::Stop => {}
            TakeCommand::Delete(name) => {
                self.known_take(name)?;
                let show = self.history.present().without_take(name);
                self.change(show, format!("Delete take {name}"), None);
                return Ok(());
            }
        }
        self.takes.asked.push(command.clone());
        Ok(())
    }

    fn known_take(&self, name: &str) -> Result<Arc<Take>, String> {
        let takes = &self.history.present().takes;
        let known = || takes.keys().cloned().collect::<Vec<_>>().join(", ");
        takes
            .get(name)
            .cloned()
            .ok_or_else(|| format!("there is no take `{name}`; there are: {}", known()))
    }

    /// The end of a step, as far as takes go.
    pub(super) fn go_on_with_takes(&mut self, commands: &[Command]) {
        self.record_step(commands);
        for asked in std::mem::take(&mut self.takes.asked) {
            let done = match asked {
                TakeCommand::Start {
                    name,
                    devices,
                    tolerance,
                } => self.start_take(name, &devices, tolerance),
                TakeCommand::Stop => self.stop_take(),
                TakeCommand::Rerun {
                    take,
                    clip,
                    tolerance,
                } => self.rerun_take(take, clip, tolerance),
                TakeCommand::Delete(_) => Ok(()),
            };
            if let Err(why) = done {
                self.note(NoteLevel::Warning, why);
            }
        }
        if let Err(why) = self.work_on_take() {
            self.takes.working = None;
            self.note(NoteLevel::Warning, why);
        }
    }

    fn record_step(&mut self, commands: &[Command]) {
        let posed = self.takes.recording.as_ref().and_then(|_| self.posed());
        let now = self.now.since(self.began);
        let Some(recording) = &mut self.takes.recording else {
            return;
        };
        let step = recording.steps.len();
        recording.steps.push(now);
        let kept = commands.iter().filter(|command| belongs_to_performance(command));
        recording
            .commands
            .extend(kept.map(|command| (step, command.clone())));
        recording.seen.extend(posed.map(|posed| posed.bits()));
        let full = recording
            .marks
            .keys()
            .any(|device| self.takes.tapes.is_full(device));
        if full || step + 1 >= STEPS_MAX {
            self.note(
                NoteLevel::Warning,
                "this take is as long as a take may be; it ends here",
            );
            self.takes.asked.push(TakeCommand::Stop);
        }
    }

    fn start_take(
        &mut self,
        name: String,
        devices: &[String],
        tolerance: Option<TakeTolerance>,
    ) -> Result<(), String> {
        let views = self.inputs.view();
        if let Some(unknown) = devices
            .iter()
            .find(|name| !views.iter().any(|view| view.name == **name))
        {
            let known: Vec<&str> = views.iter().map(|view| view.name.as_str()).collect();
            return Err(format!(
                "there is no device `{unknown}`; there are: {}",
                known.join(", ")
            ));
        }
        let chosen = views
            .iter()
            .filter(|view| devices.is_empty() || devices.contains(&view.name));
        let mut marks = BTreeMap::new();
        for view in chosen {
            if let Some(from) = self.takes.tapes.hold(&view.name) {
                let marked = Marked {
                    profile: view.profile.clone(),
                    calibration: self.calibration_for_take(&view.name),
                    address: view.address.clone(),
                    from,
                };
                marks.insert(view.name.clone(), marked);
            }
        }
        if marks.is_empty() {
            return Err("no device is there to be recorded; plug one in".into());
        }
        let start = Arc::new(self.standing());
        self.takes.recording = Some(Box::new(Recording {
            name,
            tolerance: tolerance.unwrap_or_default(),
            start,
            steps: Vec::new(),
            commands: Vec::new(),
            marks,
            seen: Vec::new(),
        }));
        Ok(())
    }

    fn stop_take(&mut self) -> Result<(), String> {
        let Some(recording) = self.takes.recording.take() else {
            return Ok(());
        };
        let Recording {
            name,
            tolerance,
            start,
            steps,
            commands,
            marks,
            seen,
        } = *recording;
        let tapes = &self.takes.tapes;
        let mut devices = BTreeMap::new();
        for (device, marked) in marks {
            let heard = tapes.heard(&device, marked.from).map(|heard| Heard {
                profile: marked.profile,
                calibration: marked.calibration,
                address: marked.address,
                ..heard
            });
            tapes.let_go(&device);
            devices.extend(heard.map(|heard| (device, heard)));
        }
        if steps.is_empty() {
            return Err(format!("take {name} has no step and is dropped"));
        }
        let take = Arc::new(Take {
            start,
            steps,
            commands,
            devices,
        });
        self.work(take, name.clone(), name, tolerance, Some(seen))
    }

    fn rerun_take(
        &mut self,
        name: String,
        clip: Option<String>,
        tolerance: Option<TakeTolerance>,
    ) -> Result<(), String> {
        let take = self.known_take(&name)?;
        let clip = clip.unwrap_or_else(|| name.clone());
        if !is_file_name(&clip) {
            return Err(format!(
                "`{clip}` cannot be the name of a clip; letters, digits, spaces, - and _ can"
            ));
        }
        self.work(take, name, clip, tolerance.unwrap_or_default(), None)
    }

    fn work(
        &mut self,
        take: Arc<Take>,
        name: String,
        clip: String,
        tolerance: TakeTolerance,
        seen: Option<Vec<u64>>,
    ) -> Result<(), String> {
        let rerun = Rerun::new(Arc::clone(&take), self.history.present(), &self.profiles)?;
        self.takes.working = Some(Box::new(Working {
            take,
            name,
            clip,
            tolerance,
            seen,
            phase: Phase::Again(Box::new(rerun)),
        }));
        Ok(())
    }

    /// One step's piece of a re-run or of thinning.
    fn work_on_take(&mut self) -> Result<(), String> {
        let Some(mut working) = self.takes.working.take() else {
            return Ok(());
        };
        let next = match &mut working.phase {
            Phase::Again(rerun) => {
                if rerun.advance(RERUN_STEPS)? {
                    let (keys, bits) = rerun.finish().ok_or("this take shows nothing")?;
                    if let Some(step) = working
                        .seen
                        .as_ref()
                        .and_then(|seen| first_difference(seen, &bits))
                    {
                        self.tell_difference(&working.take, step);
                    }
                    let figure = self
                        .history
                        .present()
                        .figure
                        .as_ref()
                        .map(|doc| Arc::clone(&doc.figure));
                    let keying = Keying::new(keys, figure.as_ref(), working.tolerance);
                    Some(Phase::Thinning(keying.map_err(|error| error.to_string())?))
                } else {
                    None
                }
            }
            Phase::Thinning(keying) => {
                let done = keying.advance(THIN_POSES).map_err(|error| error.to_string())?;
                if let Some(keyed) = done {
                    self.keep_take(&working, keyed);
                    return Ok(());
                }
                None
            }
        };
        if let Some(phase) = next {
            working.phase = phase;
        }
        self.takes.working = Some(working);
        Ok(())
    }

    /// What was seen and what comes of doing it again are not the same: something took part that a take does not
    /// keep, such as a puppet's own pose or a change of the network meanwhile.
    fn tell_difference(&mut self, take: &Take, step: usize) {
        let secs = take.steps.get(step).copied().unwrap_or_default();
        let secs = secs.saturating_sub(take.start.at).as_secs_f64();
        let words = format!(
            "from {secs:.2} s on the keys of this take are not quite what was seen: it was done again from what the devices said alone"
        );
        self.note(NoteLevel::Warning, words);
    }

    fn keep_take(&mut self, working: &Working, keyed: Keyed) {
        let (poses, keys) = (working.take.steps.len() + 1, keyed.len());
        let mut show = Show::clone(self.history.present());
        show.put_clip(&working.clip, keyed);
        let new = working.seen.is_some();
        if new {
            show.takes.insert(working.name.clone(), Arc::clone(&working.take));
        }
        let words = if new {
            format!("Record take {}", working.name)
        } else {
            format!("Re-run take {}", working.name)
        };
        let before = Arc::clone(self.history.present());
        self.change(show, words, None);
        self.settle(&before);
        let told = format!(
            "take {}: {poses} poses became {keys} keys of clip {}",
            working.name, working.clip
        );
        self.note(NoteLevel::Info, told);
    }

    /// Whoever looks on sees the clip that came of it.
    fn settle(&mut self, before: &Arc<Show>) {
        self.changed_from(before);
        self.timeline.go_to_start();
        self.show_clip();
    }

    pub(super) fn take_view(&self) -> Option<TakeView> {
        if let Some(recording) = &self.takes.recording {
            let now = self.now.since(self.began);
            return Some(TakeView {
                name: recording.name.clone(),
                recording: true,
                secs: now.saturating_sub(recording.start.at).as_secs_f64(),
                devices: recording.marks.keys().cloned().collect(),
            });
        }
        self.takes.working.as_ref().map(|working| TakeView {
            name: working.name.clone(),
            recording: false,
            secs: working.take.duration_secs(),
            devices: working.take.devices.keys().cloned().collect(),
        })
    }

    /// The pose on screen, of whatever a stored key would be of.
    pub(crate) fn posed(&self) -> Option<Posed> {
        let show = self.history.present();
        let of_joints = show.current_joint_clip().is_some() || show.figure.is_none();
        match (&self.stage, &self.rehearsing) {
            (Some(stage), _) if !of_joints => Some(Posed::Figure(stage.shared_pose())),
            (_, Some(rehearsing)) => Some(Posed::Joints(rehearsing.key())),
            _ => None,
        }
    }

    /// How everything stands that a performance begins from.
    fn standing(&self) -> Start {
        let show = self.history.present();
        let (network, frame) = self.wiring.standing();
        Start {
            at: self.now.since(self.began),
            frame,
            program: show.program_text(),
            network,
            clip: show.clip.clone(),
            stage: self.stage.as_ref().map(Stage::standing),
            joints_rad: self.rehearsing.as_ref().map(Rehearsing::key).unwrap_or_default(),
            joints_by_hand: self.rehearsing.as_ref().is_some_and(Rehearsing::by_hand),
            transport: self.timeline.standing(),
            view: self.view.clone(),
            coefficient: self.coefficient,
            step: self.steps + 1,
            fine: self.controls.fine,
            focus: self.controls.focus().to_owned(),
            joint_in_hand: self.joint_in_hand.clone(),
            controls: self.controls.standing().collect(),
        }
    }

    /// Goes on from how everything stood. The network becomes the show's, as if it had been changed just now.
    pub(crate) fn resume(&mut self, start: &Start) {
        let show = Arc::clone(self.history.present());
        let joints = self
            .rehearsing
            .as_ref()
            .map(|it| it.mannequin().joints().to_vec());
        self.controls.rename(&|device| start.controls.get(device));
        self.wiring = Wiring::resume(
            &show,
            &joints.unwrap_or_default(),
            &mut self.controls.instances,
            &start.network,
            (start.at.as_secs_f64(), start.frame),
        );
        self.controls.forget_wires();
        self.timeline.resume(&start.transport);
        self.view = start.view.clone();
        self.coefficient = start.coefficient;
        if let (Some(stage), Some(standing)) = (&mut self.stage, &start.stage) {
            stage.resume(standing);
        }
        if let Some(rehearsing) = &mut self.rehearsing {
            rehearsing.resume(&start.joints_rad, start.joints_by_hand);
        }
        self.joint_in_hand.clone_from(&start.joint_in_hand);
        self.now = self.clock.now();
        self.steps = start.step;
        self.resume_controls(start);
        let program = show.program_text();
        if program != start.program {
            for found in self.wiring.edit_program(&start.program, &program) {
                self.note(NoteLevel::Warning, found.to_string());
            }
            self.tell_devices_again(&[start.program.clone(), program]);
        }
    }

    /// Controls as they stood, in the network as it was: what has changed in it since lets go of them afterwards.
    fn resume_controls(&mut self, start: &Start) {
        self.controls.fine = start.fine;
        let stood = |instance: &Instance| start.controls.get(&instance.device);
        for instance in &mut self.controls.instances {
            if let Some(stood) = stood(instance) {
                instance.resume_page(stood);
            }
        }
        if !start.controls.is_empty() {
            self.controls.resume_focus(&start.focus);
        }
        self.refresh_bindings();
        for instance in &mut self.controls.instances {
            if let Some(stood) = stood(instance) {
                instance.resume_controls(stood);
            }
        }
    }

    /// Looks for devices that are away in every step.
    pub(crate) fn look_in_every_step(&mut self) {
        self.inputs.look_in_every_step();
    }

    /// Hears devices and does nothing else: what was said before a take.
    pub(crate) fn hear_only(&mut self) {
        self.now = self.clock.now();
        self.hear_devices();
    }
}

/// Where two rows of digests part, if they do.
fn first_difference(seen: &[u64], again: &[u64]) -> Option<usize> {
    let same = seen.iter().zip(again).take_while(|(a, b)| a == b).count();
    (same < seen.len().max(again.len())).then_some(same)
}

/// Whether a command is part of what is performed. Devices are heard themselves, a puppet is not part of a re-run,
/// and which network is performed through, with all that is set in it, is chosen when it is done again.
fn belongs_to_performance(command: &Command) -> bool {
    !matches!(
        command,
        Command::Network(_)
            | Command::LookAtNetwork(_)
            | Command::Touch { .. }
            | Command::Undo
            | Command::Redo
            | Command::Puppet(_)
            | Command::Teach(_)
            | Command::SlowToFit
            | Command::Learn(_)
            | Command::BindControl(_)
            | Command::UnbindControl { .. }
            | Command::SetControlLabel { .. }
            | Command::Controls(
                ControlCommand::Mode { .. }
                    | ControlCommand::Gear { .. }
                    | ControlCommand::Curve { .. }
                    | ControlCommand::PageFor { .. }
            )
            | Command::TestOutput { .. }
            | Command::PinDevice { .. }
            | Command::StartCapture { .. }
            | Command::StopCapture { .. }
            | Command::Save
            | Command::Take(_)
    )
}
