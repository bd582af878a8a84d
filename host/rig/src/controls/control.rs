//! One control of a device: what its events become, with pickup, gears, dead zone and button mode.
//!
//! It must not know the network: what it is to send is returned, what it drives is told to it.

use std::fmt::Write as _;

use device_profiles::{Control as Group, ControlClass, ControlKind, ControlUnit};
use ps300::value::{Kinds, Value};

use super::bound::Bound;
use super::button::Button;
use super::gears::{Gear, with_dead_zone};
use super::inlets::PAGES;
use super::pickup::{Moment, Pickup, Way};
use super::shown::VALUE_SECS;
use crate::controls_calibration::AxisCalibration;

/// The mode of what springs back and goes by its speed.
pub(crate) const RATE: &str = "rate";
/// The longest time that one push is taken for, seconds: a host that slept goes on from where it was.
const APART_SECS_MAX: f64 = 0.25;
/// How long a control is drawn as live after it moved, seconds.
const LIVE_SECS: f64 = 0.5;
/// How long after a movement nothing is sent back to the control that made it, seconds: a hand that pauses is
/// still on it.
const OWN_SECS: f64 = 0.15;
/// A push of this share of the range, or a turn of this share of a turn, is meant: what learning waits for.
pub(crate) const MEANT: f64 = 0.05;

/// When an event came, and in which gear the rig is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct At {
    pub(crate) secs: f64,
    pub(crate) step: u64,
    pub(crate) fine: bool,
}

/// One control.
#[derive(Debug)]
#[allow(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub(crate) struct Control {
    /// Of its output.
    pub(crate) number: u8,
    /// Among those of its class, from 0: as events number it.
    pub(crate) of_class: u16,
    pub(crate) name: String,
    pub(crate) kind: ControlKind,
    pub(crate) unit: &'static str,
    /// Counts at its ends, as the profile has them.
    pub(crate) range: [i32; 2],
    /// The same as a hand measured them.
    measured: Option<AxisCalibration>,
    counts_per_turn: f64,
    /// As the profile has it.
    pub(crate) counts_per_turn_built: f64,
    /// What it said last of where it is.
    pub(crate) counts: Option<i32>,
    /// It is being calibrated and drives nothing.
    pub(crate) muted: bool,
    /// Share of the range below which a change is noise.
    pub(crate) noise: f64,
    /// Share of the deflection that is the middle.
    pub(crate) zone: f64,
    zone_built: f64,
    /// What the network told it instead.
    zone_told: Option<f64>,
    pub(crate) pickup: Pickup,
    pub(crate) gear: Gear,
    pub(crate) button: Button,
    /// Where it is, in its unit.
    pub(crate) value: f64,
    moved_secs: Option<f64>,
    /// When it last said that it is elsewhere, or where it is at all: a hand may be on it.
    heard_secs: Option<f64>,
    /// A finger is on it, where it can tell.
    pub(crate) touched: bool,
    /// The place of the finger on a ring, counts.
    pub(super) finger: Option<i32>,
    /// What springs back goes by its speed: it sends how far it has come, as a dial does, not where it is.
    rate: bool,
    /// Until when it has sent how far it came.
    pub(super) sent_secs: Option<f64>,
    /// It was pushed when it began to drive what it drives: it must come to its middle first.
    pub(super) waits: bool,
    /// What it drives on the present page.
    pub(crate) bound: Vec<Bound>,
    /// Where the first of that stands, as a share of its own range; beyond it where it cannot get.
    pub(crate) target: Option<f64>,
    /// How the first of it would be read by people: its name, where it stands, as a share of its range.
    pub(crate) reading: Option<Reading>,
    /// Labels the network gave it, by page.
    labels: [String; PAGES as usize],
}

/// A parameter as people read it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Reading {
    /// What people call it.
    pub(crate) name: String,
    pub(crate) standing: Standing,
}

/// Where a parameter stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Standing {
    /// In its unit; none where it cannot be read.
    pub(crate) value: Option<f64>,
    pub(crate) unit: &'static str,
    /// Its ends, where it has any.
    pub(crate) range: Option<[f64; 2]>,
}

