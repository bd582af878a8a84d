//! The state machine on a scripted far end: what fits when, and that nothing ever jumps.

mod world {
    pub(super) use device::servo::framing::dynamixel2::encode;
    pub(super) use device::servo::framing::{Decoder, Heard};
    pub(super) use device::{Boundary, Clock, Instant, Transport, TransportError, VirtualClock};
    pub(super) use device_profiles::{ServoProfile, ServoProtocol};
}
// Only what the player needs of it is used here.
#[allow(dead_code)]
#[path = "../../device/src/servo/responder.rs"]
mod responder;

use super::*;
use crate::order::Order;
use crate::report::Phase;
use device::{Clock, VirtualClock};
use device_profiles::{Policy, Profiles, Reaction};
use motion::joint_clip::JointClip;
use proptest::prelude::*;
use responder::{ERROR, POSITION, Responder, TEMPERATURE, TORQUE};
use std::sync::Arc;
use std::time::Duration;

#[path = "known_tests.rs"]
mod known;
#[path = "policy_tests.rs"]
mod policies;

const PERIOD: Duration = Duration::from_millis(20);

/// A player on the far end, and a judge of every goal it sends.
struct Bench {
    clock: VirtualClock,
    far: Vec<Responder>,
    player: Player,
    goals: Vec<Option<(f64, f64)>>,
    sent_at: f64,
}

impl Bench {
    /// A player whose puppet lets go whatever happens.
    fn new(config: PlayerConfig) -> Self {
        let letting_go = Policy {
            on_heat: Reaction::Release,
            on_overload: Reaction::Release,
            on_brownout: Reaction::Release,
            on_lost_host: Reaction::Release,
            ..Policy::default()
        };
        Self::with_policy(config, letting_go)
    }

    fn with_policy(config: PlayerConfig, policy: Policy) -> Self {
        let profiles = Profiles::builtin();
        let puppet = Puppet::new(profiles.puppet("marionette").unwrap(), &profiles).unwrap();
        let puppet = puppet.with_policy(policy);
        let clock = VirtualClock::new();
        clock.advance(Duration::from_secs(1));
        let far: Vec<Responder> = puppet
            .buses()
            .iter()
            .map(|bus| {
                let ids: Vec<u8> = bus.members.iter().map(device::servo::Member::id).collect();
                let far = Responder::new(&clock, bus.members[0].servo(), &ids);
                for member in &bus.members {
                    let [low, high] = member.range_counts();
                    let counts = i64::midpoint(low, high) + 40;
                    far.desk()
                        .set(member.id(), POSITION, &(counts as u32).to_le_bytes());
                    let model = member.servo().model_number.to_le_bytes();
                    far.desk().set(member.id(), 0, &model);
                    far.desk().set(member.id(), 6, &[member.servo().firmware]);
                }
                far
            })
            .collect();
        let buses = puppet.buses().iter().zip(&far);
        let buses = buses
            .map(|(bus, far)| puppet.connect(&bus.name, far.transport()).unwrap())
            .collect();
        let goals = vec![None; puppet.joints().len()];
        let player = Player::new(puppet, buses, config).unwrap();
        Self {
            clock,
            far,
            player,
            goals,
            sent_at: 0.0,
        }
    }

    fn holding() -> Self {
        let mut bench = Self::new(PlayerConfig::default());
        bench.tick(vec![Order::Arm]);
        bench.until("holding");
        bench
    }

    fn tick(&mut self, orders: Vec<Order>) -> Report {
        let now = self.clock.now();
        let report = self.player.tick(now, &mut orders.into_iter()).clone();
        self.judge(&report);
        self.clock.advance(PERIOD);
        report
    }

    /// Speed and acceleration of the goals, by differences, must keep each joint's limits.
    fn judge(&mut self, report: &Report) {
        if !report.goals_sent {
            self.goals.fill(None);
            return;
        }
        let dt = report.at.as_secs_f64() - self.sent_at;
        self.sent_at = report.at.as_secs_f64();
        let limits = &self.player.lines.limits;
        for ((joint, before), limits) in report.joints.iter().zip(&mut self.goals).zip(limits) {
            let goal = joint.goal_rad.expect("goals were sent");
            let velocity = before.map_or(0.0, |(rad, _)| (goal - rad) / dt);
            if let Some((_, velocity_before)) = *before {
                let acceleration = (velocity - velocity_before) / dt;
                assert!(velocity.abs() <= limits.velocity_max_rad_per_s());
                assert!(acceleration.abs() <= limits.acceleration_max_rad_per_s2());
            } else {
                let measured = joint.measured_rad.expect("measured before torque");
                assert!(
                    (goal - measured).abs() < 0.002,
                    "first goal {goal}, measured {measured}"
                );
            }
            // A pinned goal is a whole count and may lie half a count outside.
            assert!(limits.contains(goal, 0.0008));
            *before = Some((goal, velocity));
        }
    }

