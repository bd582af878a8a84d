//! Calibrating a joint: from the counts it went through while a hand moved it to a zero, a sign, a range, limits and,
//! where the family allows it, a homing offset that puts the count's jump outside the travel.
//!
//! *Knows* counts and the two families' rules for where a count jumps. *Must not know* buses or files: whoever
//! sweeps feeds [`Sweep`], whoever writes takes [`Plan`].
//! *Start reading* at [`plan`].

mod plan;
mod sweep;

pub use plan::{Bearings, Plan, Refusal, Wish, plan};
pub use sweep::Sweep;

#[cfg(test)]
mod tests;
