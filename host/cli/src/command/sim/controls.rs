//! `dialrig sim dial-box` and `sim tablet`: simulated controls, with a script for hands.

use std::path::PathBuf;

use bench::serve::{Event, Glow, LateFault, MidiShown, Output, Served};
use serde_json::json;

use super::{PlaceArgs, Trace, serve, uhid};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::{input, setup};

const DIAL_BOX_EXAMPLES: &str = "\
Examples:
  dialrig sim dial-box --pty /tmp/dials
  dialrig sim dial-box --kind sgi-dialbox-display --pty /tmp/dials --script turn.txt --json
  dialrig sim dial-box --kind x-touch-mini-mc --pty /tmp/faders

A script has one action a line, seconds counted from when the host first switched reporting on:
  at 0.5 dial 3 +0.25turns over 1
  at 2 button 4 down

On USB, for the whole machine (needs /dev/uhid, so mostly root):
  dialrig sim dial-box --kind powermate --uhid --script turn.txt";

const TABLET_EXAMPLES: &str = "\
Examples:
  dialrig sim tablet --pty /tmp/tablet
  dialrig sim tablet --kind digitizer-ii --pty /tmp/tablet --script draw.txt

A script has one action a line, seconds counted from when the host first switched reporting on:
  at 0.5 puck 0.2 -0.4
  at 0.7 puck 0.2 -0.4 button 1
  at 1 puck away";

/// Examples, what may be typed, and every kind there is: of tablets, or of everything else.
fn with_kinds(examples: &str, tablets: bool) -> String {
    let (serial, usb) = bench::serve::kinds(tablets);
    format!(
        "{examples}\n\nWhile it runs, lines of a script without their time, faults, `unplug` and `plug` may be \
         typed.\n\nKinds on a line (--pty, --tcp):\n  {}\nKinds on USB (--uhid):\n  {}",
        serial.join(", "),
        usb.join(", ")
    )
}

/// A box of dials, faders and keys on a serial line
///
/// The SGI box unless `--kind` says otherwise: silent until it is initialised, as the real one. deej and Firmata
/// boards boot first.
#[derive(Debug, clap::Args)]
#[command(after_help = with_kinds(DIAL_BOX_EXAMPLES, false))]
pub(crate) struct DialBoxArgs {
    /// Profile of a box; `sgi-dialbox-display` has labels
    #[arg(long, value_name = "NAME", default_value = "sgi-dialbox")]
    kind: String,
    #[command(flatten)]
    common: Common,
}

/// A serial tablet with pen and puck: Wacom IV or V, Summagraphics MM
#[derive(Debug, clap::Args)]
#[command(after_help = with_kinds(TABLET_EXAMPLES, true))]
pub(crate) struct TabletArgs {
    /// Profile of a tablet
    #[arg(long, value_name = "NAME", default_value = "graphire-serial")]
    kind: String,
    #[command(flatten)]
    common: Common,
}

#[derive(Debug, clap::Args)]
struct Common {
    #[command(flatten)]
    place: ControlPlace,
    /// What hands do; `-` reads standard input
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Something that goes wrong: `garbage`, `short`, `long`, `wrong`, `interleaved`, `drop 3`, `flood 8000Hz for 2s`;
    /// with `at 2s` behind it so long after reporting began
    #[arg(long, value_name = "TEXT", value_parser = LateFault::parse)]
    fault: Vec<LateFault>,
    /// Writes down every byte
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
}

/// Where other programs find it.
#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
struct ControlPlace {
    /// A pseudo-terminal, linked to at PATH
    #[arg(long, value_name = "PATH")]
    pty: Option<PathBuf>,
    /// A TCP port; port 0 lets the system choose
    #[arg(long, value_name = "HOST:PORT")]
    tcp: Option<String>,
    /// One of this machine's own input devices, through /dev/uhid: devices on USB
    #[arg(long)]
    uhid: bool,
}

pub(super) fn dial_box(args: &DialBoxArgs, console: &Console) -> Result<Exit, Failure> {
    input(&args.kind, &args.common, console)
}

