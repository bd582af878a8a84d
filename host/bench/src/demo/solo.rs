//! The story of a puppet without a figure: it performs a clip of its own joints twice, the second time with its lag
//! made up for.
//!
//! Nobody poses here, so nothing enters through dials; orders are the rig's commands, and everything from the player
//! down to the servos' bytes is as it always is.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use device_profiles::PuppetProfile;
use rig::{Command, PuppetCommand, PuppetState, Snapshot, TransportCommand};

use super::report::{DemoReport, LagReport};
use super::story::Told;
use super::watch::Watch;
use super::{Chapter, DemoError, Scene};
use crate::world::{Late, World};

/// How long what the rig does at once may take, seconds.
const PROMPT_SECS: f64 = 5.0;
/// The approach to the first pose and a slow survey are not counted by the clip's time, seconds.
const APPROACH_SECS: f64 = 20.0;
/// Where a puppet of any kind hangs at first: a third of the way up every range, which is no pose of any clip.
pub(super) fn hanging(profile: &PuppetProfile) -> BTreeMap<String, f64> {
    let third = |min: f64, max: f64| min + (max - min) / 3.0;
    profile
        .joints()
        .map(|joint| {
            let led = profile.coupling(&joint.name).and_then(|coupling| {
                let leads = profile.joint(&coupling.follows)?;
                Some(coupling.angle_rad(third(leads.min_rad, leads.max_rad)))
            });
            (
                joint.name.clone(),
                led.unwrap_or_else(|| third(joint.min_rad, joint.max_rad)),
            )
        })
        .collect()
}

/// How each joint followed in one performance.
type Followed = BTreeMap<String, Following>;

#[derive(Clone, Copy, Default)]
struct Following {
    behind_ms: Option<f64>,
    error_rms_rad: f64,
    samples: u32,
}

pub(super) struct Solo<'a> {
    world: World,
    watch: Watch,
    chapter: Chapter,
    tell: &'a mut dyn FnMut(Scene<'_>) -> ControlFlow<()>,
    stopped: bool,
}

