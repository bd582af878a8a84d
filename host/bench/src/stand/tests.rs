use super::*;
use crate::world::Equipment;
use device::clock::{Instant, VirtualClock};
use device::transport::{Transport, TransportError};
use device_profiles::Profiles;
use firmware_sim::hands::Turn;
use rig::{Ports, Touch as RigTouch};
use std::time::Duration;

fn stand() -> (VirtualClock, Stand) {
    let clock = VirtualClock::new();
    let equipment = Equipment {
        puppet: Some("marionette".into()),
        ..Equipment::default()
    };
    let stand = equipment
        .stand(Arc::new(clock.clone()), &Profiles::builtin())
        .expect("built in");
    (clock, stand)
}

fn read(port: &mut dyn Transport) -> Result<Vec<u8>, TransportError> {
    let mut buffer = [0; 64];
    port.read(&mut buffer).map(|count| buffer[..count].to_vec())
}

#[test]
fn a_dial_box_answers_in_its_own_time() {
    let (clock, stand) = stand();
    let mut port = SimPorts::new(stand).open("sim:dial-box", 9600).expect("opens");
    port.write(&[0x20]).expect("writes");
    assert!(read(&mut *port).expect("there").is_empty());
    clock.advance(Duration::from_millis(5));
    assert_eq!(read(&mut *port).expect("there"), [0x20]);
}

#[test]
fn waiting_ends_with_the_answer() {
    let (clock, stand) = stand();
    let mut port = SimPorts::new(stand).open("sim:dial-box", 9600).expect("opens");
    port.write(&[0x20]).expect("writes");
    port.wait(&clock, Instant::from_nanos(1_000_000_000));
    // One byte there and one back, 1.04 ms each.
    let took = clock.now().as_secs_f64();
    assert!((0.002..0.0025).contains(&took), "{took}");
    assert_eq!(read(&mut *port).expect("there"), [0x20]);
}

#[test]
fn a_cable_that_is_out_makes_the_port_gone_until_it_is_opened_again() {
    let (_, stand) = stand();
    let mut ports = SimPorts::new(stand.clone());
    let mut port = ports.open("sim:tablet", 9600).expect("opens");
    ports
        .touch("sim:tablet", &RigTouch::Cable { connected: false })
        .expect("unplugs");
    assert!(read(&mut *port).expect_err("gone").is_gone());
    assert!(ports.open("sim:tablet", 9600).is_err());
    assert_eq!(ports.list().len(), 3);
    ports
        .touch("sim:tablet", &RigTouch::Cable { connected: true })
        .expect("plugs");
    assert!(port.write(&[0]).expect_err("still gone").is_gone());
    ports.open("sim:tablet", 9600).expect("opens again");
}

#[test]
fn the_cable_comes_out_at_the_chosen_call() {
    let (_, stand) = stand();
    let mut port = SimPorts::new(stand.clone())
        .open("sim:upper", 1_000_000)
        .expect("opens");
    stand.unplug_after_calls("upper", 2).expect("there");
    assert!(port.write(&[1]).is_ok() && read(&mut *port).is_ok());
    assert!(port.write(&[1]).is_err());
    assert!(!stand.is_plugged("upper").expect("there"));
}

#[test]
fn refusals_name_what_there_is() {
    let (_, stand) = stand();
    let rows = [
        (
            stand.fault("dial-box", "stall"),
            "dial-box is not a servo bus; the buses are: lower, upper",
        ),
        (
            stand.plug("nobody", false),
            "there are: dial-box, lower, tablet, upper",
        ),
        (
            stand.touch(
                "dial-box",
                &Touch::Dial {
                    control: 8,
                    by: Turn::Counts(1),
                    over_us: 0,
                },
            ),
            "dial-box has no dial 8",
        ),
        (
            stand.touch(
                "tablet",
                &Touch::Button {
                    control: 1,
                    down: true,
                },
            ),
            "tablet has no button 1",
        ),
        (stand.fault("upper", "servo 3 asleep"), "column 9"),
        (
            stand.push("tail", 1.0),
            "there is no joint \"tail\"; there are: neck_yaw",
        ),
    ];
    for (result, words) in rows {
        let message = result.expect_err(words).to_string();
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn the_truth_is_told_in_the_joints_own_angles() {
    let clock = VirtualClock::new();
    let mut equipment = Equipment {
        puppet: Some("marionette".into()),
        ..Equipment::default()
    };
    equipment.plan.start_rad.insert("neck_pitch".into(), 0.25);
    let stand = equipment
        .stand(Arc::new(clock), &Profiles::builtin())
        .expect("built in");
    let joints = stand.joints();
    assert_eq!(joints.len(), 22);
    let neck = stand.joint("neck_pitch").expect("there");
    assert!((neck.position_rad - 0.25).abs() < 1e-9 && !neck.torque);
    stand.push("neck_pitch", -0.1).expect("pushed");
    assert!((stand.joint("neck_pitch").expect("there").position_rad - 0.15).abs() < 1e-9);
    equipment.plan.start_rad.insert("tail".into(), 0.0);
    assert!(
        equipment
            .stand(Arc::new(VirtualClock::new()), &Profiles::builtin())
            .is_err()
    );
}
