//! What somebody can ask of a served device while it runs.

use std::fmt::Write;

use firmware_sim::servo_bus::{Servo, Spoken};
use firmware_sim::{Firmware, InputFault, Script, SerialDevice, ServoBus, script};

use super::{ServeLine, Served};

/// What a bus understands beside faults.
const WORDS: &str =
    "a fault such as `servo 3 stuck for 2s`, `mend`, a hand such as `hand on 3 turns to 30 deg`, or `servos`";

/// What is done to the cable of an input device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cable {
    Out,
    In,
}

impl Cable {
    pub(super) fn of(order: &str) -> Option<Self> {
        match order.trim() {
            "unplug" => Some(Self::Out),
            "plug" => Some(Self::In),
            _ => None,
        }
    }

    /// The port is gone, or there again under the same name. The device keeps its power: it has a plug of its own.
    pub(super) fn move_it(
        self,
        line: &mut ServeLine,
        device: &mut Served,
        now_us: u64,
    ) -> Result<String, String> {
        if self == Self::Out {
            line.unplug();
            return Ok("unplugged".to_owned());
        }
        line.plug().map_err(|error| error.to_string())?;
        device.firmware().port_opened(now_us);
        Ok("plugged in".to_owned())
    }
}

/// A hand or a fault on an input device.
fn handled(device: &mut dyn SerialDevice, now_us: u64, text: &str) -> Result<String, String> {
    if let Ok(fault) = InputFault::parse(text) {
        let done = device.inject(now_us, fault).then(|| text.to_owned());
        return done.ok_or_else(|| format!("`{text}`: type `unplug` to pull the cable"));
    }
    for action in hand(device.controls(), text)?.actions {
        if !device.touch(now_us, &action.touch) {
            return Err(format!("`{text}`: it has no such control"));
        }
    }
    Ok(text.to_owned())
}

/// What a hand is to do now.
pub(super) fn hand(controls: script::Device, text: &str) -> Result<Script, String> {
    Script::parse(controls, &format!("at 0 {text}")).map_err(|errors| {
        let flaw = errors.first().map_or("", |error| error.message.as_str());
        format!(
            "`{text}`: {flaw}; an order is a line of a script without its time, a fault, `unplug` or `plug`"
        )
    })
}

impl Served {
    /// Carries out `order`; what there is to say to it, or why not. To a bus every fault is an order; `mend` ends them,
    /// `hand on N` lays a hand on a horn, `servos` tells how the servos are. To an input device faults and hands are.
    pub(super) fn order(&mut self, now_us: u64, order: &str) -> Result<String, String> {
        let text = order.trim();
        let bus = match self {
            Self::Input(device, _) => return handled(&mut **device, now_us, text),
            Self::Bus(bus, ..) => bus,
        };
        if text == "servos" {
            // Nothing is said to them; they only come up to now.
            bus.receive(now_us, &[]);
            return Ok(servos(bus));
        }
        let spoken =
            Spoken::parse(text).map_err(|error| format!("`{text}`: {error}; an order is {WORDS}"))?;
        let Some(spoken) = spoken else {
            return Ok(String::new());
        };
        bus.obey(now_us, &spoken)?;
        Ok(match spoken {
            Spoken::Mend => "mended".to_owned(),
            done => done.to_string(),
        })
    }
}

/// A line for each servo.
fn servos(bus: &ServoBus) -> String {
    let lines = bus.servos().iter().map(|servo| {
        let mut line = String::new();
        let state = match (servo.is_connected(), servo.torque_is_on()) {
            (false, _) => "no power",
            (true, true) => "torque on",
            (true, false) => "torque off",
        };
        // Writing to a string does not fail.
        let _ = write!(
            line,
            "servo {:3}  {:12} {state:10} {:8.2} deg {:5.1} C {:5.1} V  {} EEPROM writes{}",
            servo.id(),
            servo.model(),
            servo.true_position_rad().to_degrees(),
            servo.temperature_c(),
            servo.supply_volts(),
            servo.counters().eeprom_writes,
            alarms(servo),
        );
        line
    });
    lines.collect::<Vec<_>>().join("\n")
}

fn alarms(servo: &Servo) -> String {
    match servo.alarm_bits() {
        0 => String::new(),
        bits => format!("  alarms {bits:#04x}"),
    }
}
