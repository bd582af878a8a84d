//! Buttons, axes, dials and rings of a descriptor, numbered in the order in which it has them.

use super::number::{bits, one_byte, planned};
use super::usage::{self, Place};
use super::{Building, add_once};
use crate::codec::hid::descriptor::{Described, Usage, UsageRange};
use crate::codec::hid::plan::{ButtonArray, Group, Plan};
use device_profiles::{ByteMatch, ControlKind, Emits, FieldName};

/// Most controls of one class; their numbers are `u16` and bitmaps are kept of them.
const CONTROLS_MAX: usize = 4_096;

/// What has been numbered so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Numbers {
    /// Ranges of the axes.
    pub(super) axes: Vec<(Usage, [i64; 2])>,
    /// Counts of a turn of the dials, where that is known.
    pub(super) dials: Vec<Option<f64>>,
    /// Ranges of the rings.
    pub(super) rings: Vec<[i64; 2]>,
    pub(super) buttons: usize,
    counters: usize,
}

impl Numbers {
    pub(super) fn write(&self, plan: &mut Plan) {
        plan.axes = self.axes.len() as u16;
        plan.dials = self.dials.len() as u16;
        plan.rings = self.rings.len() as u16;
        plan.buttons = self.buttons as u16;
        plan.counters = self.counters;
    }

    fn buttons(&mut self, count: usize) -> Option<u16> {
        let first = self.buttons;
        (first + count <= CONTROLS_MAX).then(|| {
            self.buttons += count;
            first as u16
        })
    }
}

/// What a field is to the hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sort {
    Button,
    Axis,
    Dial,
    /// A dial whose place is told, going round.
    Round,
    Ring,
    Dx,
    Dy,
    Wheel,
}

impl Building<'_> {
    pub(super) fn add_control(&mut self, field: &Described, place: Place) {
        let usage = usage::standard(field.usage());
        let Some(sort) = sort(usage, field, place) else {
            return;
        };
        self.pointer |= sort == Sort::Dx;
        let Some(name) = self.number(sort, usage, field) else {
            return;
        };
        let mut planned = planned(name, field, self.descriptor.numbered);
        if sort == Sort::Round {
            planned.counter = Some(self.numbers.counters);
            self.numbers.counters += 1;
        }
        if usage == usage::TOUCH_RING {
            planned.when = self.finger_on_ring(field);
        }
        let group = self.group(field.report, Emits::Controls, None);
        add_once(group, planned);
    }

    fn number(&mut self, sort: Sort, usage: Usage, field: &Described) -> Option<FieldName> {
        let numbers = &mut self.numbers;
        // Turns where the unit is an angle, otherwise nobody knows.
        let per_turn = field
            .counts_per_unit()
            .map(|counts| counts * std::f64::consts::TAU);
        let per_turn = per_turn.filter(|_| field.unit.kind() == super::super::descriptor::UnitKind::Angle);
        let next = |length: usize| (length < CONTROLS_MAX).then_some(length as u16 + 1);
        Some(match sort {
            Sort::Button => FieldName::Key(numbers.buttons(1)? + 1),
            // Without a range there is nothing that it could be a share of.
            Sort::Axis if field.logical[0] == field.logical[1] => return None,
            Sort::Axis => {
                let number = next(numbers.axes.len())?;
                numbers.axes.push((usage, field.logical));
                FieldName::Axis(number)
            }
            Sort::Dial | Sort::Round => {
                let number = next(numbers.dials.len())?;
                let [low, high] = field.logical;
                let round = (sort == Sort::Round).then(|| (high - low + 1) as f64);
                numbers.dials.push(per_turn.or(round));
                FieldName::Dial(number)
            }
            Sort::Ring => {
                let number = next(numbers.rings.len())?;
                numbers.rings.push(field.logical);
                FieldName::Ring(number)
            }
            Sort::Dx => FieldName::Dx,
            Sort::Dy => FieldName::Dy,
            Sort::Wheel => FieldName::Wheel,
        })
    }

    /// Wacom's rings say with a bit of their own whether a finger is there.
    fn finger_on_ring(&self, ring: &Described) -> Option<ByteMatch> {
        let mut fields = self.descriptor.fields.iter();
        let status = fields.find(|f| {
            (f.direction, f.report) == (ring.direction, ring.report)
                && usage::standard(f.usage()) == usage::TOUCH_RING_STATUS
        })?;
        let (byte, mask) = one_byte(status, self.descriptor.numbered)?;
        Some(ByteMatch {
            byte,
            mask,
            is: mask,
            to: None,
            slot: false,
        })
    }

    /// Elements that name what is down.
    pub(super) fn add_array(&mut self, field: &Described) {
        let known = |page| {
            matches!(
                page,
                usage::BUTTON | usage::KEYBOARD | usage::CONSUMER | usage::DESKTOP
            )
        };
        // One range of usages is the rule; where there are several, their pages decide together.
        if field.usages.is_empty() || !field.usages.iter().all(|range| known(range.page)) {
            return;
        }
        let [low, high] = field.logical;
        let choices = field
            .usages
            .iter()
            .map(|range| u64::from(range.count()))
            .sum::<u64>();
        let buttons = choices.min((high - low + 1).max(0) as u64) as usize;
        let Some(first) = self.numbers.buttons(buttons) else {
            return;
        };
        let array = ButtonArray {
            element: bits(field, self.descriptor.numbered),
            count: field.count,
            signed: low < 0,
            lowest: low,
            first,
            buttons: buttons as u16,
            nothing: place_of(&field.usages, |usage| usage.id == 0),
            too_many: place_of(&field.usages, |usage| usage == usage::ROLL_OVER),
        };
        let group: &mut Group = self.group(field.report, Emits::Controls, None);
        group.arrays.push(array);
    }
}

