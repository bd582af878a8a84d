//! Captures of the devices of a rig that runs: begun and ended at any time, without anything noticed on the line.
//!
//! What a report means depends on those before it. So a file that is begun in the middle first has the conversation
//! up to then, as far as the device's tape has it, with what the codec says and makes of it; then everything that
//! passes, as it passes. Each is played back as a whole.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use device::codec::hid::HidCodec;
use device::codec::{Answer, Codec, Feedback, InputEvent, Stand, Step, of_profile};
use device::exchange::{self, Exchange, Head, Record, What};
use device_profiles::InputProfile;

use super::CaptureError;
use super::file::CaptureFile;
use crate::controls::view::CaptureView;
use crate::take::{Conversation, Tapes};

/// All that are being written, by the name of their device, and how the last ones ended.
#[derive(Default)]
pub(crate) struct Captures {
    running: BTreeMap<String, Running>,
    ended: BTreeMap<String, CaptureView>,
}

struct Running {
    file: CaptureFile,
    /// When it was asked for, since the rig began.
    since: Duration,
    /// The file's beginning, likewise: when the device was first asked.
    zero: Duration,
    /// A board that starts anew when its line is opened is not heard for so long.
    boot_wait: Duration,
    /// Until then.
    deaf_until: Duration,
    /// It told by itself what it is; nobody else asked for that.
    described: bool,
}

/// The device that is to be captured.
pub(crate) struct Subject<'s> {
    pub(crate) name: &'s str,
    pub(crate) address: &'s str,
    pub(crate) profile: &'s InputProfile,
    /// It described itself; there is no such profile in any file.
    pub(crate) described: bool,
    /// What it shows.
    pub(crate) shows: Vec<Feedback>,
}

impl Captures {
    /// Whether nothing is being written.
    pub(crate) fn is_idle(&self) -> bool {
        self.running.is_empty()
    }

    pub(crate) fn runs(&self, device: &str) -> bool {
        self.running.contains_key(device)
    }

    pub(crate) fn running(&self) -> Vec<String> {
        self.running.keys().cloned().collect()
    }

    /// Begins a file in a folder.
    pub(crate) fn start(
        &mut self,
        subject: &Subject<'_>,
        folder: &Path,
        tapes: &mut Tapes,
        now: Duration,
    ) -> Result<(), CaptureError> {
        let head = Head {
            profile: (!subject.described).then(|| subject.profile.key.clone()),
            source: Some(format!("captured from {} at {}", subject.name, subject.address)),
            ..Head::default()
        };
        let file = CaptureFile::create_in(folder, &file_name(subject.name), &head)?;
        let before = tapes.watch(subject.name, now);
        let boot_wait = subject.profile.line.map_or(0, |line| line.boot_wait_ms);
        let boot_wait = Duration::from_millis(boot_wait.into());
        let zero = before.opened.saturating_add(boot_wait);
        let mut running = Running {
            file,
            since: now,
            zero,
            boot_wait,
            deaf_until: zero,
            described: subject.described,
        };
        running.tell_before(subject, before, now);
        let written = running.file.write_out();
        self.ended.remove(subject.name);
        self.running.insert(subject.name.to_owned(), running);
        written
    }

    /// Takes in what passed on the lines.
    pub(crate) fn take_in(&mut self, tapes: &Tapes) {
        for (name, running) in &mut self.running {
            for (at, what) in tapes.watched(name) {
                running.add(at, what);
            }
        }
    }

    /// What a codec made of it.
    pub(crate) fn event(&mut self, device: &str, at: Duration, event: InputEvent) {
        if let Some(running) = self.running.get_mut(device) {
            running.add(at, What::Event(event));
        }
    }

    /// A device is to show something.
    pub(crate) fn show(&mut self, device: &str, at: Duration, feedback: &Feedback) {
        if let Some(running) = self.running.get_mut(device) {
            running.add(at, What::Show(feedback.clone()));
        }
    }

    /// Writes what was taken in. Those that cannot be written end; gives what to say of them.
    pub(crate) fn write_out(&mut self, tapes: &Tapes, now: Duration) -> Vec<String> {
        let mut troubles = Vec::new();
        let ended = &mut self.ended;
        self.running.retain(|name, running| {
            let Err(error) = running.file.write_out() else {
                return true;
            };
            let part = running.file.part().display().to_string();
            troubles.push(format!("{error}; what came before is in {part}"));
            let trouble = Some(error.to_string());
            tapes.look_away(name);
            ended.insert(
                name.clone(),
                CaptureView {
                    running: false,
                    trouble,
                    ..running.view(now)
                },
            );
            false
        });
        troubles
    }