impl Reading {
    /// Of something that nobody has looked at yet.
    pub(crate) fn of(name: String) -> Self {
        Self {
            name,
            standing: Standing::default(),
        }
    }

    /// Adds name and value, or what of it there is room for; the value goes before the name where it is `moved`.
    fn write(&self, out: &mut String, characters: usize, moved: bool) {
        let start = out.len();
        out.push_str(&self.name);
        let named = out.len();
        out.push(' ');
        if !self.standing.write(out) {
            out.truncate(named);
            return;
        }
        let both = out.get(start..).unwrap_or_default();
        if characters == 0 || both.chars().count() <= characters {
            return;
        }
        if moved {
            out.drain(start..=named);
        } else {
            out.truncate(named);
        }
    }
}

impl Standing {
    /// The value as a share of the range.
    pub(crate) fn share(&self) -> Option<f64> {
        let [low, high] = self.range.filter(|[low, high]| high > low)?;
        Some(((self.value? - low) / (high - low)).clamp(0.0, 1.0))
    }

    /// Adds the value as people read it, in few characters; false where it is not known.
    fn write(&self, out: &mut String) -> bool {
        let Some(value) = self.value else {
            return false;
        };
        let places = if value.abs() >= 100.0 {
            0
        } else {
            2 - usize::from(value.abs() >= 10.0)
        };
        // `+ 0.0`, rounded, for a zero without a sign.
        let factor = 10_f64.powi(places as i32);
        let rounded = (value * factor).round() / factor + 0.0;
        let space = if self.unit.len() == 1 { " " } else { "" };
        // Writing to a string cannot fail.
        let _ = write!(out, "{rounded:.places$}{space}{}", self.unit);
        true
    }
}

impl Control {
    /// The `nth` of a group of the profile, from 0.
    pub(crate) fn new(number: u8, group: &Group, nth: u16) -> Self {
        let name = match group.names.get(usize::from(nth)) {
            Some(name) => name.clone(),
            None if group.count > 1 => format!("{} {}", group.name, nth + 1),
            None => group.name.clone(),
        };
        let range = group.range.filter(|[low, high]| low != high).unwrap_or([0, 1023]);
        let half = (f64::from(range[1]) - f64::from(range[0])).abs() / 2.0;
        let zone = f64::from(group.dead_zone) / half;
        let counts_per_turn = group.counts_per_turn.filter(|it| *it > 0.0).unwrap_or_else(|| {
            // A ring without a word of its own is once round.
            f64::from((range[1] - range[0]).unsigned_abs()) + 1.0
        });
        let mut pickup = Pickup::default();
        pickup.choose(way_built(group.kind));
        Self {
            number,
            of_class: 0,
            name,
            kind: group.kind,
            unit: unit(group.kind, group.unit),
            range,
            measured: None,
            counts_per_turn,
            counts_per_turn_built: counts_per_turn,
            counts: None,
            muted: false,
            noise: group.noise_share.unwrap_or(0.0),
            zone,
            zone_built: zone,
            zone_told: None,
            pickup,
            gear: Gear::default(),
            button: Button::default(),
            value: 0.0,
            moved_secs: None,
            heard_secs: None,
            touched: false,
            finger: None,
            rate: false,
            sent_secs: None,
            waits: false,
            bound: Vec::new(),
            target: None,
            reading: None,
            labels: Default::default(),
        }
    }

    /// What its output may send.
    pub(crate) fn kinds(&self) -> Kinds {
        match self.kind {
            ControlKind::Button => Kinds::BOOLEAN,
            _ => Kinds::REAL,
        }
    }

    /// It was turned by so many counts.
    pub(crate) fn turned(&mut self, delta_counts: i32, at: At) -> Value {
        let turns = f64::from(delta_counts) / self.counts_per_turn;
        self.value += turns;
        self.moved_secs = Some(at.secs);
        Value::Real(self.gear.turn(turns, at.secs, at.fine))
    }

    /// It went down or came up.
    pub(crate) fn pressed(&mut self, down: bool, at: At) -> Option<Value> {
        if self.button.down != down {
            self.moved_secs = Some(at.secs);
        }
        self.value = f64::from(u8::from(down));
        self.button.hear(down).map(Value::Boolean)
    }

