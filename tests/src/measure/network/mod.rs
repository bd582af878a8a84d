//! How many messages a second the function network delivers to inputs, and what a message costs in a large one.
//!
//! Three graphs, each also as a patch of Pure Data that computes the same, taken in turn in one run: the dial
//! network of every PS 300 program, 1000 functions in a row, and one output connected to 1000 inputs. Then chains
//! from 100 to 100 000 functions: a message must not cost more for the network around it. Before anything is timed
//! every graph on either side is checked to compute what it should.
//! Source of the dial network: `docs/protocols/ps300.md`, "Canonical dial network".

mod patch;
mod pure_data;
mod shape;

pub use shape::{DIAL_MESSAGES, LINEAR, Shape, WIDE};

use super::rig_step::nanos_per;
use super::{Row, Subject, Taken, Tell, median, repeated};
use patch::Graph;
use pure_data::PureData;
use std::hint::black_box;

/// Name of the measure.
pub const NAME: &str = "network";

/// Every round starts the peer three times.
const ROUNDS: usize = 21;
/// Timings of one repetition, on either side; its value is their median.
const TIMINGS: usize = 5;
/// Messages of one timing: a tenth of a millisecond or more on either side.
const MESSAGES_A_TIMING: usize = 50_000;
/// Messages of one timing of a linear row; the longest chain takes all of them in a single turn.
const LINEAR_MESSAGES: usize = 100_000;
const LINEAR_ROUNDS: usize = 41;
/// What a message may cost in the largest chain, in multiples of what it costs in the smallest.
const LINEAR_LIMIT: f64 = 2.0;

const GRAPHS: [(&str, Graph); 3] = [
    ("dials", Graph::Dials),
    ("chain", Graph::Chain(WIDE)),
    ("fan-out", Graph::FanOut(WIDE)),
];

/// Takes the measure.
pub fn take(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    beside_the_peer(tell)?;
    linear(tell)
}

fn beside_the_peer(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    let peer = PureData::find()?;
    match &peer {
        Some(peer) => eprintln!("the peer is {}", peer.version()),
        None => eprintln!(
            "Pure Data is not installed: rows without it. On Debian: \
             apt-get install --no-install-recommends puredata-core"
        ),
    }
    let mut subjects = Vec::new();
    for (row, graph) in GRAPHS {
        subjects.push(ours(row, Shape::of(graph)?));
        if let Some(peer) = &peer {
            subjects.push(peers(row, peer, graph)?);
        }
    }
    let taken = repeated(&mut subjects, ROUNDS)?;
    let all: Vec<(&Subject<'_>, Taken)> = subjects.iter().zip(taken).collect();
    for (subject, taken) in &all {
        let against = all
            .iter()
            .find(|(other, _)| other.row == subject.row && other.name == pure_data::NAME)
            .filter(|_| subject.name != pure_data::NAME)
            .map(|(_, taken)| taken.median);
        tell(&Row {
            measure: NAME,
            row: subject.row.clone(),
            subject: subject.name,
            value: taken.median,
            best: taken.most,
            unit: "messages/s",
            limit: against,
            ratio: against.map(|against| taken.median / against),
        });
    }
    Ok(())
}

fn linear(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    let mut subjects = Vec::new();
    for count in LINEAR {
        let mut shape = Shape::of(Graph::Chain(count))?;
        let turns = LINEAR_MESSAGES / shape.messages();
        subjects.push(Subject {
            row: format!("linear-{count}"),
            name: "dialrig",
            repeat: Box::new(move || nanos_per_message(&mut shape, turns)),
        });
    }
    let taken = repeated(&mut subjects, LINEAR_ROUNDS)?;
    let smallest = taken.first().map_or(f64::NAN, |taken| taken.median);
    for (subject, taken) in subjects.iter().zip(taken) {
        tell(&Row {
            measure: NAME,
            row: subject.row.clone(),
            subject: subject.name,
            value: taken.median,
            best: taken.least,
            unit: "ns/message",
            limit: Some(LINEAR_LIMIT * smallest),
            ratio: Some(taken.median / smallest),
        });
    }
    Ok(())
}

fn ours(row: &str, mut shape: Shape) -> Subject<'static> {
    let turns = MESSAGES_A_TIMING / shape.messages();
    let repeat = move || {
        let timings: anyhow::Result<Vec<f64>> = (0..TIMINGS)
            .map(|_| nanos_per_message(&mut shape, turns))
            .collect();
        Ok(1e9 / median(&mut timings?))
    };
    Subject {
        row: row.to_owned(),
        name: "dialrig",
        repeat: Box::new(repeat),
    }
}

fn peers(row: &str, peer: &PureData, graph: Graph) -> anyhow::Result<Subject<'static>> {
    let turns = MESSAGES_A_TIMING / graph.messages();
    let patch = peer.written(graph, turns, TIMINGS)?;
    let repeat = move || {
        let mut took_secs = patch.run()?;
        Ok((turns * graph.messages()) as f64 / median(&mut took_secs))
    };
    Ok(Subject {
        row: row.to_owned(),
        name: pure_data::NAME,
        repeat: Box::new(repeat),
    })
}

fn nanos_per_message(shape: &mut Shape, turns: usize) -> anyhow::Result<f64> {
    let mut quiet = true;
    let nanos = nanos_per(turns * shape.messages(), || {
        for _ in 0..turns {
            quiet &= matches!(black_box(shape.turn()), ps300::Ran::Quiet { .. });
        }
    });
    anyhow::ensure!(quiet, "the network was not quiet after its events");
    Ok(nanos)
}
