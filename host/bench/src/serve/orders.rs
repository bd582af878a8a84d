//! What somebody can ask of a served device while it runs.

use std::fmt::Write;

use firmware_sim::servo_bus::{Servo, Spoken};
use firmware_sim::{Firmware, ServoBus};

use super::Served;

/// What a bus understands beside faults.
const WORDS: &str =
    "a fault such as `servo 3 stuck for 2s`, `mend`, a hand such as `hand on 3 turns to 30 deg`, or `servos`";

impl Served {
    /// Carries out `order`; what there is to say to it, or why not. To a bus every fault is an order; `mend` ends them,
    /// `hand on N` lays a hand on a horn, `servos` tells how the servos are. A box or a tablet has hands only by its script.
    pub(super) fn order(&mut self, now_us: u64, order: &str) -> Result<String, String> {
        let Self::Bus(bus, ..) = self else {
            return Err("expected no orders: hands on this device come from --script".to_owned());
        };
        let text = order.trim();
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
