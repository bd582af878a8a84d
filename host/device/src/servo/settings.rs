//! How a bus is run.

use std::time::Duration;

/// One count of Bus Watchdog (e-manual).
const WATCHDOG_STEP: Duration = Duration::from_millis(20);
/// Highest count of Bus Watchdog (e-manual).
const WATCHDOG_COUNTS_MAX: u128 = 127;
/// One count of Return Delay Time (e-manual).
const RETURN_DELAY_STEP: Duration = Duration::from_micros(2);

/// What is read from every servo each cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Readings {
    /// Present position alone: the shortest cycle there is.
    Position,
    /// Also speed and load, the servo's clock where it has one, and supply and temperature where they lie next to
    /// these: 16 bytes on the X series, 8 on STS and AX.
    Motion,
}

/// How a bus is run. The defaults suit any adapter, and a computer that has other things to do.
#[derive(Debug, Clone, PartialEq)]
pub struct BusSettings {
    /// What the puppet calls the bus; for messages.
    pub name: String,
    /// Line speed.
    pub baud: u32,
    /// What is read each cycle.
    pub readings: Readings,
    /// How long after the wire's own time an answer may come before the servo counts as silent, at most and until
    /// the line has shown how punctual it is.
    pub answer_slack: Duration,
    /// How long around the time at which answers are due a thread that waits for them stays awake, instead of being
    /// woken by them: makes cycles shorter by what waking up takes, and costs that much of a processor.
    pub alert: Duration,
    /// Whether fast sync read is used where every servo asked has it.
    pub fast_reads: bool,
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
            readings: Readings::Motion,
            // The usual latency timer of 16 ms, and some.
            answer_slack: Duration::from_millis(20),
            alert: Duration::ZERO,
            fast_reads: true,
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
