//! Exchange files: of what both sides said, what the device did.
//!
//! The reports are taken, and the conversation as a whole where the file has it from its beginning: what reports mean may
//! depend on what was asked before. Holding both sides against one another is another matter.

use device::codec::Answer;
use device::exchange::{self, What};
use std::time::Duration;

use super::recording::{RecordedDevice, RecordedReport, Recording};

/// What the device of an exchange said; none of a text that is no exchange. Lines that cannot be read are flaws: a
/// recording is worth something without its last line.
pub(super) fn read(text: &str) -> Option<Recording> {
    let (exchange, errors) = exchange::read_readable(text);
    let told = |what: &What| matches!(what, What::Device(_) | What::Answer(_));
    if !exchange.records.iter().any(|record| told(&record.what)) {
        return None;
    }
    // Where only the device has a word, nobody knows how it began.
    let has_host = |what: &What| matches!(what, What::Host(_) | What::Answer(_) | What::Event(_));
    let is_whole = !exchange.head.reporting && exchange.records.iter().any(|record| has_host(&record.what));
    let mut device = RecordedDevice {
        name: exchange.head.profile.clone().unwrap_or_default(),
        profile: exchange.head.profile.clone(),
        conversation: is_whole.then(|| exchange.clone()),
        ..RecordedDevice::default()
    };
    let mut recording = Recording::default();
    let mut now = Duration::ZERO;
    for record in exchange.records {
        now = record.at.unwrap_or(now);
        match record.what {
            What::Device(bytes) => recording.reports.push(RecordedReport {
                device: 0,
                at: now,
                bytes,
            }),
            // Answers to questions are no reports, but this one tells what the reports mean.
            What::Answer(Answer::Descriptor(Ok(descriptor))) => device.descriptor = Some(descriptor),
            _ => {}
        }
    }
    for error in errors {
        let column = error.column.saturating_sub(1) as usize;
        recording.flaw(error.line, column, error.message);
    }
    recording.devices.push(device);
    Some(recording)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_device_said_is_taken() {
        let recording = read(
            "# a box\nprofile: sgi-dialbox\nhost   > 20\ndevice < 20   # ready\n@ 0.250 device < 33 00 40\n\
             device < string 200 13 03\nevent dial 3 +64\ndevice < 33 00 41 @ 0.300\n",
        )
        .expect("an exchange");
        assert_eq!(recording.flaws, []);
        assert_eq!(recording.devices[0].profile.as_deref(), Some("sgi-dialbox"));
        let times: Vec<_> = recording.reports.iter().map(|r| r.at.as_millis()).collect();
        assert_eq!(times, [0, 250, 300]);
        assert!(read("device < 20").is_some());
        assert!(read("E: 0.0 1 20").is_none());
        assert!(read("profile: sgi-dialbox").is_none());
    }

    #[test]
    fn a_file_that_breaks_off_in_the_middle_is_worth_what_is_there() {
        let text = "profile: sgi-dialbox\ndevice < 20 @ 0.1\ndevice < 33 00 40 @ 0.2\n";
        let whole = read(text).expect("an exchange").reports;
        for cut in text.len() - 8..text.len() {
            let recording = read(&text[..cut]).expect("an exchange");
            assert_eq!(recording.reports[0], whole[0], "cut at {cut}");
            assert_eq!(recording.reports.len() + recording.flaws.len(), 2, "cut at {cut}");
        }
        let torn = read("device < 20\ndevice < 33 0").expect("an exchange");
        assert_eq!((torn.flaws[0].line, torn.flaws[0].column), (2, 13));
    }
}