    fn until(&mut self, state: &str) -> Report {
        for _ in 0..1000 {
            let report = self.tick(vec![]);
            if report.state.name() == state {
                return report;
            }
        }
        panic!("never {state}: {:?}", self.player.state());
    }

    fn torque(&self) -> bool {
        self.far.iter().any(|far| {
            let desk = far.desk();
            desk.servos.keys().any(|id| desk.get(*id, TORQUE, 1) == 1)
        })
    }

    fn clip(from: f64, to: f64) -> Arc<JointClip> {
        let joints = vec!["neck_yaw".to_owned(), "left_elbow".to_owned()];
        let rows = (0..=50).flat_map(|row| {
            let rad = from + (to - from) * f64::from(row) / 50.0;
            [rad, rad * 0.5]
        });
        Arc::new(JointClip::new(joints, 0.04, rows.collect()).unwrap())
    }

    fn play(from: f64, to: f64, looped: bool) -> Order {
        Order::Play {
            clip: Self::clip(from, to),
            from_secs: 0.0,
            speed: 1.0,
            looped,
        }
    }
}

#[test]
fn a_clip_is_approached_played_and_ended() {
    let mut bench = Bench::holding();
    let yaw = bench.player.puppet().joint("neck_yaw").unwrap();
    let still = bench.player.puppet().joint("neck_pitch").unwrap();
    let stood = bench.player.report().joints[still].goal_rad;
    let mut report = bench.tick(vec![Bench::play(-1.0, 1.0, false)]);
    while report.phase != Phase::Running {
        assert_eq!(report.clip_secs, Some(0.0), "time stands still while approaching");
        report = bench.tick(vec![]);
    }
    assert!((report.joints[yaw].goal_rad.unwrap() + 1.0).abs() < 0.003);
    let report = bench.until("holding");
    assert_eq!(report.clip_secs, None);
    for _ in 0..20 {
        bench.tick(vec![]);
    }
    let report = bench.player.report();
    assert!(
        (report.joints[yaw].goal_rad.unwrap() - 1.0).abs() < 1e-6,
        "arrives at the last pose"
    );
    assert_eq!(
        report.joints[still].goal_rad, stood,
        "joints that are not played stand"
    );
    bench.tick(vec![Order::Release]);
    bench.until("released");
    assert!(!bench.torque());
}

#[test]
fn orders_that_do_not_fit_are_rejected_in_words() {
    let mut bench = Bench::new(PlayerConfig::default());
    let rejected = |report: Report| {
        report
            .rejected
            .map(|rejection| rejection.to_string())
            .unwrap_or_default()
    };
    let clip = Bench::play(0.0, 1.0, false);
    assert_eq!(
        rejected(bench.tick(vec![clip])),
        "cannot play while released; arm first"
    );
    assert_eq!(
        rejected(bench.tick(vec![Order::Reset])),
        "cannot reset while released; there is no fault to leave"
    );
    bench.tick(vec![Order::Arm]);
    assert_eq!(
        rejected(bench.tick(vec![Order::Hold])),
        "cannot hold while arming; wait until arming is done"
    );
    bench.until("holding");
    assert!(rejected(bench.tick(vec![Order::Seek(1.0)])).contains("play a clip first"));
    assert!(
        rejected(bench.tick(vec![Order::Follow(Arc::from([0.0]))])).contains("has 1 angles, the puppet 22")
    );
    bench.tick(vec![Order::Stop]);
    assert_eq!(
        rejected(bench.tick(vec![Order::Arm])),
        "cannot arm while faulted; reset first"
    );
}

#[test]
fn stop_works_in_every_state_and_only_reset_leaves_it() {
    // Ticks after arm; after the seventieth a clip has been playing for a while.
    for ticks in [0, 1, 2, 3, 4, 5, 6, 8, 10, 12, 14, 20, 40, 70, 100] {
        let mut bench = Bench::new(PlayerConfig::default());
        bench.tick(vec![Order::Arm]);
        let mut played = false;
        for _ in 0..ticks {
            let play = !played && *bench.player.state() == State::Holding;
            let orders = if play {
                vec![Bench::play(-1.0, 1.0, true)]
            } else {
                vec![]
            };
            played |= play;
            bench.tick(orders);
        }
        let report = bench.tick(vec![Order::Stop]);
        assert_eq!(report.state, State::Faulted(Fault::StopPressed), "after {ticks}");
        for _ in 0..60 {
            bench.tick(vec![]);
        }
        assert!(!bench.torque(), "after {ticks}");
        assert_eq!(*bench.player.state(), State::Faulted(Fault::StopPressed));
        bench.tick(vec![Order::Stop, Order::Reset]);
        assert_eq!(bench.until("released").state, State::Released);
        bench.tick(vec![Order::Arm]);
        bench.until("holding");
    }
}

