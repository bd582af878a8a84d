use super::*;
use crate::codec::{Answer, Outgoing, Step};
use crate::transport::memory::reports::{self, Noticed};
use crate::transport::memory::{MemoryTransport, pair};
use device_profiles::Profiles;
use std::sync::{Arc, Mutex};
use std::time::Duration;

fn device() -> (Device, MemoryTransport) {
    let (host, far) = pair();
    let all = Profiles::builtin();
    let profile = all.input("sgi-dialbox").expect("it is built in");
    (
        Device::of_profile("box", profile, Box::new(host)).expect("its format is known"),
        far,
    )
}

fn at_ms(ms: u64) -> Instant {
    Instant::ZERO.after(Duration::from_millis(ms))
}

fn read_all(far: &mut MemoryTransport) -> Vec<u8> {
    let mut buffer = [0; 256];
    let count = far.read(&mut buffer).expect("the host is there");
    buffer[..count].to_vec()
}

#[test]
fn silence_becomes_presence_with_the_first_answer() {
    let (mut device, mut far) = device();
    let mut events = Vec::new();
    assert_eq!(
        device.poll(at_ms(5), &mut events),
        Health::Silent { since: at_ms(5) }
    );
    assert_eq!(read_all(&mut far), [0x20]);
    assert_eq!(
        device.poll(at_ms(9), &mut events),
        Health::Silent { since: at_ms(5) }
    );
    far.write(&[0x20]).expect("the host is there");
    assert_eq!(device.poll(at_ms(12), &mut events), Health::Present);
    assert_eq!(
        events,
        [Stamped {
            at: at_ms(12),
            what: InputEvent::Started
        }]
    );
}

#[test]
fn a_lost_device_lets_go_and_comes_back_with_its_lamps() {
    let (mut device, mut far) = device();
    let mut events = Vec::new();
    device.poll(at_ms(0), &mut events);
    far.write(&[0x20]).expect("the host is there");
    device.poll(at_ms(1), &mut events);
    device.show(&Feedback::Lamps(4)).expect("the box is there");
    far.write(&[0xD8]).expect("the host is there");
    drop(far);
    events.clear();
    assert_eq!(device.poll(at_ms(2), &mut events), Health::Lost);
    let button = |down| InputEvent::Button { control: 0, down };
    let said: Vec<_> = events.drain(..).map(|e| e.what).collect();
    assert_eq!(said, [button(true), button(false)]);
    assert!(device.lost().is_some_and(TransportError::is_gone));

    let (host, mut far) = pair();
    device.reconnect(Box::new(host));
    device.poll(at_ms(3), &mut events);
    far.write(&[0x20]).expect("the host is there");
    assert_eq!(device.poll(at_ms(4), &mut events), Health::Present);
    assert!(read_all(&mut far).ends_with(&[0x75, 4, 0, 0, 0]));
    assert_eq!(events.last().map(|e| &e.what), Some(&InputEvent::Restarted));
}

/// A codec that asks what it was told to ask, and writes down what comes.
#[derive(Default)]
struct Asking {
    steps: Vec<Step>,
    heard: Arc<Mutex<Vec<String>>>,
}

impl Asking {
    fn hear(&self, text: String) {
        self.heard.lock().expect("nobody panics with it").push(text);
    }
}

impl Codec for Asking {
    fn start(&mut self, _now: Instant, out: &mut Outgoing) {
        self.steps.iter().for_each(|step| out.step(step.clone()));
    }
    fn decode(&mut self, _bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        emit(InputEvent::Restarted);
    }
    fn answer(&mut self, answer: Answer, now: Instant, _out: &mut Outgoing) {
        self.hear(format!("{} ms {answer:?}", now.as_micros() / 1000));
    }
    fn advance(&mut self, _now: Instant, _out: &mut Outgoing, _emit: &mut dyn FnMut(InputEvent)) {}
    fn encode(&mut self, _feedback: &Feedback, _out: &mut Outgoing) {}
    fn let_go(&mut self, _emit: &mut dyn FnMut(InputEvent)) {}
    fn started(&self) -> bool {
        true
    }
    fn counters(&self) -> Counters {
        Counters::default()
    }
}

