use super::*;
use crate::usb_device::pad::pen_at;

fn reports(tablet: &mut dyn UsbDevice, until_us: u64) -> Vec<Vec<u8>> {
    std::iter::from_fn(|| tablet.report(until_us))
        .map(|report| report.bytes)
        .collect()
}

fn tablet() -> Box<dyn UsbDevice> {
    let mut tablet = pth_660();
    tablet.listen(0, 0, true);
    tablet
}

#[test]
fn every_field_of_the_pen_is_where_the_descriptor_says() {
    let pen = Pen {
        tip: true,
        buttons: 2,
        pressure: 1.0,
        tilt_deg: [-64, 10],
        ..pen_at([44_800, 0x1234], MAX)
    };
    let mut tablet = tablet();
    tablet.touch(0, &Touch::Pen(pen));
    let got = reports(&mut *tablet, 0);
    let mut want = vec![
        0x10, 0x65, 0x00, 0xAF, 0x00, 0x34, 0x12, 0x00, 0xFF, 0x1F, 0xC0, 0xF6,
    ];
    want.extend([0, 0, 0, 0, 0, 1, 0, 0, 0x2A, 0, 0, 0, 0, 0x42, 0x08]);
    assert_eq!(got, [want]);
}

#[test]
fn the_other_end_leaves_and_comes_with_its_own_kind() {
    let mut tablet = tablet();
    let pen = pen_at([10, 20], MAX);
    tablet.touch(0, &Touch::Pen(pen));
    let rubber = Pen {
        eraser: true,
        tip: true,
        pressure: 0.5,
        serial: 77,
        ..pen
    };
    tablet.touch(10_000, &Touch::Pen(rubber));
    let got = reports(&mut *tablet, 30_000);
    let seen: Vec<_> = got.iter().map(|bytes| (bytes[1], bytes[17], bytes[25])).collect();
    assert_eq!(seen, [(0x60, 1, 0x42), (0, 1, 0x42), (0x78, 77, 0x4A)]);
}

#[test]
fn keys_ring_and_its_button_share_a_report() {
    let mut tablet = tablet();
    let key = |control, down| Touch::Button { control, down };
    let ring = |at| Touch::Ring { control: 0, at };
    let touches = [
        key(7, true),
        ring(Some(0.999)),
        key(8, true),
        ring(None),
        key(7, false),
    ];
    for (n, touch) in touches.iter().enumerate() {
        assert!(tablet.touch(5_000 * n as u64, touch));
    }
    let got = reports(&mut *tablet, 100_000);
    let seen: Vec<_> = got.iter().map(|bytes| (bytes[1], bytes[3], bytes[4])).collect();
    assert_eq!(
        seen,
        [
            (0x80, 0, 0),
            (0x80, 0, 0xC7),
            (0x80, 1, 0xC7),
            (0x80, 1, 0),
            (0, 1, 0)
        ]
    );
    assert!(got.iter().all(|bytes| bytes.len() == 9));
}

#[test]
fn the_mode_is_said_back() {
    let mut tablet = tablet();
    assert_eq!(tablet.feature(0, 0, 2), Ok(vec![2, 0]));
    tablet.set_feature(0, 0, &[2, 2]).expect("takes it");
    assert_eq!(tablet.feature(0, 0, 2), Ok(vec![2, 2]));
    assert_eq!(tablet.feature(0, 1, 2), Err(Stall));
}
