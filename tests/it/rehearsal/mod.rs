//! A small puppet, its player and its simulated servos in virtual time, with a tap on every line.
//!
//! Five joints on two buses, taken from the shipped marionette: three small servos of a neck, and two of a hip
//! that are mounted the other way round. Nothing here goes through the rig or the bench, so that what is proved
//! rests on player, device and firmware-sim alone.

mod instruction;
mod tap;

pub(crate) use tap::Failing;
use tap::{Bounds, Seen, Tap, lock};

use device::servo::Member;
use device::{Clock, Instant, Transport, VirtualClock};
use device_profiles::{Policy, Profiles, PuppetProfile};
use dialrig_tests::simulated::Line;
use firmware_sim::servo_bus::{BusOptions, Sag, Unit};
use firmware_sim::{Fault, ServoBus};
use motion::JointClip;
use player::{Order, Player, PlayerConfig, Puppet, Report, State};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Looks between two ticks, as the player's own loop would take.
const LOOKS: u32 = 4;
/// A simulated shaft may be this much faster than its limit: the speed is a difference of two positions a
/// millisecond apart, which rounding blurs. The simulated motor itself never exceeds its profile.
const SPEED_SLACK: f64 = 1.0 + 1e-6;
/// A goal's rate may show so much more than its limit, since it is taken from differences of goals.
const RATE_SLACK: f64 = 1.0 + 1e-4;

/// One bus of the puppet.
pub(crate) struct Hung {
    pub(crate) name: String,
    pub(crate) line: Line<ServoBus>,
    bounds: Arc<BTreeMap<u8, Bounds>>,
    pub(crate) seen: Arc<Mutex<Seen>>,
}

/// See the module.
pub(crate) struct Rehearsal {
    pub(crate) clock: VirtualClock,
    pub(crate) player: Player,
    pub(crate) buses: Vec<Hung>,
    period: Duration,
    /// What was wrong, other than with goals on the wire.
    wrong: Vec<String>,
    goals: Vec<Track>,
    ticked: Instant,
}

/// A joint's goals of the last tick and the one before.
#[derive(Clone, Copy, Debug, Default)]
struct Track {
    goal_rad: Option<f64>,
    velocity_rad_per_s: Option<f64>,
}

/// The shipped marionette without its arms and one leg.
fn profile(profiles: &Profiles) -> PuppetProfile {
    let mut puppet = profiles.puppet("marionette").expect("it is built in").clone();
    puppet
        .groups
        .retain(|group| ["trunk", "head", "lt"].contains(&group.link.as_str()));
    for group in &mut puppet.groups {
        let kept = |bus: &str| group.link != "trunk" || bus.is_empty();
        group.joints.retain(|joint| kept(&joint.bus));
    }
    puppet
}

impl Rehearsal {
    /// Everything standing at `start_rad` (from each joint's zero), torque off, nothing sent yet.
    pub(crate) fn new(start_rad: f64, seed: u64) -> Self {
        Self::with_policy(start_rad, seed, |_| {})
    }

    /// The same with another policy than the shipped puppet's.
    pub(crate) fn with_policy(start_rad: f64, seed: u64, change: impl FnOnce(&mut Policy)) -> Self {
        let profiles = Profiles::builtin();
        let mut profile = profile(&profiles);
        change(&mut profile.policy);
        let puppet = Puppet::new(&profile, &profiles).expect("the marionette fits its servos");
        let clock = VirtualClock::new();
        let buses: Vec<Hung> = puppet
            .buses()
            .iter()
            .map(|bus| Hung::new(&bus.name, bus.baud, &bus.members, start_rad, seed, &clock))
            .collect();
        let lines = buses
            .iter()
            .map(|hung| {
                puppet
                    .connect(&hung.name, hung.tap(&clock))
                    .expect("it is the puppet's bus")
            })
            .collect();
        let config = PlayerConfig::default();
        let period = config.period;
        let joints = puppet.joints().len();
        let player = Player::new(puppet, lines, config).expect("these are its buses");
        Self {
            clock,
            player,
            buses,
            period,
            wrong: Vec::new(),
            goals: vec![Track::default(); joints],
            ticked: Instant::ZERO,
        }
    }

