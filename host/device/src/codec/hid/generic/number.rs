//! A described field as a planned one.

use crate::codec::hid::bits::Bits;
use crate::codec::hid::descriptor::Described;
use crate::codec::hid::plan::{Group, PlannedField, Sign};
use device_profiles::FieldName;

/// Bits before a report's fields.
pub(super) fn offset(numbered: bool) -> u32 {
    if numbered { 8 } else { 0 }
}

/// The bits of an element.
pub(super) fn bits(field: &Described, numbered: bool) -> Bits {
    Bits::one(offset(numbered) + field.bit, field.width as u8)
}

/// A variable, under that name. Places count from 0, whatever the logical minimum; other numbers are as they come.
pub(super) fn planned(name: FieldName, field: &Described, numbered: bool) -> PlannedField {
    let [low, high] = field.logical;
    let places = matches!(
        name,
        FieldName::X | FieldName::Y | FieldName::Pressure | FieldName::TouchX | FieldName::TouchY
    );
    let sign = if low < 0 { Sign::Twos } else { Sign::None };
    // Names of tools and fingers are no quantities: firmware says 0 to 255 of 64 bits.
    let names = matches!(name, FieldName::Serial | FieldName::ToolType | FieldName::TouchId);
    let bounded = !field.flags.relative() && !name.is_switch() && !names && low < high;
    // Without null state, values outside are cut to the range, as Linux does after Microsoft's driver. A hat at rest
    // is outside whatever its flags say.
    let hat = super::usage::standard(field.usage()) == super::usage::HAT;
    let null = field.flags.null_state() || hat;
    PlannedField {
        sign,
        range: (bounded && null).then_some([low, high]),
        clamp: (bounded && !null).then_some([low, high]),
        add: if places { -low } else { 0 },
        ..PlannedField::plain(name, bits(field, numbered))
    }
}

/// Puts more bits on top of the group's field of that name, or adds it alone.
pub(super) fn widen(group: &mut Group, name: FieldName, upper: &PlannedField) {
    let known = group.fields.iter_mut().find(|f| f.name == name);
    match known {
        Some(field) => {
            if let Some(bits) = field.bits.with(upper.bits) {
                field.bits = bits;
                (field.sign, field.clamp, field.range) = (Sign::None, None, None);
            }
        }
        None => group.fields.push(*upper),
    }
}

/// A run of bits that a condition on one byte can ask for: byte and mask.
pub(super) fn one_byte(field: &Described, numbered: bool) -> Option<(u16, u8)> {
    let first = offset(numbered) + field.bit;
    let shift = first % 8;
    if shift + field.width > 8 {
        return None;
    }
    let mask = (u16::from(u8::MAX) >> (8 - field.width) << shift) as u8;
    Some((u16::try_from(first / 8).ok()?, mask))
}
