//! What travels on the wires of a function network: one typed value a message.
//!
//! Apart from the network because the command language writes values as literals
//! and display nodes receive them, and neither knows of queues.
//! Source: the message types of the PS 300 (`docs/protocols/ps300.md`, section "Message types").

use std::fmt;
use std::ops::BitOr;
use std::sync::Arc;

use glam::{DAffine3, DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};

use crate::language::VectorList;
use crate::pick::Pick;

/// Content that messages share. It knows no weak references, so that whoever holds the only one finds that out
/// without an atomic operation and puts new content in the same place.
pub use triomphe::Arc as Shared;

/// One message. Matrices act on column vectors; their literals are written row by row. What is larger than
/// three numbers is shared, so that a message is small wherever it waits and copies cost the same.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `TRUE` or `FALSE`.
    Boolean(bool),
    /// `FIX(n)`.
    Integer(i32),
    /// A bare number. Literals are always finite.
    Real(f64),
    /// Quoted text. A PS 300 packet is bytes; `CHAR(n)` up to 255 becomes the character of that code.
    String(Arc<str>),
    /// `V2D(x,y)`.
    Vector2(DVec2),
    /// `V3D(x,y,z)`.
    Vector3(DVec3),
    /// `V4D(x,y,z,w)`.
    Vector4(Shared<DVec4>),
    /// `M2D(…)`, two rows of two.
    Matrix2(Shared<DMat2>),
    /// `M3D(…)`, three rows of three.
    Matrix3(Shared<DMat3>),
    /// `M4D(…)`, four rows of four.
    Matrix4(Shared<DMat4>),
    /// Three rows of four, the kind LOOKAT makes: a linear part and, as last column, a translation.
    Matrix4x3(Shared<DAffine3>),
    /// `VL(name)`: the vectors of a list, as it is when the command is executed.
    Vectors(Arc<VectorList>),
    /// What PICK found, nearest first; no literal.
    Picks(Arc<[Pick]>),
}

impl Value {
    /// Becomes equal to `other` without sharing with it: what is written over again and again costs less so.
    #[inline]
    pub(crate) fn take_over(&mut self, other: &Self) {
        match (&mut *self, other) {
            (Self::Matrix3(mine), Self::Matrix3(content)) => written_over(mine, content),
            (Self::Matrix4(mine), Self::Matrix4(content)) => written_over(mine, content),
            (Self::Matrix4x3(mine), Self::Matrix4x3(content)) => written_over(mine, content),
            (Self::Vector3(mine), Self::Vector3(v)) => *mine = *v,
            (Self::Real(mine), Self::Real(x)) => *mine = *x,
            _ => self.clone_from(other),
        }
    }

    /// The kind of this value; ports accept or refuse by it.
    pub fn kind(&self) -> Kind {
        match self {
            Self::Boolean(_) => Kind::Boolean,
            Self::Integer(_) => Kind::Integer,
            Self::Real(_) => Kind::Real,
            Self::String(_) => Kind::String,
            Self::Vector2(_) => Kind::Vector2,
            Self::Vector3(_) => Kind::Vector3,
            Self::Vector4(_) => Kind::Vector4,
            Self::Matrix2(_) => Kind::Matrix2,
            Self::Matrix3(_) => Kind::Matrix3,
            Self::Matrix4(_) => Kind::Matrix4,
            Self::Matrix4x3(_) => Kind::Matrix4x3,
            Self::Vectors(_) => Kind::Vectors,
            Self::Picks(_) => Kind::Picks,
        }
    }

    /// The number in an integer or a real, integers promoted; nothing for other kinds.
    pub fn as_number(&self) -> Option<f64> {
        match self {
            Self::Integer(n) => Some(f64::from(*n)),
            Self::Real(x) => Some(*x),
            _ => None,
        }
    }

    /// False where any component is infinite or not a number.
    pub fn is_finite(&self) -> bool {
        match self {
            // Lists are checked where they are made: by the parser, by nodes and by PICK.
            Self::Boolean(_) | Self::Integer(_) | Self::String(_) | Self::Vectors(_) | Self::Picks(_) => true,
            Self::Real(x) => x.is_finite(),
            Self::Vector2(v) => v.is_finite(),
            Self::Vector3(v) => v.is_finite(),
            Self::Vector4(v) => v.is_finite(),
            Self::Matrix2(m) => m.is_finite(),
            Self::Matrix3(m) => m.is_finite(),
            Self::Matrix4(m) => m.is_finite(),
            Self::Matrix4x3(m) => m.is_finite(),
        }
    }
}

/// The type of a value, without the value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(
    missing_docs,
    reason = "each is the kind of the `Value` variant of the same name"
)]
pub enum Kind {
    Boolean,
    Integer,
    Real,
    String,
    Vector2,
    Vector3,
    Vector4,
    Matrix2,
    Matrix3,
    Matrix4,
    Matrix4x3,
    Vectors,
    Picks,
}

