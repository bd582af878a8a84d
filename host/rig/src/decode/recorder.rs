//! `hid-recorder` text: `D:` device, `R:` descriptor, `N:` name, `P:` path, `I:` ids, `E:` reports.
//! Source: hid-recorder(1) of hid-tools; bentiss/hid-devices has recordings of its older form, which is the same.

use super::recording::{RecordedDevice, RecordedReport, Recording, hex, seconds};

/// Most devices in one recording, so that a number is no order for memory.
const DEVICES_MAX: usize = 256;

pub(super) fn read(text: &str) -> Recording {
    let mut recording = Recording::default();
    let mut present = 0;
    for (line, text) in (1..).zip(text.lines()) {
        let text = text.trim_end();
        let Some((tag, rest)) = text.split_once(':').filter(|(tag, _)| tag.len() == 1) else {
            let words = text.trim_start();
            if !words.is_empty() && !words.starts_with('#') {
                recording.flaw(
                    line,
                    0,
                    format!(
                        "expected a line that begins with D:, R:, N:, P:, I: or E:, found \"{}\"",
                        short(words)
                    ),
                );
            }
            continue;
        };
        let rest_at = tag.len() + 1 + (rest.len() - rest.trim_start().len());
        let rest = rest.trim();
        let result = match tag {
            "D" => device_number(rest).map(|number| present = number),
            "R" => counted(rest).map(|bytes| device(&mut recording, present).descriptor = Some(bytes)),
            "N" => {
                rest.clone_into(&mut device(&mut recording, present).name);
                Ok(())
            }
            "I" => ids(rest).map(|ids| device(&mut recording, present).ids = Some(ids)),
            "E" => event(rest).map(|(at, bytes)| {
                device(&mut recording, present);
                recording.reports.push(RecordedReport {
                    device: present,
                    at,
                    bytes,
                });
            }),
            // The path says nothing about reports; other letters are for other readers.
            _ => Ok(()),
        };
        if let Err(message) = result {
            recording.flaw(line, rest_at, message);
        }
    }
    recording
}

fn device(recording: &mut Recording, number: usize) -> &mut RecordedDevice {
    while recording.devices.len() <= number {
        recording.devices.push(RecordedDevice::default());
    }
    // The loop made it.
    &mut recording.devices[number]
}

fn device_number(text: &str) -> Result<usize, String> {
    let number = text.parse().ok().filter(|&number| number < DEVICES_MAX);
    number.ok_or_else(|| {
        format!(
            "expected a device number below {DEVICES_MAX}, found \"{}\"",
            short(text)
        )
    })
}

/// A length and so many bytes.
fn counted(text: &str) -> Result<Vec<u8>, String> {
    let (length, bytes) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    let wanted: usize = length
        .parse()
        .map_err(|_| format!("expected a number of bytes, found \"{}\"", short(length)))?;
    let bytes = hex(bytes).map_err(|word| {
        format!(
            "expected a byte as two hexadecimal digits, found \"{}\"",
            short(word)
        )
    })?;
    if bytes.len() == wanted {
        Ok(bytes)
    } else {
        Err(format!("expected {wanted} bytes, found {}", bytes.len()))
    }
}

fn ids(text: &str) -> Result<[u16; 2], String> {
    let mut words = text.split_whitespace().skip(1);
    let mut id = || u16::from_str_radix(words.next()?, 16).ok();
    match (id(), id()) {
        (Some(vendor), Some(product)) => Ok([vendor, product]),
        _ => Err(format!(
            "expected a bus, a vendor and a product, found \"{}\"",
            short(text)
        )),
    }
}

fn event(text: &str) -> Result<(std::time::Duration, Vec<u8>), String> {
    let (time, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    let at = seconds(time).ok_or_else(|| format!("expected a time in seconds, found \"{}\"", short(time)))?;
    Ok((at, counted(rest.trim_start())?))
}

fn short(text: &str) -> String {
    text.chars().take(40).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn two_devices_take_turns() {
        let recording = read(
            "# a comment\nD: 0\nR: 3 05 01 c0\nN: Pen\nP: usb-1/input0\nI: 3 056a 00d4\n\
             D: 1\nN: Pad\nD: 0\nE: 000000.000000 2 02 e1\nD: 1\nE: 000000.008000 1 05\n",
        );
        assert_eq!(recording.flaws, []);
        assert_eq!(
            recording.devices[0].descriptor.as_deref(),
            Some(&[5, 1, 0xC0][..])
        );
        assert_eq!(recording.devices[0].ids, Some([0x056A, 0x00D4]));
        assert_eq!(recording.devices[1].name, "Pad");
        let second = &recording.reports[1];
        assert_eq!((second.device, second.at), (1, Duration::from_millis(8)));
    }

    #[test]
    fn a_spoilt_line_is_told_and_passed_over() {
        let recording = read("R: 2 05\nE: x 1 02\nE: 0.1 2 02 zz\nwhat\nE: 0.2 1 02\n");
        let places: Vec<_> = recording.flaws.iter().map(|f| (f.line, f.column)).collect();
        assert_eq!(places, [(1, 4), (2, 4), (3, 4), (4, 1)]);
        assert_eq!(recording.reports.len(), 1);
    }
}