    /// It stands at so many counts.
    pub(crate) fn stands(&mut self, counts: i32, at: At) -> Option<Value> {
        let share = self.share_at(counts);
        let known = self.pickup.place();
        if self.kind == ControlKind::Axis {
            return self.deflected(share * 2.0 - 1.0, at);
        }
        let at_an_end = share == 0.0 || share == 1.0;
        if known.is_some_and(|known| !at_an_end && (share - known).abs() < self.noise) {
            return None;
        }
        if known != Some(share) {
            self.value = share;
            self.heard_secs = Some(at.secs);
            self.moved_secs = known.map_or(self.moved_secs, |_| Some(at.secs));
        }
        self.pickup.hear(share, self.moment(at)).map(Value::Real)
    }

    /// A hand is on it, though it is where it was.
    pub(crate) fn is_held(&mut self, at: At) {
        self.heard_secs = Some(at.secs);
    }

    /// A place in counts as a share of its range, 0.5 where it rests.
    fn share_at(&self, counts: i32) -> f64 {
        match self.measured {
            Some(measured) if measured.rest.is_some() => f64::midpoint(measured.share(counts), 1.0),
            Some(measured) => measured.share(counts),
            None => {
                let [low, high] = self.range.map(f64::from);
                ((f64::from(counts) - low) / (high - low)).clamp(0.0, 1.0)
            }
        }
    }

    /// What springs back goes as it is pushed, unless it goes to a value that is known: then as any other.
    fn deflected(&mut self, raw: f64, at: At) -> Option<Value> {
        let deflection = with_dead_zone(raw, self.zone);
        if deflection != self.value {
            self.moved_secs = Some(at.secs);
        }
        if self.rate {
            let went = self.pass(at.secs, at.fine);
            self.pickup.place = Some(f64::midpoint(deflection, 1.0));
            if deflection != self.value {
                self.moved_secs = Some(at.secs);
            }
            self.value = deflection;
            self.waits &= deflection != 0.0;
            return went;
        }
        let was = std::mem::replace(&mut self.value, deflection);
        let share = f64::midpoint(deflection, 1.0);
        let set = self.pickup.hear(share, self.moment(at));
        match self.target {
            Some(_) => set.map(|share| Value::Real(share * 2.0 - 1.0)),
            None => (was != deflection).then_some(Value::Real(deflection)),
        }
    }

    /// Time passes. What goes by its speed has come so far since, in turns: one a second where it is pushed all the way.
    pub(crate) fn pass(&mut self, secs: f64, fine: bool) -> Option<Value> {
        if !self.rate {
            return None;
        }
        let since = self.sent_secs.replace(secs).filter(|_| !self.waits)?;
        let apart_secs = (secs - since).clamp(0.0, APART_SECS_MAX);
        let gear = self.gear.factor * if fine { super::pickup::FINE } else { 1.0 };
        let turns = self.value * apart_secs * gear;
        (turns != 0.0).then_some(Value::Real(turns))
    }

    /// It drives something else now, or what it drives was loaded anew.
    pub(crate) fn release(&mut self) {
        self.pickup.release();
        self.waits = self.rate && self.value != 0.0;
    }

    /// A finger is at a place of a ring or strip, or has left it.
    pub(crate) fn fingered(&mut self, place: Option<u16>, at: At) -> Option<Value> {
        let Some(place) = place else {
            self.finger = None;
            if self.kind == ControlKind::Strip {
                self.pickup.lose();
            }
            return None;
        };
        let place = i32::from(place);
        if self.kind == ControlKind::Strip {
            return self.stands(place, at);
        }
        let before = self.finger.replace(place)?;
        let round = (self.range[1] - self.range[0]).abs() + 1;
        let half = round / 2;
        let delta = (place - before + half).rem_euclid(round) - half;
        (delta != 0).then(|| self.turned(delta, at))
    }

    /// The network gives it a label on a page.
    pub(crate) fn labelled(&mut self, page: u8, value: Option<&Value>) {
        if let Some(label) = self.labels.get_mut(usize::from(page).wrapping_sub(1)) {
            *label = match value {
                Some(Value::String(text)) => text.to_string(),
                _ => String::new(),
            };
        }
    }

