//! Sweeps with known travels, on each family.

use super::*;
use device_profiles::{Profiles, ServoProfile};

const TURN: i64 = 4096;

fn model(name: &str) -> ServoProfile {
    Profiles::builtin().servo(name).unwrap().clone()
}

/// From `zero` to `first` and then to `second`, in the counts of the shaft, read as `read` has it.
fn swept(model: &ServoProfile, places: [i64; 3], read: impl Fn(i64) -> i64) -> Sweep {
    let mut sweep = Sweep::new(model.counts_per_turn);
    let [zero, first, second] = places;
    sweep.add(read(zero));
    sweep.mark_zero();
    let mut go = |from: i64, to: i64| {
        let steps = 40;
        for step in 0..=steps {
            sweep.add(read(from + (to - from) * step / steps));
        }
    };
    go(zero, first);
    go(first, second);
    go(second, zero);
    sweep
}

fn wish() -> Wish {
    Wish {
        sign: 1,
        range_rad: [-3.0, 3.0],
        sign_from_first_way: true,
    }
}

#[test]
fn a_dynamixel_inside_its_turn_gets_zero_sign_range_and_limits() {
    let model = model("XL330-M288");
    let sweep = swept(&model, [2000, 3000, 900], |counts| counts);
    let bearings = Bearings {
        homing_offset: Some(0),
        limits: Some([0, 4095]),
    };
    let plan = plan(&model, bearings, wish(), &sweep).unwrap();
    assert_eq!((plan.zero_counts, plan.sign, plan.homing_offset), (2000, 1, None));
    let deg = plan.range_rad.map(f64::to_degrees);
    assert!(
        (deg[0] + 95.6).abs() < 0.2 && (deg[1] - 86.9).abs() < 0.2,
        "{deg:?}"
    );
    let limits = plan.limits.unwrap();
    assert!(
        (911..914).contains(&limits[0]) && (2987..2990).contains(&limits[1]),
        "{limits:?}"
    );
    // Again with what was written: nothing more to write.
    let bearings = Bearings {
        homing_offset: Some(0),
        limits: Some(limits),
    };
    assert_eq!(
        super::plan(&model, bearings, wish(), &sweep).unwrap().limits,
        None
    );
}

#[test]
fn the_way_first_gone_is_positive() {
    let model = model("XL330-M288");
    let sweep = swept(&model, [2000, 1000, 2500], |counts| counts);
    let plan = |sign_from_first_way| {
        let wish = Wish {
            sign_from_first_way,
            ..wish()
        };
        super::plan(&model, Bearings::default(), wish, &sweep).unwrap()
    };
    assert_eq!(plan(true).sign, -1);
    assert!(plan(true).travel_rad[1] > 1.5, "{:?}", plan(true));
    assert_eq!(plan(false).sign, 1);
}

/// A DYNAMIXEL counts on while its torque is off: the jump inside the travel is refused, with the way out.
#[test]
fn a_wrap_inside_the_travel_of_a_dynamixel_is_refused() {
    let model = model("XL330-M288");
    for (places, offset, turn_deg) in [
        ([100, 900, -700], 0, 171.0),
        ([4000, 4700, 3300], 0, 171.0),
        // The offset moves count and jump alike.
        ([500, 900, 250], 400, 166.0),
    ] {
        let sweep = swept(&model, places, |counts| counts);
        let bearings = Bearings {
            homing_offset: Some(offset),
            limits: None,
        };
        let refused = plan(&model, bearings, wish(), &sweep).unwrap_err();
        let Refusal::WrapInside { turn_deg: found, .. } = refused else {
            panic!("{refused:?}")
        };
        assert!((found - turn_deg).abs() < 12.0, "{refused:?}");
    }
    // A whole turn further on is the same place, once torque is on.
    let sweep = swept(&model, [2000 + TURN, 3000 + TURN, 900 + TURN], |counts| counts);
    assert_eq!(
        plan(&model, Bearings::default(), wish(), &sweep)
            .unwrap()
            .zero_counts,
        2000
    );
}

/// An STS counts modulo a turn: the offset takes the jump out of the travel.
#[test]
fn an_sts_is_homed_where_its_travel_meets_the_jump() {
    let model = model("STS3215");
    for (places, before) in [
        ([100, 900, -700], 0_i64),
        ([4000, 4700, 3300], 0),
        ([3000, 3500, 2000], 1900),
    ] {
        let read = |offset: i64| move |counts: i64| (counts - offset).rem_euclid(TURN);
        let sweep = swept(&model, places, read(before));
        let bearings = Bearings {
            homing_offset: Some(before),
            limits: Some([0, 4095]),
        };
        let plan = plan(&model, bearings, wish(), &sweep).unwrap();
        let offset = plan.homing_offset.unwrap_or(before);
        assert!(offset.abs() <= 2047, "{plan:?}");
        // What the servo will read over the same travel: no jump, and the zero where the plan has it.
        let after = swept(&model, places, read(offset));
        assert_eq!(after.jumps(), 0, "{plan:?}");
        assert_eq!(read(offset)(places[0]), i64::from(plan.zero_counts), "{plan:?}");
        let [low, high] = [places[1].min(places[2]), places[1].max(places[2])].map(read(offset));
        assert!(low > 30 && high < 4066 && low < high, "{low} {high} {plan:?}");
    }
}

#[test]
fn an_sts_that_keeps_its_distance_is_left_alone() {
    let model = model("STS3215");
    let sweep = swept(&model, [1000, 2000, 500], |counts| counts);
    let bearings = Bearings {
        homing_offset: Some(12),
        limits: None,
    };
    let plan = plan(&model, bearings, wish(), &sweep).unwrap();
    assert_eq!((plan.homing_offset, plan.zero_counts), (None, 1000));
}

#[test]
fn what_was_no_sweep_is_refused() {
    let xl = model("XL330-M288");
    let still = swept(&xl, [2000, 2010, 1995], |counts| counts);
    let refused = plan(&xl, Bearings::default(), wish(), &still).unwrap_err();
    assert!(matches!(refused, Refusal::NotMoved { .. }), "{refused}");
    let around = swept(&xl, [2000, 4060, -30], |counts| counts);
    let refused = plan(&xl, Bearings::default(), wish(), &around).unwrap_err();
    assert!(matches!(refused, Refusal::Around { .. }), "{refused}");
    let unread = Sweep::new(4096.0);
    assert_eq!(
        plan(&xl, Bearings::default(), wish(), &unread),
        Err(Refusal::Unread)
    );
    // A potentiometer that was pushed to its end says no more there.
    let scs = model("SCS0009");
    let last = scs.position_counts[1];
    let at_end = swept(&scs, [last - 100, last + 300, last - 500], |counts| {
        counts.min(last)
    });
    let refused = plan(&scs, Bearings::default(), wish(), &at_end).unwrap_err();
    assert!(
        matches!(refused, Refusal::AtTheEnd { end: "upper", .. }),
        "{refused}"
    );
    let narrow = Wish {
        range_rad: [2.5, 3.0],
        ..wish()
    };
    let sweep = swept(&xl, [2000, 3000, 900], |counts| counts);
    let refused = plan(&xl, Bearings::default(), narrow, &sweep).unwrap_err();
    assert!(matches!(refused, Refusal::RangeElsewhere { .. }), "{refused}");
}
