//! From a sweep to what is to be set, or why it cannot be.
//!
//! Where the count jumps: a DYNAMIXEL of the X series counts on past a turn while its torque is off and takes the
//! count back into one turn, from the encoder's own zero, when torque comes on in position mode or power returns; the
//! homing offset moves all counts and the jump with them, so only the horn can be moved. A Feetech STS counts modulo a
//! turn after its homing offset, so the offset moves the jump along the shaft. Potentiometers (SCS, AX) do not jump;
//! they have an end. Sources: e-manual, "Present Position", "Homing Offset"; LeRobot's calibration of STS.

use super::sweep::Sweep;
use device_profiles::{ServoProfile, ServoProtocol};

/// A travel shorter than this was not a travel, radians: three degrees.
const SHORTEST_RAD: f64 = 0.05;
/// Kept free between the travel and the jump, in turns: three degrees, for a horn's play and the next recalibration.
const MARGIN_TURNS: f64 = 3.0 / 360.0;
/// Kept free between the ends of the travel and the joint's range, radians: one degree, so that it does not push
/// against its end stops.
const STOP_MARGIN_RAD: f64 = 0.018;
/// A travel must leave this much of a turn free, or the hand went around.
const FREE_TURNS_MIN: f64 = 2.0 * MARGIN_TURNS;
/// Largest homing offset of an STS, counts: eleven bits of magnitude (LeRobot's table).
const STS_OFFSET_MAX: i64 = 2047;
/// A limit register this near what is wanted is left alone, counts.
const LIMIT_SLACK_COUNTS: i64 = 2;

/// What the servo says of itself before it is calibrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Bearings {
    /// Its homing offset, where it has one.
    pub homing_offset: Option<i64>,
    /// Its limits, where it has them.
    pub limits: Option<[i64; 2]>,
}

/// What the profile says of the joint, and what is to be taken from the sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wish {
    /// Its sign so far.
    pub sign: i8,
    /// Its range so far, radians.
    pub range_rad: [f64; 2],
    /// The first movement after the zero was the positive one; otherwise the sign stays.
    pub sign_from_first_way: bool,
}

/// What is to be set for one joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The count at angle 0.
    pub zero_counts: i32,
    /// 1 or -1.
    pub sign: i8,
    /// The joint's range: the profile's, narrowed to the travel.
    pub range_rad: [f64; 2],
    /// The whole travel, radians about the zero.
    pub travel_rad: [f64; 2],
    /// To be written, where it must change.
    pub homing_offset: Option<i64>,
    /// To be written, where they must change: smallest and largest goal.
    pub limits: Option<[i64; 2]>,
}

/// Why a joint cannot be calibrated from a sweep.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// Nothing was read.
    #[error("its servo was never read; check the cable")]
    Unread,
    /// It was not moved.
    #[error("it was moved by {moved_deg:.1}° only; move it by hand from end to end")]
    NotMoved {
        /// How far.
        moved_deg: f64,
    },
    /// The hand went around.
    #[error(
        "it was moved by {moved_deg:.0}°, and a servo tells no more than one turn apart: its travel needs end stops, or a \
         narrower sweep"
    )]
    Around {
        /// How far.
        moved_deg: f64,
    },
    /// The jump lies inside the travel, and nothing but the horn can move it.
    #[error(
        "the servo's count jumps inside the travel, {at_deg:.0}° from its zero: take the horn off, turn the servo's shaft \
         by {turn_deg:.0}° {way}, put it on again and repeat"
    )]
    WrapInside {
        /// Where, degrees from the zero that was marked.
        at_deg: f64,
        /// How far the shaft is to be turned under the horn.
        turn_deg: f64,
        /// Which way.
        way: &'static str,
    },
    /// The potentiometer's end lies inside the travel.
    #[error(
        "the travel reaches the {end} end of the servo's range of {range_deg:.0}°: mount the horn anew, {by_deg:.0}° further \
         {way}, and repeat"
    )]
    AtTheEnd {
        /// `lower` or `upper`.
        end: &'static str,
        /// What the servo can tell apart.
        range_deg: f64,
        /// How far to move the horn at least.
        by_deg: f64,
        /// Which way.
        way: &'static str,
    },
    /// Nothing of the profile's range is left.
    #[error(
        "its travel of {from_deg:.0}° to {to_deg:.0}° and its range in the profile, {min_deg:.0}° to {max_deg:.0}°, do not \
         meet: put it at its zero before the sweep, and move it the positive way first"
    )]
    RangeElsewhere {
        /// Lower end of the travel.
        from_deg: f64,
        /// Upper end of the travel.
        to_deg: f64,
        /// The profile's lower end.
        min_deg: f64,
        /// The profile's upper end.
        max_deg: f64,
    },
}

