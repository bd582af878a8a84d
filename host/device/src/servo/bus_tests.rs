//! The bus against a scripted far end: order of arming, refusals, silence, lateness, watchdog.

mod world {
    pub(super) use crate::clock::{Clock, Instant, VirtualClock};
    pub(super) use crate::servo::framing::dynamixel2::encode;
    pub(super) use crate::servo::framing::{Decoder, Heard};
    pub(super) use crate::transport::{Boundary, Transport, TransportError};
    pub(super) use device_profiles::{ServoProfile, ServoProtocol};
}
#[path = "responder.rs"]
mod responder;

use super::*;
use crate::clock::VirtualClock;
use crate::servo::event::{BusEvent, Commanded, Goal, Presence};
use crate::servo::limit::Limits;
use crate::servo::maintenance::{Maintenance, MaintenanceError};
use device_profiles::{Profiles, ServoProfile};
use responder::{ERROR, GOAL, POSITION, Responder, TEMPERATURE, TORQUE, WATCHDOG};
use std::time::Duration;

const IDS: [u8; 5] = [1, 2, 3, 4, 5];
const PERIOD: Duration = Duration::from_millis(20);

fn servo() -> ServoProfile {
    Profiles::builtin()
        .servos()
        .find(|servo| servo.model_number == 1200)
        .expect("XL330-M288")
        .clone()
}

struct Bench {
    clock: VirtualClock,
    far: Responder,
    bus: Bus,
    events: Vec<BusEvent>,
}

impl Bench {
    fn new() -> Self {
        let clock = VirtualClock::new();
        clock.advance(Duration::from_secs(1));
        let far = Responder::new(&clock, &servo(), &IDS);
        let bus = Bus::new(
            far.transport(),
            members(&IDS),
            BusSettings::new("test", 1_000_000),
        )
        .unwrap();
        Self {
            clock,
            far,
            bus,
            events: Vec::new(),
        }
    }

    fn armed() -> Self {
        let mut bench = Self::new();
        assert_eq!(bench.arm(), Armed::Yes, "{:?}", bench.bus.refusals());
        bench
    }

    fn arm(&mut self) -> Armed {
        let events = &mut self.events;
        self.bus
            .arm_blocking(&self.clock, &mut |event| events.push(event))
            .unwrap()
    }

    /// Polls, sends goals, and lets a period pass.
    fn cycle(&mut self, goal: Goal<'_>) -> Commanded {
        let now = self.clock.now();
        let events = &mut self.events;
        self.bus.poll(now, &mut |event| events.push(event)).unwrap();
        let commanded = self.bus.command(goal, now, &mut |_| {}).unwrap();
        self.clock.advance(PERIOD);
        commanded
    }

    fn poll(&mut self) {
        let events = &mut self.events;
        self.bus
            .poll(self.clock.now(), &mut |event| events.push(event))
            .unwrap();
    }

    fn cycles(&mut self, count: usize, rad: f64) {
        for _ in 0..count {
            assert_eq!(self.cycle(Goal::Positions(&[rad; IDS.len()])), Commanded::Sent);
        }
    }

    fn ages_ms(&self) -> Vec<u128> {
        let now = self.clock.now();
        (0..IDS.len())
            .map(|at| self.bus.reading(at).unwrap().age(now).as_millis())
            .collect()
    }
}

fn members(ids: &[u8]) -> Vec<Member> {
    let limits = Limits::new([-1.5, 1.5], 3.0, 20.0).unwrap();
    ids.iter()
        .map(|id| Member::new(&format!("joint {id}"), *id, servo(), 1, 2048, limits).unwrap())
        .collect()
}

#[test]
fn arming_pins_before_torque_and_spares_the_eeprom() {
    let mut bench = Bench::new();
    bench.far.desk().set(3, POSITION, &2300_u16.to_le_bytes());
    assert_eq!(bench.arm(), Armed::Yes);
    let writes = std::mem::take(&mut bench.far.desk().writes);
    for id in IDS {
        let at = |address: usize, bytes: &[u8]| {
            let found = writes
                .iter()
                .rposition(|write| *write == (id, address, bytes.to_vec()));
            found.unwrap_or_else(|| panic!("servo {id}: {address} = {bytes:?} was not written"))
        };
        let measured: u32 = if id == 3 { 2300 } else { 2048 };
        let goal = at(GOAL, &measured.to_le_bytes());
        let torque = at(TORQUE, &[1]);
        assert!(at(WATCHDOG, &[0]) < goal && goal < at(WATCHDOG, &[10]) && at(WATCHDOG, &[10]) < torque);
        let delay = writes
            .iter()
            .filter(|write| (write.0, write.1) == (id, 9))
            .count();
        assert_eq!(delay, 1, "Return Delay Time differs from the factory's");
        assert!(
            !writes.iter().any(|write| write.1 == 10 || write.1 == 11),
            "modes are right already"
        );
    }
    assert_eq!(
        bench.bus.goal_rad(2),
        Some(bench.bus.member(2).unwrap().position_rad(2300))
    );

    assert_eq!(
        bench.bus.release_blocking(&bench.clock, &mut |_| {}).unwrap(),
        Armed::No
    );
    assert!(IDS.iter().all(|id| bench.far.desk().get(*id, TORQUE, 1) == 0));
    bench.far.desk().writes.clear();
    assert_eq!(bench.arm(), Armed::Yes);
    assert!(
        bench.far.desk().writes.iter().all(|write| write.1 >= TORQUE),
        "no EEPROM write the second time"
    );
}

