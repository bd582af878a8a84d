//! `usbhid-dump` text: chunks under a head of `BUS:DEVICE:INTERFACE:DESCRIPTOR|STREAM TIME`, bytes in hexadecimal.
//! Source: usbhid-dump(8).

use super::recording::{RecordedDevice, RecordedReport, Recording, hex, seconds};
use std::time::Duration;

/// The parts of a chunk's head.
pub(super) struct Header<'a> {
    interface: &'a str,
    stream: bool,
    at: Duration,
}

/// The head of a chunk, if it is one.
pub(super) fn header(line: &str) -> Option<Header<'_>> {
    let (place, time) = line.trim().split_once(char::is_whitespace)?;
    let (interface, entity) = place.rsplit_once(':')?;
    let numbers = interface.split(':');
    if numbers.clone().count() != 3
        || !numbers
            .clone()
            .all(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()))
    {
        return None;
    }
    Some(Header {
        interface,
        stream: match entity {
            "STREAM" => true,
            "DESCRIPTOR" => false,
            _ => return None,
        },
        at: seconds(time.trim())?,
    })
}

pub(super) fn read(text: &str) -> Recording {
    let mut recording = Recording::default();
    let mut chunk: Option<(Header<'_>, Vec<u8>)> = None;
    for (line, text) in (1..).zip(text.lines()) {
        if let Some(next) = header(text) {
            keep(&mut recording, chunk.take());
            chunk = Some((next, Vec::new()));
            continue;
        }
        let words = text.trim();
        if words.is_empty() {
            keep(&mut recording, chunk.take());
            continue;
        }
        match (&mut chunk, hex(words)) {
            (Some((_, bytes)), Ok(more)) => bytes.extend(more),
            // Between chunks people write what they did.
            (None, _) => {}
            (Some(_), Err(word)) => {
                let message = format!("expected bytes as two hexadecimal digits each, found \"{word}\"");
                recording.flaw(line, text.find(word).unwrap_or(0), message);
                chunk = None;
            }
        }
    }
    keep(&mut recording, chunk);
    recording
}

fn keep(recording: &mut Recording, chunk: Option<(Header<'_>, Vec<u8>)>) {
    let Some((header, bytes)) = chunk.filter(|(_, bytes)| !bytes.is_empty()) else {
        return;
    };
    let known = recording.devices.iter().position(|d| d.name == header.interface);
    let device = known.unwrap_or_else(|| {
        recording.devices.push(RecordedDevice {
            name: header.interface.to_owned(),
            ..RecordedDevice::default()
        });
        recording.devices.len() - 1
    });
    if header.stream {
        recording.reports.push(RecordedReport {
            device,
            at: header.at,
            bytes,
        });
    } else if let Some(device) = recording.devices.get_mut(device) {
        device.descriptor = Some(bytes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interfaces_are_devices_and_chunks_are_reports() {
        let recording = read(
            "001:004:000:DESCRIPTOR         1374402735.000001\n 05 0D 09\n C0\n\n\
             Moved the pen.\n\
             001:004:000:STREAM             1374402736.500000\n 08 80 88 47 EB 56 00 00\n 00 00 00 DC\n\n\
             001:004:001:STREAM             1374402736.600000\n 01\n",
        );
        assert_eq!(recording.flaws, []);
        assert_eq!(recording.devices.len(), 2);
        assert_eq!(
            recording.devices[0].descriptor.as_deref(),
            Some(&[5, 0xD, 9, 0xC0][..])
        );
        let lengths: Vec<_> = recording
            .reports
            .iter()
            .map(|r| (r.device, r.bytes.len()))
            .collect();
        assert_eq!(lengths, [(0, 12), (1, 1)]);
        assert_eq!(
            recording.reports[1].at,
            recording.reports[0].at + Duration::from_millis(100)
        );
    }
}
