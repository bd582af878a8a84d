//! How a bus is run.

use std::time::Duration;

/// One count of Bus Watchdog (e-manual).
const WATCHDOG_STEP: Duration = Duration::from_millis(20);
/// Highest count of Bus Watchdog (e-manual).
const WATCHDOG_COUNTS_MAX: u128 = 127;
/// One count of Return Delay Time (e-manual).
const RETURN_DELAY_STEP: Duration = Duration::from_micros(2);

/// How a bus is run. The defaults suit a USB adapter whose latency timer is at 1 to 4 ms.
#[derive(Debug, Clone, PartialEq)]
pub struct BusSettings {
    /// What the puppet calls the bus; for messages.
    pub name: String,
    /// Line speed.
    pub baud: u32,
    /// How long after the wire's own time an answer may come before the servo counts as silent.
    pub answer_slack: Duration,
    /// After so long without packets servos stop by themselves; 20 ms to 2540 ms.
    pub watchdog: Duration,
    /// Return Delay Time in steps of 2 us; 0 is fastest, some chains need 1.
    pub return_delay_counts: u8,
    /// Silence on the line after a missing answer, before the next question of arming or maintenance.
    pub quiet: Duration,
    /// A servo this warm is not armed, and reported while it runs.
    pub hot_c: f64,
    /// How often errors, torque, watchdog and supply are read in turn.
    pub health_interval: Duration,
    /// Cycles between attempts to hear a servo that does not answer.
    pub probe_cycles: u32,
}

impl BusSettings {
    /// The usual settings.
    pub fn new(name: &str, baud: u32) -> Self {
        Self {
            name: name.to_owned(),
            baud,
            answer_slack: Duration::from_millis(8),
            watchdog: Duration::from_millis(200),
            return_delay_counts: 0,
            quiet: Duration::from_millis(40),
            // 5 below the lowest factory Temperature Limit of the X series (70 C).
            hot_c: 65.0,
            health_interval: Duration::from_millis(100),
            probe_cycles: 50,
        }
    }

    pub(super) fn watchdog_counts(&self) -> u8 {
        let counts = self.watchdog.as_nanos().div_ceil(WATCHDOG_STEP.as_nanos());
        counts.clamp(1, WATCHDOG_COUNTS_MAX) as u8
    }

    pub(super) fn return_delay(&self) -> Duration {
        RETURN_DELAY_STEP * u32::from(self.return_delay_counts)
    }
}
