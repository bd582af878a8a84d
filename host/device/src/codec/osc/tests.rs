//! Packets in and out, as TouchOSC's page and one of our own say.

use super::*;
use device_profiles::Profiles;
use proptest::prelude::*;
use rosc::{OscBundle, OscMessage, OscPacket, OscTime};
use std::time::Duration;

fn at_ms(ms: u64) -> Instant {
    Instant::ZERO.after(Duration::from_millis(ms))
}

fn desk() -> InputProfile {
    toml::from_str(
        r#"
name = "test"
status = "untested"
kind = "osc"
format = "osc"
source = "test"
[[control]]
kind = "fader"
name = "fader"
count = 2
range = [0, 1000]
address = "/1/fader{n}"
[[control]]
kind = "axis"
name = "pad"
count = 2
range = [-100, 100]
address = "/3/xy"
[[control]]
kind = "button"
name = "toggle"
count = 2
address = "/1/toggle{n}"
[[control]]
kind = "dial"
name = "encoder"
address = "/2/encoder"
[[output]]
kind = "lamp"
of = "toggle"
count = 2
address = "/1/toggle{n}"
[[output]]
kind = "label"
of = "fader"
count = 2
address = "/1/label{n}"
"#,
    )
    .expect("a profile")
}

fn message(address: &str, args: Vec<OscType>) -> Vec<u8> {
    rosc::encoder::encode(&packet(address, args)).expect("encodes")
}

fn packet(address: &str, args: Vec<OscType>) -> OscPacket {
    OscPacket::Message(OscMessage {
        addr: address.to_owned(),
        args,
    })
}

fn hear(codec: &mut Osc, bytes: &[u8]) -> Vec<InputEvent> {
    let mut events = Vec::new();
    codec.decode(bytes, &mut |event| events.push(event));
    events
}

/// Messages that go out at `ms`, as address and number.
fn sent(codec: &mut Osc, ms: u64) -> Vec<(String, f32)> {
    let mut out = Outgoing::new();
    codec.advance(at_ms(ms), &mut out, &mut |_| {});
    read(&mut out)
}

fn read(out: &mut Outgoing) -> Vec<(String, f32)> {
    let mut all = Vec::new();
    while let Some(step) = out.next_step() {
        let crate::codec::Step::Report(bytes) = step else {
            panic!("a packet is a report: {step:?}");
        };
        match rosc::decoder::decode_udp(&bytes).expect("a packet") {
            (rest, OscPacket::Message(message)) => {
                assert!(rest.is_empty());
                let value = match &message.args[..] {
                    [OscType::Float(value)] => *value,
                    [OscType::String(text)] => text.len() as f32,
                    other => panic!("one value: {other:?}"),
                };
                all.push((message.addr, value));
            }
            (_, OscPacket::Bundle(_)) => panic!("no bundles are sent"),
        }
    }
    all
}

fn started(profile: &InputProfile) -> Osc {
    let mut codec = Osc::new(profile);
    let mut events = Vec::new();
    codec.start(at_ms(0), &mut Outgoing::new());
    codec.advance(at_ms(0), &mut Outgoing::new(), &mut |event| events.push(event));
    assert_eq!(events, [InputEvent::Started]);
    codec
}

fn axis(control: u16, value: i32) -> InputEvent {
    InputEvent::Axis { control, value }
}

#[test]
fn numbers_of_every_type_move_what_their_address_says() {
    let mut codec = started(&desk());
    let table: [(&str, Vec<OscType>, Vec<InputEvent>); 9] = [
        ("/1/fader1", vec![OscType::Float(0.5)], vec![axis(0, 500)]),
        ("/1/fader2", vec![OscType::Double(1.0)], vec![axis(1, 1000)]),
        ("/1/fader2", vec![OscType::Float(7.0)], vec![axis(1, 1000)]),
        (
            "/3/xy",
            vec![OscType::Float(0.0), OscType::Float(1.0)],
            vec![axis(2, -100), axis(3, 100)],
        ),
        (
            "/1/toggle2",
            vec![OscType::Int(1)],
            vec![InputEvent::Button {
                control: 1,
                down: true,
            }],
        ),
        (
            "/1/toggle2",
            vec![OscType::Bool(false)],
            vec![InputEvent::Button {
                control: 1,
                down: false,
            }],
        ),
        (
            "/2/encoder",
            vec![OscType::Float(1.0)],
            vec![InputEvent::Dial {
                control: 0,
                delta_counts: 1,
            }],
        ),
        (
            "/2/encoder",
            vec![OscType::Float(0.0)],
            vec![InputEvent::Dial {
                control: 0,
                delta_counts: -1,
            }],
        ),
        (
            "/1/fader1/z",
            vec![OscType::Float(1.0)],
            vec![InputEvent::AxisTouched {
                control: 0,
                down: true,
            }],
        ),
    ];
    for (address, args, wanted) in table {
        assert_eq!(hear(&mut codec, &message(address, args)), wanted, "{address}");
    }
    assert_eq!(codec.counters().reports, 9);
}

