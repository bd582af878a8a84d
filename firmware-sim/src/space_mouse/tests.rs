use super::*;

fn push(device: &mut dyn UsbDevice, at_us: u64, control: u8, counts: i32) {
    let to = f64::from(counts) / f64::from(TRAVEL_COUNTS);
    assert!(device.touch(
        at_us,
        &Touch::Axis {
            control,
            to,
            over_us: 0
        }
    ));
}

fn reports(device: &mut dyn UsbDevice, until_us: u64) -> Vec<Vec<u8>> {
    std::iter::from_fn(|| device.report(until_us))
        .map(|report| report.bytes)
        .collect()
}

#[test]
fn the_documented_frames_come_out_of_the_movements_they_mean() {
    let mut cap = space_navigator();
    cap.listen(0, 0, true);
    // Turned −30 about the second axis: `02 00 00 E2 FF 00 00` (VRPN, rolfmorel/spacemouse).
    push(&mut *cap, 0, 4, -30);
    let got = reports(&mut *cap, 16_000);
    assert_eq!(
        got,
        [
            vec![1, 0, 0, 0, 0, 0, 0],
            vec![2, 0, 0, 0xE2, 0xFF, 0, 0],
            vec![1, 0, 0, 0, 0, 0, 0]
        ]
    );
    push(&mut *cap, 20_000, 4, 0);
    assert_eq!(
        reports(&mut *cap, 1_000_000),
        [[2, 0, 0, 0, 0, 0, 0]],
        "back at rest, then nothing"
    );
    for (control, down) in [(0, true), (1, true), (0, false), (1, false)] {
        cap.touch(2_000_000, &Touch::Button { control, down });
    }
    let got = reports(&mut *cap, 3_000_000);
    assert_eq!(got, [[3, 1, 0], [3, 3, 0], [3, 2, 0], [3, 0, 0]]);
    assert!(!cap.touch(
        0,
        &Touch::Button {
            control: 2,
            down: true
        }
    ));
}

#[test]
fn halves_alternate_every_eight_milliseconds_while_it_is_pushed() {
    let mut cap = space_navigator();
    cap.listen(0, 0, true);
    push(&mut *cap, 0, 0, 350);
    let got = reports(&mut *cap, 800_000);
    assert_eq!(got.len(), 101);
    for (n, bytes) in got.iter().enumerate() {
        assert_eq!(usize::from(bytes[0]), n % 2 + 1);
    }
    assert_eq!(got[0], [1, 0x5E, 1, 0, 0, 0, 0]);
}

#[test]
fn the_lamp_is_output_four() {
    let mut cap = space_navigator();
    cap.output(1, 0, &[4, 1]).expect("on");
    cap.output(2, 0, &[4, 0]).expect("off");
    assert_eq!(cap.output(3, 0, &[5, 1]), Err(Stall));
    assert_eq!(
        cap.drain_shown(),
        [(1, Shown::Lamp(true)), (2, Shown::Lamp(false))]
    );
}