    /// One period: a tick with these orders, then looks until the next.
    pub(crate) fn tick(&mut self, orders: impl IntoIterator<Item = Order>) -> &Report {
        let now = self.clock.now();
        self.player.tick(now, &mut orders.into_iter());
        self.judge(now);
        for _ in 0..LOOKS {
            self.clock.advance(self.period / LOOKS);
            self.player.poll(self.clock.now());
        }
        self.player.report()
    }

    /// Ticks for a while without orders.
    pub(crate) fn run(&mut self, secs: f64) {
        let end = self.clock.now().after(Duration::from_secs_f64(secs));
        while self.clock.now() < end {
            self.tick([]);
        }
    }

    /// Ticks until the state has that name; false if it does not come to that.
    pub(crate) fn run_until(&mut self, state: &str, limit_secs: f64) -> bool {
        let end = self.clock.now().after(Duration::from_secs_f64(limit_secs));
        while self.clock.now() < end {
            self.tick([]);
            if self.player.state().name() == state {
                return true;
            }
        }
        false
    }

    /// The host sleeps: time goes on for the servos, and nobody asks them anything.
    pub(crate) fn stall(&mut self, secs: f64) {
        self.clock.advance(Duration::from_secs_f64(secs));
    }

    /// Takes a cable out or puts it back, with the player's line on it.
    pub(crate) fn plug(&mut self, bus: usize, connected: bool) {
        let Some(hung) = self.buses.get(bus) else { return };
        hung.line.connect(connected);
        if connected {
            lock(&hung.seen).fail = None;
            let (name, tap) = (hung.name.clone(), hung.tap(&self.clock));
            self.player.reconnect(&name, tap).expect("it is the puppet's bus");
        }
    }

    /// Brings a fault in on a bus.
    pub(crate) fn inject(&mut self, bus: usize, text: &str) {
        let fault = Fault::parse(text).expect("a fault by name");
        if let Some(hung) = self.buses.get(bus) {
            hung.line.with(|bus, now_us| bus.inject(now_us, &fault));
        }
    }

    /// Ends all faults and plugs everything in.
    pub(crate) fn mend(&mut self) {
        for at in 0..self.buses.len() {
            self.buses[at].line.with(ServoBus::mend);
            self.plug(at, true);
        }
    }

    /// A hand turns the first joint of a bus if nothing holds it; the way back from a push against torque would
    /// be the hand's doing.
    pub(crate) fn push(&mut self, bus: usize, rad: f64) {
        let Some(hung) = self.buses.get(bus) else { return };
        let Some(&id) = hung.bounds.keys().next() else {
            return;
        };
        hung.line.with(|bus, now_us| {
            if bus.servo(id).is_some_and(|servo| !servo.torque_is_on()) {
                bus.push(now_us, id, rad);
            }
        });
    }

    /// Stops as a program that ends does, and tells which servos still have torque.
    pub(crate) fn close(&mut self) -> Vec<String> {
        self.mend();
        self.tick([Order::Stop]);
        self.run(6.0);
        self.with_torque()
    }

    /// The joints whose servos have power and torque.
    pub(crate) fn with_torque(&self) -> Vec<String> {
        let on = self.buses.iter().flat_map(|hung| {
            hung.line.with(|bus, _| {
                let on = bus
                    .servos()
                    .iter()
                    .filter(|servo| servo.is_connected() && servo.torque_is_on());
                on.map(|servo| format!("{} servo {}", hung.name, servo.id()))
                    .collect::<Vec<_>>()
            })
        });
        on.collect()
    }

