//! Exchange files: of what both sides said, what the device did.
//!
//! Only the reports are taken here; playing both sides against one another is another matter.

use super::recording::{RecordedDevice, RecordedReport, Recording, hex, seconds};
use std::time::Duration;

/// Whether a text is an exchange.
pub(super) fn is(text: &str) -> bool {
    text.lines().any(|line| said(line).is_some())
}

/// What the device said in a line, if it said something: the time in front, and the bytes as written.
fn said(line: &str) -> Option<(Option<Duration>, &str)> {
    let line = line.split('#').next().unwrap_or_default().trim();
    let (at, line) = match line.strip_prefix('@') {
        Some(timed) => {
            let (time, rest) = timed.trim_start().split_once(char::is_whitespace)?;
            (Some(seconds(time)?), rest.trim_start())
        }
        None => (None, line),
    };
    let bytes = line.strip_prefix("device")?.trim_start().strip_prefix('<')?;
    // The time may stand behind as well.
    match bytes.split_once('@') {
        Some((bytes, time)) => Some((Some(seconds(time.trim())?), bytes.trim())),
        None => Some((at, bytes.trim())),
    }
}

pub(super) fn read(text: &str) -> Recording {
    let mut recording = Recording::default();
    let mut device = RecordedDevice::default();
    let mut now = Duration::ZERO;
    for (line, text) in (1..).zip(text.lines()) {
        if let Some(key) = text.strip_prefix("profile:") {
            let key = key.split('#').next().unwrap_or_default().trim();
            device.profile = Some(key.to_owned());
            key.clone_into(&mut device.name);
            continue;
        }
        let Some((at, bytes)) = said(text) else { continue };
        now = at.unwrap_or(now);
        let mut words = bytes.split_whitespace();
        // Answers to questions are no reports.
        let answer = words
            .next()
            .is_some_and(|word| ["feature", "string", "descriptor", "gone", "back"].contains(&word));
        if answer {
            continue;
        }
        match hex(bytes) {
            Ok(bytes) => recording.reports.push(RecordedReport {
                device: 0,
                at: now,
                bytes,
            }),
            Err(word) => recording.flaw(
                line,
                text.find(word).unwrap_or(0),
                format!("expected bytes as two hexadecimal digits each, found \"{word}\""),
            ),
        }
    }
    recording.devices.push(device);
    recording
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_device_said_is_taken() {
        let recording = read(
            "# a box\nprofile: sgi-dialbox\nhost   > 20\ndevice < 20   # ready\n@ 0.250 device < 33 00 40\n\
             device < string 200 13 03\nevent dial 3 +64\ndevice < 33 00 41 @ 0.300\n",
        );
        assert_eq!(recording.flaws, []);
        assert_eq!(recording.devices[0].profile.as_deref(), Some("sgi-dialbox"));
        let times: Vec<_> = recording.reports.iter().map(|r| r.at.as_millis()).collect();
        assert_eq!(times, [0, 250, 300]);
        assert!(is("device < 20"));
        assert!(!is("E: 0.0 1 20"));
    }
}
