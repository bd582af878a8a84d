//! Whether a puppet ever lunges: random clips, orders, faults and reconnections, judged by the simulated shafts.
//!
//! One run is one seed: a shipped puppet, where its joints hang, what is asked of it and what goes wrong. What counts
//! is not what was sent but what the shafts did (`shafts`): none turns faster than its joint's limit, none has left its
//! place when torque comes on by more than its acceleration allows since, none leaves its range, and none has torque
//! when all is over. Time is virtual and everything repeats exactly.

mod asking;
mod shafts;
mod stage;

use device_profiles::Profiles;
use stage::Stage;

/// The puppets in turn: small ones, of every protocol that a shipped puppet has.
const PUPPETS: [&str; 5] = [
    "starter",
    "so-101",
    "koch-v1-1",
    "stack-chan",
    "openmanipulator-x",
];

/// What came of one run.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The puppet.
    pub puppet: &'static str,
    /// What was wrong; empty is how it should be.
    pub wrong: Vec<String>,
    /// What was asked and what went wrong, in order.
    pub story: Vec<String>,
    /// Times torque came on at a servo.
    pub torque_ons: u64,
    /// How far all shafts turned under torque together, radians.
    pub turned_rad: f64,
    /// Faults that were brought in, cables pulled, and pauses of the host.
    pub disturbances: u64,
    /// Highest true speed of a shaft as a share of its joint's limit.
    pub speed_ratio: f64,
    /// Farthest that a shaft was from where it stood, when torque had come on within the last look, in counts.
    pub start_counts: f64,
    /// Virtual time, seconds.
    pub secs: f64,
}

/// One run.
pub fn run(seed: u64, profiles: &Profiles) -> anyhow::Result<Outcome> {
    let puppet = PUPPETS[(seed % PUPPETS.len() as u64) as usize];
    let mut random = fastrand::Rng::with_seed(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x4c75_6e67);
    let mut stage = Stage::new(puppet, profiles, &mut random)?;
    asking::perform(&mut stage, &mut random);
    stage.close();
    Ok(stage.outcome(puppet))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// So many in the suite; `measure lunge` takes many more.
    const RUNS: u64 = 60;

    /// STS servos back from a failure of their power took torque from the next goal, 20 counts away.
    #[test]
    fn a_servo_that_started_over_unseen_is_sent_no_goal() {
        let profiles = Profiles::builtin();
        for seed in [20_181, 95_886] {
            let outcome = run(seed, &profiles).expect("shipped puppets fit their servos");
            assert!(outcome.wrong.is_empty(), "{seed}: {}", outcome.wrong.join("\n"));
        }
    }

    #[test]
    fn nothing_lunges() {
        let profiles = Profiles::builtin();
        let setting = |name: &str, usual| {
            std::env::var(name)
                .ok()
                .and_then(|text| text.parse().ok())
                .unwrap_or(usual)
        };
        let first: u64 = setting("DIALRIG_SEED", 1);
        let (mut torque_ons, mut turned_rad) = (0, 0.0);
        for seed in first..first + setting("DIALRIG_RUNS", RUNS) {
            let outcome = run(seed, &profiles).expect("shipped puppets fit their servos");
            assert!(
                outcome.wrong.is_empty(),
                "DIALRIG_SEED={seed} DIALRIG_RUNS=1, {}: {}",
                outcome.puppet,
                outcome.wrong.join("\n")
            );
            torque_ons += outcome.torque_ons;
            turned_rad += outcome.turned_rad;
        }
        assert!(torque_ons > RUNS, "{torque_ons}: hardly anything was armed");
        assert!(
            turned_rad > RUNS as f64 * 0.3,
            "{turned_rad} rad: hardly anything moved"
        );
    }
}
