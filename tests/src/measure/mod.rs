//! The comparisons that issues and docs quote: each side by side in one run, repetitions taken in turn, medians.
//!
//! One file a measure. A row is one line of JSON; which way is better is said by [`MEASURES`], which `--list`
//! prints. Source of the form: `docs/cli.md`, "measure".

pub mod bus;
pub mod bus_faults;
pub mod input;
pub mod interpolant;
pub mod lunge;
pub mod network;
mod port;
pub mod rig_step;
pub mod servo_cycle;

use serde_json::{Value, json};

/// Whoever is told the rows of a measure.
pub type Tell<'a> = dyn FnMut(&Row) + 'a;

/// One measure.
pub struct Measure {
    /// As given on the command line.
    pub name: &'static str,
    /// What is measured, and which way is better.
    pub about: &'static str,
    /// Takes it; rows are told as they are known.
    pub take: fn(&mut Tell<'_>) -> anyhow::Result<()>,
}

/// All measures, in the order in which they are taken.
pub const MEASURES: [Measure; 8] = [
    Measure {
        name: rig_step::NAME,
        about: "One dial report of the simulated box through a whole step of the rig, with the shipped network \
                and show. ns: lower is better. limit: a bare decode of the same bytes by the codec; \
                ratio = value / limit, so it says how many decodes a step costs: lower is better.",
        take: rig_step::take,
    },
    Measure {
        name: input::NAME,
        about: "Input devices, for every layout: ns from the bytes of a report to each of its events, allocations for an \
                event (limit: 0), ns of a whole step of the rig that finds one report at a line; then 8000 reports a \
                second for ten seconds: reports lost (limit: 0), bytes held more at the end than after one second; then \
                ticks of the simulated rig from a dial's byte to the servo's packet (limit: 1). Lower is better \
                everywhere; ratio = value / limit, where the limit is not 0.",
        take: input::take,
    },
    Measure {
        name: interpolant::NAME,
        about: "Clip::place in ns for each link: direction, twist, start and frame, on one core. Lower is \
                better. limit: 60; ratio = value / limit: below 1 is within it.",
        take: interpolant::take,
    },
    Measure {
        name: servo_cycle::NAME,
        about: "A full cycle (sync write of 4 bytes, sync read) of 20 simulated XL430 at 1 Mbaud with the wire's \
                time, in ms. limit: what the bytes really read and written need on the wire; \
                ratio = limit / value: higher is better, 1 is the wire itself, 0.97 is wanted.",
        take: servo_cycle::take,
    },
    Measure {
        name: bus::NAME,
        about: "A full cycle (goals to all, positions of all) of 6, 12 and 20 simulated servos behind a \
                pseudo-terminal with the wire's time, in ms: ours, rustypot, dynamixel2; then four buses at once, of \
                which the slowest is told. limit: what the bytes need on the wire; ratio = limit / value: higher is \
                better, 1 is the wire itself. Wanted: 0.98 at 1 Mbaud, 0.97 (fast: 0.94) at 4 Mbaud, 0.95 of each of \
                four.",
        take: bus::take,
    },
    Measure {
        name: bus_faults::NAME,
        about: "Values that a bus returns under every fault of the simulator, judged by it, in virtual time: stale \
                values, values of another servo and values of nobody must be 0. Then what one servo that falls silent \
                costs the five others: cycles lost, 1 at most; peers: the time of a cycle from then on.",
        take: bus_faults::take,
    },
    Measure {
        name: lunge::NAME,
        about: "Never a lunge: runs of random clips, seeks, orders, faults and reconnections on shipped puppets, judged by \
                the simulated shafts (DIALRIG_RUNS, DIALRIG_SEED). violations: runs in which a shaft was faster than \
                its joint's limit, left its place when torque came on, left its range, or had torque when all was \
                over; limit 0. fastest, start: the worst over all runs, against the limit: 1 and less is within it.",
        take: lunge::take,
    },
    Measure {
        name: network::NAME,
        about: "Messages a second that the function network delivers to inputs: higher is better. dials: eight \
                dial events make 20 messages; chain: 1000 F:ADDC in a row; fan-out: one output to 1000 F:ADDC. \
                limit: Pure Data (pd) with the same graph, if it is installed; ratio = value / limit: higher is \
                better. linear-N: ns that a message costs in a chain of N: lower is better. limit: twice that of \
                100; ratio = value / that of 100: below 2 is within it.",
        take: network::take,
    },
];

/// One line of output.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name of the measure.
    pub measure: &'static str,
    /// Which of its rows.
    pub row: String,
    /// Whose doing it is.
    pub subject: &'static str,
    /// The median.
    pub value: f64,
    /// The best repetition: how near to undisturbed the machine was.
    pub best: f64,
    /// Its unit.
    pub unit: &'static str,
    /// What it is held against; none: nothing.
    pub limit: Option<f64>,
    /// Value against limit, the way round that [`Measure::about`] says.
    pub ratio: Option<f64>,
}

impl Row {
    /// The row as one JSON object. What is not known is `null`.
    pub fn json(&self) -> Value {
        json!({
            "measure": self.measure, "row": self.row, "subject": self.subject, "value": shown(self.value),
            "unit": self.unit, "limit": self.limit.map(shown), "ratio": self.ratio.map(shown), "best": shown(self.best),
        })
    }
}

/// Five digits that count: more would be noise.
fn shown(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}

/// Something to be measured again and again.
pub(crate) struct Subject<'a> {
    pub(crate) row: String,
    pub(crate) name: &'static str,
    /// One repetition; the answer is the measured value.
    pub(crate) repeat: Box<dyn FnMut() -> anyhow::Result<f64> + 'a>,
}

/// What came of all repetitions of a subject.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Taken {
    pub(crate) median: f64,
    pub(crate) least: f64,
    pub(crate) most: f64,
}

/// Takes every subject's repetitions in turn, so that what disturbs the machine disturbs all alike.
pub(crate) fn repeated(subjects: &mut [Subject<'_>], rounds: usize) -> anyhow::Result<Vec<Taken>> {
    let mut values = vec![Vec::with_capacity(rounds); subjects.len()];
    for _ in 0..rounds {
        for (subject, values) in subjects.iter_mut().zip(&mut values) {
            values.push((subject.repeat)()?);
        }
    }
    let taken = values.iter_mut().map(|values| Taken {
        median: median(values),
        least: values.first().copied().unwrap_or(f64::NAN),
        most: values.last().copied().unwrap_or(f64::NAN),
    });
    Ok(taken.collect())
}

/// Sorts, and gives the middle value; of an even number the mean of the two in the middle.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match (values.get(middle.wrapping_sub(1)), values.get(middle)) {
        (Some(below), Some(above)) if values.len().is_multiple_of(2) => f64::midpoint(*below, *above),
        (_, Some(middle)) => *middle,
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_few_and_many() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), 2.5);
        assert_eq!(median(&mut [7.0]), 7.0);
        assert!(median(&mut []).is_nan());
    }

    #[test]
    fn rows_are_flat_objects_with_few_digits() {
        let row = Row {
            measure: "m",
            row: "r".to_owned(),
            subject: "s",
            value: 1.0 / 3.0,
            best: 0.25,
            unit: "ms",
            limit: None,
            ratio: Some(2.0),
        };
        let text = row.json().to_string();
        assert_eq!(
            text,
            r#"{"measure":"m","row":"r","subject":"s","value":0.33333,"unit":"ms","limit":null,"ratio":2.0,"best":0.25}"#
        );
    }
}
