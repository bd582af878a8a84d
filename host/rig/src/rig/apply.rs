//! Doing what is asked: every command and every request of the network ends here.

use std::sync::Arc;

use super::Rig;
use crate::command::{Command, EditCommand, PoseCommand, TransportCommand, ViewCommand};
use crate::document;
use crate::parameters::Request;
use crate::snapshot::NoteLevel;

/// A pause this long ends a movement of the hand: later changes are a step of undo of their own, seconds.
const GESTURE_PAUSE_SECS: f64 = 1.0;
/// Unsaved changes are kept aside this often, seconds.
const AUTOSAVE_SECS: f64 = 20.0;

impl Rig {
    pub(super) fn apply(&mut self, command: &Command) {
        let done = match command {
            Command::Network(edit) => self.edit_network(edit),
            Command::LookAtNetwork(on) => {
                self.look_at_network(*on);
                Ok(())
            }
            Command::Touch { device, touch } => self.touch(device, touch),
            Command::Pose(PoseCommand::FromClip) => {
                self.show_clip();
                Ok(())
            }
            Command::Pose(pose) => self.pose(pose),
            Command::Edit(edit) => self.edit(edit),
            Command::Undo => self.undo(),
            Command::Redo => self.redo(),
            Command::Transport(transport) => self.timeline.apply(transport).map(|moved| {
                if moved {
                    self.show_clip_where_it_runs(transport);
                }
            }),
            Command::View(ViewCommand::Reset) => {
                self.reset_view();
                Ok(())
            }
            Command::View(view) => self.view.apply(view),
            Command::Puppet(order) => {
                self.end_teaching_by(order);
                self.order_puppet(order)
            }
            Command::Teach(teach) => self.teach(teach),
            Command::PuppetPose(pose) => self.pose_puppet(pose),
            Command::SlowToFit => self.slow_to_fit(),
            Command::Learn(_)
            | Command::BindControl(_)
            | Command::UnbindControl { .. }
            | Command::SetControlLabel { .. }
            | Command::Controls(_)
            | Command::TestOutput { .. }
            | Command::PinDevice { .. } => self.control(command),
            Command::StartCapture { devices } => self.start_captures(devices),
            Command::StopCapture { devices } => self.stop_captures(devices),
            Command::CalibrateControl(calibrate) => self.calibrate_control(calibrate),
            Command::Take(take) => self.ask_for_take(take),
            Command::Save => self.save(),
        };
        if let Err(why) = done {
            self.note(NoteLevel::Warning, why);
        }
    }

    pub(super) fn apply_request(&mut self, request: Request) {
        match request {
            Request::Command(command) => self.apply(&command),
            Request::NotForNetworks(why) => self.note(NoteLevel::Warning, why),
            Request::StoreKey => {
                let secs = self.timeline.store_secs();
                self.apply(&Command::Edit(EditCommand::StoreKey { secs }));
            }
            Request::DeleteKey => match self.timeline.key_here() {
                Some(key) => self.apply(&Command::Edit(EditCommand::DeleteKey { key })),
                None => self.note(
                    NoteLevel::Warning,
                    "there is no key at this time; go to one first",
                ),
            },
            Request::KineticStep(step) => {
                let last = self.kinetics_view.coefficients.len().saturating_sub(2).max(1);
                let at = (self.coefficient as i64).saturating_add(i64::from(step));
                self.coefficient = at.clamp(1, last as i64) as usize;
            }
            Request::Azimuth(to_rad) => self.turn_view([to_rad - self.view.azimuth_rad, 0.0]),
            Request::Elevation(to_rad) => self.turn_view([0.0, to_rad - self.view.elevation_rad]),
            Request::SpeedBy(by) => {
                let speed = self.timeline.view().speed + by;
                self.apply(&Command::Transport(TransportCommand::Speed(speed)));
            }
            Request::TwistBy { link, by_rad } => {
                let twist_rad = self.stage.as_ref().and_then(|stage| stage.twist_rad(link));
                if let Some(twist_rad) = twist_rad {
                    let twist_rad = twist_rad + by_rad;
                    self.apply(&Command::Pose(PoseCommand::LinkTwist { link, twist_rad }));
                }
            }
            Request::KineticBy(by) => {
                let coefficient = self.coefficient;
                self.apply(&Command::Edit(EditCommand::Kinetics { coefficient, by }));
            }
        }
    }

