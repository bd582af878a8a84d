//! Decoding without a profile: a report descriptor, compiled.
//!
//! Pens, pucks, fingers, dials, sliders, wheels, axes and buttons of a compliant device work so. What a descriptor
//! does not tell (vendors' own pages) is left out.

mod controls;
mod describe;
mod number;
mod touch;
mod usage;

use super::descriptor::{Described, Descriptor, Direction, Usage};
use super::plan::{Group, Plan, PlannedField, PlannedReport};
use crate::codec::{Surface, Tool};
use controls::Numbers;
use device_profiles::{Emits, FieldName, InputProfile};
use number::planned;
use usage::Place;

/// What a descriptor comes to.
#[derive(Clone, Debug)]
pub(super) struct Generic {
    pub(super) plan: Plan,
    pub(super) surface: Option<Surface>,
    /// A mouse: its buttons are those of a tool.
    pub(super) pointer: bool,
    /// The same as a profile would say it.
    pub(super) profile: InputProfile,
}

/// Compiles a descriptor.
pub(super) fn compile(descriptor: &Descriptor) -> Generic {
    let mut building = Building {
        descriptor,
        plan: Plan {
            // HID pens have a bit for the tip; those without one press from the first step on.
            tip_from_counts: 0,
            tilt_signs: [1; 2],
            ..Plan::default()
        },
        numbers: Numbers::default(),
        pointer: false,
    };
    for field in descriptor
        .fields
        .iter()
        .filter(|f| f.direction == Direction::Input)
    {
        let around = field_collections(descriptor, field);
        building.add(field, usage::place(&around));
    }
    building.finish()
}

/// Collections around a field with their numbers, innermost first.
fn field_collections(descriptor: &Descriptor, field: &Described) -> Vec<(usize, Usage)> {
    let mut around = Vec::new();
    let mut at = field.collection;
    while let Some((index, collection)) = at.and_then(|at| Some((at, descriptor.collections.get(at)?))) {
        around.push((index, collection.usage));
        at = collection.parent;
    }
    around
}

struct Building<'a> {
    descriptor: &'a Descriptor,
    plan: Plan,
    numbers: Numbers,
    pointer: bool,
}

impl Building<'_> {
    fn add(&mut self, field: &Described, place: Place) {
        if !field.flags.variable() {
            return self.add_array(field);
        }
        match place {
            Place::Pen => self.add_tool(field, Tool::Pen),
            Place::Puck => self.add_tool(field, Tool::Puck),
            Place::Finger(collection) => self.add_finger(field, collection),
            Place::TouchSurface => self.add_touch_surface(field),
            // A mouse that tells places is one lying on a tablet.
            Place::Mouse if self.tells_places(field) => self.add_tool(field, Tool::Mouse),
            Place::Mouse | Place::MultiAxis | Place::Pad | Place::Controls => self.add_control(field, place),
        }
    }

    /// Whether the x of the field's report is absolute.
    fn tells_places(&self, field: &Described) -> bool {
        let same = |f: &&Described| (f.direction, f.report) == (field.direction, field.report);
        let mut fields = self.descriptor.fields.iter().filter(same);
        fields.any(|f| usage::standard(f.usage()) == usage::X && !f.flags.relative())
    }

    fn add_tool(&mut self, field: &Described, tool: Tool) {
        let usage = usage::standard(field.usage());
        let Some(name) = puck_name(usage)
            .filter(|_| tool != Tool::Pen)
            .or_else(|| tool_name(usage))
        else {
            return;
        };
        let planned = planned(name, field, self.descriptor.numbered);
        let group = self.group(field.report, Emits::Tool, Some(tool));
        match name {
            // The upper half of a serial number goes on top of the lower.
            FieldName::Serial if usage == usage::SERIAL_HIGH => {
                number::widen(group, FieldName::Serial, &planned);
            }
            _ => add_once(group, planned),
        }
    }

    /// The one group of a report's family.
    fn group(&mut self, report: u8, emits: Emits, tool: Option<Tool>) -> &mut Group {
        let planned = self.report(report, emits, tool);
        if planned.groups.is_empty() {
            planned.groups.push(Group::default());
        }
        // There is one since the line above.
        &mut planned.groups[0]
    }

    /// A report's plan in one family, made if it is not there.
    fn report(&mut self, report: u8, emits: Emits, tool: Option<Tool>) -> &mut PlannedReport {
        let id = self.descriptor.numbered.then_some(report);
        let reports = &mut self.plan.reports;
        let known = reports.iter().position(|r| r.id == id && r.emits == emits);
        let at = known.unwrap_or(reports.len());
        if known.is_none() {
            let bytes = self.descriptor.report_bytes(Direction::Input, report);
            reports.push(PlannedReport {
                id,
                // Systems hand over longer ones, filled up.
                bytes: [bytes.unwrap_or(1), usize::MAX],
                matches: Vec::new(),
                emits,
                tool,
                used: None,
                groups: Vec::new(),
            });
        }
        &mut reports[at]
    }

    fn finish(mut self) -> Generic {
        for report in self.plan.reports.iter_mut().filter(|r| r.emits == Emits::Tool) {
            for group in &mut report.groups {
                in_range_by_contact(group);
            }
        }
        let surface = describe::surface(self.descriptor, &self.plan);
        self.numbers.write(&mut self.plan);
        let profile = describe::profile(self.descriptor, surface, &self.numbers);
        Generic {
            plan: self.plan,
            surface,
            pointer: self.pointer,
            profile,
        }
    }
}

