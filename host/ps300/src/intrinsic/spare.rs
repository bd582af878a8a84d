//! Memory of large messages nobody holds any more, to be used for the next ones.
//!
//! A dial that turns an object sends matrices for as long as it turns. One of each kind is kept: the message an
//! output sent last gives its place to the next.

use std::sync::Arc;

use glam::{DAffine3, DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};

use crate::language::VectorList;
use crate::value::Value;

/// One spare place for each kind of message that has its place apart.
#[derive(Default)]
pub struct Spares {
    vector4: Option<Arc<DVec4>>,
    matrix2: Option<Arc<DMat2>>,
    matrix3: Option<Arc<DMat3>>,
    matrix4: Option<Arc<DMat4>>,
    matrix4x3: Option<Arc<DAffine3>>,
}

impl Spares {
    /// Takes the place of a message that is to be dropped.
    #[inline]
    pub(crate) fn keep(&mut self, value: &mut Value) {
        match value {
            Value::Real(_)
            | Value::Integer(_)
            | Value::Boolean(_)
            | Value::Vector2(_)
            | Value::Vector3(_) => {}
            large => self.keep_large(large),
        }
    }

    fn keep_large(&mut self, value: &mut Value) {
        match std::mem::replace(value, Value::Boolean(false)) {
            Value::Vector4(place) => self.vector4 = Some(place),
            Value::Matrix2(place) => self.matrix2 = Some(place),
            Value::Matrix3(place) => self.matrix3 = Some(place),
            Value::Matrix4(place) => self.matrix4 = Some(place),
            Value::Matrix4x3(place) => self.matrix4x3 = Some(place),
            _ => {}
        }
    }
}

/// What can be sent.
pub trait Message {
    /// As a message, in a spare place if it needs one.
    fn into_message(self, spares: &mut Spares) -> Value;
}

macro_rules! messages {
    ($($small:ty),* $(,)?) => {
        $(impl Message for $small {
            fn into_message(self, _: &mut Spares) -> Value {
                self.into()
            }
        })*
    };
}
messages!(bool, i32, f64, DVec2, DVec3, &str, Arc<str>, VectorList, Value);

macro_rules! large_messages {
    ($($large:ty => $variant:ident from $spare:ident),* $(,)?) => {
        $(impl Message for $large {
            fn into_message(self, spares: &mut Spares) -> Value {
                Value::$variant(placed(self, spares.$spare.take()))
            }
        })*
    };
}
large_messages!(DVec4 => Vector4 from vector4, DMat2 => Matrix2 from matrix2, DMat3 => Matrix3 from matrix3,
    DMat4 => Matrix4 from matrix4, DAffine3 => Matrix4x3 from matrix4x3);

fn placed<T>(content: T, spare: Option<Arc<T>>) -> Arc<T> {
    if let Some(mut spare) = spare
        && let Some(place) = Arc::get_mut(&mut spare)
    {
        *place = content;
        return spare;
    }
    Arc::new(content)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_used_again_unless_somebody_holds_it() {
        let mut spares = Spares::default();
        let mut first = DMat3::IDENTITY.into_message(&mut spares);
        let Value::Matrix3(place) = &first else {
            panic!("{first:?}")
        };
        let at = Arc::as_ptr(place);
        spares.keep(&mut first);
        let mut second = DMat3::ZERO.into_message(&mut spares);
        assert!(
            matches!(&second, Value::Matrix3(place) if Arc::as_ptr(place) == at && **place == DMat3::ZERO)
        );
        let held = second.clone();
        spares.keep(&mut second);
        let third = DMat3::NAN.into_message(&mut spares);
        assert!(matches!(&third, Value::Matrix3(place) if Arc::as_ptr(place) != at));
        assert_eq!(held, Value::from(DMat3::ZERO));
    }
}
