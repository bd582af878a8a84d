//! The shipped files, held to what their schema cannot say.

use device_profiles::{Access, Area, Profiles};

#[test]
fn builtin_profiles_are_found_by_key_and_by_name() {
    let all = Profiles::builtin();
    assert_eq!(all.servo("XL330-M288").unwrap().model_number, 1200);
    assert_eq!(all.servo("xl430-w250").unwrap().model_number, 1060);
    assert_eq!(all.puppet("marionette").unwrap().joints().count(), 22);
    let missing = all.servo("mx-28").unwrap_err().to_string();
    assert_eq!(
        missing,
        "there is no servo profile named \"mx-28\"; there are: xl330-m288, xl430-w250"
    );
}

#[test]
fn registers_stand_where_the_manual_puts_them() {
    let all = Profiles::builtin();
    let rows = [
        ("Model Number", 0, 2, Area::Eeprom, Access::R),
        ("Return Delay Time", 9, 1, Area::Eeprom, Access::Rw),
        ("Torque Enable", 64, 1, Area::Ram, Access::Rw),
        ("Bus Watchdog", 98, 1, Area::Ram, Access::Rw),
        ("Profile Velocity", 112, 4, Area::Ram, Access::Rw),
        ("Goal Position", 116, 4, Area::Ram, Access::Rw),
        ("Realtime Tick", 120, 2, Area::Ram, Access::R),
        ("Present Position", 132, 4, Area::Ram, Access::R),
        ("Present Temperature", 146, 1, Area::Ram, Access::R),
    ];
    for servo in all.servos() {
        for (name, address, size, area, access) in rows {
            let row = servo
                .register(name)
                .unwrap_or_else(|| panic!("{} has no {name}", servo.name));
            assert_eq!(
                (row.address, row.size, row.area, row.access),
                (address, size, area, access),
                "{name}"
            );
        }
        assert_eq!(servo.baud_code(1_000_000), Some(3));
    }
}