    /// Where what it drives stands, as a share: of its own range where it has one, else of the parameter's.
    pub(crate) fn shown_share(&self) -> Option<f64> {
        if self.is_absolute() && !self.rate {
            return self.target.map(|it| it.clamp(0.0, 1.0));
        }
        self.reading.as_ref().and_then(|reading| reading.standing.share())
    }

    /// What stands beside it on a page: the network's label, else the name of what it drives, and the value while
    /// it is moved; both where there is room for both.
    pub(crate) fn write_label(&self, out: &mut String, page: u8, characters: usize, now_secs: f64) {
        let own = self.labels.get(usize::from(page).wrapping_sub(1));
        if let Some(own) = own.filter(|it| !it.is_empty()) {
            out.push_str(own);
        } else if let Some(reading) = &self.reading {
            let moved = self.moved_secs.is_some_and(|at| now_secs - at < VALUE_SECS);
            reading.write(out, characters, moved);
        }
    }

    /// The same on its own, with room for all.
    pub(crate) fn label(&self, page: u8, now_secs: f64) -> String {
        let mut label = String::new();
        self.write_label(&mut label, page, 0, now_secs);
        label
    }

    fn moment(&self, at: At) -> Moment {
        Moment {
            secs: at.secs,
            step: at.step,
            target: self.target,
            fine: at.fine,
        }
    }

    /// Takes what a hand measured, or that nothing was. What it drives stays where it is: where the control is now
    /// counts for nothing, so it has to be picked up.
    pub(crate) fn calibrate(
        &mut self,
        per_turn: Option<f64>,
        measured: Option<AxisCalibration>,
    ) -> Option<Value> {
        let per_turn = per_turn.unwrap_or(self.counts_per_turn_built);
        if (per_turn, measured) == (self.counts_per_turn, self.measured) {
            return None;
        }
        (self.counts_per_turn, self.measured) = (per_turn, measured);
        self.choose_zone();
        self.lost()
    }

    /// Whether a hand has measured it.
    pub(crate) fn is_calibrated(&self) -> bool {
        self.measured.is_some() || self.counts_per_turn != self.counts_per_turn_built
    }

    /// What its counts come to, in words; empty where that is not to be calibrated.
    pub(crate) fn comes_to(&self) -> String {
        match self.kind.class() {
            ControlClass::Dial => format!("{:.1} a turn", self.counts_per_turn),
            ControlClass::Axis => {
                let [low, high] = self.measured.map_or(self.range, |measured| measured.ends);
                match self.measured.and_then(|measured| measured.rest) {
                    Some(rest) => format!("{low} to {high}, rests at {rest}"),
                    None => format!("{low} to {high}"),
                }
            }
            ControlClass::Button | ControlClass::Ring => String::new(),
        }
    }

    /// Begins or ends being calibrated. Meanwhile it drives nothing, and it has to be picked up after.
    pub(crate) fn mute(&mut self, on: bool) -> Option<Value> {
        self.muted = on;
        self.lost()
    }

    /// The device is gone. What springs back is let go; all else stays where it is.
    pub(crate) fn lost(&mut self) -> Option<Value> {
        self.pickup.lose();
        self.touched = false;
        self.finger = None;
        let springs_back = self.kind == ControlKind::Axis && (self.rate || self.target.is_none());
        if !springs_back {
            return None;
        }
        let was = std::mem::take(&mut self.value);
        self.waits = false;
        // What went by its speed stands still where it got to.
        (was != 0.0 && !self.rate).then_some(Value::Real(0.0))
    }

    /// Whether it has a place of its own, for which it has to be picked up.
    pub(crate) fn is_absolute(&self) -> bool {
        matches!(
            self.kind,
            ControlKind::Fader | ControlKind::Knob | ControlKind::Strip | ControlKind::Axis
        )
    }

    /// Whether its next movement goes to what it drives.
    pub(crate) fn picked_up(&self) -> bool {
        !self.is_absolute()
            || (self.rate && !self.waits)
            || self.pickup.holds()
            || (self.kind == ControlKind::Axis && !self.rate && self.target.is_none())
    }

    /// Where it would take hold, in its unit, as long as it has not.
    pub(crate) fn awaits(&self) -> Option<f64> {
        let share = self.target.filter(|_| !self.rate && !self.picked_up())?;
        Some(match self.ends()? {
            [low, high] => low + (high - low) * share,
        })
    }

