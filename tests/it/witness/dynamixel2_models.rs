//! `dynamixel2` 0.9.1 on every model that speaks protocol 2.0: finds, names, configures, reads, writes, reads in groups.

use super::{BAUD, in_time, patiently};
use device_profiles::{Profiles, Role, ServoProfile, ServoProtocol};
use dialrig_tests::simulated::Served;
use dynamixel2::Bus;
use dynamixel2::instructions::SyncWriteData;
use firmware_sim::ServoBus;
use firmware_sim::servo_bus::{BusOptions, Unit};

const IDS: [u8; 3] = [1, 2, 3];

fn models() -> Vec<ServoProfile> {
    let profiles = Profiles::builtin();
    let speaks = |profile: &&ServoProfile| profile.protocol == ServoProtocol::Dynamixel2;
    let models: Vec<ServoProfile> = profiles.servos().filter(speaks).cloned().collect();
    assert!(models.len() >= 7, "{} models", models.len());
    models
}

fn served(profile: &ServoProfile) -> Served<ServoBus> {
    let mut bus = ServoBus::new(BusOptions::default());
    for id in IDS {
        let unit = Unit {
            return_delay_us: Some(0),
            ..Unit::new(id)
        };
        bus.add(profile, unit).expect("an id and a speed that there are");
    }
    Served::start(bus).expect("a pseudo-terminal")
}

fn value(served: &Served<ServoBus>, id: u8, role: Role) -> i64 {
    served.with(|bus, _| {
        bus.servo(id)
            .expect("on the bus")
            .register_of(role)
            .expect("has it")
    })
}

#[test]
fn it_finds_names_and_configures_every_model() {
    for profile in models() {
        let name = &profile.name;
        let served = served(&profile);
        let mut peer = Bus::open(served.path(), BAUD).expect("the terminal opens");
        let found = patiently(name, || {
            let answers = peer.scan().map_err(|error| error.to_string())?;
            let found: Vec<(u8, u16)> = answers
                .iter()
                .flatten()
                .map(|answer| (answer.motor_id, answer.data.model))
                .collect();
            if found.len() == IDS.len() {
                Ok(found)
            } else {
                Err(format!("{found:?}"))
            }
        });
        assert_eq!(found, IDS.map(|id| (id, profile.model_number)), "{name}");
        let address = |role| profile.role(role).expect("the model has it").address;
        patiently(name, || {
            let changed = peer
                .write_u8(3, address(Role::Id), 9)
                .map_err(|error| error.to_string());
            let there = served.with(|bus, _| bus.servo(9).is_some());
            if there { Ok(()) } else { changed.map(|_| ()) }
        });
        assert_eq!(patiently(name, || peer.ping(9)).data.model, profile.model_number);
        patiently(name, || peer.write_u8(9, address(Role::ReturnDelay), 20));
        assert_eq!(value(&served, 9, Role::ReturnDelay), 20, "{name}");
        let code = profile.baud_code(57_600).expect("the model has it");
        patiently(name, || peer.write_u8(9, address(Role::BaudRate), code));
        peer.set_baud_rate(57_600).expect("the terminal takes it");
        patiently(name, || peer.ping(9));
        assert!(peer.ping(1).is_err(), "{name}: 1 is at the old speed");
    }
}

#[test]
fn it_moves_every_model_and_reads_them_together() {
    for profile in models() {
        let name = &profile.name;
        let served = served(&profile);
        let mut peer = Bus::open(served.path(), BAUD).expect("the terminal opens");
        let row = |role| profile.role(role).expect("the model has it");
        let (goal, present) = (row(Role::GoalPosition), row(Role::PresentPosition));
        for id in IDS {
            patiently(name, || peer.write_u8(id, row(Role::TorqueEnable).address, 1));
        }
        let centre = profile.centre_counts as u32;
        let goals = [centre - 40, centre + 30, centre + 90];
        let all = || IDS.into_iter().zip(goals);
        if goal.size == 2 {
            let data: Vec<_> = all()
                .map(|(motor_id, data)| SyncWriteData {
                    motor_id,
                    data: data as u16,
                })
                .collect();
            patiently(name, || peer.sync_write_u16(goal.address, &data));
        } else {
            let data: Vec<_> = all()
                .map(|(motor_id, data)| SyncWriteData { motor_id, data })
                .collect();
            patiently(name, || peer.sync_write_u32(goal.address, &data));
        }
        in_time(name, || {
            all().all(|(id, goal)| value(&served, id, Role::PresentPosition) == i64::from(goal))
        });
        patiently(name, || {
            let read: Vec<u32> = if present.size == 2 {
                let read = peer.sync_read_u16(&IDS, present.address);
                let read = read.map_err(|error| error.to_string())?;
                read.iter().map(|answer| answer.data.into()).collect()
            } else {
                let read = peer.sync_read_u32(&IDS, present.address);
                let read = read.map_err(|error| error.to_string())?;
                read.iter().map(|answer| answer.data).collect()
            };
            // Where we were stopped for longer than it waits, it gives those that it has heard as a success.
            if read == goals {
                Ok(())
            } else {
                Err(format!("{read:?}"))
            }
        });
    }
}
