//! Why a curve could not be made or changed.

use thiserror::Error;

/// Why a curve could not be made or changed. Indices count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum SplineError {
    /// No points at all.
    #[error("a curve needs at least one point; add one")]
    Empty,
    /// A coordinate, parameter or coefficient is NaN or infinite.
    #[error("item {at} is not a finite number; correct it or leave it out")]
    NotFinite {
        /// Index of the first offender.
        at: usize,
    },
    /// An order of 0 or 1 makes no curve of several points.
    #[error("an order of at least 2 is needed for {points} points, {order} was asked for")]
    OrderTooSmall {
        /// The order asked for.
        order: usize,
        /// How many points there are.
        points: usize,
    },
    /// Parameters must grow strictly.
    #[error("parameter {at} is not above the one before it; parameters must increase strictly")]
    NotIncreasing {
        /// Index of the first parameter that fails.
        at: usize,
    },
    /// As many parameters as points are needed.
    #[error("{parameters} parameters were given for {points} points; give one for each point")]
    Lengths {
        /// How many parameters came.
        parameters: usize,
        /// How many points came.
        points: usize,
    },
    /// There is no such point.
    #[error("there is no point {index}; the curve has {count}, counted from 0")]
    NoSuchPoint {
        /// The index asked for.
        index: usize,
        /// How many there are.
        count: usize,
    },
}
