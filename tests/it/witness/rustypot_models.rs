//! `rustypot` 1.13.1's `Bus`, which knows servos by name, on every model it has a definition for: finds, names,
//! configures, reads every register it lists, writes, reads in groups. Where its tables differ from the makers', that
//! is asserted as it is.

use super::{BAUD, in_time, patiently, pause};
use device_profiles::{Profiles, Role, ServoProfile, ServoProtocol};
use dialrig_tests::simulated::Served;
use firmware_sim::ServoBus;
use firmware_sim::servo_bus::{BusOptions, Unit};
use rustypot::bus::Bus;
use rustypot::servo::dynamixel::{ax, mx, xl320, xl330, xl430};
use rustypot::servo::feetech::{scs0009, sts3215};
use rustypot::servo::{RegisterInfo, ServoDefinition};
use std::collections::BTreeMap;
use std::time::Duration;

const IDS: [u8; 3] = [1, 2, 3];

/// Each model with the definition it is driven by.
const MODELS: [(&str, ServoDefinition); 12] = [
    ("xl330-m288", xl330::DEFINITION),
    ("xl330-m077", xl330::DEFINITION),
    ("xl430-w250", xl430::DEFINITION),
    // It has no definition of its own for these: "XL430 (= XM430 table)".
    ("xm430-w350", xl430::DEFINITION),
    ("xm540-w270", xl430::DEFINITION),
    ("mx-28-2", xl430::DEFINITION),
    ("mx-28", mx::DEFINITION),
    ("ax-12a", ax::DEFINITION),
    ("xl-320", xl320::DEFINITION),
    ("sts3215", sts3215::DEFINITION),
    ("sts3250", sts3215::DEFINITION),
    ("scs0009", scs0009::DEFINITION),
];

struct Peer {
    served: Served<ServoBus>,
    bus: Bus,
    profile: ServoProfile,
    definition: ServoDefinition,
}

impl Peer {
    fn on(model: &str, definition: ServoDefinition) -> Self {
        let profiles = Profiles::builtin();
        let profile = profiles.servo(model).expect("it is built in").clone();
        let mut bus = ServoBus::new(BusOptions::default());
        for id in IDS {
            let unit = Unit {
                return_delay_us: Some(0),
                ..Unit::new(id)
            };
            bus.add(&profile, unit).expect("an id and a speed that there are");
        }
        let served = Served::start(bus).expect("a pseudo-terminal");
        let port = serialport::new(served.path_text(), BAUD)
            .timeout(Duration::from_millis(200))
            .open()
            .expect("the terminal opens");
        let motors = (1..=9).map(|id| (id, definition)).collect();
        Self {
            served,
            bus: Bus::new(port, motors),
            profile,
            definition,
        }
    }

    /// Size and value of what the servo `id` holds at `address`, without asking on the wire. No value: one of many
    /// that are alike.
    fn truth(&self, id: u8, address: u16) -> Option<(u8, Option<i64>)> {
        let row = self.profile.register_at(address)?;
        let begins = (address - row.address).is_multiple_of(row.size.into());
        let value = self.served.with(|bus, _| {
            let servo = bus.servo(id).expect("it is on the bus");
            servo.register(&row.name).expect("the model has it")
        });
        begins.then_some((row.size, (row.count == 1).then_some(value)))
    }

    fn value(&self, id: u8, role: Role) -> i64 {
        self.served.with(|bus, _| {
            bus.servo(id)
                .expect("on the bus")
                .register_of(role)
                .expect("has it")
        })
    }

