//! What a hand shows of a control: a dial by its turns, a fader by its ends, what springs back by letting go.

/// A dial with fewer counts in a turn than this was not turned round.
const COUNTS_PER_TURN_MIN: u64 = 4;
/// Counts back against counts forth, at most, of a hand that turns one way: bearings are loose, turns are not.
const BACK_SHARE_MAX: f64 = 0.1;
/// A fader must be moved this far, share of its range in the profile, for its ends to be believed.
const TRAVEL_SHARE_MIN: f64 = 0.25;
/// Values of a control at rest that say where it rests.
const RESTING_MIN: usize = 2;
/// How much wider the dead zone is than what was seen at rest: a spring never comes back to quite the same place.
const DEAD_FACTOR: i32 = 2;

/// Counts of a dial that is being turned round.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Turning {
    forth: u64,
    back: u64,
}

impl Turning {
    /// It moved.
    pub fn moved(&mut self, delta_counts: i32) {
        let counts = u64::from(delta_counts.unsigned_abs());
        if delta_counts > 0 {
            self.forth += counts;
        } else {
            self.back += counts;
        }
    }

    /// Counts so far, clockwise positive by what the device says.
    pub fn counts(&self) -> i64 {
        self.forth as i64 - self.back as i64
    }

    /// Counts in one turn, after so many whole turns clockwise; negative for a dial that counts the other way.
    pub fn per_turn(&self, turns: u32) -> Result<f64, String> {
        let (most, least) = (self.forth.max(self.back), self.forth.min(self.back));
        if turns == 0 || most - least < COUNTS_PER_TURN_MIN * u64::from(turns) {
            return Err(format!(
                "the dial gave {} counts; turn it clockwise by {}, from mark to mark",
                most - least,
                if turns == 1 {
                    "a whole turn".to_owned()
                } else {
                    format!("{turns} whole turns")
                },
            ));
        }
        if least as f64 > most as f64 * BACK_SHARE_MAX {
            return Err(format!(
                "the dial went {most} counts one way and {least} the other; turn it one way only"
            ));
        }
        Ok(self.counts() as f64 / f64::from(turns))
    }
}

/// Values of an axis that is moved from end to end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sweeping {
    seen: Option<[i32; 2]>,
    last: Option<i32>,
}

impl Sweeping {
    /// It stands there now.
    pub fn moved(&mut self, value: i32) {
        self.last = Some(value);
        let [low, high] = self.seen.get_or_insert([value; 2]);
        (*low, *high) = ((*low).min(value), (*high).max(value));
    }

    /// The lowest and highest value so far.
    pub fn seen(&self) -> Option<[i32; 2]> {
        self.seen
    }

    /// The ends, the one it stands at now last, against the range that the profile gives.
    pub fn ends(&self, range: [i32; 2]) -> Result<[i32; 2], String> {
        let (Some([low, high]), Some(last)) = (self.seen, self.last) else {
            return Err("the control did not move; take it to one end and then to the other".into());
        };
        if low == high {
            return Err(format!(
                "the control did not move from {low}; take it to one end and then to the other"
            ));
        }
        let wanted = (f64::from(range[1]) - f64::from(range[0])).abs() * TRAVEL_SHARE_MIN;
        let travel = f64::from(high) - f64::from(low);
        if travel < wanted.max(1.0) {
            return Err(format!(
                "the control went only from {low} to {high}; take it to one end and then to the other"
            ));
        }
        // It was taken to the upper end last, and hands let go a little beside it.
        let is_high = f64::from(last) - f64::from(low) >= f64::from(high) - f64::from(last);
        Ok(if is_high { [low, high] } else { [high, low] })
    }
}

/// Values of an axis that was let go of, again and again.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Resting {
    rests: Vec<i32>,
}

impl Resting {
    /// It came to rest there, if it moved at all.
    pub fn rests_at(&mut self, value: Option<i32>) {
        self.rests.extend(value);
    }

    /// Where it came to rest so far.
    pub fn all(&self) -> &[i32] {
        &self.rests
    }

    /// How often it did.
    pub fn times(&self) -> usize {
        self.rests.len()
    }

    /// Where it rests, and how many counts to either side mean nothing.
    pub fn rest(&self) -> Result<(i32, i32), String> {
        let mut rests = self.rests.clone();
        rests.sort_unstable();
        let (Some(&low), Some(&high)) = (rests.first(), rests.last()) else {
            return Err("the control has not rested; push it and let go, a few times".into());
        };
        if rests.len() < RESTING_MIN {
            return Err(format!(
                "the control rested once; push it and let go, {RESTING_MIN} times at least"
            ));
        }
        let middle = low.midpoint(high);
        let spread = high.saturating_sub(low).saturating_add(1) / 2;
        Ok((middle, spread.saturating_mul(DEAD_FACTOR).saturating_add(1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(deltas: &[i32]) -> Turning {
        let mut turning = Turning::default();
        for &delta in deltas {
            turning.moved(delta);
        }
        turning
    }

    #[test]
    fn a_turn_is_counted_whatever_way_the_dial_counts() {
        assert_eq!(turned(&[60, 70, 70]).per_turn(1), Ok(200.0));
        assert_eq!(turned(&[-100, -156]).per_turn(1), Ok(-256.0));
        assert_eq!(turned(&[300, -2, 470]).per_turn(3), Ok(256.0));
    }

    #[test]
    fn what_is_no_turn_is_refused() {
        for (deltas, turns) in [
            (&[][..], 1),
            (&[2][..], 1),
            (&[100, -60][..], 1),
            (&[100][..], 0),
            (&[9][..], 3),
        ] {
            assert!(turned(deltas).per_turn(turns).is_err(), "{deltas:?}");
        }
    }

    #[test]
    fn ends_end_where_the_hand_did() {
        let ends = |values: &[i32], range| {
            let mut sweeping = Sweeping::default();
            for &value in values {
                sweeping.moved(value);
            }
            sweeping.ends(range)
        };
        assert_eq!(ends(&[12, 500, 1011, 800], [0, 1023]), Ok([12, 1011]));
        assert_eq!(ends(&[1011, 500, 12], [0, 1023]), Ok([1011, 12]));
        assert_eq!(
            ends(&[700, 12, 1011], [0, 1023]),
            Ok([12, 1011]),
            "it began somewhere"
        );
        assert!(ends(&[500, 500], [0, 1023]).is_err_and(|it| it.contains("did not move")));
        assert!(ends(&[], [0, 1023]).is_err());
        assert!(ends(&[500, 600], [0, 1023]).is_err());
    }

    #[test]
    fn a_spring_that_never_comes_back_to_the_same_place_has_a_dead_zone() {
        let mut resting = Resting::default();
        assert!(resting.rest().is_err());
        resting.rests_at(Some(3));
        assert!(resting.rest().is_err());
        resting.rests_at(Some(-1));
        resting.rests_at(Some(2));
        let (rest, dead) = resting.rest().expect("three rests");
        assert_eq!(rest, 1);
        assert!(
            [3, -1, 2].iter().all(|value: &i32| (value - rest).abs() <= dead),
            "{dead}"
        );
    }
}
