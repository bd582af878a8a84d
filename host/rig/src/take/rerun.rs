//! A take done again: a rig without devices, on a clock of its own, that hears what the take has.
//!
//! First it hears what the devices had said before the take, so that it understands the rest. Then network, figure
//! and time are put to where they stood, and the take's own steps follow at the take's own times. A network that was
//! changed since is changed in the running one before the first step: what was not changed keeps its sums.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use device::clock::{Clock, Instant, VirtualClock};
use device::codec::Answer;
use device::exchange::What;
use device::transport::{Boundary, Transport, TransportError};
use device_profiles::Profiles;

use super::keys::Keys;
use super::{Heard, Reel, Take};
use crate::controls_calibration::{ControlsCalibration, Store};
use crate::document::Show;
use crate::inputs::{self, InputSpec};
use crate::ports::{Found, Plug, Ports};
use crate::rig::{Rig, RigOptions};

/// After a line was opened the devices are looked at this often for a while: questions must not be asked later than
/// they were, or answers would come before them.
const LOOK: Duration = Duration::from_millis(1);
/// For so long: longer than any handshake takes.
const HANDSHAKE: Duration = Duration::from_secs(10);

/// Times at which something was said before the take that are gone through in one step: no pose comes of them.
const HEARINGS: usize = 10;

/// A re-run on its way.
pub(crate) struct Rerun {
    rig: Rig,
    clock: VirtualClock,
    take: Arc<Take>,
    /// The step to be taken next; none while the devices are still heard from before.
    next: Option<usize>,
    /// Times at which devices were opened and said something before the take, ascending.
    before: VecDeque<Duration>,
    opened: Vec<Duration>,
    /// What was seen; a digest of each pose after the first.
    keys: Option<Keys>,
    bits: Vec<u64>,
}

impl Rerun {
    /// Nothing is heard yet. The network is the show's.
    pub(crate) fn new(take: Arc<Take>, show: &Show, profiles: &Arc<Profiles>) -> Result<Self, String> {
        let clock = VirtualClock::new();
        // What described itself has no profile: it is found and opened as it was.
        let described = |heard: &Heard| profiles.input(&heard.profile).is_err();
        let specs = take.devices.iter().filter(|(_, heard)| !described(heard));
        let spec = |(name, heard): (&String, &Heard)| InputSpec {
            name: name.clone(),
            profile: heard.profile.clone(),
            // Two devices may have been at one address, one after the other.
            address: name.clone(),
        };
        let options = RigOptions {
            show: show.with_clip_chosen(&take.start.clip),
            folder: None,
            profiles: Arc::clone(profiles),
            calibrations: Store::knowing(calibrated(&take, &spec)),
            inputs: specs.map(spec).collect(),
            puppet: None,
            recorder: None,
        };
        let found = take.devices.iter().filter(|(_, heard)| described(heard));
        let found = found.map(|(name, _)| name.clone()).collect();
        let ports = TakePorts::new(&take, &clock, found);
        let mut rig =
            Rig::new(Arc::new(clock.clone()), Box::new(ports), options).map_err(|error| error.to_string())?;
        rig.look_in_every_step();
        let mut before: Vec<Duration> = take
            .devices
            .values()
            .flat_map(|heard| heard.before.times())
            .chain(take.devices.values().map(|heard| heard.opened))
            .collect();
        before.sort_unstable();
        before.dedup();
        Ok(Self {
            rig,
            clock,
            next: None,
            before: before.into(),
            opened: take.devices.values().map(|heard| heard.opened).collect(),
            keys: None,
            bits: Vec::new(),
            take,
        })
    }

    /// Takes up to `steps` steps; whether it is at the end.
    pub(crate) fn advance(&mut self, steps: usize) -> Result<bool, String> {
        for _ in 0..steps {
            match self.next {
                None => {
                    for _ in 0..HEARINGS {
                        self.hear_before()?;
                        if self.next.is_some() {
                            break;
                        }
                    }
                }
                Some(next) if next < self.take.steps.len() => self.step(next),
                Some(_) => return Ok(true),
            }
        }
        Ok(self.next.is_some_and(|next| next >= self.take.steps.len()))
    }

    fn now(&self) -> Duration {
        self.clock.now().since(Instant::ZERO)
    }

