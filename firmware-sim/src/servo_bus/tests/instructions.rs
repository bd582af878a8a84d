//! What each instruction does and answers, and every refusal.

use super::*;

#[test]
fn a_ping_tells_model_and_firmware_at_every_level() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.ask(&write(1, 68, &[0]));
    let answer = host.ask(&packet(1, 1, &[]));
    assert_eq!(answer[..12], [0xFF, 0xFF, 0xFD, 0, 1, 7, 0, 0x55, 0, 0x24, 4, 45]);
    assert_eq!(
        host.ask(&read(1, 64, 1)),
        [],
        "level 0 answers nothing but a ping"
    );
    host.ask(&write(1, 68, &[1]));
    assert_eq!(host.ask(&read(1, 68, 1))[9], 1);
    assert_eq!(
        host.ask(&write(1, 65, &[1])),
        [],
        "level 1 does not answer a write"
    );
    assert_eq!(host.register(1, "LED"), 1);
}

#[test]
fn a_broadcast_ping_is_answered_in_order_of_numbers() {
    let mut host = Host::new(bus(BusOptions::default(), &[9, 2, 30]));
    let ids: Vec<u8> = host
        .ask(&packet(254, 1, &[]))
        .chunks(14)
        .map(|answer| answer[4])
        .collect();
    assert_eq!(ids, [2, 9, 30]);
}

#[test]
fn refusals_have_the_numbers_of_the_manual() {
    let goal = |counts: i32| write(1, 116, &counts.to_le_bytes());
    let table: [(Vec<u8>, u8, &str); 14] = [
        (packet(1, 0x77, &[]), 2, "no such instruction"),
        (packet(1, 5, &[]), 2, "nothing registered"),
        (write(1, 64, &[2]), 4, "Torque Enable is 0 or 1"),
        (write(1, 11, &[2]), 4, "no such mode"),
        (write(1, 116, &[0, 0]), 5, "half a goal"),
        (packet(1, 2, &[0, 0]), 5, "a read without a length"),
        (goal(4096), 6, "above Max Position Limit"),
        (goal(-1), 6, "below Min Position Limit"),
        (write(1, 104, &266i32.to_le_bytes()), 6, "above Velocity Limit"),
        (write(1, 132, &[0; 4]), 7, "Present Position is read only"),
        (write(1, 66, &[0]), 7, "no register"),
        (write(1, 117, &[0; 3]), 7, "middle of a register"),
        (read(1, 661, 2), 7, "beyond the table"),
        (read(1, 700, 1), 7, "far beyond the table"),
    ];
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    for (bytes, error, why) in table {
        assert_eq!(host.error_of(&bytes), Some(error), "{why}");
    }
    host.ask(&write(1, 64, &[1]));
    assert_eq!(
        host.error_of(&write(1, 9, &[10])),
        Some(7),
        "EEPROM with torque on"
    );
    assert_eq!(host.register(1, "Return Delay Time"), 0);
    host.ask(&write(1, 64, &[0]));
    assert_eq!(host.error_of(&write(1, 9, &[10])), Some(0));
    assert_eq!(host.bus.servo(1).expect("there").counters().eeprom_changes, 1);
}

#[test]
fn a_refused_write_writes_nothing() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    // Profile Acceleration, Profile Velocity and a goal out of range in one go.
    let mut bytes = [5i32.to_le_bytes(), 7i32.to_le_bytes(), 9999i32.to_le_bytes()].concat();
    assert_eq!(host.error_of(&write(1, 108, &bytes)), Some(6));
    assert_eq!(host.register(1, "Profile Velocity"), 0);
    bytes[8..].copy_from_slice(&2000i32.to_le_bytes());
    assert_eq!(host.error_of(&write(1, 108, &bytes)), Some(0));
    assert_eq!(
        (
            host.register(1, "Profile Velocity"),
            host.register(1, "Goal Position")
        ),
        (7, 2000)
    );
}

#[test]
fn a_registered_write_waits_for_its_action() {
    let mut host = Host::new(bus(BusOptions::default(), &[1, 2]));
    for id in [1, 2] {
        assert_eq!(host.error_of(&packet(id, 4, &[65, 0, 1])), Some(0));
        assert_eq!(
            (
                host.register(id, "LED"),
                host.register(id, "Registered Instruction")
            ),
            (0, 1)
        );
    }
    assert_eq!(host.ask(&packet(254, 5, &[])), []);
    for id in [1, 2] {
        assert_eq!(
            (
                host.register(id, "LED"),
                host.register(id, "Registered Instruction")
            ),
            (1, 0)
        );
    }
}

