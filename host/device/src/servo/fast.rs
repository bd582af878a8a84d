//! Whether one company of servos is read by fast sync read, where their firmware has it: as long as that works.
//!
//! In a fast read all answer in one packet, so one silent or damaged servo costs those behind it their turn, and some
//! firmware that has the instruction fails at it (users' reports: dynamixel_hardware_interface#79). So it is measured:
//! after a failed fast read the next read is plain, which tells who is missing; after several failures among few
//! reads plain ones are kept for a while, twice as long each time, and then fast ones are tried again.

/// Score of a failure; a success takes one off.
const FAILURE: u8 = 4;
/// Score at which fast reads are given up: three failures in a row, or one in four.
const GIVEN_UP: u8 = 12;
/// Plain reads before the first new attempt, and the most before a later one.
const PLAIN_READS: [u32; 2] = [64, 8192];
/// Successes in a row after which a later failure counts as the first.
const TRUSTED_AFTER: u32 = 256;

/// The choice for one company.
#[derive(Debug, Clone, Copy)]
pub(super) struct FastRead {
    /// Whether every member's firmware has it, as far as was read.
    pub(super) possible: bool,
    plain_left: u32,
    plain_next: u32,
    score: u8,
    run: u32,
}

impl FastRead {
    pub(super) fn new() -> Self {
        Self {
            possible: false,
            plain_left: 0,
            plain_next: PLAIN_READS[0],
            score: 0,
            run: 0,
        }
    }

    /// Whether the next read is to be a fast one. A plain one counts towards the next attempt.
    pub(super) fn choose(&mut self) -> bool {
        if !self.possible {
            return false;
        }
        if self.plain_left > 0 {
            self.plain_left -= 1;
            return false;
        }
        true
    }

    /// How a fast read went.
    pub(super) fn went(&mut self, well: bool) {
        if well {
            self.score = self.score.saturating_sub(1);
            self.run = self.run.saturating_add(1);
            if self.run >= TRUSTED_AFTER {
                self.plain_next = PLAIN_READS[0];
            }
            return;
        }
        self.run = 0;
        self.score += FAILURE;
        self.plain_left = 1;
        if self.score >= GIVEN_UP {
            self.score = 0;
            self.plain_left = self.plain_next;
            self.plain_next = (self.plain_next * 2).min(PLAIN_READS[1]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fast reads among `reads` of which every `fails`th fast one fails.
    fn fast_of(reads: u32, fails: u32) -> u32 {
        let mut fast = FastRead::new();
        fast.possible = true;
        let mut chosen = 0;
        for _ in 0..reads {
            if fast.choose() {
                chosen += 1;
                fast.went(chosen % fails != 0);
            }
        }
        chosen
    }

    #[test]
    fn fast_while_it_works_plain_where_it_does_not() {
        assert_eq!(fast_of(1000, u32::MAX), 1000);
        let rare = fast_of(1000, 20);
        assert!(
            (940..=960).contains(&rare),
            "a lost packet now and then costs one plain read each: {rare}"
        );
        let broken = fast_of(10_000, 1);
        assert!(
            broken <= 3 * 9,
            "given up and tried again, ever more seldom: {broken}"
        );
        let mut fast = FastRead::new();
        assert!(!fast.choose(), "not every firmware has it");
    }

    #[test]
    fn it_comes_back() {
        let mut fast = FastRead::new();
        fast.possible = true;
        for _ in 0..3 {
            while !fast.choose() {}
            fast.went(false);
        }
        let plain = (0..1000).take_while(|_| !fast.choose()).count();
        assert_eq!(plain, 64);
        fast.went(true);
        assert!(fast.choose());
    }
}
