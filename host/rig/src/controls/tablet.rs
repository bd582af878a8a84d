//! What a tablet's surface sends: positions, switches, pressure and the rest, as outputs of an instance.
//!
//! Outputs <1> to <6> are those of TABLETIN (`docs/ps300/functions.md`); the others are the project's own. Every
//! sample is a message of its own. It must not know which tablet it is.

use device::codec::{PenSample, Surface, Tool};
use glam::{DVec2, DVec3};
use ps300::value::{Kind, Kinds, Value};

use crate::controls_calibration::tablet::Sheet;
use crate::controls_calibration::{PressureCurve, TabletMapping};

/// Number of outputs a surface has; the controls beside it are numbered on from there.
pub(crate) const OUTPUTS: u8 = 16;

const VECTOR2: Kinds = Kinds::of(&[Kind::Vector2]);

/// What each output sends.
pub(crate) const KINDS: [Kinds; OUTPUTS as usize] = [
    VECTOR2,
    Kinds::BOOLEAN,
    Kinds::INTEGER,
    Kinds::BOOLEAN,
    Kinds::BOOLEAN,
    VECTOR2,
    Kinds::REAL,
    VECTOR2,
    Kinds::REAL,
    Kinds::REAL,
    Kinds::INTEGER,
    Kinds::INTEGER,
    Kinds::STRING,
    Kinds::of(&[Kind::Vector3]),
    Kinds::INTEGER,
    VECTOR2,
];

/// Where a message of the surface goes: output, value.
pub(crate) type Emit<'a> = dyn FnMut(u8, Value) + 'a;

/// What is remembered of a surface from sample to sample.
#[derive(Clone, Debug, Default)]
#[allow(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub(crate) struct Tablet {
    in_range: bool,
    code: i32,
    pressed: bool,
    tool: Option<(Tool, Option<u64>)>,
    fingers: Vec<u16>,
    /// What a hand measured of it.
    mapping: Option<TabletMapping>,
    /// The tip is down, by the pressure that was measured.
    tip: bool,
    /// A tool is near, whether or not that is passed on.
    near: bool,
    quiet: Quiet,
    /// Where it was last, −1 to 1, and with what pressure, 0 to 1.
    pub(crate) position: DVec2,
    pub(crate) pressure: f64,
}

/// Whether what tools do is passed on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Quiet {
    /// It is.
    #[default]
    No,
    /// It is being calibrated.
    Calibrated,
    /// It was, or its mapping was exchanged under a tool: once that is lifted.
    UntilAway,
}

impl Tablet {
    /// Takes another mapping. A tool that is near counts as lifted until it is, so that nothing steps.
    pub(crate) fn calibrate(&mut self, mapping: Option<&TabletMapping>, emit: &mut Emit<'_>) {
        if self.mapping.as_ref() == mapping {
            return;
        }
        self.leave(emit);
        self.mapping = mapping.cloned();
        if self.quiet == Quiet::No && self.near {
            self.quiet = Quiet::UntilAway;
        }
    }

    /// Begins or ends being calibrated: meanwhile tools count as lifted, and until they are.
    pub(crate) fn mute(&mut self, on: bool, emit: &mut Emit<'_>) {
        if on {
            self.leave(emit);
        }
        self.quiet = match (on, self.near) {
            (true, _) => Quiet::Calibrated,
            (false, true) => Quiet::UntilAway,
            (false, false) => Quiet::No,
        };
    }

    /// The device is gone, and with it whatever was near: what comes when it is back has come anew.
    pub(crate) fn gone(&mut self) {
        self.near = false;
        if self.quiet == Quiet::UntilAway {
            self.quiet = Quiet::No;
        }
    }

    /// Tools and fingers count as lifted.
    pub(crate) fn leave(&mut self, emit: &mut Emit<'_>) {
        if self.in_range {
            let tool = self.tool.map_or(Tool::Pen, |(tool, _)| tool);
            let away = PenSample::hovering(tool, 0, 0);
            self.pass(&away.leaving(), Surface::flat([1; 2], [1.0; 2], 1), emit);
        }
        if !self.fingers.is_empty() {
            self.fingers.clear();
            emit(15, Value::Integer(0));
        }
    }

    /// One sample, in the order the original's outputs would have sent it.
    pub(crate) fn hear(&mut self, sample: &PenSample, surface: Surface, emit: &mut Emit<'_>) {
        self.near = sample.in_range;
        if self.quiet == Quiet::UntilAway && !sample.in_range {
            self.quiet = Quiet::No;
        }
        if self.quiet != Quiet::No {
            return;
        }
        let place = self.place([sample.x_counts, sample.y_counts], surface);
        // Outside the area that counts is as far away as out of reach.
        let mut sample = if place.is_some() {
            *sample
        } else {
            sample.leaving()
        };
        sample.tip = self.tip(&sample, surface);
        self.pass(&sample, surface, emit);
    }

    /// A place on it; none outside the area that counts.
    fn place(&self, counts: [u32; 2], surface: Surface) -> Option<DVec2> {
        match &self.mapping {
            Some(mapping) => mapping.place(counts, &Sheet::from(surface)).map(DVec2::from),
            None => Some(tablet_position(counts, surface)),
        }
    }

    /// Whether the tip is down: as the tablet says, or by the pressure that was measured.
    fn tip(&mut self, sample: &PenSample, surface: Surface) -> bool {
        let measured = self.mapping.as_ref().map(|mapping| mapping.pressure);
        let measured = measured.filter(|curve| *curve != PressureCurve::default());
        self.tip = match measured.filter(|_| surface.pressure_max > 0) {
            Some(curve) => {
                sample.in_range && curve.tip(self.tip, sample.pressure_counts, surface.pressure_max)
            }
            None => sample.tip,
        };
        self.tip
    }