#[test]
fn arming_is_refused_by_name_and_leaves_no_torque() {
    type Spoil = fn(&mut responder::Desk);
    let cases: [(Spoil, &str); 7] = [
        (
            |desk| {
                desk.silent.insert(3);
            },
            "does not answer; check its cable",
        ),
        (
            |desk| desk.set(3, 0, &1060_u16.to_le_bytes()),
            "is model 1060, the puppet expects 1200",
        ),
        (|desk| desk.set(3, 6, &[30]), "has firmware 30"),
        (|desk| desk.set(3, ERROR, &[0b10_0100]), "overheating, overload"),
        (|desk| desk.set(3, TEMPERATURE, &[66]), "is at 66 C"),
        (
            |desk| desk.set(3, 48, &2500_u32.to_le_bytes()),
            "limits positions to 0 to 2500",
        ),
        (
            |desk| desk.set(3, POSITION, &5000_u32.to_le_bytes()),
            "stands at 5000 counts",
        ),
    ];
    for (spoil, text) in cases {
        let mut bench = Bench::new();
        spoil(&mut bench.far.desk());
        assert_eq!(bench.arm(), Armed::No);
        let said: Vec<String> = bench.bus.refusals().iter().map(ToString::to_string).collect();
        assert_eq!(said.len(), 1, "{said:?}");
        assert!(
            said[0].starts_with("bus \"test\", joint \"joint 3\", servo 3: "),
            "{said:?}"
        );
        assert!(said[0].contains(text), "{said:?}");
        assert!(bench.events.contains(&BusEvent::ArmingRefused));
        assert!(
            !bench
                .far
                .desk()
                .writes
                .iter()
                .any(|write| write.1 == TORQUE && write.2 == [1])
        );
        let command = bench
            .bus
            .command(Goal::Standstill, bench.clock.now(), &mut |_| {});
        assert!(matches!(command, Err(BusError::NotArmed { .. })));
    }
}

#[test]
fn an_absent_servo_costs_the_others_nothing() {
    for waits in [true, false] {
        let mut bench = Bench::armed();
        bench.cycles(5, 0.0);
        bench.far.desk().waits_for_silent = waits;
        bench.far.desk().silent.insert(2);
        bench.cycles(3, 0.0);
        for _ in 0..30 {
            bench.cycles(1, 0.0);
            bench.poll();
            let ages = bench.ages_ms();
            let others = ages.iter().enumerate().filter(|(at, _)| *at != 1);
            // A period, and one more when it was health's turn.
            assert!(
                others.clone().all(|(_, age)| *age <= 41),
                "waits {waits}: {ages:?}"
            );
        }
        assert_eq!(bench.bus.presence(1), Some(Presence::Absent));
        assert!(
            IDS.iter()
                .enumerate()
                .all(|(at, _)| at == 1 || bench.bus.presence(at) == Some(Presence::Present))
        );
        assert!(bench.events.contains(&BusEvent::Silent { member: 1 }));
        bench.far.desk().silent.clear();
        bench.cycles(60, 0.0);
        assert!(bench.events.contains(&BusEvent::Returned { member: 1 }));
        assert_eq!(bench.bus.presence(1), Some(Presence::Present));
    }
}

#[test]
fn a_late_answer_is_counted_and_never_returned() {
    for late in [25, 30, 45, 70] {
        let mut bench = Bench::armed();
        bench.cycles(10, 0.0);
        bench.far.desk().delay = Duration::from_millis(late);
        bench.cycles(1, 0.5);
        bench.far.desk().delay = Duration::ZERO;
        for _ in 0..20 {
            bench.cycle(Goal::Positions(&[0.5; 5]));
            bench.bus.poll(bench.clock.now(), &mut |_| {}).unwrap();
            let goal = bench.bus.goal_rad(0).unwrap();
            let reading = bench.bus.reading(0).unwrap();
            if reading.age(bench.clock.now()) < Duration::from_millis(21) {
                assert!(
                    (reading.position_rad - goal).abs() < 0.001,
                    "late {late}: an old position as a new one"
                );
            }
        }
        assert!(
            bench.bus.counters().stale >= 5,
            "late {late}: {:?}",
            bench.bus.counters()
        );
    }
}

