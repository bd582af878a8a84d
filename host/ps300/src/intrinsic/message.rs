//! What can be sent, and how it becomes the message an output sent last.
//!
//! A dial that turns an object sends matrices for as long as it turns: each is written over the one before, unless
//! somebody still holds that.

use std::sync::Arc;

use glam::{DAffine3, DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};

use crate::language::VectorList;
use crate::value::{Shared, Value};

/// What can be sent.
pub trait Message {
    /// False where any component is infinite or not a number.
    fn is_finite(&self) -> bool;

    /// Puts it where the message before it is, or nothing.
    fn put(self, place: &mut Option<Value>);

    /// The message by itself.
    fn into_value(self) -> Value;
}

macro_rules! small_messages {
    ($($small:ty => $variant:ident if $finite:expr),* $(,)?) => {
        $(impl Message for $small {
            #[inline]
            fn is_finite(&self) -> bool {
                $finite(self)
            }

            #[inline]
            fn put(self, place: &mut Option<Value>) {
                if let Some(Value::$variant(before)) = place {
                    *before = self;
                } else {
                    *place = Some(Value::$variant(self));
                }
            }

            #[inline]
            fn into_value(self) -> Value {
                Value::$variant(self)
            }
        })*
    };
}
small_messages!(bool => Boolean if |_| true, i32 => Integer if |_| true, f64 => Real if |x: &f64| (*x).is_finite(),
    DVec2 => Vector2 if |v: &DVec2| (*v).is_finite(), DVec3 => Vector3 if |v: &DVec3| (*v).is_finite());

macro_rules! large_messages {
    ($($large:ty => $variant:ident),* $(,)?) => {
        $(impl Message for $large {
            #[inline]
            fn is_finite(&self) -> bool {
                (*self).is_finite()
            }

            #[inline]
            fn put(self, place: &mut Option<Value>) {
                if let Some(Value::$variant(before)) = place
                    && let Some(before) = Shared::get_mut(before)
                {
                    *before = self;
                } else {
                    *place = Some(self.into());
                }
            }

            fn into_value(self) -> Value {
                self.into()
            }
        })*
    };
}
large_messages!(DVec4 => Vector4, DMat2 => Matrix2, DMat3 => Matrix3, DMat4 => Matrix4, DAffine3 => Matrix4x3);

macro_rules! worded_messages {
    ($($words:ty),* $(,)?) => {
        $(impl Message for $words {
            fn is_finite(&self) -> bool {
                true
            }

            fn put(self, place: &mut Option<Value>) {
                *place = Some(self.into());
            }

            fn into_value(self) -> Value {
                self.into()
            }
        })*
    };
}
// Lists are checked where they are made.
worded_messages!(&str, Arc<str>, VectorList);

impl Message for Value {
    fn is_finite(&self) -> bool {
        Value::is_finite(self)
    }

    /// Where the small kinds agree there is nothing to drop.
    #[inline]
    fn put(self, place: &mut Option<Value>) {
        match (&self, place) {
            (Self::Real(x), Some(Self::Real(place))) => *place = *x,
            (Self::Integer(n), Some(Self::Integer(place))) => *place = *n,
            (Self::Boolean(b), Some(Self::Boolean(place))) => *place = *b,
            (Self::Vector2(v), Some(Self::Vector2(place))) => *place = *v,
            (Self::Vector3(v), Some(Self::Vector3(place))) => *place = *v,
            (_, place) => *place = Some(self),
        }
    }

    fn into_value(self) -> Value {
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_used_again_unless_somebody_holds_it() {
        let mut last = None;
        let at = |last: &Option<Value>| match last {
            Some(Value::Matrix3(place)) => Shared::as_ptr(place),
            other => panic!("{other:?}"),
        };
        DMat3::IDENTITY.put(&mut last);
        let first = at(&last);
        DMat3::ZERO.put(&mut last);
        assert_eq!(at(&last), first);
        let held = last.clone();
        DMat3::IDENTITY.put(&mut last);
        assert_ne!(at(&last), first);
        assert_eq!(held, Some(DMat3::ZERO.into()));
        assert_eq!(last, Some(DMat3::IDENTITY.into()));
    }

    #[test]
    fn what_an_output_sends_may_change_its_kind() {
        let mut last = None;
        for value in [
            Value::from(1.0),
            DMat2::IDENTITY.into(),
            DVec3::X.into(),
            "a".into(),
            true.into(),
        ] {
            value.clone().put(&mut last);
            assert_eq!(last, Some(value));
        }
        DMat4::IDENTITY.put(&mut last);
        assert_eq!(last, Some(DMat4::IDENTITY.into()));
        2.5.put(&mut last);
        assert_eq!(last, Some(2.5.into()));
    }
}
