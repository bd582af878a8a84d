//! What `net run` prints, as numbers and texts to compute with.

use crate::session::Desk;

/// One line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Record {
    pub(crate) secs: f64,
    /// `NAME<N>`.
    pub(crate) from: String,
    pub(crate) value: serde_json::Value,
}

impl Record {
    /// All numbers of the value, matrices row by row.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        fn flat(value: &serde_json::Value, into: &mut Vec<f64>) {
            match value {
                serde_json::Value::Array(parts) => parts.iter().for_each(|part| flat(part, into)),
                one => into.extend(one.as_f64()),
            }
        }
        let mut numbers = Vec::new();
        flat(&self.value, &mut numbers);
        numbers
    }
}

/// Runs a command line that must print nothing but records.
pub(crate) fn records(desk: &Desk, command: &str) -> Vec<Record> {
    let printed = desk.run(command);
    let read = |line: &str| {
        let line: serde_json::Value =
            serde_json::from_str(line).unwrap_or_else(|_| panic!("$ {command}\nprinted: {line}"));
        Record {
            secs: line["t"].as_f64().expect("a time"),
            from: line["from"].as_str().expect("a name").to_owned(),
            value: line["value"].clone(),
        }
    };
    printed.lines().map(read).collect()
}

/// The last value of an output in that run.
pub(crate) fn last<'a>(records: &'a [Record], from: &str) -> Option<&'a Record> {
    records.iter().rev().find(|record| record.from == from)
}

/// Whether all numbers agree but for rounding.
pub(crate) fn is_near(got: &[f64], expected: &[f64]) -> bool {
    got.len() == expected.len()
        && got
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() <= 1e-9 * b.abs().max(1.0))
}
