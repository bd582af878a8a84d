//! A profile's report tables, compiled. What the words mean is told in `device_profiles::Report` and `Field`.

use super::bits::{Bits, Piece};
use super::plan::{Group, Plan, PlannedField, PlannedReport, Sign};
use crate::codec::Tool;
use device_profiles::{ByteMatch, ByteOrder, ControlClass, Field, FieldName, InputProfile, Report};

/// A pressure above this is a tip where the report has no bit for it: of the Intuos's 1024 steps, as Linux's
/// `wacom_intuos_general` has it.
const TIP_FROM_COUNTS: u32 = 10;
/// The longest report, for those that set no limit.
const ANY_LENGTH: usize = usize::MAX;

/// A profile whose tables cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlanError {
    /// Its layout is not there.
    #[error("profile \"{profile}\": its layout \"{layout}\" is not among the profiles it was taken from")]
    Layout {
        /// The profile's key.
        profile: String,
        /// The layout's.
        layout: String,
    },
    /// No tables at all.
    #[error("profile \"{profile}\": expected a layout or [[report]] tables, found neither")]
    NoReports {
        /// The profile's key.
        profile: String,
    },
    /// A number that cannot be collected.
    #[error("profile \"{profile}\": field {field} has no bits, more than 64, or more than 6 pieces")]
    Field {
        /// The profile's key.
        profile: String,
        /// The field's name.
        field: String,
    },
}

/// What the profile's tables come to.
pub(super) fn compile(profile: &InputProfile) -> Result<Plan, PlanError> {
    let tables = profile.tables();
    if let Some(layout) = profile.layout.as_ref().filter(|_| tables.reports.is_empty()) {
        return Err(PlanError::Layout {
            profile: profile.key.clone(),
            layout: layout.clone(),
        });
    }
    if tables.reports.is_empty() {
        return Err(PlanError::NoReports {
            profile: profile.key.clone(),
        });
    }
    let mut plan = Plan {
        skip_bytes: tables.skip_bytes.into(),
        buttons: profile.count(ControlClass::Button),
        axes: profile.count(ControlClass::Axis),
        rings: profile.count(ControlClass::Ring),
        dials: profile.count(ControlClass::Dial),
        tip_from_counts: TIP_FROM_COUNTS,
        tilt_signs: [1; 2],
        ..Plan::default()
    };
    for report in tables.reports {
        let planned = plan_report(report, &mut plan).map_err(|field| PlanError::Field {
            profile: profile.key.clone(),
            field,
        })?;
        plan.reports.push(planned);
    }
    plan.count_controls();
    Ok(plan)
}

impl Plan {
    /// Where the profile names no controls of a class, those of its fields are all there are.
    fn count_controls(&mut self) {
        let groups = self.reports.iter().flat_map(|report| &report.groups);
        let (mut buttons, mut axes, mut rings, mut dials) = (0, 0, 0, 0);
        for field in groups.flat_map(|group| &group.fields) {
            let (class, number) = match field.name {
                FieldName::Key(n) | FieldName::Button(n) => (&mut buttons, n),
                FieldName::Axis(n) | FieldName::Touched(n) => (&mut axes, n),
                FieldName::Ring(n) => (&mut rings, n),
                FieldName::Dial(n) => (&mut dials, n),
                _ => continue,
            };
            *class = number.max(*class);
        }
        for (class, of_fields) in [
            (&mut self.buttons, buttons),
            (&mut self.axes, axes),
            (&mut self.rings, rings),
            (&mut self.dials, dials),
        ] {
            if *class == 0 {
                *class = of_fields;
            }
        }
    }
}

fn plan_report(report: &Report, plan: &mut Plan) -> Result<PlannedReport, String> {
    let (of_slots, matches): (Vec<ByteMatch>, Vec<ByteMatch>) = report
        .matches
        .iter()
        .copied()
        .partition(|condition| condition.slot);
    let mut groups = Vec::new();
    let (first, stride, count) = report
        .slots
        .map_or((0, 0, 1), |slots| (slots.first, slots.stride, slots.count));
    for slot in 0..count {
        let start = first + slot * stride;
        let mut group = Group {
            conditions: of_slots.iter().map(|&at| moved(at, start)).collect(),
            finger: slot,
            ..Group::default()
        };
        for field in &report.fields {
            for row in 0..field.repeat.map_or(1, |repeat| repeat.count) {
                let planned = plan_field(field, start, row, plan).ok_or_else(|| field.name.to_string())?;
                group.fields.push(planned);
            }
        }
        groups.push(group);
    }
    let bytes = report
        .bytes
        .map_or([1, ANY_LENGTH], |range| range.map(usize::from));
    Ok(PlannedReport {
        id: report.id,
        bytes,
        matches,
        emits: report.emits,
        tool: report.tool.map(tool),
        used: report.slots.and_then(|slots| slots.used),
        groups,
    })
}

fn moved(condition: ByteMatch, by: u16) -> ByteMatch {
    ByteMatch {
        byte: condition.byte + by,
        ..condition
    }
}

fn plan_field(field: &Field, start: u16, row: u16, plan: &mut Plan) -> Option<PlannedField> {
    let shift = u32::from(start) * 8 + field.repeat.map_or(0, |r| u32::from(r.bits) * u32::from(row));
    let first = Piece {
        first: u32::from(field.byte) * 8 + u32::from(field.bit) + shift,
        width: field.bits(),
        big: field.endian == ByteOrder::Big && field.bits() > 8,
    };
    let also = field.also.iter().map(|piece| Piece {
        first: u32::from(piece.byte) * 8 + u32::from(piece.bit) + shift,
        width: piece.width,
        big: false,
    });
    let pieces: Vec<Piece> = std::iter::once(first).chain(also).collect();
    let counter = field.wraps.then(|| {
        plan.counters += 1;
        plan.counters - 1
    });
    // Tilts are told as the tablet counts them; which way that is goes with the surface.
    let mut scale = i64::from(field.scale);
    let [x, y] = &mut plan.tilt_signs;
    if let Some(sign) = match field.name {
        FieldName::TiltX => Some(x),
        FieldName::TiltY => Some(y),
        _ => None,
    } {
        *sign = if scale < 0 { -1 } else { 1 };
        scale = scale.abs();
    }
    Some(PlannedField {
        sign: match field.sign_bit {
            Some(bit) => Sign::Bit(bit),
            None if field.signed => Sign::Twos,
            None => Sign::None,
        },
        invert: field.invert,
        nothing: field.nothing.map(u64::from),
        scale,
        add: field.add.into(),
        counter,
        when: field.when.map(|when| moved(when, start)),
        ..PlannedField::plain(field.name.on_by(row), Bits::several(&pieces)?)
    })
}

/// The profile's word for a tool.
pub(super) fn tool(tool: device_profiles::Tool) -> Tool {
    match tool {
        device_profiles::Tool::Pen => Tool::Pen,
        device_profiles::Tool::Eraser => Tool::Eraser,
        device_profiles::Tool::Puck => Tool::Puck,
        device_profiles::Tool::Mouse => Tool::Mouse,
    }
}
