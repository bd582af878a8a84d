//! A tablet with a mapping: the area, its corners, the pressure that was measured, and no step when it is exchanged.

use super::*;
use crate::controls_calibration::Area;

/// 100 by 50 mm.
const SURFACE: Surface = Surface::flat([10_000, 5_000], [2540.0, 2540.0], 1000);

fn sample(x_counts: u32, y_counts: u32, pressure_counts: u32) -> PenSample {
    PenSample {
        pressure_counts,
        tip: pressure_counts > 0,
        ..PenSample::hovering(Tool::Pen, x_counts, y_counts)
    }
}

fn heard(tablet: &mut Tablet, sample: PenSample) -> Vec<String> {
    let mut said = Vec::new();
    tablet.hear(&sample, SURFACE, &mut |output, value| {
        said.push(format!("{output} {value:?}"));
    });
    said
}

fn calibrated(tablet: &mut Tablet, mapping: Option<&TabletMapping>) -> Vec<String> {
    let mut said = Vec::new();
    tablet.calibrate(mapping, &mut |output, value| {
        said.push(format!("{output} {value:?}"));
    });
    said
}

/// The middle 40 by 40 mm.
fn middle() -> TabletMapping {
    TabletMapping {
        area: Some(Area {
            corner_mm: [30.0, 5.0],
            size_mm: [40.0, 40.0],
        }),
        ..TabletMapping::default()
    }
}

#[test]
fn corners_of_the_area_are_the_corners_of_the_square_and_beyond_it_is_out_of_reach() {
    let mut tablet = Tablet::default();
    calibrated(&mut tablet, Some(&middle()));
    assert!(heard(&mut tablet, sample(3000, 500, 0)).contains(&"1 Vector2(DVec2(-1.0, 1.0))".to_owned()));
    assert!(heard(&mut tablet, sample(7000, 4500, 0)).contains(&"1 Vector2(DVec2(1.0, -1.0))".to_owned()));
    assert_eq!(heard(&mut tablet, sample(2000, 500, 0)), ["5 Boolean(false)"]);
    assert_eq!(
        heard(&mut tablet, sample(1000, 500, 500)),
        Vec::<String>::new(),
        "no press out there"
    );
    assert_eq!(heard(&mut tablet, sample(5000, 2500, 0))[0], "5 Boolean(true)");
}

#[test]
fn the_tip_and_the_pressure_are_those_of_the_curve() {
    let mapping = TabletMapping {
        pressure: PressureCurve {
            nothing: 0.1,
            full: 0.6,
            gamma: 1.0,
            tip_down: 0.2,
            tip_up: 0.15,
        },
        ..TabletMapping::default()
    };
    let mut tablet = Tablet::default();
    calibrated(&mut tablet, Some(&mapping));
    // A worn pen: the tablet itself says that the tip is down all the time.
    let tip = |tablet: &mut Tablet, pressure| {
        let said = heard(tablet, sample(5000, 2500, pressure));
        (
            said.contains(&"2 Boolean(true)".to_owned()),
            said.contains(&"2 Boolean(false)".to_owned()),
        )
    };
    assert_eq!(tip(&mut tablet, 90), (false, false));
    assert_eq!(tip(&mut tablet, 190), (false, false));
    assert_eq!(tip(&mut tablet, 200), (true, false));
    assert_eq!(tip(&mut tablet, 160), (false, false));
    assert_eq!(tip(&mut tablet, 150), (false, true));
    heard(&mut tablet, sample(5000, 2500, 350));
    assert!((tablet.pressure - 0.5).abs() < 1e-12);
}

#[test]
fn a_mapping_exchanged_under_a_tool_counts_from_when_it_was_lifted() {
    let mut tablet = Tablet::default();
    heard(&mut tablet, sample(5000, 2500, 600));
    let said = calibrated(&mut tablet, Some(&middle()));
    assert!(
        said.contains(&"5 Boolean(false)".to_owned()) && said.contains(&"2 Boolean(false)".to_owned()),
        "{said:?}"
    );
    assert!(
        said.contains(&"7 Real(0.0)".to_owned()) && !said.iter().any(|it| it.starts_with("1 ")),
        "{said:?}"
    );
    assert!(heard(&mut tablet, sample(6000, 2500, 600)).is_empty());
    assert!(heard(&mut tablet, sample(6000, 2500, 0).leaving()).is_empty());
    assert_eq!(heard(&mut tablet, sample(6000, 2500, 0))[0], "5 Boolean(true)");
}

#[test]
fn a_tablet_that_was_unplugged_under_a_tool_does_not_wait_for_it() {
    let mut tablet = Tablet::default();
    heard(&mut tablet, sample(5000, 2500, 0));
    calibrated(&mut tablet, Some(&middle()));
    assert!(heard(&mut tablet, sample(5000, 2500, 0)).is_empty());
    tablet.gone();
    assert_eq!(heard(&mut tablet, sample(5000, 2500, 0))[0], "5 Boolean(true)");
}

#[test]
fn while_it_is_calibrated_nothing_passes_and_after_it_the_tool_is_lifted_first() {
    let mut tablet = Tablet::default();
    heard(&mut tablet, sample(5000, 2500, 0));
    let mut said = Vec::new();
    tablet.mute(true, &mut |output, value| {
        said.push(format!("{output} {value:?}"));
    });
    assert_eq!(said, ["5 Boolean(false)"]);
    for pressure in [0, 900, 0] {
        assert!(heard(&mut tablet, sample(100, 100, pressure)).is_empty());
    }
    assert!(heard(&mut tablet, sample(100, 100, 0).leaving()).is_empty());
    assert!(heard(&mut tablet, sample(100, 100, 0)).is_empty());
    tablet.mute(false, &mut |output, value| panic!("{output} {value:?}"));
    assert!(heard(&mut tablet, sample(200, 100, 0)).is_empty());
    heard(&mut tablet, sample(200, 100, 0).leaving());
    assert!(!heard(&mut tablet, sample(200, 100, 0)).is_empty());
}