/// What is to be set after this sweep.
pub fn plan(model: &ServoProfile, bearings: Bearings, wish: Wish, sweep: &Sweep) -> Result<Plan, Refusal> {
    let rad_per_count = model.rad_per_count();
    let moved_deg = (sweep.span_counts() * rad_per_count).to_degrees();
    if sweep.samples() == 0 {
        return Err(Refusal::Unread);
    }
    if sweep.span_counts() * rad_per_count < SHORTEST_RAD {
        return Err(Refusal::NotMoved { moved_deg });
    }
    let sign = match sweep.first_way() {
        Some(way) if wish.sign_from_first_way => way,
        _ => f64::from(wish.sign),
    };
    let turned = seat(model, bearings, sweep)?;
    let [low, zero, high] = turned.places;
    let at = |counts: f64| sign * (counts - zero) * rad_per_count;
    let mut travel_rad = [at(low), at(high)];
    travel_rad.sort_by(f64::total_cmp);
    let range_rad = [
        wish.range_rad[0].max(travel_rad[0] + STOP_MARGIN_RAD),
        wish.range_rad[1].min(travel_rad[1] - STOP_MARGIN_RAD),
    ];
    if range_rad[1] - range_rad[0] < SHORTEST_RAD {
        return Err(Refusal::RangeElsewhere {
            from_deg: travel_rad[0].to_degrees(),
            to_deg: travel_rad[1].to_degrees(),
            min_deg: wish.range_rad[0].to_degrees(),
            max_deg: wish.range_rad[1].to_degrees(),
        });
    }
    Ok(Plan {
        zero_counts: zero.round() as i32,
        sign: if sign < 0.0 { -1 } else { 1 },
        range_rad,
        travel_rad,
        homing_offset: turned.homing_offset,
        limits: limits(
            model,
            bearings,
            range_rad.map(|rad| zero + sign * rad / rad_per_count),
        ),
    })
}

/// A travel in the counts that the servo will have.
struct Seated {
    /// Lowest, zero, highest.
    places: [f64; 3],
    homing_offset: Option<i64>,
}

fn seat(model: &ServoProfile, bearings: Bearings, sweep: &Sweep) -> Result<Seated, Refusal> {
    let [first, last] = model.position_counts.map(|count| count as f64);
    let turn = model.counts_per_turn;
    let is_whole_turn = last - first + 1.0 >= turn - 1.0;
    let places = sweep.places_counts();
    if !is_whole_turn {
        return at_an_end(model, places);
    }
    if sweep.span_counts() > turn * (1.0 - FREE_TURNS_MIN) {
        let moved_deg = (sweep.span_counts() * model.rad_per_count()).to_degrees();
        return Err(Refusal::Around { moved_deg });
    }
    match model.protocol {
        ServoProtocol::Sts => Ok(by_offset(model, bearings, places)),
        _ => by_horn(model, bearings, places),
    }
}

