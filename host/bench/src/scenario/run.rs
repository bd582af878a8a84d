//! Playing a scenario: time goes from line to line, and what is expected of every moment is judged at each step.

use std::collections::BTreeMap;
use std::sync::Arc;

use device_profiles::Profiles;
use rig::Command;
use rig::document::{self, NetworkFile, Show};

use super::check::{Check, Evidence};
use super::doing::Doing;
use super::input;
use super::{Line, Scenario, What, When};
use crate::dut::Dut;
use crate::stand::{HandError, JointTruth};
use crate::world::{Equipment, PERIOD, World, WorldOptions};

/// How a scenario is played.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Hardware knowledge.
    pub profiles: Arc<Profiles>,
    /// Decides what random faults hit; none: as the scenario says.
    pub seed: Option<u64>,
}

impl Default for RunOptions {
    fn default() -> Self {
        Self {
            profiles: Arc::new(Profiles::builtin()),
            seed: None,
        }
    }
}

/// What did not come as expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Line of the scenario, from 1; 0 when it could not begin.
    pub line: u32,
    /// Column, from 1.
    pub column: u32,
    /// What was found instead, and when.
    pub message: String,
}

/// How a scenario went.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The scenario's name.
    pub name: String,
    /// The seed it was played with: the same one gives the same course.
    pub seed: u64,
    /// Time it took: virtual on the simulated bench.
    pub secs: f64,
    /// Expectations that were judged.
    pub checks: usize,
    /// Whether torque is known to be off after the rig was closed. A scenario that ends with a cable out or a
    /// servo silent cannot know, which is not by itself a failure.
    pub torque_off_at_end: bool,
    /// What failed, in the order of the lines; playing goes on after a failure of every moment, and ends with
    /// the first of another kind.
    pub failures: Vec<Failure>,
}

impl Outcome {
    /// Whether everything came as expected.
    pub fn passed(&self) -> bool {
        self.failures.is_empty()
    }
}

/// Plays a scenario on the simulated bench, in virtual time.
pub fn run(scenario: &Scenario, options: &RunOptions) -> Outcome {
    play(scenario, options, None, &mut |_| ())
}

/// Plays a scenario in real time with real ports in place of what `dut` names. What hands do to real devices is
/// asked of a person: `ask` gets it as the scenario has it, when it is due.
pub fn run_on(scenario: &Scenario, options: &RunOptions, dut: &Dut, ask: &mut dyn FnMut(&str)) -> Outcome {
    play(scenario, options, Some(dut), ask)
}

fn play(scenario: &Scenario, options: &RunOptions, dut: Option<&Dut>, ask: &mut dyn FnMut(&str)) -> Outcome {
    let seed = options.seed.unwrap_or(scenario.setting.seed);
    let checks = scenario
        .lines
        .iter()
        .filter(|line| matches!(line.what, What::Check(_)));
    let mut outcome = Outcome {
        name: scenario.name.clone(),
        seed,
        secs: 0.0,
        checks: checks.count(),
        torque_off_at_end: true,
        failures: Vec::new(),
    };
    match begin(scenario, options, seed, dut) {
        Ok(world) => Play::new(scenario, world, dut, ask).play(&mut outcome),
        Err(message) => outcome.failures.push(Failure {
            line: 0,
            column: 0,
            message,
        }),
    }
    outcome
}

fn begin(scenario: &Scenario, options: &RunOptions, seed: u64, dut: Option<&Dut>) -> Result<World, String> {
    let setting = &scenario.setting;
    let mut show = match &setting.show {
        Some(path) => document::load(path).map_err(|errors| errors.to_string())?.show,
        None => Show {
            name: scenario.name.clone(),
            ..Show::default()
        },
    };
    for path in &setting.scripts {
        let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        let name = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        show.networks.push(Arc::new(NetworkFile { name, text }));
    }
    if let Some((text, _)) = input::lookout(&scenario.lines) {
        let name = "outputs that are looked at".to_owned();
        show.networks.push(Arc::new(NetworkFile { name, text }));
    }
    let usual = Equipment::default();
    // Who names devices has those and no others.
    let unasked = |usual: Option<String>| usual.filter(|_| setting.devices.is_empty());
    let mut equipment = Equipment {
        knobs: setting.knobs.clone().or(unasked(usual.knobs)),
        tablet: setting.tablet.clone().or(unasked(usual.tablet)),
        devices: setting.devices.clone(),
        puppet: setting.puppet.clone(),
        plan: usual.plan,
    };
    equipment.plan.start_rad.clone_from(&setting.start_rad);
    equipment.plan.sag_rad_per_s = setting.sag_rad_per_s;
    equipment.plan.plant = setting.plant;
    equipment.plan.stops_rad.clone_from(&setting.stops_rad);
    equipment.plan.horns.clone_from(&setting.horns);
    equipment.plan.seed = seed;
    let profiles = Arc::clone(&options.profiles);
    World::new(WorldOptions {
        show,
        profiles,
        equipment,
        calibrations: BTreeMap::new(),
        journal: None,
        dut: dut.cloned(),
    })
    .map_err(|error| error.to_string())
}

/// A scenario being played.
struct Play<'a> {
    scenario: &'a Scenario,
    dut: Option<&'a Dut>,
    ask: &'a mut dyn FnMut(&str),
    world: World,
    commands: Vec<Command>,
    truths: Vec<JointTruth>,
    /// The joints one and two steps before.
    past: [Vec<JointTruth>; 2],
    mark: Vec<JointTruth>,
    /// When the last `at` was, and its line and column: hands refused later are its doing.
    at_secs: f64,
    at_place: (u32, u32),
    failures: Vec<Failure>,
}

