//! `dialrig monitor`: decoded events of one input device, as they come.

use std::time::Duration;

use bench::SimPorts;
use bench::world::Equipment;
use rig::WithBench;
use rig::listen::{Heard, HeardEvent, Listener};
use serde_json::{Map, Value, json};

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::setup;

const EXAMPLES: &str = "\
Examples:
  dialrig monitor /dev/ttyUSB0 --profile sgi-dialbox
  dialrig monitor /tmp/tablet --profile graphire-serial --json";

/// Longest silence before Ctrl-C is looked for again.
const PATIENCE: Duration = Duration::from_millis(100);

/// What an input device says
///
/// Dials, keys, pen and puck, in the device's own counts and numbers, until Ctrl-C.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// A device path, tcp:HOST:PORT, usb:SERIAL or sim:NAME
    device: String,
    /// Profile of a dial box or tablet; `sgi-dialbox` when left out
    #[arg(long, value_name = "NAME", default_value = "sgi-dialbox")]
    profile: String,
}

pub(crate) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    let profiles = setup::profiles()?;
    let clock = rig::real_time();
    let stand = Equipment::default()
        .stand(std::sync::Arc::clone(&clock), &profiles)
        .map_err(|error| Failure::refused(error.to_string()))?;
    let mut ports = WithBench::new(Box::new(SimPorts::new(stand)));
    let mut listener = Listener::open(&mut ports, &args.device, &args.profile, &profiles, clock)
        .map_err(|error| Failure::refused(error.to_string()))?;
    let interrupt = Interrupt::listen();
    let mut teller = Teller {
        console,
        before: Before::default(),
        events: 0,
        first_secs: None,
    };
    let mut ended = Ok(());
    while ended.is_ok() && !interrupt.came() {
        let mut told = Ok(());
        ended = listener.next(PATIENCE, &mut |heard| {
            if told.is_ok() {
                told = teller.tell(&heard);
            }
        });
        told?;
        console.flush()?;
    }
    let [reports, unknown, rejected] = listener.counted();
    console.remark(format_args!(
        "{reports} reports, {} events, {unknown} unknown bytes, {rejected} rejected",
        teller.events
    ));
    match ended {
        Ok(()) => Ok(Exit::Done),
        Err(error) => Err(Failure::device(error.to_string())),
    }
}

/// What changes are told against.
#[derive(Default)]
struct Before {
    in_range: bool,
    tip: bool,
    eraser: bool,
    buttons: u8,
}

struct Teller<'a> {
    console: &'a Console,
    before: Before,
    events: u64,
    /// When the first event came; times are told from then.
    first_secs: Option<f64>,
}

impl Teller<'_> {
    fn tell(&mut self, heard: &Heard) -> Result<(), Failure> {
        match &heard.what {
            HeardEvent::Sample { .. } => self.sample(heard),
            HeardEvent::Dial { control, delta } => self.event(
                heard,
                "dial",
                vec![("control", json!(control)), ("delta", json!(delta))],
            ),
            HeardEvent::Button { control, down } => self.event(
                heard,
                "button",
                vec![("control", json!(control)), ("value", json!(down))],
            ),
            HeardEvent::Started(identity) => {
                self.console.remark(format_args!(
                    "the device answers{}",
                    identity
                        .as_ref()
                        .map(|name| format!(": {name}"))
                        .unwrap_or_default()
                ));
                Ok(())
            }
            HeardEvent::Restarted => {
                self.console.remark("the device was switched off and on");
                Ok(())
            }
        }
    }

    /// A sample, then one event for each thing that changed.
    fn sample(&mut self, heard: &Heard) -> Result<(), Failure> {
        let HeardEvent::Sample {
            tool,
            x,
            y,
            pressure,
            tilt,
            wheel,
            in_range,
            tip,
            buttons,
        } = &heard.what
        else {
            return Ok(());
        };
        // Out of range the position is an old one: nothing to report but the leaving.
        if *in_range {
            let mut fields = vec![("tool", json!(tool)), ("x", json!(x)), ("y", json!(y))];
            fields.extend(pressure.map(|p| ("pressure", json!(p))));
            if let Some([x, y]) = tilt {
                fields.extend([("tilt_x", json!(x)), ("tilt_y", json!(y))]);
            }
            if *wheel != 0 {
                fields.push(("wheel", json!(wheel)));
            }
            self.event(heard, "sample", fields)?;
        }
        let now = Before {
            in_range: *in_range,
            tip: *tip,
            eraser: *in_range && *tool == "eraser",
            buttons: *buttons,
        };
        let before = std::mem::replace(&mut self.before, now);
        let Before {
            in_range,
            tip,
            eraser,
            buttons,
        } = self.before;
        let flags = [
            ("in_range", before.in_range, in_range),
            ("tip", before.tip, tip),
            ("eraser", before.eraser, eraser),
        ];
        for (name, was, is) in flags {
            if was != is {
                self.event(heard, name, vec![("value", json!(is))])?;
            }
        }
        for bit in 0..8 {
            let (was, is) = (before.buttons >> bit & 1, buttons >> bit & 1);
            if was != is {
                self.event(
                    heard,
                    &format!("button{}", bit + 1),
                    vec![("value", json!(is == 1))],
                )?;
            }
        }
        Ok(())
    }

    fn event(&mut self, heard: &Heard, event: &str, fields: Vec<(&str, Value)>) -> Result<(), Failure> {
        self.events += 1;
        let t = heard.at_secs - *self.first_secs.get_or_insert(heard.at_secs);
        if !self.console.json() {
            let fields: Vec<String> = fields
                .iter()
                .map(|(name, value)| format!("{name} {value}"))
                .collect();
            return self
                .console
                .line(format_args!("{:10.3}  {event:<9} {}", t, fields.join("  ")));
        }
        let mut record = Map::new();
        record.insert("t".into(), json!((t * 1e6).round() / 1e6));
        record.insert("event".into(), json!(event));
        record.extend(fields.into_iter().map(|(name, value)| (name.to_owned(), value)));
        self.console.record(&record)
    }
}
