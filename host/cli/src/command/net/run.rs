//! `dialrig net run`: a function network in virtual time, sixty frames a second.

use std::path::PathBuf;

use ps300::Machine;
use ps300::language::Name;
use ps300::network::Limits;
use rig::document::Findings;

use super::diagnostics;
use super::events::{self, Doing, Event};
use super::message::MessageRecord;
use super::program;
use super::trouble::Troubles;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::input;
use crate::interrupt::Interrupt;
use crate::number;

const EXAMPLES: &str = "\
Examples:
  dialrig net run networks/figure.ps300 --dial 1:0.25@0.5 --watch 'turn<1>'
  dialrig net run clock.ps300 --until 2 --watch 'tick<1>' --watch 'DLABEL1<1>'
  dialrig net run slew.ps300 --events turns.txt --watch 'slew<1>' > slew.jsonl
  dialrig net run dials.ps300 --dial 1:0.5@0.1 --state > later.ps300

An events file has one command a line, times ascending: at 0.5 SEND 0.25 TO <1>turn;
What a device sends is written at 0.5 EMIT FIX(3) FROM FKEYS<1>;";

/// Frames a second of network time: what the original's screen showed, near enough.
const FRAMES_PER_SEC: f64 = 60.0;

/// Run in virtual time and watch messages
///
/// Prints watched messages, one a line: `{"t":…,"from":"NAME<N>","kind":…,"value":…}`. Messages that get lost on
/// the way are reported on standard error.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// Network files, loaded one after the other; `-` is standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Commands and when they are given
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    /// Where network time ends, seconds; at the last event if not given
    #[arg(long, value_name = "SECS", value_parser = number::secs)]
    until: Option<f64>,
    /// Prints what leaves this output, or what reaches this input of a label, a lamp or a parameter
    #[arg(long, value_name = "NAME<N>", value_parser = Watch::parse)]
    watch: Vec<Watch>,
    /// Prints the network with what messages have done to it, at the end, as a file to go on from
    #[arg(long)]
    state: bool,
    /// Turns dial N by TURNS at SECS, as one message
    #[arg(long, value_name = "N:TURNS@SECS", value_parser = events::dial)]
    dial: Vec<Event>,
    /// Presses function key N at SECS; 13 to 24 are keys with shift, 25 to 36 with control
    #[arg(long, value_name = "N@SECS", value_parser = events::key)]
    key: Vec<Event>,
}

/// `NAME<N>`.
#[derive(Clone, Debug)]
pub(super) struct Watch {
    pub(super) name: Name,
    pub(super) output: u8,
}

impl Watch {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let form = || "expected NAME<N>, as in 'turn<1>' (quoted, for the shell)".to_owned();
        let (name, rest) = text.trim().split_once('<').ok_or_else(form)?;
        let number = rest.strip_suffix('>').ok_or_else(form)?;
        let output = number
            .parse()
            .ok()
            .filter(|&output| output > 0)
            .ok_or_else(form)?;
        if !Name::is_valid(name) {
            return Err(form());
        }
        Ok(Self {
            name: Name::new(name),
            output,
        })
    }
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let mut found = Findings::default();
    let machine = program::load_watched(&args.files, &args.watch, console, &mut found);
    let mut events = [args.dial.as_slice(), &args.key].concat();
    if let Some(path) = &args.events {
        match input::read(path, console) {
            Ok(source) => events.extend(events::read(&source, &mut found)),
            Err(errors) => errors.0.into_iter().for_each(|error| found.error(error)),
        }
    }
    // Stable: at one time dials come first, then keys, then events as written.
    events.sort_by(|a, b| a.secs.total_cmp(&b.secs));
    diagnostics::settle(found, console)?;
    args.watch
        .iter()
        .try_for_each(|watch| check_watch(watch, &machine, &events))?;
    let until_secs = args
        .until
        .or(events.last().map(|event| event.secs))
        .unwrap_or_default();
    let mut session = Session {
        machine,
        watches: &args.watch,
        console,
        troubles: Troubles::default(),
        frames: 0,
    };
    let ended = session.play(&events, until_secs);
    session.troubles.show(console);
    ended?;
    if args.state {
        let network = session.machine.network_text_with_state();
        if console.json() {
            console.record(&StateRecord { network: &network })?;
        } else {
            console.line(network.trim_end())?;
        }
    }
    Ok(Exit::Done)
}