impl<'a> Play<'a> {
    fn new(scenario: &'a Scenario, world: World, dut: Option<&'a Dut>, ask: &'a mut dyn FnMut(&str)) -> Self {
        let truths = world.stand().joints();
        Self {
            scenario,
            dut,
            ask,
            world,
            commands: input::lookout(&scenario.lines)
                .into_iter()
                .map(|(_, look)| look)
                .collect(),
            past: [Vec::new(), Vec::new()],
            truths,
            mark: Vec::new(),
            at_secs: 0.0,
            at_place: (0, 0),
            failures: Vec::new(),
        }
    }

    fn play(mut self, outcome: &mut Outcome) {
        for line in &self.scenario.lines {
            if let Err(message) = self.line(line) {
                self.fail(line, message);
                break;
            }
        }
        outcome.secs = self.world.secs();
        outcome.torque_off_at_end = self.world.close();
        self.failures.sort_by_key(|failure| failure.line);
        outcome.failures = self.failures;
    }

    fn line(&mut self, line: &Line) -> Result<(), String> {
        match (line.when, &line.what) {
            (When::At(at_secs), what) => {
                self.run_to(at_secs);
                self.at_secs = at_secs;
                self.at_place = (line.number, line.column);
                match what {
                    What::Do(doing) => self.act(doing, &line.text),
                    What::Check(check) => self.judge(check).map_err(|found| self.found(&found)),
                }
            }
            (When::By(by_secs), What::Check(check)) => self.wait_for(check, by_secs),
            (When::Within(secs), What::Check(check)) => self.wait_for(check, self.at_secs + secs),
            // These are judged at every step; the parser lets nothing else through.
            _ => Ok(()),
        }
    }

    fn act(&mut self, doing: &Doing, text: &str) -> Result<(), String> {
        match doing {
            Doing::Mark => self.mark = self.joints(),
            // What moved during a pause says nothing about a single step.
            Doing::Stall { .. } => {
                self.truths.clear();
                self.past = [Vec::new(), Vec::new()];
            }
            _ => {}
        }
        let is_real = |name: &str| self.dut.is_some_and(|dut| dut.has(name));
        if doing.device().is_some_and(is_real) {
            (self.ask)(text);
            return Ok(());
        }
        match doing.act(&mut self.world, &mut self.commands) {
            // A joint of a real bus: it is not on the stand.
            Err(HandError::NoSuchDevice { .. }) if self.dut.is_some() => (self.ask)(text),
            other => return other.map_err(|error| error.to_string()),
        }
        Ok(())
    }

    /// The joints as they are: simulated ones really, real ones as the rig reads them.
    fn joints(&self) -> Vec<JointTruth> {
        let stand = self.world.stand();
        let mut joints = stand.joints();
        if let (Some(_), Some(puppet)) = (self.dut, &self.world.seen().puppet) {
            let earlier = |joint: &str| self.truths.iter().find(|truth| truth.joint == joint);
            joints.extend(stand.seen_joints(puppet).into_iter().map(|seen| {
                let by_rad =
                    earlier(&seen.joint).map_or(0.0, |before| seen.position_rad - before.position_rad);
                JointTruth {
                    velocity_rad_per_s: by_rad / PERIOD.as_secs_f64(),
                    ..seen
                }
            }));
        }
        joints
    }

    fn run_to(&mut self, secs: f64) {
        while self.world.secs() < secs - PERIOD.as_secs_f64() / 2.0 {
            self.step();
        }
    }

    fn wait_for(&mut self, check: &Check, by_secs: f64) -> Result<(), String> {
        loop {
            self.step();
            let Err(found) = self.judge(check) else {
                return Ok(());
            };
            if self.world.secs() >= by_secs - PERIOD.as_secs_f64() / 2.0 {
                return Err(self.found(&found));
            }
        }
    }

    fn found(&self, found: &str) -> String {
        format!("at {:.2} s {found}", self.world.secs())
    }

    fn step(&mut self) {
        let commands = std::mem::take(&mut self.commands);
        self.world.step(commands);
        let joints = self.joints();
        let before = std::mem::replace(&mut self.truths, joints);
        self.past.swap(0, 1);
        self.past[0] = before;
        for line in &self.scenario.lines {
            let already = self.failures.iter().any(|failure| failure.line == line.number);
            let (from_secs, to_secs, wanted) = match line.when {
                When::Always { from_secs, to_secs } => (from_secs, to_secs, true),
                When::Never { from_secs, to_secs } => (from_secs, to_secs, false),
                _ => continue,
            };
            let What::Check(check) = &line.what else { continue };
            // What is done at a moment is seen by the next step, so a span begins after its first moment.
            let now_secs = self.world.secs();
            if already || now_secs <= from_secs || now_secs > to_secs {
                continue;
            }
            match (self.judge(check), wanted) {
                (Err(found), true) => {
                    let message = self.found(&found);
                    self.fail(line, message);
                }
                (Ok(()), false) => {
                    let message = self.found("it was so");
                    self.fail(line, message);
                }
                _ => {}
            }
        }
        for error in self.world.take_refused() {
            let (line, column) = self.at_place;
            let message = error.to_string();
            self.failures.push(Failure {
                line,
                column,
                message,
            });
        }
    }

    fn judge(&self, check: &Check) -> Result<(), String> {
        check.judge(&Evidence {
            seen: self.world.seen(),
            stand: self.world.stand(),
            hil: self.dut.is_some(),
            truths: &self.truths,
            past: self.past.each_ref().map(Vec::as_slice),
            mark: &self.mark,
            calibrated: self.world.calibrated(),
        })
    }

    fn fail(&mut self, line: &Line, message: String) {
        self.failures.push(Failure {
            line: line.number,
            column: line.column,
            message,
        });
    }
}
