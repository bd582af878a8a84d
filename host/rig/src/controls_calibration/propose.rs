//! What comes of what was measured: an area from corners, a curve from three pressures, a rest from where it rested.

use super::measure::Resting;
use super::tablet::Sheet;
use super::{Area, AxisCalibration, PressureCurve, TabletMapping};

/// The area between two corners, in whichever order they were touched.
pub(super) fn area(touched_mm: &[[f64; 2]], sheet: &Sheet) -> Result<Area, String> {
    let [a, b] = touched_mm else {
        return Err("touch both corners".into());
    };
    let area = Area {
        corner_mm: [a[0].min(b[0]), a[1].min(b[1])],
        size_mm: [(a[0] - b[0]).abs(), (a[1] - b[1]).abs()],
    };
    let mapping = TabletMapping {
        area: Some(area),
        ..TabletMapping::default()
    };
    match mapping.fault(sheet) {
        Some(fault) => Err(fault),
        None => Ok(area),
    }
}

/// The curve of a pen that hovered, touched lightly and pressed hard. The tip is down half-way from hovering to a
/// light touch, and up a quarter of the way.
pub(super) fn curve([hovering, lightly, hard]: [u32; 3], max: u32) -> Result<PressureCurve, String> {
    /// Above what a hovering pen presses, the least share at which a tip may go down.
    const ABOVE_HOVERING: f64 = 0.002;
    let share = |counts: u32| f64::from(counts) / f64::from(max.max(1));
    let (nothing, light) = (share(hovering), share(lightly));
    let tip_down = (nothing + (light - nothing) * 0.5).max(nothing + ABOVE_HOVERING);
    let curve = PressureCurve {
        nothing,
        full: share(hard).min(1.0),
        tip_down,
        tip_up: nothing + (tip_down - nothing) * 0.5,
        gamma: 1.0,
    };
    match curve.fault() {
        Some(fault) => Err(fault),
        None => Ok(curve),
    }
}

/// Ends as they hold, with the rest that was measured between them.
pub(super) fn rest(resting: &Resting, holds: AxisCalibration) -> Result<AxisCalibration, String> {
    let (rest, dead_counts) = resting.rest()?;
    let reach = |end: i32| (f64::from(end) - f64::from(rest)).abs();
    let [from, to] = holds.ends;
    if !is_between(rest, holds.ends) || reach(from).min(reach(to)) <= f64::from(dead_counts) {
        return Err(format!(
            "it rests at {rest}, give or take {dead_counts}, which is no middle between its ends {from} and {to}; \
             let go of it each time, or measure its ends first"
        ));
    }
    Ok(AxisCalibration {
        rest: Some(rest),
        dead_counts,
        ..holds
    })
}

/// New ends, and the rest of before where it lies between them. The ends are a little inside of what was seen, by what
/// the device does not tell for noise, so that they are reached the next time too.
pub(super) fn ends([from, to]: [i32; 2], noise_counts: i32, holds: AxisCalibration) -> AxisCalibration {
    /// The travel in so many parts: one of them at least, where counts are as fine as that.
    const PARTS: i32 = 200;
    let travel = to.saturating_sub(from);
    let inside = (travel.saturating_abs() / PARTS).max(noise_counts) * travel.signum();
    let ends = [from.saturating_add(inside), to.saturating_sub(inside)];
    let rest = holds.rest.filter(|&rest| is_between(rest, ends));
    AxisCalibration {
        ends,
        rest,
        dead_counts: rest.map_or(0, |_| holds.dead_counts),
    }
}

fn is_between(rest: i32, ends: [i32; 2]) -> bool {
    let [from, to] = ends.map(f64::from);
    (f64::from(rest) - from) * (to - f64::from(rest)) > 0.0
}