pub(super) fn tablet(args: &TabletArgs, console: &Console) -> Result<Exit, Failure> {
    input(&args.kind, &args.common, console)
}

fn input(kind: &str, args: &Common, console: &Console) -> Result<Exit, Failure> {
    if args.place.uhid {
        return uhid::run(kind, args.script.as_deref(), &args.fault, console);
    }
    let profiles = setup::profiles()?;
    let profile = profiles
        .input(kind)
        .map_err(|error| Failure::refused(error.to_string()))?;
    let device = Served::input(profile).ok_or_else(|| {
        Failure::refused(if uhid::is_kind(kind) {
            format!("{kind} is on USB and has no serial line; give --uhid")
        } else {
            format!(
                "{} speaks {}, of which nothing is simulated",
                profile.key, profile.format
            )
        })
    })?;
    play(device, args, console)
}

fn play(mut device: Served, args: &Common, console: &Console) -> Result<Exit, Failure> {
    if let Some(path) = &args.script {
        let source = input::read(path, console)?;
        let script = device.script(source.text()).map_err(|errors| {
            let lines: Vec<String> = errors
                .iter()
                .map(|error| format!("{}:{error}", path.display()))
                .collect();
            Failure::refused(lines.join("\n"))
        })?;
        device.play(&script);
    }
    for fault in &args.fault {
        device.fault(fault.clone());
    }
    let mut trace = args.trace.as_ref().map(Trace::create).transpose()?;
    let place = PlaceArgs {
        pty: args.place.pty.clone(),
        tcp: args.place.tcp.clone(),
    };
    serve(device, &place, console, &mut |event| {
        if let Some(trace) = &mut trace {
            trace.note(event, console);
        }
        if let Event::Output(at_us, output) = event {
            tell(at_us, output, console);
        }
    })
}

/// Says what the device was told to show. A reader that went away does not stop the device.
fn tell(at_us: u64, output: &Output, console: &Console) {
    let t = at_us as f64 / 1e6;
    let (record, line) = match output {
        Output::Lamps(mask) => {
            let on = lit(*mask);
            (
                json!({"t": t, "output": "lamps", "on": on}),
                format!("lamps {on:?}"),
            )
        }
        Output::Label { control, text } => (
            json!({"t": t, "output": "label", "control": control, "text": text.trim_end()}),
            format!("label {control} {text}"),
        ),
        Output::Midi(shown) => midi(t, *shown),
    };
    let told = if console.json() {
        console.record(&record)
    } else {
        console.line(format_args!("{t:10.3}  {line}"))
    };
    let _ = told.and_then(|()| console.flush());
}

/// What a MIDI box shows, for programs and for people.
fn midi(t: f64, shown: MidiShown) -> (serde_json::Value, String) {
    match shown {
        MidiShown::Lamp { control, glow } => {
            let light = match glow {
                Glow::Off => "off",
                Glow::On => "on",
                Glow::Blinking => "blinking",
            };
            (
                json!({"t": t, "output": "lamp", "control": control, "light": light}),
                format!("lamp {control} {light}"),
            )
        }
        MidiShown::Colour {
            index,
            red,
            green,
            blinking,
        } => (
            json!({"t": t, "output": "lamp", "index": index, "red": red, "green": green, "blinking": blinking}),
            format!("lamp {index} red {red} green {green}{}", after(blinking)),
        ),
        MidiShown::Ring {
            control,
            lamps,
            blinking,
        } => {
            let on = lit(lamps.into());
            (
                json!({"t": t, "output": "ring", "control": control, "on": on, "blinking": blinking}),
                format!("ring {control} {on:?}{}", after(blinking)),
            )
        }
        MidiShown::Mode(mode) => (
            json!({"t": t, "output": "mode", "value": mode}),
            format!("mode {mode}"),
        ),
        MidiShown::Layer(layer) => (
            json!({"t": t, "output": "layer", "value": layer}),
            format!("layer {layer}"),
        ),
    }
}

fn after(blinking: bool) -> &'static str {
    if blinking { " blinking" } else { "" }
}

fn lit(mask: u32) -> Vec<u8> {
    (0..32).filter(|lamp| mask >> lamp & 1 == 1).collect()
}
