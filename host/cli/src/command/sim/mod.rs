//! `dialrig sim`: simulated devices for any program that speaks to the real ones.

mod controls;
mod orders;
mod servo_bus;
mod uhid;

use std::io::Write;
use std::path::PathBuf;

use bench::serve::{self, Event, Place, ServeLine, Served};
use clap::Subcommand;
use serde_json::json;

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use orders::Orders;

const EXAMPLES: &str = "\
Examples:
  dialrig sim servo-bus --servo XL430-W250:1-6 --pty /tmp/bus
  dialrig sim dial-box --pty /tmp/dials --script turn.txt
  dialrig sim tablet --kind graphire-serial --tcp 127.0.0.1:7001";

/// Simulated devices for any program
///
/// A servo bus, a dial box, a tablet, byte for byte. Prints `ready PATH` when other programs can open it, and runs until
/// Ctrl-C.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Command,
}

/// The devices there are.
#[derive(Debug, Subcommand)]
enum Command {
    ServoBus(servo_bus::Args),
    DialBox(controls::DialBoxArgs),
    Tablet(controls::TabletArgs),
}

/// Where other programs find it.
#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
struct PlaceArgs {
    /// A pseudo-terminal, linked to at PATH
    #[arg(long, value_name = "PATH")]
    pty: Option<PathBuf>,
    /// A TCP port; port 0 lets the system choose
    #[arg(long, value_name = "HOST:PORT")]
    tcp: Option<String>,
}

impl PlaceArgs {
    fn place(&self) -> Place {
        match &self.tcp {
            Some(address) => Place::Tcp(address.clone()),
            None => Place::Pty(self.pty.clone()),
        }
    }
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    match &args.command {
        Command::ServoBus(args) => servo_bus::run(args, console),
        Command::DialBox(args) => controls::dial_box(args, console),
        Command::Tablet(args) => controls::tablet(args, console),
    }
}

/// Serves until Ctrl-C.
fn serve(
    mut device: Served,
    place: &PlaceArgs,
    console: &Console,
    told: &mut dyn FnMut(Event<'_>),
) -> Result<Exit, Failure> {
    let interrupt = Interrupt::listen();
    let refused = |error: &dyn std::fmt::Display| Failure::refused(error.to_string());
    let mut line = ServeLine::open(&place.place(), device.baud()).map_err(|error| refused(&error))?;
    console.line(format_args!(
        "ready {}",
        place
            .pty
            .as_ref()
            .map_or(line.path().to_owned(), |p| p.display().to_string())
    ))?;
    console.flush()?;
    let clock = rig::real_time();
    let orders = Orders::listen();
    let mut next = || orders.next();
    serve::run(
        &mut device,
        &mut line,
        &*clock,
        interrupt.flag(),
        &mut next,
        &mut |event| {
            answer(event, console);
            told(event);
        },
    )
    .map_err(|error| refused(&error))?;
    Ok(Exit::Done)
}

/// Says what came of an order. A reader that went away does not stop the device.
fn answer(event: Event<'_>, console: &Console) {
    let (t, done, said) = match event {
        Event::Obeyed(at_us, said) => (at_us as f64 / 1e6, true, said),
        Event::Refused(at_us, why) => (at_us as f64 / 1e6, false, why),
        _ => return,
    };
    if console.json() {
        let _ = console
            .record(&json!({"t": t, "order": if done { "done" } else { "refused" }, "text": said}))
            .and_then(|()| console.flush());
    } else if done {
        let _ = console.line(said).and_then(|()| console.flush());
    } else {
        console.remark(said);
    }
}

/// A trace of bytes as an exchange file: who said what, when.
struct Trace {
    path: PathBuf,
    out: std::io::BufWriter<std::fs::File>,
}

impl Trace {
    fn create(path: &PathBuf) -> Result<Self, Failure> {
        let file = std::fs::File::create(path)
            .map_err(|error| Failure::refused(format!("cannot write {}: {error}", path.display())))?;
        Ok(Self {
            path: path.clone(),
            out: std::io::BufWriter::new(file),
        })
    }

    fn note(&mut self, event: Event<'_>, console: &Console) {
        let seconds = |at_us: u64| at_us as f64 / 1e6;
        let (at_us, who, bytes) = match event {
            Event::HostWrote(at_us, bytes) => (at_us, "host   >", bytes),
            Event::DeviceWrote(at_us, bytes) => (at_us, "device <", bytes),
            Event::Baud(at_us, baud) => {
                self.write(
                    format_args!("# {:.6} s: the host listens at {baud} baud", seconds(at_us)),
                    console,
                );
                return;
            }
            Event::Obeyed(at_us, said) => {
                for line in said.lines() {
                    self.write(format_args!("# {:.6} s: {line}", seconds(at_us)), console);
                }
                return;
            }
            Event::Output(..) | Event::Refused(..) => return,
        };
        let hex: Vec<String> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        self.write(
            format_args!("{who} {}      # {:.6} s", hex.join(" "), seconds(at_us)),
            console,
        );
    }

    fn write(&mut self, line: std::fmt::Arguments<'_>, console: &Console) {
        let written = writeln!(self.out, "{line}").and_then(|()| self.out.flush());
        if let Err(error) = written {
            console.remark(format_args!("trace {}: {error}", self.path.display()));
        }
    }
}
