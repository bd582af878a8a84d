//! Programs, messages and whole sessions made of numbers, and what must hold for each of them.
//!
//! The same numbers always make the same: property tests throw them as dice, the fuzzer mutates them as bytes.
//! Nothing here knows either, so that both check the same laws.

pub(crate) mod commands;
pub(crate) mod edits;
pub(crate) mod laws;
pub(crate) mod session;

/// Numbers to choose with.
pub(crate) type Dice = [u8; 6];

/// Chooses one of several.
pub(crate) fn pick<'a, T: ?Sized>(from: &[&'a T], die: u8) -> &'a T {
    from[usize::from(die) % from.len()]
}
