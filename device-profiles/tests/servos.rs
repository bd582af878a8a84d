//! Control tables against a second, hand-typed account of the same servos, and against themselves.
//!
//! Source of the typed addresses: rustypot's `xl330.rs`, `xl430.rs`, `xl320.rs`, `mx.rs`, `ax.rs`, `sts3215.rs`,
//! `scs0009.rs`, not the documents the files name.

use device_profiles::{
    Access, Area, HardwareFault, Profiles, Register, Role, ServoProfile, ServoProtocol, Unit, WordOrder,
};
use std::f64::consts::TAU;

/// Addresses of what every servo has.
struct Places {
    id: u16,
    baud: u16,
    delay: u16,
    torque: u16,
    goal: u16,
    position: u16,
    velocity: u16,
    voltage: u16,
    temperature: u16,
}

#[rustfmt::skip]
const X: Places = Places { id: 7, baud: 8, delay: 9, torque: 64, goal: 116, position: 132, velocity: 128, voltage: 144, temperature: 146 };
#[rustfmt::skip]
const AX: Places = Places { id: 3, baud: 4, delay: 5, torque: 24, goal: 30, position: 36, velocity: 38, voltage: 42, temperature: 43 };
#[rustfmt::skip]
const XL320: Places = Places { id: 3, baud: 4, delay: 5, torque: 24, goal: 30, position: 37, velocity: 39, voltage: 45, temperature: 46 };
#[rustfmt::skip]
const FEETECH: Places = Places { id: 5, baud: 6, delay: 7, torque: 40, goal: 42, position: 56, velocity: 58, voltage: 62, temperature: 63 };

use ServoProtocol::{Dynamixel1, Dynamixel2, Scs, Sts};

/// Key, model number, protocol, places, bytes of position, one past the last byte, code of 1 Mbaud, speed unit (rpm).
type Model = (
    &'static str,
    u16,
    ServoProtocol,
    &'static Places,
    u8,
    usize,
    u8,
    f64,
);

#[rustfmt::skip]
const MODELS: [Model; 12] = [
    ("xl330-m288", 1200, Dynamixel2, &X, 4, 252, 3, 0.229),
    ("xl330-m077", 1190, Dynamixel2, &X, 4, 252, 3, 0.229),
    ("xl430-w250", 1060, Dynamixel2, &X, 4, 662, 3, 0.229),
    ("xm430-w350", 1020, Dynamixel2, &X, 4, 662, 3, 0.229),
    ("xm540-w270", 1120, Dynamixel2, &X, 4, 662, 3, 0.229),
    ("mx-28-2", 30, Dynamixel2, &X, 4, 662, 3, 0.229),
    ("mx-28", 29, Dynamixel1, &AX, 2, 74, 1, 0.114),
    ("ax-12a", 12, Dynamixel1, &AX, 2, 50, 1, 0.111),
    ("xl-320", 350, Dynamixel2, &XL320, 2, 53, 3, 0.111),
    ("sts3215", 777, Sts, &FEETECH, 2, 87, 0, 60.0 / 4096.0),
    ("sts3250", 2825, Sts, &FEETECH, 2, 87, 0, 60.0 / 4096.0),
    ("scs0009", 1284, Scs, &FEETECH, 2, 84, 0, 300.0 / 1024.0 / 6.0),
];

fn row(servo: &ServoProfile, role: Role) -> &Register {
    servo
        .role(role)
        .unwrap_or_else(|| panic!("{} has no {role}", servo.name))
}

#[test]
fn every_model_is_what_another_account_says() {
    let all = Profiles::builtin();
    assert_eq!(
        all.servos().count(),
        MODELS.len(),
        "a new model wants its line here"
    );
    for (key, number, protocol, places, position_bytes, table_bytes, megabaud, _) in MODELS {
        let servo = all.servo(key).unwrap();
        assert_eq!((servo.model_number, servo.protocol), (number, protocol), "{key}");
        assert_eq!(all.servo_by_model(number).unwrap().key, key);
        let rows = [
            (Role::Id, places.id, 1),
            (Role::BaudRate, places.baud, 1),
            (Role::ReturnDelay, places.delay, 1),
            (Role::TorqueEnable, places.torque, 1),
            (Role::GoalPosition, places.goal, position_bytes),
            (Role::PresentPosition, places.position, position_bytes),
            (Role::PresentVelocity, places.velocity, position_bytes),
            (Role::PresentTemperature, places.temperature, 1),
        ];
        for (role, address, size) in rows {
            let found = row(servo, role);
            assert_eq!((found.address, found.size), (address, size), "{key}: {role}");
        }
        assert_eq!(row(servo, Role::PresentVoltage).address, places.voltage, "{key}");
        assert_eq!(servo.table_bytes(), table_bytes, "{key}");
        assert_eq!(servo.baud_code(1_000_000), Some(megabaud), "{key}");
        for &baud in &servo.bauds {
            let code = servo.baud_code(baud).unwrap();
            assert_eq!(servo.baud_of_code(code), Some(baud), "{key}");
        }
        let init = row(servo, Role::BaudRate).init.unwrap();
        assert!(
            servo.baud_of_code(u8::try_from(init).unwrap()).is_some(),
            "{key} starts at no speed of its own"
        );
        let want = if protocol == Scs {
            WordOrder::Big
        } else {
            WordOrder::Little
        };
        assert_eq!(servo.word_order(), want, "{key}");
    }
}