    fn turn_view(&mut self, [azimuth_by_rad, elevation_by_rad]: [f64; 2]) {
        self.apply(&Command::View(ViewCommand::Turn {
            azimuth_by_rad,
            elevation_by_rad,
        }));
    }

    /// Seeking inside the clip shows the clip. Outside it there is nothing to see but the held end, so a pose
    /// set up by hand stays, to be stored as a key there.
    fn show_clip_where_it_runs(&mut self, command: &crate::command::TransportCommand) {
        use crate::command::TransportCommand::{Nudge, Seek};
        let t = self.timeline.view();
        let inside = (t.start_secs..=t.end_secs).contains(&t.secs);
        if inside || !self.by_hand() || !matches!(command, Seek { .. } | Nudge { .. }) {
            self.show_clip();
        }
    }

    fn touch(&mut self, device: &str, touch: &crate::command::Touch) -> Result<(), String> {
        let address = self.inputs.address(device).unwrap_or(device).to_owned();
        self.ports
            .touch(&address, touch)
            .map_err(|error| error.to_string())
    }

    fn pose(&mut self, pose: &PoseCommand) -> Result<(), String> {
        let view = self.view.posing_view();
        match &mut self.stage {
            Some(stage) => stage.apply(pose, &view),
            None => Err("this show has no figure to pose".into()),
        }
    }

    fn edit(&mut self, edit: &EditCommand) -> Result<(), String> {
        let pose = self.stage.as_ref().map(|stage| stage.pose().clone());
        let of_joints = self.store_joints(edit);
        let edit = of_joints.as_ref().unwrap_or(edit);
        let edited =
            document::apply(self.history.present(), edit, pose.as_ref()).map_err(|e| e.to_string())?;
        match (edit, &mut self.stage, &mut self.rehearsing) {
            (EditCommand::StoreKey { .. }, Some(stage), _) => stage.stored(),
            (EditCommand::StoreJoints { .. }, _, Some(rehearsing)) => rehearsing.stored(),
            _ => {}
        }
        self.change(edited.show, edited.words, edited.gesture);
        self.set_clip();
        Ok(())
    }

    pub(super) fn change(&mut self, show: document::Show, words: String, gesture: Option<String>) {
        let now_secs = self.secs();
        if now_secs - self.edited_at_secs > GESTURE_PAUSE_SECS {
            self.history.end_gesture();
        }
        self.edited_at_secs = now_secs;
        self.history.push(show, words, gesture);
    }

    pub(super) fn undo(&mut self) -> Result<(), String> {
        let before = Arc::clone(self.history.present());
        self.history.undo().ok_or("there is nothing to undo")?;
        self.changed_from(&before);
        Ok(())
    }

    pub(super) fn redo(&mut self) -> Result<(), String> {
        let before = Arc::clone(self.history.present());
        self.history.redo().ok_or("there is nothing to redo")?;
        self.changed_from(&before);
        Ok(())
    }

    /// Takes over a show that undo or redo brought back, touching only what differs.
    pub(super) fn changed_from(&mut self, before: &Arc<document::Show>) {
        let show = Arc::clone(self.history.present());
        self.network_changed_from(before);
        let clips = show.clips == before.clips && show.joint_clips == before.joint_clips;
        if show.figure == before.figure && clips && show.clip == before.clip {
            return;
        }
        if show.figure != before.figure {
            self.set_stage();
        }
        if let Some(stage) = &mut self.stage {
            // What was undone is to be seen.
            stage.stored();
        }
        if let Some(rehearsing) = &mut self.rehearsing {
            rehearsing.stored();
        }
        self.set_clip();
    }

    fn save(&mut self) -> Result<(), String> {
        let Some(folder) = &self.folder else {
            return Err("this show has no folder yet; start dialrig with one".into());
        };
        document::save(self.history.present(), folder).map_err(|errors| errors.to_string())?;
        self.saved = Arc::clone(self.history.present());
        let words = format!("saved to {}", folder.display());
        self.note(NoteLevel::Info, words);
        Ok(())
    }

    pub(super) fn autosave_if_due(&mut self) {
        let now_secs = self.secs();
        if now_secs - self.autosaved_at_secs < AUTOSAVE_SECS {
            return;
        }
        self.autosaved_at_secs = now_secs;
        let Some(folder) = self
            .folder
            .as_ref()
            .filter(|_| !Arc::ptr_eq(&self.saved, self.history.present()))
        else {
            return;
        };
        if let Err(errors) = document::autosave(self.history.present(), folder) {
            self.note(NoteLevel::Warning, format!("autosave: {errors}"));
        }
    }
}
