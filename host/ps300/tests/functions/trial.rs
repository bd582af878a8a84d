//! Running a row: an instance `f` in a machine of its own, and what it sent and reported.

use glam::{DAffine3, DMat4};
use ps300::language::{Input, literal};
use ps300::{Machine, Value};

use crate::rows::{Row, Step, Wanted};

/// What came out of a row.
pub(crate) struct Outcome {
    /// Name, output and value, in the order of sending.
    pub sent: Vec<(String, u8, Value)>,
    /// All reports, with `; ` between them.
    pub reports: String,
}

/// Runs a row.
pub(crate) fn run(row: &Row) -> Outcome {
    run_as(row, &row.function)
}

/// Runs a row with another function in place of its own.
pub(crate) fn run_as(row: &Row, function: &str) -> Outcome {
    let mut machine = Machine::new();
    let define = format!("f := F:{function}{};", row.size);
    assert_eq!(machine.load(&define), [], "{}", row.place);
    (1..=127).for_each(|output| {
        machine.watch("f", output);
    });
    for step in &row.steps {
        take(&mut machine, step, row);
    }
    machine.settle();
    let sent = machine
        .drain_watched()
        .map(|watched| (watched.name.to_string(), watched.output, watched.value))
        .collect();
    let reports: Vec<_> = machine.reports().iter().map(ToString::to_string).collect();
    Outcome {
        sent,
        reports: reports.join("; "),
    }
}

fn take(machine: &mut Machine, step: &Step, row: &Row) {
    match step {
        Step::Send { input, literal } => {
            if let Some(value) = special(literal) {
                machine
                    .send("f", Input::Number(*input), value)
                    .unwrap_or_else(|error| panic!("{}: {error}", row.place));
                machine.settle();
            } else {
                let command = format!("SEND {literal} TO <{input}>f;");
                assert_eq!(machine.load(&command), [], "{}: {command}", row.place);
            }
        }
        Step::Time(secs) => {
            machine.tick(*secs, (secs * 60.0).round() as u64, 100_000);
        }
        Step::Command(command) => {
            assert_eq!(
                machine.load(&format!("{command};")),
                [],
                "{}: {command}",
                row.place
            );
            for other in row.wanted.iter().filter(|wanted| wanted.name != "f") {
                machine.watch(&other.name, other.output);
            }
        }
    }
}

impl Outcome {
    /// Fails unless this is what the row says.
    pub(crate) fn check(&self, row: &Row, what: &str) {
        let shown: Vec<_> = self
            .sent
            .iter()
            .map(|(name, output, value)| format!("<{output}>{name} {}", literal(value)))
            .collect();
        let context = || {
            format!(
                "{}, F:{}{what}: got {shown:?}, reports {:?}",
                row.place, row.function, self.reports
            )
        };
        assert_eq!(self.sent.len(), row.wanted.len(), "{}", context());
        for (sent, wanted) in self.sent.iter().zip(&row.wanted) {
            assert!(is(sent, wanted), "{}, wanted {wanted:?}", context());
        }
        assert!(self.reports.contains(&row.report), "{}", context());
        assert_eq!(self.reports.is_empty(), row.report.is_empty(), "{}", context());
    }
}

fn is((name, output, value): &(String, u8, Value), wanted: &Wanted) -> bool {
    *name == wanted.name && *output == wanted.output && alike(value, &read(&wanted.literal))
}

/// A value as the rows write it.
fn read(text: &str) -> Value {
    special(text).unwrap_or_else(|| {
        let mut machine = Machine::new();
        assert_eq!(
            machine.load(&format!("VARIABLE v; STORE {text} IN <1>v;")),
            [],
            "{text}"
        );
        machine.held("v").expect("just stored").clone()
    })
}

/// The kind that has no literal: `M4X3` and three rows of four.
fn special(text: &str) -> Option<Value> {
    let rows = text.strip_prefix("M4X3 ")?;
    let mut n: Vec<f64> = rows.split(' ').map(|n| n.parse().expect("a number")).collect();
    n.extend([0.0, 0.0, 0.0, 1.0]);
    let rows: [f64; 16] = n.try_into().expect("twelve numbers");
    Some(DAffine3::from_mat4(DMat4::from_cols_array(&rows).transpose()).into())
}

fn components(value: &Value) -> Vec<f64> {
    match value {
        Value::Real(x) => vec![*x],
        Value::Vector2(v) => v.to_array().to_vec(),
        Value::Vector3(v) => v.to_array().to_vec(),
        Value::Vector4(v) => v.to_array().to_vec(),
        Value::Matrix2(m) => m.to_cols_array().to_vec(),
        Value::Matrix3(m) => m.to_cols_array().to_vec(),
        Value::Matrix4(m) => m.to_cols_array().to_vec(),
        Value::Matrix4x3(m) => m.to_cols_array().to_vec(),
        _ => Vec::new(),
    }
}

/// Equal, reals to twelve digits or so.
pub(crate) fn alike(a: &Value, b: &Value) -> bool {
    let (x, y) = (components(a), components(b));
    let near = x.len() == y.len() && x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 1e-12);
    a.kind() == b.kind() && if x.is_empty() { a == b } else { near }
}
