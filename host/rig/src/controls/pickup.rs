//! Soft pickup: how a control that has a place of its own gets hold of a value that stands elsewhere, without a step.
//!
//! Pure: shares of the control's range and seconds in, at most one share out. It must not know devices, parameters
//! or what moved them. The decision table is that of Mixxx, `src/controllers/softtakeover.cpp`; what is added to it
//! here mends what its users report (issues 8504 and 9529 of mixxx, 427 of Deluge's firmware):
//!
//! - The table forgets that a control holds its value once it has rested for a moment, and a quick turn then leaves
//!   it behind. Here a control holds until something else moves the value.
//! - Its clock runs from the last value it took, so that a quick turn from afar jumps over the target and never
//!   catches. Here it runs from the last movement: who passes the target in one stroke takes it along.
//! - Switched to another value while it is not moved, it swallows or jumps by what it remembers of the old one.
//!   Here hold ends with the switch, the place of the control stays known.

/// Nearer than this share of the range is near. Source: `softtakeover.cpp`, 3 of 128 steps of MIDI.
pub const NEAR: f64 = 3.0 / 128.0;
/// Two values within this time are one movement, seconds. Source: `softtakeover.cpp`.
pub const MOVEMENT_SECS: f64 = 0.05;
/// What is left of a movement in fine gear. Source: SciAn's Shift.
pub const FINE: f64 = 0.1;

/// How a control gets hold of a value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Way {
    /// It takes hold when it comes near the value or passes it in one movement.
    #[default]
    Pickup,
    /// The value goes to where the control is, as soon as it is moved.
    Jump,
    /// The value goes with it, so that both reach the end together.
    Scaled,
    /// The value goes as far as the control, wherever that is.
    Relative,
}

impl Way {
    /// All, with the words of `NAME_MODE`.
    pub const WORDS: [(&'static str, Self); 4] = [
        ("pickup", Self::Pickup),
        ("jump", Self::Jump),
        ("scaled", Self::Scaled),
        ("relative", Self::Relative),
    ];

    /// The word for it.
    pub fn word(self) -> &'static str {
        let found = Self::WORDS.iter().find(|(_, way)| *way == self);
        found.map_or("pickup", |(word, _)| word)
    }
}

/// What a control knows when it is moved.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Time of the movement, seconds.
    pub secs: f64,
    /// Counts steps of the rig: what was sent in the same one has not acted yet.
    pub step: u64,
    /// Where what it drives stands, as a share of the control's range; beyond it where the control cannot get. None
    /// where nobody knows.
    pub target: Option<f64>,
    /// Fine gear: the value goes a tenth as far as the control, from wherever it is.
    pub fine: bool,
}

/// The pickup of one control.
#[derive(Clone, Debug, Default)]
pub struct Pickup {
    way: Way,
    /// Where the control is, whether or not that was taken; none before it said.
    pub(super) place: Option<f64>,
    pub(super) moved_secs: Option<f64>,
    /// What it set last, in which step.
    pub(super) set: Option<(f64, u64)>,
    /// Where what it drives stood after that.
    pub(super) answer: Option<f64>,
    pub(super) holds: bool,
}

impl Pickup {
    /// Chooses how it gets hold; it begins anew where that is another way.
    pub fn choose(&mut self, way: Way) {
        if self.way != way {
            self.way = way;
            self.release();
        }
    }

    /// How it gets hold.
    pub fn way(&self) -> Way {
        self.way
    }

    /// Where the control is, as a share of its range; none before it said.
    pub fn place(&self) -> Option<f64> {
        self.place
    }

    /// Whether the next movement goes to what it drives.
    pub fn holds(&self) -> bool {
        self.holds
    }

    /// It drives something else now, or what it drives was loaded anew. Where it is stays known.
    pub fn release(&mut self) {
        self.holds = false;
        self.answer = None;
    }

    /// It was gone and may be anywhere.
    pub fn lose(&mut self) {
        self.release();
        self.place = None;
        self.moved_secs = None;
    }

    /// Looks, once a step, where what it drives stands.
    pub fn look(&mut self, step: u64, target: Option<f64>) {
        if !self.holds || self.set.is_none_or(|(_, set_in)| set_in >= step) {
            return;
        }
        match (self.answer, target) {
            (None, target) => self.answer = target,
            (Some(answer), Some(target)) if (target - answer).abs() > NEAR => self.release(),
            _ => {}
        }
    }

    /// The control is at `place` (0 to 1 of its range): what to set, if anything.
    pub fn hear(&mut self, place: f64, at: Moment) -> Option<f64> {
        let before = self.place.replace(place);
        let moved_secs = self.moved_secs.replace(at.secs);
        // The first value says where it is and no more: it may come from a device that tells all it has.
        let before = before?;
        if before == place {
            return None;
        }
        let in_flight = self.set.filter(|(_, step)| *step == at.step).map(|(set, _)| set);
        self.look(at.step, at.target);
        let target = in_flight.or(at.target).or_else(|| self.set.map(|(set, _)| set));
        let quick = moved_secs.is_some_and(|before| at.secs - before <= MOVEMENT_SECS);
        let set = match target {
            Some(target) if at.fine => {
                self.holds = false;
                within(target, target + (place - before) * FINE)
            }
            Some(target) => self.take(target, before, place, quick),
            None => Some(place),
        };
        if let Some(set) = set {
            self.holds = !at.fine;
            self.set = Some((set, at.step));
            self.answer = None;
        }
        set
    }

    fn take(&self, target: f64, before: f64, place: f64, quick: bool) -> Option<f64> {
        match self.way {
            Way::Jump => Some(place),
            Way::Pickup => (self.holds || takes_hold(target, before, place, quick)).then_some(place),
            Way::Scaled => scaled(target, before, place),
            Way::Relative => within(target, target + (place - before)),
        }
    }
}

/// Mixxx's table: whether a control that went from `before` to `now` takes hold of what stands at `target`.
/// `quick` says that this was one movement.
pub fn takes_hold(target: f64, before: f64, now: f64, quick: bool) -> bool {
    let is_near = |place: f64| (place - target).abs() <= NEAR;
    let passes = (before < target) != (now < target);
    is_near(now) || (quick && (passes || is_near(before)))
}

/// A value inside the range, from one that is inside; none where the value lies outside and would be fetched in.
fn within(target: f64, set: f64) -> Option<f64> {
    (0.0..=1.0).contains(&target).then(|| set.clamp(0.0, 1.0))
}

/// The value moved so that what is left of its way to the end is what is left of the control's.
fn scaled(target: f64, before: f64, place: f64) -> Option<f64> {
    let end = if place > before { 1.0 } else { 0.0 };
    let left = end - before;
    if left == 0.0 {
        return within(target, target);
    }
    within(target, end - (end - target) * (end - place) / left)
}

#[cfg(test)]
#[path = "pickup_tests.rs"]
mod tests;
