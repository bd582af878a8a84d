//! The shipped networks, run as a reader of their pages runs them.

mod dials;
mod firing;
mod hands;
mod inking;
mod mirror;
mod objects;
mod pages;
mod patched;
mod paths;
mod pickup_banks;
mod pictures;
mod posing;
mod record;
mod session;
mod shipped;
