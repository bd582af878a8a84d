//! The counts a joint went through while a hand moved it: unwound where the count jumped, with its ends and the way
//! it went first.

/// A joint that has gone this far from where it began, in turns, has begun to move: eight degrees, more than a hand
/// trembles and less than the shortest travel that is worth having.
const BEGUN_TURNS: f64 = 8.0 / 360.0;

/// The travel of one joint so far.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    counts_per_turn: f64,
    /// The count as it was read last.
    last: Option<i64>,
    /// Counts since the beginning, unwound.
    now: f64,
    low: f64,
    high: f64,
    first: i64,
    zero: f64,
    jumps: u32,
    samples: u64,
    /// 1 or -1: the way it went first after the zero was marked.
    first_way: Option<f64>,
}

impl Sweep {
    /// Nothing seen yet, of a servo with so many counts in a turn.
    pub fn new(counts_per_turn: f64) -> Self {
        Self {
            counts_per_turn,
            last: None,
            now: 0.0,
            low: 0.0,
            high: 0.0,
            first: 0,
            zero: 0.0,
            jumps: 0,
            samples: 0,
            first_way: None,
        }
    }

    /// The count that was read now. A step of more than half a turn is a jump of the count, not of the joint: between
    /// two readings of a hand's movement there is never as much.
    pub fn add(&mut self, counts: i64) {
        self.samples += 1;
        let Some(last) = self.last.replace(counts) else {
            self.first = counts;
            return;
        };
        let step = (counts - last) as f64;
        let turns = (step / self.counts_per_turn).round();
        self.jumps += u32::from(turns != 0.0);
        self.now += step - turns * self.counts_per_turn;
        self.low = self.low.min(self.now);
        self.high = self.high.max(self.now);
        let gone = self.now - self.zero;
        if self.first_way.is_none() && gone.abs() > BEGUN_TURNS * self.counts_per_turn {
            self.first_way = Some(gone.signum());
        }
    }

    /// Where the joint stands now is its zero; the way it goes next is its positive one.
    pub fn mark_zero(&mut self) {
        self.zero = self.now;
        self.first_way = None;
    }

    /// Its zero lies so many counts below the middle of its travel, wherever it was marked.
    pub fn zero_below_middle(&mut self, counts: f64) {
        self.zero = f64::midpoint(self.low, self.high) - counts;
        self.first_way = None;
    }

    /// Readings so far.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Times the count jumped.
    pub fn jumps(&self) -> u32 {
        self.jumps
    }

    /// 1 or -1: the way it went first after the zero was marked; none: it has not moved.
    pub fn first_way(&self) -> Option<f64> {
        self.first_way
    }

    /// From end to end, counts.
    pub fn span_counts(&self) -> f64 {
        self.high - self.low
    }

    /// Lowest, zero and highest place in the servo's counts, unwound around the first reading.
    pub fn places_counts(&self) -> [f64; 3] {
        [self.low, self.zero, self.high].map(|place| self.first as f64 + place)
    }

    /// The place where it stands now, in the same counts; none before the first reading.
    pub fn now_counts(&self) -> Option<f64> {
        self.last.map(|_| self.first as f64 + self.now)
    }
}
