//! The puppet's seat in the rig: its lines, its player, and what it is asked to play.
//!
//! Whatever the show wants goes through a [`player::Player`]; the rig never touches a servo. In virtual time the
//! player is ticked by the step itself; in real time it has a thread of its own, which nothing here can hold up.

mod body;
mod bones;
mod mannequin;
mod model;
mod pose_view;
mod runner;
mod view;

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use device::clock::{Clock, Instant};
use device_profiles::{ProfileError, Profiles, PuppetProfile};
use motion::{JointTrack, Placed};
use player::{Order, Phase, PlayerConfig, Puppet, PuppetError, State};

pub use body::{Body, BodyError, Follower, RestFrames};
use bones::Bones;
pub(crate) use mannequin::Mannequin;
pub use model::Model;
pub use pose_view::{EndHandle, JointHandle, PuppetPoseView};
use runner::{Line, Runner};

use crate::command::PuppetCommand;
use crate::document::{DemandError, Demands};
use crate::ports::Ports;
use crate::snapshot::{NoteLevel, PuppetView, TransportView};

/// How often lines that could not be opened are tried again.
const LOOK_AGAIN: Duration = Duration::from_secs(1);
/// Step of baked joint angles; between them the player interpolates smoothly.
const BAKE_PERIOD_SECS: f64 = 0.01;

/// The puppet to drive.
#[derive(Clone, Debug)]
pub struct PuppetSpec {
    /// Key of a puppet profile.
    pub profile: String,
    /// Where each of its buses is: bus name to address.
    pub ports: BTreeMap<String, String>,
    /// How it is played.
    pub config: PlayerConfig,
    /// Who ticks the player.
    pub pace: Pace,
}

/// Who ticks the player.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// Each step of the rig ticks it once: virtual time, and everything in one journal.
    WithTheRig,
    /// A thread of its own at the configured period: real time.
    OwnThread,
}