#[test]
fn bundles_in_bundles_are_taken_in_order_and_not_without_end() {
    let mut codec = started(&desk());
    let bundle = |content| {
        OscPacket::Bundle(OscBundle {
            timetag: OscTime {
                seconds: 3_900_000_000,
                fractional: 1,
            },
            content,
        })
    };
    let fader = |value| packet("/1/fader1", vec![OscType::Float(value)]);
    let nested = bundle(vec![fader(0.1), bundle(vec![fader(0.2)]), fader(0.3)]);
    let bytes = rosc::encoder::encode(&nested).expect("encodes");
    assert_eq!(
        hear(&mut codec, &bytes),
        [axis(0, 100), axis(0, 200), axis(0, 300)]
    );
    let deep = (0..20).fold(fader(0.5), |inner, _| bundle(vec![inner]));
    let bytes = rosc::encoder::encode(&deep).expect("encodes");
    assert_eq!(hear(&mut codec, &bytes), []);
    assert_eq!(codec.counters().rejected, 1);
}

#[test]
fn hearing_asks_for_no_memory() {
    let mut codec = started(&desk());
    let bundle = OscPacket::Bundle(OscBundle {
        timetag: OscTime::from((0, 1)),
        content: vec![
            packet("/1/fader1", vec![OscType::Float(0.25)]),
            packet("/1/toggle1", vec![OscType::Int(1)]),
            packet("/9/nobody", vec![OscType::String("a longer text".into())]),
        ],
    });
    let bytes = rosc::encoder::encode(&bundle).expect("encodes");
    let mut heard = 0;
    codec.decode(&bytes, &mut |_| heard += 1);
    assert_eq!(heard, 2);
    let counted = allocation_counter::measure(|| codec.decode(&bytes, &mut |_| heard += 1));
    assert_eq!((counted.count_total, heard), (0, 3));
}

/// Of a bundle everything before what cannot be read.
#[test]
fn a_bundle_that_breaks_off_is_heard_up_to_there() {
    let mut codec = started(&desk());
    let first = message("/1/fader1", vec![OscType::Float(0.5)]);
    let length = (first.len() as u32).to_be_bytes();
    let bytes = [
        b"#bundle\0\0\0\0\0\0\0\0\x01",
        &length[..],
        &first,
        &length,
        &first[..8],
    ]
    .concat();
    assert_eq!(hear(&mut codec, &bytes), [axis(0, 500)]);
    assert_eq!((codec.counters().reports, codec.counters().rejected), (1, 1));
}

/// As deep as the longest datagram goes: whoever sends it uses up no stack.
#[test]
fn bundles_of_thousands_of_bundles_are_rejected() {
    let mut codec = started(&desk());
    let deep = (0..3000).fold(message("/1/fader1", vec![OscType::Float(0.5)]), |inner, _| {
        let length = (inner.len() as u32).to_be_bytes();
        [b"#bundle\0\0\0\0\0\0\0\0\x01", &length[..], &inner].concat()
    });
    assert_eq!(hear(&mut codec, &deep), []);
    assert_eq!(codec.counters().rejected, 1);
}

#[test]
fn nonsense_is_counted() {
    let mut codec = started(&desk());
    for bytes in [&[][..], &[1, 2, 3], b"/1/fader1", b"#bundle\0\0"] {
        assert_eq!(hear(&mut codec, bytes), []);
    }
    assert_eq!(codec.counters().rejected, 4);
    assert_eq!(
        hear(&mut codec, &message("/9/nobody", vec![OscType::Float(1.0)])),
        []
    );
    assert_eq!(codec.counters().unknown, 1);
    assert_eq!(
        hear(
            &mut codec,
            &message("/1/fader1", vec![OscType::String("x".into())])
        ),
        []
    );
    assert_eq!(
        hear(&mut codec, &message("/1/fader1", vec![OscType::Float(f32::NAN)])),
        []
    );
    assert_eq!(
        hear(&mut codec, &message("/3/xy", vec![OscType::Float(0.0)])),
        [axis(2, -100)]
    );
    assert_eq!(codec.counters().rejected, 7);
}

