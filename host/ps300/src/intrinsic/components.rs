//! Numbers and vectors alike, component by component: what can be added, limited and moved smoothly.

use glam::{DVec2, DVec3, DVec4};

use super::function::{Fault, Inputs};
use crate::value::{Kind, Kinds, Value};

/// What has components.
pub(super) const CONTINUOUS: Kinds = Kinds::NUMBER.or(Kinds::VECTOR);

/// The components of a number or vector, zeros behind them.
pub(super) fn components(value: &Value) -> Option<[f64; 4]> {
    match value {
        Value::Vector2(v) => Some([v.x, v.y, 0.0, 0.0]),
        Value::Vector3(v) => Some([v.x, v.y, v.z, 0.0]),
        Value::Vector4(v) => Some(v.to_array()),
        number => number.as_number().map(|x| [x, 0.0, 0.0, 0.0]),
    }
}

/// A vector of this kind, or a real.
pub(super) fn assemble(kind: Kind, [x, y, z, w]: [f64; 4]) -> Value {
    match kind {
        Kind::Vector2 => DVec2::new(x, y).into(),
        Kind::Vector3 => DVec3::new(x, y, z).into(),
        Kind::Vector4 => DVec4::new(x, y, z, w).into(),
        _ => x.into(),
    }
}

/// A real or a vector. Components its kind does not have are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    kind: Kind,
    at: [f64; 4],
}

impl Point {
    /// What is at an input, integers as reals.
    pub(super) fn of(inputs: &Inputs<'_>, input: u8) -> Result<Self, Fault> {
        Self::read(inputs.get(input)).ok_or(Fault::Kind {
            input,
            expected: CONTINUOUS,
        })
    }

    pub(super) fn read(value: &Value) -> Option<Self> {
        let kind = match value.kind() {
            Kind::Integer => Kind::Real,
            kind => kind,
        };
        components(value).map(|at| Self { kind, at })
    }

    pub(super) fn value(self) -> Value {
        assemble(self.kind, self.at)
    }

    pub(super) fn is_like(self, other: Self) -> bool {
        self.kind == other.kind
    }

    pub(super) fn is_number(self) -> bool {
        self.kind == Kind::Real
    }

    /// What would go with it.
    pub(super) fn kinds(self) -> Kinds {
        match self.kind {
            Kind::Real => Kinds::NUMBER,
            vector => vector.into(),
        }
    }

    /// The number, or the first component.
    pub(super) fn first(self) -> f64 {
        self.at[0]
    }

    /// Zero, of the same kind.
    pub(super) fn zero(self) -> Self {
        Self { at: [0.0; 4], ..self }
    }

    /// Component by component with another, which is of the same kind.
    pub(super) fn with(self, other: Self, each: impl Fn(f64, f64) -> f64) -> Self {
        let at = std::array::from_fn(|i| each(self.at[i], other.at[i]));
        Self { at, ..self }
    }

    /// From here (0) to another of the same kind (1), and beyond.
    pub(super) fn towards(self, other: Self, share: f64) -> Self {
        self.with(other, |a, b| a + (b - a) * share)
    }

    /// How long it is as a vector.
    pub(super) fn length(self) -> f64 {
        DVec4::from_array(self.at).length()
    }

    pub(super) fn distance(self, other: Self) -> f64 {
        self.with(other, |a, b| a - b).length()
    }
}
