use super::*;
use crate::input_fault::InputFault;
use crate::usb_device::pad::pen_at;

fn bytes(tablet: &mut dyn UsbDevice, until_us: u64) -> Vec<Vec<u8>> {
    std::iter::from_fn(|| tablet.report(until_us))
        .map(|report| report.bytes)
        .collect()
}

/// Both interfaces listened to; full mode if asked.
fn tablet(full: bool) -> Box<dyn UsbDevice> {
    let mut tablet = hs610();
    tablet.listen(0, 0, true);
    tablet.listen(0, 1, true);
    if full {
        tablet.string(0, 200).expect("answers");
    }
    tablet
}

#[test]
fn the_recorded_pen_frames_come_out_of_the_poses_they_mean() {
    let rows: [(Pen, [u8; 12]); 2] = [
        (
            Pen {
                tilt_deg: [0, -36],
                ..pen_at([18_312, 22_251], MAX)
            },
            [0x08, 0x80, 0x88, 0x47, 0xEB, 0x56, 0, 0, 0, 0, 0, 0xDC],
        ),
        (
            Pen {
                tilt_deg: [-6, 0],
                pressure: 1.0,
                tip: true,
                ..pen_at([20_985, 14_892], MAX)
            },
            [0x08, 0x81, 0xF9, 0x51, 0x2C, 0x3A, 0xFF, 0x1F, 0, 0, 0xFA, 0],
        ),
    ];
    for (pen, want) in rows {
        let mut tablet = tablet(true);
        tablet.touch(0, &Touch::Pen(pen));
        assert_eq!(tablet.report(0).map(|report| report.bytes), Some(want.to_vec()));
    }
}

#[test]
fn keys_and_ring_come_as_recorded_with_stale_bytes_behind_them() {
    let mut tablet = tablet(true);
    let pen = Pen {
        tilt_deg: [-35, 16],
        ..pen_at([100, 100], MAX)
    };
    tablet.touch(0, &Touch::Pen(pen));
    assert!(tablet.report(0).is_some());
    tablet.touch(0, &Touch::Away);
    let key = |control, down| Touch::Button { control, down };
    tablet.touch(4_000, &key(0, true));
    tablet.touch(8_000, &key(0, false));
    tablet.touch(12_000, &key(12, true));
    let got = bytes(&mut *tablet, 12_000);
    assert_eq!(
        got,
        [
            [0x08, 0xE0, 1, 1, 1, 0, 0, 0, 0, 0, 0xDD, 0x10],
            [0x08, 0xE0, 1, 1, 0, 0, 0, 0, 0, 0, 0xDD, 0x10],
            [0x08, 0xE0, 1, 1, 0, 0x10, 0, 0, 0, 0, 0xDD, 0x10],
        ]
    );
    let mut steps = Vec::new();
    for (n, share) in [Some(4.5), Some(3.5), Some(2.5), None].into_iter().enumerate() {
        let at = share.map(|step: f64| step / 12.0);
        tablet.touch(20_000 + 5_000 * n as u64, &Touch::Ring { control: 0, at });
        steps.extend(bytes(&mut *tablet, 20_000 + 5_000 * n as u64));
    }
    let ring: Vec<_> = steps.iter().map(|bytes| (bytes[1], bytes[5])).collect();
    assert_eq!(ring, [(0xF0, 5), (0xF0, 4), (0xF0, 3), (0xF0, 0)]);
}

#[test]
fn the_pen_is_told_of_every_four_milliseconds_and_never_that_it_left() {
    let mut tablet = tablet(true);
    tablet.touch(0, &Touch::Pen(pen_at([1, 2], MAX)));
    assert_eq!(bytes(&mut *tablet, 100_000).len(), 26);
    tablet.touch(101_000, &Touch::Away);
    assert_eq!(bytes(&mut *tablet, 1_000_000), Vec::<Vec<u8>>::new());
}

#[test]
fn before_the_handshake_it_is_a_coarse_pointer_without_keys() {
    let mut tablet = tablet(false);
    let wide = [DEFAULT_MAX; 2];
    let pen = Pen {
        tilt_deg: [60, -25],
        ..pen_at([0x386B, 0x18BD], wide)
    };
    tablet.touch(0, &Touch::Pen(pen));
    let report = tablet.report(0).expect("a report");
    assert_eq!(report.interface, 1);
    assert_eq!(
        report.bytes,
        [0x0A, 0xC0, 0x6B, 0x38, 0xBD, 0x18, 0, 0, 0x3C, 0xE7]
    );
    tablet.touch(
        10_000,
        &Touch::Button {
            control: 0,
            down: true,
        },
    );
    assert_eq!(bytes(&mut *tablet, 100_000), Vec::<Vec<u8>>::new());
    assert_eq!(tablet.reporting_since_us(), None);
    tablet.string(200_000, 200).expect("answers");
    assert_eq!(tablet.reporting_since_us(), Some(200_000));
    assert_eq!(tablet.report(200_000).map(|report| report.bytes[0]), Some(8));
}

#[test]
fn strings_are_as_recorded_and_unknown_ones_are_nonsense_with_a_strings_length() {
    let mut tablet = hs610();
    let name = tablet.string(0, 201).expect("answers");
    assert_eq!((name.len(), &name[..6]), (36, &[36, 3, b'H', 0, b'U', 0][..]));
    assert_eq!(tablet.string(0, 202).expect("answers").len(), 70);
    for index in [3, 100, 101, 110, 121, 122, 123] {
        let memory = tablet.string(0, index).expect("answers all the same");
        assert_eq!(memory.len(), 200);
        assert_eq!(memory[..8], UNSET_MEMORY, "string {index}");
    }
    assert_eq!(tablet.string(0, 200).expect("answers"), PARAMETERS);
    tablet.plug(10, false);
    assert_eq!(tablet.string(10, 200), Err(Stall));
}

#[test]
fn a_frame_of_garbage_comes_between_two_good_ones() {
    let mut tablet = tablet(true);
    tablet.touch(0, &Touch::Pen(pen_at([1, 2], MAX)));
    tablet.inject(2_000, InputFault::Garbage);
    let first: Vec<u8> = bytes(&mut *tablet, 8_000).iter().map(|bytes| bytes[0]).collect();
    assert_eq!(first, [0x08, 0x78, 0x08]);
}