#[test]
fn prompt_answers_after_held_up_ones_are_believed_again() {
    let mut bench = Bench::new();
    bench.far.desk().held_up = Duration::from_millis(7);
    assert_eq!(bench.arm(), Armed::Yes, "{:?}", bench.bus.refusals());
    bench.cycles(5, 0.0);
    bench.far.desk().held_up = Duration::ZERO;
    let mut pinned_again = false;
    for _ in 0..50 {
        let now = bench.clock.now();
        bench.bus.poll(now, &mut |_| {}).unwrap();
        if bench.bus.armed() == Armed::Yes {
            bench.bus.command(Goal::Standstill, now, &mut |_| {}).unwrap();
        } else {
            pinned_again = true;
        }
        bench.clock.advance(PERIOD);
    }
    assert!(pinned_again, "goals rest on measurements that are believed");
    bench.cycles(10, 0.0);
    let reading = bench.bus.reading(0).unwrap();
    assert!(
        reading.age(bench.clock.now()) < Duration::from_millis(60),
        "read anew"
    );
}

#[test]
fn a_position_that_cannot_be_is_no_reading() {
    let mut bench = Bench::armed();
    bench.cycles(3, 0.0);
    let before = bench.bus.reading(3).unwrap();
    // The far end copies goals into positions only on writes, so this stays until the next goal.
    bench.far.desk().set(4, POSITION, &0x7fff_ffff_u32.to_le_bytes());
    bench.bus.release(bench.clock.now()).unwrap();
    for _ in 0..4 {
        bench.clock.advance(PERIOD);
        let now = bench.clock.now();
        let events = &mut bench.events;
        bench.bus.poll(now, &mut |event| events.push(event)).unwrap();
        bench.bus.observe(now).unwrap();
    }
    assert!(bench.bus.reading(3).unwrap().position_counts == before.position_counts);
    assert!(bench.events.contains(&BusEvent::Implausible {
        member: 3,
        counts: 0x7fff_ffff
    }));
}

#[test]
fn after_a_pause_the_servos_are_measured_and_pinned_anew() {
    let mut bench = Bench::armed();
    bench.cycles(40, 1.0);
    bench.clock.advance(Duration::from_millis(300));
    for id in IDS {
        // What the watchdog does: stop, wherever that is, and refuse goals until it is cleared.
        bench.far.desk().set(id, WATCHDOG, &[0xff]);
        bench.far.desk().set(id, POSITION, &2200_u32.to_le_bytes());
    }
    bench.far.desk().writes.clear();
    assert_eq!(bench.cycle(Goal::Positions(&[-1.0; 5])), Commanded::Lapsed);
    while bench.bus.armed() == Armed::Arming {
        bench.clock.advance(Duration::from_millis(2));
        bench.bus.poll(bench.clock.now(), &mut |_| {}).unwrap();
    }
    assert_eq!(bench.bus.armed(), Armed::Yes, "{:?}", bench.bus.refusals());
    let first_goal = bench
        .far
        .desk()
        .writes
        .iter()
        .find(|write| write.1 == GOAL)
        .cloned()
        .unwrap();
    assert_eq!(first_goal.2, 2200_u32.to_le_bytes(), "pinned to where it stopped");
    let step = bench.bus.member(0).unwrap().position_rad(2200);
    assert_eq!(bench.bus.goal_rad(0), Some(step));
    bench.clock.advance(PERIOD);
    bench.cycles(1, -1.0);
    assert!((bench.bus.goal_rad(0).unwrap() - step).abs() <= 20.0 * 0.02 * 0.02 + 1e-9);
}

#[test]
fn a_watchdog_that_tripped_unnoticed_is_found() {
    let mut bench = Bench::armed();
    bench.cycles(5, 0.0);
    bench.far.desk().set(2, WATCHDOG, &[0xff]);
    let mut tripped = false;
    for _ in 0..200 {
        let now = bench.clock.now();
        bench
            .bus
            .poll(now, &mut |event| {
                tripped |= event == BusEvent::WatchdogTripped { member: 1 }
            })
            .unwrap();
        if bench.bus.armed() == Armed::Yes {
            bench.bus.command(Goal::Standstill, now, &mut |_| {}).unwrap();
        }
        bench.clock.advance(PERIOD);
    }
    assert!(tripped);
    assert_eq!(bench.bus.armed(), Armed::Yes);
    assert_eq!(bench.far.desk().get(2, WATCHDOG, 1), 10);
}

