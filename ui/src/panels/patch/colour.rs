//! The colour of each kind of message. Beside the theme's three accents, and far from all of them: these say what
//! flows, never that something is selected, live or faulty.

use ps300::{Kind, Kinds};

use crate::patch::token;
use crate::render::theme::{self, Rgb};

const BOOLEAN: Rgb = Rgb(0xd6, 0xc9, 0xae);
const INTEGER: Rgb = Rgb(0x6d, 0x9e, 0xeb);
const REAL: Rgb = Rgb(0x93, 0xc9, 0xf3);
const TEXT: Rgb = Rgb(0xb4, 0xcf, 0x6a);
const VECTOR: Rgb = Rgb(0xe6, 0x8f, 0xbe);
const MATRIX: Rgb = Rgb(0xa9, 0x91, 0xf5);
const LIST: Rgb = Rgb(0x8a, 0xb0, 0xa0);

/// Of one kind.
pub(super) fn of(kind: Kind) -> Rgb {
    match kind {
        Kind::Boolean => BOOLEAN,
        Kind::Integer => INTEGER,
        Kind::Real => REAL,
        Kind::String => TEXT,
        Kind::Vector2 | Kind::Vector3 | Kind::Vector4 => VECTOR,
        Kind::Matrix2 | Kind::Matrix3 | Kind::Matrix4 | Kind::Matrix4x3 => MATRIX,
        Kind::Vectors | Kind::Picks => LIST,
    }
}

/// Of a port; grey where it may be anything.
pub(super) fn of_port(kinds: Kinds) -> Rgb {
    let inside = |set: Kinds| !kinds.is_empty() && kinds.iter().all(|kind| set.has(kind));
    if inside(Kinds::VECTOR) {
        VECTOR
    } else if inside(Kinds::MATRIX) {
        MATRIX
    } else {
        token::colour_kind(kinds).map_or(theme::DIM, of)
    }
}
