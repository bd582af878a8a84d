//! What can be wrong with an input device's profile beyond its shape.

use super::{ByteOrder, Control, FORMATS, Field, InputProfile, Layout, MidiAddress, Report};
use crate::read::{Check, Flaw};

impl Check for InputProfile {
    fn flaws(&self, flaws: &mut Vec<Flaw>) {
        if !FORMATS.contains(&self.format.as_str()) {
            let known = FORMATS.join(", ");
            flaws.push(Flaw::at_key(
                "format",
                format!("expected one of the formats {known}; found \"{}\"", self.format),
            ));
        }
        if self.layout.is_some() && !self.own_reports.is_empty() {
            flaws.push(Flaw::at_key(
                "layout",
                "expected a layout or [[report]] tables, found both",
            ));
        }
        self.flaws_of_matches(flaws);
        self.flaws_of_init(flaws);
        self.flaws_of_surface(flaws);
        self.flaws_of_controls(flaws);
        flaws_of_reports(&self.own_reports, flaws);
    }
}

impl Check for Layout {
    fn flaws(&self, flaws: &mut Vec<Flaw>) {
        flaws_of_reports(&self.reports, flaws);
    }
}

impl InputProfile {
    fn flaws_of_matches(&self, flaws: &mut Vec<Flaw>) {
        for (nth, m) in self.matches.iter().enumerate() {
            let mut flaw = |message: &str| flaws.push(Flaw::at_header("[[match]]", nth, message));
            if m.product.is_some() && m.vendor.is_none() {
                flaw("product needs vendor");
            }
            let texts = [&m.maker_text, &m.product_text, &m.serial_text];
            let mut given = texts.into_iter().flatten().chain(m.strings.values());
            if given.any(String::is_empty) {
                flaw("a text to match must not be empty");
            }
            // What is on a serial line may have nothing to be known by: then it is named by hand.
            if m.by_hand_only() && m.bus != super::Bus::Serial {
                flaw("expected a vendor, usage, text or port to be known by, found none");
            }
        }
    }

    fn flaws_of_init(&self, flaws: &mut Vec<Flaw>) {
        for (nth, step) in self.init.iter().enumerate() {
            if step.action().is_none() {
                flaws.push(Flaw::at_header(
                    "[[init]]",
                    nth,
                    "expected exactly one of string, feature, read_feature, output and wait_ms",
                ));
            }
            if step.range_from.is_some() && step.string.is_none() {
                flaws.push(Flaw::at_header(
                    "[[init]]",
                    nth,
                    "range_from needs string: only strings tell ranges",
                ));
            }
        }
    }

    fn flaws_of_surface(&self, flaws: &mut Vec<Flaw>) {
        let Some(surface) = &self.surface else { return };
        let mut flaw = |message: &str| flaws.push(Flaw::at_header("[surface]", 0, message));
        if surface.size_mm.is_some() == surface.counts_per_inch.is_some() {
            flaw("expected exactly one of size_mm and counts_per_inch");
        }
        let positive = |n: f64| n.is_finite() && n > 0.0;
        if surface.counts.contains(&0) || !surface.per_inch().into_iter().all(positive) {
            flaw("counts and the size must be above 0");
        }
        if surface.tilt_steps_per_rad.is_some_and(|n| !positive(n)) {
            flaw("tilt_steps_per_rad must be above 0");
        }
        if let Some(wacom) = &self.wacom
            && wacom.eraser_bit > 3
        {
            flaws.push(Flaw::at_key(
                "eraser_bit",
                format!("eraser_bit must be 0 to 3, found {}", wacom.eraser_bit),
            ));
        }
    }

    fn flaws_of_controls(&self, flaws: &mut Vec<Flaw>) {
        for (nth, control) in self.controls.iter().enumerate() {
            for message in flaws_of_control(control) {
                flaws.push(Flaw::at_header("[[control]]", nth, message));
            }
            if self.format == "sgi-dial-box" {
                // The format has four bits for a dial and 32 for buttons.
                let most = if control.kind == super::ControlKind::Dial {
                    16
                } else {
                    32
                };
                if control.count > most {
                    flaws.push(Flaw::at_header(
                        "[[control]]",
                        nth,
                        format!(
                            "count of {} must be at most {most}, found {}",
                            control.name, control.count
                        ),
                    ));
                }
            }
        }
        for (nth, output) in self.outputs.iter().enumerate() {
            let mut flaw = |message: String| flaws.push(Flaw::at_header("[[output]]", nth, message));
            if output.count == 0 {
                flaw("count must be at least 1, found 0".to_owned());
            }
            if let Some(of) = &output.of
                && !self.controls.iter().any(|c| &c.name == of)
            {
                flaw(format!("of names no control: there is no \"{of}\""));
            }
            if let Some(midi) = &output.midi {
                flaws_of_midi(midi, output.count).into_iter().for_each(flaw);
            }
        }
    }
}

