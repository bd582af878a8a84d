//! From a dial's byte to the servo's packet, in ticks of the simulated rig.
//!
//! The puppet follows the figure; a dial twists a link. Ticks are counted from the step in which the rig hears the
//! dial to the one in which it sends another goal.

use super::tokens::events;
use anyhow::Context;
use bench::{World, WorldOptions};
use rig::{Command, NetworkEdit, PuppetCommand, PuppetState, Snapshot, Touch};
use std::path::PathBuf;

/// The puppet that has joints for the figure's links.
const PUPPET: &str = "marionette";
/// The dial, and what it drives: 90 degrees of twist a turn.
const NETWORK: &str = "measured := F:MULC; SEND 90 TO <2>measured; CONNECT DIALS<8>:<1>measured; \
                       CONNECT measured<1>:<5>POSE;";
/// Longest time for each thing that must happen, virtual seconds.
const LIMIT_SECS: f64 = 60.0;
/// Ticks without a new goal before the figure counts as reached.
const STILL_TICKS: usize = 100;
/// Ticks in which the packet must come.
const TICKS_MAX: u32 = 100;

/// Ticks from byte to packet.
pub(super) fn ticks() -> anyhow::Result<u32> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shows/salute");
    let mut options = WorldOptions::new(rig::document::load(&folder)?.show);
    options.equipment.puppet = Some(PUPPET.to_owned());
    let mut world = World::new(options)?;
    let device = world
        .run_until("the dial box reports", LIMIT_SECS, |seen, _| {
            seen.desk.simulated_device.is_some()
                && seen
                    .devices
                    .iter()
                    .all(|d| d.health == rig::DeviceHealth::Present)
        })?
        .desk
        .simulated_device
        .clone()
        .context("no dial box")?;
    world.step([
        Command::Network(NetworkEdit::Commands(NETWORK.to_owned())),
        Command::Puppet(PuppetCommand::Arm),
    ]);
    world.run_until("the puppet is armed", LIMIT_SECS, |seen, _| {
        state(seen) == Some(PuppetState::Holding)
    })?;
    world.step([Command::Puppet(PuppetCommand::Follow)]);
    let mut still = (Vec::new(), 0);
    world.run_until("the puppet has reached the figure", LIMIT_SECS, |seen, _| {
        let goals = goals(seen);
        still = if goals == still.0 {
            (goals, still.1 + 1)
        } else {
            (goals, 0)
        };
        still.1 > STILL_TICKS
    })?;
    let (before, heard) = (goals(world.seen()), events(world.seen()));
    let touch = Touch::Dial {
        control: 7,
        turns: 0.25,
    };
    world.step([Command::Touch { device, touch }]);
    let mut heard_at = None;
    for tick in 0..TICKS_MAX {
        if events(world.seen()) > heard {
            heard_at.get_or_insert(tick);
        }
        if goals(world.seen()) != before {
            let heard_at = heard_at.context("a goal changed before anything was heard")?;
            return Ok(tick - heard_at);
        }
        world.step([]);
    }
    anyhow::bail!("no goal changed within {TICKS_MAX} ticks of a turned dial")
}

fn state(seen: &Snapshot) -> Option<PuppetState> {
    seen.puppet.as_ref().map(|puppet| puppet.state)
}

fn goals(seen: &Snapshot) -> Vec<Option<u64>> {
    let joints = seen.puppet.iter().flat_map(|puppet| &puppet.joints);
    joints.map(|joint| joint.goal_rad.map(f64::to_bits)).collect()
}
