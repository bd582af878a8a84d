//! A whole rig with its bench: devices, hands and rig on one clock, which moves only when the world is stepped.
//!
//! Nothing then reads the time of day or runs beside anything else, so the same options and the same doings give
//! the same snapshots, bytes and journal, every time. With a device under test the clock is the system's and the
//! puppet has its own thread; nothing else differs.

use std::collections::BTreeMap;
use std::io::Write;
use std::sync::Arc;
use std::time::Duration;

use device::clock::{Clock, Instant, MonotonicClock, VirtualClock};
use device_profiles::Profiles;
use rig::calibration::{Proposal, Reading};
use rig::controls_calibration::{ControlsCalibration, Store};
use rig::document::Show;
use rig::journal::{Recorder, RecordingPorts};
use rig::{Command, InputSpec, Pace, Ports, PuppetSpec, Rig, RigError, RigOptions, Snapshot};

use crate::calibrating::Calibrating;
use crate::dut::{Dut, MixedPorts};
use crate::hands::Hands;
use crate::stand::{HandError, PuppetPlan, SCHEME, SimPorts, Stand, StandError};

/// Time between steps of the rig, and with it of the servo cycle: a hundred a second.
pub const PERIOD: Duration = Duration::from_millis(10);
/// Name of the dial box on the bench.
pub const DIAL_BOX: &str = "dial-box";
/// Name of the tablet on the bench.
pub const TABLET: &str = "tablet";
/// Profile of the dial box, if nobody asks for another: the one with displays, so that labels can be seen.
pub const DIAL_BOX_PROFILE: &str = "sgi-dialbox-display";
/// Profile of the tablet, if nobody asks for another: its puck has buttons and a wheel.
pub const TABLET_PROFILE: &str = "graphire-serial";

/// What stands on the bench.
#[derive(Clone, Debug, PartialEq)]
pub struct Equipment {
    /// Key of the dial box's profile; none: no dial box.
    pub knobs: Option<String>,
    /// Key of the tablet's profile; none: no tablet.
    pub tablet: Option<String>,
    /// Any other input devices: what each is called on the bench, and of which kind it is ([`Stand`] knows them by the
    /// names of their profiles).
    pub devices: Vec<(String, String)>,
    /// Key of the puppet's profile; none: no puppet.
    pub puppet: Option<String>,
    /// How the puppet begins.
    pub plan: PuppetPlan,
}

impl Default for Equipment {
    /// A dial box with displays and a tablet with a puck.
    fn default() -> Self {
        Self {
            knobs: Some(DIAL_BOX_PROFILE.to_owned()),
            tablet: Some(TABLET_PROFILE.to_owned()),
            devices: Vec::new(),
            puppet: None,
            plan: PuppetPlan::default(),
        }
    }
}

impl Equipment {
    /// Puts it all on a stand, on any clock: `sim:dial-box`, `sim:tablet`, and the puppet's buses by their names.
    pub fn stand(&self, clock: Arc<dyn Clock>, profiles: &Profiles) -> Result<Stand, StandError> {
        let mut builder = Stand::builder(clock);
        if let Some(key) = &self.knobs {
            builder = builder.input(DIAL_BOX, profiles.input(key)?)?;
        }
        if let Some(key) = &self.tablet {
            builder = builder.input(TABLET, profiles.input(key)?)?;
        }
        for (name, kind) in &self.devices {
            builder = builder.kind(name, kind, profiles)?;
        }
        if let Some(key) = &self.puppet {
            builder = builder.puppet(profiles.puppet(key)?, profiles, &self.plan)?;
        }
        Ok(builder.build())
    }

    /// The input devices as a rig is told of them.
    pub fn inputs(&self) -> Vec<InputSpec> {
        let usual = [(DIAL_BOX, &self.knobs), (TABLET, &self.tablet)];
        let usual = usual
            .into_iter()
            .filter_map(|(name, key)| Some((name, key.as_ref()?)));
        let others = self.devices.iter().map(|(name, kind)| (name.as_str(), kind));
        let spec = |(name, kind): (&str, &String)| InputSpec {
            name: name.to_owned(),
            profile: firmware_sim::usb_kind(kind)
                .map_or(kind.as_str(), |kind| kind.profile)
                .to_owned(),
            address: format!("{SCHEME}{name}"),
        };
        usual.chain(others).map(spec).collect()
    }

    /// The puppet as a rig is told of it, ticked every `period`.
    pub fn puppet(
        &self,
        profiles: &Profiles,
        pace: Pace,
        period: Duration,
    ) -> Result<Option<PuppetSpec>, StandError> {
        let Some(key) = &self.puppet else { return Ok(None) };
        let buses = &profiles.puppet(key)?.buses;
        let ports = buses
            .iter()
            .map(|bus| (bus.name.clone(), format!("{SCHEME}{}", bus.name)))
            .collect();
        let mut spec = PuppetSpec {
            profile: key.clone(),
            ports,
            config: <_>::default(),
            pace,
        };
        spec.config.period = period;
        Ok(Some(spec))
    }
}

