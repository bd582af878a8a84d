//! Commands about commands: BEGIN … END, OPTIMIZE STRUCTURE, COMMAND STATUS, !RESET.
//!
//! Commands of a group take effect one after the other, but the network does not run between them, and the
//! picture stays as it was until the last END.

use super::execute::Done;
use super::{ExecuteError, Machine};
use crate::language::{Command, Input, Name};
use crate::network::{InputPort, Role};
use crate::value::Value;

/// What has been begun and not ended.
#[derive(Default)]
pub(super) struct Open {
    /// BEGINs without their END.
    groups: u32,
    /// The revision of the picture at the first of them.
    revision: u64,
    optimize: bool,
}

impl Open {
    /// Whether commands wait for an END before the network runs.
    pub(super) fn in_group(&self) -> bool {
        self.groups > 0
    }

    /// The revision of the picture that hosts may see.
    pub(super) fn revision(&self, now: u64) -> u64 {
        if self.in_group() { self.revision } else { now }
    }
}

impl Machine {
    pub(super) fn group(&mut self, command: &Command) -> Done {
        match command {
            Command::BeginGroup => {
                if !self.open.in_group() {
                    self.open.revision = self.structure.revision;
                }
                self.open.groups += 1;
            }
            Command::EndGroup => match self.open.groups.checked_sub(1) {
                Some(left) => self.open.groups = left,
                None => return nothing("there is no BEGIN to this END"),
            },
            Command::Optimize => self.open.optimize = true,
            Command::EndOptimize => {
                if !std::mem::take(&mut self.open.optimize) {
                    return nothing("there is no OPTIMIZE STRUCTURE to this END OPTIMIZE");
                }
            }
            // Memory need not be reserved here; polygons are rendered without.
            Command::ReserveWorkingStorage { .. } => {}
            Command::CommandStatus => {
                let status = Value::from(self.status().as_str());
                return self.deliver(&Name::new("MESSAGE_DISPLAY"), Input::Number(1), &status);
            }
            _ => self.open = Open::default(),
        }
        Ok(())
    }

    /// Ends what a text has begun and not ended; true if there was anything.
    pub(super) fn end_groups(&mut self) -> bool {
        let open = self.open.in_group();
        if open {
            self.open.groups = 0;
            let firings = self.network.limits.firings_per_command;
            super::with_network!(self, |network, around| network.run_command(firings, around));
        }
        open
    }

    /// What COMMAND STATUS writes on the message line: what is open, and how much there is.
    pub fn status(&self) -> String {
        let instances = self.network.instances();
        let of = |role: Role| instances.iter().filter(|it| it.instance.role == role).count();
        let ports = instances.iter().flat_map(|it| it.instance.input_ports());
        let waiting: usize = ports.map(InputPort::waiting).sum();
        let groups = match self.open.groups {
            0 => String::new(),
            1 => "a group is open; ".to_owned(),
            groups => format!("{groups} groups are open; "),
        };
        let optimize = if self.open.optimize {
            "OPTIMIZE STRUCTURE is open; "
        } else {
            ""
        };
        format!(
            "{groups}{optimize}{} functions, {} variables, {} connections, {waiting} messages wait",
            of(Role::Function),
            of(Role::Variable),
            self.connections().len(),
        )
    }
}

fn nothing(what: &str) -> Done {
    Err(ExecuteError::Nothing {
        what: what.to_owned(),
    })
}
