//! How often a device speaks and how evenly, from the times of its reports.
//!
//! Pure. Averages over the last reports while it is in use; a pause is no part of the rhythm.

/// Reports farther apart than this are not one movement, seconds.
const PAUSE_SECS: f64 = 0.25;
/// After this time without a report nothing is said of a rate, seconds.
const SILENT_SECS: f64 = 1.0;
/// How much a new gap counts; RFC 3550 (A.8) smooths jitter the same way.
const SHARE: f64 = 1.0 / 16.0;

/// The rhythm of one device.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rhythm {
    heard_secs: Option<f64>,
    gap_secs: Option<f64>,
    /// Seconds.
    jitter: f64,
}

impl Rhythm {
    /// A report came. Several things said at one time are one report.
    pub fn hear(&mut self, secs: f64) {
        let Some(before) = self.heard_secs.replace(secs) else {
            return;
        };
        let gap = secs - before;
        if gap <= 0.0 || gap > PAUSE_SECS {
            return;
        }
        let mean = *self.gap_secs.get_or_insert(gap);
        self.jitter += ((gap - mean).abs() - self.jitter) * SHARE;
        self.gap_secs = Some(mean + (gap - mean) * SHARE);
    }

    /// Reports per second; 0 while it is silent.
    pub fn rate_hz(&self, now_secs: f64) -> f64 {
        let speaks = self
            .heard_secs
            .is_some_and(|heard| now_secs - heard <= SILENT_SECS);
        self.gap_secs.filter(|_| speaks).map_or(0.0, |gap| 1.0 / gap)
    }

    /// Mean distance of a gap from the mean gap, milliseconds; 0 while it is silent.
    pub fn jitter_ms(&self, now_secs: f64) -> f64 {
        if self.rate_hz(now_secs) > 0.0 {
            self.jitter * 1e3
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_device_has_a_rate_and_no_jitter() {
        let mut rhythm = Rhythm::default();
        (0..200).for_each(|n| rhythm.hear(f64::from(n) * 0.008));
        assert!((rhythm.rate_hz(1.6) - 125.0).abs() < 0.1);
        assert!(rhythm.jitter_ms(1.6) < 1e-6);
        assert_eq!(rhythm.rate_hz(3.0), 0.0, "it is silent");
    }

    #[test]
    fn an_uneven_one_has_jitter_and_pauses_do_not_count() {
        let mut rhythm = Rhythm::default();
        let mut secs = 0.0;
        for n in 0..400 {
            secs += if n % 2 == 0 { 0.004 } else { 0.012 };
            rhythm.hear(secs);
            if n % 50 == 49 {
                secs += 10.0;
            }
        }
        assert!((rhythm.rate_hz(secs - 9.9) - 125.0).abs() < 15.0);
        assert!((rhythm.jitter_ms(secs - 9.9) - 4.0).abs() < 0.6, "{rhythm:?}");
    }
}