/// A pen is there while it touches: also where its descriptor has no bit for being in range, and where its firmware
/// takes that bit away while it touches, as a Goodix 27c6:0113 does. With a bit for the eraser's end and none for
/// being in range it never leaves.
fn in_range_by_contact(group: &mut Group) {
    let has = |name| group.fields.iter().any(|f| f.name == name);
    if !has(FieldName::InRange) && (has(FieldName::Invert) || has(FieldName::Eraser)) {
        return;
    }
    let touches = |f: &&PlannedField| matches!(f.name, FieldName::Tip | FieldName::Eraser);
    let contacts: Vec<_> = group.fields.iter().filter(touches).copied().collect();
    group
        .fields
        .extend(contacts.into_iter().map(|contact| PlannedField {
            name: FieldName::InRange,
            ..contact
        }));
}

/// Adds a field unless one of its name is there: descriptors name the last usage for all fields that are left.
fn add_once(group: &mut Group, field: PlannedField) {
    if !group.fields.iter().any(|f| f.name == field.name) {
        group.fields.push(field);
    }
}

/// What lies on the surface with its whole weight has no tip: its switches are buttons.
fn puck_name(usage: Usage) -> Option<FieldName> {
    let number = [usage::TIP, usage::BARREL, usage::BARREL_2]
        .iter()
        .position(|&known| known == usage)?;
    Some(FieldName::Button(number as u16 + 1))
}

fn tool_name(usage: Usage) -> Option<FieldName> {
    Some(match usage {
        usage::X => FieldName::X,
        usage::Y => FieldName::Y,
        usage::Z | usage::DISTANCE => FieldName::Distance,
        usage::WHEEL => FieldName::Wheel,
        usage::PRESSURE => FieldName::Pressure,
        usage::IN_RANGE => FieldName::InRange,
        usage::INVERT => FieldName::Invert,
        usage::TILT_X => FieldName::TiltX,
        usage::TILT_Y => FieldName::TiltY,
        usage::TWIST => FieldName::Twist,
        usage::TIP => FieldName::Tip,
        usage::ERASER => FieldName::Eraser,
        usage::BARREL => FieldName::Button(1),
        usage::BARREL_2 => FieldName::Button(2),
        usage::SERIAL | usage::SERIAL_HIGH => FieldName::Serial,
        usage::TOOL_TYPE => FieldName::ToolType,
        Usage {
            page: usage::BUTTON,
            id: id @ 1..=32,
        } => FieldName::Button(id),
        _ => return None,
    })
}

#[cfg(test)]
mod real;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod written;
