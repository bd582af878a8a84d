//! What is asked of physical controls.

use super::Rig;
use crate::command::Command;

impl Rig {
    pub(super) fn control(&mut self, command: &Command) -> Result<(), String> {
        let device = match command {
            Command::BindControl(binding) => &binding.device,
            Command::UnbindControl { device, .. }
            | Command::SetControlLabel { device, .. }
            | Command::TestOutput { device, .. }
            | Command::PinDevice { device, .. } => device,
            _ => return Err("no device has controls in the network".into()),
        };
        let devices = self.inputs.view();
        Err(if devices.iter().any(|it| it.name == *device) {
            format!("{device} has no controls in the network")
        } else {
            format!("there is no input device {device}")
        })
    }
}
