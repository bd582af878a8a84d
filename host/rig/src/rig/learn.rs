//! Learning and binding: controls and parameters that were touched become connections of the network.

use ps300::value::Value;

use super::Rig;
use crate::command::{
    Binding, Command, EditCommand, LearnCommand, NetworkEdit, PoseCommand, PuppetPose, TransportCommand,
    ViewCommand,
};
use crate::controls::drive;
use crate::controls::inlets::PAGES;
use crate::controls::learn::{self, Goal, Hand};
use crate::controls::view::LearningView;
use crate::snapshot::NoteLevel;

impl Rig {
    pub(super) fn learning_view(&self) -> Option<LearningView> {
        let learning = self.controls.learning.as_ref()?;
        Some(LearningView {
            control: learning.control.clone(),
            parameter: learning.parameter.clone(),
        })
    }

    pub(super) fn learn(&mut self, learn: &LearnCommand) -> Result<(), String> {
        match learn {
            LearnCommand::Begin => self.controls.learn(true),
            LearnCommand::Cancel => self.controls.learn(false),
            LearnCommand::Control { device, control } => {
                self.place_of(device)?;
                let learning = self.controls.learning.get_or_insert_default();
                learning.control = Some((device.clone(), *control));
            }
            LearnCommand::Parameter { name, inlet } => {
                let learning = self.controls.learning.get_or_insert_default();
                learning.parameter = Some((name.clone(), *inlet));
            }
        }
        Ok(())
    }

    /// While something is learnt, whatever a person moves is the parameter meant.
    pub(super) fn learn_parameter(&mut self, command: &Command) {
        let joint = match command {
            Command::PuppetPose(PuppetPose::Joint { joint, .. } | PuppetPose::JointBy { joint, .. }) => {
                Some(joint)
            }
            _ => None,
        };
        if let Some(joint) = joint {
            self.joint_in_hand = Some(joint.clone());
        } else if matches!(command, Command::Pose(_)) {
            self.joint_in_hand = None;
        }
        if self
            .controls
            .learning
            .as_ref()
            .is_none_or(|it| it.parameter.is_some())
        {
            return;
        }
        let parameter = self.parameter_of(command);
        if let Some(learning) = &mut self.controls.learning {
            learning.parameter = parameter;
        }
    }

    /// The inlet that does what a command does.
    fn parameter_of(&self, command: &Command) -> Option<(String, u8)> {
        let link = |link: u16| {
            let links = self.stage.as_ref()?.figure().links();
            Some((format!("FIGURE.{}", links.get(usize::from(link))?.name), 2))
        };
        let known = |name: &str, inlet| Some((name.to_owned(), inlet));
        match command {
            Command::Transport(TransportCommand::Seek { .. } | TransportCommand::Nudge { .. }) => {
                known("TIME", 2)
            }
            Command::Transport(
                TransportCommand::Play | TransportCommand::Pause | TransportCommand::Toggle,
            ) => known("TIME", 3),
            Command::Transport(TransportCommand::Key(_)) => known("TIME", 4),
            Command::Transport(TransportCommand::Loop(_) | TransportCommand::ToggleLoop) => known("TIME", 5),
            Command::Transport(TransportCommand::Speed(_)) => known("TIME", 6),
            Command::View(ViewCommand::Turn {
                azimuth_by_rad,
                elevation_by_rad,
            }) => known(
                "VIEW",
                if elevation_by_rad.abs() > azimuth_by_rad.abs() {
                    6
                } else {
                    5
                },
            ),
            Command::View(ViewCommand::Reset) => known("VIEW", 4),
            Command::Pose(PoseCommand::LinkTwist { link: at, .. }) => link(*at),
            Command::Pose(PoseCommand::Twist { .. }) => link(self.stage.as_ref()?.selected()),
            Command::Pose(PoseCommand::Place) => known("POSE", 3),
            Command::Pose(PoseCommand::Step(_)) => known("POSE", 4),
            Command::PuppetPose(PuppetPose::Joint { joint, .. } | PuppetPose::JointBy { joint, .. }) => {
                Some((format!("PUPPET.{joint}"), 1))
            }
            Command::Edit(EditCommand::StoreKey { .. }) => known("KEYS", 1),
            _ => None,
        }
    }

