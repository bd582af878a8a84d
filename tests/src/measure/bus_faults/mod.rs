//! Whether a bus ever returns a value that is old or another servo's, under every fault the simulator has.
//!
//! Servos lie torque-free on the bench, and a hand moves each before every cycle to a count that nobody else has and
//! that it has not had for long: so each value that comes back says whose it is and of which cycle. The simulator's
//! own register is the judge. Everything runs in virtual time, from seeds.
//! Damaged values are told as well: sums of eight bits let one damaged packet in 256 pass.

mod chain;
mod recovery;
mod trial;

use super::{Row, Tell};
use chain::CHAINS;
use trial::{Judged, Trial};

/// Name of the measure.
pub const NAME: &str = "bus-faults";

/// Cycles of the whole measure.
const CYCLES: u64 = 1_000_000;

/// What goes wrong, by the simulator's names. Each comes again and again, so that its beginning and its end are tried
/// as well as its middle.
pub(crate) const FAULTS: [&str; 26] = [
    "",
    "servo 2 silent",
    "servo 2 silent for 40ms every 130ms",
    "servo 2 deaf for 40ms every 130ms",
    "servo 2 drop 30%",
    "servo 2 flips 3%",
    "servo 2 late 3ms for 20ms every 60ms",
    "servo 2 late 30ms once",
    "servo 2 late 25ms for 10ms every 110ms",
    "servo 3 reboot every 700ms",
    "servo 2 drift 20000",
    "servo 2 id 3 for 60ms every 300ms",
    "servo 2 baud 57600 for 60ms every 300ms",
    "servo 2 error 4 for 100ms every 300ms",
    "firmware without fast read",
    "drop 1%",
    "drop 20%",
    "late 2ms for 10ms every 50ms",
    "late 30ms once",
    "noise 1%",
    "noise 0.1%",
    "stall 30ms every 150ms",
    "stall 300ms every 900ms",
    "host stall 40ms every 170ms",
    "echo",
    "adapter latency 4ms",
];

/// Faults of the supply and the cable, which take servos away and bring them back restarted.
pub(crate) const CUTS: [&str; 3] = [
    "cable cut after 3 for 200ms every 900ms",
    "data cut after 3 for 60ms every 200ms",
    "brownout for 100ms every 900ms",
];

/// Takes the measure.
pub fn take(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    let faults: Vec<&str> = FAULTS.into_iter().chain(CUTS).collect();
    let trials = (faults.len() * CHAINS.len()) as u64;
    let cycles = CYCLES.div_ceil(trials);
    let mut all = Judged::default();
    for chain in &CHAINS {
        let mut of_chain = Judged::default();
        for (seed, fault) in faults.iter().enumerate() {
            let mut trial = Trial::new(chain, fault, seed as u64)?;
            let judged = trial.run(cycles)?;
            eprintln!("{}, \"{fault}\": {judged:?}", chain.name);
            of_chain.add(&judged);
        }
        tell_judged(tell, chain.name, &of_chain);
        all.add(&of_chain);
    }
    tell_judged(tell, "all", &all);
    recovery::take(tell)
}

fn tell_judged(tell: &mut Tell<'_>, name: &str, judged: &Judged) {
    let rows = [
        ("cycles", judged.cycles),
        ("values read", judged.fresh),
        ("stale values", judged.stale),
        ("values of another servo", judged.of_another),
        ("values damaged on the way", judged.damaged),
    ];
    for (what, count) in rows {
        tell(&Row {
            measure: NAME,
            row: format!("{name}: {what}"),
            subject: "dialrig",
            value: count as f64,
            best: count as f64,
            unit: "count",
            limit: None,
            ratio: None,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Enough for every fault to come and go some times.
    const CYCLES: u64 = 250;

    #[test]
    fn no_fault_makes_a_bus_return_an_old_value_or_another_servos() {
        for chain in &CHAINS {
            for (seed, fault) in FAULTS.into_iter().chain(CUTS).enumerate() {
                let mut trial = Trial::new(chain, fault, seed as u64).expect("a bus and a fault");
                let judged = trial.run(CYCLES).expect("the line holds");
                let wrong = (judged.stale, judged.of_another);
                assert_eq!(wrong, (0, 0), "{}, \"{fault}\": {judged:?}", chain.name);
                assert!(judged.fresh > CYCLES, "{}, \"{fault}\": {judged:?}", chain.name);
            }
        }
    }
}