#[test]
fn a_stop_may_hold_instead_of_release() {
    let mut bench = Bench::new(PlayerConfig {
        ending: Ending::Hold,
        ..PlayerConfig::default()
    });
    bench.tick(vec![Order::Arm]);
    bench.until("holding");
    bench.tick(vec![Bench::play(-1.0, 1.0, true)]);
    for _ in 0..60 {
        bench.tick(vec![]);
    }
    bench.tick(vec![Order::Stop]);
    for _ in 0..100 {
        bench.tick(vec![]);
    }
    assert!(bench.torque());
    assert!(bench.player.lines.all_still());
    bench.tick(vec![Order::Reset]);
    bench.until("released");
    assert!(!bench.torque());
}

#[test]
fn a_refused_arming_says_why_and_stays_released() {
    let mut bench = Bench::new(PlayerConfig::default());
    bench.far[0].desk().set(2, TEMPERATURE, &[80]);
    bench.tick(vec![Order::Arm]);
    let report = bench.until("released");
    assert!(report.arming_refused);
    let said: Vec<String> = bench.player.refusals().map(ToString::to_string).collect();
    assert!(
        said[0].contains("\"neck_pitch\", servo 2: is at 80 C"),
        "{said:?}"
    );
    for _ in 0..30 {
        bench.tick(vec![]);
    }
    assert!(!bench.torque());
}

#[test]
fn what_goes_wrong_stops_the_player_with_a_name() {
    type Spoil = fn(&mut Bench);
    let cases: [(Spoil, &str); 6] = [
        (
            |bench| {
                bench.far[0].desk().silent.insert(12);
            },
            "bus-silent",
        ),
        (|bench| bench.far[0].desk().gone = true, "bus-lost"),
        (|bench| bench.far[1].desk().set(3, ERROR, &[32]), "servo-error"),
        (|bench| bench.far[1].desk().set(3, TEMPERATURE, &[70]), "hot"),
        (|bench| bench.far[1].desk().set(3, TORQUE, &[0]), "torque-lost"),
        (
            |bench| bench.player.config.operator_max = Some(Duration::from_millis(500)),
            "operator-gone",
        ),
    ];
    for (spoil, name) in cases {
        let mut bench = Bench::holding();
        bench.tick(vec![Bench::play(-1.0, 1.0, true)]);
        for _ in 0..50 {
            bench.tick(vec![]);
        }
        spoil(&mut bench);
        let State::Faulted(fault) = bench.until("faulted").state else {
            panic!("{name}")
        };
        assert_eq!(fault.name(), name, "{fault}");
        let lost = bench.far[0].desk().gone;
        for _ in 0..150 {
            bench.tick(vec![]);
        }
        bench.far[0].desk().gone = false;
        assert!(lost || !bench.torque(), "{name}");
    }
}

#[test]
fn a_servo_that_does_not_follow_is_strained() {
    let mut bench = Bench::holding();
    bench.far[0].desk().stuck.insert(1);
    bench.tick(vec![Order::Follow(Arc::from(vec![1.2; 22]))]);
    let state = bench.until("faulted").state;
    let State::Faulted(Fault::Strained { place, .. }) = state else {
        panic!("{state:?}")
    };
    assert_eq!(place.joint, "neck_yaw");
}

#[test]
fn late_ticks_in_a_row_are_a_fault_and_a_single_pause_is_not() {
    let mut bench = Bench::holding();
    bench.tick(vec![Bench::play(-1.0, 1.0, true)]);
    bench.clock.advance(Duration::from_secs(2));
    bench.goals.fill(None);
    for _ in 0..100 {
        bench.tick(vec![]);
    }
    assert_eq!(
        *bench.player.state(),
        State::Playing,
        "measured, pinned and approached again"
    );
    for _ in 0..10 {
        bench.clock.advance(Duration::from_millis(25));
        bench.tick(vec![]);
    }
    assert_eq!(
        *bench.player.state(),
        State::Faulted(Fault::LateTicks { count: 10 })
    );
}

#[test]
fn servos_pinned_between_ticks_are_approached_again() {
    let mut bench = Bench::holding();
    bench.tick(vec![Bench::play(-1.0, 1.0, true)]);
    while bench.tick(vec![]).phase != Phase::Running {}
    bench.clock.advance(Duration::from_millis(250));
    bench.tick(vec![]);
    for _ in 0..200 {
        bench.player.poll(bench.clock.now());
        bench.clock.advance(Duration::from_micros(500));
    }
    assert!(bench.player.lines.all_armed(), "pinned before the next tick");
    assert_eq!(bench.tick(vec![]).phase, Phase::Approaching);
}