    pub(crate) fn is_live(&self, now_secs: f64) -> bool {
        let goes = self.rate && self.value != 0.0;
        goes || self.moved_secs.is_some_and(|at| now_secs - at < LIVE_SECS)
    }

    /// Whether a hand is on it, as far as that can be told: nothing is sent back to it then.
    pub(crate) fn is_in_hand(&self, now_secs: f64) -> bool {
        let mut said = [self.heard_secs, self.moved_secs].into_iter().flatten();
        self.muted || self.touched || said.any(|at| now_secs - at < OWN_SECS)
    }

    /// A value of its output as a share of its range, and back.
    pub(crate) fn share_of(&self, sent: f64) -> f64 {
        if self.kind == ControlKind::Axis {
            f64::midpoint(sent, 1.0)
        } else {
            sent
        }
    }

    /// The counts at a share of its range.
    pub(crate) fn counts_at(&self, share: f64) -> i32 {
        let ends = self.measured.map_or(self.range, |measured| measured.ends);
        let [low, high] = ends.map(f64::from);
        (low + (high - low) * share.clamp(0.0, 1.0)).round() as i32
    }

    /// The ends of its value, where it has any.
    pub(crate) fn ends(&self) -> Option<[f64; 2]> {
        match self.kind {
            ControlKind::Axis => Some([-1.0, 1.0]),
            ControlKind::Dial | ControlKind::Ring => None,
            _ => Some([0.0, 1.0]),
        }
    }

    /// The word of its mode.
    pub(crate) fn mode(&self) -> &'static str {
        match self.kind {
            ControlKind::Button => self.button.mode.word(),
            ControlKind::Dial | ControlKind::Ring => "relative",
            ControlKind::Axis if self.rate => RATE,
            _ => self.pickup.way().word(),
        }
    }

    /// Takes a word of `NAME_MODE`; an empty one is what it was built with. False for one it has no use for.
    pub(crate) fn set_mode(&mut self, word: &str) -> bool {
        let is = |known: &str| known.eq_ignore_ascii_case(word);
        if word.is_empty() {
            self.go_by_speed(false);
            self.button.mode = super::button::ButtonMode::default();
            self.pickup.choose(way_built(self.kind));
            return true;
        }
        let mode = super::button::ButtonMode::WORDS
            .iter()
            .find(|(known, _)| is(known));
        let way = Way::WORDS.iter().find(|(known, _)| is(known));
        match (self.kind, mode, way) {
            (ControlKind::Button, Some((_, mode)), _) => self.button.mode = *mode,
            (_, _, Some((_, way))) if self.is_absolute() => {
                self.go_by_speed(false);
                self.pickup.choose(*way);
            }
            (ControlKind::Axis, ..) if is(RATE) => self.go_by_speed(true),
            _ => return false,
        }
        true
    }

    fn go_by_speed(&mut self, on: bool) {
        if self.rate != on {
            self.rate = on;
            self.sent_secs = None;
            self.release();
        }
    }

    /// Takes a dead zone; none is what it was built with.
    pub(crate) fn set_zone(&mut self, zone: Option<f64>) {
        self.zone_told = zone;
        self.choose_zone();
    }

    /// A rest that was measured has its own quiet middle.
    fn choose_zone(&mut self) {
        let rests = self.measured.is_some_and(|measured| measured.rest.is_some());
        let built = if rests { 0.0 } else { self.zone_built };
        self.zone = self.zone_told.unwrap_or(built);
    }
}

/// A finger lands anywhere on a strip, so what it drives goes as far as the finger.
fn way_built(kind: ControlKind) -> Way {
    match kind {
        ControlKind::Strip => Way::Relative,
        _ => Way::Pickup,
    }
}

fn unit(kind: ControlKind, unit: Option<ControlUnit>) -> &'static str {
    match (kind, unit) {
        (ControlKind::Button, _) => "",
        (ControlKind::Dial | ControlKind::Ring, _) | (_, Some(ControlUnit::Turns)) => "turns",
        _ => "share",
    }
}

#[cfg(test)]
#[path = "control_tests.rs"]
mod tests;
