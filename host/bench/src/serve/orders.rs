//! What somebody can ask of a served device while it runs.

use std::fmt::Write;

use firmware_sim::servo_bus::{FaultKind, Servo};
use firmware_sim::{Fault, ServoBus};

use super::Served;

/// What a bus understands beside faults.
const WORDS: &str = "a fault such as `servo 3 stuck for 2s`, `mend` or `servos`";

impl Served {
    /// Carries out `order`; what there is to say to it, or why not. To a bus every fault is an order; `mend` ends them,
    /// `servos` tells how the servos are. A box or a tablet has hands only by its script.
    pub(super) fn order(&mut self, now_us: u64, order: &str) -> Result<String, String> {
        let Self::Bus(bus, ..) = self else {
            return Err("expected no orders: hands on this device come from --script".to_owned());
        };
        match order.trim() {
            "mend" => {
                bus.mend(now_us);
                Ok("mended".to_owned())
            }
            "servos" => Ok(servos(bus)),
            text => {
                let fault =
                    Fault::parse(text).map_err(|error| format!("`{text}`: {error}; an order is {WORDS}"))?;
                // Later there may be one with that number.
                if fault.at_us.is_none() {
                    nobody(bus, &fault)?;
                }
                bus.inject(now_us, &fault);
                Ok(fault.to_string())
            }
        }
    }
}

/// Refuses a fault of a servo that is not there.
pub(super) fn nobody(bus: &ServoBus, fault: &Fault) -> Result<(), String> {
    match fault.kind {
        FaultKind::Servo(id, _) if bus.servo(id).is_none() => {
            let ids: Vec<String> = bus.servos().iter().map(|servo| servo.id().to_string()).collect();
            Err(format!("there is no servo {id}; there are {}", ids.join(", ")))
        }
        _ => Ok(()),
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
