//! What a person does to a control device, and the time table a script makes of it.
//!
//! One vocabulary for dial boxes and tablets, so that scripts, panels and tests move simulated devices
//! the same way. A device refuses what it has no control for.

use std::collections::VecDeque;

/// One doing of a hand.
#[derive(Clone, Debug, PartialEq)]
pub enum Touch {
    /// Turns dial `control` by `by`, evenly spread over `over_us` (0: at once). Positive is clockwise.
    Dial {
        /// Number as on the device.
        control: u8,
        /// How far.
        by: Turn,
        /// Duration in microseconds.
        over_us: u64,
    },
    /// Presses or lets go of button `control`.
    Button {
        /// Number as on the device.
        control: u8,
        /// True: pressed.
        down: bool,
    },
    /// Moves fader, knob, lever or other control with a place of its own to `to`, evenly over `over_us` (0: at once).
    Axis {
        /// Number as on the device.
        control: u8,
        /// Share of its travel, 0 to 1; −1 to 1 where it springs back to the middle.
        to: f64,
        /// Duration in microseconds.
        over_us: u64,
    },
    /// Lays a finger on a ring or strip, or lifts it.
    Ring {
        /// Number as on the device.
        control: u8,
        /// Where, as a share of the way round or along, 0 to 1; none: no finger.
        at: Option<f64>,
    },
    /// Pulls the plug and puts it back.
    PowerCycle,
    /// Nobody's doing: so many bytes of nonsense reach the host, as from a loose plug.
    Noise(u16),
    /// Holds the pen so.
    Pen(Pen),
    /// Holds the puck so.
    Puck(Puck),
    /// Lifts every tool out of reach.
    Away,
    /// Lifts this tool out of reach; on a tablet that sees one tool at a time, whichever is there.
    Lift(Held),
}

/// What a hand may hold over a tablet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Held {
    /// A pen, whichever end down.
    Pen,
    /// A puck.
    Puck,
}

/// How far a dial is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// In the device's own counts.
    Counts(i32),
    /// In degrees; the device rounds to its counts.
    Degrees(f64),
    /// In whole turns; the device rounds to its counts.
    Turns(f64),
}

impl Turn {
    /// Nearest whole number of counts on a dial with `counts_per_turn`.
    pub fn counts(self, counts_per_turn: u32) -> i32 {
        let per_turn = f64::from(counts_per_turn);
        match self {
            Self::Counts(counts) => counts,
            Self::Degrees(degrees) => (degrees / 360.0 * per_turn).round() as i32,
            Self::Turns(turns) => (turns * per_turn).round() as i32,
        }
    }
}

/// A pen near the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pen {
    /// Across the active area, −1 left to 1 right.
    pub x: f64,
    /// Up the active area, −1 bottom to 1 top.
    pub y: f64,
    /// 0 to 1 of what the tablet can measure.
    pub pressure: f64,
    /// The point touches.
    pub tip: bool,
    /// Side buttons, bit 0 is button 1.
    pub buttons: u8,
    /// Held with the eraser end down.
    pub eraser: bool,
    /// Lean towards +x and +y in degrees, −64 to 63.
    pub tilt_deg: [i8; 2],
    /// Which pen of several, for tablets that tell them apart; 0: the one that came with it.
    pub serial: u32,
}

/// A puck on the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Puck {
    /// Across the active area, −1 left to 1 right.
    pub x: f64,
    /// Up the active area, −1 bottom to 1 top.
    pub y: f64,
    /// Buttons, bit 0 is button 1.
    pub buttons: u8,
    /// Wheel clicks since the last report, positive away from the hand.
    pub wheel: i32,
    /// Which puck of several, for tablets that tell them apart; 0: the one that came with it.
    pub serial: u32,
}

/// A device that hands can touch.
pub trait Hands {
    /// Does `touch` at `now_us`. False when the device has no such control: nothing happens then.
    fn touch(&mut self, now_us: u64, touch: &Touch) -> bool;

    /// When the host first switched reporting on; scripts count from there.
    fn reporting_since_us(&self) -> Option<u64>;
}

/// So many bytes of nonsense, the same for the same number: what a simulation says twice it says the same way.
pub(crate) fn noise(bytes: u16) -> Vec<u8> {
    let mut chance = fastrand::Rng::with_seed(u64::from(bytes));
    std::iter::repeat_with(|| chance.u8(..))
        .take(usize::from(bytes))
        .collect()
}

/// Touches waiting for their time, counted from the moment reporting began.
#[derive(Clone, Debug, Default)]
pub(crate) struct Schedule {
    since_ns: Option<u64>,
    waiting: VecDeque<(u64, Touch)>,
}

impl Schedule {
    /// Adds what `script` does.
    pub(crate) fn play(&mut self, script: &crate::script::Script) {
        self.add(
            script
                .actions
                .iter()
                .map(|action| (action.at_us, action.touch.clone())),
        );
    }

    /// Adds `actions` (microseconds after the start of reporting), keeping the whole in order of time.
    pub(crate) fn add(&mut self, actions: impl Iterator<Item = (u64, Touch)>) {
        self.waiting.extend(actions);
        self.waiting.make_contiguous().sort_by_key(|&(at_us, _)| at_us);
    }

    /// Reporting is on at `at_ns`; only the first time counts.
    pub(crate) fn begin(&mut self, at_ns: u64) {
        self.since_ns.get_or_insert(at_ns);
    }

    pub(crate) fn since_us(&self) -> Option<u64> {
        self.since_ns.map(|ns| ns / 1000)
    }

    /// When the next touch is due.
    pub(crate) fn next_ns(&self) -> Option<u64> {
        let (at_us, _) = self.waiting.front()?;
        Some(self.since_ns? + at_us * 1000)
    }

    /// Takes the next touch; to be called when `next_ns` has come.
    pub(crate) fn pop(&mut self) -> Option<Touch> {
        self.waiting.pop_front().map(|(_, touch)| touch)
    }

    /// Whether nothing is left to do.
    pub(crate) fn is_done(&self) -> bool {
        self.waiting.is_empty()
    }
}
