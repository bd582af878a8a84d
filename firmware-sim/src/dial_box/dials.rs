//! Eight dials: where hands have turned them, and what of it the host has been told.
//!
//! A dial's count is 16 bits and wraps. A turn over time is a step of one count at a time at evenly spaced
//! moments; what the line has no room for waits as a difference, never as a queue of reports.

/// How many dials there are.
pub(super) const DIALS: u8 = 8;

/// What a dial report carries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Mode {
    /// The count itself (`30+n`).
    #[default]
    Absolute,
    /// The change since the last report (`40+n`).
    Delta,
}

/// One turn of one dial in progress.
#[derive(Clone, Copy, Debug)]
struct Ramp {
    control: usize,
    from_ns: u64,
    span_ns: u64,
    counts: i32,
    /// Counts already made, without their sign.
    done: u32,
}

impl Ramp {
    /// The moment of the next single count.
    fn next_ns(&self) -> u64 {
        let total = u128::from(self.counts.unsigned_abs());
        self.from_ns + (u128::from(self.span_ns) * u128::from(self.done + 1) / total) as u64
    }
}

/// Counts, masks and turns in progress.
#[derive(Clone, Debug, Default)]
pub(super) struct Dials {
    counts: [i16; DIALS as usize],
    told: [i16; DIALS as usize],
    mask: u16,
    mode: Mode,
    /// The dial after the one last reported: dials take turns on the line.
    next: usize,
    ramps: Vec<Ramp>,
}

impl Dials {
    /// Turns `control` by `counts` over `span_ns`. False: no such dial.
    pub(super) fn turn(&mut self, now_ns: u64, control: u8, counts: i32, span_ns: u64) -> bool {
        let Some(count) = self.counts.get_mut(usize::from(control)) else {
            return false;
        };
        if span_ns == 0 {
            *count = count.wrapping_add(counts as i16);
        } else if counts != 0 {
            self.ramps.push(Ramp {
                control: usize::from(control),
                from_ns: now_ns,
                span_ns,
                counts,
                done: 0,
            });
        }
        true
    }

    /// When a turn in progress makes its next count.
    pub(super) fn next_step_ns(&self) -> Option<u64> {
        self.ramps.iter().map(Ramp::next_ns).min()
    }

    /// Makes every count due at `at_ns`.
    pub(super) fn step(&mut self, at_ns: u64) {
        for ramp in &mut self.ramps {
            if ramp.next_ns() <= at_ns {
                ramp.done += 1;
                let count = &mut self.counts[ramp.control];
                *count = count.wrapping_add(ramp.counts.signum() as i16);
            }
        }
        self.ramps.retain(|ramp| ramp.done < ramp.counts.unsigned_abs());
    }

    /// Host command `50` or `51`: these dials report, from where they stand.
    pub(super) fn report_by_themselves(&mut self, mask: u16, mode: Mode) {
        self.mask = mask;
        self.mode = mode;
        self.told = self.counts;
    }

    /// Initialised: counts at zero, nothing reports. Hands that are turning keep turning.
    pub(super) fn forget(&mut self) {
        self.counts = [0; DIALS as usize];
        self.told = self.counts;
        self.mask = 0;
        self.mode = Mode::Absolute;
        self.next = 0;
    }

    fn differs(&self, dial: usize) -> bool {
        self.mask >> dial & 1 == 1 && self.counts[dial] != self.told[dial]
    }

    pub(super) fn has_report(&self) -> bool {
        (0..usize::from(DIALS)).any(|dial| self.differs(dial))
    }

    /// Takes the next report: number and 16 bits, high byte first.
    pub(super) fn report(&mut self) -> Option<[u8; 3]> {
        let dials = usize::from(DIALS);
        let dial = (0..dials)
            .map(|step| (self.next + step) % dials)
            .find(|&dial| self.differs(dial))?;
        let (base, value) = match self.mode {
            Mode::Absolute => (0x30, self.counts[dial]),
            Mode::Delta => (0x40, self.counts[dial].wrapping_sub(self.told[dial])),
        };
        self.told[dial] = self.counts[dial];
        self.next = (dial + 1) % dials;
        let [high, low] = value.to_be_bytes();
        Some([base + dial as u8, high, low])
    }
}
