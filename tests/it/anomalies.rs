//! One thing goes wrong, at every place where it can: the n-th read or write of a session fails, for n = 1, 2, 3 …
//! until the session passes it; a cable is pulled at every step; bytes that mean nothing arrive on every line.
//! After each, torque is off or the pose inside its limits, and nothing has panicked.

use crate::rehearsal::{Failing, Rehearsal, clip, play};
use device::codec::Codec;
use device::codec::sgi_dial_box::SgiDialBox;
use device::codec::wacom_iv::WacomIv;
use device::{InputEvent, Instant, Transport};
use device_profiles::{Profiles, Reaction};
use dialrig_tests::measure::interpolant::Chance;
use player::{Order, Trouble};
use std::time::Duration;

/// Operations of the session below are a few hundred; each of the first ones fails in turn, then every so many.
const EVERY_ONE_TO: u64 = 60;
const THEN_EVERY: u64 = 7;

/// Arms, plays a short clip on all joints, and holds. A fault on the way ends it early.
fn session(rehearsal: &mut Rehearsal) {
    rehearsal.tick([Order::Arm]);
    if !rehearsal.run_until("holding", 1.0) {
        return;
    }
    let clip = clip(0.1, &[vec![0.0; 5], vec![0.3; 5], vec![-0.1; 5]]);
    rehearsal.tick([play(&clip)]);
    rehearsal.run_until("holding", 1.5);
}

/// What must be true after anything: everything that can be reached is off or where it may be, and all of it is
/// off and works again once the trouble is over.
fn recovers(rehearsal: &mut Rehearsal, what: &str) {
    rehearsal.run(0.5);
    let on = rehearsal.with_torque();
    let outside = rehearsal.outside_range();
    assert!(
        on.is_empty() || outside.is_empty(),
        "{what}: {on:?} on, and {outside:?}"
    );
    let on = rehearsal.close();
    assert!(on.is_empty(), "{what}: still on after closing: {on:?}");
    rehearsal.tick([Order::Reset]);
    assert!(
        rehearsal.run_until("released", 3.0),
        "{what}: {:?}",
        rehearsal.player.state()
    );
    rehearsal.tick([Order::Arm]);
    let armed = rehearsal.run_until("holding", 3.0);
    let refusals: Vec<_> = rehearsal.player.refusals().map(ToString::to_string).collect();
    assert!(
        armed,
        "{what}: cannot be armed again: {:?} {refusals:?}",
        rehearsal.player.state()
    );
    let on = rehearsal.close();
    assert!(on.is_empty(), "{what}: still on after the second closing: {on:?}");
    let wrong = rehearsal.wrong();
    assert!(wrong.is_empty(), "{what}: {}", wrong.join("\n"));
}

fn fail_each(bus: usize, how: Failing) {
    let mut whole = Rehearsal::new(0.05, 0);
    session(&mut whole);
    assert_eq!(whole.player.state().name(), "holding");
    let operations = whole.operations(bus);
    assert!(
        operations > EVERY_ONE_TO,
        "{operations} operations are no session"
    );
    let mut tried = 0;
    for nth in 1..=operations {
        if nth > EVERY_ONE_TO && nth % THEN_EVERY != 0 {
            continue;
        }
        let mut rehearsal = Rehearsal::new(0.05, 0);
        rehearsal.fail(bus, nth, how);
        session(&mut rehearsal);
        recovers(
            &mut rehearsal,
            &format!("bus {bus}, operation {nth} of {operations}, {how:?}"),
        );
        tried += 1;
    }
    eprintln!("bus {bus}, {how:?}: {tried} of {operations} operations");
}

#[test]
fn every_operation_of_a_session_may_fail_once() {
    fail_each(0, Failing::Once);
}

#[test]
fn every_operation_of_a_session_may_be_the_last_before_the_cable_is_out() {
    fail_each(1, Failing::Unplugged);
}