impl<'a> Solo<'a> {
    pub(super) fn new(world: World, tell: &'a mut dyn FnMut(Scene<'_>) -> ControlFlow<()>) -> Self {
        world.stand().keep_traffic();
        Self {
            world,
            watch: Watch::default(),
            chapter: Chapter::Playing,
            tell,
            stopped: false,
        }
    }

    /// Tells it, or ends it safely where the listener wishes.
    pub(super) fn tell(mut self) -> Result<Told, DemoError> {
        let done = self.all();
        let virtual_secs = self.world.secs();
        let joints = self.world.stand().joints();
        let show = Arc::clone(self.world.rig().show());
        let torque_off = self.world.close();
        if self.stopped {
            return Err(DemoError::Stopped { torque_off });
        }
        let [before, after] = done?;
        let mut servo = self.watch.report(&joints);
        let root_mean_square = |followed: &Followed| {
            let squares: f64 = followed
                .values()
                .map(|f| f.error_rms_rad.powi(2) * f64::from(f.samples))
                .sum();
            let samples: f64 = followed.values().map(|f| f64::from(f.samples)).sum();
            (squares / samples.max(1.0)).sqrt().to_degrees()
        };
        servo.clip_rms_error_before_deg = Some(root_mean_square(&before));
        servo.clip_rms_error_after_deg = Some(root_mean_square(&after));
        let lag = |(joint, before): (&String, &Following)| {
            let after = after.get(joint).copied().unwrap_or_default();
            let report = LagReport {
                before_ms: before.behind_ms,
                after_ms: after.behind_ms,
            };
            (joint.clone(), report)
        };
        servo.lag = before.iter().map(lag).collect();
        let report = DemoReport {
            stale_reads: self.watch.stale_reads,
            reads: self.watch.reads,
            servo,
            virtual_secs,
            ..DemoReport::default()
        };
        Ok(Told {
            report,
            rows: self.watch.rows,
            show,
        })
    }

    fn all(&mut self) -> Result<[Followed; 2], DemoError> {
        self.until([], "the clip being judged", APPROACH_SECS, |seen| {
            seen.feasibility.as_ref().is_some_and(|f| f.progress >= 1.0)
        })?;
        let play = [Command::Transport(TransportCommand::Play)];
        self.until(play, "the clip playing", PROMPT_SECS, |seen| {
            seen.transport.playing
        })?;
        let length_secs = self.world.seen().transport.end_secs;
        self.until([], "the clip's end", length_secs + 1.0, |seen| {
            !seen.transport.playing
        })?;
        self.chapter = Chapter::Arming;
        let arm = [Command::Puppet(PuppetCommand::Arm)];
        self.until(arm, "the puppet being armed", PROMPT_SECS, |seen| {
            state(seen) == Some(PuppetState::Holding)
        })?;
        self.chapter = Chapter::Performing;
        let before = self.perform(length_secs)?;
        let compensate = [Command::Puppet(PuppetCommand::CompensateLag(true))];
        self.until(compensate, "lag being made up for", PROMPT_SECS, |seen| {
            seen.puppet.as_ref().is_some_and(|puppet| puppet.compensates_lag)
        })?;
        let after = self.perform(length_secs)?;
        self.chapter = Chapter::Ending;
        let release = [Command::Puppet(PuppetCommand::Release)];
        self.until(release, "torque being off", PROMPT_SECS, |seen| {
            seen.puppet
                .as_ref()
                .is_some_and(|puppet| puppet.state == PuppetState::Released && !puppet.torque)
        })?;
        self.wait(0.5)?;
        Ok([before, after])
    }

    /// One performance from the beginning; how it went.
    fn perform(&mut self, length_secs: f64) -> Result<Followed, DemoError> {
        let play = [
            Command::Transport(TransportCommand::Seek { secs: 0.0 }),
            Command::Puppet(PuppetCommand::Play),
        ];
        self.until(play, "the puppet playing", PROMPT_SECS, |seen| {
            state(seen) == Some(PuppetState::Playing)
        })?;
        self.until([], "the clip's end", length_secs + APPROACH_SECS, |seen| {
            state(seen) != Some(PuppetState::Playing)
        })?;
        let seen = Arc::clone(self.world.seen());
        self.wait(0.7)?;
        let joints = seen.puppet.iter().flat_map(|puppet| &puppet.joints);
        let followed = joints.map(|joint| {
            let tracking = &joint.tracking;
            let following = Following {
                behind_ms: tracking.behind_clip_secs.map(|secs| secs * 1e3),
                error_rms_rad: tracking.clip_error_rms_rad,
                samples: tracking.clip_samples,
            };
            (joint.name.clone(), following)
        });
        Ok(followed.collect())
    }

    fn step(&mut self, commands: impl IntoIterator<Item = Command>) -> Result<(), DemoError> {
        self.world.step(commands.into_iter().collect::<Vec<_>>());
        let seen = Arc::clone(self.world.seen());
        self.watch.step(&seen, self.world.stand())?;
        let scene = Scene {
            chapter: self.chapter,
            key_stored: false,
            snapshot: &seen,
        };
        if (self.tell)(scene).is_break() {
            self.stopped = true;
            return Err(DemoError::Stopped { torque_off: false });
        }
        Ok(())
    }

    fn until(
        &mut self,
        commands: impl IntoIterator<Item = Command>,
        what: &str,
        limit_secs: f64,
        happened: impl Fn(&Snapshot) -> bool,
    ) -> Result<(), DemoError> {
        let end_secs = self.world.secs() + limit_secs;
        let mut commands: Vec<Command> = commands.into_iter().collect();
        loop {
            self.step(std::mem::take(&mut commands))?;
            if happened(self.world.seen()) {
                return Ok(());
            }
            if self.world.secs() >= end_secs {
                let (what, at_secs) = (what.to_owned(), self.world.secs());
                return Err(Late {
                    what,
                    limit_secs,
                    at_secs,
                }
                .into());
            }
        }
    }

    fn wait(&mut self, secs: f64) -> Result<(), DemoError> {
        let end_secs = self.world.secs() + secs;
        while self.world.secs() < end_secs {
            self.step([])?;
        }
        Ok(())
    }
}

fn state(seen: &Snapshot) -> Option<PuppetState> {
    seen.puppet.as_ref().map(|puppet| puppet.state)
}
