//! What a tablet's surface sends: positions, switches, pressure and the rest, as outputs of an instance.
//!
//! Outputs <1> to <6> are those of TABLETIN (`docs/ps300/functions.md`); the others are the project's own. Every
//! sample is a message of its own. It must not know which tablet it is.

use device::codec::{PenSample, Surface, Tool};
use glam::{DVec2, DVec3};
use ps300::value::{Kind, Kinds, Value};

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
pub(crate) struct Tablet {
    in_range: bool,
    code: i32,
    pressed: bool,
    tool: Option<(Tool, Option<u64>)>,
    fingers: Vec<u16>,
    /// Where it was last, −1 to 1, and with what pressure, 0 to 1.
    pub(crate) position: DVec2,
    pub(crate) pressure: f64,
}

impl Tablet {
    /// One sample, in the order the original's outputs would have sent it.
    pub(crate) fn hear(&mut self, sample: &PenSample, surface: Surface, emit: &mut Emit<'_>) {
        self.proximity(sample, emit);
        let position = tablet_position([sample.x_counts, sample.y_counts], surface);
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
        let pressure = f64::from(sample.pressure_counts) / f64::from(surface.pressure_max);
        self.pressure = if sample.in_range { pressure.min(1.0) } else { 0.0 };
        if sample.in_range || self.pressed {
            emit(7, Value::Real(self.pressure));
        }
        self.pressed = sample.in_range && self.pressure > 0.0;
    }

    /// A finger on the surface, or leaving it.
    pub(crate) fn touch(&mut self, id: u16, at: Option<[u32; 2]>, surface: Surface, emit: &mut Emit<'_>) {
        let known = self.fingers.iter().position(|&finger| finger == id);
        match (at, known) {
            (Some(_), None) => self.fingers.push(id),
            (None, Some(place)) => {
                self.fingers.swap_remove(place);
            }
            _ => {}
        }
        if let Some(at) = at {
            let place = tablet_position(at, surface);
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