/// Ends a session wherever it is by an order, at every tick.
#[test]
fn a_stop_at_every_tick_ends_with_torque_off() {
    for order in [Order::Stop, Order::Release] {
        for ticks in (0..70).step_by(3) {
            let mut rehearsal = Rehearsal::new(0.05, 0);
            rehearsal.tick([Order::Arm]);
            for tick in 0..ticks {
                let clip = clip(0.1, &[vec![0.0; 5], vec![0.6; 5]]);
                let armed = tick == 30;
                rehearsal.tick(armed.then(|| play(&clip)));
            }
            rehearsal.tick([order.clone()]);
            rehearsal.run(3.0);
            let on = rehearsal.with_torque();
            assert!(on.is_empty(), "{order:?} after {ticks} ticks: {on:?}");
            assert_eq!(rehearsal.wrong(), [""; 0], "{order:?} after {ticks} ticks");
        }
    }
}

#[test]
fn a_blocked_joint_is_noticed_and_let_go() {
    let mut rehearsal = Rehearsal::with_policy(0.0, 0, |policy| policy.on_overload = Reaction::Release);
    rehearsal.tick([Order::Arm]);
    assert!(rehearsal.run_until("holding", 2.0));
    rehearsal.inject(0, "servo 1 stuck");
    let far = clip(0.5, &[vec![1.2; 5], vec![1.2; 5]]);
    rehearsal.tick([play(&far)]);
    assert!(rehearsal.run_until("faulted", 8.0));
    rehearsal.run(3.0);
    assert_eq!(rehearsal.with_torque(), [""; 0]);
}

#[test]
fn a_blocked_joint_is_noticed_and_its_goal_retreats() {
    let mut rehearsal = Rehearsal::new(0.0, 0);
    rehearsal.tick([Order::Arm]);
    assert!(rehearsal.run_until("holding", 2.0));
    rehearsal.inject(0, "servo 1 stuck");
    let far = clip(0.5, &[vec![1.2; 5], vec![1.2; 5]]);
    rehearsal.tick([play(&far)]);
    let noticed = |rehearsal: &mut Rehearsal| rehearsal.tick([]).backing_off.map(|(trouble, _)| trouble);
    let trouble = (0..1000).find_map(|_| noticed(&mut rehearsal));
    assert_eq!(trouble, Some(Trouble::Overload));
    rehearsal.run(1.0);
    let joint = rehearsal.tick([]).joints[0];
    let (goal, measured) = (
        joint.goal_rad.expect("armed"),
        joint.measured_rad.expect("it answers"),
    );
    assert!(
        (goal - measured).abs() < 0.3,
        "{goal} against {measured}: it goes on pushing"
    );
}

/// Bytes of every kind: random, all one value, headers without packets, packets cut short.
fn garbage(chance: &mut Chance, kind: usize) -> Vec<u8> {
    let mut random =
        |count: usize| -> Vec<u8> { (0..count).map(|_| (chance.next_unit() * 256.0) as u8).collect() };
    match kind % 6 {
        0 => random(300),
        1 => vec![0xFF; 200],
        2 => vec![0x00; 200],
        3 => [0xFF, 0xFF, 0xFD, 0x00].repeat(50),
        4 => [
            &[0xFF, 0xFF, 0xFD, 0x00, 0x01, 0xFF, 0xFF, 0x55][..],
            &random(120),
        ]
        .concat(),
        _ => [0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x08, 0x00, 0x55, 0x00].to_vec(),
    }
}

#[test]
fn garbage_on_a_servo_line_is_counted_and_moves_nothing() {
    let mut chance = Chance(7);
    for kind in 0..12 {
        let mut rehearsal = Rehearsal::new(0.1, 0);
        for bus in 0..2 {
            rehearsal.garble(bus, &garbage(&mut chance, kind));
        }
        rehearsal.tick([Order::Arm]);
        rehearsal.run_until("holding", 2.0);
        let clip = clip(0.2, &[vec![0.1; 5], vec![0.4; 5], vec![0.0; 5]]);
        rehearsal.tick([play(&clip)]);
        for _ in 0..40 {
            for bus in 0..2 {
                rehearsal.garble(bus, &garbage(&mut chance, kind));
            }
            rehearsal.run(0.06);
        }
        recovers(&mut rehearsal, &format!("garbage of kind {kind}"));
    }
}

