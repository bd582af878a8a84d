//! A message on its way: any value, or a real number known to be one.
//!
//! Delivery is written once for both. For a real number the checks of kind, the copies and the drops of what a
//! value may own come to nothing.

use crate::intrinsic::Message;
use crate::value::{Kind, Value};

pub(super) trait Token: Message {
    fn kind(&self) -> Kind;

    fn value(&self) -> Value;

    /// Puts a copy where nothing is.
    fn copy_to(&self, into: &mut Option<Value>);
}

impl Token for f64 {
    #[inline]
    fn kind(&self) -> Kind {
        Kind::Real
    }

    #[inline]
    fn value(&self) -> Value {
        Value::Real(*self)
    }

    #[inline]
    fn copy_to(&self, into: &mut Option<Value>) {
        std::mem::forget(into.replace(Value::Real(*self))); // There was nothing to drop.
    }
}

impl Token for Value {
    #[inline]
    fn kind(&self) -> Kind {
        Value::kind(self)
    }

    #[inline]
    fn value(&self) -> Value {
        self.clone()
    }

    /// The small kinds are named so that they are copied and no more.
    #[inline]
    fn copy_to(&self, into: &mut Option<Value>) {
        let copy = match self {
            Self::Real(x) => Self::Real(*x),
            Self::Integer(n) => Self::Integer(*n),
            Self::Boolean(b) => Self::Boolean(*b),
            Self::Vector3(v) => Self::Vector3(*v),
            Self::Vector2(v) => Self::Vector2(*v),
            large => large.clone(),
        };
        std::mem::forget(into.replace(copy)); // There was nothing to drop.
    }
}