#[test]
fn sync_and_bulk_write_reach_each_its_own() {
    let mut host = Host::new(bus(BusOptions::default(), &[1, 2, 3]));
    assert_eq!(host.ask(&packet(254, 0x83, &[65, 0, 1, 0, 1, 1, 3, 1])), []);
    let leds = [1, 2, 3].map(|id| host.register(id, "LED"));
    assert_eq!(leds, [1, 0, 1]);
    host.ask(&packet(254, 0x93, &[2, 65, 0, 1, 0, 1, 3, 80, 0, 2, 0, 7, 1]));
    assert_eq!(
        (host.register(2, "LED"), host.register(3, "Position D Gain")),
        (1, 263)
    );
}

#[test]
fn a_sync_read_comes_in_listed_order_and_stops_or_goes_on_at_an_absent_servo() {
    let ask = packet(254, 0x82, &[7, 0, 1, 0, 3, 9, 1]);
    let ids = |answer: Vec<u8>| answer.chunks(12).map(|status| status[4]).collect::<Vec<_>>();
    let mut host = Host::new(bus(BusOptions::default(), &[1, 3]));
    assert_eq!(ids(host.ask(&ask)), [3]);
    let options = BusOptions {
        absent: Absent::GoOnAfter(2000),
        ..BusOptions::default()
    };
    let mut host = Host::new(bus(options, &[1, 3]));
    assert_eq!(ids(host.ask(&ask)), [3, 1]);
    let sent: Vec<_> = host.bus.statuses().copied().collect();
    assert_eq!(sent[1].first_us - sent[0].last_us, 2000);
}

#[test]
fn a_bulk_read_gives_each_its_own_bytes() {
    let mut host = Host::new(bus(BusOptions::default(), &[1, 2]));
    let answer = host.ask(&packet(254, 0x92, &[2, 146, 0, 1, 0, 1, 144, 0, 2, 0]));
    assert_eq!((answer.len(), answer[4], answer[9]), (12 + 13, 2, 25));
    // 11.1 V, what its motor is made for.
    assert_eq!((answer[16], answer[21]), (1, 111));
}

#[test]
fn fast_reads_need_the_firmware_and_end_at_an_absent_servo() {
    let profiles = Profiles::builtin();
    let xl330 = profiles.servo("xl330-m288").expect("shipped");
    let ask = packet(254, 0x8A, &[7, 0, 1, 0, 1, 2]);
    for (firmware, len) in [(45, 0), (46, 8 + 2 * 5)] {
        let mut bus = ServoBus::new(BusOptions::default());
        for id in [1, 2] {
            bus.add(
                xl330,
                Unit {
                    firmware: Some(firmware),
                    ..Unit::new(id)
                },
            )
            .expect("fits");
        }
        assert_eq!(Host::new(bus).ask(&ask).len(), len);
    }
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    assert_eq!(host.ask(&ask).len(), 8 + 5, "then silence");
}

#[test]
fn indirect_bytes_stand_for_others() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    // Slots 1 to 4 to Goal Position, slot 5 to Moving.
    for (slot, target) in [116u16, 117, 118, 119, 122].into_iter().enumerate() {
        assert_eq!(
            host.error_of(&write(1, 168 + 2 * slot as u16, &target.to_le_bytes())),
            Some(0)
        );
    }
    assert_eq!(host.error_of(&write(1, 224, &1234i32.to_le_bytes())), Some(0));
    assert_eq!(host.register(1, "Goal Position"), 1234);
    assert_eq!(
        host.error_of(&write(1, 224, &9999i32.to_le_bytes())),
        Some(6),
        "limits hold here too"
    );
    assert_eq!(host.error_of(&write(1, 228, &[1])), Some(7), "so does read only");
    assert_eq!(host.ask(&read(1, 224, 4))[9..13], 1234i32.to_le_bytes());
    // Unset slots point at their own data.
    assert_eq!(host.error_of(&write(1, 240, &[77])), Some(0));
    assert_eq!(host.ask(&read(1, 240, 1))[9], 77);
}

#[test]
fn a_reboot_forgets_ram_keeps_eeprom_and_takes_its_time() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.ask(&write(1, 24, &20i32.to_le_bytes()));
    host.ask(&write(1, 112, &100i32.to_le_bytes()));
    host.ask(&write(1, 64, &[1]));
    assert_eq!(host.error_of(&packet(1, 8, &[])), Some(0));
    assert_eq!(host.ask(&packet(1, 1, &[])), [], "not yet");
    host.wait(300);
    assert_eq!(host.ask(&packet(1, 1, &[])).len(), 14);
    let registers =
        ["Torque Enable", "Profile Velocity", "Moving Threshold"].map(|name| host.register(1, name));
    assert_eq!(registers, [0, 0, 20]);
    assert!(host.register(1, "Realtime Tick") < 400);
}

