//! A HID device whose descriptor and reports are anybody's. The laws:
//!
//! - Nothing panics, whatever is described and sent, and every report is counted once.
//! - A descriptor that is refused is refused with a place inside it, and always for the same reason.
//! - Events name controls that the device has described, nothing pressed out of range.
//! - The same reports give the same events again, and once everything is let go nothing is held.

use device::clock::Instant;
use device::codec::hid::descriptor::Descriptor;
use device::codec::hid::{HidCodec, describe};
use device::codec::{Codec, InputEvent, Outgoing};
use device_profiles::{ControlClass, InputProfile};

/// Reports in one run.
const REPORTS_MAX: usize = 64;

/// Two bytes of length, so many of a descriptor, then reports of a byte of length each.
pub fn run(bytes: &[u8]) {
    let Some((&[low, high], rest)) = bytes.split_first_chunk() else {
        return;
    };
    let length = usize::from(u16::from_le_bytes([low, high])).min(rest.len());
    let (descriptor, reports) = rest.split_at(length);
    match Descriptor::parse(descriptor) {
        Err(error) => {
            assert!(error.at <= descriptor.len(), "{error}");
            assert_eq!(HidCodec::generic(descriptor).expect_err("refused before"), error);
        }
        Ok(_) => obey(descriptor, reports),
    }
}

fn obey(descriptor: &[u8], reports: &[u8]) {
    let profile = describe(descriptor).expect("it was read before");
    let mut one = HidCodec::generic(descriptor).expect("it was read before");
    let mut other = HidCodec::generic(descriptor).expect("it was read before");
    let mut counted = 0;
    let mut rest = reports;
    while let Some((&length, behind)) = rest.split_first().filter(|_| counted < REPORTS_MAX as u64) {
        let (report, behind) = behind.split_at(usize::from(length).min(behind.len()));
        rest = behind;
        counted += 1;
        let heard = hear(&mut one, report);
        assert_eq!(hear(&mut other, report), heard, "the same again");
        for event in &heard {
            tame(event, &profile);
        }
        let counters = one.counters();
        assert_eq!(counters.reports + counters.unknown + counters.rejected, counted);
    }
    let mut let_go = Vec::new();
    one.let_go(&mut |event| let_go.push(event));
    for event in let_go {
        let away = match event {
            InputEvent::Pen(sample) => !sample.in_range,
            InputEvent::Touch { at, .. } => at.is_none(),
            InputEvent::Button { down, .. } | InputEvent::AxisTouched { down, .. } => !down,
            InputEvent::Ring { value, .. } => value.is_none(),
            _ => false,
        };
        assert!(away, "{event:?} lets nothing go");
    }
    one.let_go(&mut |event| panic!("{event:?} was still held"));
    one.advance(Instant::ZERO, &mut Outgoing::new(), &mut |event| {
        panic!("{event:?} out of nothing")
    });
}

fn hear(codec: &mut HidCodec, report: &[u8]) -> Vec<InputEvent> {
    let mut events = Vec::new();
    codec.decode(report, &mut |event| events.push(event));
    events
}

fn tame(event: &InputEvent, profile: &InputProfile) {
    let there = |class, control| assert!(control < profile.count(class), "{event:?}");
    match *event {
        InputEvent::Pen(sample) => {
            assert!(sample.in_range || (!sample.tip && sample.buttons == 0 && sample.pressure_counts == 0));
        }
        InputEvent::Dial {
            control,
            delta_counts,
        } => {
            there(ControlClass::Dial, control);
            assert_ne!(delta_counts, 0);
        }
        InputEvent::Button { control, .. } => there(ControlClass::Button, control),
        InputEvent::Axis { control, .. } => there(ControlClass::Axis, control),
        InputEvent::Ring { control, .. } => there(ControlClass::Ring, control),
        InputEvent::Touch { .. } | InputEvent::Moved { .. } => {}
        InputEvent::AxisTouched { .. } | InputEvent::Started | InputEvent::Restarted => {
            panic!("{event:?} out of a report")
        }
    }
}