    /// The names of joints outside their range, with how far; what a hand has done does not count here.
    pub(crate) fn outside_range(&self) -> Vec<String> {
        let mut outside = Vec::new();
        for hung in &self.buses {
            for (id, bounds) in hung.bounds.iter() {
                let counts = hung.line.with(|bus, _| {
                    let shaft = bus
                        .servo(*id)
                        .map(firmware_sim::servo_bus::Servo::true_position_rad);
                    shaft.unwrap_or(0.0) / bounds.rad_per_count + bounds.centre
                });
                let [low, high] = bounds.range;
                if counts < low - 1.0 || counts > high + 1.0 {
                    outside.push(format!("{} at {counts:.1}, range {low} to {high}", bounds.joint));
                }
            }
        }
        outside
    }

    /// Goals that have gone out on all buses.
    pub(crate) fn goals_sent(&self) -> u64 {
        self.buses.iter().map(|hung| lock(&hung.seen).goals).sum()
    }

    /// Reads and writes on all buses.
    pub(crate) fn operations(&self, bus: usize) -> u64 {
        self.buses.get(bus).map_or(0, |hung| lock(&hung.seen).operations)
    }

    /// Lets the `nth` read or write on a bus fail.
    pub(crate) fn fail(&mut self, bus: usize, nth: u64, how: Failing) {
        if let Some(hung) = self.buses.get(bus) {
            lock(&hung.seen).fail = Some((nth, how));
        }
    }

    /// Puts bytes on a line that no servo has sent.
    pub(crate) fn garble(&mut self, bus: usize, bytes: &[u8]) {
        if let Some(hung) = self.buses.get(bus) {
            lock(&hung.seen).garbage.extend_from_slice(bytes);
        }
    }

    /// Everything that was wrong so far: goals on the wire, rates of goals, speeds of shafts.
    pub(crate) fn wrong(&self) -> Vec<String> {
        let mut all = self.wrong.clone();
        for hung in &self.buses {
            all.extend(lock(&hung.seen).wrong.iter().cloned());
            for (id, bounds) in hung.bounds.iter() {
                let fastest = hung.line.with(|bus, _| {
                    let counters = bus.servo(*id).map(|servo| servo.counters().speed_max_rad_per_s);
                    counters.unwrap_or(0.0) / bounds.rad_per_count
                });
                if fastest > bounds.speed_max * SPEED_SLACK {
                    let most = bounds.speed_max;
                    all.push(format!(
                        "{}: turned at {fastest:.2} counts/s, {most:.2} allowed",
                        bounds.joint
                    ));
                }
            }
        }
        all
    }

    /// Compares the goals of this tick, before they are rounded, with the last tick's.
    fn judge(&mut self, now: Instant) {
        let report = self.player.report();
        let dt = now.since(self.ticked).as_secs_f64();
        self.ticked = now;
        let limits: Vec<_> = self
            .player
            .buses()
            .flat_map(|bus| bus.members().map(Member::limits))
            .collect();
        for (at, (joint, track)) in report.joints.iter().zip(&mut self.goals).enumerate() {
            let Some(limits) = limits.get(at) else { continue };
            let velocity = match (track.goal_rad, joint.goal_rad) {
                (Some(before), Some(goal)) if report.goals_sent && dt > 0.0 => Some((goal - before) / dt),
                _ => None,
            };
            let gained = track.velocity_rad_per_s.zip(velocity).map(|(was, is)| is - was);
            let most = [
                limits.velocity_max_rad_per_s(),
                limits.acceleration_max_rad_per_s2(),
            ];
            if velocity.is_some_and(|velocity| velocity.abs() > most[0] * RATE_SLACK) {
                self.wrong.push(format!(
                    "{:.3} s, joint {at}: goal at {velocity:?} rad/s",
                    now.as_secs_f64()
                ));
            }
            if gained.is_some_and(|gained| gained.abs() > most[1] * dt * RATE_SLACK) {
                self.wrong.push(format!(
                    "{:.3} s, joint {at}: goal gains {gained:?} rad/s in {dt} s",
                    now.as_secs_f64()
                ));
            }
            *track = Track {
                goal_rad: joint.goal_rad,
                velocity_rad_per_s: velocity,
            };
        }
    }
}

