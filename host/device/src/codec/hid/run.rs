//! Going through a plan for one report: fields to events. Nothing is allocated here.

use super::plan::{Family, Group, Plan, PlannedReport};
use super::tool::{Frame, Held};
use crate::codec::{InputEvent, PenSample};
use device_profiles::{Emits, FieldName};

/// Fingers remembered at once; more are told of as they come, and not let go when the device is lost.
const FINGERS_MAX: usize = 32;

/// What a device holds down, and where it stands.
#[derive(Clone, Debug)]
pub(super) struct Running {
    pub(super) held: Held,
    counters: Vec<Option<u64>>,
    /// One bit for each button.
    down: Vec<u64>,
    axes: Vec<Option<i32>>,
    touched: Vec<bool>,
    rings: Vec<Option<u16>>,
    /// Turns of this report, added up.
    turned: Vec<i64>,
    fingers: [Option<u16>; FINGERS_MAX],
    /// Messages announced that are still to come.
    due: usize,
    /// Something was heard of the tool since this was last taken.
    pub(super) tool_heard: bool,
}

/// What became of a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// Understood.
    Understood,
    /// Of no known id or kind.
    Unknown,
    /// Of a known id, but too short or too long.
    Rejected,
}

type Emit<'a> = dyn FnMut(InputEvent) + 'a;

impl Running {
    pub(super) fn new(plan: &Plan) -> Self {
        Self {
            held: Held::default(),
            counters: vec![None; plan.counters],
            down: vec![0; usize::from(plan.buttons).div_ceil(64)],
            axes: vec![None; plan.axes.into()],
            touched: vec![false; plan.axes.into()],
            rings: vec![None; plan.rings.into()],
            turned: vec![0; plan.dials.into()],
            fingers: [None; FINGERS_MAX],
            due: 0,
            tool_heard: false,
        }
    }

    /// Takes one report.
    pub(super) fn take(&mut self, plan: &Plan, bytes: &[u8], emit: &mut Emit<'_>) -> Outcome {
        let Some(bytes) = bytes.get(plan.skip_bytes..).filter(|bytes| !bytes.is_empty()) else {
            return Outcome::Rejected;
        };
        let (mut known, mut fits) = (false, false);
        let mut done = [false; 3];
        let mut whole = true;
        for report in &plan.reports {
            if report.id.is_some() && report.id != bytes.first().copied() {
                continue;
            }
            known = true;
            if !(report.bytes[0]..=report.bytes[1]).contains(&bytes.len()) {
                continue;
            }
            fits = true;
            let Some(done) = done.get_mut(report.family() as usize) else {
                continue;
            };
            if *done || !report.matches.iter().all(|condition| condition.holds(bytes)) {
                continue;
            }
            *done = true;
            whole &= self.one(plan, report, bytes, emit);
        }
        match (known, fits) {
            (true, true) if done.contains(&true) && whole => Outcome::Understood,
            (true, false) => Outcome::Rejected,
            _ if done.contains(&true) => Outcome::Rejected,
            _ => Outcome::Unknown,
        }
    }

    /// False where the report says less than it should.
    fn one(&mut self, plan: &Plan, report: &PlannedReport, bytes: &[u8], emit: &mut Emit<'_>) -> bool {
        let used = report.used.map_or(usize::MAX, |used| {
            let byte = bytes.get(usize::from(used.byte)).copied().unwrap_or(0);
            let told = usize::from((byte & used.mask) >> used.mask.trailing_zeros().min(7));
            // More messages than fit into one report: the others follow in reports that say 0.
            let due = if told > 0 { told } else { self.due };
            self.due = due.saturating_sub(report.groups.len());
            due
        });
        let mut whole = true;
        for group in report.groups.iter().take(used) {
            if !group.conditions.iter().all(|condition| condition.holds(bytes)) {
                continue;
            }
            match report.family() {
                Family::Tool => whole &= self.tool(plan, report, group, bytes, emit),
                Family::Controls => self.controls(group, bytes, emit),
                Family::Touch => self.finger(group, bytes, emit),
            }
        }
        whole
    }

