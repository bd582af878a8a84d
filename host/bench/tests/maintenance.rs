//! Looking after simulated servos of every protocol, alone and mixed, in virtual time.

use bench::stand::{SimPorts, Stand};
use device::clock::VirtualClock;
use device_profiles::{Profiles, Role};
use firmware_sim::servo_bus::{Adapter, BusOptions, Unit};
use firmware_sim::{Fault, ServoBus};
use rig::maintenance::{Backup, FoundServo, Keep, ServoLine, ServoLineError, ServoProtocol};
use std::sync::Arc;

const BAUD: u32 = 1_000_000;

/// One servo of each kind, the last of them not set up yet.
const CHAIN: [(&str, u8); 6] = [
    ("XL330-M288", 11),
    ("AX-12A", 12),
    ("STS3215", 13),
    ("SCS0009", 14),
    ("XL-320", 15),
    ("MX-28", 16),
];

/// A line with these servos, and options of its own.
struct Line {
    servos: Vec<(&'static str, Unit)>,
    options: BusOptions,
    faults: &'static [&'static str],
}

impl Line {
    fn of(servos: &[(&'static str, u8)]) -> Self {
        Self {
            servos: servos.iter().map(|&(model, id)| (model, Unit::new(id))).collect(),
            options: BusOptions {
                baud: BAUD,
                seed: 7,
                ..BusOptions::default()
            },
            faults: &[],
        }
    }

    fn open(self, protocol: Option<ServoProtocol>) -> ServoLine {
        let profiles = Profiles::builtin();
        let baud = self.options.baud;
        let mut bus = ServoBus::new(self.options);
        for (model, unit) in self.servos {
            bus.add(profiles.servo(model).expect(model), unit).expect("fits");
        }
        for text in self.faults {
            bus.inject(0, &Fault::parse(text).expect(text));
        }
        let clock = Arc::new(VirtualClock::new());
        let stand = Stand::builder(clock.clone())
            .servo_bus("line", bus)
            .expect("alone")
            .build();
        let mut ports = SimPorts::new(stand);
        ServoLine::open(&mut ports, "sim:line", baud, protocol, clock, Arc::new(profiles)).expect("opens")
    }
}

fn named(found: &[FoundServo]) -> Vec<(String, u8)> {
    let name = |found: &FoundServo| (found.model.clone().unwrap_or_default(), found.id);
    found.iter().map(name).collect()
}

fn chain() -> Vec<(String, u8)> {
    CHAIN.iter().map(|&(model, id)| (model.to_owned(), id)).collect()
}

#[test]
fn a_scan_finds_every_make_on_one_line_whatever_the_adapter() {
    let slow = Adapter {
        chunk: 62,
        latency_us: 16_000,
    };
    for (echo, adapter) in [
        (false, None),
        (true, None),
        (false, Some(slow)),
        (true, Some(slow)),
    ] {
        let mut line = Line::of(&CHAIN);
        line.options.echo = echo;
        line.options.adapter = adapter;
        let mut line = line.open(None);
        let found = line
            .scan(&[BAUD], &mut |heard| assert!(!heard.garbled))
            .expect("scans");
        assert_eq!(named(&found), chain(), "echo {echo}, adapter {adapter:?}");
        assert!(found.iter().all(|found| !found.fresh));
    }
}

#[test]
fn one_protocol_hears_only_its_own() {
    for (protocol, ids) in [
        (ServoProtocol::Dynamixel2, vec![11, 15]),
        (ServoProtocol::Dynamixel1, vec![12, 16]),
        (ServoProtocol::Sts, vec![13]),
        (ServoProtocol::Scs, vec![14]),
    ] {
        let mut line = Line::of(&CHAIN).open(Some(protocol));
        let found = line.scan(&[BAUD], &mut |_| {}).expect("scans");
        let found: Vec<u8> = found.iter().map(|found| found.id).collect();
        assert_eq!(found, ids, "{protocol}");
    }
}

#[test]
fn a_servo_from_its_box_is_found_and_known_as_such() {
    let mut line = Line::of(&[("XL430-W250", 5), ("XL330-M288", 1)]);
    line.servos[1].1.baud = Some(57_600);
    let mut line = line.open(None);
    let bauds = line.known_bauds();
    assert!(bauds.contains(&57_600) && bauds.contains(&BAUD), "{bauds:?}");
    let found = line.scan(&bauds, &mut |_| {}).expect("scans");
    let fresh: Vec<_> = found
        .iter()
        .map(|found| (found.id, found.baud, found.fresh))
        .collect();
    assert_eq!(fresh, [(1, 57_600, true), (5, BAUD, false)]);
}

#[test]
fn two_servos_with_one_id_are_named() {
    for (model, other) in [
        ("XL330-M288", "XL430-W250"),
        ("STS3215", "SCS0009"),
        ("AX-12A", "STS3250"),
    ] {
        let mut line = Line::of(&[(model, 3), (other, 3), (model, 9)]).open(None);
        let mut garbled = false;
        let found = line
            .scan(&[BAUD], &mut |heard| garbled |= heard.garbled)
            .expect("scans");
        assert!(garbled, "{model}");
        let found: Vec<FoundServo> = found.into_iter().filter(|found| found.id != 3).collect();
        assert_eq!(named(&found), [(model.to_owned(), 9)]);
        assert_eq!(line.twice_used_ids(BAUD, &found).expect("asks"), [3], "{model}");
    }
}

#[test]
fn every_make_is_read_by_role_and_by_its_makers_names() {
    let mut line = Line::of(&CHAIN).open(None);
    for (_, id) in CHAIN {
        for role in ["present-position", "present-voltage", "present-temperature", "id"] {
            let values = line
                .read(id, Some(role))
                .unwrap_or_else(|error| panic!("{id} {role}: {error}"));
            assert_eq!(values[0].role.map(|role| role.to_string()).as_deref(), Some(role));
            if role == "id" {
                assert_eq!(values[0].raw, i64::from(id));
            }
        }
        let all = line.read(id, None).expect("reads all");
        assert!(all.len() > 20, "{id}: {}", all.len());
    }
    let position = &line.read(12, Some("Present Position")).expect("AX")[0];
    assert_eq!((position.raw, position.address), (512, 36));
    let position = &line.read(14, Some("present position")).expect("SCS")[0];
    assert_eq!(position.raw, 512, "words with their high byte first");
}

#[test]
fn settings_are_written_where_they_differ_and_kept_through_locks() {
    let mut line = Line::of(&CHAIN).open(None);
    for (model, id) in CHAIN {
        let profile = Profiles::builtin().servo(model).expect("built in").clone();
        let limit = profile
            .role(Role::TemperatureLimit)
            .expect("all have it")
            .name
            .clone();
        let value = line
            .write(id, &limit, 66)
            .unwrap_or_else(|error| panic!("{model}: {error}"));
        assert_eq!(value.raw, 66, "{model}");
        // Feetech's lock is closed again; the value is in the EEPROM behind it.
        if profile.role(Role::Lock).is_some() {
            let lock = line.read(id, Some("lock")).expect("reads")[0].raw;
            let factory = profile.role(Role::Lock).and_then(|row| row.init).expect("known");
            assert_eq!(lock, factory, "{model}");
        }
        if profile.protocol != ServoProtocol::Dynamixel1 {
            line.reboot(id).unwrap_or_else(|error| panic!("{model}: {error}"));
            assert_eq!(
                line.read(id, Some("temperature-limit")).expect("reads")[0].raw,
                66,
                "{model} after a reboot"
            );
        }
    }
}

#[test]
fn an_ax_whose_lock_is_set_says_what_unlocks_it() {
    let mut line = Line::of(&CHAIN).open(None);
    line.write(12, "Lock", 1).expect("RAM");
    let error = line.write(12, "temperature-limit", 66).expect_err("locked");
    assert!(error.to_string().contains("power off and on"), "{error}");
    assert!(error.is_of_device());
}

#[test]
fn what_can_move_a_servo_is_refused_before_anything_is_written() {
    let mut line = Line::of(&CHAIN).open(None);
    for (_, id) in CHAIN {
        for (register, raw) in [("goal-position", 100), ("torque-enable", 1), ("goal-velocity", 3)] {
            match line.write(id, register, raw) {
                Err(error) => assert!(!error.is_of_device(), "{error}"),
                Ok(value) => panic!("{id}: {value:?}"),
            }
        }
    }
    assert!(line.write(11, "Indirect Address 1", 5).is_err());
    assert!(line.is_released(11).expect("asks"));
}

#[test]
fn refusals_are_errors_in_the_protocols_own_words() {
    let mut line = Line::of(&CHAIN).open(None);
    let text = |result: Result<_, ServoLineError>| {
        result
            .map(|_: rig::maintenance::RegisterValue| ())
            .expect_err("refused")
            .to_string()
    };
    let said = text(line.write(11, "Model Number", 5));
    assert!(said.contains("read only"), "{said}");
    let said = text(line.write(11, "temperature-limit", 400));
    assert!(said.contains("from 0 to 100"), "{said}");
    let said = text(line.write(11, "no such", 4));
    assert!(said.contains("it has: Model Number"), "{said}");
    let said = text(line.write(99, "led", 1));
    assert!(said.contains("does not answer at 1000000 baud"), "{said}");
    // A profile cannot know this one: bounds that another register sets.
    line.write(11, "Max Voltage Limit", 60).expect("legal");
    let said = line
        .backup(12, Backup::Store)
        .expect_err("no such thing")
        .to_string();
    assert_eq!(said, "DYNAMIXEL 1.0 has no such backup");
}

#[test]
fn ids_are_changed_and_checked_at_the_new_id() {
    let mut line = Line::of(&CHAIN).open(None);
    for (model, id) in CHAIN {
        let found = line
            .set_id(id, id + 100)
            .unwrap_or_else(|error| panic!("{model}: {error}"));
        assert_eq!((found.id, found.model.as_deref()), (id + 100, Some(model)));
        assert!(line.ping(id).is_err(), "{model} has left its id");
    }
    let taken = line.set_id(111, 113).expect_err("in use");
    assert!(!taken.is_of_device(), "{taken}");
    assert_eq!(
        taken.to_string(),
        "id 113 is in use on this line; choose a free one"
    );
    let found = line.scan(&[BAUD], &mut |_| {}).expect("scans");
    assert_eq!(found.len(), CHAIN.len());
}

#[test]
fn line_speeds_are_changed_and_checked_there() {
    for (model, id) in CHAIN {
        let mut line = Line::of(&[(model, id)]).open(None);
        let slower = if model == "STS3215" || model == "SCS0009" {
            500_000
        } else {
            57_600
        };
        let found = line
            .set_baud(id, slower)
            .unwrap_or_else(|error| panic!("{model}: {error}"));
        assert_eq!((found.baud, line.baud()), (slower, slower), "{model}");
        let back = line
            .set_baud(id, BAUD)
            .unwrap_or_else(|error| panic!("{model}: {error}"));
        assert_eq!(back.baud, BAUD, "{model}");
        let error = line.set_baud(id, 12_345).expect_err("no such speed");
        assert!(
            !error.is_of_device() && error.to_string().contains("it knows"),
            "{error}"
        );
    }
}

#[test]
fn a_factory_reset_says_where_the_servo_is_then() {
    for (model, keep, want) in [
        ("XL330-M288", Keep::Nothing, (1, 57_600)),
        ("XL330-M288", Keep::Id, (11, 57_600)),
        ("XL330-M288", Keep::IdAndBaud, (11, BAUD)),
        ("STS3215", Keep::Id, (11, BAUD)),
    ] {
        let mut line = Line::of(&[(model, 11)]).open(None);
        line.write(11, "temperature-limit", 55).expect("writes");
        let found = line
            .factory_reset(11, keep)
            .unwrap_or_else(|error| panic!("{model}: {error}"));
        assert_eq!((found.id, found.baud), want, "{model} {keep:?}");
        assert_ne!(
            line.read(want.0, Some("temperature-limit")).expect("reads")[0].raw,
            55,
            "{model}"
        );
    }
    let mut line = Line::of(&[("STS3215", 11)]).open(None);
    let error = line
        .factory_reset(11, Keep::Nothing)
        .expect_err("it keeps the id");
    assert!(!error.is_of_device(), "{error}");
}

#[test]
fn turns_are_forgotten_and_settings_copied_and_brought_back() {
    let mut line = Line::of(&[("XL330-M288", 11)]).open(None);
    line.clear(11).expect("stands still");
    line.write(11, "temperature-limit", 55).expect("writes");
    line.backup(11, Backup::Store).expect("stores");
    line.write(11, "temperature-limit", 66).expect("writes");
    line.backup(11, Backup::Restore).expect("restores");
    assert_eq!(
        line.read(11, Some("temperature-limit")).expect("reads")[0].raw,
        55
    );
}

#[test]
fn everybody_is_let_go_of_and_says_so() {
    let mut line = Line::of(&CHAIN);
    line.options.echo = true;
    let mut line = line.open(None);
    line.release().expect("sends");
    let found = line.scan(&[BAUD], &mut |_| {}).expect("scans");
    line.release().expect("sends");
    for found in found {
        assert!(line.is_released(found.id).expect("answers"), "{}", found.id);
    }
}

#[test]
fn noise_and_lost_answers_are_asked_again() {
    let mut line = Line::of(&CHAIN);
    line.faults = &["drop 5%", "noise 0.2%"];
    let mut line = line.open(None);
    let mut good = 0;
    for round in 0..10 {
        for (_, id) in CHAIN {
            if let Ok(values) = line.read(id, Some("id")) {
                assert_eq!(values[0].raw, i64::from(id), "round {round}");
                good += 1;
            }
        }
    }
    assert!(good >= 57, "{good} of 60");
}