#[test]
fn what_is_kept_without_power_and_what_may_be_written_follows_from_the_role() {
    use Role as R;
    for servo in Profiles::builtin().servos() {
        for (roles, area, access) in [
            (&[R::ModelNumber, R::FirmwareVersion][..], Area::Eeprom, Access::R),
            (
                &[
                    R::Id,
                    R::BaudRate,
                    R::ReturnDelay,
                    R::MinPosition,
                    R::MaxPosition,
                    R::TorqueLimit,
                ],
                Area::Eeprom,
                Access::Rw,
            ),
            (&[R::TorqueEnable, R::GoalPosition], Area::Ram, Access::Rw),
            (
                &[
                    R::PresentPosition,
                    R::PresentVelocity,
                    R::PresentVoltage,
                    R::PresentTemperature,
                    R::Moving,
                ],
                Area::Ram,
                Access::R,
            ),
        ] {
            for &role in roles {
                let found = row(servo, role);
                assert_eq!(
                    (found.area, found.access),
                    (area, access),
                    "{}: {role}",
                    servo.name
                );
            }
        }
        let effort = servo
            .role(R::PresentCurrent)
            .or_else(|| servo.role(R::PresentLoad));
        assert!(
            effort.is_some_and(|r| r.signed || r.sign_bit.is_some()),
            "{}",
            servo.name
        );
        assert!(servo.move_velocity().is_some(), "{}", servo.name);
        let number = row(servo, R::ModelNumber);
        assert_eq!(number.init, Some(servo.model_number.into()), "{}", servo.name);
        assert_eq!(servo.register_at(number.address), Some(number), "{}", servo.name);
    }
}

#[test]
fn start_values_fit_their_rows() {
    for servo in Profiles::builtin().servos() {
        for row in servo
            .registers
            .iter()
            .chain(servo.variants.iter().flat_map(|v| &v.registers))
        {
            let Some(init) = row.init else { continue };
            let last = init + row.init_step * i64::from(row.count - 1);
            let in_range = |v: i64| {
                row.min.is_none_or(|min| v >= min)
                    && row.max.is_none_or(|max| v <= max)
                    && (row.values.is_empty() || row.values.contains(&v))
            };
            // The manual's start value 255 of this one lies outside its own range and means "none".
            let switched_off = row.name == "Secondary(Shadow) ID" && init == 255;
            assert!(
                switched_off || in_range(init) && in_range(last),
                "{}: {}",
                servo.name,
                row.name
            );
            for value in [Some(init), Some(last), row.min, row.max].into_iter().flatten() {
                assert!(
                    fits(row, value),
                    "{}: {} cannot hold {value}",
                    servo.name,
                    row.name
                );
            }
        }
    }
}

fn fits(row: &Register, value: i64) -> bool {
    let bits = u32::from(row.size) * 8;
    let (low, high) = if let Some(bit) = row.sign_bit {
        (1 - (1_i64 << bit), (1 << bit) - 1)
    } else if row.signed {
        (-(1_i64 << (bits - 1)), (1 << (bits - 1)) - 1)
    } else {
        (0, (1 << bits) - 1)
    };
    (low..=high).contains(&value)
}