#[test]
fn what_is_sent_back_goes_to_the_same_address_and_not_to_the_one_that_is_moved() {
    let mut codec = started(&desk());
    let want = |codec: &mut Osc, control, value| {
        codec.encode(&Feedback::Motor { control, value }, &mut Outgoing::new());
    };
    want(&mut codec, 0, 250);
    want(&mut codec, 1, 1000);
    assert_eq!(
        sent(&mut codec, 10),
        [("/1/fader1".to_owned(), 0.25), ("/1/fader2".to_owned(), 1.0)]
    );
    // The hand takes fader 1 to 0.75: the parameter follows, and that is not said back.
    hear(&mut codec, &message("/1/fader1", vec![OscType::Float(0.75)]));
    want(&mut codec, 0, 750);
    assert_eq!(sent(&mut codec, 20), []);
    assert_eq!(sent(&mut codec, 2_000), []);
    // It is moved again, and meanwhile the parameter goes elsewhere: told when the hand has left it.
    hear(&mut codec, &message("/1/fader1", vec![OscType::Float(0.8)]));
    want(&mut codec, 0, 100);
    assert_eq!(sent(&mut codec, 2_010), []);
    assert_eq!(sent(&mut codec, 2_400), [("/1/fader1".to_owned(), 0.1)]);
    // A finger that lies still is seen where the controller says so.
    hear(&mut codec, &message("/1/fader2/z", vec![OscType::Float(1.0)]));
    want(&mut codec, 1, 0);
    assert_eq!(sent(&mut codec, 9_000), []);
    hear(&mut codec, &message("/1/fader2/z", vec![OscType::Float(0.0)]));
    assert_eq!(sent(&mut codec, 9_010), [("/1/fader2".to_owned(), 0.0)]);
}

#[test]
fn lamps_and_labels_are_sent_when_they_change() {
    let mut codec = started(&desk());
    let show = |codec: &mut Osc, feedback: &Feedback| {
        let mut out = Outgoing::new();
        codec.encode(feedback, &mut out);
        read(&mut out)
    };
    let both = [("/1/toggle1".to_owned(), 1.0), ("/1/toggle2".to_owned(), 0.0)];
    assert_eq!(show(&mut codec, &Feedback::Lamps(1)), both);
    assert_eq!(show(&mut codec, &Feedback::Lamps(1)), []);
    // A toggle shows what it said.
    hear(&mut codec, &message("/1/toggle2", vec![OscType::Float(1.0)]));
    assert_eq!(show(&mut codec, &Feedback::Lamps(3)), []);
    let label = Feedback::Label {
        control: 1,
        text: "knee".to_owned(),
    };
    assert_eq!(show(&mut codec, &label), [("/1/label2".to_owned(), 4.0)]);
    // A controller that comes back is shown everything.
    codec.start(at_ms(1), &mut Outgoing::new());
    assert_eq!(sent(&mut codec, 2).len(), 3);
}

#[test]
fn touchosc_as_shipped() {
    let profile = Profiles::builtin().input("touchosc").expect("built in").clone();
    let mut codec = started(&profile);
    let events = hear(&mut codec, &message("/1/fader5", vec![OscType::Float(0.5)]));
    let [InputEvent::Axis { control: 4, value }] = events[..] else {
        panic!("{events:?}");
    };
    let range = profile.controls[0].range.expect("a range");
    assert!(
        (f64::from(value - range[0]) / f64::from(range[1] - range[0]) - 0.5).abs() < 1e-3,
        "{value} of {range:?}"
    );
}

proptest! {
    #[test]
    fn any_packet_is_survived(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let mut codec = started(&desk());
        hear(&mut codec, &bytes);
    }

    #[test]
    fn a_broken_packet_is_survived(at in 0usize..40, byte in any::<u8>(), length in 0usize..40) {
        let mut codec = started(&desk());
        let mut bytes = message("/3/xy", vec![OscType::Float(0.25), OscType::Int(1)]);
        if let Some(place) = bytes.get_mut(at) {
            *place = byte;
        }
        bytes.truncate(length);
        for event in hear(&mut codec, &bytes) {
            if let InputEvent::Axis { value, .. } = event {
                prop_assert!((-100..=100).contains(&value));
            }
        }
    }
}
