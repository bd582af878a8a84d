//! Never a lunge, run after run: see [`crate::lunge`]. `DIALRIG_RUNS` and `DIALRIG_SEED` say how many and from where.

use super::{Row, Tell};
use crate::lunge::{self, Outcome};
use device_profiles::Profiles;

/// Its name.
pub const NAME: &str = "lunge";
/// Runs, if nobody says otherwise: half a minute.
const RUNS: u64 = 2000;
/// Runs between two lines of progress.
const TELL_EVERY: u64 = 5000;

fn setting(name: &str, usual: u64) -> u64 {
    let text = std::env::var(name).ok();
    text.and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// All runs; one that goes wrong is told with its seed, and the rest is taken all the same.
pub fn take(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    let profiles = Profiles::builtin();
    let (first, runs) = (setting("DIALRIG_SEED", 1), setting("DIALRIG_RUNS", RUNS));
    let mut all = Outcome::default();
    let mut violated = 0_u64;
    for seed in first..first + runs {
        let one = lunge::run(seed, &profiles)?;
        if !one.wrong.is_empty() {
            violated += 1;
            if runs == 1 {
                eprintln!("{}", one.story.join("\n"));
            }
            eprintln!(
                "DIALRIG_SEED={seed} DIALRIG_RUNS=1, {}:\n  {}",
                one.puppet,
                one.wrong.join("\n  ")
            );
        }
        all.torque_ons += one.torque_ons;
        all.disturbances += one.disturbances;
        all.turned_rad += one.turned_rad;
        all.secs += one.secs;
        all.speed_ratio = all.speed_ratio.max(one.speed_ratio);
        all.start_counts = all.start_counts.max(one.start_counts);
        let done = seed - first + 1;
        if done % TELL_EVERY == 0 {
            eprintln!("{done} runs, {violated} violated");
        }
    }
    let mut row = |row: &str, value: f64, unit, limit: Option<f64>| {
        tell(&Row {
            measure: NAME,
            row: row.to_owned(),
            subject: "dialrig",
            value,
            best: value,
            unit,
            limit,
            ratio: limit.filter(|limit| *limit > 0.0).map(|limit| value / limit),
        });
    };
    row("violations", violated as f64, "runs", Some(0.0));
    row("runs", runs as f64, "runs", None);
    row("torque-ons", all.torque_ons as f64, "servos", None);
    row("disturbances", all.disturbances as f64, "faults", None);
    row("turned", all.turned_rad, "rad", None);
    row("virtual-time", all.secs, "s", None);
    row("fastest", all.speed_ratio, "of the limit", Some(1.0));
    row("start", all.start_counts, "counts", Some(2.0));
    Ok(())
}
