//! Devices and joints that a program speaks of, where nobody can know which there are: for judging a file without
//! the rig it is for.
//!
//! A device is assumed for a sender in capitals that nothing defines and no device of every machine is nearly called
//! like, so that a misspelt name is still one.

use std::collections::BTreeSet;

use ps300::language::{Command, Definition, Located, Name};
use ps300::machine::Machine;
use ps300::value::Kinds;

use super::{drive, inlets};
use crate::parameters::JOINT;

/// Declares what the commands of all files together speak of and do not define.
pub fn assume_devices(machine: &mut Machine, commands: &[Located<Command>]) {
    let mut defined = BTreeSet::new();
    for Located { what, .. } in commands {
        match what {
            Command::Define {
                name,
                definition: Definition::Function { .. } | Definition::Node(_),
            } => {
                defined.insert(name.clone());
            }
            Command::Variable(names) => defined.extend(names.iter().cloned()),
            _ => {}
        }
    }
    for Located { what, .. } in commands {
        let (from, to) = match what {
            Command::Connect { from, to } => (Some(&from.name), &to.name),
            Command::Send { to, .. } | Command::Store { to, .. } => (None, &to.name),
            _ => continue,
        };
        for name in from.into_iter().chain([to]) {
            if !defined.contains(name) && !machine.is_defined(name.as_str()) {
                assume(machine, name);
            }
        }
    }
}

fn assume(machine: &mut Machine, name: &Name) {
    if drive::joint(name.as_str()).is_some() {
        let kinds: Vec<Kinds> = JOINT.iter().map(|(kinds, _)| *kinds).collect();
        // Nothing is called so: it was asked before.
        let _ = machine.declare_sink(name.as_str(), &kinds);
        return;
    }
    let is_name = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
    if !name.as_str().chars().all(is_name) || machine.is_nearly_defined(name) {
        return;
    }
    let device = inlets::device_of(name.as_str());
    for page in 1..=inlets::PAGES {
        let _ = machine.declare_source(&inlets::instance(device, page), &[Kinds::ANY; 127]);
    }
    for (inlet, _, kinds) in inlets::all(device, 127) {
        let _ = machine.declare_sink(&inlet, &kinds);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ps300::language::parse;

    #[test]
    fn devices_and_joints_are_assumed_and_misspelt_names_are_not() {
        let rows: [(&str, usize); 6] = [
            ("CONNECT NANO<3>:<1>PUPPET.elbow;", 0),
            (
                "SEND 'x' TO <3>NANO_LABEL; CONNECT NANO_PAGE2<1>:<2>PUPPET.elbow;",
                0,
            ),
            ("CONNECT DIAL<3>:<1>DLABEL1;", 1),
            ("CONNECT nano<3>:<1>DLABEL1;", 1),
            ("CONNECT NANO<3>:<3>PUPPET.elbow;", 1),
            ("LONGNAME := F:NOP; CONNECT LONGNAME<1>:<1>DLABEL1;", 0),
        ];
        for (text, errors) in rows {
            let mut machine = Machine::new();
            assume_devices(&mut machine, &parse(text).0);
            assert_eq!(machine.load(text).len(), errors, "{text}");
        }
    }
}
