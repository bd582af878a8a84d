//! Programs that know nothing of ours, on our simulated devices behind pseudo-terminals.
//!
//! Two published servo libraries drive the simulated bus, with every model they know; two readers written here from the documented bytes alone
//! listen to the simulated dial box and tablet, and our own codecs listen to the same. Where a library is known to
//! be wrong, its wrong behaviour is asserted with the reason, so that a corrected version is noticed.

mod dial_box;
mod dynamixel2_models;
mod dynamixel2_peer;
mod hands;
mod rustypot_models;
mod rustypot_peer;
mod tablet;

use device::{Clock, MonotonicClock};
use dialrig_tests::simulated::Served;
use firmware_sim::servo_bus::{BusOptions, Unit};
use firmware_sim::{Fault, ServoBus};
use std::time::Duration;

/// How often something is tried that fails only where the machine stops us for longer than a library waits.
const TRIES: usize = 8;
/// Bits a second on the simulated bus.
const BAUD: u32 = 1_000_000;
/// The model number of the XL430-W250. Source: its control table.
const MODEL: u16 = 1060;
/// Addresses of the X series. Source: its control tables.
const PWM_LIMIT: u8 = 36;
const TORQUE_ENABLE: u8 = 64;
const LED: u8 = 65;
const GOAL_POSITION: u8 = 116;
const PRESENT_POSITION: u8 = 132;
/// 28 bytes that hold whatever is written to them.
const INDIRECT_DATA: u8 = 224;

/// Tries until it goes well; the last failure is told.
fn patiently<T, E: std::fmt::Display>(what: &str, mut act: impl FnMut() -> Result<T, E>) -> T {
    let mut last = String::new();
    for _ in 0..TRIES {
        match act() {
            Ok(done) => return done,
            Err(error) => last = error.to_string(),
        }
        pause(100);
    }
    panic!("{what}: {last}");
}

/// Tries until it is so.
fn in_time(what: &str, mut holds: impl FnMut() -> bool) {
    for _ in 0..60 {
        if holds() {
            return;
        }
        pause(50);
    }
    panic!("never came about: {what}");
}

fn pause(ms: u64) {
    let clock = MonotonicClock::new();
    clock.sleep_until(clock.now().after(Duration::from_millis(ms)));
}

/// `count` XL430 with ids from 1 behind a terminal, without the numbers in `missing`.
fn served(count: u8, missing: &[u8], options: BusOptions) -> Served<ServoBus> {
    let profiles = device_profiles::Profiles::builtin();
    let profile = profiles.servo("xl430-w250").expect("it is built in");
    let mut bus = ServoBus::new(options);
    for id in (1..=count).filter(|id| !missing.contains(id)) {
        let unit = Unit {
            return_delay_us: Some(0),
            ..Unit::new(id)
        };
        bus.add(profile, unit).expect("an id and a speed that there are");
    }
    Served::start(bus).expect("a pseudo-terminal")
}

/// Brings in a fault by name.
fn inject(served: &Served<ServoBus>, text: &str) {
    let fault = Fault::parse(text).expect("a fault");
    served.with(|bus, now_us| bus.inject(now_us, &fault));
}

/// A register of a simulated servo, without asking on the wire.
fn register(served: &Served<ServoBus>, id: u8, name: &str) -> i64 {
    served.with(|bus, _| {
        let servo = bus.servo(id).expect("it is on the bus");
        servo.register(name).expect("the model has it")
    })
}