impl Kind {
    /// Every kind, in the order listings use.
    pub const ALL: [Self; 13] = [
        Self::Boolean,
        Self::Integer,
        Self::Real,
        Self::String,
        Self::Vector2,
        Self::Vector3,
        Self::Vector4,
        Self::Matrix2,
        Self::Matrix3,
        Self::Matrix4,
        Self::Matrix4x3,
        Self::Vectors,
        Self::Picks,
    ];

    /// The word used in messages and in the command line's JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Boolean => "boolean",
            Self::Integer => "integer",
            Self::Real => "real",
            Self::String => "string",
            Self::Vector2 => "vector2",
            Self::Vector3 => "vector3",
            Self::Vector4 => "vector4",
            Self::Matrix2 => "matrix2",
            Self::Matrix3 => "matrix3",
            Self::Matrix4 => "matrix4",
            Self::Matrix4x3 => "matrix4x3",
            Self::Vectors => "vectors",
            Self::Picks => "picks",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A set of kinds, for ports that take several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kinds(u16);

impl Kinds {
    /// No kind: an output that never sends.
    pub const NONE: Self = Self(0);
    /// Every kind: triggers, NOP, the values of switches.
    pub const ANY: Self = Self::of(&Kind::ALL);
    /// Boolean only.
    pub const BOOLEAN: Self = Self::of(&[Kind::Boolean]);
    /// Integer only.
    pub const INTEGER: Self = Self::of(&[Kind::Integer]);
    /// Real only; see [`Kinds::NUMBER`] for ports that promote integers.
    pub const REAL: Self = Self::of(&[Kind::Real]);
    /// Integer or real.
    pub const NUMBER: Self = Self::of(&[Kind::Integer, Kind::Real]);
    /// Text only.
    pub const STRING: Self = Self::of(&[Kind::String]);
    /// Vectors of two, three or four components.
    pub const VECTOR: Self = Self::of(&[Kind::Vector2, Kind::Vector3, Kind::Vector4]);
    /// Square matrices and the 4x3.
    pub const MATRIX: Self = Self::of(&[Kind::Matrix2, Kind::Matrix3, Kind::Matrix4, Kind::Matrix4x3]);

    /// The set of exactly these kinds; usable in constants.
    pub const fn of(kinds: &[Kind]) -> Self {
        let mut bits = 0;
        let mut index = 0;
        while index < kinds.len() {
            bits |= 1 << kinds[index] as u16;
            index += 1;
        }
        Self(bits)
    }

    /// The kinds in either set; usable in constants where `|` is not.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether `kind` is in the set.
    pub const fn has(self, kind: Kind) -> bool {
        self.0 & (1 << kind as u16) != 0
    }

    /// Whether the sets share a kind; a connection between ports that share none could never carry anything.
    pub const fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether the set is empty.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The kinds in the set, in the order of [`Kind::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Kind> {
        Kind::ALL.into_iter().filter(move |&kind| self.has(kind))
    }
}

impl From<Kind> for Kinds {
    fn from(kind: Kind) -> Self {
        Self::of(&[kind])
    }
}

impl BitOr for Kinds {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        self.or(other)
    }
}

/// As read aloud in an error: `integer or real`, `any kind`, `nothing`.
impl fmt::Display for Kinds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::ANY {
            return f.write_str("any kind");
        }
        if self.is_empty() {
            return f.write_str("nothing");
        }
        for (index, kind) in self.iter().enumerate() {
            if index > 0 {
                f.write_str(" or ")?;
            }
            f.write_str(kind.name())?;
        }
        Ok(())
    }
}

fn written_over<T: Copy>(mine: &mut Shared<T>, other: &Shared<T>) {
    match Shared::get_mut(mine) {
        Some(mine) => *mine = **other,
        None => *mine = Shared::new(**other),
    }
}

macro_rules! values_from {
    ($($from:ty => $variant:ident),* $(,)?) => {
        $(impl From<$from> for Value {
            fn from(value: $from) -> Self {
                Self::$variant(value)
            }
        })*
    };
}
values_from!(bool => Boolean, i32 => Integer, f64 => Real, DVec2 => Vector2, DVec3 => Vector3);

macro_rules! shared_values_from {
    ($($from:ty => $variant:ident),* $(,)?) => {
        $(impl From<$from> for Value {
            fn from(value: $from) -> Self {
                Self::$variant(Shared::new(value))
            }
        })*
    };
}
shared_values_from!(DVec4 => Vector4, DMat2 => Matrix2, DMat3 => Matrix3, DMat4 => Matrix4, DAffine3 => Matrix4x3);

impl From<VectorList> for Value {
    fn from(list: VectorList) -> Self {
        Self::Vectors(Arc::new(list))
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::String(text.into())
    }
}