/// What a world begins with.
pub struct WorldOptions {
    /// The show.
    pub show: Show,
    /// Hardware knowledge.
    pub profiles: Arc<Profiles>,
    /// What stands on the bench.
    pub equipment: Equipment,
    /// What was calibrated on input devices before, by `PROFILE@sim:NAME`.
    pub calibrations: BTreeMap<String, ControlsCalibration>,
    /// Where the journal goes.
    pub journal: Option<Box<dyn Write + Send>>,
    /// Real ports in place of simulated devices; with any of these, time is real too.
    pub dut: Option<Dut>,
}

impl WorldOptions {
    /// A show on the usual bench, with the puppet it names, without a journal.
    pub fn new(show: Show) -> Self {
        let equipment = Equipment {
            puppet: show.puppet.clone(),
            ..Equipment::default()
        };
        Self {
            show,
            profiles: Arc::new(Profiles::builtin()),
            equipment,
            calibrations: BTreeMap::new(),
            journal: None,
            dut: None,
        }
    }
}

/// A world cannot begin.
#[derive(Debug, thiserror::Error)]
pub enum WorldError {
    /// The bench cannot be set up.
    #[error(transparent)]
    Stand(#[from] StandError),
    /// The rig cannot begin.
    #[error(transparent)]
    Rig(#[from] RigError),
}

/// Something did not happen in time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{what} did not happen within {limit_secs} s (until {at_secs:.2} s of virtual time)")]
pub struct Late {
    /// What was waited for.
    pub what: String,
    /// How long.
    pub limit_secs: f64,
    /// When it was given up.
    pub at_secs: f64,
}

/// Who moves time.
enum Pacing {
    /// The world itself.
    Virtual(VirtualClock),
    /// Nobody can; the next step is due then.
    Real(Instant),
}

/// Devices, hands and a rig on one clock.
pub struct World {
    clock: Arc<dyn Clock>,
    pacing: Pacing,
    stand: Stand,
    hands: Hands,
    rig: Rig,
    seen: Arc<Snapshot>,
    refused: Vec<HandError>,
    calibrating: Calibrating,
    profiles: Arc<Profiles>,
    equipment: Equipment,
    dut: Option<Dut>,
}

impl World {
    /// Sets everything up and takes the first step, at time zero.
    pub fn new(options: WorldOptions) -> Result<Self, WorldError> {
        let WorldOptions {
            show,
            profiles,
            mut equipment,
            calibrations,
            journal,
            dut,
        } = options;
        let (clock, pacing): (Arc<dyn Clock>, Pacing) = match &dut {
            None => {
                let clock = VirtualClock::new();
                (Arc::new(clock.clone()), Pacing::Virtual(clock))
            }
            Some(_) => (Arc::new(MonotonicClock::new()), Pacing::Real(Instant::ZERO)),
        };
        equipment.plan.real_buses = dut.iter().flat_map(|dut| dut.ports.keys().cloned()).collect();
        let stand = equipment.stand(Arc::clone(&clock), &profiles)?;
        // A show that cannot be written as files can still be played; its journal then says nothing of it.
        let texts = rig::document::texts(&show).unwrap_or_default();
        let recorder = journal.map(|sink| Recorder::new(sink, texts));
        let ports = Box::new(MixedPorts::new(SimPorts::new(stand.clone())));
        let ports: Box<dyn Ports> = match &recorder {
            Some(recorder) => Box::new(RecordingPorts::new(ports, recorder.clone())),
            None => ports,
        };
        let held = Arc::clone(&profiles);
        let kept = Kept {
            recorder,
            calibrations: Store::knowing(calibrations),
        };
        let mut rig = start_rig(&clock, ports, show, profiles, &equipment, kept, dut.as_ref())?;
        let seen = rig.step(&mut std::iter::empty());
        let hands = Hands::new(stand.clone());
        Ok(Self {
            clock,
            pacing,
            stand,
            hands,
            rig,
            seen,
            refused: Vec::new(),
            calibrating: Calibrating::default(),
            profiles: held,
            equipment,
            dut,
        })
    }

    /// Moves time on by one period, lets hands do what is due, and steps the rig.
    pub fn step(&mut self, commands: impl IntoIterator<Item = Command>) -> &Arc<Snapshot> {
        match &mut self.pacing {
            Pacing::Virtual(clock) => clock.advance(PERIOD),
            Pacing::Real(due) => {
                // A host that was held up goes on from now rather than hurrying after lost steps.
                *due = due.after(PERIOD).max(self.clock.now());
                self.clock.sleep_until(*due);
            }
        }
        self.refused.extend(self.hands.advance());
        self.refused.extend(self.calibrating.sample().err());
        self.seen = self.rig.step(&mut commands.into_iter());
        &self.seen
    }

    /// Where captures go.
    pub fn keep_captures_in(&mut self, folder: std::path::PathBuf) {
        self.rig.keep_captures_in(folder);
    }

    /// Takes the puppet's lines for a calibration by hand; the rig loses them.
    pub fn begin_calibration(&mut self, joint: Option<&str>) -> Result<(), HandError> {
        let puppet = self.equipment.puppet.as_deref();
        self.calibrating
            .begin(&self.stand, &self.clock, &self.profiles, puppet, joint)
    }

    /// Every joint stands at its zero.
    pub fn mark_zero(&mut self) -> Result<(), HandError> {
        self.calibrating.mark_zero()
    }

    /// Ends the sweep, writes what it tells, and begins the rig anew with the profile that was written. Where a joint
    /// is refused nothing is written; the rig begins anew all the same.
    pub fn end_calibration(&mut self, reading: Reading) -> Result<(), HandError> {
        if let Some(written) = self.calibrating.end(reading, &self.profiles)? {
            self.profiles = Arc::new(written);
        }
        let ports = Box::new(MixedPorts::new(SimPorts::new(self.stand.clone())));
        let show = Show::clone(self.rig.show());
        let profiles = Arc::clone(&self.profiles);
        self.rig = start_rig(
            &self.clock,
            ports,
            show,
            profiles,
            &self.equipment,
            Kept {
                recorder: None,
                calibrations: Store::knowing(self.rig.calibrated().clone()),
            },
            self.dut.as_ref(),
        )
        .map_err(|error| HandError::Calibration {
            why: error.to_string(),
        })?;
        Ok(())
    }

    /// What the last calibration told.
    pub fn calibrated(&self) -> &[Proposal] {
        self.calibrating.proposals()
    }

    /// Lets the host sleep: time goes on for the devices, and nobody asks them anything.
    pub fn stall(&mut self, secs: f64) {
        let until = self.clock.now().after(Duration::from_secs_f64(secs.max(0.0)));
        self.clock.sleep_until(until);
    }

    /// Steps until `happened`, at least once. `what` is for the message when it does not.
    pub fn run_until(
        &mut self,
        what: &str,
        limit_secs: f64,
        mut happened: impl FnMut(&Snapshot, &Stand) -> bool,
    ) -> Result<Arc<Snapshot>, Late> {
        let end_secs = self.secs() + limit_secs;
        while self.secs() < end_secs {
            self.step([]);
            if happened(&self.seen, &self.stand) {
                return Ok(Arc::clone(&self.seen));
            }
        }
        Err(Late {
            what: what.to_owned(),
            limit_secs,
            at_secs: self.secs(),
        })
    }

    /// Steps for a while.
    pub fn run_for(&mut self, secs: f64) -> &Arc<Snapshot> {
        let end_secs = self.secs() + secs;
        while self.secs() < end_secs - PERIOD.as_secs_f64() / 2.0 {
            self.step([]);
        }
        &self.seen
    }

    /// Time since the world began, seconds.
    pub fn secs(&self) -> f64 {
        self.clock.now().as_secs_f64()
    }

    /// The rig as it was last seen.
    pub fn seen(&self) -> &Arc<Snapshot> {
        &self.seen
    }

    /// The devices.
    pub fn stand(&self) -> &Stand {
        &self.stand
    }

    /// The hands on them.
    pub fn hands(&mut self) -> &mut Hands {
        &mut self.hands
    }

    /// The rig itself.
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// What hands tried in vain since the last call.
    pub fn take_refused(&mut self) -> Vec<HandError> {
        std::mem::take(&mut self.refused)
    }

    /// Lets go of everything. Gives whether the rig knows torque to be off.
    pub fn close(self) -> bool {
        self.rig.close()
    }
}

/// What is kept of a rig beside its show.
pub(crate) struct Kept {
    /// Where to journal.
    pub(crate) recorder: Option<Recorder>,
    /// What was calibrated on input devices.
    pub(crate) calibrations: Store,
}

pub(crate) fn start_rig(
    clock: &Arc<dyn Clock>,
    ports: Box<dyn Ports>,
    show: Show,
    profiles: Arc<Profiles>,
    equipment: &Equipment,
    kept: Kept,
    dut: Option<&Dut>,
) -> Result<Rig, WorldError> {
    let pace = if dut.is_some() {
        Pace::OwnThread
    } else {
        Pace::WithTheRig
    };
    let mut puppet = equipment.puppet(&profiles, pace, PERIOD)?;
    let mut inputs = equipment.inputs();
    if let Some(dut) = dut {
        dut.redirect_inputs(&mut inputs);
        if let Some(puppet) = &mut puppet {
            dut.redirect_puppet(puppet);
        }
    }
    let options = RigOptions {
        show,
        folder: None,
        profiles,
        inputs,
        calibrations: kept.calibrations,
        puppet,
        recorder: kept.recorder,
    };
    Ok(Rig::new(Arc::clone(clock), ports, options)?)
}
