//! Handshakes with a device at the far end of a line: every step, and unplugging inside every step.

use super::{Device, Health};
use crate::clock::Instant;
use crate::codec::{Codec, Counters, Feedback, Handshake, InputEvent, Outgoing};
use crate::transport::memory::reports::{self, Noticed, ReportDevice};
use device_profiles::{HexBytes, InitStep, RangeFrom};
use std::time::Duration;

/// Says `Started` when it is begun, and a restart for every report.
#[derive(Default)]
struct Behind {
    begun: bool,
    told: bool,
}

impl Codec for Behind {
    fn start(&mut self, _now: Instant, _out: &mut Outgoing) {
        *self = Self {
            begun: true,
            told: false,
        };
    }
    fn decode(&mut self, _bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        emit(InputEvent::Restarted);
    }
    fn advance(&mut self, _now: Instant, _out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        if self.begun && !self.told {
            self.told = true;
            emit(InputEvent::Started);
        }
    }
    fn encode(&mut self, _feedback: &Feedback, _out: &mut Outgoing) {}
    fn let_go(&mut self, _emit: &mut dyn FnMut(InputEvent)) {}
    fn started(&self) -> bool {
        self.begun
    }
    fn counters(&self) -> Counters {
        Counters::default()
    }
}

const NAME: [u8; 12] = [12, 3, b'H', 0, b'U', 0, b'I', 0, b'O', 0, b'N', 0];
const RANGES: [u8; 19] = [
    0x13, 3, 0x70, 0xC6, 0, 0x06, 0x7C, 0, 0xFF, 0x1F, 0xD8, 0x13, 3, 0x0D, 0x10, 1, 4, 0x3C, 0x3E,
];
/// Output report 2 of 9 bytes behind its id, feature report 5 of 2.
const DESCRIPTOR: [u8; 22] = [
    0x06, 0, 0xFF, 0x09, 1, 0xA1, 1, 0x85, 2, 0x75, 8, 0x95, 9, 0x91, 2, 0x85, 5, 0x95, 2, 0xB1, 2, 0xC0,
];

fn step(change: impl FnOnce(&mut InitStep)) -> InitStep {
    let mut step = InitStep::default();
    change(&mut step);
    step
}

/// One of each kind.
fn steps() -> Vec<InitStep> {
    vec![
        step(|s| {
            s.string = Some(201);
            s.expect = Some("HUIO".to_owned());
        }),
        step(|s| s.wait_ms = Some(20)),
        step(|s| s.output = HexBytes::parse("02 b0 04")),
        step(|s| s.feature = HexBytes::parse("05 02")),
        step(|s| {
            s.read_feature = Some(5);
            s.expect = Some("05 02".to_owned());
        }),
        step(|s| {
            s.string = Some(123);
            s.optional = true;
        }),
        step(|s| {
            s.string = Some(200);
            s.range_from = Some(RangeFrom::UclogicV2);
        }),
    ]
}

fn handshake(steps: Vec<InitStep>) -> Handshake {
    Handshake::of_steps(steps, Box::new(Behind::default()))
}

fn plug() -> (reports::ReportTransport, ReportDevice) {
    let (host, far) = reports::pair("sim:pad");
    far.set_descriptor(&DESCRIPTOR);
    far.set_string(201, &NAME);
    far.set_string(200, &RANGES);
    far.set_feature(5, &[5, 2, 0]);
    (host, far)
}

fn at_ms(ms: u64) -> Instant {
    Instant::ZERO.after(Duration::from_millis(ms))
}

/// Polls every millisecond until it is well, at most three seconds.
fn run(device: &mut Device, from_ms: u64, events: &mut Vec<crate::codec::Stamped<InputEvent>>) -> Health {
    let mut health = Health::Lost;
    for ms in from_ms..from_ms + 3000 {
        health = device.poll(at_ms(ms), events);
        if !matches!(health, Health::Silent { .. }) {
            break;
        }
    }
    health
}

