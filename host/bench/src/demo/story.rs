//! The story itself: what the hands do, one thing after the other, each when its effect is seen.

use std::ops::ControlFlow;
use std::sync::Arc;

use firmware_sim::hands::Turn;
use rig::document::Show;
use rig::{DeviceHealth, PuppetState, Side, Snapshot};

use super::aim::aim;
use super::pose::Target;
use super::report::{DemoReport, ServoRow};
use super::watch::Watch;
use super::{Chapter, DemoError, Scene};
use crate::hands::Movement;
use crate::stand::Surface;
use crate::world::{DIAL_BOX, Late, TABLET, World};

/// Keys of the dial box, as the device numbers them (F1 is 0).
mod key {
    pub(super) const VIEW_PAGE: u8 = 1;
    pub(super) const ROOT_PAGE: u8 = 2;
    pub(super) const STORE: u8 = 3;
    pub(super) const PLAY: u8 = 5;
    pub(super) const ARM: u8 = 9;
    pub(super) const PERFORM: u8 = 10;
    /// From `more-keys.ps300`.
    pub(super) const FIRST_LINK: u8 = 12;
    pub(super) const RELEASE: u8 = 14;
}

/// Dials, as the device numbers them (dial 1 is 0).
mod dial {
    pub(super) const ROOT: [u8; 3] = [0, 1, 2];
    pub(super) const TWIST: u8 = 3;
    pub(super) const TIME: u8 = 4;
    pub(super) const KNOT: u8 = 5;
    pub(super) const MOVE: u8 = 6;
}

/// Metres of the root for a turn of its dial (`networks/figure.ps300`).
const ROOT_M_PER_TURN: f64 = 0.5;
/// Seconds for a turn of the time dial (`networks/figure.ps300`).
const SECS_PER_TURN: f64 = 4.0;
/// Kinetic coefficients for a turn of their dial (`networks/figure.ps300`).
const KNOTS_PER_TURN: f64 = 4.0;
/// What the kinetic curve is changed by: which coefficient after the last, and how much of a key.
const RETIMINGS: [(f64, f64); 2] = [(3.0, -0.25), (3.0, 0.25)];
/// How long a key or button is held.
const PRESS_SECS: f64 = 0.06;
/// What a report takes to the rig: three bytes at 9600 baud, then the next step.
const REPORT_SECS: f64 = 0.02;
/// How long anything that the rig does at once may take, with what the devices say in between.
const PROMPT_SECS: f64 = 1.0;
/// Differences below these are not worth a movement: half a count of a 256-count dial.
const WORTH_TURNING: f64 = 0.5 / 256.0;

pub(super) struct Story<'a> {
    world: World,
    surface: Surface,
    watch: Watch,
    chapter: Chapter,
    tell: &'a mut dyn FnMut(Scene<'_>) -> ControlFlow<()>,
    stopped: bool,
    keys: usize,
    errors_rad: Vec<f64>,
}

pub(super) struct Told {
    pub(super) report: DemoReport,
    pub(super) rows: Vec<ServoRow>,
    pub(super) show: Arc<Show>,
}

