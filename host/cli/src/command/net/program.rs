//! Network files loaded into one machine.

use std::path::PathBuf;

use ps300::Machine;
use ps300::language::{self, Command, Definition, Diagnostic, Located, Name, Severity};
use ps300::machine::ExecuteError;
use ps300::machine::devices::READOUTS;
use ps300::network::{Made, Places};
use ps300::value::Kinds;
use rig::controls::assumed::assume_devices;
use rig::document::Findings;
use rig::document::source::Source;
use rig::parameters::{LINK, PARAMETERS};

use super::diagnostics;
use super::run::Watch;
use crate::console::Console;
use crate::input;

/// A machine with the inlets of the rig, so that networks made for it can be connected to them.
fn machine() -> Machine {
    let mut machine = Machine::new();
    for parameter in PARAMETERS {
        let kinds: Vec<Kinds> = parameter.inlets.iter().map(|inlet| inlet.kinds).collect();
        // Names of the table's own: a test of the rig keeps them apart from the machine's.
        let _ = machine.declare_sink(parameter.name, &kinds);
    }
    machine
}

/// A figure's links are inlets too. Which figure a file is for is not known here, so every link that it
/// names is taken to be there.
fn declare_links(machine: &mut Machine, commands: &[Located<Command>]) {
    let kinds: Vec<Kinds> = LINK.iter().map(|(kinds, _)| *kinds).collect();
    for Located { what, .. } in commands {
        if let Command::Connect { to, .. } | Command::Send { to, .. } | Command::Store { to, .. } = what
            && is_link(&to.name)
            && !machine.is_defined(to.name.as_str())
        {
            // A name that was read is a name.
            let _ = machine.declare_sink(to.name.as_str(), &kinds);
        }
    }
}

fn is_link(name: &Name) -> bool {
    name.split_structure()
        .is_some_and(|(structure, _)| structure.eq_ignore_ascii_case("FIGURE"))
}

/// How many inputs something has that takes messages out of the network: a label, a lamp, a parameter of
/// the rig. Nothing for names of other things.
pub(super) fn host_inputs(name: &Name) -> Option<usize> {
    let same = |other: &str| name.as_str().eq_ignore_ascii_case(other);
    if let Some(parameter) = PARAMETERS.iter().find(|parameter| same(parameter.name)) {
        return Some(parameter.inlets.len());
    }
    if is_link(name) {
        return Some(LINK.len());
    }
    READOUTS
        .iter()
        .find(|readout| readout.names().any(|name| same(&name)))
        .map(|readout| readout.inputs.len())
}

/// Loads files in order, noting everything there is to say about them.
pub(super) fn load(files: &[PathBuf], console: &Console, found: &mut Findings) -> Machine {
    let mut machine = machine();
    for source in sources(files, console, found) {
        let commands = language::parse(source.text()).0;
        declare_links(&mut machine, &commands);
        assume_devices(&mut machine, &commands);
        let remarks = machine.load_named(&called(&source), source.text());
        diagnostics::note(&source, (1, 1), remarks, found);
    }
    machine
}

/// What reports call a file: its name without folders.
pub(super) fn called(source: &Source) -> String {
    let path = source.path();
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
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
        let (commands, remarks) = language::parse(source.text());
        declare_links(&mut reader, &commands);
        declare_links(&mut machine, &commands);
        assume_devices(&mut reader, &commands);
        assume_devices(&mut machine, &commands);
        let all = reader.load(source.text()).into_iter();
        let warnings = all.filter(|remark| remark.severity == Severity::Warning);
        diagnostics::note(&source, (1, 1), warnings, found);
        let errors = remarks
            .into_iter()
            .filter(|remark| remark.severity == Severity::Error);
        diagnostics::note(&source, (1, 1), errors, found);
        let name = called(&source);
        let places = Places::new(&name, source.text());
        for Located { at, what } in &commands {
            if let Err(error) = execute(&mut machine, what, places.at(*at), watches) {
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

/// Executes one command of a text; an output that it makes is watched if asked for.
pub(super) fn execute(
    machine: &mut Machine,
    command: &Command,
    made: Made,
    watches: &[Watch],
) -> Result<(), ExecuteError> {
    machine.execute_at(command, made)?;
    match command {
        Command::Define {
            name,
            definition: Definition::Function { .. },
        } => watch(machine, watches, Some(name)),
        Command::Variable(names) => {
            for name in names {
                watch(machine, watches, Some(name));
            }
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