    fn hear_before(&mut self) -> Result<(), String> {
        let (now, start) = (self.now(), self.take.start.at);
        let shaking = self
            .opened
            .iter()
            .any(|&opened| opened <= now && now < opened.saturating_add(HANDSHAKE));
        while self.before.front().is_some_and(|&at| at <= now) {
            self.before.pop_front();
        }
        let said = self.before.front().copied().unwrap_or(start);
        let next = if shaking { said.min(now + LOOK) } else { said };
        if now >= start || next > start {
            self.clock.sleep_until(Instant::ZERO.after(start));
            self.rig.hear_only();
            self.rig.resume(&self.take.start);
            let posed = self
                .rig
                .posed()
                .ok_or("this show has neither a figure nor a puppet to pose")?;
            self.keys = Some(Keys::beginning_with(posed));
            self.next = Some(0);
            return Ok(());
        }
        self.clock.sleep_until(Instant::ZERO.after(next));
        self.rig.hear_only();
        Ok(())
    }

    fn step(&mut self, step: usize) {
        let at = self.take.steps[step];
        self.clock.sleep_until(Instant::ZERO.after(at));
        let from = self.take.commands.partition_point(|(in_step, _)| *in_step < step);
        let commands = self.take.commands[from..]
            .iter()
            .take_while(|(in_step, _)| *in_step == step)
            .map(|(_, command)| command.clone())
            .collect::<Vec<_>>();
        self.rig.go(&commands);
        if let (Some(posed), Some(keys)) = (self.rig.posed(), &mut self.keys) {
            self.bits.push(posed.bits());
            keys.add(at.saturating_sub(self.take.start.at).as_secs_f64(), posed);
        }
        self.next = Some(step + 1);
    }

    /// What was seen, and a digest of the pose after each step.
    pub(crate) fn finish(&mut self) -> Option<(Keys, Vec<u64>)> {
        Some((self.keys.take()?, std::mem::take(&mut self.bits)))
    }
}

/// What was calibrated on the devices of a take, which nothing but their names tells apart there: named ones by profile
/// and address, those that describe themselves by the name alone.
fn calibrated(
    take: &Take,
    spec: &dyn Fn((&String, &Heard)) -> InputSpec,
) -> BTreeMap<String, ControlsCalibration> {
    let known = take.devices.iter().flat_map(|device| {
        let (name, heard) = device;
        [inputs::by_address(&spec(device)), name.clone()].map(|by| (by, heard.calibration.clone()))
    });
    known.collect()
}

/// Lines that devices of a take were on, one after another, by the device's name.
type Lines = BTreeMap<String, VecDeque<Line>>;

/// One line, from its opening until it was gone.
#[derive(Debug, Default)]
struct Line {
    opened: Duration,
    reports: bool,
    said: Reel,
    /// What came back for questions; what nobody asks for does not stand in the way of the rest.
    answers: VecDeque<(Duration, Answer)>,
}

/// Ports at which the devices of a take are.
struct TakePorts {
    clock: VirtualClock,
    lines: Arc<Mutex<Lines>>,
    /// Devices that nobody names.
    found: Vec<String>,
}

impl TakePorts {
    fn new(take: &Take, clock: &VirtualClock, found: Vec<String>) -> Self {
        let lines = take
            .devices
            .iter()
            .map(|(name, heard)| (name.clone(), lines_of(heard)));
        Self {
            clock: clock.clone(),
            lines: Arc::new(Mutex::new(lines.collect())),
            found,
        }
    }
}

fn lines_of(heard: &Heard) -> VecDeque<Line> {
    let line = |opened| Line {
        opened,
        reports: heard.reports,
        ..Line::default()
    };
    let mut lines = vec![line(heard.opened)];
    for record in heard.before.records().chain(heard.during.records()) {
        let at = record.at.unwrap_or_default();
        if record.what == What::Back {
            lines.push(line(at));
            continue;
        }
        let Some(last) = lines.last_mut() else { continue };
        match record.what {
            What::Answer(answer) => last.answers.push_back((at, answer)),
            what => last.said.put(at, what),
        }
    }
    lines.into()
}

impl Ports for TakePorts {
    /// Devices that are there and not opened yet.
    fn list(&mut self) -> Vec<Found> {
        let now = self.clock.now().since(Instant::ZERO);
        let lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        let waits = |name: &&String| {
            let next = lines.get(*name).and_then(VecDeque::front);
            next.is_some_and(|line| line.opened <= now)
        };
        let found = |name: &String| Found {
            address: name.clone(),
            plug: Some(Plug {
                name: name.clone(),
                profile: None,
                slot: 1,
                baud: 0,
                identity: name.clone(),
            }),
            ..Found::default()
        };
        self.found.iter().filter(waits).map(found).collect()
    }

