//! Faults of a served input device that come at a time of their own.

use std::time::Duration;

use firmware_sim::{InputFault, InputFaultError};

/// A fault with its time, as `drop 3 at 2s`: seconds since reporting began, as in scripts; at once where none is said.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LateFault {
    at: Duration,
    fault: InputFault,
}

impl LateFault {
    /// Reads one. What pulls a cable is none: a cable is pulled by `unplug`, while the device runs.
    pub fn parse(text: &str) -> Result<Self, InputFaultError> {
        let flaw = || InputFaultError {
            text: text.to_owned(),
        };
        let (what, at) = match text.rsplit_once(" at ") {
            None => (text, Duration::ZERO),
            Some((what, at)) => {
                let secs = at
                    .trim()
                    .strip_suffix('s')
                    .and_then(|secs| secs.parse::<f64>().ok());
                let at = secs.and_then(|secs| Duration::try_from_secs_f64(secs).ok());
                (what, at.ok_or_else(flaw)?)
            }
        };
        let fault = InputFault::parse(what)?;
        if matches!(fault, InputFault::UnplugAfterRequests(_)) {
            return Err(flaw());
        }
        Ok(Self { at, fault })
    }
}

/// Those that are still to come.
#[derive(Debug, Default)]
pub struct LateFaults(Vec<LateFault>);

impl LateFaults {
    pub(super) fn add(&mut self, fault: LateFault) {
        self.0.push(fault);
    }

    /// Takes one that is due, on a device that has been reporting `since_us`.
    pub(super) fn take(&mut self, since_us: Option<u64>, now_us: u64) -> Option<InputFault> {
        let since_us = since_us.filter(|_| !self.0.is_empty())?;
        let due = |late: &LateFault| since_us + late.at.as_micros() as u64 <= now_us;
        let place = self.0.iter().position(due)?;
        Some(self.0.remove(place).fault)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_may_have_its_time() {
        let late = |text| LateFault::parse(text).map(|late| (late.at.as_millis(), late.fault));
        assert_eq!(late("drop 3 at 2.5s"), Ok((2500, InputFault::Drop(3))));
        assert_eq!(late("garbage"), Ok((0, InputFault::Garbage)));
        for text in ["drop 3 at noon", "drop 3 at -1s", "unplug after 2", "stuck"] {
            let error = late(text).expect_err(text).to_string();
            assert!(error.ends_with(&format!("found `{text}`")), "{error}");
        }
    }
}
