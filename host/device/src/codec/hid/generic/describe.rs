//! What a descriptor says about the device, in the words of profiles: its surface and its controls.

use super::controls::{Numbers, axis_name};
use super::usage;
use crate::codec::Surface;
use crate::codec::hid::descriptor::{Described, Descriptor, Direction, UnitKind};
use crate::codec::hid::plan::Plan;
use device_profiles::{Control, ControlKind, Emits, InputKind, InputProfile};

/// Millimetres in an inch.
const MM_PER_INCH: f64 = 25.4;
/// Counts in an inch where the descriptor has no length: both axes alike, so that nothing is stretched.
const COUNTS_PER_INCH_UNKNOWN: f64 = 1_000.0;
/// Tilt without a unit is in degrees, as the usage tables define it.
const DEGREES_PER_RAD: f64 = 180.0 / std::f64::consts::PI;

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
    let angle = |field: &Described| {
        let per_rad = field
            .counts_per_unit()
            .filter(|_| field.unit.kind() == UnitKind::Angle);
        per_rad.unwrap_or(DEGREES_PER_RAD)
    };
    Some(Surface {
        tilt_steps_per_rad: find(usage::TILT_X).map(angle),
        twist_steps_per_turn: find(usage::TWIST).map(|f| angle(f) * std::f64::consts::TAU),
        ..Surface::flat(
            [span(x), span(y)],
            counts_per_inch,
            find(usage::PRESSURE).map_or(0, span),
        )
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
