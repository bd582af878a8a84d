//! Fingers: one group of fields for each finger collection of a report.

use super::number::{one_byte, planned};
use super::usage::{self, Place};
use super::{Building, add_once};
use crate::codec::hid::descriptor::Described;
use crate::codec::hid::plan::Group;
use device_profiles::{Emits, FieldName, Used};

impl Building<'_> {
    pub(super) fn add_finger(&mut self, field: &Described, collection: usize) {
        let name = match usage::standard(field.usage()) {
            usage::X => FieldName::TouchX,
            usage::Y => FieldName::TouchY,
            usage::TIP => FieldName::TouchDown,
            usage::CONTACT_ID => FieldName::TouchId,
            usage::CONTACT_COUNT => return self.add_touch_surface(field),
            _ => return,
        };
        let planned = planned(name, field, self.descriptor.numbered);
        let nth = self.finger_of(field.report, collection);
        let report = self.report(field.report, Emits::Touch, None);
        while report.groups.len() <= nth {
            let finger = report.groups.len() as u16;
            report.groups.push(Group {
                finger,
                ..Group::default()
            });
        }
        if let Some(group) = report.groups.get_mut(nth) {
            add_once(group, planned);
        }
    }

    /// How many finger collections of the report came before this one.
    fn finger_of(&self, report: u8, collection: usize) -> usize {
        let mut seen = Vec::new();
        for field in self.descriptor.fields.iter().filter(|f| f.report == report) {
            let around = super::field_collections(self.descriptor, field);
            if let Place::Finger(at) = usage::place(&around)
                && !seen.contains(&at)
            {
                seen.push(at);
            }
        }
        seen.iter().position(|&at| at == collection).unwrap_or(0)
    }

    /// Outside the fingers: how many there are, and buttons.
    pub(super) fn add_touch_surface(&mut self, field: &Described) {
        if usage::standard(field.usage()) != usage::CONTACT_COUNT {
            return self.add_control(field, Place::TouchSurface);
        }
        let used = one_byte(field, self.descriptor.numbered).map(|(byte, mask)| Used { byte, mask });
        self.report(field.report, Emits::Touch, None).used = used;
    }
}