/// Events name controls that there are.
fn tame(event: &InputEvent) {
    match *event {
        InputEvent::Dial {
            control,
            delta_counts,
        } => {
            assert!(control < 8 && delta_counts.abs() <= 32_768, "{event:?}");
        }
        InputEvent::Button { control, .. } => assert!(control < 32, "{event:?}"),
        InputEvent::Pen(sample) => assert!(sample.in_range || (!sample.tip && sample.buttons == 0)),
        InputEvent::Started | InputEvent::Restarted => {}
        _ => panic!("{event:?} from a device that has nothing of the kind"),
    }
}

#[test]
fn garbage_on_input_lines_makes_no_wild_events() {
    let profiles = Profiles::builtin();
    let knobs = profiles.input("sgi-dialbox").expect("it is built in");
    let tablet = profiles.input("graphire-serial").expect("it is built in");
    let mut chance = Chance(11);
    for kind in 0..60 {
        let codecs: [Box<dyn Codec>; 3] = [
            Box::new(SgiDialBox::new(knobs)),
            Box::new(SgiDialBox::listening(knobs)),
            Box::new(WacomIv::new(tablet)),
        ];
        for mut codec in codecs {
            let mut outgoing = device::codec::Outgoing::new();
            codec.start(Instant::ZERO, &mut outgoing);
            for ms in 0..40_u64 {
                let bytes = garbage(&mut chance, kind);
                codec.decode(&bytes, &mut |event| tame(&event));
                let now = Instant::ZERO.after(Duration::from_millis(ms * 50));
                codec.advance(now, &mut outgoing, &mut |event| tame(&event));
                outgoing.drain().for_each(drop);
            }
            // What was held by accident is let go, once.
            let mut held = 0;
            codec.let_go(&mut |_| held += 1);
            assert!(held <= 33, "{held} things let go");
            codec.let_go(&mut |event| panic!("{event:?} let go twice"));
        }
    }
}

#[test]
fn garbage_from_a_host_leaves_simulated_devices_well() {
    use device::VirtualClock;
    use dialrig_tests::simulated::{Line, bus_of};
    use firmware_sim::dial_box::Options;
    use firmware_sim::servo_bus::BusOptions;
    use std::sync::Arc;
    let mut chance = Chance(13);
    let clock = VirtualClock::new();
    let mut bus = Line::new(bus_of(3, BusOptions::default()), Arc::new(clock.clone()));
    let mut dials = Line::new(
        firmware_sim::SgiDialBox::new(Options::default()),
        Arc::new(clock.clone()),
    );
    for kind in 0..60 {
        let bytes = garbage(&mut chance, kind);
        bus.write(&bytes).expect("the line is there");
        dials.write(&bytes).expect("the line is there");
        clock.advance(Duration::from_millis(400));
        let mut heard = [0; 512];
        while bus.read(&mut heard).expect("the line is there") > 0 {}
        while dials.read(&mut heard).expect("the line is there") > 0 {}
    }
    // A ping to servo 2, worked out by hand from the protocol page and the CRC rule.
    let mut ping = vec![0xFF, 0xFF, 0xFD, 0x00, 0x02, 0x03, 0x00, 0x01];
    ping.extend(device::servo::framing::dynamixel2::crc(&ping).to_le_bytes());
    bus.write(&ping).expect("the line is there");
    clock.advance(Duration::from_millis(10));
    let mut heard = [0; 64];
    let count = bus.read(&mut heard).expect("the line is there");
    assert_eq!(count, 14, "servo 2 answers: {:02x?}", &heard[..count]);
}
