//! Recorded reports to events, without hardware: `hid-recorder` text, `usbhid-dump` text, exchanges.
//!
//! Without a profile, the descriptor in the recording is used, or the profile it names.

mod dump;
mod exchange;
mod profile;
mod recorder;
mod recording;

pub use profile::with_file;
pub use recording::{Flaw, RecordedDevice, RecordedReport, Recording};

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use device::clock::Instant;
use device::codec::hid::HidCodec;
use device::codec::{self, Codec, Counters, InputEvent, Outgoing, Stamped, Stand};
use device::exchange::play;
use device_profiles::{InputProfile, Profiles};

use crate::telling::{Buttons, Teller, Told};

/// A recording cannot be decoded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DecodeError {
    /// Nothing in it.
    #[error(
        "expected hid-recorder text (lines R:, N:, I:, E:), usbhid-dump text (BUS:DEVICE:INTERFACE:STREAM) or an exchange \
         (device < 01 02), found nothing of the kind"
    )]
    Empty,
    /// No profile and no descriptor.
    #[error("device \"{name}\": the recording has no report descriptor; name a profile with --profile")]
    Unknown {
        /// The device.
        name: String,
    },
    /// What there is does not make a codec.
    #[error("device \"{name}\": {why}")]
    Codec {
        /// The device.
        name: String,
        /// Why.
        why: String,
    },
}

/// Decodes a recording, device by device in one stream.
pub struct Decoding {
    seats: Vec<Option<Seat>>,
    unknown: u64,
}

struct Seat {
    codec: Box<dyn Codec>,
    teller: Teller,
    /// When its last report came.
    heard_at: Option<Duration>,
    /// What came of the whole conversation, to be told as its reports are taken; and how many of these are left.
    played: Option<(VecDeque<Stamped<InputEvent>>, usize)>,
}

/// How often a silent device is looked at, and how long: no codec has a longer limit.
const LOOK: Duration = Duration::from_millis(10);
const LOOKS: u32 = 300;

/// What the last line says.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Reports understood, unknown and rejected.
    pub counters: Counters,
    /// Lines.
    pub events: u64,
    /// Smallest and largest of every axis.
    pub axes: BTreeMap<String, [i64; 2]>,
    /// Changes of what is on or off.
    pub edges: BTreeMap<String, u64>,
}

impl Decoding {
    /// For the devices of a recording; `profile` is used for all of them.
    ///
    /// # Errors
    /// When a device that sent something can be understood by no means.
    pub fn new(
        recording: &Recording,
        profile: Option<&InputProfile>,
        profiles: &Profiles,
    ) -> Result<Self, DecodeError> {
        if recording.is_empty() {
            return Err(DecodeError::Empty);
        }
        let mut seats = Vec::new();
        for (number, device) in recording.devices.iter().enumerate() {
            let heard = recording.reports.iter().any(|report| report.device == number);
            let count = recording.reports.iter().filter(|report| report.device == number);
            let seat = Seat::new(device, profile, profiles).map(|seat| seat.converse(device, count.count()));
            // A device that sent nothing may be anything.
            seats.push(if heard { Some(seat?) } else { seat.ok() });
        }
        Ok(Self { seats, unknown: 0 })
    }

    /// Takes one report; `told` gets its time in seconds and each line.
    pub fn take(&mut self, report: &RecordedReport, told: &mut dyn FnMut(f64, Told)) {
        let Some(seat) = self.seats.get_mut(report.device).and_then(Option::as_mut) else {
            self.unknown += 1;
            return;
        };
        if seat.played.is_some() {
            seat.tell_played(report.at, told);
            return;
        }
        let now = Instant::ZERO.after(report.at);
        let at_secs = report.at.as_secs_f64();
        // Time limits that ran out before this report, then the report, then what follows from it.
        seat.wait(report.at, told);
        let mut heard = Vec::new();
        seat.codec.decode(&report.bytes, &mut |event| heard.push(event));
        seat.tell(at_secs, &heard, told);
        seat.advance(now, at_secs, told);
    }