/// Place of the first such usage among an array's choices.
fn place_of(usages: &[UsageRange], is: impl Fn(Usage) -> bool) -> Option<u16> {
    let each = |&range: &UsageRange| (0..range.count()).filter_map(move |n| range.nth(n));
    // Beyond the most controls there is nothing to be looked for.
    let mut all = usages.iter().flat_map(each).take(CONTROLS_MAX);
    all.position(is).map(|at| at as u16)
}

fn sort(usage: Usage, field: &Described, place: Place) -> Option<Sort> {
    let relative = field.flags.relative();
    let pointer = place == Place::Mouse;
    // Small firmware takes a byte for what is on or off.
    let switch = field.width == 1 || field.logical == [0, 1];
    let round = field.flags.wraps() && !relative && field.logical[0] < field.logical[1];
    Some(match usage {
        usage::X if pointer && relative => Sort::Dx,
        usage::Y if pointer && relative => Sort::Dy,
        usage::WHEEL if pointer && relative => Sort::Wheel,
        usage::TOUCH_RING | usage::HAT => Sort::Ring,
        usage::WHEEL if place == Place::Pad && !relative => Sort::Ring,
        usage::WHEEL if !relative && field.flags.null_state() => Sort::Ring,
        // X to Rz: deflections of a cap are absolute, whatever its firmware says.
        Usage {
            page: usage::DESKTOP,
            id: 0x30..=0x35,
        } if place == Place::MultiAxis => Sort::Axis,
        usage::DIAL | usage::WHEEL if round && counts_round(field) => Sort::Round,
        Usage {
            page: usage::DESKTOP,
            id: 0x30..=0x38,
        }
        | Usage {
            page: usage::SIMULATION,
            id: 0x20..,
        } => {
            if relative {
                Sort::Dial
            } else {
                Sort::Axis
            }
        }
        // Volume, balance, bass and treble by knob, panning by wheel; by keys they are buttons.
        Usage {
            page: usage::CONSUMER,
            id: 0xE0..=0xE4 | 0x0238,
        } if !switch => {
            if relative {
                Sort::Dial
            } else {
                Sort::Axis
            }
        }
        // Of the desktop's: system keys and D-pads.
        Usage {
            page: usage::BUTTON | usage::KEYBOARD | usage::CONSUMER,
            ..
        }
        | Usage {
            page: usage::DESKTOP,
            id: 0x3D..=0x3E | 0x81..=0xB7,
        } if switch => Sort::Button,
        _ => return None,
    })
}

/// Differences of a counter are told in its own bits: they must be all there are.
fn counts_round(field: &Described) -> bool {
    let [low, high] = field.logical;
    let span = high - low;
    field.width < 64 && span == (1_i64 << field.width.min(62)) - 1
}

/// What an axis is called.
pub(super) fn axis_name(usage: Usage) -> (ControlKind, &'static str) {
    match usage {
        usage::SLIDER => (ControlKind::Fader, "slider"),
        usage::DIAL => (ControlKind::Knob, "dial"),
        usage::WHEEL => (ControlKind::Knob, "wheel"),
        usage::X => (ControlKind::Axis, "x"),
        usage::Y => (ControlKind::Axis, "y"),
        usage::Z => (ControlKind::Axis, "z"),
        Usage {
            page: usage::DESKTOP,
            id: 0x33,
        } => (ControlKind::Axis, "rx"),
        Usage {
            page: usage::DESKTOP,
            id: 0x34,
        } => (ControlKind::Axis, "ry"),
        Usage {
            page: usage::DESKTOP,
            id: 0x35,
        } => (ControlKind::Axis, "rz"),
        _ => (ControlKind::Axis, "axis"),
    }
}