#[test]
fn a_factory_reset_keeps_what_it_is_told_to() {
    for (scope, ids) in [
        (0xFF, [true, false]),
        (0x01, [false, true]),
        (0x02, [false, true]),
    ] {
        let profiles = Profiles::builtin();
        let mut bus = ServoBus::new(BusOptions {
            baud: 57_600,
            ..BusOptions::default()
        });
        bus.add(profiles.servo("xl430-w250").expect("shipped"), Unit::new(5))
            .expect("fits");
        let mut host = Host::new(bus);
        assert_eq!(host.error_of(&packet(5, 6, &[scope])), Some(0));
        host.wait(300);
        let answers = [1, 5].map(|id| host.ask(&packet(id, 1, &[])).len() == 14);
        assert_eq!(answers, ids, "{scope:02x}");
    }
    let mut host = Host::new(bus(BusOptions::default(), &[5]));
    host.ask(&packet(254, 6, &[0xFF]));
    host.wait(300);
    assert_eq!(host.ask(&packet(5, 1, &[])).len(), 14, "ignored from firmware 42");
}

#[test]
fn clear_and_backup_do_as_documented() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.ask(&write(1, 11, &[4]));
    host.bus.push(host.now_us, 1, std::f64::consts::TAU * 3.0);
    assert_eq!(host.register(1, "Present Position"), 2048 + 3 * 4096);
    assert_eq!(
        host.error_of(&packet(1, 0x10, &[1, 0x44, 0x58, 0x4C, 0x22])),
        Some(0)
    );
    assert_eq!(host.register(1, "Present Position"), 2048);
    assert_eq!(host.error_of(&packet(1, 0x10, &[1, 2, 3, 4, 5])), Some(4));
    let store = packet(1, 0x20, &[1, 0x43, 0x54, 0x52, 0x4C]);
    let restore = packet(1, 0x20, &[2, 0x43, 0x54, 0x52, 0x4C]);
    assert_eq!(host.error_of(&restore), Some(1), "nothing stored");
    host.ask(&write(1, 64, &[1]));
    assert_eq!(host.error_of(&store), Some(1), "torque is on");
    host.ask(&write(1, 64, &[0]));
    assert_eq!(host.error_of(&store), Some(0));
    assert_eq!(host.register(1, "Backup Ready"), 1);
    host.ask(&write(1, 24, &99i32.to_le_bytes()));
    assert_eq!(host.error_of(&restore), Some(0));
    host.wait(300);
    assert_eq!(host.register(1, "Moving Threshold"), 10);
}

#[test]
fn a_new_mode_resets_what_the_manual_says() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.ask(&write(1, 84, &900u16.to_le_bytes()));
    host.ask(&write(1, 112, &50i32.to_le_bytes()));
    assert_eq!(host.error_of(&write(1, 11, &[1])), Some(0));
    let registers = ["Position P Gain", "Profile Velocity", "Goal PWM"].map(|name| host.register(1, name));
    assert_eq!(registers, [640, 0, 885]);
}

#[test]
fn a_new_number_and_a_new_speed_take_effect_behind_the_answer() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    assert_eq!(host.ask(&write(1, 7, &[8]))[4], 1);
    assert_eq!(host.ask(&packet(1, 1, &[])), []);
    assert_eq!(host.error_of(&write(8, 8, &[1])), Some(0));
    assert_eq!(host.ask(&packet(8, 1, &[])), [], "it is at 57600 now");
    host.bus.set_line_baud(host.now_us, 57_600);
    assert_eq!(host.ask(&packet(8, 1, &[])).len(), 14);
}

#[test]
fn a_shadow_obeys_without_a_word() {
    let mut host = Host::new(bus(BusOptions::default(), &[1, 2]));
    host.ask(&write(2, 12, &[1]));
    assert_eq!(host.ask(&write(1, 65, &[1])).len(), 11);
    assert_eq!(host.register(2, "LED"), 1);
}

#[test]
fn eeprom_survives_between_runs() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    host.ask(&write(1, 20, &(-500i32).to_le_bytes()));
    let kept = host.bus.servo(1).expect("there").eeprom().to_vec();
    let mut other = bus(BusOptions::default(), &[1]);
    assert!(other.servos_mut()[0].restore_eeprom(&kept));
    assert_eq!(
        other.servo(1).expect("there").register("Homing Offset"),
        Some(-500)
    );
    assert!(!other.servos_mut()[0].restore_eeprom(&kept[1..]));
}
