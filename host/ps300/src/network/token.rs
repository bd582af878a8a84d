//! A message on its way: any value, or a real number known to be one.
//!
//! Delivery is written once for both. For a real number the checks of kind, the copies and the drops of what a
//! value may own come to nothing.

use crate::value::{Kind, Value};

pub(super) trait Token {
    fn kind(&self) -> Kind;

    fn is_finite(&self) -> bool;

    fn value(&self) -> Value;

    /// Shows it as a value.
    fn lend<R>(&self, to: impl FnOnce(&Value) -> R) -> R;

    /// Puts a copy where nothing is.
    fn put(&self, into: &mut Option<Value>);

    /// Leaves the message in a place for looking at. What was there may come back in its stead.
    fn leave(&mut self, in_place: &mut Option<Value>);
}

impl Token for f64 {
    #[inline]
    fn kind(&self) -> Kind {
        Kind::Real
    }

    #[inline]
    fn is_finite(&self) -> bool {
        f64::is_finite(*self)
    }

    #[inline]
    fn value(&self) -> Value {
        Value::Real(*self)
    }

    #[inline]
    fn lend<R>(&self, to: impl FnOnce(&Value) -> R) -> R {
        to(&Value::Real(*self))
    }

    #[inline]
    fn put(&self, into: &mut Option<Value>) {
        std::mem::forget(into.replace(Value::Real(*self))); // There was nothing to drop.
    }

    #[inline]
    fn leave(&mut self, in_place: &mut Option<Value>) {
        if let Some(Value::Real(x)) = in_place {
            *x = *self;
        } else {
            *in_place = Some(Value::Real(*self));
        }
    }
}

impl Token for Value {
    #[inline]
    fn kind(&self) -> Kind {
        Value::kind(self)
    }

    #[inline]
    fn is_finite(&self) -> bool {
        Value::is_finite(self)
    }

    #[inline]
    fn value(&self) -> Value {
        self.clone()
    }

    #[inline]
    fn lend<R>(&self, to: impl FnOnce(&Value) -> R) -> R {
        to(self)
    }

    /// The small kinds are named so that they are copied and no more.
    #[inline]
    fn put(&self, into: &mut Option<Value>) {
        *into = Some(match self {
            Self::Real(x) => Self::Real(*x),
            Self::Integer(n) => Self::Integer(*n),
            Self::Boolean(b) => Self::Boolean(*b),
            Self::Vector3(v) => Self::Vector3(*v),
            Self::Vector2(v) => Self::Vector2(*v),
            large => large.clone(),
        });
    }

    /// Where the kinds agree only what they carry is moved.
    #[inline]
    fn leave(&mut self, in_place: &mut Option<Value>) {
        match (self, in_place) {
            (Self::Real(x), Some(Self::Real(place))) => *place = *x,
            (Self::Integer(n), Some(Self::Integer(place))) => *place = *n,
            (Self::Boolean(b), Some(Self::Boolean(place))) => *place = *b,
            (Self::Vector2(v), Some(Self::Vector2(place))) => *place = *v,
            (Self::Vector3(v), Some(Self::Vector3(place))) => *place = *v,
            (Self::Matrix3(m), Some(Self::Matrix3(place))) => std::mem::swap(m, place),
            (Self::Matrix4(m), Some(Self::Matrix4(place))) => std::mem::swap(m, place),
            (message, Some(place)) => std::mem::swap(message, place),
            (message, place) => *place = Some(message.clone()),
        }
    }
}
