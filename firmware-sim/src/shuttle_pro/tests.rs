use super::*;
use crate::hands::Turn;

fn reports(device: &mut dyn UsbDevice, until_us: u64) -> Vec<Vec<u8>> {
    std::iter::from_fn(|| device.report(until_us))
        .map(|report| report.bytes)
        .collect()
}

#[test]
fn shuttle_jog_and_buttons_have_their_bytes() {
    let mut shuttle = shuttle_pro();
    shuttle.listen(0, 0, true);
    let axis = |to| Touch::Axis {
        control: 0,
        to,
        over_us: 0,
    };
    let click = |clicks| Touch::Dial {
        control: 0,
        by: Turn::Counts(clicks),
        over_us: 0,
    };
    let press = |control, down| Touch::Button { control, down };
    let rows: [(u64, Touch, [u8; 5]); 7] = [
        (0, axis(-1.0), [0xF9, 0xFD, 0, 0, 0]),
        (10_000, axis(0.0), [0, 0xFD, 0, 0, 0]),
        (20_000, click(2), [0, 0xFF, 0, 0, 0]),
        (30_000, click(1), [0, 0, 0, 0, 0]),
        (40_000, press(0, true), [0, 0, 0, 1, 0]),
        (50_000, press(14, true), [0, 0, 0, 1, 0x40]),
        (60_000, press(0, false), [0, 0, 0, 0, 0x40]),
    ];
    for (at_us, touch, want) in rows {
        assert!(shuttle.touch(at_us, &touch), "{touch:?}");
        assert_eq!(reports(&mut *shuttle, at_us), [want], "{touch:?}");
    }
    assert!(!shuttle.touch(0, &press(15, true)));
}

#[test]
fn a_jog_over_many_turns_wraps_without_losing_a_click() {
    let mut shuttle = shuttle_pro();
    shuttle.listen(0, 0, true);
    let turn = Touch::Dial {
        control: 0,
        by: Turn::Turns(-60.0),
        over_us: 5_000_000,
    };
    shuttle.touch(0, &turn);
    let mut last = JOG_AT_POWER;
    let mut sum = 0;
    for bytes in reports(&mut *shuttle, 6_000_000) {
        sum += i32::from(bytes[1].wrapping_sub(last) as i8);
        last = bytes[1];
    }
    assert_eq!(sum, -600);
}
