//! A cycle asks for no memory, whatever it meets: what runs hundreds of times a second must not wait for an allocator.

mod world {
    pub(super) use device::servo::framing::dynamixel2::encode;
    pub(super) use device::servo::framing::{Decoder, Heard};
    pub(super) use device::transport::{Boundary, Transport, TransportError};
    pub(super) use device::{Clock, Instant, VirtualClock};
    pub(super) use device_profiles::{ServoProfile, ServoProtocol};
}
#[path = "../src/servo/responder.rs"]
#[allow(
    dead_code,
    unreachable_pub,
    reason = "the far end of other tests, of which this needs a part"
)]
mod responder;

use device::servo::{Armed, Bus, BusSettings, Goal, Limits, Member, Readings};
use device::transport::{Boundary, Transport, TransportError};
use device::{Clock, VirtualClock};
use device_profiles::Profiles;
use responder::Responder;
use std::time::Duration;

const IDS: [u8; 24] = [
    1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24,
];

/// The far end's own memory does not count.
struct Uncounted(Box<dyn Transport>);

impl Transport for Uncounted {
    fn boundary(&self) -> Boundary {
        self.0.boundary()
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let mut count = Ok(0);
        allocation_counter::opt_out(|| count = self.0.read(buffer));
        count
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let mut written = Ok(());
        allocation_counter::opt_out(|| written = self.0.write(bytes));
        written
    }
}

/// Allocations of a thousand cycles of 20 ms, once every way of reading has been gone through.
fn allocations(readings: Readings) -> u64 {
    let clock = VirtualClock::new();
    clock.advance(Duration::from_secs(1));
    let profiles = Profiles::builtin();
    let servo = profiles.servo("xl330-m288").expect("it is built in");
    let far = Responder::new(&clock, servo, &IDS);
    let limits = Limits::new([-1.5, 1.5], 3.0, 20.0).expect("in order");
    let member =
        |id: &u8| Member::new(&format!("joint {id}"), *id, servo.clone(), 1, 2048, limits).expect("in range");
    let settings = BusSettings {
        readings,
        ..BusSettings::new("counted", 1_000_000)
    };
    let line = Box::new(Uncounted(far.transport()));
    let mut bus = Bus::new(line, IDS.iter().map(member).collect(), settings).expect("ids differ");
    assert_eq!(bus.arm_blocking(&clock, &mut |_| {}).expect("a line"), Armed::Yes);
    let mut cycle = |number: u64| {
        // Everything that may happen in the rhythm of some cycles each: silence, lateness, and neither.
        allocation_counter::opt_out(|| {
            let mut desk = far.desk();
            desk.silent.clear();
            if number / 60 % 3 == 1 {
                desk.silent.insert(7);
            }
            let late = number % 40 == 39;
            desk.delay = if late {
                Duration::from_millis(27)
            } else {
                Duration::ZERO
            };
        });
        let goal = if (number / 30).is_multiple_of(2) {
            0.5
        } else {
            -0.5
        };
        let goals = [goal; IDS.len()];
        let now = clock.now();
        bus.poll(now, &mut |_| {}).expect("a line");
        if bus.armed() == Armed::Yes {
            bus.command(Goal::Positions(&goals), now, &mut |_| {})
                .expect("a line");
        }
        let until = now.after(Duration::from_millis(20));
        while clock.now() < until {
            bus.wait(&clock, until);
            bus.poll(clock.now(), &mut |_| {}).expect("a line");
            bus.use_pause(clock.now(), until).expect("a line");
        }
    };
    (0..400).for_each(&mut cycle);
    let counted = allocation_counter::measure(|| (400..1400).for_each(&mut cycle));
    assert_eq!(bus.armed(), Armed::Yes, "it was armed all the time");
    assert!(bus.counters().stale > 0, "{:?}", bus.counters());
    counted.count_total
}

#[test]
fn a_cycle_asks_for_no_memory() {
    for readings in [Readings::Position, Readings::Motion] {
        assert_eq!(allocations(readings), 0, "{readings:?}");
    }
}
