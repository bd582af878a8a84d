//! Servos on a bus: the only part of the program that can write a goal.
//!
//! Knows: packets ([`framing`]), control tables by name ([`register`]), the limits every goal passes
//! ([`limit`]), and one bus of servos as a whole ([`bus`]). Must not know: clips, figures, or why anybody
//! wants a pose. Angles are the joint's, in radians; counts exist only between [`member`] and the wire.
//!
//! Start at [`Bus`]. Taking servos apart, addressing them and reading registers is [`Maintenance`], which
//! cannot write goals.

pub mod bus;
pub mod calibrate;
pub mod doctor;
pub mod framing;
pub mod freshness;
pub mod limit;
pub mod maintenance;
pub mod member;
pub mod register;

mod arming;
mod ask;
mod block;
mod blocking;
mod company;
mod cycle;
mod event;
mod fast;
mod gather;
mod health;
mod jerk;
mod line;
mod owed;
mod release;
mod settings;
mod slot;
mod table;
mod tempo;
mod turns;
mod unseen;
mod writes;

pub use arming::{Refusal, Why};
pub use bus::{Bus, BusError};
pub use event::{Armed, BusCounters, BusEvent, Commanded, Goal, Intervention, Presence};
pub use limit::{Change, Limits, LimitsError};
pub use maintenance::{Found, Heard, Maintenance, MaintenanceError};
pub use member::{Load, Member, MemberError, Reading, Supply};
pub use settings::{BusSettings, Readings};