/// An output that neither is there nor will be made by an event was misspelt.
fn check_watch(watch: &Watch, machine: &Machine, events: &[Event]) -> Result<(), Failure> {
    let Watch { name, output } = watch;
    let inputs = program::host_inputs(name);
    let is_there = machine.outlet(name.as_str(), *output).is_some()
        || inputs.is_some_and(|count| usize::from(*output) <= count);
    if is_there || events.iter().any(|event| event.makes(name)) {
        return Ok(());
    }
    let known = machine.instances();
    let outputs = known.iter().find(|view| view.name == name);
    let hint = match outputs.map(|view| view.outputs.len()).or(inputs) {
        Some(1) => format!("{name} has <1> only"),
        Some(count) => format!("{name} has <1> to <{count}>"),
        None if machine.is_defined(name.as_str()) => format!("{name} sends nothing; watch what it is fed by"),
        None => {
            let names: Vec<&str> = known.iter().map(|view| view.name.as_str()).take(20).collect();
            format!("what sends here: {}", names.join(", "))
        }
    };
    Err(Failure::refused(format!("there is no output {name}<{output}> to watch")).with_hint(hint))
}

/// The network at the end, where all is JSON.
#[derive(serde::Serialize)]
struct StateRecord<'a> {
    network: &'a str,
}

/// A network while it runs.
struct Session<'a> {
    machine: Machine,
    watches: &'a [Watch],
    console: &'a Console,
    troubles: Troubles,
    /// Frames shown so far.
    frames: u64,
}

impl Session<'_> {
    /// Frames at their times and events at theirs, up to the end. A frame comes before the events of its time.
    fn play(&mut self, events: &[Event], until_secs: f64) -> Result<(), Failure> {
        let interrupt = Interrupt::listen();
        let progress = self
            .console
            .progress((until_secs * FRAMES_PER_SEC) as u64 + 1, "running");
        let mut coming = events.iter().peekable();
        loop {
            if interrupt.came() {
                return Err(Failure::interrupted());
            }
            let frame_secs = self.frames as f64 / FRAMES_PER_SEC;
            match coming.next_if(|event| event.secs < frame_secs && event.secs <= until_secs) {
                Some(event) => self.event(event),
                None if frame_secs <= until_secs => {
                    self.frames += 1;
                    self.tick(frame_secs);
                    progress.inc(1);
                }
                None => break,
            }
            self.show()?;
        }
        progress.finish_and_clear();
        match coming.count() {
            0 => {}
            left => self.console.remark(format_args!(
                "{left} events come after {until_secs} s and did not happen"
            )),
        }
        Ok(())
    }

    fn tick(&mut self, secs: f64) {
        let firings = Limits::default().firings_per_command;
        self.machine.tick(secs, self.frames.saturating_sub(1), firings);
    }

    fn event(&mut self, event: &Event) {
        // Between two frames network time goes to the event's own.
        if event.secs > self.machine.secs() {
            self.tick(event.secs);
        }
        match &event.doing {
            Doing::Emit {
                name,
                output,
                value,
                place,
            } => {
                if self.machine.emit(name.as_str(), *output, value.clone()) {
                    self.tick(event.secs);
                } else if let Some(mut warning) = place.clone() {
                    warning.message = format!("there is no output {name}<{output}>");
                    self.console.warn(&[warning]);
                }
            }
            Doing::Command(given) => {
                let (command, place, made) = &**given;
                if let Err(error) = program::execute(&mut self.machine, command, made.clone(), self.watches) {
                    let mut warning = place.clone();
                    warning.message = error.to_string();
                    self.console.warn(&[warning]);
                }
            }
        }
    }

    /// Prints what was watched and notes what went wrong since the last time.
    fn show(&mut self) -> Result<(), Failure> {
        let secs = self.machine.secs();
        for seen in self.machine.drain_watched() {
            let record = MessageRecord::new(seen.secs, seen.name.as_str(), seen.output, &seen.value);
            self.console.record(&record)?;
        }
        let mut arrived = Vec::new();
        let watches = self.watches;
        self.machine.drain_sinks(|_, name, input, value| {
            let is_watched = |watch: &Watch| watch.output == input && watch.name == Name::new(name);
            if watches.iter().any(is_watched) {
                arrived.push(MessageRecord::new(secs, name, input, &value));
            }
        });
        arrived
            .iter()
            .try_for_each(|record| self.console.record(record))?;
        let reports = self.machine.reports();
        self.troubles.add(secs, reports);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn watches_are_names_with_numbers() {
        for bad in ["", "a", "a<>", "a<0>", "a<1", "a<x>", "<1>a", "1a<1>", "a<300>"] {
            assert!(Watch::parse(bad).is_err(), "{bad}");
        }
        let watch = Watch::parse("turn.x<12>").expect("well formed");
        assert_eq!((watch.name.as_str(), watch.output), ("turn.x", 12));
    }
}