    /// The first of its names for a register that the definition has.
    fn named(&self, names: &[&'static str]) -> &'static str {
        let found = names.iter().find(|name| self.definition.register(name).is_some());
        found.unwrap_or_else(|| panic!("{}: none of {names:?}", self.definition.name))
    }
}

#[test]
fn it_finds_and_names_every_model() {
    for (model, definition) in MODELS {
        let mut peer = Peer::on(model, definition);
        let number = peer.profile.model_number;
        let expected: BTreeMap<u8, u16> = IDS.map(|id| (id, number)).into();
        patiently(model, || {
            let found = peer
                .bus
                .scan(definition, &[1, 2, 3, 4])
                .map_err(|error| error.to_string())?;
            if found == expected {
                Ok(())
            } else {
                Err(format!("{found:?}"))
            }
        });
        // It asks those only that answer in turn; an AX or an SCS it does not ask.
        assert_eq!(
            definition.info.supports_broadcast_ping, peer.profile.broadcast_ping,
            "{model}"
        );
        if definition.info.supports_broadcast_ping {
            patiently(model, || {
                let found = peer
                    .bus
                    .broadcast_scan(definition, &[1, 2, 3, 4])
                    .map_err(|error| error.to_string())?;
                if found == expected {
                    Ok(())
                } else {
                    Err(format!("{found:?}"))
                }
            });
        }
    }
}

#[test]
fn it_reads_every_register_it_lists() {
    let mut different = Vec::new();
    for (model, definition) in MODELS {
        let mut peer = Peer::on(model, definition);
        for reg in definition.registers {
            let read = patiently(reg.name, || peer.bus.read_register(2, reg.name));
            let here = format!("{model} {} at {}", reg.name, reg.addr);
            match peer.truth(2, reg.addr.into()) {
                None => different.push(format!("{here}: nothing begins there")),
                Some((size, _)) if size != reg.size => {
                    different.push(format!("{here}: {} bytes, not {size}", reg.size));
                }
                // The servo's clock goes on.
                Some((_, Some(truth))) if reg.name != "realtime_tick" && !same(reg, read, truth) => {
                    different.push(format!("{here}: {read}, not {truth}"));
                }
                Some(_) => {}
            }
        }
    }
    assert_eq!(different, KNOWN, "{different:#?}");
}

/// Whether two readings of the same bytes agree, whatever each makes of a sign.
fn same(reg: &RegisterInfo, read: i64, truth: i64) -> bool {
    let mask = if reg.size >= 8 {
        !0
    } else {
        (1_i64 << (8 * reg.size)) - 1
    };
    let magnitude = |bit: u32| (truth.abs() | i64::from(truth < 0) << bit) & mask;
    read == truth
        || read & mask == truth & mask
        || [10, 11, 15].iter().any(|&bit| read & mask == magnitude(bit))
}

/// Where its tables and the makers' part: it drives the MX-28 and the XL430 by the table of the XM430, which has a current
/// sensor and newer firmware, and lists an Acceleration Limit that the X series' pages no longer have.
const KNOWN: &[&str] = &[
    "xl330-m288 acceleration_limit at 40: nothing begins there",
    "xl330-m077 acceleration_limit at 40: nothing begins there",
    "xl430-w250 current_limit at 38: nothing begins there",
    "xl430-w250 goal_current at 102: nothing begins there",
    "mx-28-2 current_limit at 38: nothing begins there",
    "mx-28-2 startup_configuration at 60: nothing begins there",
    "mx-28-2 goal_current at 102: nothing begins there",
    "mx-28-2 backup_ready at 147: nothing begins there",
];

#[test]
fn it_gives_numbers_and_speeds() {
    for (model, definition) in MODELS {
        let mut peer = Peer::on(model, definition);
        let is_deaf = peer.profile.eeprom_deaf_us_per_byte.is_some();
        let settle = || pause(if is_deaf { 40 } else { 0 });
        patiently(model, || {
            let changed = peer
                .bus
                .change_id(definition, 3, 9)
                .map_err(|error| error.to_string());
            settle();
            // Asked again after an answer that was lost on our side, the number is another already.
            let there = peer.served.with(|bus, _| bus.servo(9).is_some());
            if there { Ok(()) } else { changed }
        });
        // Its tables give speeds to those only that it has tried.
        let (speed, code) = match definition
            .info
            .baudrates
            .iter()
            .find(|(speed, _)| *speed == 57_600)
        {
            Some(&(speed, code)) => (speed, Some(code)),
            None => (57_600, None),
        };
        let ours = peer.profile.baud_code(speed).expect("the model has it");
        match code {
            Some(code) if code != ours => {
                // It counts 57600 as 5, where the maker's own libraries have 76800 (vendor's INST.h: 6).
                assert!(
                    matches!(peer.profile.protocol, ServoProtocol::Sts | ServoProtocol::Scs),
                    "{model}"
                );
                assert_eq!((code, ours), (5, 6), "{model}");
                assert_eq!(peer.profile.baud_of_code(code), Some(76_800), "{model}");
                continue;
            }
            Some(_) => patiently(model, || peer.bus.change_baudrate(definition, 1, speed)),
            None => {
                let name = peer.named(&["baud_rate", "baudrate"]);
                patiently(model, || peer.bus.write_register(1, name, ours.into()));
            }
        }
        settle();
        peer.bus.set_baudrate(speed).expect("the terminal takes it");
        // Not by its scan, which leaves a servo 5.5 ms, of which the wire takes 4.9 at this speed.
        let number = patiently(model, || peer.bus.read_register(1, "model_number"));
        assert_eq!(number, i64::from(peer.profile.model_number), "{model}");
        assert!(
            peer.bus.read_register(2, "model_number").is_err(),
            "{model}: 2 is at the old speed"
        );
    }
}

#[test]
fn it_moves_and_reads_them_together() {
    for (model, definition) in MODELS {
        let mut peer = Peer::on(model, definition);
        let (torque, goal, present) = ("torque_enable", "goal_position", "present_position");
        patiently(model, || {
            let failed = peer.bus.set_torque(&IDS, true, 3);
            if failed.is_empty() {
                Ok(())
            } else {
                Err(format!("{failed:?}"))
            }
        });
        for id in IDS {
            assert_eq!(peer.value(id, Role::TorqueEnable), 1, "{model} {torque}");
        }
        let centre = i64::from(peer.profile.centre_counts);
        let goals = [centre - 40, centre + 30, centre + 90];
        patiently(model, || peer.bus.sync_write_register(&IDS, goal, &goals));
        in_time(model, || {
            IDS.iter()
                .zip(goals)
                .all(|(&id, goal)| peer.value(id, Role::PresentPosition) == goal)
        });
        // It believes that an AX and an MX know sync read, which protocol 1.0 of ROBOTIS has not; asked one by one
        // they answer, as an SCS always is.
        let believes = definition.info.supports_sync_read;
        if believes && !peer.profile.sync_read {
            assert_eq!(peer.profile.protocol, ServoProtocol::Dynamixel1, "{model}");
            let read = peer.bus.sync_read_register(&IDS, present);
            assert!(read.is_err(), "{model}: it is mended: {read:?}");
            pause(50);
            for (id, goal) in IDS.into_iter().zip(goals) {
                assert_eq!(
                    patiently(model, || peer.bus.read_register(id, present)),
                    goal,
                    "{model}"
                );
            }
        } else {
            let read = patiently(model, || peer.bus.sync_read_register(&IDS, present));
            assert_eq!(read, goals, "{model}");
        }
        patiently(model, || {
            let failed = peer.bus.set_torque(&IDS, false, 3);
            if failed.is_empty() {
                Ok(())
            } else {
                Err(format!("{failed:?}"))
            }
        });
        assert_eq!(peer.value(1, Role::TorqueEnable), 0, "{model}");
    }
}

/// The X and STS servos of Reachy Mini, both protocols on one line, in one call.
#[test]
fn it_reads_two_protocols_on_one_line() {
    let profiles = Profiles::builtin();
    let mut sim = ServoBus::new(BusOptions::default());
    for (id, model) in [(1, "sts3215"), (2, "xl330-m288")] {
        let unit = Unit {
            return_delay_us: Some(0),
            ..Unit::new(id)
        };
        sim.add(profiles.servo(model).expect("built in"), unit)
            .expect("fits");
    }
    let served = Served::start(sim).expect("a pseudo-terminal");
    let port = serialport::new(served.path_text(), BAUD)
        .timeout(Duration::from_millis(200))
        .open()
        .expect("the terminal opens");
    let mut bus = Bus::new(port, [(1, sts3215::DEFINITION), (2, xl330::DEFINITION)].into());
    for _ in 0..5 {
        let read = patiently("both", || bus.sync_read_register(&[1, 2], "present_position"));
        assert_eq!(read, [2048, 2048]);
    }
}
