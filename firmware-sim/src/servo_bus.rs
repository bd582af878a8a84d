//! Servos on one half-duplex wire: DYNAMIXEL with protocol 2.0 or 1.0, Feetech STS and SCS, in any mixture.
//!
//! `bus` orders what happens on the wire; `wire` carries bytes at their pace; the two ways to put a packet together,
//! `dynamixel2` and `summed`, find packets and say what they ask for (`heard`); `dispatch` hands that to servos and
//! `chain` lets them answer in turn; `servo` is one servo, made of its `table` with the registers it works with
//! (`reg`, `coding`), its `goal`, its `motion` along a `trajectory`, its `plant` and the protection of its `hardware`;
//! `execute`, `write` and `effect` are what an order does to it; `fault` is what may go wrong, `fault_run` when,
//! `trouble` what it does to a servo; `beside` is what a person at the bench can do and `spoken` what
//! that person says. Source: `docs/protocols/` and
//! the profiles (the makers' protocol pages and control tables).

mod beside;
mod bus;
mod chain;
mod coding;
mod dispatch;
mod dynamixel2;
mod effect;
mod execute;
mod fault;
mod fault_run;
mod goal;
mod hardware;
mod heard;
mod motion;
mod plant;
mod refresh;
mod reg;
mod servo;
mod spoken;
mod summed;
mod table;
mod trajectory;
mod trouble;
mod unit;
mod wire;
mod witness;
mod write;

pub use bus::{AddError, BusOptions, ServoBus, StatusSent};
pub use chain::Absent;
pub use dynamixel2::receiver::{BadCrc, InnerHeader};
pub use fault::{BusFault, Fault, FaultError, FaultKind, ServoFault};
pub use plant::{Hand, PlantKind};
pub use servo::Servo;
pub use spoken::Spoken;
pub use unit::{Counters, Gaps, Precedence, Sag, Unit};
pub use wire::{Adapter, WireTime};

#[cfg(test)]
mod tests;