#[test]
fn steps_are_done_in_order_with_waits_late_answers_and_refusals() {
    let (host, far) = reports::pair("sim:pad");
    far.set_string(200, &[4, 3, 65, 0]);
    far.set_descriptor(&[5, 1]);
    let heard = Arc::new(Mutex::new(Vec::new()));
    let codec = Asking {
        steps: vec![
            Step::Report(vec![2, 0xB0]),
            Step::Wait(Duration::from_millis(10)),
            Step::AskString(200),
            Step::AskString(7),
            Step::Feature(vec![2, 2]),
            Step::AskFeature { id: 9, bytes: 4 },
            Step::AskDescriptor,
        ],
        heard: Arc::clone(&heard),
    };
    let mut device = Device::new("pad", "test", Box::new(host), Box::new(codec));
    let mut events = Vec::new();
    device.poll(at_ms(0), &mut events);
    device.poll(at_ms(9), &mut events);
    assert_eq!(far.noticed(), Some(Noticed::Output(vec![2, 0xB0])));
    assert_eq!(far.noticed(), None, "it waits");
    far.answer_late(2);
    for ms in 10..14 {
        device.poll(at_ms(ms), &mut events);
    }
    let noticed: Vec<_> = std::iter::from_fn(|| far.noticed()).collect();
    assert_eq!(
        noticed,
        [
            Noticed::AskedString(200),
            Noticed::AskedString(7),
            Noticed::Feature(vec![2, 2]),
            Noticed::AskedFeature(9)
        ]
    );
    let heard = heard.lock().expect("nobody panics with it");
    let begins = [
        "12 ms Text { index: 200, raw: Ok([4, 3, 65, 0]) }",
        "12 ms Text { index: 7, raw: Err(",
        "12 ms Feature { id: 9, bytes: Err(",
        "12 ms Descriptor(Ok([5, 1]))",
    ];
    assert_eq!(heard.len(), begins.len(), "{heard:?}");
    for (text, begin) in heard.iter().zip(begins) {
        assert!(text.starts_with(begin), "{text}");
    }
    assert_eq!(
        device.poll(at_ms(20), &mut events),
        Health::Present,
        "refusals are no loss"
    );
}

#[test]
fn every_report_keeps_its_own_time_and_none_is_of_the_future() {
    let (host, far) = reports::pair("sim:pad");
    let mut device = Device::new("pad", "test", Box::new(host), Box::new(Asking::default()));
    for (button, ms) in [(1, 3), (2, 4), (3, 99)] {
        far.report_at(&[button], at_ms(ms));
    }
    far.report(&[4]);
    let mut events = Vec::new();
    device.poll(at_ms(10), &mut events);
    let times: Vec<_> = events.iter().map(|event| event.at).collect();
    assert_eq!(times, [at_ms(3), at_ms(4), at_ms(10), at_ms(10)]);
}

#[test]
fn unplugging_while_a_question_is_open_ends_clean_and_can_be_resumed() {
    let (host, far) = reports::pair("sim:pad");
    let codec = Asking {
        steps: vec![Step::AskString(200)],
        ..Asking::default()
    };
    let mut device = Device::new("pad", "test", Box::new(host), Box::new(codec));
    far.answer_late(100);
    let mut events = Vec::new();
    device.poll(at_ms(0), &mut events);
    drop(far);
    assert_eq!(device.poll(at_ms(1), &mut events), Health::Lost);
    let (host, far) = reports::pair("sim:pad");
    far.set_string(200, &[2, 3]);
    device.reconnect(Box::new(host));
    assert_eq!(device.poll(at_ms(2), &mut events), Health::Present);
    assert_eq!(far.noticed(), Some(Noticed::AskedString(200)));
}
