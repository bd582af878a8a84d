//! The only loop that can move a motor.
//!
//! Knows: which joint sits on which bus ([`Puppet`]), what may be asked ([`Order`]) and when ([`State`]), how to
//! get from wherever the puppet is to where a clip begins, and when to stop by itself ([`Fault`]). Must not know:
//! networks, shows, windows or knobs, so that none of them can reach the servos or keep this loop waiting.
//! The limits of speed, acceleration and range are not here but in `device::servo`, below every goal.
//!
//! Start at [`Player::tick`].
#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::indexing_slicing,
        clippy::panic,
        clippy::expect_used,
        clippy::unreachable
    )
)]

mod approach;
mod config;
mod fault;
mod following;
mod hear;
mod joints;
pub mod lag;
mod obey;
mod order;
mod playback;
mod player;
mod playing;
mod policy;
mod puppet;
mod report;
mod run;
mod trouble;
mod watch;

pub use config::{Ending, PlayerConfig};
pub use fault::{Fault, Place};
pub use lag::Tracking;
pub use order::{Order, Rejection};
pub use player::{Player, State};
pub use puppet::{Puppet, PuppetBus, PuppetError, Seat};
pub use report::{Interventions, JointReport, Phase, Report};
pub use run::{Operator, run};
pub use trouble::Trouble;
