//! USB devices on the bench, through the ports the rig uses.

use super::super::{SimPorts, Stand};
use super::*;
use device::clock::VirtualClock;
use device_profiles::Profiles;
use firmware_sim::hands::{Pen, Turn};
use rig::Ports;
use std::time::Duration;

fn bench(devices: &[(&str, &str)]) -> (Arc<VirtualClock>, Stand, SimPorts) {
    let clock = Arc::new(VirtualClock::new());
    let profiles = Profiles::builtin();
    let mut builder = Stand::builder(Arc::clone(&clock) as Arc<dyn Clock>);
    for (name, kind) in devices {
        let profile = profiles.input(kind).expect("shipped");
        builder = builder.input(name, profile).expect("simulated");
    }
    let stand = builder.build();
    let ports = SimPorts::new(stand.clone());
    (clock, stand, ports)
}

fn reports(transport: &mut dyn Transport) -> Vec<(u64, Vec<u8>)> {
    let mut buffer = [0; 64];
    let mut seen = Vec::new();
    while let Ok(count @ 1..) = transport.read(&mut buffer) {
        let at = transport.arrived().expect("noted").as_micros();
        seen.push((at, buffer[..count].to_vec()));
    }
    seen
}

#[test]
fn reports_come_whole_with_the_time_they_arrived() {
    let (clock, stand, mut ports) = bench(&[("knob", "powermate")]);
    assert_eq!(ports.list()[0].matches, ["powermate"]);
    let mut knob = ports.open("sim:knob", 0).expect("there");
    assert_eq!(knob.boundary(), Boundary::Reports);
    clock.advance(Duration::from_millis(5));
    let turn = Touch::Dial {
        control: 0,
        by: Turn::Counts(9),
        over_us: 0,
    };
    stand.touch("knob", &turn).expect("has a dial");
    clock.advance(Duration::from_millis(95));
    let want = [(5_000, vec![0, 7, 0, 0, 0, 0]), (15_000, vec![0, 2, 0, 0, 0, 0])];
    assert_eq!(reports(&mut *knob), want);
    // The host's leading 0 stands for "not numbered" and never reaches the device.
    knob.write(&[0, 0x55]).expect("there");
    assert_eq!(stand.shown_by_usb("knob").expect("USB"), [Shown::Level(0x55)]);
}

#[test]
fn a_handshake_by_strings_goes_through_and_ends_at_whatever_step_the_cable_comes_out() {
    for step in 0..3 {
        let (_, stand, mut ports) = bench(&[("tablet", "hs610")]);
        let mut tablet = ports.open("sim:tablet", 0).expect("there");
        stand.unplug_after_calls("tablet", step).expect("there");
        let asked: Vec<bool> = [201, 200, 202]
            .map(|index| tablet.read_string(index).is_ok())
            .to_vec();
        let want: Vec<bool> = (0..3).map(|n| n < step).collect();
        assert_eq!(asked, want);
        assert!(tablet.read(&mut [0; 64]).expect_err("unplugged").is_gone());
        assert!(ports.list().is_empty());
        stand.plug("tablet", true).expect("there");
        assert!(ports.open("sim:tablet", 0).is_ok());
        assert!(
            tablet
                .read(&mut [0; 64])
                .expect_err("the old end stays dead")
                .is_gone()
        );
    }
}

#[test]
fn a_string_the_device_refuses_is_no_reason_to_think_it_gone() {
    let (_, _, mut ports) = bench(&[("tablet", "ctl-472")]);
    let mut tablet = ports.open("sim:tablet", 0).expect("there");
    assert!(!tablet.read_string(200).expect_err("none").is_gone());
    tablet.write_feature(&[2, 2]).expect("takes it");
    let mut buffer = [0; 8];
    assert_eq!(tablet.read_feature(2, &mut buffer).expect("says it"), Some(2));
    assert_eq!(buffer[..2], [2, 2]);
}

#[test]
fn ten_equal_devices_do_not_hear_each_others_hands() {
    let names: Vec<String> = (0..10).map(|n| format!("tablet{n}")).collect();
    let devices: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), "pth-660")).collect();
    let (clock, stand, mut ports) = bench(&devices);
    assert_eq!(ports.list().len(), 10);
    let mut open: Vec<_> = names
        .iter()
        .map(|name| ports.open(&format!("sim:{name}"), 0).expect("there"))
        .collect();
    for (n, name) in names.iter().enumerate() {
        let pen = Pen {
            x: n as f64 / 10.0,
            ..Pen::default()
        };
        stand.touch(name, &Touch::Pen(pen)).expect("has a pen");
    }
    clock.advance(Duration::from_millis(20));
    for (n, transport) in open.iter_mut().enumerate() {
        let seen = reports(&mut **transport);
        assert_eq!(seen.len(), 1);
        let x = u32::from_le_bytes([seen[0].1[2], seen[0].1[3], seen[0].1[4], 0]);
        assert_eq!(x, 22_400 + 2_240 * n as u32);
    }
}