fn flaws_of_control(control: &Control) -> Vec<String> {
    let mut found = Vec::new();
    if control.count == 0 {
        found.push("count must be at least 1, found 0".to_owned());
    }
    if !control.names.is_empty() && control.names.len() != usize::from(control.count) {
        found.push(format!(
            "names must be as many as count, expected {}, found {}",
            control.count,
            control.names.len()
        ));
    }
    if control
        .counts_per_turn
        .is_some_and(|n| !(n.is_finite() && n > 0.0))
    {
        found.push(format!(
            "counts_per_turn must be above 0, found {}",
            control.counts_per_turn.unwrap_or(0.0)
        ));
    }
    if control.range.is_some_and(|[low, high]| low >= high) {
        found.push("range must rise".to_owned());
    }
    for midi in [&control.midi, &control.touch].into_iter().flatten() {
        found.extend(flaws_of_midi(midi, control.count));
    }
    found
}

fn flaws_of_midi(midi: &MidiAddress, count: u16) -> Vec<String> {
    let mut found = Vec::new();
    if !(1..=16).contains(&midi.channel) {
        found.push(format!("channel must be 1 to 16, found {}", midi.channel));
    }
    let given = [
        midi.cc.is_some(),
        !midi.ccs.is_empty(),
        midi.note.is_some(),
        !midi.notes.is_empty(),
        midi.bend,
    ];
    if given.iter().filter(|&&g| g).count() != 1 {
        found.push("expected exactly one of cc, ccs, note, notes and bend".to_owned());
        return found;
    }
    let last = count.saturating_sub(1);
    let there = if midi.bend {
        u16::from(midi.channel) + last <= 16
    } else {
        midi.cc_of(last).or(midi.note_of(last)).is_some_and(|n| n < 128)
    };
    if !there {
        found.push(format!(
            "there are not {count} messages: numbers end at 127, channels at 16"
        ));
    }
    found
}

fn flaws_of_reports(reports: &[Report], flaws: &mut Vec<Flaw>) {
    let mut seen: Vec<String> = Vec::new();
    for (nth, report) in reports.iter().enumerate() {
        if report.bytes.is_some_and(|[few, most]| few > most) {
            flaws.push(Flaw::at_header("[[report]]", nth, "bytes must not fall"));
        }
        if report.slots.is_some_and(|s| s.stride == 0 || s.count == 0) {
            flaws.push(Flaw::at_header(
                "[[report]]",
                nth,
                "slots must have a stride and a count above 0",
            ));
        }
        for field in &report.fields {
            if let Some(message) = flaw_of_field(field, report) {
                let nth = seen.iter().filter(|&text| *text == text_of(field)).count();
                flaws.push(Flaw::at_nth(text_of(field), nth, message));
            }
            seen.push(text_of(field));
        }
    }
}

/// A field as its file writes its beginning.
fn text_of(field: &Field) -> String {
    format!("name = \"{}\"", field.name)
}

fn flaw_of_field(field: &Field, report: &Report) -> Option<String> {
    let name = field.name;
    let bits = field.all_bits();
    if bits == 0 || bits > 64 || field.bit > 7 || field.also.iter().any(|p| p.bit > 7) {
        return Some(format!(
            "{name}: expected 1 to 64 bits that begin at bit 0 to 7, found {bits}"
        ));
    }
    if field.endian == ByteOrder::Big && (field.bit != 0 || !field.bits().is_multiple_of(8)) {
        return Some(format!("{name}: big-endian numbers are whole bytes"));
    }
    if field.signed && field.sign_bit.is_some() {
        return Some(format!("{name}: both signed (two's complement) and sign_bit"));
    }
    if field.sign_bit.is_some_and(|bit| u32::from(bit) >= bits) {
        return Some(format!("{name}: sign_bit lies outside its {bits} bits"));
    }
    let most = match (report.slots, report.bytes) {
        (Some(slots), _) => slots.stride,
        (None, Some([_, most])) => most,
        (None, None) => return None,
    };
    // Bits beyond the longest report would never be there.
    let far = field
        .repeat
        .map_or(0, |r| u32::from(r.bits) * u32::from(r.count.saturating_sub(1)));
    let end = u32::from(field.byte) * 8 + u32::from(field.bit) + u32::from(field.bits()) + far;
    (end > u32::from(most) * 8).then(|| format!("{name}: ends at bit {end}, after the report's {most} bytes"))
}