#[test]
fn units_are_the_ones_their_counts_imply() {
    let all = Profiles::builtin();
    for (key, _, _, _, _, _, _, rpm) in MODELS {
        let servo = all.servo(key).unwrap();
        let rows = [
            (Role::PresentPosition, Unit::Radian, servo.rad_per_count()),
            (Role::GoalPosition, Unit::Radian, servo.rad_per_count()),
            (Role::MinPosition, Unit::Radian, servo.rad_per_count()),
            (Role::PresentVelocity, Unit::RadianPerSecond, rpm * TAU / 60.0),
            (Role::PresentVoltage, Unit::Volt, 0.1),
            (Role::PresentTemperature, Unit::Celsius, 1.0),
            (Role::ReturnDelay, Unit::Second, 2e-6),
        ];
        for (role, unit, factor) in rows {
            let found = row(servo, role);
            assert_eq!(found.unit, Some(unit), "{key}: {role}");
            let per_count = found.unit_per_count.unwrap();
            assert!(
                (per_count / factor - 1.0).abs() < 1e-9,
                "{key}: {role} is {per_count}, wanted {factor}"
            );
        }
        let speed = servo.move_velocity().unwrap().unit_per_count;
        assert_eq!(speed, Some(servo.rad_per_s_per_count()), "{key}");
    }
}

/// A motor gives at most a quarter of stall torque times free speed, and never more than it is given.
#[test]
fn motors_are_possible() {
    for servo in Profiles::builtin().servos() {
        let motor = servo
            .motor
            .as_ref()
            .unwrap_or_else(|| panic!("{} has no motor", servo.name));
        let given_w = motor.rated_voltage_v * motor.stall_current_a;
        let got_w = motor.stall_torque_nm * motor.no_load_speed_rad_per_s / 4.0;
        assert!(
            (0.05..0.5).contains(&(got_w / given_w)),
            "{}: {got_w} of {given_w} W",
            servo.name
        );
        let [low, high] = [Role::MinVoltage, Role::MaxVoltage].map(|role| {
            let row = row(servo, role);
            row.init.unwrap() as f64 * row.unit_per_count.unwrap()
        });
        assert!((low..=high).contains(&motor.rated_voltage_v), "{}", servo.name);
        // Where the factory bounds the speed it is by what the motor can do.
        if let Some(limit) = servo.role(Role::VelocityLimit) {
            let limit_rad_per_s = limit.init.unwrap() as f64 * limit.unit_per_count.unwrap();
            let ratio = limit_rad_per_s / motor.no_load_speed_rad_per_s;
            assert!((0.9..1.1).contains(&ratio), "{}: {ratio}", servo.name);
        }
    }
}

#[test]
fn older_firmware_has_its_own_table() {
    let all = Profiles::builtin();
    let rows = [
        ("xl330-m288", 53, "Indirect Address 1..28", Some((168, 28))),
        ("xl330-m288", 52, "Indirect Address 1..28", None),
        ("xl330-m288", 52, "Indirect Data 1..20", Some((208, 20))),
        ("xl330-m288", 46, "Backup Ready", Some((147, 1))),
        ("xl330-m288", 45, "Backup Ready", None),
        ("xm430-w350", 45, "Startup Configuration", Some((60, 1))),
        ("xm430-w350", 44, "Startup Configuration", None),
        ("xm430-w350", 41, "Acceleration Limit", Some((40, 1))),
        ("mx-28", 39, "Realtime Tick", None),
        ("ax-12a", 1, "Punch", Some((48, 1))),
    ];
    for (key, firmware, name, want) in rows {
        let servo = all.servo(key).unwrap().at_firmware(firmware);
        let found = servo.register(name).map(|row| (row.address, row.count));
        assert_eq!(found, want, "{key} {firmware}: {name}");
    }
    let limit = |firmware| {
        let servo = all.servo("xm430-w350").unwrap().at_firmware(firmware);
        row(&servo, Role::VelocityLimit).init
    };
    assert_eq!((limit(42), limit(41)), (Some(200), Some(350)));
}

#[test]
fn faults_are_told_from_each_models_own_bits() {
    use HardwareFault::{InputVoltage, Overheating, Overload};
    let all = Profiles::builtin();
    for (key, bits, want) in [
        (
            "xl330-m288",
            0b10_0101,
            &[InputVoltage, Overheating, Overload][..],
        ),
        ("xl-320", 0b111, &[InputVoltage, Overheating, Overload]),
        ("xl-320", 0b1, &[Overload]),
        ("sts3215", 0b10_0000, &[Overload]),
        ("ax-12a", 0b101_1000, &[]),
    ] {
        let servo = all.servo(key).unwrap();
        assert_eq!(servo.faults(bits).collect::<Vec<_>>(), want, "{key} {bits:#b}");
        let mask = want.iter().fold(0, |mask, &fault| mask | servo.fault_mask(fault));
        assert_eq!(mask, if want.is_empty() { 0 } else { bits }, "{key}");
    }
}