    fn open(&mut self, address: &str, _baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        let now = self.clock.now().since(Instant::ZERO);
        // Whatever happens under the lock leaves whole lines.
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        let waiting = lines.get_mut(address);
        let line = waiting.and_then(|lines| lines.pop_front_if(|line| line.opened <= now));
        let line = line.ok_or_else(|| TransportError::NotFound {
            address: address.to_owned(),
        })?;
        Ok(Box::new(TakeTransport {
            address: address.to_owned(),
            clock: self.clock.clone(),
            reports: line.reports,
            said: line.said,
            answers: line.answers,
            arrived: None,
        }))
    }
}

/// A line on which a device says what it said.
struct TakeTransport {
    address: String,
    clock: VirtualClock,
    reports: bool,
    said: Reel,
    answers: VecDeque<(Duration, Answer)>,
    arrived: Option<Instant>,
}

impl TakeTransport {
    fn now(&self) -> Duration {
        self.clock.now().since(Instant::ZERO)
    }

    /// The first answer of that kind, taken out, if its time has come; an error where none will ever come.
    fn answer(&mut self, is: impl Fn(&Answer) -> bool) -> Result<Option<Answer>, TransportError> {
        let Some(place) = self.answers.iter().position(|(_, answer)| is(answer)) else {
            return Err(self.refused("the take has no answer to this question"));
        };
        if self.answers[place].0 > self.now() {
            return Ok(None);
        }
        Ok(self.answers.remove(place).map(|(_, answer)| answer))
    }

    fn refused(&self, why: &str) -> TransportError {
        TransportError::Io {
            address: self.address.clone(),
            source: std::io::Error::other(why.to_owned()),
        }
    }
}

impl Transport for TakeTransport {
    fn boundary(&self) -> Boundary {
        if self.reports {
            Boundary::Reports
        } else {
            Boundary::Stream
        }
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let now = self.now();
        while self.said.front_at().is_some_and(|at| at <= now) {
            if self.said.front_other().is_some() {
                return Err(TransportError::Gone {
                    address: self.address.clone(),
                });
            }
            self.arrived = self.said.front_at().map(|at| Instant::ZERO.after(at));
            let count = self.said.read_front(buffer, self.reports);
            if count > 0 {
                return Ok(count);
            }
        }
        Ok(0)
    }

    fn write(&mut self, _bytes: &[u8]) -> Result<(), TransportError> {
        Ok(())
    }

    fn write_feature(&mut self, bytes: &[u8]) -> Result<Option<()>, TransportError> {
        let first = bytes.first().copied().unwrap_or_default();
        let refused =
            |answer: &Answer| matches!(answer, Answer::Feature { id, bytes: Err(_) } if *id == first);
        if !self.answers.front().is_some_and(|(_, answer)| refused(answer)) {
            return Ok(Some(()));
        }
        match self.answer(refused)? {
            Some(Answer::Feature { bytes: Err(why), .. }) => Err(self.refused(&why)),
            _ => Ok(None),
        }
    }

    fn read_feature(&mut self, wanted: u8, buffer: &mut [u8]) -> Result<Option<usize>, TransportError> {
        match self.answer(|answer| matches!(answer, Answer::Feature { id, .. } if *id == wanted))? {
            Some(Answer::Feature { bytes: Ok(bytes), .. }) => {
                let count = bytes.len().min(buffer.len());
                buffer[..count].copy_from_slice(&bytes[..count]);
                Ok(Some(count))
            }
            Some(Answer::Feature { bytes: Err(why), .. }) => Err(self.refused(&why)),
            _ => Ok(None),
        }
    }

    fn read_string(&mut self, wanted: u8) -> Result<Option<Vec<u8>>, TransportError> {
        match self.answer(|answer| matches!(answer, Answer::Text { index, .. } if *index == wanted))? {
            Some(Answer::Text { raw, .. }) => raw.map(Some).map_err(|why| self.refused(&why)),
            _ => Ok(None),
        }
    }

    fn report_descriptor(&mut self) -> Result<Vec<u8>, TransportError> {
        match self.answer(|answer| matches!(answer, Answer::Descriptor(_)))? {
            Some(Answer::Descriptor(bytes)) => bytes.map_err(|why| self.refused(&why)),
            _ => Err(self.refused("the report descriptor was not read yet")),
        }
    }

    fn arrived(&self) -> Option<Instant> {
        self.arrived
    }
}
