//! Turns and pushes that take time: single counts at evenly spaced moments.

/// Movements of several controls in progress.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ramps {
    all: Vec<Ramp>,
}

#[derive(Clone, Copy, Debug)]
struct Ramp {
    control: u8,
    from_us: u64,
    over_us: u64,
    counts: i32,
    done: u32,
}

impl Ramp {
    fn next_us(&self) -> u64 {
        let total = u128::from(self.counts.unsigned_abs());
        self.from_us + (u128::from(self.over_us) * u128::from(self.done + 1) / total) as u64
    }
}

impl Ramps {
    /// Ends the movements of `control` that are under way.
    pub(crate) fn stop(&mut self, control: u8) {
        self.all.retain(|ramp| ramp.control != control);
    }

    /// Moves `control` by `counts` over `over_us` from `now_us` on, beside movements still under way.
    pub(crate) fn begin(&mut self, now_us: u64, control: u8, counts: i32, over_us: u64) {
        if counts != 0 {
            self.all.push(Ramp {
                control,
                from_us: now_us,
                over_us,
                counts,
                done: 0,
            });
        }
    }

    /// When the next single count is made.
    pub(crate) fn next_us(&self) -> Option<u64> {
        self.all.iter().map(Ramp::next_us).min()
    }

    /// Makes every count due at `at_us`: control and sum of counts, for each control that moved.
    pub(crate) fn step(&mut self, at_us: u64, mut moved: impl FnMut(u8, i32)) {
        for ramp in &mut self.all {
            let mut by = 0;
            while ramp.done < ramp.counts.unsigned_abs() && ramp.next_us() <= at_us {
                ramp.done += 1;
                by += ramp.counts.signum();
            }
            if by != 0 {
                moved(ramp.control, by);
            }
        }
        self.all.retain(|ramp| ramp.done < ramp.counts.unsigned_abs());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_come_evenly_and_all_of_them() {
        let mut ramps = Ramps::default();
        ramps.begin(1000, 2, -4, 4000);
        let mut seen = Vec::new();
        while let Some(at) = ramps.next_us() {
            ramps.step(at, |control, by| seen.push((at, control, by)));
        }
        assert_eq!(seen, [(2000, 2, -1), (3000, 2, -1), (4000, 2, -1), (5000, 2, -1)]);
        ramps.begin(0, 0, 1000, 0);
        ramps.step(0, |_, by| assert_eq!(by, 1000));
        assert_eq!(ramps.next_us(), None);
    }
}