impl<'a> Story<'a> {
    pub(super) fn new(
        world: World,
        tell: &'a mut dyn FnMut(Scene<'_>) -> ControlFlow<()>,
    ) -> Result<Self, DemoError> {
        let surface = world
            .stand()
            .surface(TABLET)?
            .ok_or(DemoError::Show { missing: "a tablet" })?;
        world.stand().keep_traffic();
        Ok(Self {
            world,
            surface,
            watch: Watch::default(),
            chapter: Chapter::Beginning,
            tell,
            stopped: false,
            keys: 0,
            errors_rad: Vec::new(),
        })
    }

    /// Tells it, or ends it safely where the listener wishes.
    pub(super) fn tell(mut self, targets: &[Target]) -> Result<Told, DemoError> {
        let done = self.all(targets);
        let virtual_secs = self.world.secs();
        let joints = self.world.stand().joints();
        let show = Arc::clone(self.world.rig().show());
        let torque_off = self.world.close();
        if self.stopped {
            return Err(DemoError::Stopped { torque_off });
        }
        done?;
        let sum_rad: f64 = self.errors_rad.iter().sum();
        let report = DemoReport {
            keys_entered: self.keys,
            stale_reads: self.watch.stale_reads,
            reads: self.watch.reads,
            pose_error_deg: self
                .errors_rad
                .iter()
                .fold(0.0, |a: f64, &b| a.max(b))
                .to_degrees(),
            pose_error_mean_deg: (sum_rad / self.errors_rad.len().max(1) as f64).to_degrees(),
            servo: self.watch.report(&joints),
            virtual_secs,
            ..DemoReport::default()
        };
        Ok(Told {
            report,
            rows: self.watch.rows,
            show,
        })
    }

    fn all(&mut self, targets: &[Target]) -> Result<(), DemoError> {
        self.until("dial box and tablet answering", 3.0, |seen| {
            seen.devices
                .iter()
                .all(|device| device.health == DeviceHealth::Present)
        })?;
        for (key, target) in targets.iter().enumerate() {
            self.chapter = Chapter::Posing {
                key,
                of: targets.len(),
            };
            self.enter(target)?;
        }
        self.chapter = Chapter::Retiming;
        self.retime()?;
        self.chapter = Chapter::Playing;
        self.press(key::PLAY)?;
        self.until("the clip playing", PROMPT_SECS, |seen| seen.transport.playing)?;
        let last_secs = targets.last().map_or(0.0, |target| target.secs);
        self.until("the clip's end", last_secs + PROMPT_SECS, |seen| {
            !seen.transport.playing
        })?;
        self.go_to(0.0)?;
        self.perform(last_secs)
    }

    /// One step: the watch looks, the listener hears.
    fn step(&mut self) -> Result<(), DemoError> {
        self.world.step([]);
        let seen = Arc::clone(self.world.seen());
        self.watch.step(&seen, self.world.stand())?;
        let keys = std::mem::replace(&mut self.keys, seen.keys.len());
        let scene = Scene {
            chapter: self.chapter,
            key_stored: seen.keys.len() > keys,
            snapshot: &seen,
        };
        if (self.tell)(scene).is_break() {
            self.stopped = true;
            return Err(DemoError::Stopped { torque_off: false });
        }
        match self.world.take_refused().pop() {
            Some(error) => Err(error.into()),
            None => Ok(()),
        }
    }

    fn until(
        &mut self,
        what: &str,
        limit_secs: f64,
        happened: impl Fn(&Snapshot) -> bool,
    ) -> Result<(), DemoError> {
        let end_secs = self.world.secs() + limit_secs;
        loop {
            self.step()?;
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
            self.step()?;
        }
        Ok(())
    }

    /// Until the hands rest and what they did has been heard.
    fn rest(&mut self) -> Result<(), DemoError> {
        while self.world.hands().are_busy() {
            self.step()?;
        }
        self.wait(REPORT_SECS)
    }

    fn press(&mut self, control: u8) -> Result<(), DemoError> {
        self.world.hands().begin(
            DIAL_BOX,
            0.0,
            Movement::Press {
                control,
                for_secs: PRESS_SECS,
            },
        );
        self.wait(PRESS_SECS)
    }

    /// Begins to turn a dial if that is worth it; gives how long it takes.
    fn turn(&mut self, control: u8, turns: f64) -> f64 {
        if turns.abs() < WORTH_TURNING {
            return 0.0;
        }
        // A wrist does most of a turn in half a second and needs several reaches for more.
        let over_secs = (0.15 + 0.35 * turns.abs()).min(1.0);
        let by = Turn::Turns(turns);
        self.world.hands().begin(
            DIAL_BOX,
            0.0,
            Movement::Turn {
                control,
                by,
                over_secs,
            },
        );
        over_secs
    }

    fn go_to(&mut self, secs: f64) -> Result<(), DemoError> {
        let by_secs = secs - self.world.seen().transport.secs;
        self.turn(dial::TIME, by_secs / SECS_PER_TURN);
        self.rest()
    }

    /// One key: time, root, every link in order, store.
    fn enter(&mut self, target: &Target) -> Result<(), DemoError> {
        let keys = self.world.seen().keys.len();
        self.go_to(target.secs)?;
        self.place_root(target)?;
        self.press(key::FIRST_LINK)?;
        self.until("the first link being selected", PROMPT_SECS, |seen| {
            selected(seen) == Some(0)
        })?;
        for link in 0..target.links.len() {
            self.place_link(target, link)?;
        }
        self.compare(target);
        self.press(key::STORE)?;
        self.until("the key being stored", PROMPT_SECS, |seen| seen.keys.len() > keys)
    }

    fn place_root(&mut self, target: &Target) -> Result<(), DemoError> {
        let now = self
            .world
            .seen()
            .figure
            .as_ref()
            .map_or(target.root, |figure| figure.pose.root);
        let turns = ((target.root - now) / ROOT_M_PER_TURN).to_array();
        if turns.iter().all(|turns| turns.abs() < WORTH_TURNING) {
            return Ok(());
        }
        self.press(key::ROOT_PAGE)?;
        for (dial, turns) in dial::ROOT.into_iter().zip(turns) {
            self.turn(dial, turns);
        }
        self.rest()?;
        self.press(key::VIEW_PAGE)
    }

    /// The left hand twists while the right one moves the puck; then the button.
    fn place_link(&mut self, target: &Target, link: usize) -> Result<(), DemoError> {
        let seen = Arc::clone(self.world.seen());
        let Some(figure) = &seen.figure else {
            return Err(DemoError::Show { missing: "a figure" });
        };
        let wanted = target.links[link];
        let (pose, placed) = (figure.pose.links[link], figure.placed[link]);
        let twist_turns = (wanted.twist_rad - pose.twist_rad) / std::f64::consts::TAU;
        self.turn(dial::TWIST, twist_turns);
        let found = aim(
            &seen.view,
            &self.surface,
            placed.start,
            pose.length,
            wanted.direction,
        );
        let here = self.world.hands().tool_at(TABLET).unwrap_or([0.0; 2]);
        let far = (found.place[0] - here[0]).hypot(found.place[1] - here[1]);
        // Longer ways take longer, but less than in proportion (Fitts).
        let over_secs = 0.10 + 0.16 * far.sqrt();
        self.world.hands().begin(
            TABLET,
            0.0,
            Movement::Glide {
                to: found.place,
                over_secs,
            },
        );
        while self.world.hands().are_busy() {
            self.step()?;
        }
        if twist_turns.abs() >= WORTH_TURNING {
            self.wait(REPORT_SECS)?;
        }
        let button = if found.side == Side::Near { 1 } else { 2 };
        let last = link + 1 == target.links.len();
        let click = if last {
            // Letting the button go over the tablet would point the same link again, on the near side.
            Movement::ClickAway {
                button,
                for_secs: PRESS_SECS,
            }
        } else {
            Movement::Click {
                button,
                for_secs: PRESS_SECS,
            }
        };
        self.world.hands().begin(TABLET, 0.0, click);
        if last {
            return self.rest();
        }
        self.until("the next link being selected", PROMPT_SECS, |seen| {
            selected(seen) == Some(link + 1)
        })
    }

    fn compare(&mut self, target: &Target) {
        if let Some(figure) = &self.world.seen().figure {
            let pairs = figure.pose.links.iter().zip(&target.links);
            self.errors_rad
                .extend(pairs.map(|(got, wanted)| got.direction.angle_between(wanted.direction)));
        }
    }

    fn retime(&mut self) -> Result<(), DemoError> {
        for (knots, keys) in RETIMINGS {
            self.turn(dial::KNOT, knots / KNOTS_PER_TURN);
            self.rest()?;
            self.turn(dial::MOVE, keys);
            self.rest()?;
        }
        Ok(())
    }

    fn perform(&mut self, last_secs: f64) -> Result<(), DemoError> {
        self.chapter = Chapter::Arming;
        self.press(key::ARM)?;
        self.until("the puppet being armed", 5.0, |seen| {
            state(seen) == Some(PuppetState::Holding)
        })?;
        self.wait(0.3)?;
        self.chapter = Chapter::Performing;
        self.press(key::PERFORM)?;
        self.until("the puppet playing", 2.0, |seen| {
            state(seen) == Some(PuppetState::Playing)
        })?;
        // The approach takes a few seconds and is not counted by the clip's time.
        let limit_secs = last_secs + 15.0;
        self.until("the clip's end", limit_secs, |seen| {
            state(seen) != Some(PuppetState::Playing)
        })?;
        self.chapter = Chapter::Ending;
        self.wait(0.7)?;
        self.press(key::RELEASE)?;
        let loose = |seen: &Snapshot| {
            seen.puppet
                .as_ref()
                .is_some_and(|p| p.state == PuppetState::Released && !p.torque)
        };
        self.until("torque being off", 5.0, loose)?;
        self.wait(1.0)
    }
}

fn selected(seen: &Snapshot) -> Option<usize> {
    seen.figure.as_ref()?.selected.map(usize::from)
}

fn state(seen: &Snapshot) -> Option<PuppetState> {
    seen.puppet.as_ref().map(|puppet| puppet.state)
}