impl Hung {
    fn new(
        name: &str,
        baud: u32,
        members: &[Member],
        start_rad: f64,
        seed: u64,
        clock: &VirtualClock,
    ) -> Self {
        let options = BusOptions {
            baud,
            seed,
            ..BusOptions::default()
        };
        let mut bus = ServoBus::new(options);
        let mut bounds = BTreeMap::new();
        for member in members {
            let servo = member.servo();
            let centre = f64::from(servo.centre_counts);
            let start = member.position_counts(start_rad) as f64;
            let unit = Unit {
                start_rad: (start - centre) * servo.rad_per_count(),
                ..Unit::new(member.id())
            };
            bus.add(servo, unit).expect("an id of a puppet");
            let [low, high] = member.range_counts();
            let limit = member.limits().velocity_max_rad_per_s() / servo.rad_per_count();
            bounds.insert(
                member.id(),
                Bounds {
                    joint: member.joint().to_owned(),
                    centre,
                    rad_per_count: servo.rad_per_count(),
                    range: [low as f64, high as f64],
                    speed_max: limit,
                },
            );
        }
        Self {
            name: name.to_owned(),
            line: Line::new(bus, Arc::new(clock.clone())),
            bounds: Arc::new(bounds),
            seen: Arc::default(),
        }
    }

    fn tap(&self, clock: &VirtualClock) -> Box<dyn Transport> {
        let clock = Arc::new(clock.clone());
        Box::new(Tap::new(
            self.line.clone(),
            clock,
            Arc::clone(&self.bounds),
            Arc::clone(&self.seen),
        ))
    }

    /// Gravity on every joint whose torque is off.
    pub(crate) fn sag(&self, rad_per_s: f64) {
        for (id, bounds) in self.bounds.iter() {
            let hanging = (bounds.range[0] - bounds.centre) * bounds.rad_per_count;
            let sag = Sag {
                to_rad: hanging,
                rad_per_s,
            };
            self.line.with(|bus, now_us| bus.set_sag(now_us, *id, Some(sag)));
        }
    }
}

/// Joint names of the rehearsed puppet, in the order of poses.
pub(crate) fn joint_names() -> Vec<String> {
    let profile = profile(&Profiles::builtin());
    profile.joints().map(|joint| joint.name.clone()).collect()
}

/// A clip for the first `rows[0].len()` joints, a row every `period_secs`.
pub(crate) fn clip(period_secs: f64, rows: &[Vec<f64>]) -> Arc<JointClip> {
    let joints = rows.first().map_or(0, Vec::len);
    let names = joint_names().into_iter().take(joints).collect();
    let clip = JointClip::new(names, period_secs, rows.concat());
    Arc::new(clip.expect("finite rows of one length"))
}

/// An order to play a clip from its beginning once.
pub(crate) fn play(clip: &Arc<JointClip>) -> Order {
    Order::Play {
        clip: Arc::clone(clip),
        from_secs: 0.0,
        speed: 1.0,
        looped: false,
    }
}

#[test]
fn a_rehearsal_arms_plays_and_lets_go() {
    let mut rehearsal = Rehearsal::new(0.1, 0);
    rehearsal.tick([Order::Arm]);
    assert!(
        rehearsal.run_until("holding", 2.0),
        "{:?}",
        rehearsal.player.refusals().collect::<Vec<_>>()
    );
    let clip = clip(0.5, &[vec![0.1; 5], vec![0.4; 5], vec![0.1; 5]]);
    rehearsal.tick([play(&clip)]);
    assert_eq!(rehearsal.player.state(), &State::Playing);
    assert!(rehearsal.run_until("holding", 10.0));
    assert!(rehearsal.goals_sent() > 100);
    assert_eq!(rehearsal.close(), [""; 0]);
    assert_eq!(rehearsal.wrong(), [""; 0]);
    assert_eq!(rehearsal.outside_range(), [""; 0]);
}