    /// Ends the capture of a device: the file takes its place.
    pub(crate) fn stop(&mut self, device: &str, tapes: &Tapes, now: Duration) -> Result<(), CaptureError> {
        let Some(running) = self.running.remove(device) else {
            return Ok(());
        };
        tapes.look_away(device);
        let mut view = CaptureView {
            running: false,
            ..running.view(now)
        };
        let finished = running.file.finish();
        match &finished {
            Ok((place, _)) => view.file = place.display().to_string(),
            Err(error) => view.trouble = Some(error.to_string()),
        }
        self.ended.insert(device.to_owned(), view);
        finished.map(|_| ())
    }

    /// The capture of a device, or the last one of it.
    pub(crate) fn view(&self, device: &str, now: Duration) -> Option<CaptureView> {
        let running = self.running.get(device).map(|running| running.view(now));
        running.or_else(|| self.ended.get(device).cloned())
    }
}

impl Running {
    fn view(&self, now: Duration) -> CaptureView {
        CaptureView {
            file: self.file.part().display().to_string(),
            running: true,
            secs: now.saturating_sub(self.since).as_secs_f64(),
            bytes: self.file.bytes(),
            events: self.file.events(),
            trouble: None,
        }
    }

    fn add(&mut self, at: Duration, what: What) {
        match what {
            What::Back => {
                self.deaf_until = at.saturating_add(self.boot_wait);
                self.put(self.deaf_until, What::Back);
            }
            What::Device(bytes) if at < self.deaf_until => {
                let words: Vec<String> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
                self.file
                    .remark(&format!("passed over while it starts: {}", words.join(" ")));
            }
            What::Host(Step::AskDescriptor) if self.described => {}
            what => self.put(at, what),
        }
    }

    fn put(&mut self, at: Duration, what: What) {
        self.file.add(at.saturating_sub(self.zero), what);
    }

    /// The conversation up to now, with what the codec says and makes of it, and what is shown on the device.
    fn tell_before(&mut self, subject: &Subject<'_>, before: Conversation, now: Duration) {
        let mut records = Vec::new();
        let rebased = |at: Duration| at.saturating_sub(self.zero);
        if let Some(descriptor) = before.descriptor.filter(|_| subject.described) {
            records.push(Record::new(Duration::ZERO, What::Answer(descriptor)));
        }
        for record in before.records {
            let at = record.at.unwrap_or_default();
            let passed_over = match record.what {
                What::Device(_) => at < self.zero,
                // It stands at the beginning.
                What::Answer(Answer::Descriptor(_)) => subject.described,
                _ => false,
            };
            if !passed_over {
                records.push(Record::new(rebased(at), record.what));
            }
        }
        let shows = subject.shows.iter().cloned().map(What::Show);
        records.extend(shows.map(|what| Record::new(rebased(now), what)));
        let codec = codec_of(subject, &records);
        let exchange = Exchange {
            head: Head::default(),
            records,
        };
        let played = codec.map(|mut codec| exchange::play(&exchange, codec.as_mut()));
        let mut told: Vec<(u8, Record)> = exchange.records.into_iter().map(|record| (0, record)).collect();
        if let Some(played) = played {
            let since = |at: device::Instant| at.since(device::Instant::ZERO);
            let said = played.said.into_iter();
            told.extend(said.map(|(at, step)| (1, Record::new(since(at), What::Host(step)))));
            let events = played.events.into_iter();
            told.extend(events.map(|it| (2, Record::new(since(it.at), What::Event(it.what)))));
        }
        // What the device said comes before what was made of it. Stable: each keeps its order.
        told.sort_by_key(|(rank, record)| (record.at, *rank));
        if before.left_out > 0 {
            self.file.remark(&format!(
                "{} reports are left out here somewhere",
                before.left_out
            ));
        }
        for (_, record) in told {
            self.file.add(record.at.unwrap_or_default(), record.what);
        }
        self.file
            .remark("up to here out of the rig's memory; from here on as it passes");
    }
}

/// The codec that hears it again.
fn codec_of(subject: &Subject<'_>, records: &[Record]) -> Option<Box<dyn Codec>> {
    if !subject.described {
        return of_profile(subject.profile, Stand::Unasked).ok();
    }
    let descriptor = records.iter().find_map(|record| match &record.what {
        What::Answer(Answer::Descriptor(Ok(descriptor))) => Some(descriptor),
        _ => None,
    })?;
    HidCodec::generic(descriptor)
        .ok()
        .map(|codec| Box::new(codec) as Box<dyn Codec>)
}

/// A device's name as that of a file.
fn file_name(device: &str) -> String {
    let plain = device.chars().map(|c| {
        if c.is_ascii_alphanumeric() || "-_".contains(c) {
            c
        } else {
            '-'
        }
    });
    plain.collect()
}
