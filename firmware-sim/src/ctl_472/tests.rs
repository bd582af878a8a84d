use super::*;
use crate::usb_device::pad::pen_at;

fn reports(tablet: &mut dyn UsbDevice, until_us: u64) -> Vec<Vec<u8>> {
    std::iter::from_fn(|| tablet.report(until_us))
        .map(|report| report.bytes)
        .collect()
}

fn tablet() -> Box<dyn UsbDevice> {
    let mut tablet = ctl_472();
    tablet.listen(0, 0, true);
    tablet.set_feature(0, 0, &[2, 2]).expect("takes it");
    tablet
}

/// Frames recorded from relatives of the same layout, with the state byte each pose makes; distances are theirs.
#[test]
fn state_bytes_are_those_of_the_recorded_frames() {
    let at = |counts| pen_at(counts, MAX);
    let pressed = |counts: u16| f64::from(counts) / f64::from(PRESSURE_MAX);
    let rows: [(Pen, [u8; 8]); 4] = [
        (
            Pen {
                tip: true,
                pressure: pressed(909),
                ..at([14_720, 3054])
            },
            [0x02, 0xE1, 0x80, 0x39, 0xEE, 0x0B, 0x8D, 0x03],
        ),
        (
            Pen {
                tip: true,
                buttons: 1,
                pressure: pressed(935),
                ..at([5863, 4039])
            },
            [0x02, 0xF3, 0xE7, 0x16, 0xC7, 0x0F, 0xA7, 0x03],
        ),
        (
            Pen {
                tip: true,
                buttons: 2,
                pressure: pressed(804),
                ..at([5752, 3918])
            },
            [0x02, 0xF5, 0x78, 0x16, 0x4E, 0x0F, 0x24, 0x03],
        ),
        (
            Pen {
                eraser: true,
                ..at([5573, 2849])
            },
            [0x02, 0xF8, 0xC5, 0x15, 0x21, 0x0B, 0, 0],
        ),
    ];
    for (pen, want) in rows {
        let mut tablet = tablet();
        tablet.touch(0, &Touch::Pen(pen));
        let got = reports(&mut *tablet, 100_000);
        assert_eq!(got.len(), 2, "first without pressure, then all of it");
        assert_eq!(got[0][1], 0xD0);
        assert_eq!(got[1][..8], want, "{pen:?}");
    }
}

#[test]
fn a_pen_comes_and_goes_in_the_recorded_order() {
    let mut tablet = tablet();
    tablet.touch(0, &Touch::Pen(pen_at([0, 3734], MAX)));
    tablet.touch(50_000, &Touch::Away);
    let got = reports(&mut *tablet, 200_000);
    let states: Vec<u8> = got.iter().map(|bytes| bytes[1]).collect();
    assert_eq!(states, [0xD0, 0xE0, 0xD0, 0x80, 0x00]);
    assert_eq!(got[0][..6], [0x02, 0xD0, 0, 0, 0x96, 0x0E]);
    assert!(got[3..].iter().all(|bytes| bytes[2..] == [0; 8]));
}

#[test]
fn it_is_a_mouse_until_it_is_told_and_again_after_its_power_went() {
    let mut tablet = ctl_472();
    tablet.listen(0, 0, true);
    assert_eq!(tablet.feature(0, 0, 2), Ok(vec![2, 0]));
    tablet.touch(0, &Touch::Pen(pen_at([1000, 1000], MAX)));
    tablet.touch(10_000, &Touch::Pen(pen_at([1400, 800], MAX)));
    assert_eq!(reports(&mut *tablet, 20_000), [[1, 0, 0, 0], [1, 0, 10, 0xFB]]);
    tablet.set_feature(20_000, 0, &[2, 2]).expect("takes it");
    assert_eq!(tablet.feature(20_000, 0, 2), Ok(vec![2, 2]));
    assert_eq!(
        reports(&mut *tablet, 40_000)[0][..2],
        [2, 0xD0],
        "the pen is still there"
    );
    tablet.touch(50_000, &Touch::PowerCycle);
    assert_eq!(tablet.arrival(50_000), 0);
    assert_eq!(tablet.arrival(600_000), 2);
    assert_eq!(tablet.feature(600_000, 0, 2), Ok(vec![2, 0]));
    assert_eq!(tablet.set_feature(600_000, 0, &[3, 2]), Err(Stall));
}