    /// What has come of it.
    pub fn totals(&self) -> Totals {
        let mut totals = Totals::default();
        totals.counters.unknown = self.unknown;
        for seat in self.seats.iter().flatten() {
            let (counters, tally) = (seat.codec.counters(), seat.teller.tally());
            totals.counters.reports += counters.reports;
            totals.counters.unknown += counters.unknown;
            totals.counters.rejected += counters.rejected;
            totals.events += tally.events;
            for (axis, &[low, high]) in &tally.axes {
                let range = totals.axes.entry(axis.to_string()).or_insert([low, high]);
                *range = [range[0].min(low), range[1].max(high)];
            }
            for (name, count) in &tally.edges {
                *totals.edges.entry(name.clone()).or_default() += count;
            }
        }
        totals
    }
}

impl Seat {
    fn new(
        device: &RecordedDevice,
        profile: Option<&InputProfile>,
        profiles: &Profiles,
    ) -> Result<Self, DecodeError> {
        let fail = |why: String| DecodeError::Codec {
            name: device.name.clone(),
            why,
        };
        let named = device.profile.as_ref().map(|key| profiles.input(key)).transpose();
        let named = named.map_err(|error| fail(error.to_string()))?;
        let stand = if device.conversation.is_some() {
            Stand::Unasked
        } else {
            Stand::Reporting
        };
        let mut seat = match (profile.or(named), &device.descriptor) {
            (Some(profile), _) => {
                let codec = codec::of_profile(profile, stand).map_err(|error| fail(error.to_string()))?;
                let buttons = if codec.surface().is_some() {
                    Buttons::Keys
                } else {
                    Buttons::Numbered
                };
                Self {
                    codec,
                    teller: Teller::new(buttons),
                    heard_at: None,
                    played: None,
                }
            }
            (None, Some(descriptor)) => {
                let codec = HidCodec::generic(descriptor).map_err(|error| fail(error.to_string()))?;
                let buttons = match codec.surface() {
                    Some(_) => Buttons::Keys,
                    None if codec.is_pointer() => Buttons::Pointer,
                    None => Buttons::Numbered,
                };
                Self {
                    codec: Box::new(codec),
                    teller: Teller::new(buttons),
                    heard_at: None,
                    played: None,
                }
            }
            (None, None) => {
                return Err(DecodeError::Unknown {
                    name: device.name.clone(),
                });
            }
        };
        let presses = seat.codec.surface().is_none_or(|area| area.pressure_max > 0);
        seat.teller.leave_pressure_out(!presses);
        Ok(seat)
    }

    /// Plays the conversation, if there is one.
    fn converse(mut self, device: &RecordedDevice, reports: usize) -> Self {
        if let Some(exchange) = &device.conversation {
            let played = play(exchange, self.codec.as_mut());
            self.played = Some((played.events.into(), reports));
        }
        self
    }

    /// Tells what had come by the time of a report; with the last one all of it.
    fn tell_played(&mut self, at: Duration, told: &mut dyn FnMut(f64, Told)) {
        let Some((mut events, left)) = self.played.take() else {
            return;
        };
        let left = left.saturating_sub(1);
        let now = Instant::ZERO.after(at);
        while let Some(event) = events.pop_front_if(|event| left == 0 || event.at <= now) {
            self.tell(event.at.since(Instant::ZERO).as_secs_f64(), &[event.what], told);
        }
        self.played = Some((events, left));
    }

    /// Lets the time until the next report pass.
    fn wait(&mut self, until: Duration, told: &mut dyn FnMut(f64, Told)) {
        if let Some(heard_at) = self.heard_at.replace(until) {
            for look in 1..=LOOKS {
                let at = heard_at + LOOK * look;
                if at >= until {
                    break;
                }
                self.advance(Instant::ZERO.after(at), at.as_secs_f64(), told);
            }
        }
        self.advance(Instant::ZERO.after(until), until.as_secs_f64(), told);
    }

    fn advance(&mut self, now: Instant, at_secs: f64, told: &mut dyn FnMut(f64, Told)) {
        let mut heard = Vec::new();
        // A recording answers no questions.
        let mut unsaid = Outgoing::new();
        self.codec
            .advance(now, &mut unsaid, &mut |event| heard.push(event));
        self.tell(at_secs, &heard, told);
    }

    fn tell(&mut self, at_secs: f64, events: &[InputEvent], told: &mut dyn FnMut(f64, Told)) {
        for event in events {
            self.teller.tell(event, &mut |line| told(at_secs, line));
        }
    }
}
