//! The doctor: what is wrong with a bus of servos, where, what it costs, and what to do.
//!
//! *Knows* what can be wrong ([`Kind`]), how to look ([`examine`]) and how to judge what was seen ([`judge`]).
//! *Must not know* who asks, nor show anything. Looking changes nothing on the bus: no torque, no setting.
//! *Start reading* at [`Seen`], which is all that a judgement is made from.

mod cost;
mod examine;
mod facts;
mod finding;
mod judge;
mod kind;

pub use examine::{About, examine};
pub use facts::{Expected, Joint, Patient, Seen, Stray};
pub use finding::{Finding, Fix};
pub use judge::judge;
pub use kind::Kind;

#[cfg(test)]
mod tests;