    fn tool(
        &mut self,
        plan: &Plan,
        report: &PlannedReport,
        group: &Group,
        bytes: &[u8],
        emit: &mut Emit<'_>,
    ) -> bool {
        self.tool_heard |= report.emits != Emits::Nothing;
        let mut emit = |sample: PenSample| emit(InputEvent::Pen(sample));
        match report.emits {
            Emits::Leave => {
                self.held.leave(&mut emit);
                true
            }
            Emits::Enter => {
                let frame = self.frame(group, bytes);
                self.held.enter(&frame, report.tool, &mut emit);
                true
            }
            Emits::Tool => {
                let frame = self.frame(group, bytes);
                self.held
                    .report(&frame, report.tool, plan.tip_from_counts, &mut emit)
            }
            _ => true,
        }
    }

    fn frame(&mut self, group: &Group, bytes: &[u8]) -> Frame {
        let mut frame = Frame::default();
        for field in &group.fields {
            let Some(value) = field.value(bytes, &mut self.counters) else {
                continue;
            };
            let on = Some(value != 0);
            match field.name {
                FieldName::X => frame.x = Some(value),
                FieldName::Y => frame.y = Some(value),
                FieldName::Pressure => frame.pressure = Some(value),
                FieldName::TiltX => frame.tilt_x = Some(value),
                FieldName::TiltY => frame.tilt_y = Some(value),
                FieldName::Twist => frame.twist = Some(value),
                FieldName::Distance => frame.distance = Some(value),
                FieldName::Wheel => frame.wheel = Some(frame.wheel.unwrap_or(0).saturating_add(value)),
                // A pen that touches is there, whatever its own bit says.
                FieldName::InRange => frame.in_range = Some(frame.in_range == Some(true) || value != 0),
                FieldName::Proximity => frame.proximity = on,
                FieldName::Ready => frame.ready = on,
                FieldName::Tip => frame.tip = on,
                FieldName::Eraser => frame.eraser = on,
                FieldName::Invert => frame.invert = on,
                FieldName::Serial => frame.serial = Some(value as u64),
                FieldName::ToolType => frame.tool_type = u32::try_from(value).ok(),
                FieldName::Button(number @ 1..=32) => {
                    let bit = 1 << (number - 1);
                    frame.buttons_told |= bit;
                    frame.buttons |= if value != 0 { bit } else { 0 };
                }
                _ => {}
            }
        }
        frame
    }

    fn controls(&mut self, group: &Group, bytes: &[u8], emit: &mut Emit<'_>) {
        let (mut dx, mut dy, mut wheel) = (0_i64, 0_i64, 0_i64);
        for field in &group.fields {
            // A ring's silence is a finger that has left, where it has a word for that.
            let no_finger = field.nothing.is_some() || field.range.is_some() || field.when.is_some();
            let value = field.value(bytes, &mut self.counters);
            if let (FieldName::Ring(number), true) = (field.name, value.is_some() || no_finger) {
                self.ring(number - 1, value, emit);
                continue;
            }
            let Some(value) = value else { continue };
            match field.name {
                FieldName::Key(number) | FieldName::Button(number) => {
                    self.button(number - 1, value != 0, emit);
                }
                FieldName::Axis(number) => self.axis(number - 1, value, emit),
                FieldName::Touched(number) => self.touch_axis(number - 1, value != 0, emit),
                FieldName::Dial(number) => {
                    if let Some(sum) = self.turned.get_mut(usize::from(number - 1)) {
                        *sum = sum.saturating_add(value);
                    }
                }
                FieldName::Dx => dx = dx.saturating_add(value),
                FieldName::Dy => dy = dy.saturating_add(value),
                FieldName::Wheel => wheel = wheel.saturating_add(value),
                _ => {}
            }
        }
        if (dx, dy, wheel) != (0, 0, 0) {
            let [dx, dy] = [dx, dy].map(narrow);
            let wheel = narrow(wheel).clamp(i16::MIN.into(), i16::MAX.into()) as i16;
            emit(InputEvent::Moved { dx, dy, wheel });
        }
        for (control, sum) in (0..).zip(&mut self.turned) {
            let delta_counts = narrow(std::mem::take(sum));
            if delta_counts != 0 {
                emit(InputEvent::Dial {
                    control,
                    delta_counts,
                });
            }
        }
        for array in &group.arrays {
            self.button_array(array, bytes, emit);
        }
    }