#[test]
fn release_works_from_every_moment_of_arming() {
    for polls in (0..120).step_by(4) {
        let mut bench = Bench::new();
        bench.bus.begin_arming(bench.clock.now()).unwrap();
        for _ in 0..polls {
            bench.bus.poll(bench.clock.now(), &mut |_| {}).unwrap();
            bench.clock.advance(Duration::from_millis(1));
        }
        assert_eq!(
            bench.bus.release_blocking(&bench.clock, &mut |_| {}).unwrap(),
            Armed::No
        );
        assert!(
            IDS.iter().all(|id| bench.far.desk().get(*id, TORQUE, 1) == 0),
            "after {polls} polls"
        );
    }
}

#[test]
fn a_bus_must_make_sense() {
    let clock = VirtualClock::new();
    let far = Responder::new(&clock, &servo(), &IDS);
    let bus = |ids: &[u8]| Bus::new(far.transport(), members(ids), BusSettings::new("test", 1_000_000));
    assert!(matches!(bus(&[]), Err(BusError::Empty { .. })));
    assert!(matches!(bus(&[1, 2, 1]), Err(BusError::SameId { id: 1, .. })));
    let mut bench = Bench::armed();
    let short = bench
        .bus
        .command(Goal::Positions(&[0.0]), bench.clock.now(), &mut |_| {});
    assert!(matches!(short, Err(BusError::GoalCount { want: 5, got: 1, .. })));
}

#[test]
fn a_line_that_is_gone_is_an_error_and_can_be_replaced() {
    let mut bench = Bench::armed();
    bench.cycles(3, 0.2);
    bench.far.desk().gone = true;
    assert!(matches!(
        bench.bus.poll(bench.clock.now(), &mut |_| {}),
        Err(BusError::Transport { .. })
    ));
    bench.far.desk().gone = false;
    bench.bus.reconnect(bench.far.transport()).unwrap();
    assert_eq!(bench.bus.armed(), Armed::No);
    assert_eq!(
        bench.bus.reading(0),
        None,
        "nothing is assumed about what was before"
    );
    assert_eq!(bench.arm(), Armed::Yes);
}

#[test]
fn maintenance_reads_and_writes_but_moves_nothing() {
    let bench = Bench::armed();
    let clock = bench.clock.clone();
    let mut maintenance = bench.bus.into_maintenance(&clock).unwrap();
    assert!(IDS.iter().all(|id| bench.far.desk().get(*id, TORQUE, 1) == 0));
    assert_eq!(maintenance.ping(4, &clock).unwrap().model_number, 1200);
    assert!(matches!(
        maintenance.ping(9, &clock),
        Err(MaintenanceError::Silent { id: 9, .. })
    ));
    assert_eq!(
        maintenance
            .read_register(&servo(), 4, "Present Temperature", &clock)
            .unwrap(),
        30
    );
    maintenance.write_register(&servo(), 4, "LED", 1, &clock).unwrap();
    for (name, raw) in [
        ("Goal Position", 0),
        ("Goal Velocity", 1),
        ("Torque Enable", 1),
        ("Indirect Data 1..28", 0),
    ] {
        let refused = maintenance.write_register(&servo(), 4, name, raw, &clock);
        assert!(matches!(refused, Err(MaintenanceError::Goal { .. })), "{name}");
    }
    let unknown = maintenance
        .write_register(&servo(), 4, "Led", 1, &clock)
        .unwrap_err();
    assert!(unknown.to_string().contains("it has: Model Number"), "{unknown}");
    let found = maintenance
        .scan(&[57_600, 1_000_000], &clock, &mut |_| {})
        .unwrap();
    assert_eq!(
        found
            .iter()
            .filter(|found| found.baud == 1_000_000)
            .map(|found| found.id)
            .collect::<Vec<_>>(),
        IDS
    );
    assert!(maintenance.into_bus().is_some());
}

#[test]
fn maintenance_of_an_unknown_line_changes_nothing_before_it_writes() {
    let clock = VirtualClock::new();
    let far = Responder::new(&clock, &servo(), &IDS);
    far.desk().set(2, TORQUE, &[1]);
    let mut maintenance = Maintenance::new(far.transport(), 1_000_000).unwrap();
    maintenance
        .read_register(&servo(), 1, "Present Position", &clock)
        .unwrap();
    assert_eq!(
        far.desk().get(2, TORQUE, 1),
        1,
        "asking one servo lets no other fall"
    );
    maintenance.write_register(&servo(), 1, "LED", 1, &clock).unwrap();
    assert_eq!(
        far.desk().get(2, TORQUE, 1),
        0,
        "writing begins with torque off everywhere"
    );
}
