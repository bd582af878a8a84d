//! `--uhid`: a simulated USB input device as one of the machine's own.

use std::io::ErrorKind;
use std::path::Path;

use bench::serve::{Event, LateFault, UHID_NODE, UsbAudience, UsbServed, UsbShown};
use serde_json::json;

use super::answer;
use super::orders::Orders;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::input;
use crate::interrupt::Interrupt;

/// Whether devices of this kind are on USB.
pub(super) fn is_kind(kind: &str) -> bool {
    UsbServed::kinds().any(|name| name == kind)
}

/// Serves a device until Ctrl-C.
pub(super) fn run(
    kind: &str,
    script: Option<&Path>,
    faults: &[LateFault],
    console: &Console,
) -> Result<Exit, Failure> {
    let mut device = UsbServed::of(kind).ok_or_else(|| {
        let known: Vec<_> = UsbServed::kinds().collect();
        Failure::refused(format!(
            "no simulated device on USB is called {kind}; there are: {}",
            known.join(", ")
        ))
    })?;
    if let Some(path) = script {
        let source = input::read(path, console)?;
        device.play(source.text()).map_err(|errors| {
            let lines: Vec<String> = errors
                .iter()
                .map(|error| format!("{}:{error}", path.display()))
                .collect();
            Failure::refused(lines.join("\n"))
        })?;
    }
    for fault in faults {
        device.fault(fault.clone());
    }
    let interrupt = Interrupt::listen();
    let clock = rig::real_time();
    let orders = Orders::listen();
    let mut audience = UsbAudience {
        ready: &mut || {
            let _ = console
                .line(format_args!("ready {kind}"))
                .and_then(|()| console.flush());
        },
        orders: &mut || orders.next(),
        shown: &mut |at_us, shown| tell(at_us, shown, console),
        answered: &mut |at_us, done| match done {
            Ok(said) => answer(Event::Obeyed(at_us, said), console),
            Err(why) => answer(Event::Refused(at_us, why), console),
        },
    };
    let served = device.run(&*clock, interrupt.flag(), &mut audience);
    served.map_err(|error| {
        let hint = match error.kind() {
            ErrorKind::NotFound => "; load it with `modprobe uhid`",
            ErrorKind::PermissionDenied => "; run it as root, or give yourself the right to write there",
            _ => "",
        };
        Failure::refused(format!("{UHID_NODE}: {error}{hint}"))
    })?;
    Ok(Exit::Done)
}

/// Says what the device was told to show. A reader that went away does not stop the device.
fn tell(at_us: u64, shown: &UsbShown, console: &Console) {
    let t = at_us as f64 / 1e6;
    let record = match *shown {
        UsbShown::Level(level) => json!({"t": t, "output": "level", "value": level}),
        UsbShown::Lamp(on) => json!({"t": t, "output": "lamp", "on": on}),
        UsbShown::Pulse { speed, awake, asleep } => {
            json!({"t": t, "output": "pulse", "speed": speed, "awake": awake, "asleep": asleep})
        }
    };
    let told = if console.json() {
        console.record(&record)
    } else {
        console.line(record)
    };
    let _ = told.and_then(|()| console.flush());
}
