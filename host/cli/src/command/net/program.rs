//! Network files loaded into one machine.

use std::path::PathBuf;

use ps300::Machine;
use ps300::language::{self, Command, Definition, Diagnostic, Located, Name, Severity};
use ps300::machine::ExecuteError;
use rig::document::Findings;
use rig::document::source::Source;

use super::diagnostics;
use super::run::Watch;
use crate::console::Console;
use crate::input;

/// A machine that the files are loaded into one after the other.
pub(super) fn machine() -> Machine {
    Machine::new()
}

/// Loads files in order, noting everything there is to say about them.
pub(super) fn load(files: &[PathBuf], console: &Console, found: &mut Findings) -> Machine {
    let mut machine = machine();
    for source in sources(files, console, found) {
        let remarks = machine.load(source.text());
        diagnostics::note(&source, (1, 1), remarks, found);
    }
    machine
}

/// The same, watching outputs from the moment they are there: a file may set off messages itself.
/// What only loses a message, as a wrong kind does, is a warning here: the network runs without it.
pub(super) fn load_watched(
    files: &[PathBuf],
    watches: &[Watch],
    console: &Console,
    found: &mut Findings,
) -> Machine {
    // Names that are never defined show only when all is read, which this machine does.
    let mut reader = machine();
    let mut machine = self::machine();
    watch(&mut machine, watches, None);
    for source in sources(files, console, found) {
        let remarks = reader.load(source.text());
        let warnings = remarks
            .into_iter()
            .filter(|remark| remark.severity == Severity::Warning);
        diagnostics::note(&source, (1, 1), warnings, found);
        let (commands, remarks) = language::parse(source.text());
        let errors = remarks
            .into_iter()
            .filter(|remark| remark.severity == Severity::Error);
        diagnostics::note(&source, (1, 1), errors, found);
        for Located { at, what } in &commands {
            if let Err(error) = execute(&mut machine, what, watches) {
                let remark = if is_lost_message(&error) {
                    Diagnostic::warning(*at, error.to_string())
                } else {
                    Diagnostic::error(*at, error.to_string())
                };
                diagnostics::note(&source, (1, 1), [remark], found);
            }
        }
    }
    machine
}

fn sources(files: &[PathBuf], console: &Console, found: &mut Findings) -> Vec<Source> {
    let mut sources = Vec::new();
    for path in files {
        match input::read(path, console) {
            Ok(source) => sources.push(source),
            Err(errors) => errors.0.into_iter().for_each(|error| found.error(error)),
        }
    }
    sources
}

/// Executes one command; an output that it makes is watched if asked for.
pub(super) fn execute(
    machine: &mut Machine,
    command: &Command,
    watches: &[Watch],
) -> Result<(), ExecuteError> {
    machine.execute(command)?;
    match command {
        Command::Define {
            name,
            definition: Definition::Function { .. },
        } => watch(machine, watches, Some(name)),
        Command::Variable(names) => {
            names.iter().for_each(|name| watch(machine, watches, Some(name)));
        }
        _ => {}
    }
    Ok(())
}

/// Watches the outputs asked for, all or those of one name. Outputs not there yet are left for later.
fn watch(machine: &mut Machine, watches: &[Watch], only: Option<&Name>) {
    for wanted in watches {
        if only.is_none_or(|name| *name == wanted.name) {
            machine.watch(wanted.name.as_str(), wanted.output);
        }
    }
}

fn is_lost_message(error: &ExecuteError) -> bool {
    matches!(
        error,
        ExecuteError::Kind { .. } | ExecuteError::NotFinite { .. } | ExecuteError::Empty { .. }
    )
}
