//! Time as a strip: where a moment is between left and right, and which times deserve a mark.
//!
//! Shared by the transport in the window and by the strip under a film.

/// Seconds along a strip of some width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timeline {
    /// Time at the left edge, seconds.
    pub start_secs: f64,
    /// Time at the right edge, seconds; always after the start.
    pub end_secs: f64,
    /// Left edge, points or pixels.
    pub left: f32,
    /// Right edge.
    pub right: f32,
}

impl Timeline {
    /// A clip's time over a strip; a clip without length gets one second.
    pub fn new(start_secs: f64, end_secs: f64, left: f32, right: f32) -> Timeline {
        let end_secs = if end_secs > start_secs + 1e-6 {
            end_secs
        } else {
            start_secs + 1.0
        };
        Timeline {
            start_secs,
            end_secs,
            left,
            right,
        }
    }

    /// Where a moment is; not clamped.
    pub fn x(&self, secs: f64) -> f32 {
        let share = (secs - self.start_secs) / (self.end_secs - self.start_secs);
        self.left + (f64::from(self.right - self.left) * share) as f32
    }

    /// Which moment is at `x`, clamped to the strip.
    pub fn secs(&self, x: f32) -> f64 {
        let share = f64::from((x - self.left) / (self.right - self.left).max(1.0)).clamp(0.0, 1.0);
        self.start_secs + (self.end_secs - self.start_secs) * share
    }

    /// Distance between marks, seconds, such that neighbours are at least `apart` from each other.
    pub fn mark_step_secs(&self, apart: f32) -> f64 {
        let per_unit = (self.end_secs - self.start_secs) / f64::from((self.right - self.left).max(1.0));
        let least = per_unit * f64::from(apart);
        let steps = [
            0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0,
        ];
        steps.into_iter().find(|&step| step >= least).unwrap_or(least)
    }

    /// The moments that get a mark.
    pub fn marks_secs(&self, apart: f32) -> impl Iterator<Item = f64> + use<> {
        let step = self.mark_step_secs(apart);
        let first = (self.start_secs / step - 1e-9).ceil() as i64;
        let last = (self.end_secs / step + 1e-9).floor() as i64;
        (first..=last).map(move |mark| mark as f64 * step)
    }
}

/// A time as people read it: `0.48`, `1:02.50`; seconds with two decimals.
pub fn clock_text(secs: f64) -> String {
    let hundredths = (secs.abs() * 100.0).round() as u64;
    let sign = if secs < 0.0 && hundredths > 0 { "-" } else { "" };
    let (minutes, rest) = (hundredths / 6000, hundredths % 6000);
    if minutes == 0 {
        format!("{sign}{}.{:02}", rest / 100, rest % 100)
    } else {
        format!("{sign}{minutes}:{:02}.{:02}", rest / 100, rest % 100)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        let line = Timeline::new(1.0, 3.0, 100.0, 300.0);
        assert_eq!(line.x(2.0), 200.0);
        assert!((line.secs(250.0) - 2.5).abs() < 1e-6);
        assert_eq!(line.secs(-50.0), 1.0);
        assert_eq!(line.secs(900.0), 3.0);
    }

    #[test]
    fn marks_are_round_and_never_crowd() {
        let line = Timeline::new(0.0, 2.4, 0.0, 600.0);
        let marks: Vec<f64> = line.marks_secs(60.0).collect();
        assert_eq!(marks.len(), 5);
        assert!((marks[1] - 0.5).abs() < 1e-12);
        assert!(Timeline::new(0.0, 0.0, 0.0, 0.0).marks_secs(60.0).count() < 100);
    }

    #[test]
    fn times_read_well() {
        for (secs, want) in [
            (0.0, "0.00"),
            (0.484, "0.48"),
            (59.999, "1:00.00"),
            (62.5, "1:02.50"),
            (-0.5, "-0.50"),
        ] {
            assert_eq!(clock_text(secs), want);
        }
    }
}
