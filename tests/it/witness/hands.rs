//! Our own bus beside the libraries, on the same served servos.

use super::{BAUD, patiently};
use device::MonotonicClock;
use device::servo::{Bus, BusSettings};
use device::transport::serial;
use dialrig_tests::simulated::{Served, members};
use firmware_sim::ServoBus;

/// The ids that our bus has read within a few looks, out of `count` that it expects.
pub(super) fn readings(served: &Served<ServoBus>, count: u8) -> Vec<u8> {
    let clock = MonotonicClock::new();
    let transport = patiently("opening", || serial::open(&served.path_text(), BAUD));
    let settings = BusSettings::new("ours", BAUD);
    let mut bus = Bus::new(Box::new(transport), members(count), settings).expect("ids from 1");
    for _ in 0..8 {
        bus.observe_blocking(&clock, &mut |_| {})
            .expect("the line is there");
    }
    let read = (0..usize::from(count)).filter(|&at| bus.reading(at).is_some());
    read.map(|at| at as u8 + 1).collect()
}
