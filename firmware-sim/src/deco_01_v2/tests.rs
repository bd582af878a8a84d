use super::*;
use crate::usb_device::pad::pen_at;

fn init(tablet: &mut dyn UsbDevice, at_us: u64) {
    let mut report = INIT.to_vec();
    report.resize(10, 0);
    tablet.output(at_us, 2, &report).expect("there");
}

fn listened(mut tablet: Box<dyn UsbDevice>, at_us: u64) -> Box<dyn UsbDevice> {
    for interface in 0..3 {
        tablet.listen(at_us, interface, true);
    }
    tablet
}

fn reports(tablet: &mut dyn UsbDevice, until_us: u64) -> Vec<(u8, Vec<u8>)> {
    std::iter::from_fn(|| tablet.report(until_us))
        .map(|report| (report.interface, report.bytes))
        .collect()
}

#[test]
fn before_the_handshake_it_is_a_pen_on_another_scale_and_a_keyboard() {
    let mut tablet = listened(deco_01_v2_rev_b(), 0);
    let pen = Pen {
        tip: true,
        pressure: 4546.0 / f64::from(PRESSURE_MAX),
        tilt_deg: [60, -19],
        ..pen_at([14_266, 14_096], [DEFAULT_MAX; 2])
    };
    tablet.touch(0, &Touch::Pen(pen));
    let recorded = vec![0x07, 0xA1, 0xBA, 0x37, 0x10, 0x37, 0xC2, 0x11, 0x3C, 0x13];
    assert_eq!(reports(&mut *tablet, 0), [(1, recorded)]);
    let key = |down| Touch::Button { control: 0, down };
    tablet.touch(10_000, &key(true));
    tablet.touch(20_000, &key(false));
    let got = reports(&mut *tablet, 20_000);
    let keyboard = |modifiers, usage| (0, vec![6, modifiers, usage, 0, 0, 0, 0, 0]);
    assert_eq!(got, [keyboard(1, 0x57), keyboard(0, 0)]);
}

#[test]
fn after_it_everything_is_report_two() {
    let mut tablet = listened(deco_01_v2(), 0);
    init(&mut *tablet, 0);
    assert_eq!(tablet.reporting_since_us(), Some(0));
    let pen = Pen {
        tip: true,
        pressure: 1.0,
        buttons: 1,
        tilt_deg: [10, 20],
        ..pen_at([0x1234, 0x0102], MAX)
    };
    tablet.touch(0, &Touch::Pen(pen));
    tablet.touch(4_000, &Touch::Away);
    tablet.touch(
        8_000,
        &Touch::Button {
            control: 7,
            down: true,
        },
    );
    let got = reports(&mut *tablet, 8_000);
    assert_eq!(
        got,
        [
            (
                2,
                vec![2, 0xA3, 0x34, 0x12, 0x02, 0x01, 0xFF, 0x1F, 10, 0xEC, 0, 0]
            ),
            (
                2,
                vec![2, 0xC0, 0x34, 0x12, 0x02, 0x01, 0xFF, 0x1F, 10, 0xEC, 0, 0]
            ),
            (2, vec![2, 0xF0, 0x80, 0, 0, 0, 0, 0, 0, 0, 0, 0]),
        ]
    );
    assert_eq!(tablet.string(9_000, 100).expect("answers"), PARAMETERS);
    assert_eq!(tablet.arrival(9_000), 1, "this one stays");
}

#[test]
fn revision_b_leaves_after_the_handshake_and_returns_as_another_product() {
    let mut tablet = listened(deco_01_v2_rev_b(), 0);
    assert_eq!(tablet.facts().product, 0x0905);
    init(&mut *tablet, 1_000);
    assert_eq!(
        tablet.string(2_000, 100).expect("answers before it goes"),
        PARAMETERS
    );
    assert_eq!(tablet.arrival(2_000), 0);
    assert_eq!(tablet.string(3_000, 100), Err(Stall));
    assert_eq!(tablet.arrival(501_999), 0);
    assert_eq!(tablet.arrival(502_000), 2);
    assert_eq!(tablet.facts().product, 0x1227);
    assert_eq!(tablet.reporting_since_us(), None, "nobody listens yet");
    let mut tablet = listened(tablet, 600_000);
    assert_eq!(tablet.reporting_since_us(), Some(600_000));
    init(&mut *tablet, 600_000);
    tablet.string(600_000, 100).expect("answers");
    assert_eq!(tablet.arrival(700_000), 2, "once is enough");
    tablet.touch(700_000, &Touch::Pen(pen_at([5, 6], MAX)));
    assert_eq!(reports(&mut *tablet, 700_000)[0].1[0], 2);
    tablet.plug(800_000, false);
    tablet.plug(900_000, true);
    assert_eq!((tablet.arrival(900_000), tablet.facts().product), (3, 0x0905));
}

#[test]
fn strings_tell_the_model_and_outputs_elsewhere_are_refused() {
    let mut tablet = deco_01_v2();
    assert_eq!(tablet.string(0, 4), Ok(string_descriptor("UG901_BPU1002")));
    assert_eq!(tablet.string(0, 101), Err(Stall));
    assert_eq!(tablet.output(0, 0, &INIT), Err(Stall));
    assert_eq!(tablet.output(0, 2, &[2, 0xB0, 2]), Err(Stall));
}