    fn pass(&mut self, sample: &PenSample, surface: Surface, emit: &mut Emit<'_>) {
        self.proximity(sample, emit);
        let place = self.place([sample.x_counts, sample.y_counts], surface);
        let position = place.filter(|_| sample.in_range).unwrap_or(self.position);
        if sample.in_range {
            self.position = position;
            emit(1, Value::Vector2(position));
        }
        self.press(sample, surface, emit);
        if sample.in_range {
            beside(sample, surface, emit);
        }
        let code = button_code(sample);
        if code == self.code {
            return;
        }
        let pressed = code & !self.code != 0;
        if (code == 0) != (self.code == 0) {
            emit(2, Value::Boolean(code != 0));
        }
        self.code = code;
        emit(3, Value::Integer(code));
        if pressed {
            emit(6, Value::Vector2(position));
        }
    }

    fn proximity(&mut self, sample: &PenSample, emit: &mut Emit<'_>) {
        if sample.in_range != self.in_range {
            self.in_range = sample.in_range;
            emit(5, Value::Boolean(sample.in_range));
        }
        let tool = (sample.tool, sample.tool_serial);
        if !sample.in_range || self.tool == Some(tool) {
            return;
        }
        self.tool = Some(tool);
        let number = match sample.tool {
            Tool::Pen => 1,
            Tool::Eraser => 2,
            Tool::Puck => 3,
            Tool::Mouse => 4,
        };
        emit(12, Value::Integer(number));
        if let Some(serial) = sample.tool_serial {
            emit(13, Value::from(format!("{serial:X}").as_str()));
        }
    }

    /// Pressure with every sample, and once when it ends.
    fn press(&mut self, sample: &PenSample, surface: Surface, emit: &mut Emit<'_>) {
        if surface.pressure_max == 0 {
            return;
        }
        let curve = self.mapping.as_ref().map(|mapping| mapping.pressure);
        let pressure = curve
            .unwrap_or_default()
            .share(sample.pressure_counts, surface.pressure_max);
        self.pressure = if sample.in_range { pressure } else { 0.0 };
        if sample.in_range || self.pressed {
            emit(7, Value::Real(self.pressure));
        }
        self.pressed = sample.in_range && self.pressure > 0.0;
    }

    /// A finger on the surface, or leaving it.
    pub(crate) fn touch(&mut self, id: u16, at: Option<[u32; 2]>, surface: Surface, emit: &mut Emit<'_>) {
        if self.quiet != Quiet::No {
            return;
        }
        let place = at.and_then(|at| self.place(at, surface));
        let at = at.filter(|_| place.is_some());
        let known = self.fingers.iter().position(|&finger| finger == id);
        match (at, known) {
            (Some(_), None) => self.fingers.push(id),
            (None, Some(place)) => {
                self.fingers.swap_remove(place);
            }
            _ => {}
        }
        if let Some(place) = place {
            emit(14, Value::Vector3(DVec3::new(place.x, place.y, f64::from(id))));
        }
        if at.is_some() == known.is_none() {
            emit(15, Value::Integer(self.fingers.len() as i32));
        }
    }

    /// A pointer without a place has moved.
    pub(crate) fn moved(delta: [i32; 2], wheel: i16, emit: &mut Emit<'_>) {
        if delta != [0, 0] {
            let [dx, dy] = delta.map(f64::from);
            emit(16, Value::Vector2(DVec2::new(dx, 0.0 - dy)));
        }
        if wheel != 0 {
            emit(11, Value::Integer(wheel.into()));
        }
    }
}

/// Tilt, twist, height and wheel, where the tool has them.
fn beside(sample: &PenSample, surface: Surface, emit: &mut Emit<'_>) {
    if let Some(tilt) = surface.tilt_rad(sample) {
        let [x, y] = tilt.map(f64::to_degrees);
        // A tablet's y points towards the user, the network's away from him.
        emit(8, Value::Vector2(DVec2::new(x, 0.0 - y)));
    }
    if let (Some(twist), Some(steps)) = (sample.twist, surface.twist_steps_per_turn) {
        emit(9, Value::Real(f64::from(twist) / steps * 360.0));
    }
    if let Some(distance) = sample.distance {
        emit(10, Value::Real(distance.into()));
    }
    if sample.wheel != 0 {
        emit(11, Value::Integer(sample.wheel.into()));
    }
}

/// Buttons as the puck's code: 1, 2, 4, 8. A pen's tip is the first, its barrel buttons follow.
fn button_code(sample: &PenSample) -> i32 {
    if !sample.in_range {
        return 0;
    }
    match sample.tool {
        Tool::Puck | Tool::Mouse => (sample.buttons & 15) as i32,
        Tool::Pen | Tool::Eraser => i32::from(sample.tip) | ((sample.buttons & 7) << 1) as i32,
    }
}

fn tablet_position(counts: [u32; 2], surface: Surface) -> DVec2 {
    let inches = |axis: usize| f64::from(surface.max_counts[axis]) / surface.counts_per_inch[axis].max(1.0);
    let half_long_side = inches(0).max(inches(1)).max(f64::MIN_POSITIVE) / 2.0;
    let from_middle = |axis: usize| {
        let share = f64::from(counts[axis]) / f64::from(surface.max_counts[axis].max(1));
        (share - 0.5) * inches(axis) / half_long_side
    };
    // Counts grow downwards; `0 − y` rather than `−y`, which would make the middle −0.
    DVec2::new(from_middle(0), 0.0 - from_middle(1))
}

#[cfg(test)]
#[path = "tablet_tests.rs"]
mod tests;
