//! What usages mean for controls. Ids from "HID Usage Tables" 1.5, pages 0x01, 0x09 and 0x0D.

use crate::codec::hid::descriptor::Usage;

pub(super) const DESKTOP: u16 = 0x01;
pub(super) const SIMULATION: u16 = 0x02;
pub(super) const KEYBOARD: u16 = 0x07;
pub(super) const BUTTON: u16 = 0x09;
pub(super) const CONSUMER: u16 = 0x0C;
pub(super) const DIGITIZER: u16 = 0x0D;
/// More keys are down than the array has elements: it says nothing of which. Elements then all hold this.
pub(super) const ROLL_OVER: Usage = Usage::new(KEYBOARD, 0x01);
/// Wacom's own page: the standard ones folded into it.
pub(super) const WACOM: u16 = 0xFF0D;

pub(super) const POINTER: Usage = Usage::new(DESKTOP, 0x01);
pub(super) const MOUSE: Usage = Usage::new(DESKTOP, 0x02);
pub(super) const MULTI_AXIS: Usage = Usage::new(DESKTOP, 0x08);
pub(super) const X: Usage = Usage::new(DESKTOP, 0x30);
pub(super) const Y: Usage = Usage::new(DESKTOP, 0x31);
pub(super) const Z: Usage = Usage::new(DESKTOP, 0x32);
pub(super) const SLIDER: Usage = Usage::new(DESKTOP, 0x36);
pub(super) const DIAL: Usage = Usage::new(DESKTOP, 0x37);
pub(super) const WHEEL: Usage = Usage::new(DESKTOP, 0x38);
pub(super) const HAT: Usage = Usage::new(DESKTOP, 0x39);
pub(super) const STYLUS: Usage = Usage::new(DIGITIZER, 0x20);
pub(super) const PUCK: Usage = Usage::new(DIGITIZER, 0x21);
pub(super) const FINGER: Usage = Usage::new(DIGITIZER, 0x22);
pub(super) const TOUCH_SCREEN: Usage = Usage::new(DIGITIZER, 0x04);
pub(super) const TOUCH_PAD: Usage = Usage::new(DIGITIZER, 0x05);
pub(super) const FUNCTION_KEYS: Usage = Usage::new(DIGITIZER, 0x39);
pub(super) const PRESSURE: Usage = Usage::new(DIGITIZER, 0x30);
pub(super) const IN_RANGE: Usage = Usage::new(DIGITIZER, 0x32);
pub(super) const INVERT: Usage = Usage::new(DIGITIZER, 0x3C);
pub(super) const TILT_X: Usage = Usage::new(DIGITIZER, 0x3D);
pub(super) const TILT_Y: Usage = Usage::new(DIGITIZER, 0x3E);
pub(super) const TWIST: Usage = Usage::new(DIGITIZER, 0x41);
pub(super) const TIP: Usage = Usage::new(DIGITIZER, 0x42);
pub(super) const BARREL: Usage = Usage::new(DIGITIZER, 0x44);
pub(super) const ERASER: Usage = Usage::new(DIGITIZER, 0x45);
pub(super) const CONTACT_ID: Usage = Usage::new(DIGITIZER, 0x51);
pub(super) const CONTACT_COUNT: Usage = Usage::new(DIGITIZER, 0x54);
pub(super) const BARREL_2: Usage = Usage::new(DIGITIZER, 0x5A);
pub(super) const SERIAL: Usage = Usage::new(DIGITIZER, 0x5B);
pub(super) const SERIAL_HIGH: Usage = Usage::new(WACOM, 0x5C);
pub(super) const TOOL_TYPE: Usage = Usage::new(WACOM, 0x77);
pub(super) const DISTANCE: Usage = Usage::new(WACOM, 0x0132);
pub(super) const TOUCH_RING: Usage = Usage::new(WACOM, 0x0138);
pub(super) const TOUCH_RING_STATUS: Usage = Usage::new(WACOM, 0x0139);
/// Pen, light pen and plain digitizer: what a stylus or puck is used on.
const PENS: std::ops::RangeInclusive<u16> = 0x01..=0x03;

/// The usage that a maker's own stands for. Wacom's page has the standard page in the upper byte of the id, 0 for the
/// digitizer's; some ids are its own. Source: Linux `wacom_wac.c`, `wacom_equivalent_usage`.
pub(super) fn standard(usage: Usage) -> Usage {
    if usage.page != WACOM {
        return usage;
    }
    match (usage.id >> 8, usage.id & 0xFF) {
        // Sense, serial number's upper half, tool type; distance, strips and rings.
        (0, 0x36 | 0x5C | 0x77) | (1, 0x32 | 0x36..=0x39 | 0xD0) => usage,
        (0, id) => Usage::new(DIGITIZER, id),
        (9, id) => Usage::new(BUTTON, id),
        (1, id) => Usage::new(DESKTOP, id),
        _ => usage,
    }
}

/// Where a field belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// To a tool over the surface.
    Pen,
    /// To a puck.
    Puck,
    /// To the finger of the collection of that number.
    Finger(usize),
    /// To a surface for fingers, outside any finger.
    TouchSurface,
    /// To a mouse.
    Mouse,
    /// To a cap with six axes, whose deflections some firmware calls relative.
    MultiAxis,
    /// To the keys beside a tablet's surface.
    Pad,
    /// To anything else.
    Controls,
}

/// Where a field belongs that has these collections around it, innermost first, each with its number.
pub(super) fn place(around: &[(usize, Usage)]) -> Place {
    let has = |wanted: Usage| around.iter().find(|&&(_, usage)| standard(usage) == wanted);
    if let Some(&(at, _)) = has(FINGER) {
        return Place::Finger(at);
    }
    let application = around.last().map(|&(_, usage)| standard(usage));
    match application.unwrap_or_default() {
        TOUCH_SCREEN | TOUCH_PAD if has(STYLUS).is_some() => Place::Pen,
        TOUCH_SCREEN | TOUCH_PAD => Place::TouchSurface,
        FUNCTION_KEYS => Place::Pad,
        MULTI_AXIS => Place::MultiAxis,
        MOUSE | POINTER => Place::Mouse,
        Usage { page: DIGITIZER, id } if PENS.contains(&id) => {
            if has(PUCK).is_some() && has(STYLUS).is_none() {
                Place::Puck
            } else {
                Place::Pen
            }
        }
        _ => Place::Controls,
    }
}