    fn button(&mut self, control: u16, down: bool, emit: &mut Emit<'_>) {
        let Some(word) = self.down.get_mut(usize::from(control / 64)) else {
            return;
        };
        let bit = 1 << (control % 64);
        if (*word & bit != 0) != down {
            *word ^= bit;
            emit(InputEvent::Button { control, down });
        }
    }

    fn button_array(&mut self, array: &super::plan::ButtonArray, bytes: &[u8], emit: &mut Emit<'_>) {
        let named = |n| array.named(n, bytes);
        if array.too_many.is_some() && named(0) == array.too_many {
            // What is held is held on.
            return;
        }
        for at in 0..array.buttons {
            let control = array.first + at;
            let word = self.down.get(usize::from(control / 64)).copied().unwrap_or(0);
            let held = word >> (control % 64) & 1 == 1;
            if held && !(0..array.count).any(|n| named(n) == Some(at)) {
                self.button(control, false, emit);
            }
        }
        for at in (0..array.count).filter_map(named) {
            self.button(array.first + at, true, emit);
        }
    }

    fn axis(&mut self, control: u16, value: i64, emit: &mut Emit<'_>) {
        let value = narrow(value);
        if let Some(place) = self.axes.get_mut(usize::from(control))
            && place.replace(value) != Some(value)
        {
            emit(InputEvent::Axis { control, value });
        }
    }

    fn touch_axis(&mut self, control: u16, down: bool, emit: &mut Emit<'_>) {
        if let Some(touched) = self.touched.get_mut(usize::from(control))
            && std::mem::replace(touched, down) != down
        {
            emit(InputEvent::AxisTouched { control, down });
        }
    }

    fn ring(&mut self, control: u16, value: Option<i64>, emit: &mut Emit<'_>) {
        let value = value.map(|value| value.clamp(0, u16::MAX.into()) as u16);
        if let Some(place) = self.rings.get_mut(usize::from(control))
            && std::mem::replace(place, value) != value
        {
            emit(InputEvent::Ring { control, value });
        }
    }

    fn finger(&mut self, group: &Group, bytes: &[u8], emit: &mut Emit<'_>) {
        let (mut id, mut x, mut y, mut down) = (i64::from(group.finger), None, None, None);
        for field in &group.fields {
            let Some(value) = field.value(bytes, &mut self.counters) else {
                continue;
            };
            match field.name {
                FieldName::TouchId => id = value,
                FieldName::TouchX => x = Some(value),
                FieldName::TouchY => y = Some(value),
                FieldName::TouchDown => down = Some(value != 0),
                _ => {}
            }
        }
        let Ok(id) = u16::try_from(id) else { return };
        let known = self.fingers.iter().position(|&finger| finger == Some(id));
        if down == Some(false) {
            if let Some(place) = known.and_then(|at| self.fingers.get_mut(at)) {
                *place = None;
                emit(InputEvent::Touch { id, at: None });
            }
            return;
        }
        let (Some(x), Some(y)) = (x, y) else { return };
        if known.is_none()
            && let Some(place) = self.fingers.iter_mut().find(|finger| finger.is_none())
        {
            *place = Some(id);
        }
        let count = |value: i64| u32::try_from(value.max(0)).unwrap_or(u32::MAX);
        emit(InputEvent::Touch {
            id,
            at: Some([count(x), count(y)]),
        });
    }

    /// Everything held is let go; where absolute things stand is forgotten.
    pub(super) fn let_go(&mut self, emit: &mut Emit<'_>) {
        self.held.leave(&mut |sample| emit(InputEvent::Pen(sample)));
        for id in self.fingers.iter_mut().filter_map(Option::take) {
            emit(InputEvent::Touch { id, at: None });
        }
        for control in 0..self.down.len() as u16 * 64 {
            self.button(control, false, emit);
        }
        for control in 0..self.touched.len() as u16 {
            self.touch_axis(control, false, emit);
        }
        for control in 0..self.rings.len() as u16 {
            self.ring(control, None, emit);
        }
        self.counters.fill(None);
        self.axes.fill(None);
    }
}

fn narrow(value: i64) -> i32 {
    value.clamp(i32::MIN.into(), i32::MAX.into()) as i32
}
