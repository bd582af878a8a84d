//! The measured networks on our side, and what drives them.

use super::patch::Graph;
use anyhow::Context;
use ps300::network::Outlet;
use ps300::{Limits, Machine, Value};
use std::fmt::Write;

/// Functions in the row, and inputs of the fan.
pub const WIDE: usize = 1000;
/// Functions in the rows that show what a message costs in a large network.
pub const LINEAR: [usize; 4] = [100, 1000, 10_000, 100_000];
/// Messages that eight dial events make in the dial network.
pub const DIAL_MESSAGES: usize = 20;
/// What every dial sends in one turn, and takes back in the next: exact in single precision too, and far from
/// every limit of the dial network.
pub(super) const STEP: f64 = 0.25;
/// What every function of a row or fan adds. Likewise exact.
pub(super) const ADDEND: f64 = 1.0;
/// Firings a tick may take: more than any shape needs.
const FIRINGS_MAX: u32 = 1_000_000;
const SECS_A_FRAME: f64 = 1.0 / 60.0;

const DIALS: &str = include_str!("../../../../host/ps300/tests/data/dials.ps300");

/// One of the networks, with what drives it.
pub struct Shape {
    machine: Machine,
    dials: Vec<Outlet>,
    messages: usize,
    frame: u64,
}

impl Shape {
    /// The dial network.
    pub fn dials() -> anyhow::Result<Self> {
        Self::of(Graph::Dials)
    }

    /// [`WIDE`] F:ADDC, each connected to the next.
    pub fn chain() -> anyhow::Result<Self> {
        Self::chain_of(WIDE)
    }

    /// `count` F:ADDC, each connected to the next.
    pub fn chain_of(count: usize) -> anyhow::Result<Self> {
        Self::of(Graph::Chain(count))
    }

    /// One dial connected to [`WIDE`] F:ADDC.
    pub fn fan_out() -> anyhow::Result<Self> {
        Self::of(Graph::FanOut(WIDE))
    }

    /// The network of a graph, which has been seen to compute what it should.
    pub(super) fn of(graph: Graph) -> anyhow::Result<Self> {
        let text = match graph {
            Graph::Dials => DIALS.to_owned(),
            Graph::Chain(count) => row(count, |at| match at {
                0 => "DIALS<1>".to_owned(),
                _ => format!("n{}<1>", at - 1),
            })?,
            Graph::FanOut(count) => row(count, |_| "DIALS<1>".to_owned())?,
        };
        let dials = if matches!(graph, Graph::Dials) { 8 } else { 1 };
        let mut shape = Self::loaded(&text, dials, graph.messages())?;
        shape.check(graph)?;
        Ok(shape)
    }

    fn loaded(text: &str, dials: u8, messages: usize) -> anyhow::Result<Self> {
        let mut machine = Machine::with_limits(Limits {
            // The longest row and the devices, and all of it after one message.
            instances_max: 2 * LINEAR[LINEAR.len() - 1],
            firings_per_batch: FIRINGS_MAX,
            ..Limits::default()
        });
        if let Some(diagnostic) = machine.load(text).first() {
            anyhow::bail!("the measured network does not load: {diagnostic:?}");
        }
        let outlet = |dial| machine.outlet("DIALS", dial).context("there are eight dials");
        Ok(Self {
            dials: (1..=dials).map(outlet).collect::<anyhow::Result<_>>()?,
            machine,
            messages,
            frame: 0,
        })
    }

    /// Messages that one [`Shape::turn`] delivers to inputs.
    pub fn messages(&self) -> usize {
        self.messages
    }

    /// One event of every dial in use, forth and back in turn, and the network run until it is quiet.
    pub fn turn(&mut self) -> ps300::Ran {
        let step = if self.frame.is_multiple_of(2) { STEP } else { -STEP };
        for &dial in &self.dials {
            self.machine.emit_from(dial, step);
        }
        self.frame += 1;
        self.machine
            .tick(self.frame as f64 * SECS_A_FRAME, self.frame, FIRINGS_MAX)
    }

    /// Turns forth and back once, and looks at what the ends say in between.
    fn check(&mut self, graph: Graph) -> anyhow::Result<()> {
        let ends = graph.ends();
        for (name, _) in &ends {
            anyhow::ensure!(self.machine.watch(name, 1), "{name} has no output");
        }
        self.turn();
        let seen: Vec<_> = self.machine.drain_watched().collect();
        for (name, wanted) in &ends {
            let last = seen.iter().rev().find(|watched| watched.name.as_str() == name);
            let got = last.map(|watched| numbers(&watched.value)).unwrap_or_default();
            anyhow::ensure!(near(&got, wanted), "{name} says {got:?}, expected {wanted:?}");
            self.machine.unwatch(name, 1);
        }
        self.turn();
        anyhow::ensure!(self.machine.reports().is_empty(), "messages were lost");
        Ok(())
    }
}

/// Functions that add [`ADDEND`], each fed by what `from` says.
fn row(count: usize, from: impl Fn(usize) -> String) -> anyhow::Result<String> {
    let mut text = String::new();
    for at in 0..count {
        let from = from(at);
        writeln!(
            text,
            "n{at} := F:ADDC; SEND {ADDEND:?} TO <2>n{at}; CONNECT {from}:<1>n{at};"
        )?;
    }
    Ok(text)
}

/// The numbers of a message, matrices row by row.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Real(number) => vec![*number],
        Value::Vector3(vector) => vector.to_array().to_vec(),
        Value::Matrix3(matrix) => matrix.transpose().to_cols_array().to_vec(),
        _ => Vec::new(),
    }
}

/// Whether two lists say the same as far as single precision and six printed digits go.
pub(super) fn near(got: &[f64], wanted: &[f64]) -> bool {
    let close = |(got, wanted): (&f64, &f64)| (got - wanted).abs() <= 1e-5 * wanted.abs().max(1.0);
    got.len() == wanted.len() && got.iter().zip(wanted).all(close)
}
