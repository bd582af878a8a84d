//! The buses that faults are tried on: one for each way of reading.

use device::servo::{Limits, Member};
use device_profiles::{Profiles, ServoProfile};
use firmware_sim::ServoBus;
use firmware_sim::servo_bus::{BusOptions, Unit};

/// Servos of one bus, by their profiles; ids from 1.
pub(crate) struct Chain {
    pub(crate) name: &'static str,
    pub(crate) models: &'static [&'static str],
}

/// Protocol 2.0 by sync and fast sync read, by bulk read, STS by sync read, protocol 1.0 with and without bulk read, SCS,
/// and two pairs that share a line.
pub(crate) const CHAINS: [Chain; 6] = [
    Chain {
        name: "xl430",
        models: &["xl430-w250"; 6],
    },
    Chain {
        name: "xl430 xl330 mx28 by bulk",
        models: &["xl430-w250", "xl330-m288", "mx-28-2", "xl430-w250", "xl330-m288"],
    },
    Chain {
        name: "sts",
        models: &["sts3215"; 6],
    },
    Chain {
        name: "mx28 ax by protocol 1",
        models: &["mx-28", "mx-28", "mx-28", "ax-12a", "ax-12a"],
    },
    Chain {
        name: "xl430 ax",
        models: &["xl430-w250", "ax-12a", "xl430-w250", "ax-12a", "xl430-w250"],
    },
    Chain {
        name: "sts scs",
        models: &["sts3215", "scs0009", "sts3215", "scs0009"],
    },
];

impl Chain {
    fn profiles(&self) -> anyhow::Result<Vec<ServoProfile>> {
        let profiles = Profiles::builtin();
        let models = self.models.iter().map(|model| Ok(profiles.servo(model)?.clone()));
        models.collect()
    }

    /// The servos.
    pub(crate) fn bus(&self, options: BusOptions) -> anyhow::Result<ServoBus> {
        let mut bus = ServoBus::new(options);
        for (profile, id) in self.profiles()?.iter().zip(1..) {
            let unit = Unit {
                return_delay_us: Some(0),
                turnaround_us: 20,
                ..Unit::new(id)
            };
            bus.add(profile, unit)?;
        }
        Ok(bus)
    }

    /// The same servos as the driver knows them.
    pub(crate) fn members(&self) -> anyhow::Result<Vec<Member>> {
        let limits = Limits::new([-1.0, 1.0], 4.0, 20.0)?;
        let of = |(profile, id): (ServoProfile, u8)| {
            let centre = profile.centre_counts;
            Ok(Member::new(
                &format!("joint {id}"),
                id,
                profile,
                1,
                centre,
                limits,
            )?)
        };
        self.profiles()?.into_iter().zip(1..).map(of).collect()
    }
}
