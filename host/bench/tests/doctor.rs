//! The doctor on simulated servos, in virtual time: every kind of finding from a fault of the simulator, and none from
//! a healthy bus.

#[path = "doctor/ward.rs"]
mod ward;

use device::transport::TransportError;
use rig::doctor::Kind;
use std::collections::BTreeSet;
use ward::{Bus, Ward};

/// One trouble: how the bus is made, what is expected to be found beside nothing else, and at which joint.
struct Row {
    kind: Kind,
    /// Other findings that come with it.
    also: &'static [Kind],
    joint: Option<&'static str>,
    bus: Box<dyn FnOnce(&mut Bus)>,
    /// Whether the arm's profile is named.
    puppet: bool,
}

/// Nothing but this, at that joint if one is named.
fn row(kind: Kind, joint: &'static str, bus: impl FnOnce(&mut Bus) + 'static) -> Row {
    Row {
        kind,
        also: &[],
        joint: (!joint.is_empty()).then_some(joint),
        bus: Box::new(bus),
        puppet: true,
    }
}

/// The same by faults of the simulator, as one types them.
fn faults(kind: Kind, joint: &'static str, texts: &'static [&'static str]) -> Row {
    row(kind, joint, move |bus| {
        for text in texts {
            bus.fault(text);
        }
    })
}

fn with(also: &'static [Kind], row: Row) -> Row {
    Row { also, ..row }
}

/// Ports that cannot be opened.
fn rows_of_ports() -> Vec<Row> {
    let address = || "/dev/ttyUSB9".to_owned();
    let refused = |error: TransportError| move |bus: &mut Bus| bus.refused = Some(error);
    vec![
        row(
            Kind::PortMissing,
            "",
            refused(TransportError::NotFound { address: address() }),
        ),
        row(
            Kind::PortForbidden,
            "",
            refused(TransportError::Forbidden {
                address: address(),
                hint: "",
            }),
        ),
        row(
            Kind::PortBusy,
            "",
            refused(TransportError::Busy { address: address() }),
        ),
    ]
}

/// Who is there and who is not.
fn rows_of_presence() -> Vec<Row> {
    use Kind::{
        Cable, DuplicateId, FactoryFresh, MissingServo, OtherBaud, SilentLine, UnexpectedServo, UnknownModel,
        WrongModel,
    };
    vec![
        faults(SilentLine, "", &["cable cut"]),
        faults(OtherBaud, "elbow", &["servo 3 baud 115200"]),
        faults(OtherBaud, "", &["every servo baud 57600"]),
        faults(Cable, "elbow", &["cable cut after 2"]),
        faults(Cable, "wrist", &["data cut after 3"]),
        faults(MissingServo, "shoulder", &["servo 2 silent"]),
        faults(MissingServo, "gripper", &["cable cut after 4"]),
        with(
            &[MissingServo],
            faults(DuplicateId, "shoulder", &["servo 3 id 2"]),
        ),
        faults(
            FactoryFresh,
            "elbow",
            &["servo 3 baud 57600", "servo 3 id 1 from 1us to 9999s"],
        ),
        row(WrongModel, "elbow", |bus| bus.replace(3, "XL430-W250")),
        with(
            &[WrongModel],
            faults(UnknownModel, "elbow", &["servo 3 has model-number 4242"]),
        ),
        row(UnexpectedServo, "", |bus| {
            bus.add("XL330-M288", 9);
        }),
    ]
}

/// Adapter, speed, noise and firmware.
fn rows_of_the_line() -> Vec<Row> {
    use Kind::{AdapterLatency, Echo, MixedFirmware, Noise, OldFirmware, SlowBaud};
    vec![
        row(AdapterLatency, "", |bus| bus.timer_ms = Some(16)),
        faults(AdapterLatency, "", &["adapter latency 16ms"]),
        faults(Echo, "", &["echo"]),
        faults(Noise, "", &["drop 3%"]),
        faults(Noise, "", &["noise 0.3%"]),
        faults(Noise, "wrist", &["servo 4 drop 10%"]),
        row(SlowBaud, "", |bus| bus.baud = 57_600),
        faults(OldFirmware, "base", &["every servo firmware 40"]),
        faults(MixedFirmware, "", &["servo 4 firmware 50"]),
    ]
}

/// What is set in a servo, and what that does to its joint's travel.
fn rows_of_settings() -> Vec<Row> {
    use Kind::{
        DriveMode, HomingOffset, LimitsInside, LimitsOutside, OperatingMode, OutOfRange, ReturnDelay,
        StatusLevel, Wrap,
    };
    vec![
        faults(ReturnDelay, "shoulder", &["servo 2 has return-delay 250"]),
        faults(StatusLevel, "shoulder", &["servo 2 has status-return-level 1"]),
        faults(OperatingMode, "shoulder", &["servo 2 has operating-mode 1"]),
        faults(DriveMode, "shoulder", &["servo 2 has drive-mode 8"]),
        faults(Wrap, "gripper", &["servo 5 has homing-offset 500"]),
        faults(HomingOffset, "shoulder", &["servo 2 has homing-offset 1500"]),
        faults(LimitsInside, "shoulder", &["servo 2 has max-position 2500"]),
        faults(LimitsOutside, "shoulder", &["servo 2 has max-position 900"]),
        row(OutOfRange, "wrist", |bus| bus.unit(4).start_rad = 2.0),
    ]
}

/// Models that the arm does not have, each by itself.
fn rows_of_others() -> Vec<Row> {
    let alone = |model: &'static str, text: &'static str, kind: Kind| Row {
        puppet: false,
        ..row(kind, "", move |bus: &mut Bus| {
            bus.servos.clear();
            bus.add(model, 1);
            bus.fault(text);
        })
    };
    vec![
        alone("STS3215", "servo 1 unlocked", Kind::Lock),
        alone("SCS0009", "servo 1 unlocked", Kind::Lock),
        alone("AX-12A", "servo 1 locked", Kind::Lock),
        alone("STS3215", "servo 1 has return-delay 100", Kind::ReturnDelay),
        alone("AX-12A", "servo 1 has status-return-level 1", Kind::StatusLevel),
        alone("STS3215", "servo 1 has operating-mode 1", Kind::OperatingMode),
        alone("STS3215", "servo 1 hot 68", Kind::Hot),
        alone("SCS0009", "servo 1 drop 10%", Kind::Noise),
        alone("AX-12A", "adapter latency 16ms", Kind::AdapterLatency),
        alone("XL-320", "servo 1 has return-delay 250", Kind::ReturnDelay),
    ]
}

/// Supply, heat and errors.
fn rows_of_health() -> Vec<Row> {
    use Kind::{HardwareError, Hot, LowVoltage, VoltageSag, WrongSupply};
    vec![
        faults(LowVoltage, "base", &["supply 3.6"]),
        with(&[HardwareError], faults(WrongSupply, "base", &["supply 12"])),
        with(
            &[HardwareError],
            faults(VoltageSag, "base", &["supply 3.4 for 100ms"]),
        ),
        faults(Hot, "elbow", &["servo 3 hot 66"]),
        faults(HardwareError, "base", &["servo 1 error 32"]),
    ]
}

fn rows() -> Vec<Row> {
    let parts = [
        rows_of_ports(),
        rows_of_presence(),
        rows_of_the_line(),
        rows_of_settings(),
        rows_of_health(),
        rows_of_others(),
    ];
    parts.into_iter().flatten().collect()
}

fn kinds(findings: &[rig::doctor::Finding]) -> BTreeSet<Kind> {
    findings.iter().map(|finding| finding.kind).collect()
}

#[test]
fn a_healthy_bus_gives_nothing() {
    for puppet in [true, false] {
        let mut ward = Ward::new(Bus::healthy(), puppet);
        let found = ward.look();
        assert!(found.is_empty(), "with puppet: {puppet}\n{found:#?}");
    }
}

/// Three of every model there is, at a speed that all three have and that is fast enough.
#[test]
fn healthy_servos_of_every_model_give_nothing() {
    for model in device_profiles::Profiles::builtin().servos() {
        let mut bus = Bus::healthy();
        bus.servos.clear();
        for id in 1..=3 {
            bus.add(&model.key, id);
        }
        let found = Ward::new(bus, false).look();
        assert!(found.is_empty(), "{}\n{found:#?}", model.name);
    }
}

#[test]
fn every_trouble_is_found_and_nothing_else() {
    let mut wrong = Vec::new();
    let mut shown = BTreeSet::new();
    for row in rows() {
        shown.insert(row.kind);
        let mut bus = Bus::healthy();
        (row.bus)(&mut bus);
        let found = Ward::new(bus, row.puppet).look();
        let mut expected = BTreeSet::from([row.kind]);
        expected.extend(row.also);
        if kinds(&found) != expected {
            wrong.push(format!("{}: {found:#?}", row.kind.name()));
        }
        let there = found.iter().find(|finding| finding.kind == row.kind);
        let joint = there.and_then(|finding| finding.joint.as_deref());
        if row.joint.is_some() && joint != row.joint {
            wrong.push(format!(
                "{}: at {joint:?}, expected {:?}",
                row.kind.name(),
                row.joint
            ));
        }
        for finding in &found {
            assert!(!finding.what.is_empty() && !finding.costs.is_empty() && !finding.remedy.is_empty());
            assert!(finding.fix.is_none() || finding.kind.is_fixable(), "{finding:?}");
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let never: Vec<_> = Kind::all().filter(|kind| !shown.contains(kind)).collect();
    assert!(never.is_empty(), "no row brings these about: {never:?}");
}

/// What can be mended is, and is not found again; the rest of the findings stay.
#[test]
fn fixes_mend_what_they_say() {
    let mut bus = Bus::healthy();
    bus.timer_ms = Some(16);
    bus.fault("servo 2 has return-delay 250");
    bus.fault("servo 4 has return-delay 50");
    bus.fault("servo 3 hot 66");
    let mut ward = Ward::new(bus, true);
    let found = ward.look();
    assert_eq!(
        kinds(&found),
        BTreeSet::from([Kind::AdapterLatency, Kind::ReturnDelay, Kind::Hot])
    );
    for finding in &found {
        if let Some(fix) = finding.fix {
            let line = ward.line.clone();
            ward.doctor.mend(&line, fix).expect("mends");
        }
    }
    let left = ward.look();
    assert_eq!(kinds(&left), BTreeSet::from([Kind::Hot]), "{left:#?}");
}

/// A servo from its box becomes the joint that is missing.
#[test]
fn a_factory_fresh_servo_is_adopted() {
    let mut bus = Bus::healthy();
    let profile = bus.servos[2].0.clone();
    *bus.unit(3) = firmware_sim::servo_bus::Unit {
        return_delay_us: Some(0),
        ..firmware_sim::servo_bus::Unit::factory(&profile)
    };
    let mut ward = Ward::new(bus, true);
    let found = ward.look();
    assert_eq!(kinds(&found), BTreeSet::from([Kind::FactoryFresh]), "{found:#?}");
    let remedy = &found[0].remedy;
    assert!(remedy.contains("--adopt elbow"), "{remedy}");
    let lines = [ward.line.clone()];
    ward.doctor.adopt(&lines, "elbow").expect("adopts");
    let left = ward.look();
    assert!(left.is_empty(), "{left:#?}");
    let again = ward.doctor.adopt(&lines, "elbow").expect_err("nobody is left");
    assert!(again.to_string().contains("as from the factory"), "{again}");
}
