//! The shipped networks, run as a reader of their pages runs them.

mod dials;
mod firing;
mod mirror;
mod objects;
mod pages;
mod record;
mod session;
