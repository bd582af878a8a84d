//! Servos on one half-duplex wire.
//!
//! `bus` orders what happens on the wire and hands instructions to servos; `wire` carries bytes at their
//! pace; `receiver` finds packets; `packet` and `crc` are the framing; `servo` is one servo, made of its
//! `table`, its `goal`, its `motion` along a `trajectory`, its `plant` and the protection of its `hardware`; `execute` and
//! `write` are what an instruction does to it; `fault` is what may go wrong, `fault_run` when, `trouble` what it
//! does to a servo; `beside` is what a person at the bench can do. Source: `docs/protocols/dynamixel2.md` (the maker's protocol page and control tables).

mod beside;
mod bus;
mod chain;
mod crc;
mod dispatch;
mod execute;
mod fault;
mod fault_run;
mod goal;
mod hardware;
mod motion;
mod packet;
mod plant;
mod receiver;
mod refresh;
mod servo;
mod table;
mod trajectory;
mod trouble;
mod unit;
mod wire;
mod witness;
mod write;

pub use bus::{AddError, BusOptions, ServoBus, StatusSent};
pub use chain::Absent;
pub use fault::{BusFault, Fault, FaultError, FaultKind, ServoFault};
pub use plant::{Hand, PlantKind};
pub use receiver::{BadCrc, InnerHeader};
pub use servo::Servo;
pub use unit::{Counters, Gaps, Sag, Unit};
pub use wire::{Adapter, WireTime};

#[cfg(test)]
mod tests;
