//! A bus of XL430 as the servo reference measures it: so many of them, 1 Mbaud, return delay 0.

use device::servo::{Limits, Member};
use device_profiles::{Profiles, ServoProfile};
use firmware_sim::ServoBus;
use firmware_sim::servo_bus::{BusOptions, Unit};

/// Present Position of the X series; Goal Position is 116. Source: their control tables.
pub const POSITION: u16 = 132;

/// The model everybody measures with.
pub(crate) fn xl430() -> ServoProfile {
    let profiles = Profiles::builtin();
    let profile = profiles.servo("xl430-w250").expect("it is built in");
    profile.clone()
}

/// `count` servos with ids from 1, ready to answer at once.
pub fn bus_of(count: u8, options: BusOptions) -> ServoBus {
    let mut bus = ServoBus::new(options);
    for id in 1..=count {
        let unit = Unit {
            return_delay_us: Some(0),
            ..Unit::new(id)
        };
        bus.add(&xl430(), unit)
            .expect("ids from 1 at a speed the model has");
    }
    bus
}

/// The same servos as our own bus drives them, each with a range around the middle of its turn.
pub fn members(count: u8) -> Vec<Member> {
    let limits = Limits::new([-1.5, 1.5], 4.0, 20.0).expect("numbers in order");
    let of = |id: u8| {
        let profile = xl430();
        let centre = profile.centre_counts;
        Member::new(&format!("joint {id}"), id, profile, 1, centre, limits).expect("the range fits the turn")
    };
    (1..=count).map(of).collect()
}