    /// Connects what was touched, once both ends were.
    pub(super) fn learn_if_touched(&mut self) {
        let learning = self.controls.learning.as_ref();
        let Some((Some((device, control)), Some((to, inlet)))) =
            learning.map(|it| (it.control.clone(), it.parameter.clone()))
        else {
            return;
        };
        self.controls.learn(false);
        let binding = Binding {
            device,
            control,
            page: None,
            to,
            inlet,
            range: None,
        };
        if let Err(why) = self.bind(&binding) {
            self.note(NoteLevel::Warning, why);
        }
    }

    pub(super) fn bind(&mut self, binding: &Binding) -> Result<(), String> {
        let instance = self.instance_of(&binding.device)?;
        let page = binding.page.unwrap_or(instance.pages.now);
        if !(1..=PAGES).contains(&page) {
            return Err(format!("{} has pages 1 to {PAGES}, not {page}", binding.device));
        }
        let name = crate::controls::inlets::instance(&instance.name, page);
        let control = instance.controls.iter().find(|it| it.number == binding.control);
        let control =
            control.ok_or_else(|| format!("{} has no control {}", binding.device, binding.control))?;
        let (kind, mode, modes) = (control.kind, control.mode(), format!("{}_MODE", instance.name));
        let machine = self.wiring.machine();
        if !machine.is_defined(&binding.to) {
            return Err(format!("the network has nothing called {}", binding.to));
        }
        let drive = drive::drive(&binding.to, binding.inlet);
        let read_at = drive::read_at(&binding.to, binding.inlet);
        let stands = read_at.and_then(|at| self.stands(&binding.to, at));
        let held = machine
            .front(&binding.to, binding.inlet)
            .and_then(Value::as_number);
        let goal = Goal {
            name: &binding.to,
            inlet: binding.inlet,
            sort: drive.map(|it| it.sort),
            range: binding.range.or(stands.and_then(|(_, range)| range)),
            value: stands.map(|(value, _)| value).or(held),
        };
        let hand = Hand {
            instance: &name,
            number: binding.control,
            kind,
            rate: learn::goes_by_speed(kind, mode, binding.range.is_some()),
        };
        let mut commands = self.parting(&name, binding.control);
        let made = learn::connection(hand, &goal)?;
        let wanted = learn::mode_for(hand, goal.sort, mode);
        if mode != wanted {
            commands.push(ps300::Command::Send {
                payload: ps300::language::Payload::Value(Value::from(wanted)),
                to: learn::input(&modes, binding.control),
            });
        }
        commands.extend(made);
        self.edit_network(&NetworkEdit::Commands(learn::text(&commands)))?;
        let words = format!(
            "{} {} drives {}<{}>",
            binding.device, binding.control, binding.to, binding.inlet
        );
        self.note(NoteLevel::Info, words);
        Ok(())
    }

    pub(super) fn unbind(&mut self, device: &str, control: u8) -> Result<(), String> {
        let name = self.instance_of(device)?.page_name();
        let commands = self.parting(&name, control);
        if commands.is_empty() {
            return Err(format!("{name}<{control}> drives nothing"));
        }
        self.edit_network(&NetworkEdit::Commands(learn::text(&commands)))
    }

    fn parting(&self, name: &str, control: u8) -> Vec<ps300::Command> {
        let machine = self.wiring.machine();
        let outlet = machine.outlet(name, control);
        let wired = outlet.is_some_and(|outlet| machine.listeners(outlet) > 0);
        learn::parted(name, control, &|name| machine.is_defined(name), wired)
    }
}