#[test]
fn a_lost_line_is_reconnected_and_armed_from_where_the_joints_are() {
    let mut bench = Bench::holding();
    bench.far[1].desk().gone = true;
    bench.until("faulted");
    bench.far[1].desk().gone = false;
    bench.far[1].desk().set(11, POSITION, &2100_u32.to_le_bytes());
    let transport = bench.far[1].transport();
    bench.player.reconnect("lower", transport).unwrap();
    bench.tick(vec![Order::Reset]);
    bench.until("released");
    bench.tick(vec![Order::Arm]);
    bench.until("holding");
    bench.tick(vec![]);
}

/// An operator with a list of orders, and a line to give back, who leaves after so many ticks.
struct Visitor {
    orders: std::vec::IntoIter<Order>,
    line: Option<(String, Box<dyn Transport>)>,
    ticks: u128,
    leaves_at: u128,
    states: Vec<&'static str>,
}

impl Visitor {
    fn new(orders: Vec<Order>, leaves_at: u128) -> Self {
        Self {
            orders: orders.into_iter(),
            line: None,
            ticks: 0,
            leaves_at,
            states: Vec::new(),
        }
    }
}

impl crate::Operator for Visitor {
    fn order(&mut self) -> Option<Order> {
        self.orders.next()
    }

    fn returned_line(&mut self) -> Option<(String, Box<dyn Transport>)> {
        self.line.take()
    }

    fn seen(&mut self, player: &Player) -> std::ops::ControlFlow<()> {
        self.ticks += 1;
        self.states.push(player.state().name());
        if self.ticks >= self.leaves_at {
            std::ops::ControlFlow::Break(())
        } else {
            std::ops::ControlFlow::Continue(())
        }
    }
}

#[test]
fn the_loop_ends_without_torque_however_it_is_left() {
    let mut bench = Bench::new(PlayerConfig::default());
    let mut visitor = Visitor::new(vec![Order::Arm], 150);
    let began = bench.clock.now();
    crate::run(&mut bench.player, &bench.clock, PERIOD, &mut visitor);
    assert!(visitor.states.contains(&"holding"));
    assert!(!bench.torque());
    let took = bench.clock.now().since(began);
    assert_eq!(
        took.as_millis().div_ceil(20),
        visitor.ticks - 1,
        "one tick a period, none in a burst"
    );
}

#[test]
fn a_line_that_is_back_does_not_end_a_fault() {
    let mut bench = Bench::new(PlayerConfig::default());
    bench.tick(vec![Order::Arm]);
    bench.until("holding");
    bench.far[1].desk().gone = true;
    bench.until("faulted");
    bench.far[1].desk().gone = false;
    let mut visitor = Visitor::new(Vec::new(), 50);
    visitor.line = Some(("lower".to_owned(), bench.far[1].transport()));
    crate::run(&mut bench.player, &bench.clock, PERIOD, &mut visitor);
    let stayed = visitor.states.iter().take(50).all(|state| *state == "faulted");
    assert!(stayed, "only a reset leaves it: {:?}", visitor.states);
}

fn order() -> impl Strategy<Value = u8> {
    prop_oneof![6 => 0_u8..6, 1 => 6_u8..9]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, ..ProptestConfig::default() })]

    /// Whatever is ordered and however irregular the ticks: the judge in `Bench::tick` finds no goal beyond a
    /// joint's limits, and a stop ends without torque.
    #[test]
    fn no_order_makes_a_goal_jump(
        orders in proptest::collection::vec((order(), -3.0..3.0, 1_usize..25, 0_u64..60), 1..25),
    ) {
        let mut bench = Bench::holding();
        for (kind, value, ticks, pause_ms) in orders {
            let order = match kind {
                0 => Bench::play(value, -value * 0.3, true),
                1 => Bench::play(-1.2, value, false),
                2 => Order::Seek(value.abs()),
                3 => Order::Follow(Arc::from(vec![value; 22])),
                4 => Order::Follow(Arc::from(vec![if value > 0.0 { f64::NAN } else { f64::INFINITY }; 22])),
                5 => Order::Hold,
                6 => Order::Release,
                7 => Order::Stop,
                _ => Order::Reset,
            };
            bench.tick(vec![order]);
            bench.clock.advance(Duration::from_millis(pause_ms));
            for _ in 0..ticks {
                let arm = *bench.player.state() == State::Released;
                bench.tick(if arm { vec![Order::Arm] } else { vec![] });
            }
        }
        bench.tick(vec![Order::Stop]);
        for _ in 0..60 {
            bench.tick(vec![]);
        }
        prop_assert!(!bench.torque());
    }
}