/// A puppet cannot be driven as described.
#[derive(Debug, thiserror::Error)]
pub enum PuppetSetupError {
    /// No such profile; the message lists what there is.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// The profile does not fit its servos.
    #[error(transparent)]
    Puppet(#[from] PuppetError),
    /// The show demands what the puppet cannot do.
    #[error(transparent)]
    Demand(#[from] DemandError),
    /// A bus has no address.
    #[error("puppet {puppet} needs an address for its bus \"{bus}\"; give one `--port` for each of: {buses}")]
    NoAddress {
        /// The puppet.
        puppet: String,
        /// The bus.
        bus: String,
        /// All its buses.
        buses: String,
    },
}

/// The puppet's seat.
pub(crate) struct Seat {
    profile: PuppetProfile,
    puppet: Puppet,
    lines: Vec<Line>,
    spec: PuppetSpec,
    clock: Arc<dyn Clock>,
    runner: Runner,
    bones: Option<Bones>,
    body: Option<Body>,
    follower: Option<Follower>,
    /// Whether it follows what is on screen.
    following: bool,
    /// Stop was pressed before there was a player.
    stopped: bool,
    look_at: Instant,
    remarks: Vec<(NoteLevel, String)>,
}

impl Seat {
    pub(crate) fn new(
        spec: PuppetSpec,
        demands: &Demands,
        profiles: &Profiles,
        clock: Arc<dyn Clock>,
    ) -> Result<Self, PuppetSetupError> {
        let profile = demands.of(profiles.puppet(&spec.profile)?)?;
        let puppet = Puppet::new(&profile, profiles)?;
        let lines = puppet
            .buses()
            .iter()
            .map(|bus| match spec.ports.get(&bus.name) {
                Some(address) => Ok(Line {
                    bus: bus.name.clone(),
                    address: address.clone(),
                    baud: bus.baud,
                }),
                None => Err(PuppetSetupError::NoAddress {
                    puppet: profile.name.clone(),
                    bus: bus.name.clone(),
                    buses: puppet
                        .buses()
                        .iter()
                        .map(|b| b.name.as_str())
                        .collect::<Vec<_>>()
                        .join(", "),
                }),
            })
            .collect::<Result<_, _>>()?;
        let bones = Model::new(&profile).ok().map(|model| Bones::new(Arc::new(model)));
        Ok(Self {
            profile,
            puppet,
            lines,
            spec,
            clock,
            runner: Runner::Waiting,
            bones,
            body: None,
            follower: None,
            following: false,
            stopped: false,
            look_at: Instant::ZERO,
            remarks: Vec::new(),
        })
    }

    /// How it follows the show's figure, if it does.
    pub(crate) fn body(&self) -> Option<&Body> {
        self.body.as_ref()
    }

    /// What is known of the puppet.
    pub(crate) fn profile(&self) -> &PuppetProfile {
        &self.profile
    }

    /// Whose joints follow the show's figure from now on.
    pub(crate) fn lead_by(&mut self, body: Option<Body>) {
        self.follower = None;
        self.body = body;
    }

    /// Passes an order on, or says why not. Playing is ordered by [`Seat::play`].
    pub(crate) fn order(&mut self, order: &PuppetCommand) -> Result<(), String> {
        if !matches!(order, PuppetCommand::Heartbeat | PuppetCommand::CompensateLag(_)) {
            self.following = *order == PuppetCommand::Follow;
            self.follower = None;
        }
        if let Runner::Waiting = self.runner {
            // A stop is kept for the player that is to come; nothing can move before.
            match order {
                PuppetCommand::Stop => self.stopped = true,
                PuppetCommand::Reset => self.stopped = false,
                _ => {}
            }
        }
        let order = match order {
            PuppetCommand::Arm => {
                self.say_what_a_lost_host_means();
                Order::Arm
            }
            PuppetCommand::Play | PuppetCommand::Follow => return Ok(()),
            PuppetCommand::Hold => Order::Hold,
            PuppetCommand::Release => Order::Release,
            PuppetCommand::Stop => Order::Stop,
            PuppetCommand::Reset => Order::Reset,
            PuppetCommand::Heartbeat => Order::Heartbeat,
            PuppetCommand::CompensateLag(on) => Order::CompensateLag(*on),
        };
        self.pass_on(order)
    }

    fn pass_on(&mut self, order: Order) -> Result<(), String> {
        self.runner
            .order(order)
            .map_err(|()| format!("puppet {}: {}", self.profile.name, self.missing()))
    }

    /// Said before torque comes on, since nobody can say it afterwards.
    fn say_what_a_lost_host_means(&mut self) {
        let models = self.puppet.without_watchdog();
        if models.is_empty() {
            return;
        }
        let words = format!(
            "puppet {}: {} have no watchdog: if this program or the cable is lost they stand at their last goal, with \
             torque on, until their power is cut or `dialrig servo release` reaches them",
            self.profile.name,
            models.join(" and ")
        );
        self.remarks.push((NoteLevel::Warning, words));
    }

    fn missing(&self) -> String {
        let addresses: Vec<_> = self.lines.iter().map(|l| l.address.as_str()).collect();
        format!(
            "its lines are not open ({}); it is looked for once a second",
            addresses.join(", ")
        )
    }

    /// Plays a motion from the present animation time, or from its beginning where that is at the end.
    pub(crate) fn play(&mut self, track: &JointTrack, timeline: &TransportView) -> Result<(), String> {
        let clip = track.bake(BAKE_PERIOD_SECS).map_err(|error| error.to_string())?;
        let at_end = timeline.secs >= timeline.end_secs;
        let from_secs = if at_end {
            0.0
        } else {
            (timeline.secs - timeline.start_secs).max(0.0)
        };
        self.pass_on(Order::Play {
            clip: Arc::new(clip),
            from_secs,
            speed: timeline.speed,
            looped: timeline.looped,
        })
    }

    /// Joints go to these angles, and stay; the next angles may come at once.
    pub(crate) fn lead(&mut self, angles_rad: &[f64]) {
        // A full queue means that newer angles are on their way anyway.
        let _ = self.runner.order(Order::Follow(angles_rad.into()));
    }

    /// What is on screen now, for a puppet that follows it live: its own pose where it is posed itself, else the
    /// figure's.
    pub(crate) fn follow(&mut self, placed: Option<&[Placed]>, posed_rad: Option<&[f64]>) {
        if !self.following {
            return;
        }
        let angles: Arc<[f64]> = match (posed_rad, placed) {
            (Some(posed_rad), _) => posed_rad.into(),
            (None, Some(placed)) => match (&mut self.follower, &self.body) {
                (Some(follower), _) => follower.follow(placed).into(),
                (follower @ None, Some(body)) => follower.insert(Follower::new(body)).follow(placed).into(),
                (None, None) => return,
            },
            (None, None) => return,
        };
        // A full queue means a newer pose is on its way anyway.
        let _ = self.runner.order(Order::Follow(angles));
    }

    /// One step: opens lines that are missing, ticks the player if the rig does, and says what happened.
    pub(crate) fn advance(&mut self, now: Instant, ports: &mut dyn Ports) -> Vec<(NoteLevel, String)> {
        if matches!(self.runner, Runner::Waiting) && now >= self.look_at {
            self.look_at = now.after(LOOK_AGAIN);
            match runner::open(
                &self.puppet,
                &self.lines,
                ports,
                &self.spec.config,
                self.spec.pace,
            ) {
                Ok(player) => {
                    self.runner = Runner::start(player, self.spec.pace, &self.clock);
                    if std::mem::take(&mut self.stopped) {
                        // A player that has just begun has room for it.
                        let _ = self.runner.order(Order::Stop);
                    }
                }
                Err(why) => self
                    .remarks
                    .push((NoteLevel::Warning, format!("puppet {}: {why}", self.profile.name))),
            }
        }
        self.runner
            .advance(now, &self.lines, &self.profile, ports, &mut self.remarks);
        std::mem::take(&mut self.remarks)
    }

    /// The time of the clip being performed, since its first key; `None` while none runs.
    pub(crate) fn performed_secs(&self) -> Option<f64> {
        let mut secs = None;
        self.runner.report(&mut |report| {
            let runs = report.state == State::Playing && report.phase == Phase::Running && !self.following;
            secs = report.clip_secs.filter(|_| runs);
        });
        secs
    }

    pub(crate) fn view(&mut self, now: Instant) -> PuppetView {
        let mut seen = None;
        self.runner
            .report(&mut |report| seen = Some(view::of(&self.profile, report, now)));
        let mut view = seen.unwrap_or_else(|| view::absent(&self.profile, self.missing()));
        if let Some(bones) = &mut self.bones {
            view.draw(bones);
        }
        view
    }

    /// Stops and lets go. Returns whether torque is known to be off.
    pub(crate) fn close(&mut self, clock: &dyn Clock) -> bool {
        std::mem::replace(&mut self.runner, Runner::Waiting).close(clock)
    }
}
