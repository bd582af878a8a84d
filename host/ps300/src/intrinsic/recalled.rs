//! Reading back what a function remembered.
//!
//! Apart from the functions because a state comes from text that anybody may have written: each value is
//! checked for its kind, and nothing may be missing or left over.

use super::components::Point;
use super::function::TEXT_MAX_BYTES;
use crate::value::{Kind, Value};

/// A state, read value by value.
pub(super) struct Recalled<'a> {
    rest: &'a [Value],
}

/// Makes `place` what `read` finds in `state`, or `new` where that is empty. False, and no change, where
/// it does not fit.
pub(super) fn restore<'a, T>(
    place: &mut T,
    new: T,
    state: &'a [Value],
    read: impl FnOnce(&mut Recalled<'a>) -> Option<T>,
) -> bool {
    let mut recalled = Recalled { rest: state };
    let found = if state.is_empty() {
        Some(new)
    } else {
        read(&mut recalled).filter(|_| recalled.rest.is_empty())
    };
    found.map(|found| *place = found).is_some()
}

/// [`Function`](super::function::Function)'s two methods of state where one value that may be absent is all
/// that is remembered: its field, the kind it is written as, and how it is read.
macro_rules! remembers_one {
    ($field:ident, $kind:ident, $read:ident) => {
        fn remembered(&self) -> Vec<crate::value::Value> {
            self.$field
                .map(crate::value::Value::$kind)
                .into_iter()
                .collect()
        }

        fn recall(&mut self, state: &[crate::value::Value]) -> bool {
            crate::intrinsic::recalled::restore(&mut self.$field, None, state, |state| {
                state.$read().map(Some)
            })
        }
    };
}
pub(super) use remembers_one;

/// A real that may be absent, as one value of a state; see [`Recalled::optional`].
pub(super) fn optional(real: Option<f64>) -> Value {
    real.map_or(Value::Boolean(false), Value::Real)
}

impl<'a> Recalled<'a> {
    /// The next value, of any kind a message can have.
    pub(super) fn value(&mut self) -> Option<&'a Value> {
        let (first, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(first).filter(|value| value.is_finite())
    }

    /// The next value, of a kind that has a literal.
    pub(super) fn written(&mut self) -> Option<&'a Value> {
        self.value()
            .filter(|value| !matches!(value, Value::Vectors(_) | Value::Picks(_)))
    }

    /// How many values are left.
    pub(super) fn left(&self) -> usize {
        self.rest.len()
    }

    pub(super) fn real(&mut self) -> Option<f64> {
        match self.value()? {
            Value::Real(x) => Some(*x),
            _ => None,
        }
    }

    pub(super) fn integer(&mut self) -> Option<i32> {
        match self.value()? {
            Value::Integer(n) => Some(*n),
            _ => None,
        }
    }

    pub(super) fn boolean(&mut self) -> Option<bool> {
        match self.value()? {
            Value::Boolean(b) => Some(*b),
            _ => None,
        }
    }

    /// Text no longer than what travels.
    pub(super) fn text(&mut self) -> Option<String> {
        match self.value()? {
            Value::String(text) if text.len() <= TEXT_MAX_BYTES => Some(text.to_string()),
            _ => None,
        }
    }

    /// A count that may be too large for an integer, kept as a real.
    pub(super) fn count(&mut self) -> Option<u64> {
        /// Reals are exact up to here.
        const EXACT_MAX: f64 = 9_007_199_254_740_992.0;
        let count = self.real()?;
        let whole = count.fract() == 0.0 && (0.0..=EXACT_MAX).contains(&count);
        whole.then_some(count as u64)
    }

    /// A real, or nothing where FALSE stands for one; put where it belongs.
    pub(super) fn optional(&mut self, place: &mut Option<f64>) -> Option<()> {
        *place = match self.value()? {
            Value::Boolean(false) => None,
            Value::Real(x) => Some(*x),
            _ => return None,
        };
        Some(())
    }

    /// A number or vector.
    pub(super) fn point(&mut self) -> Option<Point> {
        let value = self.value()?;
        Point::read(value).filter(|_| value.kind() != Kind::Integer)
    }

    /// All that is left, as reals.
    pub(super) fn reals<C: FromIterator<f64>>(&mut self) -> Option<C> {
        std::iter::from_fn(|| (self.left() > 0).then(|| self.real())).collect()
    }
}
