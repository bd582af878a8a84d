//! Our own bus beside the libraries, on the same served servos.

use super::{BAUD, in_time, patiently};
use device::MonotonicClock;
use device::servo::{Bus, BusSettings};
use device::transport::serial;
use dialrig_tests::simulated::{Served, members};
use firmware_sim::ServoBus;

/// Looks until our bus has read all of `there`, out of `count` that it expects, and gives all that it has read.
pub(super) fn readings(served: &Served<ServoBus>, count: u8, there: &[u8]) -> Vec<u8> {
    let clock = MonotonicClock::new();
    let transport = patiently("opening", || serial::open(&served.path_text(), BAUD));
    let settings = BusSettings::new("ours", BAUD);
    let mut bus = Bus::new(Box::new(transport), members(count), settings).expect("ids from 1");
    let mut read = Vec::new();
    in_time("our bus reads what is there", || {
        bus.observe_blocking(&clock, &mut |_| {})
            .expect("the line is there");
        let known = (0..usize::from(count)).filter(|&at| bus.reading(at).is_some());
        read = known.map(|at| at as u8 + 1).collect();
        there.iter().all(|id| read.contains(id))
    });
    read
}