#[test]
fn every_step_is_done_in_order_and_the_device_tells_its_ranges() {
    let (host, far) = plug();
    let mut device = Device::new("pad", "test", Box::new(host), Box::new(handshake(steps())));
    // Before the handshake is over its reports mean nothing.
    far.report(&[0x0A, 1, 2]);
    let mut events = Vec::new();
    assert_eq!(run(&mut device, 0, &mut events), Health::Present);
    let noticed: Vec<_> = std::iter::from_fn(|| far.noticed()).collect();
    let asked = |index| Noticed::AskedString(index);
    assert_eq!(
        noticed,
        [
            asked(201),
            Noticed::Output(vec![2, 0xB0, 4, 0, 0, 0, 0, 0, 0, 0]),
            Noticed::Feature(vec![5, 2, 0]),
            Noticed::AskedFeature(5),
            // Not there, and not needed: tried three times.
            asked(123),
            asked(123),
            asked(123),
            asked(200),
        ]
    );
    let surface = device.surface().expect("it was told");
    assert_eq!(surface.max_counts, [50_800, 31_750]);
    assert_eq!(device.identity(), Some("HUION"));
    far.report(&[8]);
    run(&mut device, 3000, &mut events);
    let said: Vec<_> = events.into_iter().map(|event| event.what).collect();
    assert_eq!(said, [InputEvent::Started, InputEvent::Restarted]);
}

#[test]
fn unplugging_inside_every_step_ends_clean_and_begins_again() {
    // Late answers stretch each question over several polls, so that every step is met half done.
    for unplug_at in 0..60 {
        let (host, far) = plug();
        let mut device = Device::new("pad", "test", Box::new(host), Box::new(handshake(steps())));
        let mut events = Vec::new();
        for ms in 0..unplug_at {
            if ms % 3 == 0 {
                far.answer_late(2);
            }
            device.poll(at_ms(ms * 7), &mut events);
        }
        drop(far);
        assert_eq!(
            device.poll(at_ms(unplug_at * 7), &mut events),
            Health::Lost,
            "{unplug_at}"
        );
        let (host, far) = plug();
        device.reconnect(Box::new(host));
        events.clear();
        assert_eq!(
            run(&mut device, 1000, &mut events),
            Health::Present,
            "{unplug_at}"
        );
        assert_eq!(events.len(), 1, "{unplug_at}");
        assert_eq!(
            far.noticed(),
            Some(Noticed::AskedString(201)),
            "from the first step"
        );
    }
}

#[test]
fn a_wrong_answer_is_told_and_tried_again_later() {
    let (host, far) = plug();
    // What firmware sends that has no such string.
    far.set_string(201, &[0xC8, 0x0E, 0, 0x20, 0x65, 1, 0, 8]);
    let mut device = Device::new("pad", "test", Box::new(host), Box::new(handshake(steps())));
    let mut events = Vec::new();
    for ms in 0..1000 {
        device.poll(at_ms(ms), &mut events);
    }
    let trouble = device.trouble().expect("it is in trouble").to_owned();
    assert!(
        trouble.starts_with("step 1 of its handshake: expected a string descriptor"),
        "{trouble}"
    );
    assert!(!device.started());
    far.set_string(201, &NAME);
    assert_eq!(run(&mut device, 1000, &mut events), Health::Present);
    assert_eq!(device.trouble(), None);
}

#[test]
fn silence_and_other_answers_do_not_hold_it_up_for_ever() {
    let (host, far) = plug();
    far.set_string(201, &[6, 3, b'X', 0, b'P', 0]);
    let mut device = Device::new("pad", "test", Box::new(host), Box::new(handshake(steps())));
    let mut events = Vec::new();
    for ms in 0..500 {
        device.poll(at_ms(ms), &mut events);
    }
    assert!(device.trouble().is_some_and(|why| why.contains("found \"XP\"")));
    far.answer_late(u32::MAX);
    for ms in 500..30_000 {
        device.poll(at_ms(ms), &mut events);
    }
    assert!(
        device
            .trouble()
            .is_some_and(|why| why.contains("no answer within 3 s"))
    );
    far.answer_late(0);
    far.set_string(201, &NAME);
    let mut health = Health::Lost;
    for ms in 30_000..45_000 {
        health = device.poll(at_ms(ms), &mut events);
    }
    assert_eq!(health, Health::Present);
}
