//! A device that sends 8000 reports a second: is everything taken, in bounded memory?

use super::frames::Layout;
use super::tokens::{Heard, STEP, events};

/// Reports in a second, as fast as USB high speed goes.
const RATE_HZ: u32 = 8_000;
/// Steps of the flood: ten seconds.
const STEPS: u64 = 1_000;
/// Steps after which memory is as large as it gets.
const SETTLED: u64 = 100;

/// What came of it.
pub(super) struct Flooded {
    /// Reports sent.
    pub(super) sent: u64,
    /// Events heard of them.
    pub(super) heard: u64,
    /// Bytes that were held more after nine seconds than after one.
    pub(super) grown_bytes: i64,
}

/// Floods a rig in virtual time.
pub(super) fn flood(layout: &Layout) -> anyhow::Result<Flooded> {
    let mut rig = Heard::new(layout)?;
    let reports = u64::from(RATE_HZ) * STEP.as_millis() as u64 / 1_000;
    let before = events(&rig.step());
    let mut run = |steps: u64| {
        for _ in 0..steps {
            for _ in 0..reports {
                rig.report();
            }
            rig.step();
        }
    };
    run(SETTLED);
    let grown = allocation_counter::measure(|| run(STEPS - SETTLED));
    let heard = events(&rig.step()) - before;
    Ok(Flooded {
        sent: STEPS * reports,
        heard,
        grown_bytes: grown.bytes_current,
    })
}
