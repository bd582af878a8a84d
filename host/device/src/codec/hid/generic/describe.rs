//! What a descriptor says about the device, in the words of profiles: its surface and its controls.

use super::controls::{Numbers, axis_name};
use super::usage::{self, Place};
use crate::codec::Surface;
use crate::codec::hid::descriptor::{Described, Descriptor, Direction, UnitKind};
use crate::codec::hid::plan::Plan;
use device_profiles::{Control, ControlKind, Emits, InputKind, InputProfile};
use std::f64::consts::{PI, TAU};

/// Millimetres in an inch.
const MM_PER_INCH: f64 = 25.4;
/// Counts in an inch where the descriptor has no length: both axes alike, so that nothing is stretched.
const COUNTS_PER_INCH_UNKNOWN: f64 = 1_000.0;
/// Tilt without a unit is in degrees, as the usage tables define it.
const DEGREES_PER_RAD: f64 = 180.0 / PI;

/// The active area of the first report that is about a tool.
pub(super) fn surface(descriptor: &Descriptor, plan: &Plan) -> Option<Surface> {
    let report = plan.reports.iter().find(|r| r.emits == Emits::Tool)?;
    let find = |wanted| {
        descriptor.fields.iter().find(|f| {
            f.direction == Direction::Input
                && f.report == report.id.unwrap_or(0)
                && usage::standard(f.usage()) == wanted
        })
    };
    // What one report leaves out another may have, as of a puck and a pen.
    let of_tools = |wanted| {
        let is_tools = |f: &&Described| {
            let place = usage::place(&super::field_collections(descriptor, f));
            f.direction == Direction::Input && matches!(place, Place::Pen | Place::Puck)
        };
        let mut fields = descriptor.fields.iter().filter(is_tools);
        find(wanted).or_else(|| fields.find(|f| usage::standard(f.usage()) == wanted))
    };
    let span = |field: &Described| {
        let [low, high] = field.logical;
        u32::try_from(high - low).unwrap_or(u32::MAX)
    };
    let (x, y) = (find(usage::X)?, find(usage::Y)?);
    let per_inch = |field: &Described| {
        let per_mm = field
            .counts_per_unit()
            .filter(|_| field.unit.kind() == UnitKind::Length);
        per_mm.map(|per_mm| per_mm * MM_PER_INCH)
    };
    let counts_per_inch = match (per_inch(x), per_inch(y)) {
        (Some(x), Some(y)) => [x, y],
        _ => [COUNTS_PER_INCH_UNKNOWN; 2],
    };
    Some(Surface {
        tilt_steps_per_rad: of_tools(usage::TILT_X).map(tilt_steps_per_rad),
        twist_steps_per_turn: of_tools(usage::TWIST).map(twist_steps_per_turn),
        ..Surface::flat(
            [span(x), span(y)],
            counts_per_inch,
            of_tools(usage::PRESSURE).map_or(0, span),
        )
    })
}

/// Counts of a radian, where the unit is an angle and gives the field as much of a circle as is meant: units of
/// lengths, or their powers of ten, are often left standing from the fields before.
fn by_unit(field: &Described, likely_rad: [f64; 2]) -> Option<f64> {
    let per_rad = field
        .counts_per_unit()
        .filter(|_| field.unit.kind() == UnitKind::Angle)?;
    let [low, high] = field.logical;
    let range_rad = (high as f64 - low as f64) / per_rad;
    (likely_rad[0]..=likely_rad[1])
        .contains(&range_rad)
        .then_some(per_rad)
}

/// Tilt goes from 15 degrees to a straight angle either way. Without a unit it is in degrees, as the usage tables
/// have it; more of these than there are is the whole of a half circle.
fn tilt_steps_per_rad(field: &Described) -> f64 {
    let [low, high] = field.logical;
    let range = (high - low) as f64;
    by_unit(field, [PI / 6.0, 2.0 * PI]).unwrap_or(if range > 360.0 {
        range / PI
    } else {
        DEGREES_PER_RAD
    })
}

/// Twist goes once round or nearly so. Without a unit it is in degrees; more of these than there are is a turn.
fn twist_steps_per_turn(field: &Described) -> f64 {
    let [low, high] = field.logical;
    let range = (high - low) as f64;
    let per_rad = by_unit(field, [PI, 2.0 * TAU]);
    per_rad.map_or(if range > 360.0 { range + 1.0 } else { 360.0 }, |per_rad| {
        per_rad * TAU
    })
}

/// The profile nobody had to write.
pub(super) fn profile(descriptor: &Descriptor, surface: Option<Surface>, numbers: &Numbers) -> InputProfile {
    let kind = match descriptor.fields.first().and_then(|f| descriptor.application(f)) {
        _ if surface.is_some() => InputKind::Tablet,
        Some(usage::MULTI_AXIS) => InputKind::SixAxis,
        _ if numbers.axes.is_empty() && numbers.dials.is_empty() => InputKind::Pad,
        _ => InputKind::Knobs,
    };
    InputProfile {
        surface: surface.map(in_profile),
        controls: controls(numbers),
        ..InputProfile::bare("HID device", kind, "hid", "the device's report descriptor")
    }
}

fn in_profile(surface: Surface) -> device_profiles::Surface {
    let mm = |axis: usize| f64::from(surface.max_counts[axis]) / surface.counts_per_inch[axis] * MM_PER_INCH;
    device_profiles::Surface {
        counts: surface.max_counts,
        size_mm: Some([mm(0), mm(1)]),
        pressure: surface.pressure_max,
        tilt_steps_per_rad: surface.tilt_steps_per_rad,
        twist_steps_per_turn: surface.twist_steps_per_turn.map(|steps| steps.round() as u32),
        ..device_profiles::Surface::default()
    }
}

fn controls(numbers: &Numbers) -> Vec<Control> {
    let narrow = |range: [i64; 2]| range.map(|n| n.clamp(i32::MIN.into(), i32::MAX.into()) as i32);
    let mut all: Vec<Control> = Vec::new();
    for &(usage, range) in &numbers.axes {
        let (kind, name) = axis_name(usage);
        all.push(Control {
            range: Some(narrow(range)),
            ..Control::bare(kind, name)
        });
    }
    for &counts_per_turn in &numbers.dials {
        all.push(Control {
            counts_per_turn,
            ..Control::bare(ControlKind::Dial, "dial")
        });
    }
    for &range in &numbers.rings {
        all.push(Control {
            range: Some(narrow(range)),
            ..Control::bare(ControlKind::Ring, "ring")
        });
    }
    if numbers.buttons > 0 {
        all.push(Control {
            count: numbers.buttons as u16,
            ..Control::bare(ControlKind::Button, "button")
        });
    }
    all
}