/// Potentiometers: the count stands still beyond its ends, so a travel that touches one has lost its own end there.
fn at_an_end(model: &ServoProfile, places: [f64; 3]) -> Result<Seated, Refusal> {
    let [first, last] = model.position_counts.map(|count| count as f64);
    let margin = 1.0;
    let to_deg = |counts: f64| (counts * model.rad_per_count()).to_degrees();
    let range_deg = to_deg(last - first);
    // How far the horn must come back is not to be seen; a tenth of the range shows the rest.
    let by_deg = range_deg / 10.0;
    if places[0] <= first + margin {
        return Err(Refusal::AtTheEnd {
            end: "lower",
            range_deg,
            by_deg,
            way: "back",
        });
    }
    if places[2] >= last - margin {
        return Err(Refusal::AtTheEnd {
            end: "upper",
            range_deg,
            by_deg,
            way: "on",
        });
    }
    Ok(Seated {
        places,
        homing_offset: None,
    })
}

/// Feetech STS: the offset goes where the travel lies in the middle of the turn. It stays when the travel keeps its
/// distance from the jump already: EEPROM wears.
fn by_offset(model: &ServoProfile, bearings: Bearings, places: [f64; 3]) -> Seated {
    let turn = model.counts_per_turn;
    let [first, last] = model.position_counts.map(|count| count as f64);
    let margin = MARGIN_TURNS * turn;
    let into_turn = |by: f64| places.map(|place| place + by);
    // The sweep may have been unwound into a neighbouring turn.
    let stays = into_turn(-(places[0] / turn).floor() * turn);
    if stays[0] >= first + margin && stays[2] <= last - margin {
        return Seated {
            places: stays,
            homing_offset: None,
        };
    }
    let before = bearings.homing_offset.unwrap_or(0);
    let middle = f64::midpoint(places[0], places[2]);
    // Present = actual - offset: more offset moves the travel down.
    let down = (middle - f64::from(model.centre_counts)).round();
    let wanted = before as f64 + down;
    let turns = (wanted / turn).round();
    let offset = ((wanted - turns * turn) as i64).clamp(-STS_OFFSET_MAX, STS_OFFSET_MAX);
    let moved = (offset - before) as f64;
    let seated = into_turn(-moved);
    let back = -((f64::midpoint(seated[0], seated[2]) / turn).floor() * turn);
    Seated {
        places: seated.map(|place| place + back),
        homing_offset: (offset != before).then_some(offset),
    }
}

/// DYNAMIXEL: the travel must lie inside the turn that begins at the homing offset.
fn by_horn(model: &ServoProfile, bearings: Bearings, places: [f64; 3]) -> Result<Seated, Refusal> {
    let turn = model.counts_per_turn;
    let begins = model.position_counts[0] as f64 + bearings.homing_offset.unwrap_or(0) as f64;
    // While torque is off the count runs on over turns; it comes back into this one.
    let turns = ((places[0] - begins) / turn).floor();
    let here = places.map(|place| place - turns * turn);
    let ends = begins + turn - 1.0;
    if here[2] <= ends {
        return Ok(Seated {
            places: here,
            homing_offset: None,
        });
    }
    let to_deg = |counts: f64| (counts * model.rad_per_count()).to_degrees();
    let off_centre = f64::midpoint(here[0], here[2]) - (begins + turn / 2.0);
    // The shorter way round.
    let turn_deg = to_deg(off_centre - (off_centre / turn).round() * turn);
    Err(Refusal::WrapInside {
        at_deg: to_deg(ends - here[1]),
        turn_deg: turn_deg.abs(),
        way: if turn_deg > 0.0 {
            "towards lower counts"
        } else {
            "towards higher counts"
        },
    })
}

/// Limits that hold the range, if those of the servo do not.
fn limits(model: &ServoProfile, bearings: Bearings, ends: [f64; 2]) -> Option<[i64; 2]> {
    let before = bearings.limits?;
    let [first, last] = model.position_counts;
    let mut wanted = ends.map(|counts| (counts.round() as i64).clamp(first, last));
    wanted.sort_unstable();
    let near = (0..2).all(|end| (wanted[end] - before[end]).abs() <= LIMIT_SLACK_COUNTS);
    (!near).then_some(wanted)
}
