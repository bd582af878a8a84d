//! What must hold for any input: one file for each part of the crate.

mod curves;
mod figures;
mod kinetics;
mod robots;

use proptest::prelude::ProptestConfig;
use proptest::test_runner::RngSeed;

/// Cases of one property. The seed is fixed, so that a run says the same as the last one; no file of
/// failures is kept, since proptest prints the shrunk input.
fn cases(cases: u32) -> ProptestConfig {
    // The year of the thesis.
    let rng_seed = RngSeed::Fixed(1989);
    ProptestConfig {
        cases,
        rng_seed,
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}
