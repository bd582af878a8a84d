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
        Err(format!("{device} has no controls in the network"))
    }
}
